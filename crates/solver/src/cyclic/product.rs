//! Products of a matrix and a vector, in harmonic and in nodal space: no global matrix.

use pulp::Arch;
use rayon::prelude::*;

use super::assemble::Product;
use super::matrix::CyclicMatrix;
use super::ring::CyclicRing;
use crate::error::SolverError;

impl CyclicRing {
    /// Overwrites `y` with A x in harmonic space, `[harmonic_len()]`; `matrix` has this ring's couplings.
    ///
    /// # Panics
    /// When the lengths are others.
    pub fn apply_harmonic(&self, matrix: &CyclicMatrix, x: &[f64], y: &mut [f64]) -> Result<(), SolverError> {
        matrix.check_pattern(&self.shared.pattern)?;
        assert_eq!(x.len(), self.harmonic_len(), "a vector in harmonic space");
        assert_eq!(y.len(), self.harmonic_len(), "a vector in harmonic space");
        if x.is_empty() {
            return Ok(());
        }
        let (arch, len) = (Arch::new(), self.group_len());
        y.par_chunks_mut(len)
            .zip(x.par_chunks(len))
            .enumerate()
            .for_each(|(group, (y, x))| {
                arch.dispatch(Product {
                    shared: &self.shared,
                    matrix,
                    group,
                    x,
                    y,
                });
            });
        Ok(())
    }

    /// A x of nodal vectors, `[n]`, through the sectors.
    ///
    /// # Panics
    /// When the length is another.
    pub fn apply(&self, matrix: &CyclicMatrix, x: &[f64]) -> Result<Vec<f64>, SolverError> {
        Ok(self.operator(matrix)?.apply(x))
    }
}
