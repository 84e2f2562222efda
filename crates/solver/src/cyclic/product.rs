//! Products of a matrix and a vector, in harmonic and in nodal space: no global matrix.

use pulp::Arch;
use rayon::prelude::*;

use super::matrix::CyclicMatrix;
use super::phases::{LANES, Lanes};
use super::ring::{CyclicRing, Link};
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
            .for_each(|(group, (y, x))| arch.dispatch(|| self.apply_group(matrix, group, x, y)));
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

    /// One group's part of the product. Couplings of a row with one step share their phase.
    #[inline(always)]
    fn apply_group(&self, matrix: &CyclicMatrix, group: usize, x: &[f64], y: &mut [f64]) {
        let shared = &self.shared;
        let phases: Vec<[Lanes; 2]> = shared
            .steps
            .iter()
            .map(|&q| shared.phases.lanes(group, q))
            .collect();
        y.fill(0.0);
        let same = |a: &Link, b: &Link| a.row == b.row && a.step == b.step;
        for links in shared.links.chunk_by(same) {
            let mut sums = [[[0.0; LANES]; 2]; 3];
            for link in links {
                let node = &x[6 * LANES * link.column..][..6 * LANES];
                add_block(&matrix.blocks[link.block], node, &mut sums);
            }
            let Link { row, step, .. } = links[0];
            add_turned(&phases[step], &sums, &mut y[6 * LANES * row..][..6 * LANES]);
        }
    }
}

/// Adds `C D w` of one node, D = diag(1, i, 1).
#[inline(always)]
fn add_block(block: &[f64; 9], node: &[f64], sums: &mut [[Lanes; 2]; 3]) {
    for (i, sum) in sums.iter_mut().enumerate() {
        let [a, b, c] = [block[3 * i], block[3 * i + 1], block[3 * i + 2]];
        for lane in 0..LANES {
            let at = |part: usize| node[part * LANES + lane];
            sum[0][lane] += a * at(0) - b * at(3) + c * at(4);
            sum[1][lane] += a * at(1) + b * at(2) + c * at(5);
        }
    }
}

/// Adds `D^H exp(i phase) sums` to a node.
#[inline(always)]
fn add_turned([cos, sin]: &[Lanes; 2], sums: &[[Lanes; 2]; 3], node: &mut [f64]) {
    for (i, [re, im]) in sums.iter().enumerate() {
        let parts = &mut node[2 * i * LANES..2 * (i + 1) * LANES];
        for lane in 0..LANES {
            let x = cos[lane] * re[lane] - sin[lane] * im[lane];
            let y = cos[lane] * im[lane] + sin[lane] * re[lane];
            // Division by i of the azimuthal component.
            let (x, y) = if i == 1 { (y, -x) } else { (x, y) };
            parts[lane] += x;
            parts[LANES + lane] += y;
        }
    }
}
