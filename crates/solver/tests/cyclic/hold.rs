//! Rings held by others than whole rings of nodes: by nothing, or by a rigid partner.

use dense::DenseCholesky;
use mesh::Mesh;
use solver::{Bordered, CyclicBordered, LinearSolver, SolverError};

use super::rings::{Ring, SHIFT, loads, rings};
use crate::common::assert_close;

/// Takes the resultant force and moment out of nodal loads: subtracts the combination of rigid motions they work on.
fn balance(mesh: &Mesh, loads: &mut [f64]) {
    let modes = fem::rigid_modes(mesh, [0.0; 3]);
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let gram: Vec<f64> = modes
        .iter()
        .flat_map(|a| modes.iter().map(|b| dot(a, b)))
        .collect();
    let factor = DenseCholesky::factor(modes.len(), &gram).unwrap();
    // Twice: once leaves the rounding of the first.
    for _ in 0..2 {
        let mut parts: Vec<f64> = modes.iter().map(|mode| dot(mode, loads)).collect();
        factor.solve(&mut parts, 1);
        for (part, mode) in parts.iter().zip(&modes) {
            loads.iter_mut().zip(mode).for_each(|(f, m)| *f -= part * m);
        }
    }
}

/// Wrong: a ring held in its mean motion would feel the springs that hold it, and its oval shape would be off.
#[test]
fn a_ring_that_nothing_holds_deforms_freely_under_balanced_loads() {
    for (ring, symmetry) in rings() {
        let mut balanced = loads(ring.mesh.n_dofs());
        balance(&ring.mesh, &mut balanced);
        let factor = ring.ring.factor_unheld(&ring.stiffness).unwrap();
        assert_eq!(factor.symmetry(), symmetry);
        let mut found = balanced.clone();
        factor.solve(&mut found, 1);
        let product = ring.ring.apply(&ring.stiffness, &found).unwrap();
        let stiffest = ring
            .assembled(0.0)
            .data()
            .iter()
            .fold(0.0_f64, |m, x| m.max(x.abs()));
        let largest = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let residual: Vec<f64> = product.iter().zip(&balanced).map(|(p, f)| p - f).collect();
        // Backward error: rounding of some hundred operations.
        let error = largest(&residual) / (stiffest * largest(&found) + 1.0);
        assert!(error < 1e-14, "{error:e}");

        // Six dofs fixed instead: the same but for a rigid motion, taken out in both.
        let free: Vec<usize> = (0..ring.mesh.n_dofs())
            .filter(|dof| !supports(&ring).contains(dof))
            .collect();
        let sparse = ring.sparse(&ring.assembled(0.0), &free);
        let mut part: Vec<f64> = free.iter().map(|&dof| balanced[dof]).collect();
        sparse.solve(&mut part, 1);
        let mut expected = vec![0.0; found.len()];
        free.iter().zip(part).for_each(|(&dof, x)| expected[dof] = x);
        balance(&ring.mesh, &mut expected);
        balance(&ring.mesh, &mut found);
        // Rigid motions of the sparse solution are some thousand times the deformation.
        assert_close(&found, &expected, 1e-8);
    }
}

/// Six dofs that hold a body: a node in three directions, a second in two, a third in one.
fn supports(ring: &Ring) -> [usize; 6] {
    let (nodes, width) = (ring.periodicity.nodes(), ring.periodicity.n_section_nodes());
    let quarter = ring.periodicity.n_sectors() / 4;
    let [a, b, c] = [nodes[0], nodes[quarter * width], nodes[2 * quarter * width]];
    [3 * a, 3 * a + 1, 3 * a + 2, 3 * b + 2, 3 * c + 1, 3 * c + 2]
}

