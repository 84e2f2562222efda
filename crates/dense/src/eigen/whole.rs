//! Whole eigenproblems of a few hundred unknowns by dense matrices.
//!
//! Time about 18 n^3, memory 3 n^2.

use super::basis::{inner_products, linear_combinations};
use super::problem::{EigenProblem, Eigenpairs};
use super::symmetric::symmetric_eigen;
use crate::error::DenseError;

/// Eigenvalue of a mass matrix, over its largest, that is round-off of a dof without mass.
const MASSLESS: f64 = 1e-13;
/// Eigenvalue of the operator, over its largest, that is round-off of an infinite lambda.
const INFINITE: f64 = 1e-14;

/// The lowest pairs of a small problem, at most `n_pairs`: all finite ones are found.
///
/// With the mass M = B B^T, the operator's eigenvectors are those of B^T (K + s M)^-1 B, a symmetric matrix in which
/// neither dofs without mass nor constrained motions appear.
pub fn dense_lowest(problem: &dyn EigenProblem, n_pairs: usize) -> Result<Eigenpairs, DenseError> {
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
