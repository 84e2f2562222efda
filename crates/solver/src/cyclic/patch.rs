//! Nodal weights of a patch in the table of responses, and the compliance between two patches by the processor's
//! vectors.
//!
//! For each sector t of the loaded patch, z_p = `sum over s of G_{s-t}^T w_p` of both directions p of the moved patch
//! stays in registers while the rows of the responses are read one after the other; then it meets the weights v_q
//! once. So a number of the table serves two products, and vectors are summed across once per sector.

use std::ops::Range;

use pulp::{Simd, WithSimd};

/// Most vectors of a row that are read together. With two sums of each, the weights and the row they fit into the 16
/// registers of AVX2, and eight sums at a time hide how long an addition takes; narrower windows sum several rows
/// apart.
const WIDEST: usize = 4;
/// Numbers in the longest vector.
const LONGEST: usize = 8;
/// Numbers that may be read beyond a run of a row; they meet no weight.
pub(super) const BEYOND: usize = LONGEST - 1;

/// Nodal weights of two directions on chosen nodes, in cylindrical components.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patch {
    runs: Vec<Run>,
    /// Weights of the two directions, run by run.
    weights: [Vec<f64>; 2],
}

/// Neighbouring dofs of one sector in the table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Run {
    pub(super) sector: usize,
    /// First dof in the table.
    pub(super) dof: usize,
    /// Place of their weights in the patch.
    weights: Range<usize>,
}

impl Patch {
    /// Adds the weights of two directions at the node with the table's dofs `dof..dof + 3`.
    pub(super) fn push(&mut self, sector: usize, dof: usize, weights: [[f64; 3]; 2]) {
        let end = self.weights[0].len();
        match self.runs.last_mut() {
            Some(run) if run.sector == sector && run.dof + run.weights.len() == dof => run.weights.end += 3,
            _ => self.runs.push(Run {
                sector,
                dof,
                weights: end..end + 3,
            }),
        }
        for (all, more) in self.weights.iter_mut().zip(weights) {
            all.extend(more);
        }
    }

    /// Its runs.
    pub(super) fn runs(&self) -> &[Run] {
        &self.runs
    }

    /// Weights of the two directions on the dofs of a run.
    #[inline(always)]
    pub(super) fn of(&self, run: &Run) -> [&[f64]; 2] {
        [0, 1].map(|p| &self.weights[p][run.weights.clone()])
    }
}

/// Compliance between two patches, m/N, `[direction of a][direction of b]`.
pub(super) struct Compliance<'a> {
    pub(super) n_sectors: usize,
    pub(super) n_dofs: usize,
    /// `[n_sectors][n_dofs][n_dofs]` and [`BEYOND`] more: sector, displacement, force; m/N.
    pub(super) responses: &'a [f64],
    /// The patch that is measured.
    pub(super) a: &'a Patch,
    /// The patch that is loaded.
    pub(super) b: &'a Patch,
}

impl Compliance<'_> {
    /// What the force of `b` on V vectors of dofs from `first` on of a sector moves, with the weights `v` of two
    /// directions. U rows are summed apart.
    #[inline(always)]
    fn window<S: Simd, const V: usize, const U: usize>(
        &self,
        simd: S,
        sector: usize,
        first: usize,
        v: [&[f64]; 2],
    ) -> [[f64; 2]; 2] {
        let (n, n_dofs) = (self.n_sectors, self.n_dofs);
        let mut z = [[[simd.splat_f64s(0.0); V]; 2]; U];
        for moved in &self.a.runs {
            let apart = (moved.sector + n - sector) % n;
            let rows = &self.responses[(apart * n_dofs + moved.dof) * n_dofs + first..];
            let [w0, w1] = self.a.of(moved);
            let row = |i: usize| &rows[i * n_dofs..];
            let ((w0, rest0), (w1, rest1)) = (w0.as_chunks::<U>(), w1.as_chunks::<U>());
            let n_chunks = w0.len();
            for (i, (w0, w1)) in w0.iter().zip(w1).enumerate() {
                for (u, z) in z.iter_mut().enumerate() {
                    add_row(simd, row(U * i + u), [w0[u], w1[u]], z);
                }
            }
            for (i, (&w0, &w1)) in rest0.iter().zip(rest1).enumerate() {
                add_row(simd, row(U * n_chunks + i), [w0, w1], &mut z[0]);
            }
        }
        let mut compliance = [[0.0; 2]; 2];
        for z in z {
            for (z, compliance) in z.iter().zip(&mut compliance) {
                let mut sums = [0.0; WIDEST * LONGEST];
                S::as_mut_simd_f64s(&mut sums[..V * S::F64_LANES])
                    .0
                    .copy_from_slice(z);
                let along = v.map(|v| v.iter().zip(&sums).map(|(v, z)| v * z).sum::<f64>());
                (0..2).for_each(|q| compliance[q] += along[q]);
            }
        }
        compliance
    }
}

/// Adds the first V vectors of a row of responses times both weights.
#[inline(always)]
fn add_row<S: Simd, const V: usize>(simd: S, row: &[f64], weights: [f64; 2], z: &mut [[S::f64s; V]; 2]) {
    let row = S::as_simd_f64s(&row[..V * S::F64_LANES]).0;
    let [w0, w1] = weights.map(|w| simd.splat_f64s(w));
    for k in 0..V {
        z[0][k] = simd.mul_add_e_f64s(w0, row[k], z[0][k]);
        z[1][k] = simd.mul_add_e_f64s(w1, row[k], z[1][k]);
    }
}

impl WithSimd for Compliance<'_> {
    type Output = [[f64; 2]; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [[f64; 2]; 2] {
        let mut compliance = [[0.0; 2]; 2];
        for loaded in &self.b.runs {
            let [v0, v1] = self.b.of(loaded);
            let width = WIDEST * S::F64_LANES;
            for (k, v) in v0.chunks(width).zip(v1.chunks(width)).enumerate() {
                let (sector, first, v) = (loaded.sector, loaded.dof + k * width, [v.0, v.1]);
                let part = match v[0].len().div_ceil(S::F64_LANES) {
                    1 => self.window::<S, 1, 4>(simd, sector, first, v),
                    2 => self.window::<S, 2, 2>(simd, sector, first, v),
                    3 => self.window::<S, 3, 1>(simd, sector, first, v),
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
