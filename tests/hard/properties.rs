//! Random bearings, loads and speeds within bounds: equilibrium, symmetry, ledger.

use contact::{BearingGeometry, HertzContact, Side};
use dynamics::kinematics::Speed;
use dynamics::motion::MotionSettings;
use dynamics::{Model, StaticSolution, StaticSolver};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};

use super::bearings::{Load, RPM, conserving, rigid};
use super::course::from_equilibrium;
use super::record::{LEDGER, Record};
use super::support::steel;
use super::{HardCase, Pace};

pub fn cases() -> Vec<HardCase> {
    let case = HardCase::new;
    let bearings = "3 to 40 balls of 1 to 60 mm, grooves 0.505 to 0.6, clearance to 0.8 A either way, loads of 1e-8 \
                    to 1e-3 E D_w^2";
    vec![
        case(
            "random_equilibria",
            Pace::Fast,
            "bearings nobody thought of",
            bearings,
            |r| equilibria(r, 60),
        ),
        case(
            "random_equilibria_many",
            Pace::Slow,
            "bearings nobody thought of",
            bearings,
            |r| equilibria(r, 1000),
        ),
        case(
            "random_mirrors",
            Pace::Fast,
            "symmetry where no ball stands on the line of the load",
            bearings,
            |r| mirrors(r, 30),
        ),
        case(
            "random_mirrors_many",
            Pace::Slow,
            "symmetry where no ball stands on the line of the load",
            bearings,
            |r| mirrors(r, 300),
        ),
        case(
            "random_motions",
            Pace::Fast,
            "load jumps at any speed, step and size",
            "the same, 0 to 40 000 rpm, steps of 1/50 to 3 periods of a ball",
            |r| motions(r, 12),
        ),
        case(
            "random_motions_many",
            Pace::Slow,
            "load jumps at any speed, step and size",
            "the same, 0 to 40 000 rpm, steps of 1/50 to 3 periods of a ball",
            |r| motions(r, 100),
        ),
    ]
}

/// A bearing and its loads.
#[derive(Clone, Copy, Debug)]
struct Random {
    geometry: BearingGeometry,
    axial: f64,
    radial: f64,
    direction: f64,
    rpm: f64,
    /// Step over the period of a ball.
    step: f64,
}

fn bearing() -> impl Strategy<Value = Random> {
    let sizes = (
        3usize..=40,
        -3.0..-1.222f64,
        0.505..0.6f64,
        0.505..0.6f64,
        -0.8..0.8f64,
    );
    let loads = (
        -8.0..-3.0f64,
        -2.0..1.0f64,
        0.0..std::f64::consts::TAU,
        0.0..std::f64::consts::TAU,
    );
    let motion = (0.0..40_000.0f64, -1.7..0.5f64);
    (sizes, loads, motion).prop_map(
        |((n, size, inner, outer, clearance), (load, ratio, direction, phase), (rpm, step))| {
            let ball = 10f64.powf(size);
            // Balls fill up to 90 % of the pitch circle, and the bore stays open.
            let pitch = (1.1 * n as f64 * ball / std::f64::consts::PI).max(3.0 * ball);
            let distance = (inner + outer - 1.0) * ball;
            let raceway = pitch - ball;
            let geometry = BearingGeometry {
                n_balls: n,
                ball_diameter: ball,
                inner_raceway_diameter: raceway,
                outer_raceway_diameter: raceway + 2.0 * ball + clearance * distance,
                inner_groove_radius: inner * ball,
                outer_groove_radius: outer * ball,
                first_ball_azimuth: phase,
            };
            let axial = 10f64.powf(load) * 207e9 * ball * ball;
            Random {
                geometry,
                axial,
                radial: axial * 10f64.powf(ratio),
                direction,
                rpm,
                step: 10f64.powf(step),
            }
        },
    )
}

fn model(random: &Random, direction: f64) -> Model {
    let mut model = rigid(Load::dead(random.axial), Load::dead(0.0));
    model.geometry = random.geometry;
    let elastic = dynamics::model::elastic(&steel());
    model.hertz = Side::BOTH.map(|side| HertzContact::new(&random.geometry, side, elastic, elastic));
    model.effects.push(Box::new(dynamics::effects::RadialForce {
        value: random.radial,
        direction,
        schedule: input::Schedule::Constant,
    }));
    model.shaft_mass = 20.0 * model.ball_mass() * random.geometry.n_balls as f64;
    model
}

fn solve(model: &Model) -> Result<StaticSolution, TestCaseError> {
    let solution = StaticSolver::new(model).and_then(|mut s| s.solve(model, None));
    solution.map_err(|e| TestCaseError::fail(e.to_string()))
}

/// Runs a property on the same `cases` random bearings each time.
fn hold(record: &mut Record, cases: u32, property: impl Fn(Random) -> Result<(), TestCaseError>) {
    let config = Config {
        cases,
        failure_persistence: None,
        ..Config::default()
    };
    let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    let outcome = runner.run(&bearing(), property);
    record.note(format!("{cases} bearings"));
    record.that(
        &format!("it holds for all: {outcome:?}")
            .chars()
            .take(1500)
            .collect::<String>(),
        outcome.is_ok(),
    );
}

