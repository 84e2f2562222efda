//! A dense factor as a linear solver.

use crate::common::{Numbers, assert_close};
use dense::DenseCholesky;
use solver::LinearSolver;

/// Hilbert-like but well conditioned: a_ij = 1/(1 + |i - j|) + n on the diagonal.
fn definite(n: usize) -> Vec<f64> {
    (0..n * n)
        .map(|k| (k / n, k % n))
        .map(|(i, j)| 1.0 / (1.0 + i.abs_diff(j) as f64) + if i == j { n as f64 } else { 0.0 })
        .collect()
}

/// If this failed, code written for any factorisation could not use a dense one.
#[test]
fn dense_cholesky_is_a_linear_solver() {
    let n = 50;
    let a = definite(n);
    let solver: Box<dyn LinearSolver> = Box::new(DenseCholesky::factor(n, &a).unwrap());
    let x = Numbers::new(9).vector(2 * n);
    let mut b: Vec<f64> = (0..2 * n)
        .map(|k| (0..n).map(|l| a[n * (k % n) + l] * x[n * (k / n) + l]).sum())
        .collect();
    solver.solve(&mut b, 2);
    assert_close(&b, &x, 1e-14);
    assert_eq!((solver.n(), solver.factor_bytes()), (n, 8 * n * n));
}
