//! Solutions, their bits, and what is refused.

use mesh::{ElementKind, revolve};
use solver::{Coupling, CyclicMatrix, LinearSolver, SolverError, Symmetry};

use super::rings::{Ring, SHIFT, assert_agree, loads, rings, section};
use crate::common::assert_close;

/// Wrong: a step of a free ring would move it otherwise than the assembled matrix does.
#[test]
fn a_free_ring_with_mass_is_solved_as_by_the_sparse_factor() {
    for (ring, symmetry) in rings() {
        let free: Vec<usize> = (0..ring.mesh.n_dofs()).collect();
        let cyclic = ring.ring.factor(&ring.shifted()).unwrap();
        assert_eq!(cyclic.symmetry(), symmetry);
        let sparse = ring.sparse(&ring.assembled(SHIFT), &free);
        assert_agree(&cyclic, &sparse, 1e-12);
    }
}

/// Wrong: the statics of a ring clamped at its bore would differ from that of the assembled matrix.
#[test]
fn a_clamped_ring_is_solved_as_by_the_sparse_factor() {
    for (ring, symmetry) in rings() {
        let [keep, free] = ring.without_bore();
        let matrix = ring.stiffness.restricted(&keep);
        let cyclic = ring
            .ring
            .restricted(&matrix, &keep)
            .unwrap()
            .factor(&matrix)
            .unwrap();
        assert_eq!(cyclic.symmetry(), symmetry);
        assert_agree(&cyclic, &ring.sparse(&ring.assembled(0.0), &free), 1e-12);
    }
}

/// Wrong: the real form of mirrored sections would be another matrix than the Hermitian form, which needs no symmetry.
#[test]
fn the_real_and_the_hermitian_form_agree() {
    for n in [24, 15] {
        let mesh = revolve(&section(), n, ElementKind::Hex20, &[]).unwrap();
        let real = Ring::new(mesh.clone());
        let periodicity = real.periodicity.clone();
        let hermitian = Ring::with_offsets(mesh, periodicity, None);
        let factors = [&real, &hermitian].map(|ring| ring.ring.factor(&ring.shifted()).unwrap());
        assert_eq!(factors[0].symmetry(), Symmetry::Mirrored);
        assert_eq!(factors[1].symmetry(), Symmetry::None);
        assert_eq!(2 * factors[0].factor_bytes(), factors[1].factor_bytes());
        for factor in &factors {
            let ring = factor.ring();
            assert_eq!(ring.factor_bytes(factor.symmetry()), factor.factor_bytes());
        }
        let [real_flops, hermitian_flops] =
            [Symmetry::Mirrored, Symmetry::None].map(|symmetry| factors[0].ring().flops(symmetry));
        assert_eq!(4.0 * real_flops, hermitian_flops);
        let mut solutions = [(); 2].map(|()| loads(real.mesh.n_dofs()));
        factors
            .iter()
            .zip(&mut solutions)
            .for_each(|(f, x)| f.solve(x, 1));
        assert_close(&solutions[0], &solutions[1], 1e-12);
    }
}

/// Wrong: the same scene would give other bits on another number of threads.
#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let ring = Ring::new(revolve(&section(), 90, ElementKind::Hex8, &[]).unwrap());
    let matrix = ring.shifted();
    let results: Vec<Vec<f64>> = [1, 2, 4]
        .into_iter()
        .map(|n_threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(n_threads)
                .build()
                .unwrap();
            pool.install(|| {
                let mut x = loads(5 * ring.mesh.n_dofs());
                ring.ring.factor(&matrix).unwrap().solve(&mut x, 5);
                x.extend(ring.ring.apply(&matrix, &x[..ring.mesh.n_dofs()]).unwrap());
                x
            })
        })
        .collect();
    assert!(results[1..].iter().all(|other| *other == results[0]));
}

/// Wrong: a new step size would be solved with the factor of the old one, or with other bits than a fresh factor.
#[test]
fn a_factor_made_in_the_memory_of_another_has_the_same_bits() {
    for (ring, _) in rings() {
        let other = ring.stiffness.combined(0.5, 9.0 * SHIFT, &ring.mass).unwrap();
        let fresh = ring.ring.factor(&ring.shifted()).unwrap();
        let again = ring
            .ring
            .factor(&other)
            .unwrap()
            .refactored(&ring.shifted())
            .unwrap();
        let mut solutions = [(); 2].map(|()| loads(ring.mesh.n_dofs()));
        fresh.solve(&mut solutions[0], 1);
        again.solve(&mut solutions[1], 1);
        assert_eq!(solutions[0], solutions[1]);
    }
}
/// Wrong: a free ring without mass, which can move as a whole, would get a solution that is nothing but round-off.
#[test]
fn a_ring_free_to_move_is_refused() {
    for n in [24, 15] {
        let ring = Ring::new(revolve(&section(), n, ElementKind::Hex8, &[]).unwrap());
        let error = ring.ring.factor(&ring.stiffness).unwrap_err();
        let is_refused = matches!(
            error,
            SolverError::NotPositiveDefinite { .. } | SolverError::Singular { .. }
        );
        assert!(is_refused, "{error}");
        assert!(error.row().unwrap() < ring.mesh.n_dofs());
    }
}

/// Wrong: blocks that make no symmetric matrix would be taken, and half of them ignored.
#[test]
fn couplings_that_make_no_symmetric_matrix_are_refused() {
    let own = Coupling {
        row: 0,
        column: 0,
        shift: 0,
    };
    let next = Coupling { shift: 1, ..own };
    let back = Coupling { shift: -1, ..own };
    let (unit, mut skew) = ([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], [0.0; 9]);
    let refused = |couplings: &[Coupling], blocks: &[[f64; 9]]| {
        CyclicMatrix::new(5, 1, couplings, blocks)
            .unwrap_err()
            .to_string()
    };
    let text = refused(&[own, next], &[unit, skew]);
    assert!(text.starts_with(
        "the coupling of section node 0 with section node 0, 1 sectors farther, has no opposite"
    ));
    assert!(refused(&[next, back], &[unit, unit]).contains("is missing"));
    assert!(refused(&[own, own], &[unit, unit]).contains("is given twice"));
    assert!(refused(&[own, Coupling { row: 1, ..own }], &[unit, unit]).contains("does not exist"));
    skew[1] = 0.5;
    assert!(refused(&[own, next, back], &[unit, skew, skew]).contains("expected transposed blocks"));
    skew[1] = f64::NAN;
    assert!(refused(&[own], &[skew]).contains("expected finite numbers"));
}
