//! The columns of a factor that belong to a sector's interior, as dense panels, and the two triangular sweeps over them.
//!
//! Places 0..n_interior are the interior in elimination order, the rest the boundary. faer's own solver runs forwards and
//! backwards in one call; here the interface comes between. One right-hand side is bound by memory and has its own
//! kernel; for several, faer multiplies dense blocks.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use faer::{Accum, MatMut, MatRef, Par};

use super::kernel;

/// One dense panel, a lower trapezoid.
#[derive(Clone, Copy, Debug)]
struct Panel {
    /// First place.
    begin: usize,
    width: usize,
    height: usize,
    /// Where its values start, column-major `[width][height]`.
    values: usize,
    /// Where its rows below the triangle start, `[height - width]`.
    rows: usize,
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

impl Panels {
    /// Takes the columns before `n_interior` from a supernodal factor; `values` is what faer's layout says.
    pub(super) fn new(
        supernodal: &SymbolicSupernodalCholesky<usize>,
        mut values: Vec<f64>,
        n_interior: usize,
    ) -> Panels {
        let (mut panels, mut rows, mut end_of_values) = (Vec::new(), Vec::new(), 0);
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
                values: supernodal.col_ptr_for_val()[s],
                rows: rows.len(),
            };
            // A supernode that reaches into the boundary keeps its interior columns.
            rows.extend(inside..end);
            rows.extend_from_slice(pattern);
            end_of_values = end_of_values.max(panel.values + panel.width * panel.height);
            panels.push(panel);
        }
        values.truncate(end_of_values);
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

    /// `[y; g] = [L^-1 f; g - F L^-1 f]`, row-major `[places][n_rhs]`. Panels that the right-hand sides do not touch are not read.
    pub(super) fn forward(&self, x: &mut [f64], n_rhs: usize) {
        let mut buffer = vec![0.0; self.tallest * n_rhs];
        if n_rhs == 1 {
            pulp::Arch::new().dispatch(|| self.forward_one(x, &mut buffer));
            return;
        }
        for panel in &self.panels {
            let own = &mut x[n_rhs * panel.begin..n_rhs * (panel.begin + panel.width)];
            if own.iter().all(|&v| v == 0.0) {
                continue;
            }
            let (l, f) = self.blocks(panel);
            let own = MatMut::from_row_major_slice_mut(own, panel.width, n_rhs);
            solve_lower_triangular_in_place(l, own, Par::Seq);
            let own = &x[n_rhs * panel.begin..n_rhs * (panel.begin + panel.width)];
            let own = MatRef::from_row_major_slice(own, panel.width, n_rhs);
            let below = panel.height - panel.width;
            let product = &mut buffer[..n_rhs * below];
            let target = MatMut::from_row_major_slice_mut(&mut *product, below, n_rhs);
            matmul(target, Accum::Replace, f, own, 1.0, Par::Seq);
            for (&row, values) in self.rows_below(panel).iter().zip(product.chunks_exact(n_rhs)) {
                let x = &mut x[n_rhs * row..n_rhs * (row + 1)];
                x.iter_mut().zip(values).for_each(|(x, v)| *x -= v);
            }
        }
    }

    /// `x_i = L^-T (y - F^T x_b)` in place of y, `[places][n_rhs]`; the boundary stays.
    pub(super) fn backward(&self, x: &mut [f64], n_rhs: usize) {
        let mut buffer = vec![0.0; self.tallest * n_rhs];
        if n_rhs == 1 {
            pulp::Arch::new().dispatch(|| self.backward_one(x, &mut buffer));
            return;
        }
        for panel in self.panels.iter().rev() {
            let (l, f) = self.blocks(panel);
            let below = panel.height - panel.width;
            let gathered = &mut buffer[..n_rhs * below];
            for (&row, values) in self
                .rows_below(panel)
                .iter()
                .zip(gathered.chunks_exact_mut(n_rhs))
            {
                values.copy_from_slice(&x[n_rhs * row..n_rhs * (row + 1)]);
            }
            let gathered = MatRef::from_row_major_slice(&*gathered, below, n_rhs);
            let own = &mut x[n_rhs * panel.begin..n_rhs * (panel.begin + panel.width)];
            let mut own = MatMut::from_row_major_slice_mut(own, panel.width, n_rhs);
            matmul(own.as_mut(), Accum::Add, f.transpose(), gathered, -1.0, Par::Seq);
            solve_upper_triangular_in_place(l.transpose(), own, Par::Seq);
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
            kernel::forward(self.values_of(panel), panel.width, panel.height, buffer);
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
            kernel::backward(self.values_of(panel), panel.width, panel.height, buffer);
            x[panel.begin..panel.begin + panel.width].copy_from_slice(&buffer[..panel.width]);
        }
    }

    fn values_of(&self, panel: &Panel) -> &[f64] {
        &self.values[panel.values..panel.values + panel.width * panel.height]
    }

    fn rows_below(&self, panel: &Panel) -> &[usize] {
        &self.rows[panel.rows..panel.rows + panel.height - panel.width]
    }

    /// Triangle and rows below.
    fn blocks(&self, panel: &Panel) -> (MatRef<'_, f64>, MatRef<'_, f64>) {
        let whole = MatRef::from_column_major_slice(self.values_of(panel), panel.height, panel.width);
        whole.split_at_row(panel.width)
    }
}
