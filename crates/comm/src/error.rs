//! Failures of this crate.

use thiserror::Error;

/// Failures of this crate.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum CommError {
    /// A launcher has started several tasks of a program that runs as one.
    #[error(
        "the launcher started {tasks} tasks ({variable}={tasks}), but this program was built without MPI and runs as \
         one process, so they would all do the same run; start one task (-n 1) and give it the cores as threads"
    )]
    ParallelLaunch {
        /// Environment variable that says so.
        variable: &'static str,
        /// Number of tasks.
        tasks: usize,
    },
    /// The tasks that a launcher started do not see each other.
    #[error(
        "the launcher started {tasks} tasks ({variable}={tasks}), but MPI knows of {size}: launcher and program use \
         different MPI libraries; start the program with the launcher of {library}"
    )]
    WrongLauncher {
        /// Environment variable that says so.
        variable: &'static str,
        /// Number of tasks.
        tasks: usize,
        /// Number of ranks.
        size: usize,
        /// The library the program was built with.
        library: String,
    },
    /// MPI does not start.
    #[error(
        "the MPI library does not start; it was started before, or does not support calls from one thread of several"
    )]
    NoMpi,
}
