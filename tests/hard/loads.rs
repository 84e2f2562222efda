//! Loads and clearances of a bearing: jumps, reversals, impacts, balls that unload.

use dynamics::interactions::contact_damping::ContactDamping;
use dynamics::motion::{Integrator, Motion, MotionSettings};
use dynamics::{Model, ShaftDof};
use input::Schedule;

use super::bearings::{
    Load, add_moment, conserving, equilibrium_at, flexible, largest_ball_force, released, rigid, transient,
};
use super::course::{Course, march};
use super::plot::Plot;
use super::record::Record;
use super::{HardCase, Pace};

pub fn cases() -> Vec<HardCase> {
    let case = HardCase::new;
    vec![
        case(
            "radial_step_x10",
            Pace::Fast,
            "200 N to 2 kN in 10 us: half a period of the ball contacts",
            "1 kN axial, rigid rings, shaft 0.5 kg, dt 5 us, 10 ms",
            |r| jump(r, &rigid(Load::dead(1e3), Load::jump(200.0, 2e3)), 10e-3),
        ),
        case(
            "radial_step_x10_flexible",
            Pace::Slow,
            "the same with rings that answer",
            "both rings flexible, 2 x 2 052 dofs, dt 5 us, 3 ms",
            |r| jump(r, &flexible(Load::dead(1e3), Load::jump(200.0, 2e3)), 3e-3),
        ),
        case(
            "axial_2_to_20_kn",
            Pace::Fast,
            "ten times the load in 10 us",
            "rigid rings, shaft 0.5 kg, dt 5 us, 10 ms",
            |r| jump(r, &rigid(Load::jump(2e3, 20e3), Load::dead(0.0)), 10e-3),
        ),
        case(
            "axial_2_to_20_kn_flexible",
            Pace::Slow,
            "the same with rings that answer",
            "both rings flexible, dt 5 us, 3 ms",
            |r| jump(r, &flexible(Load::jump(2e3, 20e3), Load::dead(0.0)), 3e-3),
        ),
        case(
            "axial_2000_to_100_n",
            Pace::Fast,
            "the ring is thrown out of its balls: all contacts open",
            "rigid rings, shaft 0.5 kg, dt 5 us, 10 ms",
            unloaded,
        ),
        case(
            "axial_2000_to_100_n_flexible",
            Pace::Slow,
            "the same with rings that answer",
            "both rings flexible, dt 5 us, 3 ms",
            unloaded_flexible,
        ),
        case(
            "half_the_balls_unload",
            Pace::Fast,
            "3 kN radial on 100 N of preload in 10 us: half the balls lose contact and meet it again",
            "rigid rings, shaft 0.5 kg, axial motion locked at its place, dt 5 us, 10 ms",
            half_unload,
        ),
        case(
            "half_the_balls_unload_flexible",
            Pace::Slow,
            "the same with rings that answer",
            "both rings flexible, dt 5 us, 3 ms",
            half_unload_flexible,
        ),
        case(
            "reversing_load",
            Pace::Fast,
            "radial 2 kN at 200 Hz, through zero 400 times a second",
            "500 N axial, rigid rings, shaft 0.5 kg, dt 5 us, 20 ms",
            reversing,
        ),
        case(
            "reversing_thrust",
            Pace::Fast,
            "axial 1 kN at 300 Hz: the balls change from one flank of the grooves to the other",
            "rigid rings, shaft 0.5 kg, started at rest in the middle, dt 5 us, 20 ms",
            reversing_thrust,
        ),
        case(
            "impact_50_us",
            Pace::Fast,
            "half sine of 10 kN in 50 us, two periods of a ball",
            "1 kN axial, rigid rings, shaft 0.5 kg, dt 5 us, 5 ms",
            impact,
        ),
        case(
            "impulse_of_a_short_pulse",
            Pace::Fast,
            "a pulse of 50 us must give its whole impulse, also in steps of twice its length",
            "half sine of 5 N on a shaft that touches no ball, every integrator, dt 20 to 100 us, 4 ms",
            short_pulse,
        ),
        case(
            "tilted_by_a_moment",
            Pace::Fast,
            "20 N m on free tilts in 0 s: the tilts have no mass of their own with rigid rings",
            "1 kN axial, rigid rings, shaft 0.5 kg, dt 5 us, 5 ms",
            moment,
        ),
    ]
}

/// Share of its displacement by which a damped bearing may still be off its equilibrium.
pub const SETTLED: f64 = 0.02;
/// Share of the largest energy that the moving of patches may give or take.
const PUMPED: f64 = 0.05;

