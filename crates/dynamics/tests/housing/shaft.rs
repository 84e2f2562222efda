//! An inner ring tied to a hollow shaft that turns: against ring and shaft meshed as one, its energy and its bits.

use std::sync::Arc;

use body::SeatTie;
use contact::Side;
use dynamics::effects::RingDamping;
use dynamics::kinematics::Speed;
use dynamics::modes::bearing_modes;
use dynamics::motion::{Motion, MotionSettings, MotionState, StepCache};
use dynamics::{Backend, ContactMode, Hold, Mode, Model, ModesSettings, RingModel, ShaftDof};
use fem::Material;

use super::{LEVEL, difference, equilibrium, every_fifth, forces, harmonics, space, surrounding, wrapped};
use crate::support::rings::ring;
use crate::support::{Case, on_threads, steel};

/// Step, s.
const STEP: f64 = 1e-5;
/// Speed of the shaft, rad/s: 9500 rpm.
const SPEED: f64 = 1000.0;

pub fn inner(hold: Hold) -> RingModel {
    ring(Side::Inner, LEVEL, hold)
}

/// A tube in the bore whose inside is carried by the shaft: alone, and with the ring.
pub fn hollow_shaft(layers: usize) -> (mesh::Mesh, mesh::Mesh) {
    wrapped(&inner(Hold::Clamped), layers, 0.6, |_| true)
}

pub fn on_shaft(mesh: mesh::Mesh, functions: [usize; 2], below: Option<f64>) -> RingModel {
    made_of(steel(), mesh, functions, below)
}

fn made_of(material: Material, mesh: mesh::Mesh, [n, across]: [usize; 2], below: Option<f64>) -> RingModel {
    let ring = inner(Hold::MeanMotion);
    let body = surrounding(mesh, space(&ring, harmonics(n, across)), material);
    let body = Arc::new(body.on_shaft(&[ring.groove.centre_z]).unwrap());
    let modes = below.map(|below| Arc::new(body.modes(below).unwrap()));
    let tie = SeatTie::to_seat(body, 0);
    RingModel {
        tie: Some(Arc::new(match modes {
            Some(modes) => tie.in_motion(modes),
            None => tie,
        })),
        ..ring
    }
}

/// Ring and shaft as one mesh.
pub fn as_one(layers: usize) -> RingModel {
    RingModel {
        mesh: hollow_shaft(layers).1,
        held_group: "feet",
        ..inner(Hold::Clamped)
    }
}

pub fn bearing(inner: RingModel, backend: Backend) -> Model {
    let case = Case {
        radial: 3000.0,
        ..Case::axial(1000.0)
    };
    let mut model = case.flexible(ContactMode::Patch, LEVEL, Hold::Clamped);
    model.rings[0] = Some(Arc::new(inner));
    Model { backend, ..model }
}

/// A bearing whose shaft is free, with a light hub of its own, and may tilt.
pub fn free(inner: RingModel, backend: Backend) -> Model {
    let mut model = bearing(inner, backend);
    model.shaft_mass = 0.1;
    model.shaft_inertia.transverse = 5e-5;
    model.shaft_inertia.polar = 8e-5;
    model.shaft = [ShaftDof::Free; 5];
    model
}

fn settings() -> MotionSettings {
    MotionSettings::conserving(STEP, Speed::constant(SPEED))
}

/// States of the motion after a blow on shaft and tilt, every fifth of `n` steps.
fn course(model: &Model, settings: MotionSettings, n: usize) -> Vec<MotionState> {
    let motion = Motion::new(model, settings).unwrap();
    let blow = [0.05, 0.0, 0.03, 0.0, 1.0];
    every_fifth(&motion, motion.rest([0.0, 0.0, 12e-6, 0.0, 0.0], blow), n)
}

/// Displacements and tilts of the shaft and forces on the inner ring over a course.
fn histories(states: &[MotionState]) -> [Vec<f64>; 3] {
    let shaft = states.iter().flat_map(|state| state.shaft[..3].to_vec());
    let tilts = states.iter().flat_map(|state| state.shaft[3..].to_vec());
    let inner = states.iter().flat_map(|s| s.forces.iter().step_by(2));
    [
        shaft.collect(),
        tilts.collect(),
        inner.flat_map(|force| force.to_array()).collect(),
    ]
}

