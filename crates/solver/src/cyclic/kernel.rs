//! Block Cholesky factorisation and triangular solves of a group of harmonics, one harmonic per lane.
//!
//! L has rows of 3 x 3 blocks ([`super::factor_rows`]); the diagonal holds the inverses of the pivots' roots. Row i
//! of the factor needs products with earlier rows only. A solve runs forwards and backwards while the group's factor
//! is still in the cache ([`super::sweep`]).

use std::marker::PhantomData;

use pulp::{Simd, WithSimd};

use super::factor_rows::FactorRows;
use super::number::{Complex, Form, Number};
use super::phases::LANES;

/// Factors a group in place.
pub(super) struct Factorise<'a, F: Form> {
    pub(super) rows: &'a FactorRows,
    /// On entry the lower triangle of the matrix, then of the factor, `[n_blocks][3][3][PARTS][LANES]`.
    pub(super) values: &'a mut [f64],
    /// Gets every pivot divided by its diagonal entry, `[n][3][LANES]`.
    pub(super) ratios: &'a mut [f64],
    pub(super) form: PhantomData<F>,
}

/// Index of the vectors of a group: an entry's part has `LANES / S::F64_LANES` vectors, of which `half` is one.
pub(super) struct View<S: Simd> {
    pub(super) simd: S,
    pub(super) half: usize,
}

impl<S: Simd> View<S> {
    pub(super) const VECTORS: usize = LANES / S::F64_LANES;

    /// Vectors of one block.
    #[inline(always)]
    pub(super) const fn block_len(parts: usize) -> usize {
        9 * parts * Self::VECTORS
    }

    #[inline(always)]
    pub(super) fn entry<N: Number<S>>(&self, block: &[S::f64s], entry: usize) -> N {
        let first = entry * N::PARTS * Self::VECTORS + self.half;
        N::load([block[first], block[first + (N::PARTS - 1) * Self::VECTORS]])
    }

    #[inline(always)]
    fn set_entry<N: Number<S>>(&self, block: &mut [S::f64s], entry: usize, value: N) {
        let first = entry * N::PARTS * Self::VECTORS + self.half;
        let parts = value.parts();
        for part in 0..N::PARTS {
            block[first + part * Self::VECTORS] = parts[part];
        }
    }

    #[inline(always)]
    pub(super) fn component(&self, node: &[S::f64s], component: usize) -> Complex<S> {
        let first = 2 * component * Self::VECTORS + self.half;
        Complex {
            re: node[first],
            im: node[first + Self::VECTORS],
        }
    }

    #[inline(always)]
    pub(super) fn set_component(&self, node: &mut [S::f64s], component: usize, value: Complex<S>) {
        let first = 2 * component * Self::VECTORS + self.half;
        node[first] = value.re;
        node[first + Self::VECTORS] = value.im;
    }

    /// Adds `A B^H` of two blocks.
    #[inline(always)]
    fn add_product<N: Number<S>>(&self, a: &[S::f64s], b: &[S::f64s], sum: &mut [[N; 3]; 3]) {
        for t in 0..3 {
            let column: [N; 3] = [0, 1, 2].map(|r| self.entry(a, 3 * r + t));
            for c in 0..3 {
                let factor: N = self.entry(b, 3 * c + t);
                for r in 0..3 {
                    sum[r][c] = sum[r][c].plus_product(self.simd, column[r], factor);
                }
            }
        }
    }
}

impl<F: Form> WithSimd for Factorise<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let values = S::as_mut_simd_f64s(self.values).0;
        let ratios = S::as_mut_simd_f64s(self.ratios).0;
        let len = View::<S>::block_len(F::PARTS);
        let n = self.rows.n();
        let longest = (0..n).map(|i| self.rows.columns(i).len()).max().unwrap_or(0);
        let mut row = vec![simd.splat_f64s(0.0); longest * len];
        let mut places = vec![ABSENT; n];
        for i in 0..n {
            let run = self.rows.row(i);
            let row = &mut row[..run.columns.len() * len];
            let there = run.first * len..(run.first + run.columns.len()) * len;
            for (k, block) in row.chunks_exact_mut(len).enumerate() {
                block.copy_from_slice(&values[there.clone()][run.place(k) * len..][..len]);
            }
            factor_row::<S, F::Number<S>>(simd, self.rows, i, values, row, &mut places);
            let ratios = &mut ratios[3 * i * View::<S>::VECTORS..][..3 * View::<S>::VECTORS];
            let (_, diagonal) = row.split_at_mut(row.len() - len);
            for half in 0..View::<S>::VECTORS {
                factor_diagonal::<S, F::Number<S>>(&View { simd, half }, diagonal, ratios);
            }
            for (k, block) in row.chunks_exact(len).enumerate() {
                values[there.clone()][run.place(k) * len..][..len].copy_from_slice(block);
            }
        }
    }
}

/// Place of a block that a row lacks.
const ABSENT: usize = usize::MAX;

