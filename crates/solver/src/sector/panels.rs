//! The columns of a factor that belong to a sector's interior, as dense panels, and the two triangular sweeps over
//! them.
//!
//! Places 0..n_interior are the interior in elimination order, the rest the boundary. faer's own solver runs forwards
//! and backwards in one call; here the interface comes between. One right-hand side is bound by memory and has its
//! own kernel; for several, faer multiplies dense blocks.
//!
//! A panel is stored in *strips* of [`STRIP`] columns, each without the rows above its first: sweeps read next to
//! nothing but entries of L, in one stream.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use faer::{Accum, MatMut, MatRef, Par};
use pulp::{Simd, WithSimd};

use super::kernel;

/// Columns of a strip.
const STRIP: usize = 32;

/// One dense panel, a lower trapezoid.
#[derive(Clone, Copy, Debug)]
struct Panel {
    /// First place.
    begin: usize,
    width: usize,
    height: usize,
    /// Where its values start.
    values: usize,
    /// Where its rows below the triangle start, `[height - width]`.
    rows: usize,
}

/// Some columns of a panel.
#[derive(Clone, Copy)]
struct Strip<'a> {
    /// First row of the panel, and column.
    first: usize,
    width: usize,
    /// Rows from the first on.
    height: usize,
    /// Column-major `[width][height]`.
    values: &'a [f64],
}

/// The interior columns [L; F] of a factor.
#[derive(Debug)]
pub(super) struct Panels {
    panels: Vec<Panel>,
    /// Places of the rows below the triangles.
    rows: Vec<usize>,
    values: Vec<f64>,
    tallest: usize,
}

/// Places and widths of the strips of a panel.
fn strips(width: usize) -> impl DoubleEndedIterator<Item = (usize, usize)> {
    (0..width.div_ceil(STRIP)).map(move |k| (STRIP * k, STRIP.min(width - STRIP * k)))
}

impl Panels {
    /// Takes the columns before `n_interior` from a supernodal factor; `values` is what faer's layout says,
    /// column-major `[width][height]` for each supernode.
    pub(super) fn new(
        supernodal: &SymbolicSupernodalCholesky<usize>,
        mut values: Vec<f64>,
        n_interior: usize,
    ) -> Panels {
        let (mut panels, mut rows, mut n_values) = (Vec::new(), Vec::new(), 0);
        for s in 0..supernodal.n_supernodes() {
            let (begin, end) = (supernodal.supernode_begin()[s], supernodal.supernode_end()[s]);
            if begin >= n_interior {
                continue;
            }
            let pattern = supernodal.supernode(s).pattern();
            let inside = end.min(n_interior);
            let panel = Panel {
                begin,
                width: inside - begin,
                height: end - begin + pattern.len(),
                values: n_values,
                rows: rows.len(),
            };
            // A supernode that reaches into the boundary keeps its interior columns.
            rows.extend(inside..end);
            rows.extend_from_slice(pattern);
            let source = supernodal.col_ptr_for_val()[s];
            for (first, width) in strips(panel.width) {
                for column in first..first + width {
                    // Strips are shorter than what they are taken from: nothing is overwritten before it is read.
                    let start = source + panel.height * column;
                    values.copy_within(start + first..start + panel.height, n_values);
                    n_values += panel.height - first;
                }
            }
            panels.push(panel);
        }
        values.truncate(n_values);
        values.shrink_to_fit();
        let tallest = panels.iter().map(|p| p.height).max().unwrap_or(0);
        Panels {
            panels,
            rows,
            values,
            tallest,
        }
    }

    /// Bytes of the values.
    pub(super) fn bytes(&self) -> usize {
        size_of::<f64>() * self.values.capacity()
    }

    /// `[y; g] = [L^-1 f; g - F L^-1 f]`, row-major `[places][n_rhs]`. Panels that the right-hand sides do not touch
    /// are not read.
    pub(super) fn forward(&self, x: &mut [f64], n_rhs: usize) {
        let mut buffer = vec![0.0; self.tallest * n_rhs];
        if n_rhs == 1 {
            pulp::Arch::new().dispatch(Forward(self, x, &mut buffer));
            return;
        }
        for panel in &self.panels {
            let own = &mut x[n_rhs * panel.begin..n_rhs * (panel.begin + panel.width)];
            if own.iter().all(|&v| v == 0.0) {
                continue;
            }
            let buffer = &mut buffer[..n_rhs * panel.height];
            let (top, below) = buffer.split_at_mut(own.len());
            top.copy_from_slice(own);
            below.fill(0.0);
            for strip in self.strips(panel) {
                let rows = &mut buffer[n_rhs * strip.first..];
                let rows = MatMut::from_row_major_slice_mut(rows, strip.height, n_rhs);
                let (mut own, below) = rows.split_at_row_mut(strip.width);
                let (l, f) = strip.blocks();
                solve_lower_triangular_in_place(l, own.as_mut(), Par::Seq);
                matmul(below, Accum::Add, f, own.as_ref(), -1.0, Par::Seq);
            }
            let (top, below) = buffer.split_at(own.len());
            own.copy_from_slice(top);
            for (&row, values) in self.rows_below(panel).iter().zip(below.chunks_exact(n_rhs)) {
                let x = &mut x[n_rhs * row..n_rhs * (row + 1)];
                x.iter_mut().zip(values).for_each(|(x, v)| *x += v);
            }
        }
    }

