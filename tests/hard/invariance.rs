//! What must not change an answer: units, where the mesh begins, numbers of balls, directions, threads.

use contact::Side;
use dynamics::kinematics::Speed;
use dynamics::motion::MotionSettings;
use dynamics::{Hold, Model, StaticSolution};

use super::bearings::{Load, RPM, SMALL, conserving, equilibrium_at, flexible, rigid, set_loads};
use super::course::from_equilibrium;
use super::record::Record;
use super::support::relative;
use super::support::rings::{ring, ring_model};
use super::{HardCase, Pace};
use crate::util::tables::Table;
use crate::util::{Dir, RIGID, SCENE};

pub fn cases() -> Vec<HardCase> {
    let case = HardCase::new;
    vec![
        case(
            "units_of_the_scene",
            Pace::Fast,
            "convergence that depends on the unit system",
            "the tests' scene in m, kN, bar, t and rad, rigid rings",
            units,
        ),
        case(
            "mesh_turned_by_a_sector",
            Pace::Fast,
            "an answer that depends on where the mesh begins",
            "both meshes turned by 1, 7 and 53 of 54 sectors",
            turned_mesh,
        ),
        case(
            "order_of_balls",
            Pace::Fast,
            "an answer that depends on the number of a ball",
            "first ball one pitch on, 2 kN and 1 kN radial, flexible",
            order,
        ),
        case(
            "turned_load",
            Pace::Fast,
            "directions that are not alike",
            "radial load turned by 5 pitches, flexible, at rest and 0.5 ms of motion",
            turned_load,
        ),
        case(
            "mirrored_motion",
            Pace::Fast,
            "a sign of the axis that is not a mirror",
            "speed and transverse load reversed, rigid, 2 ms at 6000 rpm",
            mirrored_motion,
        ),
        case(
            "any_number_of_threads",
            Pace::Fast,
            "sums in another order",
            "half the balls unload, flexible, 1, 2 and 5 threads: bits",
            threads,
        ),
    ]
}

fn forces(dir: &Dir, out: &str) -> Vec<f64> {
    let table = Table::read(dir, &format!("{out}/balls.csv"));
    [
        table.column("inner_force_n"),
        table.column("outer_contact_angle_rad"),
    ]
    .concat()
}

fn worst(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| relative(*a, *b)).fold(0.0, f64::max)
}

fn units(record: &mut Record) {
    let dir = Dir::with_scene(SCENE);
    dir.run("si", &RIGID);
    let usual = forces(&dir, "si");
    let other = SCENE
        .replace("\"9 mm\"", "\"0.009 m\"")
        .replace("\"56.01 mm\"", "\"5.601 cm\"")
        .replace("\"74.037 mm\"", "\"74037 um\"")
        .replace("\"4.65 mm\"", "\"4650000 nm\"")
        .replace("\"207 GPa\"", "\"2070000 bar\"")
        .replace("\"7800 kg/m3\"", "\"7.8 t/m3\"")
        .replace("\"2 kN\"", "\"0.002 MN\"")
        .replace("\"1 kN\"", "\"1000000 mN\"")
        .replace("\"0 deg\"", "\"0 rad\"");
    record.that("the scene is another text", other != SCENE);
    dir.write("scene.toml", other);
    dir.run("other", &RIGID);
    record.below(
        "largest change of a ball force or contact angle",
        worst(&usual, &forces(&dir, "other")),
        1e-11,
    );
}

/// Ball forces and contact angles.
pub fn results(solution: &StaticSolution) -> Vec<f64> {
    let of_ball =
        |b: &dynamics::balls::BallResult| [b.inner.force_n, b.outer.force_n, b.inner.contact_angle_rad];
    solution.balls.iter().flat_map(of_ball).collect()
}

pub fn loaded() -> Model {
    let mut model = flexible(Load::dead(2e3), Load::dead(1e3));
    model.shaft_mass = 0.0;
    model
}

