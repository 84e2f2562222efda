//! Start and end of a process as one of the ranks.

use std::time::Duration;

use crate::communicator::Communicator;
use crate::error::CommError;
use crate::launch;

/// How long a rank that has failed waits for the others to fail as well before it ends them.
pub const PATIENCE: Duration = Duration::from_secs(2);

/// A process among its ranks; to be kept until the end.
pub struct Environment {
    #[cfg(feature = "mpi")]
    mpi: Option<parallel::Mpi>,
}

/// How a process ends among its ranks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
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

    /// Waits for all ranks to end. A rank that failed waits [`PATIENCE`] only, and then learns that it is alone: the others wait
    /// for its messages, and it must end them with [`Environment::abort`].
    pub fn finish(&self, success: bool) -> End {
        #[cfg(feature = "mpi")]
        if let Some(mpi) = &self.mpi {
            return mpi.finish(success);
        }
        let _ = success;
        End::Together
    }

    /// Ends all ranks at once with an exit code.
    pub fn abort(&self, code: u8) -> ! {
        #[cfg(feature = "mpi")]
        if let Some(mpi) = &self.mpi {
            mpi.abort(code);
        }
        std::process::exit(i32::from(code))
    }
}

#[cfg(not(feature = "mpi"))]
pub(crate) fn world() -> Communicator {
    Communicator::Serial
}

#[cfg(feature = "mpi")]
pub(crate) use parallel::world;

#[cfg(feature = "mpi")]
mod parallel {
    use std::sync::OnceLock;
    use std::time::Instant;

    use mpi::Threading;
    use mpi::collective::CommunicatorCollectives;
    use mpi::environment::Universe;
    use mpi::topology::{Communicator as _, SimpleCommunicator};

    use super::{Communicator, End, PATIENCE};
    use crate::error::CommError;
    use crate::messages;

    /// Exit code of a panic, as that of a process alone.
    const PANICKED: i32 = 101;

    /// Set once MPI runs: the library itself is one per process.
    static RUNNING: OnceLock<()> = OnceLock::new();

    pub(crate) fn world() -> Communicator {
        match RUNNING.get() {
            Some(()) => Communicator::Mpi,
            None => Communicator::Serial,
        }
    }

    /// MPI, running.
    pub(super) struct Mpi {
        /// A second set of the same ranks, on which the end is announced: messages of the run cannot be mistaken for it.
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
            let _ = RUNNING.set(());
            let shown = std::panic::take_hook();
            std::panic::set_hook(Box::new(move |panic| {
                shown(panic);
                // Unwinding would wait for the others in MPI_Finalize, for ever.
                SimpleCommunicator::world().abort(PANICKED);
            }));
            Ok(Mpi {
                ending: SimpleCommunicator::world().duplicate(),
                _universe: universe,
            })
        }

        pub(super) fn finish(&self, success: bool) -> End {
            let start = Instant::now();
            let mut barrier = self.ending.immediate_barrier();
            loop {
                barrier = match barrier.test() {
                    Ok(_) => return End::Together,
                    Err(pending) => pending,
                };
                if !success && start.elapsed() > PATIENCE {
                    // The barrier is never completed: the process ends with it.
                    std::mem::forget(barrier);
                    return End::Alone;
                }
                std::thread::sleep(std::time::Duration::from_millis(1));
            }
        }

        pub(super) fn abort(&self, code: u8) -> ! {
            SimpleCommunicator::world().abort(i32::from(code))
        }
    }
}
