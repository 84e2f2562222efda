//! Rings that are periodic up to a defect: the results of sparse factors.

use std::sync::Arc;

use contact::Side;
use dynamics::modes::ring_modes;
use dynamics::{Backend, Hold, Model, ModesSettings, RingSupport, StaticSolver};

use super::{HEX8, HEX20, assert_near, assert_same_motion, bearing, motion, motion_without_frame, statics};
use crate::support::rings::{Level, ring_model};

/// The bearing with a notch in each ring: in four sectors of 54 or 36 the nodes of a face, of the shoulders and of
/// the held surface stand elsewhere, up to 0.15 mm. Nodes of the raceway stay.
fn notched(level: Level, hold: Hold, backend: Backend) -> Model {
    let mut model = bearing(level, hold, backend);
    for side in Side::BOTH {
        let ring = model.ring(side).unwrap();
        let mut mesh = ring.mesh.clone();
        let raceway = mesh.group_nodes("raceway");
        for (node, [x, y, z]) in mesh.nodes.iter_mut().enumerate() {
            let azimuth = y.atan2(*x);
            let is_in = (0.9..1.35).contains(&azimuth) && *z > 3e-3 && raceway.binary_search(&node).is_err();
            if is_in {
                let depth = 1.5e-4 * (1.0 - (azimuth - 1.1).abs());
                *z -= depth;
                // The held surface stays where it is but for the axial shift.
                let r = x.hypot(*y);
                if (26e-3..39e-3).contains(&r) {
                    let factor = 1.0 + 0.3 * depth / r;
                    (*x, *y) = (factor * *x, factor * *y);
                }
            }
        }
        let hold = ring.hold;
        model.rings[side.index()] = Some(Arc::new(ring_model(side, mesh, hold)));
    }
    model
}

/// Wrong: an equilibrium of rings with a notch would not be that of the sparse factor: clamped and in mean motion,
/// linear and quadratic elements.
#[test]
fn statics_of_notched_rings_is_that_of_assembled_rings() {
    for (level, hold) in [
        (HEX8, Hold::Clamped),
        (HEX8, Hold::MeanMotion),
        (HEX20, Hold::Clamped),
    ] {
        let ends = [(Backend::Auto, "cyclic"), (Backend::Sparse, "sparse")]
            .map(|(backend, name)| statics(&notched(level, hold, backend), name));
        let forces = ends.each_ref().map(|s| {
            let pair = |b: &dynamics::balls::BallResult| [b.inner.force_n, b.outer.force_n];
            s.balls.iter().flat_map(pair).collect::<Vec<_>>()
        });
        assert_near(&forces[0], &forces[1], 1e-11, "forces");
        for side in Side::BOTH {
            let [found, expected] = ends.each_ref().map(|s| s.elastic[side.index()].as_ref().unwrap());
            assert_near(found, expected, 1e-11, "elastic displacement");
        }
    }
}

/// Wrong: the notch would not matter in these tests, or the log would not say what and where it is.
#[test]
fn the_log_says_where_the_notch_is_and_what_it_costs() {
    let model = notched(HEX8, Hold::Clamped, Backend::Auto);
    let solver = StaticSolver::new(&model).unwrap();
    let note = solver.ring(Side::Inner).unwrap().solver.solver_note();
    println!("{note}");
    for part in [
        "cyclic (54 equal sectors but for ",
        " in 4 of them, the first node ",
        "e-4 m from their places",
        " iterations on the defect",
    ] {
        assert!(note.contains(part), "{note}");
    }
    let ends = [
        statics(&bearing(HEX8, Hold::Clamped, Backend::Auto), "cyclic"),
        statics(&model, "cyclic"),
    ];
    let [a, b] = ends.each_ref().map(|s| s.balls[3].inner.force_n);
    assert!((a - b).abs() > 1e-6 * a, "{a} and {b}");
}

/// Wrong: a notch would make or take energy, or the motion would drift away from that of the sparse factor. The bore
/// that follows the shaft is part of the notch.
#[test]
fn thirty_steps_of_notched_rings_agree_with_sparse_factors() {
    let backends = [Backend::Cyclic, Backend::Sparse];
    let [found, expected] = backends.map(|backend| motion(|| notched(HEX8, Hold::Clamped, backend), 30));
    assert_same_motion(&found, &expected, 1e-10);
    let [found, expected] =
        backends.map(|backend| motion_without_frame(|| notched(HEX8, Hold::MeanMotion, backend), 30));
    assert_same_motion(&found, &expected, 1e-10);
}

/// Wrong: natural modes of a ring with a notch would be those of the ring without.
#[test]
fn modes_of_a_notched_ring_refuse_harmonics() {
    let settings = |backend| ModesSettings {
        number: 4,
        shift: None,
        backend,
    };
    let model = notched(HEX8, Hold::Clamped, Backend::Auto);
    let ring = model.ring(Side::Inner).unwrap();
    let modes = |backend| {
        ring_modes(
            Side::Inner,
            ring,
            RingSupport::Free,
            settings(backend),
            &mut |_| (),
        )
    };
    let text = modes(Backend::Cyclic).err().unwrap().to_string();
    assert!(
        text.starts_with("the inner ring is rotationally periodic only up to a defect"),
        "{text}"
    );
    let [auto, sparse] = [Backend::Auto, Backend::Sparse].map(|backend| {
        let set = modes(backend).unwrap();
        set.modes.iter().map(|m| m.frequency).collect::<Vec<_>>()
    });
    assert_near(&auto, &sparse, 1e-12, "frequencies");
}

/// Wrong: a scene that forces harmonics on a ring without sectors would be solved otherwise, or refused without the
/// place.
#[test]
fn statics_refuses_forced_harmonics_with_the_first_difference() {
    let mut model = bearing(HEX8, Hold::Clamped, Backend::Cyclic);
    let mut mesh = model.ring(Side::Inner).unwrap().mesh.clone();
    // No two nodes of the upper half agree.
    for (i, [_, y, z]) in mesh.nodes.iter_mut().enumerate() {
        if *y > 0.0 {
            *z += 1e-5 * (i as f64).sin();
        }
    }
    model.rings[0] = Some(Arc::new(ring_model(Side::Inner, mesh, Hold::Clamped)));
    let text = StaticSolver::new(&model).err().unwrap().to_string();
    assert!(
        text.starts_with(
            "the inner ring is not rotationally periodic, so solver.backend = \"cyclic\" cannot be: "
        ) && text.contains("node")
            && text.contains("it is not periodic up to a defect either"),
        "{text}"
    );
}
