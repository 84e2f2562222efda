//! A bearing that turns without inertia, against equilibria at rest, its own period, and motion in time.

use std::f64::consts::PI;

use contact::Side;
use dynamics::effects::{AxialForce, BallCentrifugal, Gravity, Now, RadialForce};
use dynamics::kinematics::{BallSpeeds, Rolling, Speed};
use dynamics::motion::{Motion, MotionSettings, StepCache};
use dynamics::{ContactMode, Hold, Model, Pose, QuasiStaticMotion, StaticSolution, StaticSolver};
use input::Schedule;

use crate::support::rings::Level;
use crate::support::{Case, relative};

const SMALL: Level = Level::hex8(54, 6, 1, 2);
/// 1800 rpm, rad/s.
const SPEED: f64 = 60.0 * PI;

fn rolling(model: &Model) -> Rolling {
    Rolling::new(&model.geometry, Speed::constant(SPEED), [0.0; 2])
}

fn combined() -> Case {
    Case {
        radial: 1000.0,
        ..Case::axial(2000.0)
    }
}

/// Equilibria from the start on, `n` steps of `dt`.
fn run(model: &Model, dt: f64, n: u64) -> Vec<StaticSolution> {
    let mut quasi = QuasiStaticMotion::new(model, rolling(model), dt).unwrap();
    let mut solutions: Vec<StaticSolution> = Vec::new();
    for step in 0..=n {
        let solution = quasi.step(step, solutions.last()).unwrap();
        solutions.push(solution);
    }
    solutions
}

/// Largest difference of any ball's force from that of the ball `shift` places on, over the largest force.
fn force_change(a: &StaticSolution, b: &StaticSolution, shift: usize) -> f64 {
    let n = a.balls.len();
    let largest = a.balls.iter().map(|x| x.inner.force_n).fold(0.0, f64::max);
    let sides = |x: &StaticSolution, i: usize| [x.balls[i].inner.force_n, x.balls[i].outer.force_n];
    let change = |i: usize| {
        let (before, after) = (sides(a, (i + shift) % n), sides(b, i));
        (before[0] - after[0]).abs().max((before[1] - after[1]).abs())
    };
    (0..n).map(change).fold(0.0, f64::max) / largest
}

/// Wrong: the balls would not stand where the cage has carried them. Rigid rings: the equilibrium of a bearing whose
/// first ball is at that azimuth, to the round-off that Newton leaves.
#[test]
fn rigid_rings_pass_through_the_equilibria_at_the_phases_of_the_cage() {
    for free_tilt in [false, true] {
        let case = Case {
            free_tilt,
            moment: 1.0,
            ..combined()
        };
        let model = case.rigid();
        let dt = 1.7e-4;
        for (step, moving) in run(&model, dt, 6).iter().enumerate() {
            let phase = rolling(&model).pose(step as f64 * dt).now.cage_angle;
            let rest = crate::support::equilibrium(&Case { phase, ..case }.rigid());
            assert!(force_change(&rest, moving, 0) < 1e-12, "step {step}");
            for (a, b) in rest.balls.iter().zip(&moving.balls) {
                assert!((a.azimuth_rad - b.azimuth_rad).abs() < 1e-12);
                assert!(relative(a.inner.contact_angle_rad, b.inner.contact_angle_rad) < 1e-11);
            }
            for i in 0..5 {
                let (a, b) = (rest.displacements.shaft[i], moving.displacements.shaft[i]);
                assert!(
                    (a - b).abs() < 1e-16 + 1e-9 * a.abs(),
                    "step {step}, dof {i}: {a} {b}"
                );
            }
        }
    }
}

/// Wrong: a ball would meet other rings than the one before it. When the cage has turned by one pitch, and the inner
/// ring by what belongs to it, every ball carries what the next one carried. The outer mesh repeats after a pitch (54
/// elements, 18 balls); the inner one stands elsewhere under the balls, which is worth the difference between places
/// on a mesh.
#[test]
fn forces_repeat_when_every_ball_stands_where_the_next_one_stood() {
    let model = combined().flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    let cage = rolling(&model).kinematics.cage * SPEED;
    let n = 8;
    let solutions = run(&model, 2.0 * PI / 18.0 / cage / n as f64, n);
    let (first, last) = (&solutions[0], &solutions[n as usize]);
    let change = force_change(first, last, 1);
    println!("after one pitch: {change:.2e}");
    assert!(change < 1e-5, "{change}");
    // In between, balls carry other forces: this is no bearing that stands still.
    assert!(force_change(first, &solutions[n as usize / 2], 1) > 0.02);

    // The same with an inner mesh that has turned by whole elements: nothing is different but round-off.
    let turned = Pose {
        now: Now {
            time: 0.0,
            cage_angle: 2.0 * PI / 18.0,
            ..Now::default()
        },
        ring_angles: [2.0 * PI / 18.0 * 2.0, 0.0],
        rolled: 0.0,
    };
    let mut solver = StaticSolver::new(&model).unwrap();
    let exact = solver.solve_at(&model, &turned, Some(first)).unwrap();
    let change = force_change(first, &exact, 1);
    assert!(change < 1e-8, "{change}");
}