/// Blocks (i, j) of the factor, j < i, and the diagonal block less their products, in place of those of the matrix in
/// `row`. `places` is [`ABSENT`] before and after.
#[inline(always)]
fn factor_row<S: Simd, N: Number<S>>(
    simd: S,
    rows: &FactorRows,
    i: usize,
    done: &[S::f64s],
    row: &mut [S::f64s],
    places: &mut [usize],
) {
    let len = View::<S>::block_len(N::PARTS);
    let Some((_, columns)) = rows.columns(i).split_last() else {
        return;
    };
    for (place, &j) in columns.iter().enumerate() {
        places[j] = place;
    }
    for (place, &j) in columns.iter().enumerate() {
        let run = rows.row(j);
        let other = &done[run.first * len..(run.first + run.columns.len()) * len];
        let (known, rest) = row.split_at_mut(place * len);
        for half in 0..View::<S>::VECTORS {
            let view = View { simd, half };
            let mut sum = [[N::zero(simd); 3]; 3];
            for (k, &column) in run.columns.iter().enumerate() {
                // Of column j itself the place is not less.
                if places[column] < place {
                    let block = &other[run.place(k) * len..][..len];
                    view.add_product(&known[places[column] * len..][..len], block, &mut sum);
                }
            }
            let pivot = &other[run.place(run.columns.len() - 1) * len..][..len];
            solve_block(&view, pivot, &sum, &mut rest[..len]);
        }
    }
    columns.iter().for_each(|&j| places[j] = ABSENT);
    let (known, diagonal) = row.split_at_mut(columns.len() * len);
    for half in 0..View::<S>::VECTORS {
        let view = View { simd, half };
        let mut sum = [[N::zero(simd); 3]; 3];
        for block in known.chunks_exact(len) {
            view.add_product(block, block, &mut sum);
        }
        for (r, c) in [(1, 0), (2, 0), (2, 1)] {
            let value = view.entry::<N>(diagonal, 3 * r + c).minus(simd, sum[r][c]);
            view.set_entry(diagonal, 3 * r + c, value);
        }
        // The diagonal entries stay as they are for the ratios; the sums wait in the upper triangle.
        for (r, place) in [(0, 1), (1, 2), (2, 5)] {
            view.set_entry(diagonal, place, sum[r][r]);
        }
    }
}

/// `(A - sum) L_jj^-H` in place of A, with the diagonal block `pivot` of the factor.
#[inline(always)]
fn solve_block<S: Simd, N: Number<S>>(
    view: &View<S>,
    pivot: &[S::f64s],
    sum: &[[N; 3]; 3],
    block: &mut [S::f64s],
) {
    let simd = view.simd;
    let pivot = &pivot[..View::<S>::block_len(N::PARTS)];
    let entry = |e: usize| view.entry::<N>(pivot, e);
    let inverse = [0, 4, 8].map(|e| entry(e).parts()[0]);
    for r in 0..3 {
        let a = |c: usize| view.entry::<N>(block, 3 * r + c).minus(simd, sum[r][c]);
        let x0 = a(0).scaled(simd, inverse[0]);
        let s1 = N::zero(simd).plus_product(simd, x0, entry(3));
        let x1 = a(1).minus(simd, s1).scaled(simd, inverse[1]);
        let s2 = N::zero(simd).plus_product(simd, x0, entry(6));
        let s2 = s2.plus_product(simd, x1, entry(7));
        let x2 = a(2).minus(simd, s2).scaled(simd, inverse[2]);
        for (c, x) in [x0, x1, x2].into_iter().enumerate() {
            view.set_entry(block, 3 * r + c, x);
        }
    }
}

/// Cholesky factor of a diagonal block whose diagonal still lacks the sums kept in its upper triangle.
#[inline(always)]
fn factor_diagonal<S: Simd, N: Number<S>>(view: &View<S>, block: &mut [S::f64s], ratios: &mut [S::f64s]) {
    let simd = view.simd;
    let one = simd.splat_f64s(1.0);
    let mut invert_pivot = |r: usize, entry: S::f64s, sum: S::f64s| -> S::f64s {
        let pivot = simd.sub_f64s(entry, sum);
        ratios[r * View::<S>::VECTORS + view.half] = simd.div_f64s(pivot, entry);
        simd.div_f64s(one, simd.sqrt_f64s(pivot))
    };
    let entry = |e: usize| view.entry::<N>(block, e);
    let real = |e: usize| entry(e).parts()[0];
    let square = |x: N| N::zero(simd).plus_product(simd, x, x).parts()[0];
    let i0 = invert_pivot(0, real(0), real(1));
    let l10 = entry(3).scaled(simd, i0);
    let l20 = entry(6).scaled(simd, i0);
    let i1 = invert_pivot(1, real(4), simd.add_f64s(real(2), square(l10)));
    let s21 = N::zero(simd).plus_product(simd, l20, l10);
    let l21 = entry(7).minus(simd, s21).scaled(simd, i1);
    let sum = simd.add_f64s(simd.add_f64s(real(5), square(l20)), square(l21));
    let i2 = invert_pivot(2, real(8), sum);
    let zero = simd.splat_f64s(0.0);
    for (e, value) in [(0, i0), (4, i1), (8, i2), (1, zero), (2, zero), (5, zero)] {
        view.set_entry(block, e, N::load([value, zero]));
    }
    for (e, value) in [(3, l10), (6, l20), (7, l21)] {
        view.set_entry(block, e, value);
    }
}

#[cfg(test)]
mod tests;