/// Wrong: a bore that follows the shaft would not move as it does in the matrix with the shaft's rows assembled.
#[test]
fn a_bore_that_follows_five_rigid_dofs_is_a_border() {
    for (ring, _) in rings() {
        let [keep, free] = ring.without_bore();
        let (n_dofs, shifted) = (ring.mesh.n_dofs(), ring.shifted());
        // Rigid motions of the bore: translations and the two tilts.
        let modes: Vec<Vec<f64>> = [0, 1, 2, 3, 4]
            .iter()
            .map(|&i| {
                let mut mode = fem::rigid_modes(&ring.mesh, [0.0; 3])[i].clone();
                free.iter().for_each(|&dof| mode[dof] = 0.0);
                mode
            })
            .collect();
        let forces: Vec<Vec<f64>> = modes
            .iter()
            .map(|mode| ring.ring.apply(&shifted, mode).unwrap())
            .collect();
        let border: Vec<f64> = forces
            .iter()
            .flat_map(|f| free.iter().map(|&dof| f[dof]))
            .collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let corner: Vec<f64> = modes
            .iter()
            .flat_map(|m| forces.iter().map(|f| dot(m, f)))
            .collect();
        let matrix = shifted.restricted(&keep);
        let factor = ring
            .ring
            .restricted(&matrix, &keep)
            .unwrap()
            .factor(&matrix)
            .unwrap();
        let bordered = Bordered::new(factor.clone(), &border, 5, &corner).unwrap();
        let low = CyclicBordered::new(factor, &border, 5, &corner).unwrap();

        // T^T A T w with w = T [x; q] must be the load, whatever way A is applied.
        let n = bordered.n();
        assert_eq!(n, free.len() + 5);
        let rhs = loads(2 * n);
        let mut found = rhs.clone();
        bordered.solve(&mut found, 2);
        let mut in_harmonics = rhs.clone();
        low.solve(&mut in_harmonics, 2);
        assert_close(&in_harmonics, &found, 1e-12);
        let assembled = ring.assembled(SHIFT);
        for (found, rhs) in found.chunks(n).zip(rhs.chunks(n)) {
            let mut w = vec![0.0; n_dofs];
            free.iter().zip(found).for_each(|(&dof, x)| w[dof] = *x);
            for (q, mode) in found[free.len()..].iter().zip(&modes) {
                w.iter_mut().zip(mode).for_each(|(w, m)| *w += q * m);
            }
            let f = crate::common::product(&assembled, &w);
            let mut reduced: Vec<f64> = free.iter().map(|&dof| f[dof]).collect();
            reduced.extend(modes.iter().map(|mode| dot(mode, &f)));
            assert_close(&reduced, rhs, 1e-10);
        }
    }
}

/// Wrong: a partner that is not rigid, or holds parts of rings only, would lose all but its lowest harmonics in
/// silence.
#[test]
fn a_border_beyond_the_lowest_harmonics_is_refused() {
    let (ring, _) = rings().swap_remove(0);
    let factor = ring.ring.factor(&ring.shifted()).unwrap();
    let mut border = vec![0.0; 2 * ring.mesh.n_dofs()];
    (0..ring.mesh.n_nodes()).for_each(|node| border[3 * node + 2] = 1.0);
    let place = ring.mesh.n_dofs() + 7;
    border[place] = 1.0;
    let error = CyclicBordered::new(factor, &border, 2, &[1e12, 0.0, 0.0, 1e12]).unwrap_err();
    assert!(
        matches!(error, SolverError::BorderBeyond { column: 1, share } if share > 0.1),
        "{error}"
    );
    assert!(
        error
            .to_string()
            .contains("expected rigid motions of whole rings of nodes")
    );
}

/// Wrong: a pass over the groups of harmonics would not find the solution that a solve of all finds, to the bit.
#[test]
fn one_group_after_the_other_is_solved_as_all_together() {
    for (ring, _) in rings() {
        let n = ring.mesh.n_dofs();
        let nodes = &ring.mesh.nodes;
        let border: Vec<f64> = nodes.iter().flat_map(|&[_, y, z]| [0.0, -z, y]).collect();
        let factor = ring.ring.factor(&ring.shifted()).unwrap();
        let whole = CyclicBordered::new(factor, &border, 1, &[1e16]).unwrap();
        let load = loads(n);
        let mut harmonic = vec![0.0; ring.ring.harmonic_len()];
        ring.ring.to_harmonic(&load, &mut harmonic);
        let (mut parts, mut row) = (harmonic.clone(), [0.7]);
        let low = ring.ring.low_len();
        for (group, part) in parts.chunks_exact_mut(low).enumerate() {
            let border = if group == 0 { &mut row[..] } else { &mut [] };
            whole.solve_group(group, part, border);
        }
        let mut expected_row = [0.7];
        whole.solve_harmonic(&mut [&mut harmonic], &mut expected_row);
        assert!(parts == harmonic && row == expected_row);
    }
}
