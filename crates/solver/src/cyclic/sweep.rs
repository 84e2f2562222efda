//! Forward and backward sweeps over the factor of a group of harmonics, one harmonic per lane, whole or in parts.
//!
//! Nodes are in two runs, those that lead and those that trail, 1 and 2 in
//! ```text
//! [L_11      ]        [r_1]
//! [L_21  L_22],  r =  [r_2],  z = L^-1 r,  x_2 = L_22^-H z_2,  x_1 = L_11^-H (z_1 - L_21^H x_2)
//! ```
//! *Half solved* is (z_1, x_2): a forward sweep and the trailing block finish the nodes that trail, and a backward
//! sweep finishes the others. Of a right-hand side that is zero where nodes lead z_1 = 0, so that its half takes the
//! trailing block alone. Half solved vectors add up. So loads that are known early and loads on trailing nodes, which
//! depend on the motion there under the first, take one forward and one backward sweep together.

use std::marker::PhantomData;

use pulp::{Simd, WithSimd};

use super::factor_rows::{BlockRun, FactorRows};
use super::kernel::View;
use super::number::{Complex, Form, Number};

/// What a solve does of its sweeps; nodes trail from the given one on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sweeps {
    /// Forwards, then backwards: the solution.
    Whole,
    /// From a right-hand side to its half solved form.
    Begin(usize),
    /// The same of a right-hand side that is zero where nodes lead.
    Trailing(usize),
    /// From a half solved vector to the solution; nothing when all nodes trail, from 0 on.
    Finish(usize),
}

/// Sweeps over a block of R vectors, `[n][3][2][LANES]` each.
pub(super) struct Solve<'a, 'b, F: Form, const R: usize> {
    pub(super) rows: &'a FactorRows,
    /// The factor, `[n_blocks][3][3][PARTS][LANES]`.
    pub(super) values: &'a [f64],
    pub(super) columns: [&'b mut [f64]; R],
    pub(super) sweeps: Sweeps,
    pub(super) form: PhantomData<F>,
}

/// Blocks of a row.
#[derive(Clone, Copy)]
struct RowBlocks<'a, S: Simd> {
    run: BlockRun<'a>,
    values: &'a [S::f64s],
    len: usize,
}

impl<'a, S: Simd> RowBlocks<'a, S> {
    #[inline(always)]
    fn new(run: BlockRun<'a>, values: &'a [S::f64s], len: usize) -> Self {
        RowBlocks {
            values: &values[run.first * len..][..run.columns.len() * len],
            run,
            len,
        }
    }

    /// Block k.
    #[inline(always)]
    fn at(&self, k: usize) -> &'a [S::f64s] {
        &self.values[self.run.place(k) * self.len..][..self.len]
    }
}

impl<F: Form, const R: usize> WithSimd for Solve<'_, '_, F, R> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let values = S::as_simd_f64s(self.values).0;
        let len = View::<S>::block_len(F::PARTS);
        let mut columns = self.columns.map(|column| S::as_mut_simd_f64s(column).0);
        let n = self.rows.n();
        let (forward, backward, first) = match self.sweeps {
            Sweeps::Whole => (0..n, 0..n, [0, 0]),
            Sweeps::Begin(trailing) => (0..n, trailing..n, [0, trailing]),
            Sweeps::Trailing(trailing) => (trailing..n, trailing..n, [trailing; 2]),
            Sweeps::Finish(trailing) => (0..0, 0..trailing, [0, 0]),
        };
        for half in 0..View::<S>::VECTORS {
            let view = View { simd, half };
            for i in forward.clone() {
                let blocks = RowBlocks::<S>::new(self.rows.since_column(i, first[0]), values, len);
                forward_row::<S, F::Number<S>, R>(&view, blocks, i, &mut columns);
            }
            if let Sweeps::Finish(trailing) = self.sweeps {
                for i in (trailing..n).rev() {
                    let mut x = [[Complex::zero(simd); 3]; R];
                    for r in 0..R {
                        x[r] = node(&view, columns[r], i);
                    }
                    let blocks = RowBlocks::<S>::new(self.rows.before_column(i, trailing), values, len);
                    let n_blocks = blocks.run.columns.len();
                    spread::<S, F::Number<S>, R>(&view, blocks, n_blocks, x, &mut columns);
                }
            }
            for i in backward.clone().rev() {
                let blocks = RowBlocks::<S>::new(self.rows.since_column(i, first[1]), values, len);
                backward_row::<S, F::Number<S>, R>(&view, blocks, i, &mut columns);
            }
        }
    }
}

/// The three components of node i.
#[inline(always)]
fn node<S: Simd>(view: &View<S>, column: &[S::f64s], i: usize) -> [Complex<S>; 3] {
    let len = 6 * View::<S>::VECTORS;
    let node = &column[i * len..][..len];
    [
        view.component(node, 0),
        view.component(node, 1),
        view.component(node, 2),
    ]
}

