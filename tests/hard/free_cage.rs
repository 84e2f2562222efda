//! A free cage beside free balls: impacts, clearances and friction that may break a step.

use contact::Side;
use dynamics::interactions::cage::{Cage, Land};

use super::bearings::Load;
use super::free_balls::{CLOSED, Rolling};
use super::record::Record;
use super::{HardCase, Pace};

pub fn cases() -> Vec<HardCase> {
    let slow = |name, why, settings, run| HardCase::new(name, Pace::Slow, why, settings, run);
    vec![
        slow(
            "free_cage_without_clearance",
            "every ball touches its pocket on both sides at once, at every step",
            "rigid rings, 300 N, 1 kN radial, 4000 to 9000 rpm in 1 ms, outer land, no clearance, dt 10 us, 3 ms",
            |r| with_cage(cage(0.0), Some(Side::Outer)).holds(r),
        ),
        slow(
            "free_cage_with_1_mm_of_clearance",
            "the cage falls behind and is met by balls at speed",
            "the same with 1 mm of clearance, 30 N and 100 N radial, 20 ms",
            |r| {
                let case = with_cage(cage(1e-3), Some(Side::Outer));
                let case = Rolling {
                    axial: Load::dead(30.0),
                    radial: Load::dead(100.0),
                    ..case
                };
                case.with(20e-3).holds(r);
            },
        ),
        slow(
            "free_cage_friction_1",
            "friction in the pockets carries the cage radially: the engine of its whirl",
            "the same with 20 um of clearance and friction 1 in pockets and on the outer land",
            |r| {
                let case = Cage {
                    friction: 1.0,
                    ..cage(20e-6)
                };
                with_cage(case, Some(Side::Outer)).holds(r);
            },
        ),
        slow(
            "free_cage_dead_impacts",
            "restitution 0.05: the dissipation is 20 times the spring, and ends within a step",
            "the same with 20 um of clearance, friction 0.1, inner land",
            |r| {
                let case = Cage {
                    restitution: 0.05,
                    ..cage(20e-6)
                };
                with_cage(case, Some(Side::Inner)).holds(r);
            },
        ),
        slow(
            "free_cage_elastic_impacts",
            "restitution 1: nothing calms the cage",
            "the same with restitution 1, outer land",
            |r| {
                let case = Cage {
                    restitution: 1.0,
                    ..cage(20e-6)
                };
                with_cage(case, Some(Side::Outer)).holds(r);
            },
        ),
        slow(
            "free_cage_of_steel",
            "pockets of 1e10 N/m^1.5: impacts of 5 us in steps of 10",
            "the same with 20 um of clearance, restitution 0.6, inner land",
            |r| {
                let case = Cage {
                    stiffness: 1e10,
                    ..cage(20e-6)
                };
                with_cage(case, Some(Side::Inner)).holds(r);
            },
        ),
        slow(
            "free_cage_stop_dead",
            "10 000 rpm to a stand in 10 us: the balls run on into the pockets",
            "rigid rings, 300 N, 100 um of clearance, outer land with drag, dt 5 us, 5 ms",
            |r| {
                let case = with_cage(cage(100e-6), Some(Side::Outer));
                let stop = Rolling::run_up(10_000.0, 0.0, 1e-5);
                let case = Rolling {
                    dt: 5e-6,
                    speeds: stop.speeds,
                    radial: Load::dead(0.0),
                    ..case
                };
                case.with(5e-3).holds(r);
            },
        ),
        slow(
            "free_cage_light",
            "a cage of 0.1 g between balls of 3 g: accelerations of 1e5 m/s2",
            "rigid rings, 300 N, 1 kN radial, 4000 to 9000 rpm in 1 ms, 20 um, outer land, dt 10 us, 3 ms",
            |r| {
                let case = Cage {
                    mass: 1e-4,
                    polar: 1e-7,
                    transverse: 5e-8,
                    ..cage(20e-6)
                };
                with_cage(case, Some(Side::Outer)).holds(r);
            },
        ),
        slow(
            "free_cage_that_nothing_guides",
            "balls without load lag, and shift a cage that only pockets hold",
            "rigid rings, 300 N, 1 kN radial, 4000 to 9000 rpm in 1 ms, no clearance, no land, dt 10 us, 3 ms",
            unguided,
        ),
        slow(
            "free_cage_flexible",
            "all at once: elastic rings, friction, pockets and a land",
            "both rings flexible, 100 N, 60 N radial, 2000 to 10 000 rpm in 1 ms, 50 um of clearance, dt 10 us, 3 ms",
            |r| {
                let case = with_cage(cage(50e-6), Some(Side::Outer));
                let speeds = Rolling::run_up(2000.0, 10_000.0, 1e-3).speeds;
                let (axial, radial) = (Load::dead(100.0), Load::dead(60.0));
                let case = Rolling {
                    axial,
                    radial,
                    speeds,
                    is_flexible: true,
                    ..case
                };
                case.holds(r);
            },
        ),
    ]
}

/// A run with a cage.
fn with_cage(cage: Cage, guide: Option<Side>) -> Rolling {
    let land = guide.map(|side| Land {
        side,
        radius: if side == Side::Inner { 30e-3 } else { 35e-3 },
        width: 10e-3,
        clearance: 50e-6,
        viscosity: 0.01,
    });
    Rolling {
        axial: Load::dead(300.0),
        radial: Load::dead(1000.0),
        cage: Some(Cage { land, ..cage }),
        ..Rolling::run_up(4000.0, 9000.0, 1e-3)
    }
}

/// A cage of 12 g with a diametral clearance of its pockets, m.
pub fn cage(pocket_clearance: f64) -> Cage {
    Cage {
        mass: 0.012,
        polar: 1.2e-5,
        transverse: 6.5e-6,
        pocket_clearance,
        pocket_offsets: Vec::new(),
        stiffness: 2e8,
        restitution: 0.6,
        friction: 0.1,
        land: None,
    }
}

/// It must end with an error that says so, and close its ledger until then.
fn unguided(record: &mut Record) {
    let (course, _) = with_cage(cage(0.0), None).course(|_| ());
    record.says(
        course.error.as_deref().unwrap_or("none"),
        "pockets hold no cage along their own axes",
    );
    record.note_defect(course.defect);
    record.below("ledger defect", course.defect, CLOSED);
}