/// Shaft x and z over time.
pub fn plot(course: &Course) -> Option<Plot> {
    Some(Plot {
        x: "time, ms",
        y: "shaft displacement, um",
        curves: vec![course.curve("x", 0), course.curve("z", 1)],
    })
}

/// Bounded by twice the static answer and a share, since a load that comes at once does at most twice its static work.
pub fn bounded(record: &mut Record, model: &Model, course: &Course, end: f64) {
    let rest = equilibrium_at(model, end).unwrap();
    let peak = largest_ball_force(&rest);
    record.below("largest contact force", course.peak, 3.5 * peak);
    pumped(record, course);
    record.note(format!(
        "largest force {:.0} N (at rest {peak:.0} N), up to {} of {} contacts open",
        course.peak,
        course.open,
        course.last.forces.len()
    ));
}

/// Patches that move and change their size with the contacts must not drive the motion: the ledger closes all the
/// same if they do.
fn pumped(record: &mut Record, course: &Course) {
    let ledger = &course.last.ledger;
    if course.last.rings.iter().any(Option::is_some) {
        let share = ledger.patch_work.abs() / ledger.largest;
        record.below("work of moving patches over the largest energy", share, PUMPED);
    }
}

/// A jump between two equilibria: ledger and bounds without damping; with damping the settled place against statics.
pub fn jump(record: &mut Record, model: &Model, duration: f64) {
    undamped_jump(record, model, duration);
    settled(record, model, duration);
}

/// A jump without damping: ledger, bounds and plot.
pub fn undamped_jump(record: &mut Record, model: &Model, duration: f64) {
    let course = transient(model, conserving(5e-6), duration);
    record.closed(&course);
    bounded(record, model, &course, duration);
    record.plot = plot(&course);
}

/// Contact damping, and an integrator that damps what the contacts cannot.
pub fn settling() -> MotionSettings {
    MotionSettings {
        dt: 1e-5,
        integrator: Integrator::chung_hulbert(0.5),
        ..with_damping(500.0, 1e-6)
    }
}

/// With damping the bearing comes to the equilibrium of its load.
fn settled(record: &mut Record, model: &Model, end: f64) {
    let settings = settling();
    let coming = transient(model, settings.clone(), 2.0 * end);
    record.closed(&coming);
    let steps = (0.2 * end / settings.dt) as usize;
    let motion = Motion::new(model, settings).unwrap();
    let mean = march(&motion, coming.last, steps).mean_shaft;
    let rest = equilibrium_at(model, end).unwrap().displacements.shaft;
    let size = |q: [f64; 5]| q[0].hypot(q[1]).hypot(q[2]);
    let off = size([0, 1, 2, 3, 4].map(|i| mean[i] - rest[i]));
    record.below(
        "settled place off the static one, share,",
        off / size(rest),
        SETTLED,
    );
}

fn unloaded(record: &mut Record) {
    let model = rigid(Load::jump(2e3, 100.0), Load::dead(0.0));
    thrown_out(record, &model, 10e-3);
}

fn unloaded_flexible(record: &mut Record) {
    let model = flexible(Load::jump(2e3, 100.0), Load::dead(0.0));
    thrown_out(record, &model, 3e-3);
}

/// The ring leaves its balls: energy bounds how far, and what they meet with again.
fn thrown_out(record: &mut Record, model: &Model, duration: f64) {
    let course = transient(model, conserving(5e-6), duration);
    record.closed(&course);
    record.that("contacts open", course.open > 0);
    let before = largest_ball_force(&equilibrium_at(model, 0.0).unwrap());
    // Undamped, it cannot come back harder than it left, balls added.
    record.below("largest force over that before", course.peak / before, 2.0);
    record.note(format!("up to {} contacts open", course.open));
    record.plot = plot(&course);
}

pub fn preloaded_then_radial(mut model: Model) -> Model {
    let rest = equilibrium_at(&model, 0.0).unwrap();
    model.shaft[2] = ShaftDof::Prescribed(rest.displacements.shaft[2]);
    model
}

fn half_unload(record: &mut Record) {
    let model = preloaded_then_radial(rigid(Load::dead(100.0), Load::jump(0.0, 3e3)));
    half_of(record, &model, 10e-3);
}

fn half_unload_flexible(record: &mut Record) {
    let model = preloaded_then_radial(flexible(Load::dead(100.0), Load::jump(0.0, 3e3)));
    half_of(record, &model, 3e-3);
}

