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
        let (len, first) = (self.group_len(), self.own_groups().start);
        y.par_chunks_mut(len)
            .zip(x.par_chunks(len))
            .enumerate()
            .for_each(|(i, (y, x))| self.apply_group(matrix, first + i, x, y));
        Ok(())
    }

    /// The same for one group's part of the vectors; the pattern of `matrix` is the ring's.
    pub(super) fn apply_group(&self, matrix: &CyclicMatrix, group: usize, x: &[f64], y: &mut [f64]) {
        Arch::new().dispatch(Product {
            shared: &self.shared,
            matrix,
            group,
            x,
            y,
        });
    }

    /// A x of nodal vectors, `[n]`, through the sectors.
    ///
    /// # Panics
    /// When the length is another.
    pub fn apply(&self, matrix: &CyclicMatrix, x: &[f64]) -> Result<Vec<f64>, SolverError> {
        Ok(self.operator(matrix)?.apply(x))
    }
}
