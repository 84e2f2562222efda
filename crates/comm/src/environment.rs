//! Start and end of a process as one of the ranks.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use crate::communicator::Communicator;
use crate::error::CommError;
use crate::launch;

/// How long a rank that has failed waits for the others to fail as well before it ends them.
pub const PATIENCE: Duration = Duration::from_secs(2);

/// How long a rank whose computation has failed waits for those of the others to fail as well. Longer than
/// [`PATIENCE`], because ranks that go on compute until they fail.
pub const FAILURE_PATIENCE: Duration = Duration::from_secs(10);

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

    /// Waits for all ranks to end. A rank that failed waits [`PATIENCE`] only, and then learns that it is alone: the
    /// others wait for its messages, and it must end them with [`Environment::abort`].
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
        Communicator::world().abort(code)
    }
}

/// Whether an agreement has failed by this rank and not by all.
static OWN_FAILURE: AtomicBool = AtomicBool::new(false);

#[cfg(feature = "mpi")]
pub(crate) fn note_own_failure() {
    OWN_FAILURE.store(true, Ordering::Relaxed);
}

pub(crate) fn has_failed_alone() -> bool {
    OWN_FAILURE.load(Ordering::Relaxed)
}

#[cfg(not(feature = "mpi"))]
pub(crate) fn world() -> Communicator {
    Communicator::Serial
}

#[cfg(feature = "mpi")]
pub(crate) use parallel::{all_failed, world};

#[cfg(feature = "mpi")]
mod parallel {
    use std::cell::{Cell, RefCell};
    use std::sync::OnceLock;
    use std::time::{Duration, Instant};

    use mpi::Threading;
    use mpi::collective::CommunicatorCollectives;
    use mpi::environment::Universe;
    use mpi::topology::{Communicator as _, SimpleCommunicator};

    use super::{Communicator, End, FAILURE_PATIENCE, PATIENCE};
    use crate::error::CommError;
    use crate::messages;

    /// Exit code of a panic, as that of a process alone.
    const PANICKED: i32 = 101;

    /// Set once MPI runs: the library itself is one per process.
    static RUNNING: OnceLock<()> = OnceLock::new();

    thread_local! {
        /// A set of the same ranks on which those meet that have failed; of the main thread, which sends all messages.
        static FAILING: RefCell<Option<SimpleCommunicator>> = const { RefCell::new(None) };
        /// Whether this rank has waited for the others to fail in vain.
        static ALONE: Cell<bool> = const { Cell::new(false) };
    }

    pub(crate) fn world() -> Communicator {
        match RUNNING.get() {
            Some(()) => Communicator::Mpi,
            None => Communicator::Serial,
        }
    }

    /// Whether all ranks call this within [`FAILURE_PATIENCE`]. Once they have not, the answer stays.
    pub(crate) fn all_failed() -> bool {
        let met = || {
            FAILING.with_borrow(|ranks| {
                ranks
                    .as_ref()
                    .is_none_or(|ranks| meet(ranks, Some(FAILURE_PATIENCE)))
            })
        };
        if !ALONE.get() && !met() {
            ALONE.set(true);
        }
        !ALONE.get()
    }

    /// Waits for all ranks to come here, not longer than the patience, if any; whether they came.
    fn meet(ranks: &SimpleCommunicator, patience: Option<Duration>) -> bool {
        let start = Instant::now();
        let mut barrier = ranks.immediate_barrier();
        loop {
            barrier = match barrier.test() {
                Ok(_) => return true,
                Err(pending) => pending,
            };
            if patience.is_some_and(|patience| start.elapsed() > patience) {
                // The barrier is never completed: the process ends with it.
                std::mem::forget(barrier);
                return false;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }

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
            let _ = RUNNING.set(());
            FAILING.set(Some(SimpleCommunicator::world().duplicate()));
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

        pub(super) fn finish(&self, success: bool) -> End {
            let patience = (!success).then_some(PATIENCE);
            match meet(&self.ending, patience) {
                true => End::Together,
                false => End::Alone,
            }
        }
    }

    impl Drop for Mpi {
        fn drop(&mut self) {
            // Before MPI ends, with the universe.
            FAILING.take();
        }
    }
}