/// Wrong: the turning inner ring would carry loads or contacts in directions that do not turn back with it: by
/// symmetry a quarter turn of loads, balls and ring together turns the displacement of the shaft and changes no
/// force.
#[test]
fn a_turned_bearing_under_turned_loads_is_the_same_bearing() {
    let quarter = 0.5 * PI;
    let model_at = |angle: f64| {
        let mut model = combined().flexible(ContactMode::Patch, Level::hex8(36, 6, 1, 2), Hold::Clamped);
        let (sin, cos) = angle.sin_cos();
        let gravity = Gravity::new([1e4 * cos, 1e4 * sin, 0.0], Schedule::Constant, &model.rings).unwrap();
        model.effects = vec![
            Box::new(AxialForce {
                value: 2000.0,
                schedule: Schedule::Constant,
            }),
            Box::new(RadialForce {
                value: 1000.0,
                direction: angle,
                schedule: Schedule::Constant,
            }),
            Box::new(gravity),
        ];
        model
    };
    let solve = |angle: f64| {
        let pose = Pose {
            now: Now {
                time: 0.0,
                cage_angle: angle,
                ..Now::default()
            },
            ring_angles: [angle, 0.0],
            rolled: 0.0,
        };
        let model = model_at(angle);
        let mut solver = StaticSolver::new(&model).unwrap();
        solver.solve_at(&model, &pose, None).unwrap()
    };
    let (rest, turned) = (solve(0.0), solve(quarter));
    assert!(force_change(&rest, &turned, 0) < 1e-9);
    let (a, b) = (rest.displacements.shaft, turned.displacements.shaft);
    assert!((b[1] - a[0]).abs() < 1e-8 * a[0].abs() && (b[0] + a[1]).abs() < 1e-8 * a[0].abs());
    // The inner ring's own frame turned with it: the same field, node by node.
    let field = |s: &StaticSolution| s.elastic[Side::Inner.index()].clone().unwrap();
    let largest = field(&rest).iter().fold(0.0f64, |m, x| m.max(x.abs()));
    for (x, y) in field(&rest).iter().zip(&field(&turned)) {
        assert!((x - y).abs() < 1e-8 * largest, "{x} {y}");
    }
}

/// Wrong: quasi-static and dynamic runs of the same scene would be two different bearings. At 1800 rpm inertia is
/// small: the forces differ by less than 1e-4, of which most is the mean over a step against its end.
#[test]
fn slow_motion_follows_the_quasi_static_run() {
    let mut model = combined().flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    model.effects.push(Box::new(BallCentrifugal {
        speeds: Speed::constant(SPEED).into(),
        slip: [0.0; 2],
        ball_speeds: BallSpeeds::FreeAngle,
    }));
    let dt = 2e-5;
    let mut quasi = QuasiStaticMotion::new(&model, rolling(&model), 0.5 * dt).unwrap();
    let start = quasi.step(0, None).unwrap();
    let settings = MotionSettings::conserving(dt, Speed::constant(SPEED));
    let motion = Motion::new(&model, settings).unwrap();
    let mut state = motion.start(&start);
    let (mut earlier, mut worst) = (start, 0.0f64);
    let mut cache = StepCache::default();
    for step in 1..=150u64 {
        state = motion.step(&state, &mut cache).unwrap().0;
        if !step.is_multiple_of(30) {
            continue;
        }
        // Forces of motion are means over the step: those of its middle.
        let rest = quasi.step(2 * step - 1, Some(&earlier)).unwrap();
        let largest = rest.balls.iter().map(|b| b.inner.force_n).fold(0.0, f64::max);
        for (ball, f) in rest.balls.iter().zip(state.forces.chunks_exact(2)) {
            worst = worst.max((f[0].norm() - ball.inner.force_n).abs() / largest);
            worst = worst.max((f[1].norm() - ball.outer.force_n).abs() / largest);
        }
        earlier = rest;
    }
    println!("dynamic against quasi-static: {worst:.2e}");
    assert!(worst < 1e-4, "{worst}");
}

/// Wrong: a warm start, or the columns of an earlier instant, would change the result and not only its cost.
#[test]
fn an_instant_does_not_depend_on_the_instants_before_it() {
    let model = combined().flexible(ContactMode::Patch, SMALL, Hold::MeanMotion);
    let solutions = run(&model, 4e-4, 5);
    let last = solutions.last().unwrap();
    let pose = rolling(&model).pose(5.0 * 4e-4);
    let cold = StaticSolver::new(&model)
        .unwrap()
        .solve_at(&model, &pose, None)
        .unwrap();
    let change = force_change(&cold, last, 0);
    assert!(change < 1e-8, "{change}");
    assert!(last.rounds <= cold.rounds, "{} {}", last.rounds, cold.rounds);
    println!("rounds: warm {}, cold {}", last.rounds, cold.rounds);
}