/// Wrong: an inner ring on its shaft would not be the body that they are together. One mesh of both, with the same
/// nodes, is clamped at the same place.
#[test]
fn ring_and_shaft_at_rest_are_those_of_one_mesh() {
    let own = hollow_shaft(4).0;
    let n_ring = inner(Hold::Clamped).mesh.n_dofs();
    let one = equilibrium(&bearing(as_one(4), Backend::Sparse));
    let expected = &one.elastic[0].as_ref().unwrap()[..n_ring];
    let (mut moved, mut pushed, mut shaft) = (Vec::new(), Vec::new(), Vec::new());
    for n in [[16, 2], [16, 4], [18, 6]] {
        let model = bearing(on_shaft(own.clone(), n, None), Backend::Auto);
        let solution = equilibrium(&model);
        moved.push(difference(solution.elastic[0].as_ref().unwrap(), expected));
        pushed.push(difference(&forces(&solution), &forces(&one)));
        shaft.push(difference(
            &solution.displacements.shaft,
            &one.displacements.shaft,
        ));
        let work = solution.work_defect.abs() / solution.load_work;
        assert!(work < 1e-9, "the virtual work does not close: {work:e}");
    }
    println!("displacements {moved:?}, forces {pushed:?}, shaft {shaft:?}");
    assert!(moved.windows(2).all(|e| e[1] < e[0]), "{moved:?}");
    // The seat has 36 nodes round and 7 across: order 18 and degree 6 are all of it.
    assert!(
        moved[2] < 1e-9 && pushed[2] < 1e-9 && shaft[2] < 1e-9,
        "{moved:?} {pushed:?} {shaft:?}"
    );
    assert!(pushed[0] < 1e-3 && shaft[0] < 5e-3, "{pushed:?} {shaft:?}");
}

/// Wrong: ring and shaft would move otherwise than the body that they are together: the inertia of the shaft's tube,
/// its turning, its modes.
#[test]
fn ring_and_shaft_move_as_one_mesh() {
    let expected = histories(&course(&free(as_one(3), Backend::Sparse), settings(), 40));
    let own = hollow_shaft(3).0;
    let mut errors = Vec::new();
    for (n, below) in [([4, 2], 1e3), ([18, 6], 60e3)] {
        let ring = on_shaft(own.clone(), n, Some(below));
        let found = histories(&course(&free(ring, Backend::Auto), settings(), 40));
        errors.push([0, 1, 2].map(|i| difference(&found[i], &expected[i])));
    }
    println!("shaft, tilts and forces: {errors:?}");
    let [shaft, tilts, forces] = errors[1];
    assert!(shaft < 1e-3 && tilts < 1e-3 && forces < 5e-3, "{errors:?}");
}

/// Wrong: ring and shaft would vibrate otherwise than the body that they are together, free or with a shaft that is
/// held along an axis and in its tilts.
#[test]
fn ring_and_shaft_have_the_modes_of_one_mesh() {
    let own = hollow_shaft(3).0;
    let settings = ModesSettings {
        number: 48,
        shift: None,
        backend: Backend::Auto,
    };
    let held = [
        ShaftDof::Free,
        ShaftDof::Prescribed(0.0),
        ShaftDof::Free,
        ShaftDof::Prescribed(0.0),
        ShaftDof::Prescribed(0.0),
    ];
    for shaft in [[ShaftDof::Free; 5], held] {
        let of = |ring: RingModel, backend: Backend| -> Vec<Mode> {
            let model = Model {
                shaft,
                ..free(ring, backend)
            };
            let found = bearing_modes(&model, &equilibrium(&model), settings, &mut |_| ());
            let elastic = found.unwrap().modes.into_iter().filter(|mode| !mode.is_rigid);
            elastic.take(12).collect()
        };
        let expected = of(as_one(3), Backend::Sparse);
        let mut errors = Vec::new();
        for (n, below) in [([4, 2], 1e3), ([18, 6], 60e3)] {
            let found = of(on_shaft(own.clone(), n, Some(below)), Backend::Auto);
            let pairs = found.iter().zip(&expected);
            let off = pairs.map(|(a, b)| (a.frequency / b.frequency - 1.0).abs());
            errors.push(off.fold(0.0, f64::max));
            for mode in &found {
                assert!(
                    mode.bound < 1e-6 * mode.frequency && mode.residual < 1e-6,
                    "{mode:?}"
                );
                assert!(mode.kinetic_bodies[0] > 0.0 && mode.shape.bodies[0].is_some());
                let still = (0..5).filter(|&dof| shaft[dof] != ShaftDof::Free);
                still.for_each(|dof| assert!(mode.shape.shaft[dof].abs() < 1e-6));
            }
        }
        println!("frequencies: {errors:?}");
        assert!(errors[1] < 4e-4 && errors[1] < errors[0], "{errors:?}");
    }
}