fn turned_mesh(record: &mut Record) {
    let usual = results(&equilibrium_at(&loaded(), 0.0).unwrap());
    for sectors in [1, 7, 53] {
        let mut model = loaded();
        let (sin, cos) = (std::f64::consts::TAU * sectors as f64 / 54.0).sin_cos();
        model.rings = Side::BOTH.map(|side| {
            let mut mesh = ring(side, SMALL, Hold::Clamped).mesh;
            for x in &mut mesh.nodes {
                *x = [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1], x[2]];
            }
            Some(std::sync::Arc::new(ring_model(side, mesh, Hold::Clamped)))
        });
        let turned = results(&equilibrium_at(&model, 0.0).unwrap());
        record.below(
            &format!("largest change, {sectors} sectors,"),
            worst(&usual, &turned),
            1e-9,
        );
    }
}

fn order(record: &mut Record) {
    let mut model = loaded();
    let usual = results(&equilibrium_at(&model, 0.0).unwrap());
    model.geometry.first_ball_azimuth = std::f64::consts::TAU / 18.0;
    let mut next = results(&equilibrium_at(&model, 0.0).unwrap());
    next.rotate_right(3);
    record.below("largest change", worst(&usual, &next), 1e-9);
}

fn turned_load(record: &mut Record) {
    let pitch = std::f64::consts::TAU / 18.0;
    let run = |pitches: f64| {
        let mut model = loaded();
        model.effects.pop();
        model.effects.push(Box::new(dynamics::effects::RadialForce {
            value: 1e3,
            direction: pitches * pitch,
            schedule: input::Schedule::Constant,
        }));
        let start = equilibrium_at(&model, 0.0).unwrap();
        model.effects.pop();
        model.effects.push(Box::new(dynamics::effects::RadialForce {
            value: 4e3,
            direction: pitches * pitch,
            schedule: input::Schedule::Constant,
        }));
        let course = from_equilibrium(&model, &start, conserving(5e-6), 100);
        let moved: Vec<f64> = course.last.forces.iter().map(|f| f.norm()).collect();
        (results(&start), moved)
    };
    let (usual, (mut rest, mut moved)) = (run(0.0), run(5.0));
    rest.rotate_left(15);
    moved.rotate_left(10);
    record.below("largest change at rest", worst(&usual.0, &rest), 1e-9);
    let scale = usual.1.iter().fold(0.0f64, |m, f| m.max(*f));
    let change = usual
        .1
        .iter()
        .zip(&moved)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    record.below(
        "largest change of a force after 100 steps over the largest force",
        change / scale,
        1e-6,
    );
}

fn mirrored_motion(record: &mut Record) {
    let run = |sign: f64| {
        let mut model = rigid(Load::dead(1e3), Load::dead(0.0));
        model.effects.push(Box::new(dynamics::effects::RadialForce {
            value: 2e3,
            direction: sign * 0.3,
            schedule: input::Schedule::Ramp {
                from: 0.0,
                to: 1.0,
                start: 0.0,
                duration: 1e-5,
            },
        }));
        let start = equilibrium_at(&model, 0.0).unwrap();
        let settings = MotionSettings {
            speeds: Speed::constant(sign * 6000.0 * RPM).into(),
            ..conserving(5e-6)
        };
        let course = from_equilibrium(&model, &start, settings, 400);
        record_free(&course.last)
    };
    let (there, mirrored) = (run(1.0), run(-1.0));
    record.near("x, m,", mirrored[0], there[0], 1e-9);
    record.near("y, m,", mirrored[1], -there[1], 1e-9);
    record.near("z, m,", mirrored[2], there[2], 1e-9);
}

fn record_free(state: &dynamics::motion::MotionState) -> [f64; 3] {
    [state.shaft[0], state.shaft[1], state.shaft[2]]
}

fn threads(record: &mut Record) {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut model = flexible(Load::dead(1e3), Load::dead(0.0));
            let start = equilibrium_at(&model, 0.0).unwrap();
            set_loads(&mut model, Load::dead(1e3), Load::dead(5e3));
            let speed = Speed::constant(6000.0 * RPM);
            from_equilibrium(
                &model,
                &start,
                MotionSettings {
                    speeds: speed.into(),
                    ..conserving(5e-6)
                },
                60,
            )
            .last
        })
    };
    let one = run(1);
    record.that("2 threads give the bits of 1", run(2) == one);
    record.that("5 threads give the bits of 1", run(5) == one);
}
