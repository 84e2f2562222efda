//! What can go wrong when a matrix is analysed or factored.

use dense::DenseError;
use thiserror::Error;

/// Failures of this crate. Rows and columns are in the caller's numbering.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SolverError {
    /// The matrix has different numbers of rows and columns.
    #[error("the matrix to factor has {rows} rows and {columns} columns; expected a square one")]
    NotSquare {
        /// Number of rows.
        rows: usize,
        /// Number of columns.
        columns: usize,
    },
    /// The elimination order does not name each row once.
    #[error(
        "the elimination order has {length} entries for {n} rows and is wrong at position {position}; \
         expected every row exactly once"
    )]
    NotPermutation {
        /// Length of the order.
        length: usize,
        /// Number of rows of the matrix.
        n: usize,
        /// First position with a repeated, missing or too large row.
        position: usize,
    },
    /// A matrix was factored with the analysis of another pattern.
    #[error(
        "the matrix has {found} stored entries in a pattern other than the analysed one ({expected} entries); \
         analyse it anew"
    )]
    PatternChanged {
        /// Stored entries of the matrix given.
        found: usize,
        /// Stored entries of the matrix analysed.
        expected: usize,
    },
    /// A stored entry is infinite or not a number.
    #[error(
        "matrix entry ({row}, {column}) is {value}; expected finite numbers, so check coordinates, material \
         and step size"
    )]
    NonFinite {
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
        /// The entry.
        value: f64,
    },
    /// Elimination met a pivot that is negative, zero or not a number.
    #[error(
        "the matrix of {n} rows is not positive definite: elimination breaks down at row {row}; the body may be \
         unsupported, or an element there inverted"
    )]
    NotPositiveDefinite {
        /// Row of the bad pivot.
        row: usize,
        /// Number of rows.
        n: usize,
    },
    /// A pivot is nothing but round-off.
    #[error(
        "the matrix of {n} rows is singular to working precision at row {row}: its pivot is {relative_pivot:.1e} of \
         its diagonal, the limit is {limit:.1e}; the body may be free to move as a whole, so support it or add mass"
    )]
    Singular {
        /// Row of the pivot.
        row: usize,
        /// Number of rows.
        n: usize,
        /// Pivot divided by the diagonal entry.
        relative_pivot: f64,
        /// Smallest accepted ratio.
        limit: f64,
    },
    /// A coupling of a periodic ring's sector cannot be.
    #[error(
        "the coupling of section node {row} with section node {column}, {shift} sectors farther, {problem}; expected \
         couplings in opposite pairs, each once, and one of every node with itself"
    )]
    BadCoupling {
        /// Section node of the rows.
        row: usize,
        /// Section node of the columns.
        column: usize,
        /// Sectors from the first to the second.
        shift: i32,
        /// What is wrong.
        problem: &'static str,
    },
    /// The blocks of a periodic ring's sector do not make a symmetric matrix.
    #[error(
        "the coupling of section node {row} with section node {column}, {shift} sectors farther, differs from its \
         opposite by {difference:.1e}, the limit is {limit:.1e}; expected transposed blocks"
    )]
    NotSymmetric {
        /// Section node of the rows.
        row: usize,
        /// Section node of the columns.
        column: usize,
        /// Sectors from the first to the second.
        shift: i32,
        /// Largest difference of an entry.
        difference: f64,
        /// Largest accepted difference.
        limit: f64,
    },
    /// A border of a periodic ring is no rigid motion.
    #[error(
        "column {column} of the border reaches beyond the lowest harmonics of the ring with a share of {share:.1e}; \
         expected rigid motions of whole rings of nodes"
    )]
    BorderBeyond {
        /// Column of the border.
        column: usize,
        /// Largest harmonic beyond, relative to the largest of the lowest.
        share: f64,
    },
    /// A ring cannot be cut into that many sectors.
    #[error(
        "a ring of {n_elements} elements cannot be cut into {n_sectors} sectors; expected 1 to {n_elements}"
    )]
    BadSectors {
        /// Sectors asked for.
        n_sectors: usize,
        /// Elements of the ring.
        n_elements: usize,
    },
    /// Another rank has failed.
    #[error("on rank {rank}: {message}")]
    OnRank {
        /// The rank.
        rank: usize,
        /// Its error.
        message: String,
    },
    /// The factor does not fit into memory.
    #[error(
        "no memory for a factorisation of {n} rows, which needs {bytes} bytes; use a coarser mesh, more sectors \
         or a machine with more memory"
    )]
    OutOfMemory {
        /// Number of rows.
        n: usize,
        /// Bytes asked for.
        bytes: usize,
    },
    /// A dense matrix failed otherwise.
    #[error(transparent)]
    Dense(DenseError),
}

impl From<DenseError> for SolverError {
    fn from(error: DenseError) -> SolverError {
        match error {
            DenseError::NonFinite { row, column, value } => SolverError::NonFinite { row, column, value },
            DenseError::NotPositiveDefinite { row, n } => SolverError::NotPositiveDefinite { row, n },
            DenseError::Singular {
                row,
                n,
                relative_pivot,
                limit,
            } => SolverError::Singular {
                row,
                n,
                relative_pivot,
                limit,
            },
            other => SolverError::Dense(other),
        }
    }
}

impl SolverError {
    /// Row of the matrix to blame, in the caller's numbering, so that the caller can name node and body.
    pub fn row(&self) -> Option<usize> {
        match *self {
            SolverError::NonFinite { row, .. }
            | SolverError::NotPositiveDefinite { row, .. }
            | SolverError::Singular { row, .. } => Some(row),
            _ => None,
        }
    }

    /// The error of a part as one of the whole matrix of `n` rows, in which row and column k of the part are number
    /// `of(k)`.
    pub(crate) fn in_whole(mut self, n: usize, of: impl Fn(usize) -> usize) -> SolverError {
        match &mut self {
            SolverError::NotPositiveDefinite { row, n: rows }
            | SolverError::Singular { row, n: rows, .. } => {
                (*row, *rows) = (of(*row), n);
            }
            SolverError::NonFinite { row, column, .. } => (*row, *column) = (of(*row), of(*column)),
            _ => {}
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a message would blame a row of the part, which is another node of the ring.
    #[test]
    fn errors_of_a_part_name_rows_of_the_whole() {
        let part = [
            SolverError::NotPositiveDefinite { row: 1, n: 2 },
            SolverError::Singular {
                row: 0,
                n: 2,
                relative_pivot: 1e-14,
                limit: 1e-12,
            },
            SolverError::NonFinite {
                row: 1,
                column: 0,
                value: f64::INFINITY,
            },
            SolverError::Dense(DenseError::EigenNotFinite),
        ];
        let whole = part.map(|error| error.in_whole(9, |k| [7, 4][k]));
        let expected = [
            SolverError::NotPositiveDefinite { row: 4, n: 9 },
            SolverError::Singular {
                row: 7,
                n: 9,
                relative_pivot: 1e-14,
                limit: 1e-12,
            },
            SolverError::NonFinite {
                row: 4,
                column: 7,
                value: f64::INFINITY,
            },
            SolverError::Dense(DenseError::EigenNotFinite),
        ];
        assert_eq!(whole, expected);
    }
}
