//! Block Cholesky factorisation and triangular solves of a group of harmonics, one harmonic per lane.
//!
//! L is kept by rows of 3 x 3 blocks in the profile; the diagonal holds the inverses of the pivots' roots. Row i of the
//! factor needs dot products of rows only, so that all memory is read in order. A solve runs forwards and
//! backwards while the group's factor is still in the cache.

use std::marker::PhantomData;

use pulp::{Simd, WithSimd};

use super::number::{Complex, Form, Number};
use super::phases::LANES;
use super::profile::Profile;

/// Factors a group in place.
pub(super) struct Factorise<'a, F: Form> {
    pub(super) profile: &'a Profile,
    /// On entry the lower triangle of the matrix, then of the factor, `[n_blocks][3][3][PARTS][LANES]`.
    pub(super) values: &'a mut [f64],
    /// Gets every pivot divided by its diagonal entry, `[n][3][LANES]`.
    pub(super) ratios: &'a mut [f64],
    pub(super) form: PhantomData<F>,
}

/// Solves for a block of R right-hand sides, `[n][3][2][LANES]` each.
pub(super) struct Solve<'a, 'b, F: Form, const R: usize> {
    pub(super) profile: &'a Profile,
    pub(super) values: &'a [f64],
    pub(super) columns: [&'b mut [f64]; R],
    pub(super) form: PhantomData<F>,
}

/// Index of the vectors of a group: an entry's part has `LANES / S::F64_LANES` vectors, of which `half` is one.
struct View<S: Simd> {
    simd: S,
    half: usize,
}

impl<S: Simd> View<S> {
    const VECTORS: usize = LANES / S::F64_LANES;

    /// Vectors of one block.
    #[inline(always)]
    const fn block_len(parts: usize) -> usize {
        9 * parts * Self::VECTORS
    }

