//! Solves in two halves.

use solver::LinearSolver;
use solver::cyclic::CyclicBordered;

use super::rings::{loads, rings};
use crate::common::assert_close;

/// Section nodes on one line and one beside it, not ascending.
const LAST: [usize; 4] = [5, 1, 3, 2];

/// Wrong: contact forces that come in between the two sweeps of a solve would move the ring otherwise than in a solve
/// of their own; the raceway would not have moved as it does under the known loads when they are asked for; or
/// sections without mirror symmetry, or the first harmonics with their border, would be solved otherwise; or one
/// group after the other otherwise than all together.
#[test]
fn forces_between_the_halves_of_a_solve_move_the_ring_as_in_a_solve_of_their_own() {
    for (ring, _) in rings() {
        let n = ring.mesh.n_dofs();
        let border: Vec<f64> = ring
            .mesh
            .nodes
            .iter()
            .flat_map(|&[_, y, z]| [0.0, -z, y])
            .collect();
        let bordered = |ring_of: &solver::CyclicRing| {
            let factor = ring_of.factor(&ring.shifted()).unwrap();
            CyclicBordered::new(factor, &border, 1, &[1e16]).unwrap()
        };
        let ended = ring.ring.ending_with(&LAST).unwrap();
        let [plain, halved] = [bordered(&ring.ring), bordered(&ended)];
        let trailing = ended.section_part(&LAST, []);
        let mut known = loads(n);
        known.push(0.7);
        // Forces on the nodes that trail alone, in the space of the ring.
        let mut forces = vec![0.0; ended.harmonic_len()];
        let nodal: Vec<f64> = known[..n].iter().rev().map(|f| 3.0 * f).collect();
        ended.to_harmonic_from(&trailing, &nodal, &mut forces);
        let mut both = vec![0.0; n];
        ended.from_harmonic(&forces, &mut both);
        both.iter_mut()
            .zip(&known)
            .for_each(|(both, known)| *both += known);
        both.push(known[n] - 0.2);

        let [mut early, mut expected] = [known.clone(), both];
        plain.solve(&mut early, 1);
        plain.solve(&mut expected, 1);

        let mut half = vec![0.0; ended.harmonic_len()];
        ended.to_harmonic(&known[..n], &mut half);
        let mut row = [known[n]];
        halved.begin_harmonic(&mut half, &mut row);
        let mut moved = early.clone();
        ended.from_harmonic_at(&trailing, &half, &mut moved[..n]);
        moved[n] = row[0];
        assert_close(&moved, &early, 1e-12);

        let low = ended.low_len();
        let (mut together, mut row_together) = (forces.clone(), [-0.2]);
        halved.begin_trailing_harmonic(&mut together, &mut row_together);
        let mut row_of_forces = [-0.2];
        for (group, (half, forces)) in half
            .chunks_exact_mut(low)
            .zip(forces.chunks_exact_mut(low))
            .enumerate()
        {
            let border = if group == 0 {
                &mut row_of_forces[..]
            } else {
                &mut []
            };
            halved.begin_trailing_group(group, forces, border);
            half.iter_mut().zip(&*forces).for_each(|(half, f)| *half += f);
        }
        assert!(together == forces && row_together == row_of_forces);
        let mut groups = half.clone();
        let parts = groups.chunks_exact_mut(low).enumerate();
        parts.for_each(|(group, part)| halved.finish_group(group, part));
        halved.finish_harmonic(&mut half);
        assert!(groups == half);
        let mut found = vec![0.0; n + 1];
        ended.from_harmonic(&half, &mut found[..n]);
        found[n] = row[0] + row_of_forces[0];
        assert_close(&found, &expected, 1e-12);
    }
}

/// Wrong: a ring whose order ends nowhere in particular, as a ring that ranks share or one with a defect has it,
/// would have to be treated in another way than one that ends with its raceway.
#[test]
fn without_nodes_that_trail_the_first_half_is_all() {
    let (ring, _) = rings().swap_remove(0);
    let factor = ring.ring.factor(&ring.shifted()).unwrap();
    let solver = CyclicBordered::new(factor, &[], 0, &[]).unwrap();
    let mut half = vec![0.0; ring.ring.harmonic_len()];
    ring.ring.to_harmonic(&loads(ring.mesh.n_dofs()), &mut half);
    let mut whole = half.clone();
    solver.solve_harmonic(&mut [&mut whole], &mut []);
    solver.begin_harmonic(&mut half, &mut []);
    assert!(half == whole);
    solver.finish_harmonic(&mut half);
    assert!(half == whole);
}

/// Wrong: a force on a node whose forward sweep is over would be lost in silence.
#[test]
#[should_panic(expected = "loads on nodes that trail")]
fn forces_elsewhere_are_refused_between_the_halves() {
    let (ring, _) = rings().swap_remove(0);
    let ended = ring.ring.ending_with(&LAST).unwrap();
    let solver = CyclicBordered::new(ended.factor(&ring.shifted()).unwrap(), &[], 0, &[]).unwrap();
    let mut forces = vec![0.0; ended.low_len()];
    forces[0] = 1.0;
    solver.begin_trailing_group(1, &mut forces, &mut []);
}
