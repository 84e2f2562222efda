//! Cases that may break a step: each ends, closes its ledger and heats.

use dynamics::interactions::traction::law::{Curve, CurvePoints, SlipTable};
use dynamics::interactions::traction::{Creep, PatchPoints, Traction, TractionLaw};
use dynamics::kinematics::{RingSpeeds, Speed};
use dynamics::motion::{Integrator, Ladder, Motion, MotionSettings, StepCache};

use super::bearings::{coulomb, freed, rpm, run, settings, thrust};
use crate::support::equilibrium;

struct Hard {
    name: &'static str,
    axial: f64,
    speed: Speed,
    traction: Traction,
    dt: f64,
    steps: usize,
}

fn ramp(from: f64, to: f64, over: f64) -> Speed {
    Speed::table(vec![0.0, over], vec![rpm(from), rpm(to)])
}

fn falling() -> Traction {
    Traction {
        law: TractionLaw::Curve(Curve::new(CurvePoints {
            at_rest: 0.0,
            most: 0.09,
            slip_of_most: 0.02,
            at_large: 0.02,
        })),
        creep: Creep::Elastic,
        places: PatchPoints::new([3, 15]),
    }
}

fn falling_table() -> Traction {
    let (slips, values) = (vec![0.0, 0.005, 0.02, 0.5], vec![0.0, 0.09, 0.04, 0.02]);
    Traction {
        law: TractionLaw::Table(SlipTable::new(slips, values)),
        ..falling()
    }
}

fn cases() -> Vec<Hard> {
    let case = |name, axial, speed, traction, dt, steps| Hard {
        name,
        axial,
        speed,
        traction,
        dt,
        steps,
    };
    let usual = || coulomb(0.07, Creep::Elastic);
    let constant = |n: f64| Speed::constant(rpm(n));
    vec![
        case(
            "friction 1",
            2000.0,
            constant(3000.0),
            coulomb(1.0, Creep::Elastic),
            1e-5,
            60,
        ),
        case("40 000 rpm", 2000.0, constant(40_000.0), usual(), 1e-5, 60),
        case("light load", 5.0, constant(3000.0), usual(), 1e-5, 60),
        case("reversal", 1000.0, ramp(300.0, -300.0, 6e-4), usual(), 1e-5, 60),
        case("stop", 1000.0, ramp(10_000.0, 0.0, 6e-4), usual(), 1e-5, 80),
        case("from rest", 1000.0, ramp(0.0, 2000.0, 1e-3), usual(), 1e-5, 60),
        case(
            "falling curve",
            1000.0,
            ramp(1000.0, 1800.0, 5e-4),
            falling(),
            1e-5,
            60,
        ),
        case(
            "falling table",
            1000.0,
            ramp(1000.0, 1800.0, 5e-4),
            falling_table(),
            1e-5,
            60,
        ),
        case("small step", 1000.0, constant(3000.0), usual(), 1e-6, 60),
        case("large step", 1000.0, constant(3000.0), usual(), 2e-5, 60),
        case("bearing at rest", 1000.0, constant(0.0), usual(), 1e-5, 20),
    ]
}

/// Wrong: friction would be solved only where it is easy.
#[test]
fn hard_cases_end_with_a_closed_ledger_and_heat_that_never_falls() {
    for hard in cases() {
        let speeds = RingSpeeds::from(hard.speed);
        let model = freed(thrust(hard.axial), hard.traction, &speeds);
        let settings = MotionSettings {
            ladder: Ladder {
                halvings: 4,
                tolerance: None,
            },
            ..settings(hard.dt, &speeds)
        };
        let motion = Motion::new(&model, settings).unwrap();
        let start = motion.start(&equilibrium(&model));
        let (mut loss, mut worst) = (0.0, 0.0f64);
        let last = run(&motion, start, hard.steps, |state| {
            let friction = state.ledger.friction.unwrap();
            assert!(
                friction.loss >= loss,
                "{}: {} after {loss}",
                hard.name,
                friction.loss
            );
            loss = friction.loss;
            worst = worst.max(state.ledger.relative_defect().abs());
        });
        println!("{}: defect {worst:e} {:?}", hard.name, last.ledger.friction);
        assert!(worst < 1e-9, "{}: {worst}", hard.name);
    }
}

/// Wrong: balls would pass through each other, or an integrator that dissipates be taken with another's equations.
#[test]
fn what_free_balls_cannot_do_is_said() {
    let speeds = RingSpeeds::default();
    let model = freed(thrust(1000.0), coulomb(0.07, Creep::Elastic), &speeds);
    let conserving = settings(1e-5, &speeds);
    let motion = Motion::new(&model, conserving.clone()).unwrap();
    let mut start = motion.start(&equilibrium(&model));
    let free = start.free.as_mut().unwrap();
    let [x, y, z] = free.places[3];
    free.places[4] = [x - 1e-3 * y / x.hypot(y), y + 1e-3 * x / x.hypot(y), z];
    let error = motion
        .step(&start, &mut StepCache::default())
        .unwrap_err()
        .to_string();
    let expected = "balls 3 and 4 run into each other: orbits that differ bring free balls together; give them a \
                    cage, [cage] with motion = \"free\", or load the bearing so that all balls roll alike";
    assert!(error.ends_with(expected), "{error}");
    let mut caged = thrust(1000.0);
    caged.cage = Some(dynamics::interactions::cage::Cage {
        pocket_clearance: 5e-3,
        ..super::cage::cage()
    });
    let caged = freed(caged, coulomb(0.07, Creep::Elastic), &speeds);
    let moving = Motion::new(&caged, conserving.clone()).unwrap();
    let mut start = moving.start(&equilibrium(&caged));
    start.free.as_mut().unwrap().cage.as_mut().unwrap().place[0] = 2.3e-3;
    let error = moving
        .step(&start, &mut StepCache::default())
        .unwrap_err()
        .to_string();
    let expected = "the cage stands 2.300 mm off the axis, beyond 2.250 mm, a quarter of a ball diameter: pockets hold \
                    no cage along their own axes, and balls that lag shift it; guide it by a land, cage.guidance = \
                    \"outer_land\" or \"inner_land\"";
    assert!(error.ends_with(expected), "{error}");
    let dissipating = MotionSettings {
        integrator: Integrator::chung_hulbert(0.8),
        ..conserving
    };
    let error = Motion::new(&model, dissipating).err().unwrap().to_string();
    assert_eq!(
        error,
        "a moving bearing cannot have balls.motion = \"free\" with an integrator that dissipates; use integrator = \
         \"average_acceleration\" in this version"
    );
}