/// Wrong: the joint, the shaft or its turning would make or eat energy.
#[test]
fn the_ledger_of_a_turning_shaft_closes() {
    let damped = MotionSettings {
        rayleigh: RingDamping {
            mass: 20.0,
            stiffness: 1e-7,
        },
        ..settings()
    };
    for settings in [settings(), damped] {
        let ring = on_shaft(hollow_shaft(2).0, [6, 2], Some(20e3));
        for state in course(&free(ring, Backend::Auto), settings, 60) {
            let defect = state.ledger.relative_defect();
            assert!(defect.abs() < 1e-9, "{defect:e} {:?}", state.ledger);
        }
    }
}

/// Wrong: what turns would be pulled off its way, or the shaft would ring though nothing acts on it: Coriolis and
/// centrifugal forces on its elastic part are of first order in the speed over its frequencies. A soft shaft turns at
/// 3000 rad/s, touches no ball, and flies; it goes straight on and is not strained.
#[test]
fn a_soft_shaft_that_turns_flies_straight() {
    let soft = Material::new(1e9, 0.3, 7800.0).unwrap();
    let ring = made_of(soft, hollow_shaft(2).0, [6, 2], Some(20e3));
    let mut model = free(ring, Backend::Auto);
    model.effects.clear();
    let errors = |dt: f64| {
        let motion = Motion::new(&model, MotionSettings::conserving(dt, Speed::constant(3000.0))).unwrap();
        let start = [1e-6, 0.0, -39e-6, 0.0, 0.0];
        let velocity = [2e-3, -1e-3, -1e-4, 0.0, 0.0];
        let (mut state, mut cache) = (motion.rest(start, velocity), StepCache::default());
        let kinetic = state.ledger.kinetic[0];
        let mut largest = [0.0f64; 3];
        for step in 1..=(1e-3 / dt).round() as i32 {
            state = motion.step(&state, &mut cache).unwrap().0;
            let force = state.forces.iter().fold(0.0f64, |m, f| m.max(f.norm()));
            assert!(force < 1e-6, "it touches a ball with {force:e} N");
            let off = |i: usize| state.shaft[i] - start[i] - velocity[i] * dt * f64::from(step);
            let way = off(0).hypot(off(1)).hypot(off(2)) / 2e-6;
            let tilt = 0.03 * state.shaft[3].hypot(state.shaft[4]) / 2e-6;
            let found = [way, tilt, (state.ledger.strain[0] / kinetic).sqrt()];
            largest = [0, 1, 2].map(|i| largest[i].max(found[i]));
        }
        largest
    };
    let [coarse, fine] = [STEP, 0.5 * STEP].map(errors);
    println!("way, tilt and strain: {coarse:?} {fine:?}");
    // What is left of the strain is that of the ring, whose own elastic part knows no frame.
    let [way, tilt, strain] = coarse;
    assert!(way < 1e-3 && fine[0] < 0.4 * way, "{coarse:?} {fine:?}");
    assert!(tilt < 1e-8 && strain < 1e-2, "{coarse:?}");
}

/// Wrong: a bearing on an elastic shaft would not stay where it is in equilibrium.
#[test]
fn an_equilibrium_stays() {
    let mut model = free(on_shaft(hollow_shaft(2).0, [6, 2], Some(20e3)), Backend::Auto);
    model.shaft[3] = ShaftDof::Prescribed(0.0);
    model.shaft[4] = ShaftDof::Prescribed(0.0);
    super::loads::assert_stays(&model, Side::Inner);
}

/// Wrong: solvers or threads would move it otherwise.
#[test]
fn all_solvers_give_the_same_motion_and_threads_the_same_bits() {
    let moved = |backend: Backend, threads: usize| {
        on_threads(threads, || {
            let ring = on_shaft(hollow_shaft(2).0, [6, 2], Some(20e3));
            course(&free(ring, backend), settings(), 20)
        })
    };
    let [one, two] = [1, 2].map(|threads| moved(Backend::Cyclic, threads));
    assert_eq!(histories(&one), histories(&two));
    assert!(one.last().unwrap().rings == two.last().unwrap().rings);
    let [a, b] = [one, moved(Backend::Sparse, 2)].map(|states| histories(&states));
    for (a, b) in a.iter().zip(&b) {
        let off = difference(a, b);
        assert!(off < 1e-8, "{off:e}");
    }
}