fn equilibria(record: &mut Record, cases: u32) {
    hold(record, cases, |random| {
        let model = model(&random, random.direction);
        let solution = solve(&model)?;
        let scale = random.axial.hypot(random.radial);
        let mut sums = [[0.0; 3]; 2];
        for ball in &solution.balls {
            let (sin, cos) = ball.azimuth_rad.sin_cos();
            for (sum, c) in sums.iter_mut().zip([&ball.inner, &ball.outer]) {
                let (axial, radial) = c.contact_angle_rad.sin_cos();
                let add = [
                    c.force_n * radial * cos,
                    c.force_n * radial * sin,
                    c.force_n * axial,
                ];
                (0..3).for_each(|i| sum[i] += add[i]);
            }
        }
        let (sin, cos) = random.direction.sin_cos();
        let load = [random.radial * cos, random.radial * sin, random.axial];
        for sum in sums {
            for i in 0..3 {
                // Interference presses harder than the loads: the sums cancel.
                let force = solution
                    .balls
                    .iter()
                    .map(|b| b.inner.force_n)
                    .sum::<f64>()
                    .max(scale);
                prop_assert!((sum[i] - load[i]).abs() < 1e-8 * force, "{sum:?} is not {load:?}");
            }
        }
        prop_assert!(
            solution
                .balls
                .iter()
                .all(|b| b.inner.force_n >= 0.0 && b.outer.force_n >= 0.0)
        );
        let work = solution.load_work.abs().max(solution.hertz_energy);
        prop_assert!(
            solution.work_defect.abs() < 1e-8 * work,
            "defect {:e} of {work:e} J",
            solution.work_defect
        );
        Ok(())
    });
}

fn mirrors(record: &mut Record, cases: u32) {
    hold(record, cases, |random| {
        // Mirrored in the plane of x and z: azimuths and the direction of the load change sign.
        let mut other = random;
        other.geometry.first_ball_azimuth = -random.geometry.first_ball_azimuth;
        let here = solve(&model(&random, random.direction))?;
        let there = solve(&model(&other, -random.direction))?;
        let n = random.geometry.n_balls;
        let scale = here.balls.iter().map(|b| b.inner.force_n).fold(0.0, f64::max);
        for i in 0..n {
            let (a, b) = (
                here.balls[i].inner.force_n,
                there.balls[(n - i) % n].inner.force_n,
            );
            prop_assert!((a - b).abs() < 1e-7 * scale, "ball {i}: {a} N and {b} N");
        }
        let (a, b) = (here.displacements.shaft, there.displacements.shaft);
        let way = a.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        for (i, sign) in [1.0, -1.0, 1.0].into_iter().enumerate() {
            prop_assert!((a[i] - sign * b[i]).abs() < 1e-6 * way, "{a:?} {b:?}");
        }
        Ok(())
    });
}

fn motions(record: &mut Record, cases: u32) {
    let worst = std::cell::Cell::new(0.0f64);
    let left = std::cell::Cell::new(0u32);
    hold(record, cases, |random| {
        let lighter = Random {
            radial: 0.1 * random.radial,
            ..random
        };
        let start = match solve(&model(&lighter, random.direction)) {
            // The few balls of some bearings have no place to press under such loads: refused at rest, as it must be.
            Err(TestCaseError::Fail(reason))
                if reason.message().contains("but no groove reaches beyond 90 deg") =>
            {
                left.set(left.get() + 1);
                return Ok(());
            }
            start => start?,
        };
        let jumped = model(&random, random.direction);
        let force = start.balls.iter().map(|b| b.outer.force_n).fold(0.0, f64::max);
        let stiffness = 1.5 * jumped.hertz[1].stiffness.powf(2.0 / 3.0) * force.cbrt();
        let period = std::f64::consts::TAU * (jumped.ball_mass() / (2.0 * stiffness)).sqrt();
        let settings = MotionSettings {
            speeds: Speed::constant(random.rpm * RPM).into(),
            ..conserving(random.step * period)
        };
        let course = from_equilibrium(&jumped, &start, settings, 200);
        worst.set(worst.get().max(course.defect));
        if let Some(error) = &course.error {
            // Where balls swing out of what a groove can be, the program must say so; in a bearing that keeps its
            // balls loaded and bears its load they do not.
            prop_assert!(error.contains("but no groove reaches beyond 90 deg"), "{error}");
            prop_assert!(may_leave(&jumped), "{error}");
            left.set(left.get() + 1);
        }
        prop_assert!(course.defect < LEDGER && course.is_finite());
        Ok(())
    });
    record.note_defect(worst.get());
    record.note(format!("{} runs end where a ball leaves its groove", left.get()));
    record.below(
        "share of runs that do not come to their end",
        f64::from(left.get()) / f64::from(cases),
        0.1,
    );
}

/// Whether a ball may leave its groove: somewhere in a turn of the cage the bearing has no equilibrium within its
/// grooves, or one beyond the static rating of steel, or with contacts steeper than those of angular contact bearings
/// (40 deg at most, and 10 deg more under load), or with a loose ball, which swings without damping.
fn may_leave(model: &Model) -> bool {
    const PLACES: usize = 8;
    let pitch = std::f64::consts::TAU / model.geometry.n_balls as f64;
    (0..PLACES).any(|i| {
        let mut pose = dynamics::Pose::default();
        pose.now.cage_angle = pitch * i as f64 / PLACES as f64;
        let Ok(rest) = StaticSolver::new(model).and_then(|mut s| s.solve_at(model, &pose, None)) else {
            return true;
        };
        let mut contacts = rest.balls.iter().flat_map(|b| [&b.inner, &b.outer]);
        let outside =
            |c: &dynamics::balls::ContactResult| c.force_n <= 0.0 || c.contact_angle_rad.to_degrees() > 50.0;
        !rest.warnings.is_empty() || contacts.any(outside)
    })
}
