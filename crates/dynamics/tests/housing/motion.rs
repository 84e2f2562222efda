//! A ring tied to a moving body: against a rigid partner, against ring and body meshed as one, its energy and its bits.

use std::sync::Arc;

use body::SeatTie;
use contact::Side;
use dynamics::effects::RingDamping;
use dynamics::kinematics::Speed;
use dynamics::motion::{Integrator, Motion, MotionSettings, MotionState, StepCache};
use dynamics::{Backend, Hold, Model, RingModel, ShaftDof};

use super::{
    bearing, difference, equilibrium, every_fifth, harmonics, outer, space, surrounding, tied, tube,
};
use crate::support::{on_threads, steel};

/// Step, s.
const STEP: f64 = 1e-5;

/// The outer ring on a body that moves, with its modes below a frequency, Hz.
pub fn on_moving_body(mesh: mesh::Mesh, n: usize, below: f64) -> RingModel {
    let space = space(&outer(Hold::MeanMotion), harmonics(n, 2));
    let body = surrounding(mesh, space, steel());
    let modes = Arc::new(body.modes(below).unwrap());
    tied(SeatTie::to_seat(Arc::new(body), 0).in_motion(modes))
}

/// A bearing whose shaft has a mass and is free to be struck, across and along.
pub fn struck(outer: RingModel, backend: Backend) -> Model {
    let mut model = bearing(outer, backend);
    model.shaft_mass = 0.5;
    model.shaft[0] = ShaftDof::Free;
    model.shaft[1] = ShaftDof::Free;
    model
}

fn settings() -> MotionSettings {
    MotionSettings::conserving(STEP, Speed::constant(100.0))
}

/// States of the motion after a blow of 0.05 m/s across and 0.03 m/s along the shaft, every fifth of `n` steps.
fn course(model: &Model, settings: MotionSettings, n: usize) -> Vec<MotionState> {
    let motion = Motion::new(model, settings).unwrap();
    let mut state = motion.start(&equilibrium(model));
    state.shaft_velocity = [0.05, 0.0, 0.03, 0.0, 0.0];
    let state = motion.with_energies(state);
    every_fifth(&motion, motion.with_accelerations(state).unwrap(), n)
}

/// Displacements of the shaft and forces on a ring over a course.
pub fn histories_of(states: &[MotionState], side: Side) -> [Vec<f64>; 2] {
    let shaft = states.iter().flat_map(|state| state.shaft[..3].to_vec());
    let ring = states
        .iter()
        .flat_map(|s| s.forces.iter().skip(side.index()).step_by(2));
    [shaft.collect(), ring.flat_map(|force| force.to_array()).collect()]
}

/// The same of the outer ring.
fn histories(states: &[MotionState]) -> [Vec<f64>; 2] {
    histories_of(states, Side::Outer)
}

/// Wrong: the joint would hold a moving ring more or less than the mean motion when it ties nothing else.
#[test]
fn the_six_rigid_functions_on_a_rigid_body_are_the_mean_motion() {
    let held = outer(Hold::MeanMotion);
    let rigid = tied(SeatTie::to_rigid(space(&held, body::SeatBasis::Rigid)));
    let expected = histories(&course(&struck(held, Backend::Auto), settings(), 40));
    let found = histories(&course(&struck(rigid, Backend::Auto), settings(), 40));
    for (found, expected) in found.iter().zip(&expected) {
        let off = difference(found, expected);
        assert!(off < 1e-8, "{off:e}");
    }
}

/// Wrong: ring and housing would move otherwise than the body that they are together.
#[test]
fn ring_and_housing_move_as_one_mesh() {
    let (own, both) = tube(&outer(Hold::Clamped), 3);
    let one = RingModel {
        mesh: both,
        held_group: "feet",
        ..outer(Hold::Clamped)
    };
    let expected = histories(&course(&struck(one, Backend::Sparse), settings(), 60));
    let mut errors = Vec::new();
    for (n, below) in [(4, 1e3), (12, 1e3), (12, 60e3)] {
        let ring = on_moving_body(own.clone(), n, below);
        let found = histories(&course(&struck(ring, Backend::Auto), settings(), 60));
        errors.push([0, 1].map(|i| difference(&found[i], &expected[i])));
    }
    println!("shaft and forces: {errors:?}");
    let [shaft, forces] = errors[2];
    assert!(shaft < 3e-3 && forces < 1e-2, "{errors:?}");
    assert!(errors[2][0] < errors[0][0], "{errors:?}");
}

