//! Errors of ranks that work together.

use comm::Communicator;

use crate::error::SolverError;

/// The result of all ranks: an error on one is an error on all.
#[track_caller]
pub(super) fn agree<T>(comm: Communicator, result: Result<T, SolverError>) -> Result<T, SolverError> {
    comm.agree(result, |rank, message| SolverError::OnRank { rank, message })
}