/// `y_i = L_ii^-1 (b_i - sum over j of L_ij y_j)`.
#[inline(always)]
fn forward_row<S: Simd, N: Number<S>, const R: usize>(
    view: &View<S>,
    blocks: RowBlocks<'_, S>,
    i: usize,
    columns: &mut [&mut [S::f64s]; R],
) {
    let (simd, node_len) = (view.simd, 6 * View::<S>::VECTORS);
    let Some((_, places)) = blocks.run.columns.split_last() else {
        return;
    };
    // One sum in the order of the columns, whatever R and the first column: blocks that meet zeros change no bit of it.
    let mut sums = [[Complex::zero(simd); 3]; R];
    for (k, &j) in places.iter().enumerate() {
        add_block::<S, N, R>(view, blocks.at(k), j, columns, &mut sums);
    }
    let pivot = Pivot::<S, N>::new(view, blocks.at(blocks.run.columns.len() - 1));
    for r in 0..R {
        let node = &mut columns[r][i * node_len..][..node_len];
        let mut y = [Complex::zero(simd); 3];
        for c in 0..3 {
            y[c] = view.component(node, c).minus(simd, sums[r][c]);
        }
        y[0] = y[0].scaled(simd, pivot.inverse[0]);
        let s1 = pivot.l10.times(simd, y[0], Complex::zero(simd));
        y[1] = y[1].minus(simd, s1).scaled(simd, pivot.inverse[1]);
        let s2 = pivot.l20.times(simd, y[0], Complex::zero(simd));
        let s2 = pivot.l21.times(simd, y[1], s2);
        y[2] = y[2].minus(simd, s2).scaled(simd, pivot.inverse[2]);
        for c in 0..3 {
            view.set_component(node, c, y[c]);
        }
    }
}

/// A diagonal block, whose diagonal is inverted.
struct Pivot<S: Simd, N> {
    inverse: [S::f64s; 3],
    l10: N,
    l20: N,
    l21: N,
}

impl<S: Simd, N: Number<S>> Pivot<S, N> {
    #[inline(always)]
    fn new(view: &View<S>, block: &[S::f64s]) -> Self {
        let block = &block[..View::<S>::block_len(N::PARTS)];
        Pivot {
            inverse: [
                view.entry::<N>(block, 0).parts()[0],
                view.entry::<N>(block, 4).parts()[0],
                view.entry::<N>(block, 8).parts()[0],
            ],
            l10: view.entry(block, 3),
            l20: view.entry(block, 6),
            l21: view.entry(block, 7),
        }
    }
}

/// Adds `L_ij y_j`.
#[inline(always)]
fn add_block<S: Simd, N: Number<S>, const R: usize>(
    view: &View<S>,
    block: &[S::f64s],
    j: usize,
    columns: &[&mut [S::f64s]; R],
    sums: &mut [[Complex<S>; 3]; R],
) {
    let mut y = [[Complex::zero(view.simd); 3]; R];
    for r in 0..R {
        y[r] = node(view, columns[r], j);
    }
    for c in 0..3 {
        for a in 0..3 {
            let entry: N = view.entry(block, 3 * a + c);
            for r in 0..R {
                sums[r][a] = entry.times(view.simd, y[r][c], sums[r][a]);
            }
        }
    }
}

/// `x_i = L_ii^-H y_i`, then `y_j -= L_ij^H x_i` for the columns j of the row.
#[inline(always)]
fn backward_row<S: Simd, N: Number<S>, const R: usize>(
    view: &View<S>,
    blocks: RowBlocks<'_, S>,
    i: usize,
    columns: &mut [&mut [S::f64s]; R],
) {
    let (simd, node_len) = (view.simd, 6 * View::<S>::VECTORS);
    let pivot = Pivot::<S, N>::new(view, blocks.at(blocks.run.columns.len() - 1));
    let mut x = [[Complex::zero(simd); 3]; R];
    for r in 0..R {
        let node = &mut columns[r][i * node_len..][..node_len];
        let x2 = view.component(node, 2).scaled(simd, pivot.inverse[2]);
        let s1 = pivot.l21.conj_times(simd, x2, Complex::zero(simd));
        let x1 = view
            .component(node, 1)
            .minus(simd, s1)
            .scaled(simd, pivot.inverse[1]);
        let s0 = pivot.l10.conj_times(simd, x1, Complex::zero(simd));
        let s0 = pivot.l20.conj_times(simd, x2, s0);
        let x0 = view
            .component(node, 0)
            .minus(simd, s0)
            .scaled(simd, pivot.inverse[0]);
        x[r] = [x0, x1, x2];
        for c in 0..3 {
            view.set_component(node, c, x[r][c]);
        }
    }
    spread::<S, N, R>(view, blocks, blocks.run.columns.len() - 1, x, columns);
}

/// `y_j -= L_ij^H x_i` for the first `n_blocks` blocks (i, j) of a row, the last one first.
#[inline(always)]
fn spread<S: Simd, N: Number<S>, const R: usize>(
    view: &View<S>,
    blocks: RowBlocks<'_, S>,
    n_blocks: usize,
    x: [[Complex<S>; 3]; R],
    columns: &mut [&mut [S::f64s]; R],
) {
    let (simd, node_len) = (view.simd, 6 * View::<S>::VECTORS);
    let mut minus_x = [[Complex::zero(simd); 3]; R];
    for r in 0..R {
        for a in 0..3 {
            minus_x[r][a] = minus_x[r][a].minus(simd, x[r][a]);
        }
    }
    for (k, &j) in blocks.run.columns[..n_blocks].iter().enumerate().rev() {
        let block = blocks.at(k);
        let mut y = [[Complex::zero(simd); 3]; R];
        for r in 0..R {
            y[r] = node(view, columns[r], j);
        }
        for a in 0..3 {
            for c in 0..3 {
                let entry: N = view.entry(block, 3 * a + c);
                for r in 0..R {
                    y[r][c] = entry.conj_times(simd, minus_x[r][a], y[r][c]);
                }
            }
        }
        for r in 0..R {
            let node = &mut columns[r][j * node_len..][..node_len];
            for c in 0..3 {
                view.set_component(node, c, y[r][c]);
            }
        }
    }
}
