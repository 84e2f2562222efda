//! Rotationally periodic rings, solved from one sector: the same results as with assembled matrices and sparse factors.

mod ahead;
mod defect;
mod missing;
mod rigid_motion;

use std::sync::Arc;

use crate::support::rings::{Level, ring_model};
use crate::support::{Case, on_threads};
use contact::{Meridian, Side};
use dynamics::effects::FrameRotation;
use dynamics::kinematics::Speed;
use dynamics::modes::{bearing_modes, ring_modes};
use dynamics::motion::{Motion, MotionSettings, MotionState, StepCache};
use dynamics::{
    Backend, ContactMode, Hold, Model, ModesSettings, NodalStress, PointStress, RingSupport, StaticSolution,
    StaticSolver,
};

const HEX8: Level = Level::hex8(54, 6, 1, 2);
const HEX20: Level = Level::hex20(36, 4, 1, 1);
/// Speed of the inner ring, rad/s: 1800 rpm.
const SPEED: f64 = 60.0 * std::f64::consts::PI;

/// Thrust and a radial load, so that all harmonics count.
fn bearing(level: Level, hold: Hold, backend: Backend) -> Model {
    let case = Case {
        radial: 800.0,
        ..Case::axial(2000.0)
    };
    let mut model = case.flexible(ContactMode::Patch, level, hold);
    model.backend = backend;
    model
}

