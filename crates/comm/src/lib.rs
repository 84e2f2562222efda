//! The ranks of a run and the few message-passing operations they need.
//!
//! A run is one program on all ranks (SPMD): every rank takes the same decisions from the same numbers, and calls the
//! same operations in the same order, from its main thread. With one process every operation is the identity, at no
//! cost. With the feature `mpi` the ranks are those of an MPI launcher; this crate alone knows it.
//!
//! **Failure.** Ranks agree on success before the next operation where one of them may fail alone
//! ([`Communicator::agree`]). What slips through is caught at the end: a rank that ends with an error waits
//! [`PATIENCE`] for the others to end as well, and then ends them ([`Environment::finish`]); a panic ends all at
//! once. A rank that is killed is the launcher's business, which ends the others. What should fail on all ranks,
//! because they compute it from the same numbers, may fail on one whose numbers are wrong: it exchanges nothing more
//! before it knows that all have failed ([`Communicator::all_failed`]).
//!
//! With the feature `inject`, which only `scripts/test-mpi` turns on, faults can be asked for at every message.

mod communicator;
mod environment;
mod error;
mod failing;
#[cfg(feature = "inject")]
mod inject;
mod launch;
#[cfg(feature = "mpi")]
mod messages;
pub mod print;

pub use communicator::{Communicator, shares};
pub use environment::{Environment, ProcessEnd};
pub use error::CommError;
pub use failing::{FAILURE_PATIENCE, PATIENCE};
