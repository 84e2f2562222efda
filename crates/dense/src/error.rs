//! What can go wrong when a dense matrix is factored.

use thiserror::Error;

/// Failures of this crate.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum DenseError {
    /// An entry is infinite or not a number.
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
        /// Pivot divided by the largest entry of its column.
        relative_pivot: f64,
        /// Smallest accepted ratio.
        limit: f64,
    },
    /// The iteration for eigenvalues did not end.
    #[error(
        "the eigenvalues of a matrix of {n} rows have not converged; check coordinates, material and masses"
    )]
    EigenNotConverged {
        /// Number of rows.
        n: usize,
    },
    /// Lanczos gave up.
    #[error(
        "{converged} of {wanted} eigenpairs have converged after {steps} blocks; ask for fewer, or move the shift \
         towards their frequencies"
    )]
    SearchNotConverged {
        /// Pairs asked for.
        wanted: usize,
        /// Pairs that have converged.
        converged: usize,
        /// Blocks tried.
        steps: usize,
    },
    /// A matrix whose eigenvalues are wanted has an entry that is infinite or not a number.
    #[error("an eigenvalue is not finite; check coordinates, material and masses")]
    EigenNotFinite,
}
