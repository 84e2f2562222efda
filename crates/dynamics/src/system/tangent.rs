//! The tangent of a system: its scale and its factors.

use std::ops::Range;

use dense::{BlockLu, DenseCholesky, DenseError};

/// A tangent, factored: by Cholesky where it belongs to an energy, else by LU.
pub enum TangentFactors {
    /// Of an energy.
    Cholesky(DenseCholesky),
    /// Of any forces.
    Lu(BlockLu),
}

impl TangentFactors {
    /// Factors a tangent over `n` unknowns, row-major; LU eliminates `blocks` first.
    pub fn new(
        n: usize,
        tangent: &[f64],
        has_energy: bool,
        blocks: &[Range<usize>],
    ) -> Result<TangentFactors, DenseError> {
        Ok(match has_energy {
            true => TangentFactors::Cholesky(DenseCholesky::factor(n, tangent)?),
            false => TangentFactors::Lu(BlockLu::factor(n, tangent, blocks)?),
        })
    }

    /// Replaces a right-hand side by the solution.
    pub fn solve(&self, rhs: &mut [f64]) {
        match self {
            TangentFactors::Cholesky(factors) => factors.solve(rhs, 1),
            TangentFactors::Lu(factors) => factors.solve(rhs),
        }
    }
}

/// Makes a tangent over `n` unknowns, row-major, that of unknowns scaled by `scales`; none are ones.
pub fn scale_tangent(n: usize, scales: &[f64], tangent: &mut [f64]) {
    let scales = scales.iter().enumerate();
    for (i, scale) in scales.filter(|(_, scale)| **scale != 1.0) {
        let row = tangent[n * i..n * (i + 1)].iter_mut();
        row.for_each(|value| *value *= scale);
        let column = tangent[i..].iter_mut().step_by(n);
        column.for_each(|value| *value *= scale);
    }
}
