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
        matrix.check_pattern(&self.shared.pattern)?;
        assert_eq!(x.len(), self.n(), "three components per node");
        let shared = &self.shared;
        let (n, width) = (self.n_sectors(), self.n_section_nodes());
        let mut cylindrical = vec![0.0; x.len()];
        for (site, u) in cylindrical.chunks_exact_mut(3).enumerate() {
            let (node, [c, s]) = (shared.nodes[site], shared.directions[site]);
            let [x, y, z] = [0, 1, 2].map(|i| x[3 * node + i]);
            u.copy_from_slice(&[c * x + s * y, c * y - s * x, z]);
        }
        let mut forces = vec![0.0; x.len()];
        forces
            .par_chunks_mut((3 * width).max(1))
            .enumerate()
            .for_each(|(sector, forces)| {
                for link in &shared.links {
                    let shift =
                        (shared.steps[link.step] + shared.halves[link.row] - shared.halves[link.column]) / 2;
                    let there = (sector as i64 + i64::from(shift)).rem_euclid(n as i64) as usize;
                    let u = &cylindrical[3 * (there * width + link.column)..][..3];
                    let block = &matrix.blocks[link.block];
                    for (i, f) in forces[3 * link.row..3 * link.row + 3].iter_mut().enumerate() {
                        *f += block[3 * i] * u[0] + block[3 * i + 1] * u[1] + block[3 * i + 2] * u[2];
                    }
                }
            });
        let mut product = vec![0.0; x.len()];
        for (site, f) in forces.chunks_exact(3).enumerate() {
            let (node, [c, s]) = (shared.nodes[site], shared.directions[site]);
            product[3 * node..3 * node + 3].copy_from_slice(&[
                c * f[0] - s * f[1],
                s * f[0] + c * f[1],
                f[2],
            ]);
        }
        Ok(product)
    }
}
