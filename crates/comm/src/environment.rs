//! Start and end of a process as one of the ranks.

use crate::communicator::Communicator;
use crate::error::CommError;
use crate::launch;

/// A process among its ranks; to be kept until the end.
pub struct Environment {
    #[cfg(feature = "mpi")]
    mpi: Option<parallel::Mpi>,
}

/// How a process ends among its ranks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProcessEnd {
    /// All ranks have ended.
    Together,
    /// This rank has failed alone; the others still run.
    Alone,
}

impl Environment {
    /// Joins the ranks that a launcher has started, if any. Refuses tasks that cannot talk to each other.
    #[cfg(not(feature = "mpi"))]
    pub fn start() -> Result<Environment, CommError> {
        match launch::tasks(|name| std::env::var(name).ok()) {
            Some((variable, tasks)) => Err(CommError::ParallelLaunch { variable, tasks }),
            None => Ok(Environment {}),
        }
    }

    /// Joins the ranks that a launcher has started, if any. Refuses tasks that cannot talk to each other.
    #[cfg(feature = "mpi")]
    pub fn start() -> Result<Environment, CommError> {
        let mpi = match launch::tasks(|name| std::env::var(name).ok()) {
            Some((variable, tasks)) => Some(parallel::Mpi::start(variable, tasks)?),
            None => None,
        };
        Ok(Environment { mpi })
    }

    /// Waits for all ranks to end. A rank that failed waits [`crate::PATIENCE`] only, and then learns that it is alone:
    /// the others wait for its messages, and it must end them with [`Environment::abort`].
    pub fn finish(&self, success: bool) -> ProcessEnd {
        #[cfg(feature = "mpi")]
        if let Some(mpi) = &self.mpi {
            return mpi.finish(success);
        }
        let _ = success;
        ProcessEnd::Together
    }

    /// Ends all ranks at once with an exit code.
    pub fn abort(&self, code: u8) -> ! {
        Communicator::world().abort(code)
    }
}

#[cfg(feature = "mpi")]
mod parallel {
    use mpi::Threading;
    use mpi::environment::Universe;
    use mpi::topology::{Communicator as _, SimpleCommunicator};

    use super::ProcessEnd;
    use crate::communicator;
    use crate::error::CommError;
    use crate::failing::{self, PATIENCE, meet};
    use crate::messages;

    /// Exit code of a panic, as that of a process alone.
    const PANICKED: i32 = 101;

    /// MPI, running.
    pub(super) struct Mpi {
        /// A second set of the same ranks, on which the end is announced: messages of the run cannot be mistaken for
        /// it.
        ending: SimpleCommunicator,
        /// Ends MPI when it is dropped.
        _universe: Universe,
    }

    impl Mpi {
        pub(super) fn start(variable: &'static str, tasks: usize) -> Result<Mpi, CommError> {
            let (universe, threading) =
                mpi::initialize_with_threading(Threading::Funneled).ok_or(CommError::NoMpi)?;
            if threading < Threading::Funneled {
                return Err(CommError::NoMpi);
            }
            let size = messages::size();
            if size != tasks {
                let version = mpi::environment::library_version().unwrap_or_default();
                let library = version
                    .split(['\0', '\n', ','])
                    .next()
                    .unwrap_or_default()
                    .to_string();
                return Err(CommError::WrongLauncher {
                    variable,
                    tasks,
                    size,
                    library,
                });
            }
            communicator::note_running();
            failing::prepare(SimpleCommunicator::world().duplicate());
            let (rank, shown) = (messages::rank(), std::panic::take_hook());
            std::panic::set_hook(Box::new(move |panic| {
                crate::print::from_any_rank(format_args!("error: on rank {rank}: a fault of the program:"));
                shown(panic);
                // Unwinding would wait for the others in MPI_Finalize, for ever.
                SimpleCommunicator::world().abort(PANICKED);
            }));
            Ok(Mpi {
                ending: SimpleCommunicator::world().duplicate(),
                _universe: universe,
            })
        }

        pub(super) fn finish(&self, success: bool) -> ProcessEnd {
            let patience = (!success).then_some(PATIENCE);
            match meet(&self.ending, patience) {
                true => ProcessEnd::Together,
                false => ProcessEnd::Alone,
            }
        }
    }

    impl Drop for Mpi {
        fn drop(&mut self) {
            // Before MPI ends, with the universe.
            failing::forget();
        }
    }
}
