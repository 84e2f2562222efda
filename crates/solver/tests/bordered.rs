//! Borders of a factored matrix against the whole matrix, and the borders that are refused.

use dense::DenseCholesky;
use solver::{Bordered, LinearSolver, SolverError, SparseCholesky, Symbolic};

use crate::common::{Ring, assert_close, dense};

/// A sparse factor and its matrix.
fn factored() -> (SparseCholesky, Vec<f64>) {
    let ring = Ring::new(12, 2, 1);
    let matrix = ring.stiffness_with_mass(0.1);
    let factor = Symbolic::new(&matrix, &ring.order())
        .unwrap()
        .factor(&matrix)
        .unwrap();
    (factor, dense(&matrix))
}

/// A border of `m` columns with entries everywhere.
fn border(n: usize, m: usize) -> Vec<f64> {
    (0..n * m)
        .map(|i| ((7 * i + 3) % 23) as f64 / 23.0 - 0.5)
        .collect()
}

/// Row-major m x m matrix with `diagonal` on its diagonal and tenths beside it.
fn corner(m: usize, diagonal: f64) -> Vec<f64> {
    (0..m * m)
        .map(|ij| if ij / m == ij % m { diagonal } else { 0.1 })
        .collect()
}

/// Wrong: the rows of the border, or those of the factor under the border's influence, would be solved for another
/// matrix than the bordered one.
#[test]
fn a_bordered_factor_solves_the_bordered_matrix() {
    for m in [1, 5] {
        let (inner, a) = factored();
        let n = inner.n();
        let (b, d) = (border(n, m), corner(m, 500.0));
        let mut whole = vec![0.0; (n + m) * (n + m)];
        for i in 0..n {
            whole[(n + m) * i..(n + m) * i + n].copy_from_slice(&a[n * i..n * (i + 1)]);
            for k in 0..m {
                whole[(n + m) * i + n + k] = b[n * k + i];
                whole[(n + m) * (n + k) + i] = b[n * k + i];
            }
        }
        for k in 0..m {
            let start = (n + m) * (n + k) + n;
            whole[start..start + m].copy_from_slice(&d[m * k..m * (k + 1)]);
        }
        let expected_factor = DenseCholesky::factor(n + m, &whole).unwrap();
        let bordered = Bordered::new(inner, &b, m, &d).unwrap();
        assert_eq!(bordered.n(), n + m);
        let mut found: Vec<f64> = (0..3 * (n + m))
            .map(|i| ((5 * i + 1) % 17) as f64 - 8.0)
            .collect();
        let mut expected = found.clone();
        bordered.solve(&mut found, 3);
        expected_factor.solve(&mut expected, 3);
        assert_close(&found, &expected, 1e-12);
    }
}

/// Wrong: a rigid partner without stiffness of its own, or a border of nonsense, would be solved for in silence.
#[test]
fn a_border_that_is_not_positive_definite_is_refused_by_row() {
    let (inner, _) = factored();
    let n = inner.n();
    let mut b = border(n, 2);
    let refused = |b: &[f64], d: &[f64]| Bordered::new(factored().0, b, 2, d).unwrap_err();
    // What the border does to the matrix takes all of a corner this soft.
    let error = refused(&b, &corner(2, 1e-3));
    assert_eq!(error, SolverError::NotPositiveDefinite { row: n, n: n + 2 });
    assert_eq!(
        refused(&vec![0.0; 2 * n], &[1.0, 0.0, 0.0, 0.0]).row(),
        Some(n + 1)
    );
    assert_eq!(
        refused(&vec![0.0; 2 * n], &[1.0, 0.0, 0.0, f64::NAN]).row(),
        Some(n + 1)
    );
    b[n + 4] = f64::NAN;
    assert_eq!(refused(&b, &corner(2, 500.0)).row(), Some(4));
}
