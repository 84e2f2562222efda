//! Eigenpairs of dense symmetric matrices. Time about 9 n^3, memory 3 n^2.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::{Mat, MatRef, Par};

use crate::error::DenseError;

/// Eigenvalues, ascending `[n]`, and orthonormal eigenvectors, column-major `[n][n]`, of the symmetric matrix `a`,
/// `[n][n]`, of which the lower triangle of the row-major matrix is read.
///
/// # Panics
/// When `a.len() != n * n`.
pub fn symmetric_eigen(n: usize, a: &[f64]) -> Result<(Vec<f64>, Vec<f64>), DenseError> {
    assert_eq!(a.len(), n * n, "a dense matrix of {n} rows");
    if n == 0 {
        return Ok((Vec::new(), Vec::new()));
    }
    if !a.iter().all(|x| x.is_finite()) {
        return Err(DenseError::EigenNotFinite);
    }
    let scale = power_of_two(a);
    let scaled: Vec<f64> = a.iter().map(|x| x / scale).collect();
    let (mut values, mut vectors) = (Diag::<f64>::zeros(n), Mat::<f64>::zeros(n, n));
    let request = self_adjoint_evd_scratch::<f64>(n, ComputeEigenvectors::Yes, Par::Seq, Default::default());
    self_adjoint_evd(
        MatRef::from_row_major_slice(&scaled, n, n),
        values.as_mut(),
        Some(vectors.as_mut()),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(request)),
        Default::default(),
    )
    .map_err(|_| DenseError::EigenNotConverged { n })?;
    let values = (0..n).map(|i| scale * values[i]).collect();
    let vectors = (0..n * n).map(|k| vectors[(k % n, k / n)]).collect();
    Ok((values, vectors))
}

/// The power of two next below the largest entry; 1 for a zero matrix. Dividing by it is exact, and the
/// factorisation, whose thresholds are absolute, then sees a matrix of ordinary size: unscaled, entries of 1e-11 cost
/// ten digits.
fn power_of_two(a: &[f64]) -> f64 {
    let largest = a.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    if largest == 0.0 {
        return 1.0;
    }
    // Not 2^-1074 and the like, by which 1 cannot be divided.
    largest.log2().floor().clamp(-1000.0, 1000.0).exp2()
}