/// Wrong: the joint or the body would make or eat energy, with an integrator that conserves, one that dissipates, and
/// with damping. An integrator that remembers an acceleration may give a part of its loss back for a while.
#[test]
fn the_ledger_closes_and_losses_take_energy() {
    let (own, _) = tube(&outer(Hold::Clamped), 2);
    let dissipating = MotionSettings {
        integrator: Integrator::hht(0.1),
        ..settings()
    };
    let damped = MotionSettings {
        rayleigh: RingDamping {
            mass: 20.0,
            stiffness: 1e-7,
        },
        ..settings()
    };
    for (of, settings) in [
        ("kept", settings()),
        ("integrator", dissipating),
        ("damping", damped),
    ] {
        let model = struck(on_moving_body(own.clone(), 6, 20e3), Backend::Auto);
        let states = course(&model, settings, 60);
        let mut before = 0.0;
        for state in &states {
            let ledger = &state.ledger;
            assert!(ledger.relative_defect().abs() < 1e-9, "{of}: {ledger:?}");
            let lost = ledger.rayleigh_loss + ledger.numerical_loss;
            assert!(
                of == "integrator" || lost >= before - 1e-12,
                "{of}: {lost} after {before}"
            );
            before = lost;
        }
        assert_eq!(before > 1e-9, of != "kept", "{of}: {before:e} J");
        let body = states.last().unwrap().rings[1].as_ref().unwrap().body();
        assert!(
            body.unwrap().0[1].iter().any(|v| v.abs() > 1e-9),
            "the body moves"
        );
    }
}

/// Wrong: a bearing in a housing would not stay where it is in equilibrium.
#[test]
fn an_equilibrium_stays() {
    let (own, _) = tube(&outer(Hold::Clamped), 2);
    let model = struck(on_moving_body(own, 6, 20e3), Backend::Auto);
    let rest = equilibrium(&model);
    let motion = Motion::new(&model, MotionSettings::conserving(STEP, Speed::constant(0.0))).unwrap();
    let (mut state, mut cache) = (motion.start(&rest), StepCache::default());
    for _ in 0..20 {
        state = motion.step(&state, &mut cache).unwrap().0;
    }
    let off = difference(&state.shaft, &rest.displacements.shaft);
    assert!(off < 1e-7, "{off:e}");
    assert!(state.ledger.kinetic.iter().sum::<f64>() < 1e-12 * state.ledger.strain[1]);
}

/// Wrong: a solver of harmonics and one of the whole matrix would move otherwise.
#[test]
fn all_solvers_of_the_ring_give_the_same_motion() {
    let (own, _) = tube(&outer(Hold::Clamped), 2);
    let [a, b] = [Backend::Cyclic, Backend::Sparse].map(|backend| {
        let ring = on_moving_body(own.clone(), 6, 20e3);
        histories(&course(&struck(ring, backend), settings(), 20))
    });
    for (a, b) in a.iter().zip(&b) {
        let off = difference(a, b);
        assert!(off < 1e-8, "{off:e}");
    }
}

/// Wrong: threads would change bits of a bearing that moves in a housing.
#[test]
fn a_moving_housing_has_the_same_bits_on_one_and_two_threads() {
    let bits = |threads: usize| {
        on_threads(threads, || {
            let (own, _) = tube(&outer(Hold::Clamped), 2);
            let model = struck(on_moving_body(own, 6, 20e3), Backend::Auto);
            course(&model, settings(), 10)
        })
    };
    let [one, two] = [1, 2].map(bits);
    assert!(one.last() == two.last());
}
