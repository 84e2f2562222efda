//! Rings that are periodic but for missing elements, such as a keyway, or nodes held besides: the results of sparse
//! factors.

use dynamics::motion::StepCache;
use std::sync::Arc;

use contact::Side;
use dynamics::effects::{FrameRotation, Gravity, RingDamping};
use dynamics::kinematics::Speed;
use dynamics::motion::{Integrator, Motion, MotionSettings, check_supported};
use dynamics::{Backend, Hold, Model, StaticSolver};
use input::Schedule;
use mesh::{Facet, Mesh};

use super::ahead::alone;
use super::{
    End, HEX8, SPEED, assert_near, assert_same_motion, bearing, motion, motion_without_frame, statics,
};
use crate::support::on_threads;
use crate::support::rings::{Level, ring_model};

const HEX20: Level = Level::hex20(36, 4, 1, 2);

/// The bearing with other meshes.
fn with_meshes(level: Level, hold: Hold, backend: Backend, change: impl Fn(Side, Mesh) -> Mesh) -> Model {
    let mut model = bearing(level, hold, backend);
    for side in Side::BOTH {
        let mesh = change(side, model.ring(side).unwrap().mesh.clone());
        model.rings[side.index()] = Some(Arc::new(ring_model(side, mesh, hold)));
    }
    model
}

/// The bearing with a keyway in both rings.
pub fn keyed(level: Level, hold: Hold, backend: Backend) -> Model {
    with_meshes(level, hold, backend, keyway)
}

/// A keyway over the whole width in the bore of the inner ring and in the outer ring's seat: 3 sectors wide, half as
/// deep as the ring.
fn keyway(side: Side, mesh: Mesh) -> Mesh {
    let is_in = |mesh: &Mesh, e: usize| {
        let [x, y, _] = mesh.element_centre(e);
        let (azimuth, r) = (y.atan2(x), x.hypot(y));
        let is_deep = match side {
            Side::Inner => r < 26.6e-3,
            Side::Outer => r > 38.4e-3,
        };
        (1.0..1.35).contains(&azimuth) && is_deep
    };
    let lost: Vec<bool> = (0..mesh.n_elements()).map(|e| is_in(&mesh, e)).collect();
    mesh.without_elements(|e| lost[e]).0
}

/// A spall on the edge of the groove, away from the balls' tracks: facets of the raceway are gone.
fn spall(side: Side, mesh: Mesh) -> Mesh {
    let sign = match side {
        Side::Inner => -1.0,
        Side::Outer => 1.0,
    };
    let height = |node: usize| sign * mesh.nodes[node][2];
    let edge = mesh
        .group_nodes("raceway")
        .into_iter()
        .map(height)
        .fold(0.0, f64::min);
    let mut lost = vec![false; mesh.n_elements()];
    for &facet in mesh.group("raceway") {
        let [x, y, _] = mesh.element_centre(facet.element);
        let is_at_edge = mesh.facet_nodes(facet).any(|node| height(node) < 0.99 * edge);
        lost[facet.element] = is_at_edge && (1.0..1.3).contains(&y.atan2(x));
    }
    let n = mesh.group("raceway").len();
    let spalled = mesh.without_elements(|e| lost[e]).0;
    assert!(spalled.group("raceway").len() < n, "no facet is gone");
    spalled
}

/// A ring whose clamped surface reaches over a shoulder, in two sectors.
fn clawed(side: Side, mut mesh: Mesh) -> Mesh {
    let width = mesh.nodes.iter().map(|x| x[2]).fold(0.0, f64::max);
    let faces = mesh.kind.n_faces();
    let mut more = Vec::new();
    for element in 0..mesh.n_elements() {
        for face in 0..faces {
            let facet = Facet { element, face };
            let is_on = mesh.facet_nodes(facet).all(|node| {
                let [x, y, z] = mesh.nodes[node];
                z > 0.999 * width && (1.0..1.3).contains(&y.atan2(x))
            });
            if is_on {
                more.push(facet);
            }
        }
    }
    assert!(!more.is_empty());
    let group = match side {
        Side::Inner => "bore",
        Side::Outer => "seat",
    };
    mesh.groups.get_mut(group).unwrap().extend(more);
    mesh
}

/// A ring whose clamped surface lacks some facets, so that nodes between them are free.
fn loosened(side: Side, mut mesh: Mesh) -> Mesh {
    let group = match side {
        Side::Inner => "bore",
        Side::Outer => "seat",
    };
    let is_free = |f: &Facet| {
        let [x, y, z] = mesh.element_centre(f.element);
        (1.0..1.4).contains(&y.atan2(x)) && z > -3e-3
    };
    let kept: Vec<Facet> = mesh
        .group(group)
        .iter()
        .filter(|f| !is_free(f))
        .copied()
        .collect();
    mesh.groups.insert(group.to_string(), kept);
    mesh
}