fn half_of(record: &mut Record, model: &Model, duration: f64) {
    let course = transient(model, conserving(5e-6), duration);
    record.closed(&course);
    bounded(record, model, &course, duration);
    record.that("at least half the balls are loose at a time", course.open >= 18);
    let rest = equilibrium_at(model, duration).unwrap().displacements.shaft[0];
    record.near("mean place, m,", course.mean_shaft[0], rest, 0.25);
    record.plot = plot(&course);
}

fn reversing(record: &mut Record) {
    let wave = Schedule::Harmonic {
        frequency: 200.0,
        phase: 0.0,
        mean: 0.0,
        amplitude: 1.0,
    };
    let model = rigid(Load::dead(500.0), Load(2e3, wave));
    let course = transient(&model, conserving(5e-6), 20e-3);
    record.closed(&course);
    // Four whole periods: the mean of x is zero by symmetry.
    let largest = equilibrium_at(&model, 1.25e-3).unwrap();
    record.below(
        "mean x over the largest static one",
        course.mean_shaft[0].abs() / largest.displacements.shaft[0],
        0.2,
    );
    record.below(
        "largest force over the largest static one",
        course.peak / largest_ball_force(&largest),
        3.5,
    );
    record.plot = plot(&course);
}

fn reversing_thrust(record: &mut Record) {
    let wave = Schedule::Harmonic {
        frequency: 300.0,
        phase: 0.0,
        mean: 0.0,
        amplitude: 1.0,
    };
    let model = rigid(Load(1e3, wave), Load::dead(0.0));
    let middle = -model.geometry.axial_offset();
    let course = released(&model, conserving(5e-6), [0.0, 0.0, middle, 0.0, 0.0], 20e-3);
    record.closed(&course);
    record.that("both flanks are met", course.open > 0 && course.peak > 50.0);
    record.below("largest force, N,", course.peak, 3e3);
    record.plot = plot(&course);
}

fn impact(record: &mut Record) {
    let pulse = Schedule::Impact {
        start: 0.0,
        duration: 50e-6,
    };
    let model = rigid(Load::dead(1e3), Load(10e3, pulse));
    let course = transient(&model, conserving(5e-6), 5e-3);
    record.closed(&course);
    // The impulse of a half sine, 2 F T / pi, is what the shaft gets at most.
    let speed = 2.0 * 10e3 * 50e-6 / std::f64::consts::PI / model.shaft_mass;
    let energy = 0.5 * model.shaft_mass * speed * speed;
    record.below(
        "work of the impact over that on a free shaft",
        course.last.ledger.load_work / energy,
        1.0,
    );
    record.plot = plot(&course);
}

fn short_pulse(record: &mut Record) {
    let force = 5.0;
    let pulse = Schedule::Impact {
        start: 112e-6,
        duration: 50e-6,
    };
    let model = rigid(Load::dead(0.0), Load(force, pulse));
    // Where the balls stand across the inner groove: 5 um of gap, of which the flight takes 1.3.
    let across = -model.geometry.axial_offset() * 3.0 / 8.0;
    let speed = 2.0 * force * 50e-6 / std::f64::consts::PI / model.shaft_mass;
    let mut worst = 0.0f64;
    for (_, integrator, scheme) in super::steps::settings() {
        for dt in [20e-6, 50e-6, 100e-6] {
            let settings = MotionSettings {
                integrator,
                scheme,
                ..conserving(dt)
            };
            let course = released(&model, settings, [0.0, 0.0, across, 0.0, 0.0], 4e-3);
            record.closed(&course);
            record.that("nothing touches", course.peak == 0.0);
            worst = worst.max((course.last.shaft_velocity[0] / speed - 1.0).abs());
        }
    }
    record.below("speed after the pulse, off by", worst, 1e-9);
}

fn moment(record: &mut Record) {
    let mut model = rigid(Load::dead(1e3), Load::dead(0.0));
    model.shaft[3] = ShaftDof::Free;
    model.shaft[4] = ShaftDof::Free;
    let start = equilibrium_at(&model, 0.0).unwrap();
    add_moment(&mut model, 20.0);
    let course = super::course::from_equilibrium(&model, &start, conserving(5e-6), 1000);
    record.closed(&course);
    let rest = equilibrium_at(&model, 0.0).unwrap();
    record.near(
        "mean tilt, rad,",
        course.mean_shaft[3],
        rest.displacements.shaft[3],
        0.1,
    );
}

pub fn with_damping(coefficient: f64, full_approach: f64) -> MotionSettings {
    MotionSettings {
        contact_damping: Some(ContactDamping {
            coefficient,
            full_approach,
        }),
        ..conserving(5e-6)
    }
}
