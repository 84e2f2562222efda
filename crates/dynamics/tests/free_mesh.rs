//! Steps of a ring that Gmsh meshed freely, so that nothing of it is periodic.

#![allow(clippy::float_cmp)]

use std::path::Path;
use std::sync::Arc;

use crate::support::rings::{Level, ring_model};
use crate::support::{Case, equilibrium, on_threads};
use contact::Side;
use dynamics::effects::{FrameRotation, RingDamping};
use dynamics::kinematics::Speed;
use dynamics::motion::{Motion, MotionSettings, MotionState, StepCache};
use dynamics::{Backend, ContactMode, Hold, Model, Sectors};

/// Speed of the inner ring, rad/s: 1800 rpm.
const SPEED: f64 = 60.0 * std::f64::consts::PI;
const STEPS: usize = 4;

/// The free inner ring in its turning frame beside a small periodic one.
fn bearing() -> Model {
    let case = Case {
        radial: 800.0,
        ..Case::axial(2000.0)
    };
    let mut model = case.flexible(ContactMode::Patch, Level::hex8(54, 6, 1, 2), Hold::Clamped);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes/7010c_inner_tet10.msh");
    let mesh = mesh::read_msh(path, 1e-3).unwrap();
    model.rings[0] = Some(Arc::new(ring_model(Side::Inner, mesh, Hold::Clamped)));
    model
        .effects
        .push(Box::new(FrameRotation::new(Speed::constant(SPEED))));
    model
}

/// Steps from a state; with `forget`, each begins with its state alone, as a resumed run does.
fn steps(motion: &Motion, start: &MotionState, forget: bool) -> MotionState {
    let (mut state, mut cache) = (start.clone(), StepCache::default());
    for _ in 0..STEPS {
        if forget {
            cache = StepCache::default();
        }
        state = motion.step(&state, &mut cache).unwrap().0;
    }
    state
}

/// Wrong: a free mesh would be a ring of another compliance, or its steps would hang on threads or on where a run was
/// resumed. Sectors solve the columns of all contacts anew; forces agree to 1e-10 of the largest.
#[test]
fn steps_of_a_free_mesh_are_those_of_sectors_and_have_the_same_bits_again() {
    let mut model = bearing();
    let start = equilibrium(&model);
    let settings = || MotionSettings {
        rayleigh: RingDamping {
            mass: 100.0,
            stiffness: 1e-8,
        },
        ..MotionSettings::conserving(1e-5, Speed::constant(SPEED))
    };
    let of = |threads: usize, forget: bool| {
        on_threads(threads, || {
            let motion = Motion::new(&model, settings()).unwrap();
            assert_eq!(motion.solver_name(Side::Inner), Some("sparse"));
            steps(&motion, &motion.start(&start), forget)
        })
    };
    let end = of(2, false);
    assert!(of(1, false) == end, "one thread");
    assert!(
        of(3, true) == end,
        "three threads, each step from its state alone"
    );
    model.backend = Backend::Sector(Sectors {
        n_sectors: Some(6),
        ..Sectors::default()
    });
    let motion = Motion::new(&model, settings()).unwrap();
    assert_eq!(motion.solver_name(Side::Inner), Some("sector"));
    let sectors = steps(&motion, &motion.start(&start), false);
    let largest = end.forces.iter().map(|f| f.norm()).fold(0.0, f64::max);
    let errors = end.forces.iter().zip(&sectors.forces);
    let error = errors.map(|(a, b)| (*a - *b).norm()).fold(0.0, f64::max) / largest;
    println!("forces of sparse and sector steps agree to {error:.1e} of the largest");
    assert!(error < 1e-10, "{error:e}");
}
