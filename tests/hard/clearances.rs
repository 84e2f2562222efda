//! Clearances, preload and contact laws: what a load jump meets.

use contact::Side;
use dynamics::motion::{Integrator, MotionSettings};
use dynamics::{Model, ShaftDof};

use super::bearings::{Load, conserving, equilibrium_at, released, rigid, set_loads, transient};
use super::record::{LEDGER, Record};
use super::{HardCase, Pace};

use super::loads::{
    SETTLED, bounded, jump, plot, preloaded_then_radial, settling, undamped_jump, with_damping,
};
use super::swings;

/// Axial and radial load of the cases on clearance, N.
const CLEARANCE_LOADS: [f64; 2] = [500.0, 1e3];
/// Diametral clearance that leaves seven of 18 balls loose under these loads, m.
const LARGE_CLEARANCE: f64 = 50e-6;

pub fn cases() -> Vec<HardCase> {
    let mut cases = clearances();
    cases.extend(contacts());
    cases
}

fn clearances() -> Vec<HardCase> {
    let case = |name, why, settings, run| HardCase::new(name, Pace::Slow, why, settings, run);
    vec![
        case(
            "no_preload",
            "no axial load at all: 1 kN radial comes in 10 us on balls that just touch",
            "rigid rings, shaft 0.5 kg, all free but the tilts, dt 5 us, 10 ms",
            no_preload,
        ),
        case(
            "zero_clearance",
            "free contact angle 0: axial stiffness starts from nothing",
            "P_d = 0, 500 N axial and 1 kN radial in 10 us, dt 5 us, 10 ms",
            |r| clearance(r, 0.0),
        ),
        case(
            "interference",
            "balls pressed on both raceways without a load",
            "P_d = -20 um, the same loads",
            |r| clearance(r, -20e-6),
        ),
        case(
            "large_clearance",
            "balls on the unloaded side are far from touching; the last that carry swing long",
            "P_d = 50 um, the same loads; with damping 160 ms",
            large_clearance,
        ),
        case(
            "huge_clearance_motion",
            "contact angle 41 deg; loose balls swing out of what a groove can be",
            "P_d = 0.2 mm, the same loads, no damping",
            huge_clearance,
        ),
        case(
            "pure_radial",
            "few balls carry, the others are loose; nothing pushes along the axis",
            "radial 200 N to 2 kN in 10 us, axial motion locked, dt 5 us, 10 ms",
            pure_radial,
        ),
    ]
}

fn contacts() -> Vec<HardCase> {
    let case = |name, why, settings, run| HardCase::new(name, Pace::Fast, why, settings, run);
    let loads = "half_the_balls_unload with these contacts";
    vec![
        case(
            "damping_zero",
            "a coefficient of zero must be the undamped bearing, bit for bit",
            loads,
            no_damping,
        ),
        case(
            "damping_huge",
            "1e6 N s/m: a thousand times critical",
            loads,
            |r| damped(r, 1e6, 1e-6),
        ),
        case(
            "damping_sudden",
            "d0 = 1 pm: the damping jumps at touch",
            loads,
            |r| damped(r, 50.0, 1e-12),
        ),
        case(
            "contacts_x100",
            "K x 100: a ball's period is a tenth of 23 us, half a step",
            loads,
            |r| stiffer(r, 1e2),
        ),
        case(
            "contacts_x1e4",
            "K x 1e4: a ball's period is 0.23 us, a twentieth of a step",
            loads,
            |r| stiffer(r, 1e4),
        ),
    ]
}

fn no_preload(record: &mut Record) {
    let model = rigid(Load::dead(0.0), Load::jump(0.0, 1e3));
    let course = released(&model, conserving(5e-6), [0.0; 5], 10e-3);
    record.closed(&course);
    bounded(record, &model, &course, 10e-3);
    record.plot = plot(&course);
}

fn clearance(record: &mut Record, clearance: f64) {
    let model = with_clearance(record, clearance);
    jump(record, &model, 10e-3);
}

/// Balls at the end of the loaded side carry a few newtons and swing for long, so it takes more than one time to see
/// where the bearing settles.
fn large_clearance(record: &mut Record) {
    let model = with_clearance(record, LARGE_CLEARANCE);
    undamped_jump(record, &model, 10e-3);
    let held_back = |[axial, radial]: [f64; 2]| {
        let mut model = with_clearance(&mut Record::default(), LARGE_CLEARANCE);
        let [dead, across] = CLEARANCE_LOADS;
        set_loads(&mut model, Load::dead(dead - axial), Load::dead(across - radial));
        model
    };
    // Off by the usual share after one span, and by half of that after each of two more.
    swings::die_out(record, (&model, settling()), held_back, SETTLED / 4.0);
}

