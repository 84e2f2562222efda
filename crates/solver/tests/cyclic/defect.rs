//! Rings with a defect: the sparse factor's solutions, and those of conjugate gradients.

use fem::Material;
use mesh::Mesh;
use solver::cyclic::{Change, CyclicDefect, conjugate_gradients};
use solver::{CyclicBordered, LinearSolver, ResponseTable, SolverError};

use crate::common::assert_close;
use crate::rings::{Ring, SHIFT, loads, rings, steel};

/// The change of the stiffness when the elements `elements` have `factor` times their modulus.
fn softened(mesh: &Mesh, elements: &[usize], factor: f64) -> Change {
    let mut nodes: Vec<usize> = elements.iter().flat_map(|&e| mesh.element(e)).copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    let steel = steel();
    let material = Material::new(steel.young_modulus, steel.poisson_ratio, steel.density).unwrap();
    let matrix = fem::assemble_stiffness(&mesh.part(elements, &nodes), &material).unwrap();
    let n = 3 * nodes.len();
    let mut values = vec![0.0; n * n];
    for (&k, (i, j)) in matrix.iter() {
        values[n * i + j] = (factor - 1.0) * k;
    }
    Change {
        rows: nodes.iter().flat_map(|node| 3 * node..3 * node + 3).collect(),
        values,
    }
}

/// Elements round the ring's first node.
fn patch(mesh: &Mesh) -> Vec<usize> {
    let [x0, y0, z0] = mesh.nodes[mesh.element(0)[0]];
    let near = |&e: &usize| {
        mesh.element(e).iter().any(|&n| {
            let [x, y, z] = mesh.nodes[n];
            (x - x0).hypot(y - y0).hypot(z - z0) < 4.5e-3
        })
    };
    (0..mesh.n_elements()).filter(near).collect()
}

fn base(ring: &Ring) -> CyclicBordered {
    CyclicBordered::new(ring.ring.factor(&ring.shifted()).unwrap(), &[], 0, &[]).unwrap()
}

/// Wrong: displacements of a ring with soft or stiff elements would not be those of its assembled matrix.
#[test]
fn a_ring_with_changed_elements_is_solved_as_its_assembled_matrix() {
    for (ring, _) in rings() {
        for factor in [0.5, 0.01, 2.0] {
            let change = softened(&ring.mesh, &patch(&ring.mesh), factor);
            let mut assembled = ring.assembled(SHIFT);
            let n = change.rows.len();
            for (i, &row) in change.rows.iter().enumerate() {
                for (j, &column) in change.rows.iter().enumerate() {
                    let value = change.values[n * i + j];
                    if value != 0.0 {
                        *assembled.get_mut(row, column).unwrap() += value;
                    }
                }
            }
            let all: Vec<usize> = (0..ring.mesh.n_dofs()).collect();
            let sparse = ring.sparse(&assembled, &all);
            let cyclic = CyclicDefect::new(base(&ring), &change).unwrap();
            let mut found = loads(2 * all.len());
            let mut expected = found.clone();
            cyclic.solve(&mut found, 2);
            sparse.solve(&mut expected, 2);
            for (found, expected) in found.chunks(all.len()).zip(expected.chunks(all.len())) {
                // Rounding of both factors, with what soft elements lose.
                assert_close(found, expected, 1e-11);
            }
        }
    }
}

/// Wrong: the direct forces of a defect would not be where conjugate gradients with the regular ring as preconditioner converge, or
/// these would not converge as fast as they do: 13 iterations for half or twice the modulus, 60 to 86 for a hundredth.
#[test]
fn conjugate_gradients_on_the_true_matrix_end_at_the_direct_solution() {
    for (ring, _) in rings() {
        for (factor, most) in [(0.5, 20), (0.01, 90), (2.0, 20)] {
            let change = softened(&ring.mesh, &patch(&ring.mesh), factor);
            let base = base(&ring);
            let nodes = change.rows.iter().map(|row| row / 3);
            let table = ResponseTable::new(base.inner(), &ring.ring.section_nodes(nodes));
            let n = change.rows.len();
            let compliance: Vec<f64> = (0..n * n)
                .map(|ij| table.between(change.rows[ij / n], change.rows[ij % n]))
                .collect();
            let mut x = loads(ring.mesh.n_dofs());
            base.solve(&mut x, 1);
            let at: Vec<f64> = change.rows.iter().map(|&row| x[row]).collect();
            let (forces, iterations) = conjugate_gradients(&compliance, &change.values, &at);
            let direct = CyclicDefect::new(base, &change).unwrap();
            println!("{factor} times the modulus on {n} rows: {iterations} iterations");
            assert!((5..most).contains(&iterations), "{iterations} iterations");
            assert_close(&forces, &direct.defect().forces(&at), 1e-6);
        }
    }
}

/// Wrong: elements that are gone twice over would be solved for, with a nonsense answer.
#[test]
fn a_change_that_leaves_no_positive_definite_matrix_is_refused() {
    let (ring, _) = rings().swap_remove(0);
    let change = softened(&ring.mesh, &patch(&ring.mesh), -30.0);
    let error = CyclicDefect::new(base(&ring), &change).unwrap_err();
    let is_refused =
        matches!(&error, SolverError::NotPositiveDefinite { row, .. } if change.rows.contains(row));
    assert!(is_refused, "{error}");
}
