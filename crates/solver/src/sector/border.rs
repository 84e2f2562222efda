//! A ring in sectors whose held nodes follow a rigid partner: a border of a few rows, next to nothing of it beside
//! the sectors.
//!
//! The block elimination of [`crate::bordered`], with Z = A^-1 B left by sector and B sparse:
//! `y = C^-1 (g - B^T A^-1 f)`, `x = A^-1 f - Z y`. All functions are collective.

use dense::DenseCholesky;

use super::agree::agree;
use super::columns::SectorColumns;
use super::factor::SectorCholesky;
use crate::bordered::factor_complement;
use crate::error::SolverError;
use crate::linear_solver::{LinearSolver, SparseVector};

/// Factor of `[A B; B^T D]` with A in sectors; the rows of the border come last. The border may have no rows.
#[derive(Debug)]
pub struct SectorBordered {
    inner: SectorCholesky,
    border: Vec<SparseVector>,
    /// Rows of B that are not empty, ascending.
    rows: Vec<usize>,
    /// A^-1 B.
    z: SectorColumns,
    schur: DenseCholesky,
}

/// Solutions: of the ring, by sector, and of the border.
#[derive(Debug)]
pub struct BorderedColumns {
    columns: SectorColumns,
    /// Column-major `[m][n_columns]`.
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
        let z = inner.columns(&[], &border);
        let rows = union(border.iter(), n);
        let values = z.values_at(&rows);
        let mut complement = corner.to_vec();
        for i in 0..m {
            for j in 0..=i {
                complement[m * i + j] -= sparse_dot(&border[i], &rows, |at| values[m * at + j]);
            }
        }
        Ok(SectorBordered {
            schur: agree(inner.shared.comm, factor_complement(n, &complement, corner))?,
            inner,
            border,
            rows,
            z,
        })
    }

    /// Solutions for `dense` right-hand sides, column-major `[n + m][..]`, and then `sparse` ones.
    ///
    /// # Panics
    /// When `dense.len()` is no multiple of n + m.
    pub fn columns(&self, dense: &[f64], sparse: &[SparseVector]) -> BorderedColumns {
        let (n, m) = (self.inner.n(), self.border.len());
        let size = (n + m).max(1);
        assert!(
            dense.len().is_multiple_of(size),
            "right-hand sides of {size} rows"
        );
        let mut inside = Vec::with_capacity(dense.len());
        let mut g = Vec::new();
        for column in dense.chunks_exact(size) {
            inside.extend_from_slice(&column[..n]);
            g.extend_from_slice(&column[n..]);
        }
        let mut loads = Vec::with_capacity(sparse.len());
        for load in sparse {
            let (within, beyond): (SparseVector, SparseVector) = load.iter().partition(|entry| entry.0 < n);
            loads.push(within);
            let first = g.len();
            g.resize(first + m, 0.0);
            beyond
                .iter()
                .for_each(|&(row, value)| g[first + row - n] += value);
        }
        let columns = self.inner.columns(&inside, &loads);
        let n_columns = columns.n_columns();
        let values = columns.values_at(&self.rows);
        for (r, g) in g.chunks_exact_mut(m.max(1)).enumerate() {
            for (g, b) in g.iter_mut().zip(&self.border) {
                *g -= sparse_dot(b, &self.rows, |at| values[n_columns * at + r]);
            }
        }
        self.schur.solve(&mut g, n_columns);
        BorderedColumns { columns, border: g }
    }

    /// Values of functionals of the solutions, row-major `[functionals.len()][n_columns]`.
    pub fn measure(&self, of: &BorderedColumns, functionals: &[&SparseVector]) -> Vec<f64> {
        let (n, m, n_columns) = (self.inner.n(), self.border.len(), of.columns.n_columns());
        let rows = union(functionals.iter().copied(), n);
        let mut values = of.columns.values_at(&rows);
        let z = self.z.values_at(&rows);
        for (values, z) in values
            .chunks_exact_mut(n_columns.max(1))
            .zip(z.chunks(m.max(1)).chain(std::iter::repeat(&[][..])))
        {
            for (value, y) in values.iter_mut().zip(of.border.chunks(m.max(1))) {
                *value -= z.iter().zip(y).map(|(z, y)| z * y).sum::<f64>();
            }
        }
        let mut measured = Vec::with_capacity(n_columns * functionals.len());
        for functional in functionals {
            let places: Vec<(usize, f64)> = functional
                .iter()
                .map(|&(row, value)| {
                    (
                        if row < n {
                            position(&rows, row)
                        } else {
                            rows.len() + row - n
                        },
                        value,
                    )
                })
                .collect();
            measured.extend((0..n_columns).map(|r| {
                let at = |place: usize| match place.checked_sub(rows.len()) {
                    None => values[n_columns * place + r],
                    Some(i) => of.border[m * r + i],
                };
                places
                    .iter()
                    .map(|&(place, value)| value * at(place))
                    .sum::<f64>()
            }));
        }
        measured
    }

    /// The sum of all solutions of `terms` times their factors, `[n + m]`, on all ranks.
    pub fn sum(&self, terms: &[(&BorderedColumns, &[f64])]) -> Vec<f64> {
        let m = self.border.len();
        let mut y = vec![0.0; m];
        for (columns, factors) in terms {
            for (column, f) in columns.border.chunks_exact(m.max(1)).zip(*factors) {
                y.iter_mut().zip(column).for_each(|(y, x)| *y += f * x);
            }
        }
        let back: Vec<f64> = y.iter().map(|y| -y).collect();
        let inside = terms
            .iter()
            .map(|(columns, factors)| (&columns.columns, *factors));
        let all: Vec<(&SectorColumns, &[f64])> = inside.chain([(&self.z, &back[..])]).collect();
        let mut sum = SectorColumns::sum(&all);
        sum.extend(y);
        sum
    }
}