/// A ring whose clamped surface is its lower quarter alone.
fn clasped(side: Side, mut mesh: Mesh) -> Mesh {
    let group = match side {
        Side::Inner => "bore",
        Side::Outer => "seat",
    };
    let mut kept = mesh.group(group).to_vec();
    kept.retain(|facet| {
        let [x, y, _] = mesh.element_centre(facet.element);
        y < -0.7 * x.hypot(y)
    });
    mesh.groups.insert(group.to_string(), kept);
    mesh
}

/// Wrong: a ring that is clamped on less than half of its seat would be that of a regular ring that nothing holds.
#[test]
fn a_ring_that_is_clamped_on_a_quarter_of_its_seat_has_no_regular_ring() {
    let ends = [Backend::Auto, Backend::Sparse].map(|backend| {
        let model = with_meshes(HEX8, Hold::Clamped, backend, clasped);
        statics(&model, "sparse").balls[3].inner.force_n
    });
    assert_eq!(ends[0], ends[1]);
    let model = with_meshes(HEX8, Hold::Clamped, Backend::Cyclic, clasped);
    let error = StaticSolver::new(&model).err().unwrap().to_string();
    assert!(
        error.contains("; what holds it reaches less than half round; use "),
        "{error}"
    );
    assert_same_statics(Hold::MeanMotion, |backend| {
        with_meshes(HEX8, Hold::MeanMotion, backend, clasped)
    });
}

/// A ring in its mean motion bends 1e5 times more easily than its elements strain, and their rounding shows in it as
/// often.
fn assert_same_statics(hold: Hold, build: impl Fn(Backend) -> Model) {
    let tolerance = match hold {
        Hold::MeanMotion => 5e-12,
        Hold::Clamped | Hold::Free => 1e-12,
    };
    let ends = [(Backend::Cyclic, "cyclic"), (Backend::Sparse, "sparse")].map(|(backend, name)| {
        let solution = statics(&build(backend), name);
        let forces = solution
            .balls
            .iter()
            .flat_map(|b| [b.inner.force_n, b.outer.force_n]);
        let forces: Vec<f64> = forces.collect();
        (solution, forces)
    });
    let [(found, forces), (expected, expected_forces)] = ends;
    assert_near(&forces, &expected_forces, 1e-12, "forces");
    for side in Side::BOTH {
        let [found, expected] = [&found, &expected].map(|s| s.elastic[side.index()].as_ref().unwrap());
        assert_near(found, expected, tolerance, "elastic displacement");
    }
}

/// Wrong: an equilibrium of rings with a keyway or a spall, or that are held elsewhere as well, would not be that of
/// the sparse factor.
#[test]
fn statics_of_rings_with_missing_elements_is_that_of_assembled_rings() {
    for (level, hold) in [
        (HEX8, Hold::Clamped),
        (HEX8, Hold::MeanMotion),
        (HEX20, Hold::Clamped),
    ] {
        assert_same_statics(hold, |backend| with_meshes(level, hold, backend, keyway));
        assert_same_statics(hold, |backend| with_meshes(level, hold, backend, spall));
    }
    assert_same_statics(Hold::Clamped, |backend| {
        with_meshes(HEX8, Hold::Clamped, backend, clawed)
    });
    assert_same_statics(Hold::Clamped, |backend| {
        with_meshes(HEX8, Hold::Clamped, backend, loosened)
    });
    let both = |side, mesh| clawed(side, spall(side, keyway(side, loosened(side, mesh))));
    assert_same_statics(Hold::Clamped, |backend| {
        with_meshes(HEX8, Hold::Clamped, backend, both)
    });
}

/// Wrong: missing elements would make or take energy, or the motion would drift away from that of the sparse factor,
/// by the mass of absent nodes or by the bore that follows the shaft.
#[test]
fn thirty_steps_of_rings_with_missing_elements_agree_with_sparse_factors() {
    type Change = fn(Side, Mesh) -> Mesh;
    let backends = [Backend::Cyclic, Backend::Sparse];
    let cases: [(Hold, Change); 5] = [
        (Hold::Clamped, loosened),
        (Hold::Clamped, keyway),
        (Hold::MeanMotion, keyway),
        (Hold::Clamped, spall),
        (Hold::Clamped, clawed),
    ];
    for (hold, change) in cases {
        let [found, expected] =
            backends.map(|backend| motion(|| with_meshes(HEX8, hold, backend, change), 30));
        assert_same_motion(&found, &expected, 1e-10);
    }
    let [found, expected] = backends
        .map(|backend| motion_without_frame(|| with_meshes(HEX20, Hold::Clamped, backend, keyway), 10));
    assert_same_motion(&found, &expected, 1e-10);
}