    /// `x_i = L^-T (y - F^T x_b)` in place of y, `[places][n_rhs]`; the boundary stays.
    pub(super) fn backward(&self, x: &mut [f64], n_rhs: usize) {
        let mut buffer = vec![0.0; self.tallest * n_rhs];
        if n_rhs == 1 {
            pulp::Arch::new().dispatch(Backward(self, x, &mut buffer));
            return;
        }
        for panel in self.panels.iter().rev() {
            let own = n_rhs * panel.begin..n_rhs * (panel.begin + panel.width);
            let buffer = &mut buffer[..n_rhs * panel.height];
            let (top, below) = buffer.split_at_mut(own.len());
            top.copy_from_slice(&x[own.clone()]);
            for (&row, values) in self.rows_below(panel).iter().zip(below.chunks_exact_mut(n_rhs)) {
                values.copy_from_slice(&x[n_rhs * row..n_rhs * (row + 1)]);
            }
            for strip in self.strips(panel).rev() {
                let rows = &mut buffer[n_rhs * strip.first..];
                let rows = MatMut::from_row_major_slice_mut(rows, strip.height, n_rhs);
                let (mut own, below) = rows.split_at_row_mut(strip.width);
                let (l, f) = strip.blocks();
                matmul(
                    own.as_mut(),
                    Accum::Add,
                    f.transpose(),
                    below.as_ref(),
                    -1.0,
                    Par::Seq,
                );
                solve_upper_triangular_in_place(l.transpose(), own, Par::Seq);
            }
            let n_own = own.len();
            x[own].copy_from_slice(&buffer[..n_own]);
        }
    }

    #[inline(always)]
    fn forward_one(&self, x: &mut [f64], buffer: &mut [f64]) {
        for panel in &self.panels {
            let own = &mut x[panel.begin..panel.begin + panel.width];
            if own.iter().all(|&v| v == 0.0) {
                continue;
            }
            let buffer = &mut buffer[..panel.height];
            buffer[..panel.width].copy_from_slice(own);
            buffer[panel.width..].fill(0.0);
            for strip in self.strips(panel) {
                kernel::forward(
                    strip.values,
                    strip.width,
                    strip.height,
                    &mut buffer[strip.first..],
                );
            }
            own.copy_from_slice(&buffer[..panel.width]);
            for (&row, v) in self.rows_below(panel).iter().zip(&buffer[panel.width..]) {
                x[row] += v;
            }
        }
    }

    #[inline(always)]
    fn backward_one(&self, x: &mut [f64], buffer: &mut [f64]) {
        for panel in self.panels.iter().rev() {
            let buffer = &mut buffer[..panel.height];
            let (own, below) = buffer.split_at_mut(panel.width);
            own.copy_from_slice(&x[panel.begin..panel.begin + panel.width]);
            for (v, &row) in below.iter_mut().zip(self.rows_below(panel)) {
                *v = x[row];
            }
            for strip in self.strips(panel).rev() {
                kernel::backward(
                    strip.values,
                    strip.width,
                    strip.height,
                    &mut buffer[strip.first..],
                );
            }
            x[panel.begin..panel.begin + panel.width].copy_from_slice(&buffer[..panel.width]);
        }
    }

    /// The strips of a panel, from the first columns to the last.
    #[inline(always)]
    fn strips(&self, panel: &Panel) -> impl DoubleEndedIterator<Item = Strip<'_>> {
        let (panel, values) = (*panel, &self.values[panel.values..]);
        strips(panel.width).map(move |(first, width)| {
            // Whole strips before this one, each STRIP rows shorter than the one before it.
            let start = first * panel.height - first * first.saturating_sub(STRIP) / 2;
            let height = panel.height - first;
            Strip {
                first,
                width,
                height,
                values: &values[start..start + width * height],
            }
        })
    }

    fn rows_below(&self, panel: &Panel) -> &[usize] {
        &self.rows[panel.rows..panel.rows + panel.height - panel.width]
    }
}

impl<'a> Strip<'a> {
    /// Triangle and rows below.
    fn blocks(&self) -> (MatRef<'a, f64>, MatRef<'a, f64>) {
        let whole = MatRef::from_column_major_slice(self.values, self.height, self.width);
        whole.split_at_row(self.width)
    }
}

/// A sweep over one right-hand side, compiled for the vectors of the processor: panels, right-hand side by places,
/// buffer. A closure would be compiled for the oldest processor.
struct Forward<'a>(&'a Panels, &'a mut [f64], &'a mut [f64]);
struct Backward<'a>(&'a Panels, &'a mut [f64], &'a mut [f64]);

impl WithSimd for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.0.forward_one(self.1, self.2);
    }
}

impl WithSimd for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.0.backward_one(self.1, self.2);
    }
}