    #[inline(always)]
    fn entry<N: Number<S>>(&self, block: &[S::f64s], entry: usize) -> N {
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
    fn component(&self, node: &[S::f64s], component: usize) -> Complex<S> {
        let first = 2 * component * Self::VECTORS + self.half;
        Complex {
            re: node[first],
            im: node[first + Self::VECTORS],
        }
    }

    #[inline(always)]
    fn set_component(&self, node: &mut [S::f64s], component: usize, value: Complex<S>) {
        let first = 2 * component * Self::VECTORS + self.half;
        node[first] = value.re;
        node[first + Self::VECTORS] = value.im;
    }

    /// `sum over k of A_k B_k^H` of two runs of blocks.
    #[inline(always)]
    fn dot_blocks<N: Number<S>>(&self, a: &[S::f64s], b: &[S::f64s]) -> [[N; 3]; 3] {
        let mut sum = [[N::zero(self.simd); 3]; 3];
        let len = Self::block_len(N::PARTS);
        for (a, b) in a.chunks_exact(len).zip(b.chunks_exact(len)) {
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
        sum
    }
}

impl<F: Form> WithSimd for Factorise<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let values = S::as_mut_simd_f64s(self.values).0;
        let ratios = S::as_mut_simd_f64s(self.ratios).0;
        let len = View::<S>::block_len(F::PARTS);
        for i in 0..self.profile.n() {
            factor_row::<S, F::Number<S>>(simd, self.profile, i, values);
            let diagonal = &mut values[self.profile.place(i, i) * len..][..len];
            let ratios = &mut ratios[3 * i * View::<S>::VECTORS..][..3 * View::<S>::VECTORS];
            for half in 0..View::<S>::VECTORS {
                factor_diagonal::<S, F::Number<S>>(&View { simd, half }, diagonal, ratios);
            }
        }
    }
}

/// Blocks (i, j) of the factor, j < i, and the diagonal block less their products.
#[inline(always)]
fn factor_row<S: Simd, N: Number<S>>(simd: S, profile: &Profile, i: usize, values: &mut [S::f64s]) {
    let len = View::<S>::block_len(N::PARTS);
    let first = profile.first[i];
    let (done, row) = values.split_at_mut(profile.starts[i] * len);
    for j in first..i {
        let from = first.max(profile.first[j]);
        let other = &done[profile.place(j, from) * len..][..(j + 1 - from) * len];
        let (other, pivot) = other.split_at((j - from) * len);
        let (known, rest) = row.split_at_mut((j - first) * len);
        let known = &known[(from - first) * len..];
        for half in 0..View::<S>::VECTORS {
            let view = View { simd, half };
            let sum: [[N; 3]; 3] = view.dot_blocks(known, other);
            solve_block(&view, pivot, &sum, &mut rest[..len]);
        }
    }
    let (known, diagonal) = row.split_at_mut((i - first) * len);
    let diagonal = &mut diagonal[..len];
    for half in 0..View::<S>::VECTORS {
        let view = View { simd, half };
        let sum: [[N; 3]; 3] = view.dot_blocks(known, known);
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

impl<F: Form, const R: usize> WithSimd for Solve<'_, '_, F, R> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let values = S::as_simd_f64s(self.values).0;
        let mut columns = self.columns.map(|column| S::as_mut_simd_f64s(column).0);
        let n = self.profile.n();
        for i in 0..n {
            for half in 0..View::<S>::VECTORS {
                forward_row::<S, F::Number<S>, R>(
                    &View { simd, half },
                    self.profile,
                    i,
                    values,
                    &mut columns,
                );
            }
        }
        for i in (0..n).rev() {
            for half in 0..View::<S>::VECTORS {
                backward_row::<S, F::Number<S>, R>(
                    &View { simd, half },
                    self.profile,
                    i,
                    values,
                    &mut columns,
                );
            }
        }
    }
}

/// `y_i = L_ii^-1 (b_i - sum over j of L_ij y_j)`.
#[inline(always)]
fn forward_row<S: Simd, N: Number<S>, const R: usize>(
    view: &View<S>,
    profile: &Profile,
    i: usize,
    values: &[S::f64s],
    columns: &mut [&mut [S::f64s]; R],
) {
    let (simd, len, node_len) = (view.simd, View::<S>::block_len(N::PARTS), 6 * View::<S>::VECTORS);
    let first = profile.first[i];
    let row = &values[profile.starts[i] * len..profile.starts[i + 1] * len];
    let (blocks, diagonal) = row.split_at((i - first) * len);
    let mut sums = [[Complex::zero(simd); 3]; R];
    for (j, block) in blocks.chunks_exact(len).enumerate() {
        for c in 0..3 {
            let x: [Complex<S>; R] =
                std::array::from_fn(|r| view.component(&columns[r][(first + j) * node_len..][..node_len], c));
            for a in 0..3 {
                let entry: N = view.entry(block, 3 * a + c);
                for r in 0..R {
                    sums[r][a] = entry.times(simd, x[r], sums[r][a]);
                }
            }
        }
    }
    let entry = |e: usize| view.entry::<N>(diagonal, e);
    let inverse = [0, 4, 8].map(|e| entry(e).parts()[0]);
    for r in 0..R {
        let node = &mut columns[r][i * node_len..][..node_len];
        let b = |c: usize| view.component(node, c).minus(simd, sums[r][c]);
        let y0 = b(0).scaled(simd, inverse[0]);
        let s1 = entry(3).times(simd, y0, Complex::zero(simd));
        let y1 = b(1).minus(simd, s1).scaled(simd, inverse[1]);
        let s2 = entry(7).times(simd, y1, entry(6).times(simd, y0, Complex::zero(simd)));
        let y2 = b(2).minus(simd, s2).scaled(simd, inverse[2]);
        for (c, y) in [y0, y1, y2].into_iter().enumerate() {
            view.set_component(node, c, y);
        }
    }
}

/// `x_i = L_ii^-H y_i`, then `y_j -= L_ij^H x_i` for the columns j of the row.
#[inline(always)]
fn backward_row<S: Simd, N: Number<S>, const R: usize>(
    view: &View<S>,
    profile: &Profile,
    i: usize,
    values: &[S::f64s],
    columns: &mut [&mut [S::f64s]; R],
) {
    let (simd, len, node_len) = (view.simd, View::<S>::block_len(N::PARTS), 6 * View::<S>::VECTORS);
    let first = profile.first[i];
    let row = &values[profile.starts[i] * len..profile.starts[i + 1] * len];
    let (blocks, diagonal) = row.split_at((i - first) * len);
    let entry = |e: usize| view.entry::<N>(diagonal, e);
    let inverse = [0, 4, 8].map(|e| entry(e).parts()[0]);
    let mut x = [[Complex::zero(simd); 3]; R];
    for r in 0..R {
        let node = &mut columns[r][i * node_len..][..node_len];
        let y = |c: usize| view.component(node, c);
        let x2 = y(2).scaled(simd, inverse[2]);
        let s1 = entry(7).conj_times(simd, x2, Complex::zero(simd));
        let x1 = y(1).minus(simd, s1).scaled(simd, inverse[1]);
        let s0 = entry(6).conj_times(simd, x2, entry(3).conj_times(simd, x1, Complex::zero(simd)));
        let x0 = y(0).minus(simd, s0).scaled(simd, inverse[0]);
        x[r] = [x0, x1, x2];
        (0..3).for_each(|c| view.set_component(node, c, x[r][c]));
    }
    for (j, block) in blocks.chunks_exact(len).enumerate() {
        let mut sums = [[Complex::zero(simd); 3]; R];
        for a in 0..3 {
            for c in 0..3 {
                let entry: N = view.entry(block, 3 * a + c);
                for r in 0..R {
                    sums[r][c] = entry.conj_times(simd, x[r][a], sums[r][c]);
                }
            }
        }
        for r in 0..R {
            let node = &mut columns[r][(first + j) * node_len..][..node_len];
            for c in 0..3 {
                let y = view.component(node, c).minus(simd, sums[r][c]);
                view.set_component(node, c, y);
            }
        }
    }
}

#[cfg(test)]
mod tests;
