//! A ring in sectors whose held nodes follow a rigid partner: a border of a few rows, next to nothing of it beside
//! the sectors.
//!
//! The block elimination of [`crate::bordered`] on right-hand sides that are half solved, [`SectorHalves`]. Of a
//! right-hand side (f; g), with C the complement of A,
//! ```text
//! r = g - B^T A^-1 f,    y = C^-1 r,    x = A^-1 (f - B y)
//! (f; g) S^-1 (h; k) = f A^-1 h  +  r(f, g) y(h, k)
//! ```
//! All functions are collective.

use dense::DenseCholesky;

use super::agree::agree;
use super::factor::SectorCholesky;
use super::halves::SectorHalves;
use crate::bordered::factor_complement;
use crate::error::SolverError;
use crate::linear_solver::{LinearSolver, SparseVector};

/// Factor of `[A B; B^T D]` with A in sectors; the rows of the border come last. The border may have no rows.
#[derive(Debug)]
pub struct SectorBordered {
    inner: SectorCholesky,
    /// B.
    border: SectorHalves,
    schur: DenseCholesky,
}

/// Right-hand sides half way: those of the ring, and the border's rows.
#[derive(Debug)]
pub struct BorderedHalves {
    halves: SectorHalves,
    /// r, `[n_columns][m]`.
    reached: Vec<f64>,
    /// y, the same.
    border: Vec<f64>,
}

impl SectorBordered {
    /// Borders the matrix A of `inner` with the columns B and the symmetric D, row-major `[m][m]`, of which the lower
    /// triangle counts. Errors name rows of the whole, those of the border from n on.
    ///
    /// # Panics
    /// When the sizes disagree.
    pub fn new(
        inner: SectorCholesky,
        border: Vec<SparseVector>,
        corner: &[f64],
    ) -> Result<SectorBordered, SolverError> {
        let (n, m) = (inner.n(), border.len());
        assert_eq!(corner.len(), m * m, "a corner of {m} rows");
        for (column, entries) in border.iter().enumerate() {
            if let Some(&(row, value)) = entries.iter().find(|(_, value)| !value.is_finite()) {
                let column = n + column;
                return Err(SolverError::NonFinite { row, column, value });
            }
        }
        let [_, border] = inner.halves(&[], &border);
        let of_border = border.products(&border);
        let complement: Vec<f64> = corner.iter().zip(of_border).map(|(d, b)| d - b).collect();
        Ok(SectorBordered {
            schur: agree(inner.shared.comm, factor_complement(n, &complement, corner))?,
            inner,
            border,
        })
    }

    /// `dense` right-hand sides, column-major `[n + m][..]`, and `sparse` ones.
    ///
    /// # Panics
    /// When `dense.len()` is no multiple of n + m.
    pub fn halves(&self, dense: &[f64], sparse: &[SparseVector]) -> [BorderedHalves; 2] {
        let (n, m) = (self.inner.n(), self.border.n_columns());
        let size = (n + m).max(1);
        assert!(
            dense.len().is_multiple_of(size),
            "right-hand sides of {size} rows"
        );
        let (mut inside, mut beyond) = (Vec::with_capacity(dense.len()), [Vec::new(), Vec::new()]);
        for column in dense.chunks_exact(size) {
            inside.extend_from_slice(&column[..n]);
            beyond[0].extend_from_slice(&column[n..]);
        }
        let mut loads = Vec::with_capacity(sparse.len());
        for load in sparse {
            let (within, behind): (SparseVector, SparseVector) = load.iter().partition(|entry| entry.0 < n);
            loads.push(within);
            let first = beyond[1].len();
            beyond[1].resize(first + m, 0.0);
            let rows = behind.iter();
            rows.for_each(|&(row, value)| beyond[1][first + row - n] += value);
        }
        let [of_dense, of_sparse] = self.inner.halves(&inside, &loads);
        let [g, h] = beyond;
        [self.bordered(of_dense, g), self.bordered(of_sparse, h)]
    }