/// The model with both rings twisted along the axis: periodic, but no section is its own mirror image.
fn twisted(model: &mut Model) {
    for side in Side::BOTH {
        let ring = model.ring(side).unwrap();
        let mut mesh = ring.mesh.clone();
        for [x, y, z] in &mut mesh.nodes {
            let (s, c) = (6.0 * *z).sin_cos();
            (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
        }
        let hold = ring.hold;
        model.rings[side.index()] = Some(Arc::new(ring_model(side, mesh, hold)));
    }
}

#[track_caller]
fn assert_near(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let largest = expected.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let errors = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    let error = errors.fold(0.0, f64::max) / largest;
    println!("{what}: {error:.1e} of the largest, allowed {tolerance:.0e}");
    assert!(
        error <= tolerance,
        "{what}: {error:e} of the largest, allowed {tolerance:e}"
    );
}

fn statics(model: &Model, name: &str) -> StaticSolution {
    let mut solver = StaticSolver::new(model).unwrap();
    for side in Side::BOTH {
        let note = solver.ring(side).unwrap().solver.solver_note();
        assert!(note.starts_with(name), "{note}");
    }
    solver.solve(model, None).unwrap()
}

/// Wrong: an equilibrium by harmonics would not be that of the sparse factor: clamped, in mean motion, with quadratic
/// elements, and with sections that are not their own mirror image. 1e-12 of the largest force and displacement.
#[test]
fn statics_of_sectors_is_that_of_assembled_rings() {
    for (level, hold, twist) in [
        (HEX8, Hold::Clamped, false),
        (HEX8, Hold::MeanMotion, false),
        (HEX8, Hold::Clamped, true),
        (HEX20, Hold::MeanMotion, true),
    ] {
        let ends = [(Backend::Auto, "cyclic"), (Backend::Sparse, "sparse")].map(|(backend, name)| {
            let mut model = bearing(level, hold, backend);
            if twist {
                twisted(&mut model);
            }
            statics(&model, name)
        });
        let forces = |s: &StaticSolution| {
            s.balls
                .iter()
                .flat_map(|b| [b.inner.force_n, b.outer.force_n])
                .collect::<Vec<_>>()
        };
        assert_near(&forces(&ends[0]), &forces(&ends[1]), 1e-12, "forces");
        for side in Side::BOTH {
            let [found, expected] = ends.each_ref().map(|s| s.elastic[side.index()].as_ref().unwrap());
            assert_near(found, expected, 1e-12, "elastic displacement");
        }
    }
}

/// Wrong: stress by the weights of one sector would not be that of the elements, at nodes or at integration points,
/// in a loaded bearing.
#[test]
fn stress_of_sectors_is_that_of_the_elements() {
    for level in [HEX8, HEX20] {
        let model = bearing(level, Hold::Clamped, Backend::Auto);
        let solution = statics(&model, "cyclic");
        for side in Side::BOTH {
            let ring = model.ring(side).unwrap();
            let [fast, slow] = [Backend::Auto, Backend::Sparse]
                .map(|backend| NodalStress::new(ring, side.name(), backend).unwrap());
            assert!(fast.operator_bytes().is_some() && slow.operator_bytes().is_none());
            let u = solution.elastic[side.index()].as_ref().unwrap();
            let [found, expected] = [fast.nodal(u), slow.nodal(u)];
            assert_near(found.as_flattened(), expected.as_flattened(), 1e-12, "stress");
            let [fast, slow] = [Backend::Auto, Backend::Sparse]
                .map(|backend| PointStress::new(ring, side.name(), backend).unwrap());
            assert!(fast.operator_bytes().is_some() && slow.operator_bytes().is_none());
            let [found, expected] = [fast.at_points(u), slow.at_points(u)];
            assert_near(
                found.as_flattened(),
                expected.as_flattened(),
                1e-12,
                "stress at points",
            );
        }
    }
}

/// Wrong: natural frequencies from sectors would not be those of assembled matrices: a free ring, a clamped bearing
/// with a moving shaft, and rings in mean motion. The bounds of both searches are 1e-8 or better.
#[test]
fn modes_of_sectors_are_those_of_assembled_rings() {
    let settings = |backend| ModesSettings {
        number: 12,
        shift: None,
        backend,
    };
    let backends = [Backend::Auto, Backend::Sparse];
    let model = bearing(HEX8, Hold::Clamped, Backend::Auto);
    let ring = model.ring(Side::Outer).unwrap();
    for support in [RingSupport::Free, RingSupport::AsHeld] {
        let [found, expected] = backends.map(|backend| {
            let set = ring_modes(Side::Outer, ring, support, settings(backend), &mut |_| ()).unwrap();
            set.modes
                .iter()
                .filter(|m| !m.is_rigid)
                .map(|m| m.frequency)
                .collect::<Vec<_>>()
        });
        assert_near(&found, &expected, 1e-9, "frequencies of a ring");
    }
    for hold in [Hold::Clamped, Hold::MeanMotion] {
        let model = bearing(HEX8, hold, Backend::Auto);
        let solution = statics(&model, "cyclic");
        let [found, expected] = backends.map(|backend| {
            let set = bearing_modes(&model, &solution, settings(backend), &mut |_| ()).unwrap();
            set.modes.iter().map(|m| m.frequency).collect::<Vec<_>>()
        });
        assert_near(&found, &expected, 1e-9, "frequencies of a bearing");
    }
}

/// A state and the coordinates of its rings: displacements, velocities, accelerations.
pub struct End {
    state: MotionState,
    rings: [[Vec<f64>; 3]; 2],
}

/// Steps at 1800 rpm from equilibrium with the turning frame.
fn rolling(level: Level, backend: Backend, steps: usize) -> End {
    motion(|| bearing(level, Hold::Clamped, backend), steps)
}

/// The same of a model.
fn motion(build: impl Fn() -> Model, steps: usize) -> End {
    let mut model = build();
    model
        .effects
        .push(Box::new(FrameRotation::new(Speed::constant(SPEED))));
    motion_of(&model, &build(), steps)
}

/// The same without the inertia of the turning frame.
fn motion_without_frame(build: impl Fn() -> Model, steps: usize) -> End {
    let model = build();
    motion_of(&model, &model, steps)
}

/// Steps of a model from the equilibrium of another.
fn motion_of(model: &Model, at_rest: &Model, steps: usize) -> End {
    let name = match model.backend {
        Backend::Sparse => "sparse",
        Backend::Sector(_) => "sector",
        Backend::Auto | Backend::Cyclic => "cyclic",
    };
    let start = statics(at_rest, name);
    let motion = Motion::new(model, MotionSettings::conserving(1e-5, Speed::constant(SPEED))).unwrap();
    let mut state = motion.start(&start);
    let mut cache = StepCache::default();
    for _ in 0..steps {
        state = motion.step(&state, &mut cache).unwrap().0;
    }
    assert!(state.ledger.relative_defect().abs() < 1e-8, "{:?}", state.ledger);
    let rings = Side::BOTH.map(|side| motion.ring_coordinates(&state, side).unwrap());
    End { state, rings }
}

#[track_caller]
fn assert_same_motion(found: &End, expected: &End, tolerance: f64) {
    let forces = |end: &End| Meridian::flat(&end.state.forces);
    assert_near(&forces(found), &forces(expected), tolerance, "forces");
    for ([w, v, _], [expected, rate, _]) in found.rings.iter().zip(&expected.rings) {
        assert_near(w, expected, tolerance, "displacement");
        // A velocity is a displacement of a step over its size, and so is its error.
        let moved = |v: &[f64]| {
            let pairs = v.iter().zip(expected);
            pairs.map(|(v, w)| 1e-5 * v + w).collect::<Vec<f64>>()
        };
        assert_near(&moved(v), &moved(rate), tolerance, "motion of a step");
    }
}

/// Wrong: results would drift apart over many steps. 500 steps of 1e-5 s at 1800 rpm with the turning frame, all
/// displacements, forces and motions of a step to 1e-10 of the largest.
#[test]
#[ignore = "takes minutes with the sparse factor: cargo test --release -p raceway-dynamics --test tests periodic -- \
            --ignored"]
fn five_hundred_steps_agree_with_sparse_factors() {
    let level = Level::hex8(90, 8, 2, 3);
    let [found, expected] = [Backend::Cyclic, Backend::Sparse].map(|backend| rolling(level, backend, 500));
    assert_same_motion(&found, &expected, 1e-10);
}

/// Wrong: a periodic ring solved by harmonics and the same ring cut by angle into sectors would be two different
/// bearings. Statics to 1e-12, 500 steps to 1e-10.
#[test]
#[ignore = "takes minutes with the factors of sectors: scripts/test-slow"]
fn statics_and_five_hundred_steps_agree_with_rings_cut_into_sectors() {
    let level = Level::hex8(90, 8, 2, 3);
    let backends = [Backend::Cyclic, Backend::Sector(Default::default())];
    let ends = backends.map(|backend| bearing(level, Hold::Clamped, backend));
    let [found, expected] = [statics(&ends[0], "cyclic"), statics(&ends[1], "sector")];
    for side in Side::BOTH {
        let [a, b] = [&found, &expected].map(|s| s.elastic[side.index()].as_ref().unwrap());
        assert_near(a, b, 1e-12, "elastic displacement");
    }
    let [found, expected] = backends.map(|backend| rolling(level, backend, 500));
    assert_same_motion(&found, &expected, 1e-10);
}

/// Wrong: products of sectors, which motion takes its energies and right-hand sides from, would be others; in few
/// steps.
#[test]
fn thirty_steps_agree_with_sparse_factors() {
    let [found, expected] = [Backend::Cyclic, Backend::Sparse].map(|backend| rolling(HEX8, backend, 30));
    assert_same_motion(&found, &expected, 1e-11);
}

/// Wrong: the bits of a motion or of its stress would depend on the number of threads.
#[test]
fn one_two_and_four_threads_give_the_same_bits() {
    let run = |threads: usize| {
        on_threads(threads, || {
            let state = rolling(HEX8, Backend::Auto, 5).state;
            let model = bearing(HEX8, Hold::Clamped, Backend::Auto);
            let ring = model.ring(Side::Outer).unwrap();
            let motion =
                Motion::new(&model, MotionSettings::conserving(1e-5, Speed::constant(SPEED))).unwrap();
            let u = motion.ring_displacement(&state, Side::Outer).unwrap().0;
            let stress = NodalStress::new(ring, "outer", Backend::Auto).unwrap().nodal(&u);
            (state, stress)
        })
    };
    let one = run(1);
    for threads in [2, 4] {
        let other = run(threads);
        assert_eq!(one.0.rings, other.0.rings, "{threads} threads");
        assert_eq!(one.0.forces, other.0.forces, "{threads} threads");
        assert_eq!(one.0.ledger, other.0.ledger, "{threads} threads");
        assert_eq!(one.1, other.1, "{threads} threads");
    }
}

/// Wrong: probes of a moving ring would show other nodes' motion, or the bore would not follow the shaft. Free and
/// held nodes, to the bits of the transform of the whole field.
#[test]
fn chosen_nodes_move_as_in_the_whole_field() {
    let model = bearing(HEX8, Hold::Clamped, Backend::Auto);
    let motion = Motion::new(&model, MotionSettings::conserving(5e-6, Speed::constant(SPEED))).unwrap();
    let mut state = motion.start(&statics(&model, "cyclic"));
    state = motion.step(&state, &mut StepCache::default()).unwrap().0;
    for side in Side::BOTH {
        let ring = model.ring(side).unwrap();
        let mesh = &ring.mesh;
        let nodes = [
            mesh.group_nodes("raceway")[7],
            mesh.group_nodes(ring.held_group)[5],
            3,
            mesh.n_nodes() - 1,
        ];
        let (whole, angle) = motion.ring_displacement(&state, side).unwrap();
        let (found, same) = motion.ring_displacement_at(&state, side, &nodes).unwrap();
        assert!(angle == same && found.len() == whole.len());
        assert!(
            found.iter().any(|u| u.is_nan()),
            "the whole field was transformed"
        );
        let of = |field: &[f64]| nodes.map(|node| [0, 1, 2].map(|i| field[3 * node + i]));
        assert_near(
            of(&found).as_flattened(),
            of(&whole).as_flattened(),
            1e-12,
            "nodes",
        );
    }
}
