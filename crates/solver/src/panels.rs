//! Columns of a factor as dense panels, and the two triangular sweeps over them.
//!
//! Of a sector these are the columns of its interior: places 0..n_interior in elimination order, then the boundary.
//! faer's own solver runs forwards and backwards in one call; here the interface, or contacts, come between. One
//! right-hand side is bound by memory and has its own kernel; for several, faer multiplies dense blocks. Some panels
//! that follow each other may be swept alone, with places of their own.
//!
//! A panel is stored in *strips* of [`STRIP`] columns, each without the rows above its first: sweeps read next to
//! nothing but entries of L, in one stream.

use std::ops::Range;

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use faer::{Accum, MatMut, MatRef, Par};
use pulp::{Simd, WithSimd};

use crate::kernel;

/// Columns of a strip.
const STRIP: usize = 32;

/// Up to so many right-hand sides of one panel are bound by memory and have their own kernel.
const FEW: usize = 8;

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
pub(crate) struct Panels {
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
    pub(crate) fn new(
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
    pub(crate) fn bytes(&self) -> usize {
        size_of::<f64>() * self.values.capacity()
    }

    /// All panels.
    pub(crate) fn all(&self) -> Range<usize> {
        0..self.panels.len()
    }

    /// Places of the columns of a panel.
    pub(crate) fn places(&self, panel: usize) -> Range<usize> {
        let panel = &self.panels[panel];
        panel.begin..panel.begin + panel.width
    }

    /// Places of the rows below the triangle of a panel, ascending.
    pub(crate) fn below(&self, panel: usize) -> &[usize] {
        self.rows_below(&self.panels[panel])
    }

    /// The panels in another order, `order[k]` being the panel that comes as the k-th, with other places: each panel
    /// says by `place(panel, old place)` where its rows are.
    pub(crate) fn rearranged(mut self, order: &[usize], place: impl Fn(usize, usize) -> usize) -> Panels {
        for (p, panel) in self.panels.iter_mut().enumerate() {
            let rows = &mut self.rows[panel.rows..panel.rows + panel.height - panel.width];
            rows.iter_mut().for_each(|row| *row = place(p, *row));
            panel.begin = place(p, panel.begin);
        }
        self.panels = order.iter().map(|&p| self.panels[p]).collect();
        self
    }

    /// `[f; t] -> [L^-1 f; t - F L^-1 f]` with one panel, row-major `[height][n_rhs]`, in `buffer`.
    pub(crate) fn eliminate(&self, panel: usize, buffer: &mut [f64], n_rhs: usize) {
        let panel = &self.panels[panel];
        if n_rhs > FEW {
            return self.eliminate_with(panel, buffer, n_rhs);
        }
        let mut columns = vec![0.0; buffer.len()];
        for (row, values) in buffer.chunks_exact(n_rhs).enumerate() {
            values
                .iter()
                .enumerate()
                .for_each(|(r, &v)| columns[panel.height * r + row] = v);
        }
        pulp::Arch::new().dispatch(Few(self, panel, &mut columns));
        for (row, values) in buffer.chunks_exact_mut(n_rhs).enumerate() {
            values
                .iter_mut()
                .enumerate()
                .for_each(|(r, v)| *v = columns[panel.height * r + row]);
        }
    }

    fn eliminate_with(&self, panel: &Panel, buffer: &mut [f64], n_rhs: usize) {
        for strip in self.strips(panel) {
            let rows = &mut buffer[n_rhs * strip.first..];
            let rows = MatMut::from_row_major_slice_mut(rows, strip.height, n_rhs);
            let (mut own, below) = rows.split_at_row_mut(strip.width);
            let (l, f) = strip.blocks();
            solve_lower_triangular_in_place(l, own.as_mut(), Par::Seq);
            matmul(below, Accum::Add, f, own.as_ref(), -1.0, Par::Seq);
        }
    }

    /// `[y; g] = [L^-1 f; g - F L^-1 f]` with `some` panels, row-major `[places][n_rhs]`. Panels that the right-hand
    /// sides do not touch are not read.
    pub(crate) fn forward(&self, some: Range<usize>, x: &mut [f64], n_rhs: usize) {
        let mut buffer = vec![0.0; self.tallest * n_rhs];
        let panels = &self.panels[some];
        if n_rhs == 1 {
            pulp::Arch::new().dispatch(Forward(self, panels, x, &mut buffer));
            return;
        }
        for panel in panels {
            let own = &mut x[n_rhs * panel.begin..n_rhs * (panel.begin + panel.width)];
            if own.iter().all(|&v| v == 0.0) {
                continue;
            }
            let buffer = &mut buffer[..n_rhs * panel.height];
            let (top, below) = buffer.split_at_mut(own.len());
            top.copy_from_slice(own);
            below.fill(0.0);
            self.eliminate_with(panel, buffer, n_rhs);
            let (top, below) = buffer.split_at(own.len());
            own.copy_from_slice(top);
            for (&row, values) in self.rows_below(panel).iter().zip(below.chunks_exact(n_rhs)) {
                let x = &mut x[n_rhs * row..n_rhs * (row + 1)];
                x.iter_mut().zip(values).for_each(|(x, v)| *x += v);
            }
        }
    }

    /// `x_i = L^-T (y - F^T x_b)` in place of y with `some` panels, `[places][n_rhs]`; the boundary stays.
    pub(crate) fn backward(&self, some: Range<usize>, x: &mut [f64], n_rhs: usize) {
        let mut buffer = vec![0.0; self.tallest * n_rhs];
        let panels = &self.panels[some];
        if n_rhs == 1 {
            pulp::Arch::new().dispatch(Backward(self, panels, x, &mut buffer));
            return;
        }
        for panel in panels.iter().rev() {
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
    fn forward_one(&self, panels: &[Panel], x: &mut [f64], buffer: &mut [f64]) {
        for panel in panels {
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
    fn backward_one(&self, panels: &[Panel], x: &mut [f64], buffer: &mut [f64]) {
        for panel in panels.iter().rev() {
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

/// A sweep over one right-hand side, compiled for the vectors of the processor: the factor, its panels to sweep,
/// right-hand side by places, buffer. A closure would be compiled for the oldest processor.
struct Few<'a>(&'a Panels, &'a Panel, &'a mut [f64]);
struct Forward<'a>(&'a Panels, &'a [Panel], &'a mut [f64], &'a mut [f64]);
struct Backward<'a>(&'a Panels, &'a [Panel], &'a mut [f64], &'a mut [f64]);

impl WithSimd for Few<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Few(panels, panel, columns) = self;
        for strip in panels.strips(panel) {
            kernel::forward_few(
                strip.values,
                strip.width,
                strip.height,
                &mut columns[strip.first..],
                panel.height,
            );
        }
    }
}

impl WithSimd for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.0.forward_one(self.1, self.2, self.3);
    }
}

impl WithSimd for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.0.backward_one(self.1, self.2, self.3);
    }
}
