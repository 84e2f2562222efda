//! Nodal weights of a patch in the table of responses, and the compliance between two patches by the processor's
//! vectors.
//!
//! For each sector t of the loaded patch, z_p = `sum over s of G_{s-t}^T w_p` of all directions p of the moved patch
//! stays in registers while the rows of the responses are read one after the other; then it meets the weights v_q
//! once. So a number of the table serves as many products as there are directions, and vectors are summed across once
//! per sector.

use std::ops::Range;

use pulp::{Simd, WithSimd};

/// Most vectors of a row that are read together by patches of two directions. With two sums of each, the weights and
/// the row they fit into the 16 registers of AVX2, and eight sums at a time hide how long an addition takes; narrower
/// windows sum several rows apart.
const WIDEST: usize = 4;
/// The same by patches of four directions: eight sums.
const WIDEST_OF_MANY: usize = 2;
/// Numbers in the longest vector.
const LONGEST: usize = 8;
/// Numbers that may be read beyond a run of a row; they meet no weight.
pub(super) const BEYOND: usize = LONGEST - 1;

/// Nodal weights of one or more pairs of directions on chosen nodes, in cylindrical components.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PatchWeights {
    runs: Vec<DofRun>,
    n_directions: usize,
    /// Weights run by run, `[dof][direction]`.
    weights: Vec<f64>,
}

/// Neighbouring dofs of one sector in the table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DofRun {
    pub(super) sector: usize,
    /// First dof in the table.
    pub(super) dof: usize,
    /// Place of their weights in the patch.
    weights: Range<usize>,
}

impl PatchWeights {
    /// Without nodes, for so many pairs of directions.
    pub(super) fn new(pairs: usize) -> PatchWeights {
        PatchWeights {
            runs: Vec::new(),
            n_directions: 2 * pairs,
            weights: Vec::new(),
        }
    }

    /// Number of directions.
    pub fn n_directions(&self) -> usize {
        self.n_directions
    }

    /// Adds the weights of a pair of directions at the node with the table's dofs `dof..dof + 3`; nodes come in the
    /// order of the table.
    pub(super) fn push(&mut self, (sector, dof): (usize, usize), pair: usize, weights: [[f64; 3]; 2]) {
        let is_same = |run: &DofRun| run.sector == sector && run.dof + run.weights.len() == dof + 3;
        if !self.runs.last().is_some_and(is_same) {
            self.push_node(sector, dof);
        }
        let first = self.weights.len() - 3 * self.n_directions;
        for (k, dof) in self.weights[first..]
            .chunks_exact_mut(self.n_directions)
            .enumerate()
        {
            (0..2).for_each(|p| dof[2 * pair + p] = weights[p][k]);
        }
    }

    /// Adds a node without weights.
    fn push_node(&mut self, sector: usize, dof: usize) {
        let end = self.weights.len() / self.n_directions;
        match self.runs.last_mut() {
            Some(run) if run.sector == sector && run.dof + run.weights.len() == dof => run.weights.end += 3,
            _ => self.runs.push(DofRun {
                sector,
                dof,
                weights: end..end + 3,
            }),
        }
        self.weights.resize(self.n_directions * (end + 3), 0.0);
    }

    /// Its runs.
    pub(super) fn runs(&self) -> &[DofRun] {
        &self.runs
    }

    /// Weights on the dofs of a run, `[dof][direction]`.
    #[inline(always)]
    pub(super) fn of(&self, run: &DofRun) -> &[f64] {
        &self.weights[self.n_directions * run.weights.start..self.n_directions * run.weights.end]
    }
}

/// Compliance between two patches of D directions, m/N, `[direction of a][direction of b]`.
pub(super) struct Compliance<'a, const D: usize> {
    pub(super) n_sectors: usize,
    pub(super) n_dofs: usize,
    /// `[n_sectors][n_dofs][n_dofs]` and [`BEYOND`] more: sector, displacement, force; m/N.
    pub(super) responses: &'a [f64],
    /// The patch that is measured.
    pub(super) a: &'a PatchWeights,
    /// The patch that is loaded.
    pub(super) b: &'a PatchWeights,
}

