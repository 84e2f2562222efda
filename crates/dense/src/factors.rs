//! Cholesky and LU factors. Time n^3/3 (Cholesky) or 2 n^3/3 (LU), memory n^2.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt;
use faer::linalg::lu::partial_pivoting as lu;
use faer::perm::PermRef;
use faer::{Mat, MatMut, MatRef, Par};

use crate::error::DenseError;

/// Smallest accepted pivot relative to the largest entry of its column in the row-scaled matrix, per row.
const PIVOT_LIMIT_PER_ROW: f64 = f64::EPSILON;

/// Cholesky factor of a dense symmetric positive definite matrix.
#[derive(Clone, Debug)]
pub struct DenseCholesky {
    factor: Mat<f64>,
}

impl DenseCholesky {
    /// Factors the symmetric positive definite matrix `a`, row-major `[n][n]`, of which the lower triangle is read.
    /// The error names the row at which elimination breaks down.
    ///
    /// # Panics
    /// When `a.len() != n * n`.
    pub fn factor(n: usize, a: &[f64]) -> Result<Self, DenseError> {
        check_dense(n, a)?;
        let mut factor = MatRef::from_row_major_slice(a, n, n).to_owned();
        cholesky_in_place(factor.as_mut())?;
        Ok(DenseCholesky { factor })
    }

    /// Inverse, row-major `[n][n]`, exactly symmetric.
    pub fn inverse(&self) -> Vec<f64> {
        let n = self.n();
        let mut inverse = identity(n);
        self.solve(&mut inverse, n);
        for i in 0..n {
            for j in 0..i {
                let mean = 0.5 * (inverse[n * i + j] + inverse[n * j + i]);
                (inverse[n * i + j], inverse[n * j + i]) = (mean, mean);
            }
        }
        inverse
    }

    /// Number of rows.
    pub fn n(&self) -> usize {
        self.factor.nrows()
    }

    /// Replaces right-hand sides, column-major `[n][n_rhs]`, by solutions.
    ///
    /// # Panics
    /// When `rhs.len() != n * n_rhs`.
    pub fn solve(&self, rhs: &mut [f64], n_rhs: usize) {
        let n = self.n();
        assert_eq!(rhs.len(), n * n_rhs, "{n_rhs} right-hand sides of {n} rows");
        let mut memory = MemBuffer::new(llt::solve::solve_in_place_scratch::<f64>(n, n_rhs, Par::Seq));
        llt::solve::solve_in_place(
            self.factor.as_ref(),
            MatMut::from_column_major_slice_mut(rhs, n, n_rhs),
            Par::Seq,
            MemStack::new(&mut memory),
        );
    }

    /// L in the lower triangle; what stands above is no part of it.
    pub(crate) fn into_lower(self) -> Mat<f64> {
        self.factor
    }
}

/// L in place of the lower triangle of a symmetric positive definite matrix. The error names the row at which
/// elimination breaks down.
pub fn cholesky_in_place(mut matrix: MatMut<'_, f64>) -> Result<(), DenseError> {
    let n = matrix.nrows();
    let request = llt::factor::cholesky_in_place_scratch::<f64>(n, Par::Seq, Default::default());
    let mut memory = MemBuffer::new(request);
    let done = llt::factor::cholesky_in_place(
        matrix.as_mut(),
        Default::default(),
        Par::Seq,
        MemStack::new(&mut memory),
        Default::default(),
    );
    match done {
        Ok(_) => Ok(()),
        Err(llt::factor::LltError::NonPositivePivot { index }) => {
            Err(DenseError::NotPositiveDefinite { row: index, n })
        }
    }
}

/// LU factors, with row exchanges, of a dense matrix that need be neither symmetric nor definite.
///
/// Rows are scaled by powers of two first, so that rows in newton and rows in metre are exchanged on equal terms.
#[derive(Clone, Debug)]
pub struct DenseLu {
    factor: Mat<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
    row_scale: Vec<f64>,
}

