//! How ranks that fail learn of each other: who has failed alone, and where those that have failed meet.

#[cfg(feature = "mpi")]
pub(crate) use parallel::{all_failed, forget, meet, prepare};

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// How long a rank that has failed waits for the others to fail as well before it ends them.
pub const PATIENCE: Duration = Duration::from_secs(2);

/// How long a rank whose computation has failed waits for those of the others to fail as well. Longer than
/// [`PATIENCE`], because ranks that go on compute until they fail.
pub const FAILURE_PATIENCE: Duration = Duration::from_secs(10);

/// Whether an agreement has failed by this rank and not by all.
static OWN_FAILURE: AtomicBool = AtomicBool::new(false);

#[cfg(feature = "mpi")]
pub(crate) fn note_own_failure() {
    OWN_FAILURE.store(true, Ordering::Relaxed);
}

pub(crate) fn has_failed_alone() -> bool {
    OWN_FAILURE.load(Ordering::Relaxed)
}

#[cfg(feature = "mpi")]
mod parallel {
    use std::cell::{Cell, RefCell};
    use std::time::{Duration, Instant};

    use mpi::collective::CommunicatorCollectives;
    use mpi::topology::SimpleCommunicator;

    use super::FAILURE_PATIENCE;

    thread_local! {
        /// A set of the same ranks on which those meet that have failed; of the main thread, which sends all messages.
        static FAILING: RefCell<Option<SimpleCommunicator>> = const { RefCell::new(None) };
        /// Whether this rank has waited for the others to fail in vain.
        static ALONE: Cell<bool> = const { Cell::new(false) };
    }

    /// Gives those that will have failed a set of the ranks to meet on.
    pub(crate) fn prepare(ranks: SimpleCommunicator) {
        FAILING.set(Some(ranks));
    }

    /// Drops that set, before MPI ends.
    pub(crate) fn forget() {
        FAILING.take();
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
    pub(crate) fn meet(ranks: &SimpleCommunicator, patience: Option<Duration>) -> bool {
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
}
