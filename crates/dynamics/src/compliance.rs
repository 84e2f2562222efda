//! The inverse of the compliance of a ring's contacts, or the error that says why there is none.

use contact::Side;
use dense::DenseCholesky;

use crate::error::DynamicsError;

/// Largest product of a diagonal entry of C and the same of C^-1: the digits that the inverse has lost there.
/// Contacts that the mesh tells apart have 1 to 10, with a ring that floats up to 1e4; of ones that it does not,
/// nothing is left.
const LARGEST_LOSS: f64 = 1e10;

/// C^-1 of the compliance C of contacts and mount, SI, row-major `[n][n]`.
pub(crate) fn inverse(
    side: Side,
    n: usize,
    n_balls: usize,
    compliance: &[f64],
) -> Result<Vec<f64>, DynamicsError> {
    let not_distinct = || DynamicsError::ContactsNotDistinct {
        side: side.name(),
        n_balls,
    };
    let inverse = DenseCholesky::factor(n, compliance)
        .map_err(|_| not_distinct())?
        .inverse();
    let loss = |i: usize| compliance[(n + 1) * i] * inverse[(n + 1) * i];
    if (0..n).all(|i| loss(i) <= LARGEST_LOSS) {
        Ok(inverse)
    } else {
        Err(not_distinct())
    }
}