fn with_clearance(record: &mut Record, clearance: f64) -> Model {
    let [axial, radial] = CLEARANCE_LOADS;
    let mut model = rigid(Load::dead(axial), Load::jump(0.0, radial));
    let g = &mut model.geometry;
    g.outer_raceway_diameter = g.inner_raceway_diameter + 2.0 * g.ball_diameter + clearance;
    g.validate().unwrap();
    record.note(format!(
        "free contact angle {:.1} deg",
        g.free_contact_angle().to_degrees()
    ));
    model
}

/// Loose balls swing up their grooves; where one passes 90 deg, the motion must end there and say so.
fn huge_clearance(record: &mut Record) {
    let model = with_clearance(record, 0.2e-3);
    let course = transient(&model, conserving(5e-6), 10e-3);
    record.note_defect(course.defect);
    record.below("ledger defect", course.defect, LEDGER);
    record.that("all numbers are finite", course.is_finite());
    match &course.error {
        Some(error) => record.says(error, "but no groove reaches beyond 90 deg"),
        None => bounded(record, &model, &course, 10e-3),
    }
    record.plot = plot(&course);
}

fn pure_radial(record: &mut Record) {
    let mut model = rigid(Load::dead(0.0), Load::jump(200.0, 2e3));
    model.shaft[2] = ShaftDof::Prescribed(0.0);
    let course = transient(&model, conserving(5e-6), 10e-3);
    record.closed(&course);
    bounded(record, &model, &course, 10e-3);
    let rest = equilibrium_at(&model, 10e-3).unwrap().displacements.shaft[0];
    record.near("mean place, m,", course.mean_shaft[0], rest, 0.25);
}

fn unloading() -> Model {
    preloaded_then_radial(rigid(Load::dead(100.0), Load::jump(0.0, 3e3)))
}

fn no_damping(record: &mut Record) {
    let model = unloading();
    let (with, without) = (
        transient(&model, with_damping(0.0, 1e-6), 3e-3),
        transient(&model, conserving(5e-6), 3e-3),
    );
    record.closed(&with);
    record.that("the states are the same bits", with.last == without.last);
    record.that("nothing is lost to damping", with.last.ledger.contact_loss == 0.0);
}

fn damped(record: &mut Record, coefficient: f64, full_approach: f64) {
    let model = unloading();
    let course = transient(&model, with_damping(coefficient, full_approach), 10e-3);
    record.closed(&course);
    record.that(
        "losses only grow",
        course.losses_grow && course.last.ledger.contact_loss > 0.0,
    );
    bounded(record, &model, &course, 10e-3);
    let rest = equilibrium_at(&model, 10e-3).unwrap().displacements.shaft[0];
    let mean = course.mean_shaft[0];
    // Heavy damping creeps: it is on its way, not beyond.
    record.that(
        "the mean place lies between start and equilibrium, or a quarter beyond",
        0.0 < mean && mean < 1.25 * rest,
    );
    record.note(format!(
        "mean x {:.2} um of {:.2} um; {:.1} mJ of {:.1} mJ lost to damping",
        1e6 * mean,
        1e6 * rest,
        1e3 * course.last.ledger.contact_loss,
        1e3 * course.last.ledger.largest
    ));
    record.plot = plot(&course);
}

fn stiffer(record: &mut Record, factor: f64) {
    let mut model = rigid(Load::dead(100.0), Load::jump(0.0, 3e3));
    model.hertz = Side::BOTH.map(|s| {
        let h = model.hertz[s.index()];
        h.with_stiffness(factor * h.stiffness)
    });
    let model = preloaded_then_radial(model);
    let course = transient(&model, conserving(5e-6), 10e-3);
    record.closed(&course);
    bounded(record, &model, &course, 10e-3);
    let damped = MotionSettings {
        integrator: Integrator::chung_hulbert(0.5),
        ..conserving(5e-6)
    };
    let damped = transient(&model, damped, 10e-3);
    record.closed(&damped);
    let rest = equilibrium_at(&model, 10e-3).unwrap().displacements.shaft[0];
    record.near(
        "mean place with chung_hulbert 0.5, m,",
        damped.mean_shaft[0],
        rest,
        0.25,
    );
    record.plot = plot(&course);
}