    /// Right-hand sides with the rows `g` of the border, `[n_columns][m]`.
    fn bordered(&self, halves: SectorHalves, mut g: Vec<f64>) -> BorderedHalves {
        let known = halves.products(&self.border);
        g.iter_mut().zip(known).for_each(|(g, known)| *g -= known);
        let mut border = g.clone();
        self.schur.solve(&mut border, halves.n_columns());
        BorderedHalves {
            halves,
            reached: g,
            border,
        }
    }

    /// The sum of all solutions of `terms` times their factors, `[n + m]`, on all ranks: one sweep backwards.
    ///
    /// # Panics
    /// When a term has another number of factors than columns.
    pub fn finish(&self, terms: &[(&BorderedHalves, &[f64])]) -> Vec<f64> {
        let m = self.border.n_columns();
        let mut y = vec![0.0; m];
        for (halves, factors) in terms {
            for (column, f) in halves.border.chunks_exact(m.max(1)).zip(*factors) {
                y.iter_mut().zip(column).for_each(|(y, x)| *y += f * x);
            }
        }
        let back: Vec<f64> = y.iter().map(|y| -y).collect();
        let inside = terms.iter().map(|(halves, factors)| (&halves.halves, *factors));
        let all: Vec<(&SectorHalves, &[f64])> = inside.chain([(&self.border, &back[..])]).collect();
        let mut sum = self.inner.finish(&all);
        sum.extend(y);
        sum
    }
}

impl BorderedHalves {
    /// Bytes on this rank.
    pub fn bytes(&self) -> usize {
        self.halves.bytes() + size_of::<f64>() * (self.reached.len() + self.border.len())
    }

    /// Number of right-hand sides.
    pub fn n_columns(&self) -> usize {
        self.halves.n_columns()
    }

    /// What each of these right-hand sides measures of the solutions of others, row-major
    /// `[n_columns][others.n_columns]`, on all ranks.
    pub fn products(&self, others: &BorderedHalves) -> Vec<f64> {
        let mut products = self.halves.products(&others.halves);
        let m = self.reached.len() / self.n_columns().max(1);
        let rows = products.chunks_exact_mut(others.n_columns().max(1));
        for (row, r) in rows.zip(self.reached.chunks(m.max(1))) {
            for (value, y) in row.iter_mut().zip(others.border.chunks(m.max(1))) {
                *value += r.iter().zip(y).map(|(r, y)| r * y).sum::<f64>();
            }
        }
        products
    }

    /// Adds right-hand sides to these, one to one.
    ///
    /// # Panics
    /// When their numbers differ, or they touch other sectors.
    pub fn add(&mut self, more: &BorderedHalves) {
        self.halves.add(&more.halves);
        for (own, more) in [
            (&mut self.reached, &more.reached),
            (&mut self.border, &more.border),
        ] {
            own.iter_mut().zip(more).for_each(|(x, y)| *x += y);
        }
    }
}

impl LinearSolver for SectorBordered {
    fn n(&self) -> usize {
        self.inner.n() + self.border.n_columns()
    }

    fn solve(&self, rhs: &mut [f64], n_rhs: usize) {
        let n = self.n();
        assert_eq!(rhs.len(), n * n_rhs, "{n_rhs} right-hand sides of {n} rows");
        let [halves, _] = self.halves(rhs, &[]);
        for (r, column) in rhs.chunks_exact_mut(n.max(1)).enumerate() {
            let mut factors = vec![0.0; n_rhs];
            factors[r] = 1.0;
            column.copy_from_slice(&self.finish(&[(&halves, &factors)]));
        }
    }

    fn factor_bytes(&self) -> usize {
        self.inner.factor_bytes() + self.border.bytes() + self.schur.factor_bytes()
    }

    fn name(&self) -> &'static str {
        self.inner.name()
    }
}