impl DenseLu {
    /// Factors `a`, row-major `[n][n]`. A pivot below n eps of its column's largest entry is an error that names
    /// the column.
    ///
    /// # Panics
    /// When `a.len() != n * n`.
    pub fn factor(n: usize, a: &[f64]) -> Result<Self, DenseError> {
        check_dense(n, a)?;
        let row_scale: Vec<f64> = (0..n)
            .map(|i| power_of_two_scale(&a[n * i..n * (i + 1)]))
            .collect();
        let mut columns = scaled_columns(n, a, &row_scale);
        let largest: Vec<f64> = columns.chunks_exact(n.max(1)).map(largest_size).collect();
        let mut factor = MatMut::from_column_major_slice_mut(&mut columns, n, n).to_owned();
        let (mut forward, mut inverse) = (vec![0; n], vec![0; n]);
        let request = lu::factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Default::default());
        let mut memory = MemBuffer::new(request);
        let stack = MemStack::new(&mut memory);
        lu::factor::lu_in_place(
            factor.as_mut(),
            &mut forward,
            &mut inverse,
            Par::Seq,
            stack,
            Default::default(),
        );
        let limit = n as f64 * PIVOT_LIMIT_PER_ROW;
        for column in 0..n {
            let relative_pivot = factor[(column, column)].abs() / largest[column];
            // Written so that NaN, which 0/0 of an empty column gives, is refused as well.
            if relative_pivot.is_nan() || relative_pivot <= limit {
                return Err(DenseError::Singular {
                    row: column,
                    n,
                    relative_pivot,
                    limit,
                });
            }
        }
        Ok(DenseLu {
            factor,
            forward,
            inverse,
            row_scale,
        })
    }

    /// Number of rows.
    pub fn n(&self) -> usize {
        self.factor.nrows()
    }

    /// Replaces right-hand sides, column-major `[n][n_rhs]`, by solutions.
    ///
    /// # Panics
    /// When `rhs.len() != n * n_rhs`.
    pub fn solve(&self, rhs: &mut [f64], n_rhs: usize) {
        let n = self.n();
        assert_eq!(rhs.len(), n * n_rhs, "{n_rhs} right-hand sides of {n} rows");
        if rhs.is_empty() {
            return;
        }
        for column in rhs.chunks_exact_mut(n) {
            column
                .iter_mut()
                .zip(&self.row_scale)
                .for_each(|(value, scale)| *value *= scale);
        }
        let mut memory = MemBuffer::new(lu::solve::solve_in_place_scratch::<usize, f64>(
            n,
            n_rhs,
            Par::Seq,
        ));
        lu::solve::solve_in_place(
            self.factor.as_ref(),
            self.factor.as_ref(),
            PermRef::new_checked(&self.forward, &self.inverse, n),
            MatMut::from_column_major_slice_mut(rhs, n, n_rhs),
            Par::Seq,
            MemStack::new(&mut memory),
        );
    }

    /// Inverse, row-major `[n][n]`.
    pub fn inverse(&self) -> Vec<f64> {
        let n = self.n();
        let mut columns = identity(n);
        self.solve(&mut columns, n);
        (0..n * n).map(|k| columns[n * (k % n) + k / n]).collect()
    }
}

/// The power of two nearest below the reciprocal of a row's largest entry: exact, so scaling adds no error.
fn power_of_two_scale(row: &[f64]) -> f64 {
    let largest = largest_size(row);
    if largest < f64::MIN_POSITIVE {
        1.0
    } else {
        (-largest.log2().ceil()).clamp(-1000.0, 1000.0).exp2()
    }
}

/// Entries summed up side by side, so that the processor's vectors take them.
const LANES: usize = 8;
/// Rows turned into columns at a time: a line of the cache.
const ROWS: usize = 8;

/// Largest size of any value.
fn largest_size(values: &[f64]) -> f64 {
    let (chunks, rest) = values.as_chunks::<LANES>();
    let mut most = [0.0_f64; LANES];
    for chunk in chunks {
        for (most, value) in most.iter_mut().zip(chunk) {
            *most = most.max(value.abs());
        }
    }
    most.iter()
        .chain(rest)
        .fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// Columns of the row-major matrix `a` whose rows are scaled.
fn scaled_columns(n: usize, a: &[f64], row_scale: &[f64]) -> Vec<f64> {
    let mut columns = vec![0.0; n * n];
    for first in (0..n).step_by(ROWS) {
        let rows = first..(first + ROWS).min(n);
        for (j, column) in columns.chunks_exact_mut(n).enumerate() {
            for i in rows.clone() {
                column[i] = row_scale[i] * a[n * i + j];
            }
        }
    }
    columns
}

fn identity(n: usize) -> Vec<f64> {
    let mut columns = vec![0.0; n * n];
    columns.iter_mut().step_by(n + 1).for_each(|value| *value = 1.0);
    columns
}

/// Checks size and entries of a row-major matrix.
pub(crate) fn check_dense(n: usize, a: &[f64]) -> Result<(), DenseError> {
    assert_eq!(a.len(), n * n, "a dense matrix of {n} rows");
    // Without an early end, so that the processor's vectors take it.
    if a.iter().fold(true, |all, value| all & value.is_finite()) {
        return Ok(());
    }
    match a.iter().position(|value| !value.is_finite()) {
        Some(k) => Err(DenseError::NonFinite {
            row: k / n,
            column: k % n,
            value: a[k],
        }),
        None => Ok(()),
    }
}
