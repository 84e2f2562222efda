//! Energy, momentum and their order in the step.

use dynamics::effects::RadialForce;
use dynamics::interactions::traction::Creep;
use dynamics::kinematics::{RingSpeeds, Speed};
use dynamics::motion::{Motion, MotionState, StepCache};
use input::Schedule;

use super::bearings::{coulomb, freed, rpm, run, settings, thrust};
use crate::support::equilibrium;

/// Thrust and a radial force that unloads some balls, while the speed rises from 2000 to 3000 rpm within a
/// millisecond.
fn speed_change(mu: f64, dt: f64, duration: f64, mut note: impl FnMut(&MotionState)) -> MotionState {
    let speeds = RingSpeeds::from(Speed::table(vec![0.0, 1e-3], vec![rpm(2000.0), rpm(3000.0)]));
    let mut model = freed(thrust(200.0), coulomb(mu, Creep::Elastic), &speeds);
    model.effects.push(Box::new(RadialForce {
        value: 3000.0,
        direction: 0.0,
        schedule: Schedule::Constant,
    }));
    let motion = Motion::new(&model, settings(dt, &speeds)).unwrap();
    let start = motion.start(&equilibrium(&model));
    run(&motion, start, (duration / dt).round() as usize, &mut note)
}

/// Wrong: energy would appear or go without a line in the ledger, or friction give some back. 18 balls, some of which
/// lose their contacts; 1e-9 of the largest energy.
#[test]
fn the_ledger_closes_and_the_heat_of_friction_never_falls() {
    let (mut loss, mut worst, mut open) = (0.0, 0.0f64, 0);
    let last = speed_change(0.07, 1e-5, 2e-3, |state| {
        let friction = state.ledger.friction.unwrap();
        assert!(friction.loss >= loss, "{} after {loss}", friction.loss);
        loss = friction.loss;
        worst = worst.max(state.ledger.relative_defect().abs());
        open += state.approaches.iter().filter(|d| **d <= 0.0).count();
    });
    println!("defect {worst:e} {:?} open {open}", last.ledger.friction);
    assert!(worst < 1e-9, "{worst}");
    assert!(open > 0, "some balls lose a contact");
}

/// Wrong: the integrator would take part of the energy that does not go away with the step. Its share halves with it.
#[test]
fn the_integrators_share_of_friction_halves_with_the_step() {
    let share = |dt: f64| {
        let last = speed_change(0.07, dt, 1e-3, |_| {});
        let friction = last.ledger.friction.unwrap();
        [friction.integrator_share, friction.loss]
    };
    let (coarse, fine) = (share(4e-6), share(2e-6));
    println!("{coarse:?} {fine:?}");
    let ratio = fine[0] / coarse[0];
    assert!((ratio - 0.5).abs() < 0.1, "{ratio}");
}

/// Wrong: a frictionless ball would be turned, or its orbit driven: without traction each keeps its angular velocity,
/// and under thrust its moment of momentum about the axis.
#[test]
fn without_friction_balls_keep_their_turning_and_their_moment_of_momentum() {
    let speeds = RingSpeeds::from(Speed::constant(rpm(5000.0)));
    let model = freed(thrust(2000.0), coulomb(0.0, Creep::Elastic), &speeds);
    let motion = Motion::new(&model, settings(1e-5, &speeds)).unwrap();
    let start = motion.start(&equilibrium(&model));
    let moment = |state: &MotionState, ball: usize| {
        let free = state.free.as_ref().unwrap();
        let [x, y, _] = free.places[ball];
        free.orbit(ball) * (x * x + y * y)
    };
    let first = start.clone();
    let last = run(&motion, start, 300, |_| {});
    let (from, to) = (first.free.as_ref().unwrap(), last.free.as_ref().unwrap());
    for ball in 0..18 {
        let size = from.turnings[ball].iter().map(|w| w * w).sum::<f64>().sqrt();
        for (a, b) in from.turnings[ball].iter().zip(to.turnings[ball]) {
            assert!((a - b).abs() < 1e-12 * size, "{a} {b}");
        }
        let (a, b) = (moment(&first, ball), moment(&last, ball));
        assert!((b / a - 1.0).abs() < 1e-10, "{}", b / a - 1.0);
    }
}

/// Wrong: a resumed run would differ from one that went on: the state is all that evolves.
#[test]
fn a_motion_from_a_stored_state_has_the_same_bits() {
    let speeds = RingSpeeds::from(Speed::constant(rpm(5000.0)));
    let model = freed(thrust(500.0), coulomb(0.07, Creep::Elastic), &speeds);
    let motion = Motion::new(&model, settings(1e-5, &speeds)).unwrap();
    let start = motion.start(&equilibrium(&model));
    let through = run(&motion, start.clone(), 20, |_| {});
    let mut state = start;
    for _ in 0..20 {
        (state, _) = motion.step(&state.clone(), &mut StepCache::default()).unwrap();
    }
    assert_eq!(format!("{through:?}"), format!("{state:?}"));
}
