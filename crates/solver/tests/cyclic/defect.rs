//! Rings with a defect: the sparse factor's solutions, and those of conjugate gradients.

use fem::Material;
use mesh::Mesh;
use solver::cyclic::{Change, CyclicDefect, RowResponses, conjugate_gradients};
use solver::{CyclicBordered, LinearSolver, ResponseTable, SolverError};

use super::rings::{Ring, SHIFT, loads, rings, steel};
use crate::common::assert_close;

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
        loose: None,
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

/// Wrong: the direct forces of a defect would not be where conjugate gradients with the regular ring as
/// preconditioner converge, or these would not converge as fast as they do: 13 iterations for half or twice the
/// modulus, 60 to 86 for a hundredth.
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

/// Wrong: elements that are gone with their inner nodes would not be those of the assembled matrix without them, or
/// callers would meet nodes that they do not have.
#[test]
fn a_ring_that_lacks_elements_and_nodes_is_solved_as_its_assembled_matrix() {
    for (ring, _) in rings() {
        let lost = patch(&ring.mesh);
        let mut nodes: Vec<usize> = lost.iter().flat_map(|&e| ring.mesh.element(e)).copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let mut is_there = vec![false; ring.mesh.n_nodes()];
        let kept = (0..ring.mesh.n_elements()).filter(|e| lost.binary_search(e).is_err());
        kept.flat_map(|e| ring.mesh.element(e))
            .for_each(|&node| is_there[node] = true);
        let seen: Vec<usize> = (0..is_there.len()).filter(|&node| is_there[node]).collect();
        assert!(seen.len() < is_there.len(), "no node is gone");
        // Rows by the caller's numbers, those that are gone last.
        nodes.sort_by_key(|&node| !is_there[node]);
        let part = ring.mesh.part(&lost, &{
            let mut sorted = nodes.clone();
            sorted.sort_unstable();
            sorted
        });
        let row = |local: usize| {
            let x = part.nodes[local / 3];
            3 * nodes.iter().position(|&node| ring.mesh.nodes[node] == x).unwrap() + local % 3
        };
        let (stiffness, pattern) = (
            fem::assemble_stiffness(&part, &steel()).unwrap(),
            fem::Pattern::new(&part).unwrap(),
        );
        let mass = fem::assemble_node_mass(&pattern, &part, &steel()).unwrap();
        let size = 3 * nodes.len();
        let mut values = vec![0.0; size * size];
        for (&k, (i, j)) in stiffness.iter() {
            values[size * row(i) + row(j)] -= k;
        }
        for (&m, (a, b)) in mass.iter() {
            (0..3).for_each(|c| values[size * row(3 * a + c) + row(3 * b + c)] -= SHIFT * m);
        }
        let mut assembled = ring.assembled(SHIFT);
        for (i, a) in nodes.iter().enumerate() {
            for (j, b) in nodes.iter().enumerate() {
                for cd in 0..9 {
                    let change = values[size * (3 * i + cd / 3) + 3 * j + cd % 3];
                    if change != 0.0 {
                        *assembled.get_mut(3 * a + cd / 3, 3 * b + cd % 3).unwrap() += change;
                    }
                }
            }
        }
        let free: Vec<usize> = seen.iter().flat_map(|node| 3 * node..3 * node + 3).collect();
        let rows = nodes.iter().filter_map(|node| seen.binary_search(node).ok());
        let rows: Vec<usize> = rows.flat_map(|node| 3 * node..3 * node + 3).collect();
        let change = Change::condensed(rows, Vec::new(), &values).unwrap();
        let cyclic = CyclicDefect::new(
            base(&ring).seen_at(&seen.iter().copied().map(Some).collect::<Vec<_>>()),
            &change,
        )
        .unwrap();
        assert_eq!(cyclic.n(), free.len());
        let mut found = loads(free.len());
        let mut expected = found.clone();
        cyclic.solve(&mut found, 1);
        ring.sparse(&assembled, &free).solve(&mut expected, 1);
        assert_close(&found, &expected, 1e-11);
    }
}

/// Wrong: rows of a defect would not move under loads on patches as solves for these loads say, or the small table of
/// the raceway would not be part of the large one.
#[test]
fn rows_of_a_defect_move_under_patches_as_solves_say() {
    for (ring, _) in rings() {
        let factor = ring.ring.factor(&ring.shifted()).unwrap();
        let (raceway, others) = ([4, 1, 7], [11, 0, 5]);
        let table = ResponseTable::new(&factor, &[raceway, others].concat());
        let first = table.first(raceway.len());
        let (n, width) = (ring.periodicity.n_sectors(), ring.periodicity.n_section_nodes());
        let node = |sector: usize, i: usize| ring.periodicity.nodes()[(sector % n) * width + i];
        // Single components of nodes in three sectors, of the raceway as well.
        let rows: Vec<usize> = [
            (2, 0, 1),
            (1, 11, 0),
            (2, 5, 2),
            (1, 4, 1),
            (n - 1, 0, 0),
            (2, 11, 1),
        ]
        .map(|(sector, i, component)| 3 * node(sector, i) + component)
        .to_vec();
        let responses = RowResponses::new(&table, raceway.len(), &rows);
        let (values, mut patches, mut expected) = (loads(200), Vec::new(), vec![0.0; 6 * rows.len()]);
        for (p, sector) in [0, 1, n - 1].into_iter().enumerate() {
            let nodes = [0, 1, 2, 3].map(|i| node(sector + i / 2, raceway[(p + i) % 3]));
            let value = |i: usize, q: usize, c: usize| values[24 * p + 6 * i + 3 * q + c];
            let weights = [0, 1, 2, 3].map(|i| [0, 1].map(|q| [0, 1, 2].map(|c| value(i, q, c))));
            patches.push(first.patch(&[(&nodes, &weights)]).unwrap());
            for q in 0..2 {
                let mut u = vec![0.0; ring.mesh.n_dofs()];
                for (node, w) in nodes.iter().zip(&weights) {
                    (0..3).for_each(|c| u[3 * node + c] += w[q][c]);
                }
                factor.solve(&mut u, 1);
                for (i, &row) in rows.iter().enumerate() {
                    expected[6 * i + 2 * p + q] = u[row];
                }
            }
        }
        assert_close(&responses.of_patches(&patches), &expected, 1e-12);
        assert_eq!(responses.bytes(), RowResponses::bytes_of(n, 3, 4));
        let small = ResponseTable::new(&factor, &raceway);
        assert_eq!(first.compliances(&patches), small.compliances(&patches));
    }
}
