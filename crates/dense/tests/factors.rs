//! The dense factorisations against known inverses, and their errors.

mod common;

use dense::{DenseCholesky, DenseError, DenseLu};

use common::{Numbers, assert_close};

/// Hilbert-like but well conditioned: a_ij = 1/(1 + |i - j|) + n on the diagonal.
fn definite(n: usize) -> Vec<f64> {
    (0..n * n)
        .map(|k| (k / n, k % n))
        .map(|(i, j)| 1.0 / (1.0 + i.abs_diff(j) as f64) + if i == j { n as f64 } else { 0.0 })
        .collect()
}

fn transposed_product(n: usize, a: &[f64], b: &[f64]) -> Vec<f64> {
    (0..n * n)
        .map(|k| (0..n).map(|l| a[n * (k / n) + l] * b[n * l + k % n]).sum())
        .collect()
}

fn identity(n: usize) -> Vec<f64> {
    (0..n * n)
        .map(|k| if k / n == k % n { 1.0 } else { 0.0 })
        .collect()
}

/// If this failed, contact systems would be solved wrongly, or with rows and columns exchanged (the LU matrix is not
/// symmetric).
#[test]
fn inverses_times_their_matrices_are_the_identity() {
    for n in [1, 2, 5, 36, 300] {
        let a = definite(n);
        let inverse = DenseCholesky::factor(n, &a).unwrap().inverse();
        assert_close(&transposed_product(n, &a, &inverse), &identity(n), 1e-12);
        assert!(
            (0..n * n).all(|k| inverse[k] == inverse[n * (k % n) + k / n]),
            "the inverse is symmetric"
        );
        let mut b = Numbers::new(n as u64).vector(n * n);
        (0..n).for_each(|i| b[n * i + (i + 1) % n] += n as f64);
        let inverse = DenseLu::factor(n, &b).unwrap().inverse();
        assert_close(&transposed_product(n, &b, &inverse), &identity(n), 1e-12);
    }
}

/// If this failed, a saddle-point system (zero on its diagonal) would need another solver.
#[test]
fn lu_solves_an_indefinite_system_with_a_zero_diagonal() {
    let lu = DenseLu::factor(3, &[0.0, 2.0, 1.0, 2.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    assert!(
        matches!(lu, Err(DenseError::Singular { row: 2, .. })),
        "rows 2 and 3 are parallel"
    );
    let lu = DenseLu::factor(3, &[0.0, 2.0, 1.0, 2.0, 0.0, 3.0, 1.0, 3.0, 0.0]).unwrap();
    let mut x = vec![2.0 + 1.0, 2.0 + 3.0, 1.0 + 3.0];
    lu.solve(&mut x, 1);
    assert_close(&x, &[1.0, 1.0, 1.0], 1e-15);
}

/// If this failed, a system with rows in newton and rows in metre would be called singular, or a singular one sound.
#[test]
fn row_scales_do_not_decide_what_is_singular() {
    let scaled = [1e12, 2e12, 1e-9, -1e-9];
    let mut x = vec![3e12, 0.0];
    DenseLu::factor(2, &scaled).unwrap().solve(&mut x, 1);
    assert_close(&x, &[1.0, 1.0], 1e-15);
    let parallel = [1e12, 2e12, 1e-9, 2e-9];
    let error = DenseLu::factor(2, &parallel).unwrap_err();
    assert!(
        matches!(error, DenseError::Singular { row: 1, n: 2, .. }),
        "{error}"
    );
    let empty_column = [0.0, 1.0, 0.0, 2.0];
    let error = DenseLu::factor(2, &empty_column).unwrap_err();
    assert!(matches!(error, DenseError::Singular { row: 0, .. }), "{error}");
}

/// If this failed, an unstable contact system would pass as stable, or the wrong unknown be blamed.
#[test]
fn dense_cholesky_names_the_row_at_which_it_breaks_down() {
    for (n, row) in [(1, 0), (40, 0), (40, 17), (200, 199)] {
        let mut a = definite(n);
        a[n * row + row] = -1.0;
        let error = DenseCholesky::factor(n, &a).unwrap_err();
        assert_eq!(error, DenseError::NotPositiveDefinite { row, n });
    }
}

/// If this failed, a number that is none would surface as a wrong solution instead of as a sentence.
#[test]
fn an_entry_that_is_not_a_number_is_named() {
    let error = DenseLu::factor(2, &[1.0, 0.0, f64::NAN, 1.0]).unwrap_err();
    assert!(
        matches!(
            error,
            DenseError::NonFinite {
                row: 1,
                column: 0,
                ..
            }
        ),
        "{error}"
    );
}
