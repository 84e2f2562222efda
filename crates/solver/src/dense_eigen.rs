//! Dense symmetric eigenproblems: the projected matrix of Lanczos, and whole problems of a few hundred unknowns.
//!
//! Time about 9 n^3 for the pairs of one matrix, memory 3 n^2.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::{Mat, MatRef, Par};

use crate::eigenproblem::{EigenProblem, Eigenpairs};
use crate::error::SolverError;
use crate::lanczos::basis::{inner_products, linear_combinations};

/// Eigenvalue of a mass matrix, over its largest, that is round-off of a dof without mass.
const MASSLESS: f64 = 1e-13;
/// Eigenvalue of the operator, over its largest, that is round-off of an infinite lambda.
const INFINITE: f64 = 1e-14;

/// Eigenvalues, ascending `[n]`, and orthonormal eigenvectors, column-major `[n][n]`, of the symmetric matrix `a`, `[n][n]`,
/// of which the lower triangle of the row-major matrix is read.
///
/// # Panics
/// When `a.len() != n * n`.
pub fn symmetric_eigen(n: usize, a: &[f64]) -> Result<(Vec<f64>, Vec<f64>), SolverError> {
    assert_eq!(a.len(), n * n, "a dense matrix of {n} rows");
    if n == 0 {
        return Ok((Vec::new(), Vec::new()));
    }
    if !a.iter().all(|x| x.is_finite()) {
        return Err(SolverError::EigenNotFinite);
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
    .map_err(|_| SolverError::EigenNotConverged {
        wanted: n,
        converged: 0,
        steps: 0,
    })?;
    let values = (0..n).map(|i| scale * values[i]).collect();
    let vectors = (0..n * n).map(|k| vectors[(k % n, k / n)]).collect();
    Ok((values, vectors))
}

/// The power of two next below the largest entry; 1 for a zero matrix. Dividing by it is exact, and the factorisation, whose
/// thresholds are absolute, then sees a matrix of ordinary size: unscaled, entries of 1e-11 cost ten digits.
fn power_of_two(a: &[f64]) -> f64 {
    let largest = a.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    if largest == 0.0 {
        return 1.0;
    }
    // Not 2^-1074 and the like, by which 1 cannot be divided.
    largest.log2().floor().clamp(-1000.0, 1000.0).exp2()
}

/// The lowest pairs of a small problem, at most `n_pairs`: all finite ones are found.
///
/// With the mass M = B B^T, the operator's eigenvectors are those of B^T (K + s M)^-1 B, a symmetric matrix in which neither
/// dofs without mass nor constrained motions appear.
pub fn dense_lowest(problem: &dyn EigenProblem, n_pairs: usize) -> Result<Eigenpairs, SolverError> {
    let n = problem.n();
    let mut unit = vec![0.0; n * n];
    unit.iter_mut().step_by(n + 1).for_each(|x| *x = 1.0);
    let (mass_values, mass_vectors) = symmetric_eigen(n, &symmetrised(n, problem.mass(&unit, n)))?;
    let largest = mass_values.last().copied().unwrap_or(0.0);
    let mut root = Vec::new();
    for (value, vector) in mass_values.iter().zip(mass_vectors.chunks_exact(n.max(1))) {
        if *value > MASSLESS * largest {
            root.extend(vector.iter().map(|x| value.sqrt() * x));
        }
    }
    let rank = root.len().checked_div(n).unwrap_or(0);
    let solved = problem.solve(root.clone(), rank);
    let operator = symmetrised(rank, inner_products(n, &root, rank, &solved, rank));
    let (thetas, modes) = symmetric_eigen(rank, &operator)?;
    let top = thetas.last().copied().unwrap_or(0.0);
    let finite = thetas.iter().rev().take_while(|theta| **theta > INFINITE * top);
    let kept = finite.count().min(n_pairs);
    let vectors = linear_combinations(n, &solved, rank, &modes[rank * (rank - kept)..], kept);
    Eigenpairs::new(problem, vectors)
}

fn symmetrised(n: usize, mut a: Vec<f64>) -> Vec<f64> {
    for i in 0..n {
        for j in 0..i {
            let mean = 0.5 * (a[n * i + j] + a[n * j + i]);
            (a[n * i + j], a[n * j + i]) = (mean, mean);
        }
    }
    a
}