impl BorderedColumns {
    /// Bytes on this rank.
    pub fn bytes(&self) -> usize {
        self.columns.bytes() + size_of::<f64>() * self.border.len()
    }

    /// The first solution alone.
    pub fn first(&self) -> BorderedColumns {
        let m = self.border.len() / self.columns.n_columns();
        BorderedColumns {
            columns: self.columns.first(),
            border: self.border[..m].to_vec(),
        }
    }

    /// Adds the first solution of `other` to the first of these.
    pub fn add_to_first(&mut self, other: &BorderedColumns) {
        self.columns.add_to_first(&other.columns);
        let m = self.border.len() / self.columns.n_columns();
        let pairs = self.border[..m].iter_mut().zip(&other.border);
        pairs.for_each(|(x, y)| *x += y);
    }
}

impl LinearSolver for SectorBordered {
    fn n(&self) -> usize {
        self.inner.n() + self.border.len()
    }

    fn solve(&self, rhs: &mut [f64], n_rhs: usize) {
        let n = self.n();
        assert_eq!(rhs.len(), n * n_rhs, "{n_rhs} right-hand sides of {n} rows");
        let columns = self.columns(rhs, &[]);
        for (r, column) in rhs.chunks_exact_mut(n.max(1)).enumerate() {
            let mut factors = vec![0.0; n_rhs];
            factors[r] = 1.0;
            column.copy_from_slice(&self.sum(&[(&columns, &factors)]));
        }
    }

    fn factor_bytes(&self) -> usize {
        self.inner.factor_bytes() + self.z.bytes() + self.schur.factor_bytes()
    }

    fn name(&self) -> &'static str {
        self.inner.name()
    }
}

/// Rows below n of some sparse vectors, ascending.
fn union<'v>(vectors: impl Iterator<Item = &'v SparseVector>, n: usize) -> Vec<usize> {
    let mut rows: Vec<usize> = vectors
        .flatten()
        .map(|entry| entry.0)
        .filter(|&row| row < n)
        .collect();
    rows.sort_unstable();
    rows.dedup();
    rows
}

fn position(rows: &[usize], row: usize) -> usize {
    rows.binary_search(&row)
        .expect("the union has the rows of its parts")
}

/// A functional of values at `rows`, given by place among them.
fn sparse_dot(functional: &SparseVector, rows: &[usize], at: impl Fn(usize) -> f64) -> f64 {
    functional
        .iter()
        .map(|&(row, value)| value * at(position(rows, row)))
        .sum()
}