impl<const D: usize> Compliance<'_, D> {
    /// What the force of `b` on V vectors of dofs from `first` on of a sector moves, with its weights `v`. U rows are
    /// summed apart.
    #[inline(always)]
    fn window<S: Simd, const V: usize, const U: usize>(
        &self,
        simd: S,
        sector: usize,
        first: usize,
        v: &[[f64; D]],
    ) -> [[f64; D]; D] {
        let (n, n_dofs) = (self.n_sectors, self.n_dofs);
        let mut z = [[[simd.splat_f64s(0.0); V]; D]; U];
        for moved in &self.a.runs {
            let apart = (moved.sector + n - sector) % n;
            let rows = &self.responses[(apart * n_dofs + moved.dof) * n_dofs + first..];
            let row = |i: usize| &rows[i * n_dofs..];
            let (chunks, rest) = self.a.of(moved).as_chunks::<D>().0.as_chunks::<U>();
            for (i, w) in chunks.iter().enumerate() {
                for (u, z) in z.iter_mut().enumerate() {
                    add_row(simd, row(U * i + u), w[u], z);
                }
            }
            for (i, &w) in rest.iter().enumerate() {
                add_row(simd, row(U * chunks.len() + i), w, &mut z[0]);
            }
        }
        let mut compliance = [[0.0; D]; D];
        for z in z {
            for (z, compliance) in z.iter().zip(&mut compliance) {
                let mut sums = [0.0; WIDEST * LONGEST];
                S::as_mut_simd_f64s(&mut sums[..V * S::F64_LANES])
                    .0
                    .copy_from_slice(z);
                let along = |q: usize| v.iter().zip(&sums).map(|(v, z)| v[q] * z).sum::<f64>();
                (0..D).for_each(|q| compliance[q] += along(q));
            }
        }
        compliance
    }
}

/// Adds the first V vectors of a row of responses times each weight.
#[inline(always)]
fn add_row<S: Simd, const V: usize, const D: usize>(
    simd: S,
    row: &[f64],
    weights: [f64; D],
    z: &mut [[S::f64s; V]; D],
) {
    let row = S::as_simd_f64s(&row[..V * S::F64_LANES]).0;
    for (z, w) in z.iter_mut().zip(weights) {
        let w = simd.splat_f64s(w);
        for (z, row) in z.iter_mut().zip(row) {
            *z = simd.mul_add_e_f64s(w, *row, *z);
        }
    }
}

impl<const D: usize> WithSimd for Compliance<'_, D> {
    type Output = [[f64; D]; D];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [[f64; D]; D] {
        let mut compliance = [[0.0; D]; D];
        let widest = if D == 2 { WIDEST } else { WIDEST_OF_MANY };
        for loaded in &self.b.runs {
            let width = widest * S::F64_LANES;
            let windows = self.b.of(loaded).as_chunks::<D>().0.chunks(width);
            for (k, v) in windows.enumerate() {
                let (sector, first) = (loaded.sector, loaded.dof + k * width);
                let part = match (v.len().div_ceil(S::F64_LANES), D) {
                    (1, 2) => self.window::<S, 1, 4>(simd, sector, first, v),
                    (1, _) => self.window::<S, 1, 1>(simd, sector, first, v),
                    (2, 2) => self.window::<S, 2, 2>(simd, sector, first, v),
                    (2, _) => self.window::<S, 2, 1>(simd, sector, first, v),
                    (3, _) => self.window::<S, 3, 1>(simd, sector, first, v),
                    _ => self.window::<S, 4, 1>(simd, sector, first, v),
                };
                for (sums, part) in compliance.as_flattened_mut().iter_mut().zip(part.as_flattened()) {
                    *sums += part;
                }
            }
        }
        compliance
    }
}
