//! Rings that cannot be cut or factored.

use std::borrow::Cow;

use mesh::ElementKind;
use solver::{SectorLayout, SolverError};

use super::rings::{Held, Problem, ring};

/// Wrong: a scene that asks for more sectors than there are elements would panic.
#[test]
fn too_many_sectors_are_refused() {
    let mesh = ring(ElementKind::Hex8, 6);
    let free: Vec<usize> = (0..mesh.n_dofs()).collect();
    for n_sectors in [0, 25] {
        let error = SectorLayout::new(&mesh.nodes, &mesh.connectivity, 8, &free, n_sectors).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!("a ring of 24 elements cannot be cut into {n_sectors} sectors; expected 1 to 24")
        );
    }
    // One sector per element: nodes that four sectors share.
    let problem = Problem::new(mesh, Held::Inertia);
    let finest = problem.sectors(24);
    assert!(finest.is_ok(), "{finest:?}");
}

/// Wrong: a ring that nothing holds would be solved to huge numbers.
#[test]
fn a_ring_that_nothing_holds_is_refused() {
    let mut problem = Problem::new(ring(ElementKind::Hex8, 12), Held::Clamped);
    problem.free = (0..problem.mesh.n_dofs()).collect();
    for n_sectors in [1, 2, 4] {
        let error = problem.sectors(n_sectors).unwrap_err();
        let expected = matches!(
            error,
            SolverError::Singular { .. } | SolverError::NotPositiveDefinite { .. }
        );
        assert!(expected, "{n_sectors} sectors: {error}");
    }
}

/// Wrong: the message about a broken element would blame a row of another place.
#[test]
fn errors_name_the_row_of_the_ring() {
    let problem = Problem::new(ring(ElementKind::Hex8, 12), Held::Clamped);
    let symbolic = problem.symbolic(3);
    let layout = symbolic.layout().clone();
    let sector = &layout.sectors()[1];
    let broken = sector.nodes[sector.nodes.len() / 2];
    let error = symbolic
        .factor(|s| {
            let mut matrix = problem.part(&layout, s);
            if let Ok(node) = layout.sectors()[s].nodes.binary_search(&broken) {
                *matrix.get_mut(3 * node, 3 * node).unwrap() = f64::NAN;
            }
            Cow::Owned(matrix)
        })
        .unwrap_err();
    let row = error.row().unwrap_or_else(|| panic!("{error}"));
    assert_eq!(problem.free[row], 3 * broken, "{error}");
}