/// Wrong: the piece of the regular ring that fills a keyway would act on the ring, or swing up over many steps.
#[test]
fn sixty_steps_of_rings_with_a_keyway_keep_their_energy_and_agree_with_sparse_factors() {
    let [found, expected] = [Backend::Cyclic, Backend::Sparse]
        .map(|backend| motion_without_frame(|| with_meshes(HEX8, Hold::Clamped, backend, keyway), 60));
    assert_same_motion(&found, &expected, 1e-10);
    let length = |end: &End| end.state.rings[0].as_ref().unwrap().displacement().len();
    assert!(
        length(&found) > length(&expected),
        "the state is not of harmonics"
    );
    println!("energy {:.1e}", found.state.ledger.relative_defect());
    assert!(found.state.ledger.relative_defect().abs() < 1e-10);
}

/// Wrong: a resumed run of rings with a keyway would not go on as the run that was never stopped, or its bits would
/// depend on the number of threads: with loads on the ring, losses and a history of accelerations, clamped and in
/// mean motion.
#[test]
fn a_step_of_rings_with_a_keyway_has_the_same_bits_from_its_state_alone() {
    // The last case takes several rounds for the inertia of the frame.
    for (hold, dt, speed) in [
        (Hold::Clamped, 1e-5, Speed::constant(SPEED)),
        (Hold::MeanMotion, 1e-5, Speed::constant(SPEED)),
        (
            Hold::Clamped,
            4e-5,
            Speed::table(vec![0.0, 1e-3], vec![5.0 * SPEED, 20.0 * SPEED]),
        ),
    ] {
        let mut model = with_meshes(HEX8, hold, Backend::Auto, keyway);
        model.effects.push(Box::new(FrameRotation::new(speed.clone())));
        let gravity = Gravity::new([0.0, -9.81, 0.0], Schedule::Constant, &model.rings).unwrap();
        model.effects.push(Box::new(gravity));
        let settings = MotionSettings {
            integrator: Integrator::chung_hulbert(0.8),
            rayleigh: RingDamping {
                mass: 300.0,
                stiffness: 2e-8,
            },
            ..MotionSettings::conserving(dt, speed)
        };
        let start = statics(&model, "cyclic");
        let motion = Motion::new(&model, settings).unwrap();
        let mut state = motion.start(&start);
        let mut cache = StepCache::default();
        for threads in [1, 2, 4] {
            let (next, report) = on_threads(threads, || motion.step(&state, &mut cache)).unwrap();
            println!("{hold:?}: {} rounds", report.frame_rounds);
            let (expected, _) = motion.step(&alone(&state), &mut StepCache::default()).unwrap();
            assert!(next == expected, "{hold:?}, step {}", next.step);
            state = next;
        }
        println!("{hold:?}: {:.1e}", state.ledger.relative_defect());
        assert!(state.ledger.relative_defect().abs() < 1e-9, "{:?}", state.ledger);
    }
}

/// Wrong: a ring with a keyway would be stiffened as if it had none, or not at all without a word.
#[test]
fn a_ring_with_a_keyway_is_not_stiffened_by_its_stress() {
    let speed = Speed::constant(SPEED);
    let mut model = keyed(HEX8, Hold::Clamped, Backend::Auto);
    model
        .effects
        .push(Box::new(FrameRotation::new(speed.clone()).stiffened()));
    let error = Motion::new(&model, MotionSettings::conserving(1e-5, speed))
        .err()
        .unwrap();
    assert_eq!(
        error.to_string(),
        "effects.frame_rotation.stress_stiffening is not there for the inner ring: it is rotationally periodic only up \
         to a defect; remove it, or set it to false"
    );
    let before = check_supported(&model).unwrap_err();
    assert_eq!(before.to_string(), error.to_string());
}

/// Wrong: the keyway would not matter in these tests, or the log would not say what and where it is.
#[test]
fn the_log_says_which_elements_are_missing() {
    let notes = |change: fn(Side, Mesh) -> Mesh| {
        let model = with_meshes(HEX8, Hold::Clamped, Backend::Auto, change);
        let solver = StaticSolver::new(&model).unwrap();
        solver.ring(Side::Inner).unwrap().solver.solver_note().to_string()
    };
    let note = notes(keyway);
    println!("{note}");
    for part in [
        "cyclic (54 equal sectors but for ",
        " missing elements in 3 of them, the first beside node ",
        " absent nodes; ",
        " rows, ",
        " iterations on the defect",
    ] {
        assert!(note.contains(part), "{note}");
    }
    let note = notes(clawed);
    assert!(
        note.contains(" nodes that are held there alone, the first node "),
        "{note}"
    );
    let note = notes(loosened);
    assert!(
        note.contains(" nodes that are free there alone, the first node "),
        "{note}"
    );
    let ends = [
        bearing(HEX8, Hold::Clamped, Backend::Auto),
        with_meshes(HEX8, Hold::Clamped, Backend::Auto, keyway),
    ];
    let [a, b] = ends.map(|model| statics(&model, "cyclic").balls[3].inner.force_n);
    assert!((a - b).abs() > 1e-6 * a, "{a} and {b}");
}

/// Wrong: a ball on a part of the raceway that is gone would roll on as if it were there.
#[test]
fn a_ball_over_missing_facets_stops_with_the_place() {
    let pitted = |_: Side, mesh: Mesh| {
        let is_lost: Vec<bool> = (0..mesh.n_elements())
            .map(|e| {
                let [x, y, _] = mesh.element_centre(e);
                y.atan2(x).abs() < 0.1 && mesh.group("raceway").iter().any(|f| f.element == e)
            })
            .collect();
        mesh.without_elements(|e| is_lost[e]).0
    };
    let texts = [Backend::Cyclic, Backend::Sparse].map(|backend| {
        let model = with_meshes(HEX8, Hold::Clamped, backend, pitted);
        let error = StaticSolver::new(&model).unwrap().solve(&model, None).err();
        error.unwrap().to_string()
    });
    assert!(
        texts[0].starts_with("no facet of the inner raceway holds azimuth "),
        "{}",
        texts[0]
    );
    assert_eq!(texts[0], texts[1]);
}

/// Wrong: a facet that one group lacks would cost a sparse factor though no matrix knows it, or the results would be
/// others.
#[test]
fn a_facet_that_a_group_lacks_changes_no_solver() {
    let unmarked = |side: Side, mut mesh: Mesh| {
        let groove_sign = if side == Side::Inner { -1.0 } else { 1.0 };
        // At the edge, where no patch reaches.
        let is_at_edge = |f: &Facet| groove_sign * mesh.element_centre(f.element)[2] < -3.2e-3;
        let edge = mesh.group("raceway").iter().position(is_at_edge).unwrap();
        mesh.groups.get_mut("raceway").unwrap().remove(edge);
        mesh
    };
    let model = with_meshes(HEX8, Hold::MeanMotion, Backend::Auto, unmarked);
    let solver = StaticSolver::new(&model).unwrap();
    let note = solver.ring(Side::Inner).unwrap().solver.solver_note();
    assert!(
        note.starts_with("cyclic (54 equal sectors but for groups of facets"),
        "{note}"
    );
    assert_same_statics(Hold::MeanMotion, |backend| {
        with_meshes(HEX8, Hold::MeanMotion, backend, unmarked)
    });
}

/// Wrong: a ring that harmonics do not solve would be solved by them all the same, or nobody would know why not.
#[test]
fn what_is_no_defect_is_one_matrix_and_the_log_says_why() {
    let large = |_: Side, mesh: Mesh| {
        let is_in = |e: usize| {
            let [x, y, z] = mesh.element_centre(e);
            z > 0.0 && (0.0..3.0).contains(&y.atan2(x))
        };
        let lost: Vec<bool> = (0..mesh.n_elements()).map(is_in).collect();
        mesh.without_elements(|e| lost[e]).0
    };
    // Four tenths of the ring, in the middle of its section.
    let uneven = |side: Side, mut mesh: Mesh| {
        for (node, [x, y, z]) in mesh.nodes.iter_mut().enumerate() {
            let r = x.hypot(*y);
            let is_inside = match side {
                Side::Inner => (25.5e-3..28e-3).contains(&r),
                Side::Outer => (37e-3..39.5e-3).contains(&r),
            };
            if is_inside && (0.0..2.45).contains(&y.atan2(*x)) {
                *z += 2e-5 * (node as f64).sin();
            }
        }
        mesh
    };
    type Change = Box<dyn Fn(Side, Mesh) -> Mesh>;
    let cases: [(Change, &str); 2] = [
        (
            Box::new(large),
            "it is not periodic up to a defect either: with 54 sectors, more than ",
        ),
        (Box::new(uneven), "it is periodic up to a defect that touches "),
    ];
    for (change, reason) in cases {
        let model = with_meshes(HEX8, Hold::Clamped, Backend::Auto, &change);
        let solver = StaticSolver::new(&model).unwrap();
        let note = solver.ring(Side::Inner).unwrap().solver.solver_note();
        assert!(note.starts_with("sparse (") && note.contains(reason), "{note}");
        let forced = with_meshes(HEX8, Hold::Clamped, Backend::Cyclic, &change);
        let text = StaticSolver::new(&forced).err().unwrap().to_string();
        assert!(
            text.contains("solver.backend = \"cyclic\" cannot be") && text.contains(reason),
            "{text}"
        );
    }
}
