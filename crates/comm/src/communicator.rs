//! The ranks and what they exchange.

use std::ops::Range;

use crate::failing;

/// Set once MPI runs: the library itself is one per process.
#[cfg(feature = "mpi")]
static RUNNING: std::sync::OnceLock<()> = std::sync::OnceLock::new();

/// From now on the ranks are those of MPI.
#[cfg(feature = "mpi")]
pub(crate) fn note_running() {
    let _ = RUNNING.set(());
}

/// The ranks of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Communicator {
    /// One process: rank 0 of 1.
    #[default]
    Serial,
    /// The ranks of an MPI launcher.
    #[cfg(feature = "mpi")]
    Mpi,
}

impl Communicator {
    /// The ranks that the launcher has started, once [`crate::Environment::start`] has been called; one before.
    pub fn world() -> Communicator {
        #[cfg(feature = "mpi")]
        if RUNNING.get().is_some() {
            return Communicator::Mpi;
        }
        Communicator::Serial
    }

    /// Number of this rank, from 0.
    pub fn rank(self) -> usize {
        match self {
            Communicator::Serial => 0,
            #[cfg(feature = "mpi")]
            Communicator::Mpi => crate::messages::rank(),
        }
    }

    /// Number of ranks.
    pub fn size(self) -> usize {
        match self {
            Communicator::Serial => 1,
            #[cfg(feature = "mpi")]
            Communicator::Mpi => crate::messages::size(),
        }
    }

    /// Whether this is the rank that writes files and speaks to the user.
    pub fn is_root(self) -> bool {
        self.rank() == 0
    }

    /// Units of work of each rank when `n` of them are dealt out.
    pub fn shares(self, n: usize) -> Vec<Range<usize>> {
        shares(n, self.size())
    }

    /// Units of work of this rank.
    pub fn share(self, n: usize) -> Range<usize> {
        self.shares(n)[self.rank()].clone()
    }

    /// The `values` of all ranks, one after the other in rank order; rank r has `lengths[r]` of them.
    ///
    /// # Panics
    /// When `values` has another length than was announced.
    #[track_caller]
    pub fn all_gather(self, values: Vec<f64>, lengths: &[usize]) -> Vec<f64> {
        assert_eq!(
            values.len(),
            lengths[self.rank()],
            "numbers of rank {}",
            self.rank()
        );
        match self {
            Communicator::Serial => values,
            #[cfg(feature = "mpi")]
            Communicator::Mpi => {
                let fault = self.fault("all_gather");
                spoiled(crate::messages::all_gather(&values, lengths), fault)
            }
        }
    }

    /// Sends `sent[r]` to each rank r. Returns what the ranks have sent to this one, in rank order; rank r sends
    /// `lengths[r]` numbers.
    ///
    /// # Panics
    /// When there is not one message per rank, or that of a single rank to itself has another length than was
    /// announced.
    #[track_caller]
    pub fn exchange(self, sent: Vec<Vec<f64>>, lengths: &[usize]) -> Vec<f64> {
        assert_eq!(
            [sent.len(), lengths.len()],
            [self.size(); 2],
            "one message per rank"
        );
        assert_eq!(
            sent[self.rank()].len(),
            lengths[self.rank()],
            "numbers of rank {} to itself",
            self.rank()
        );
        match self {
            Communicator::Serial => sent.concat(),
            #[cfg(feature = "mpi")]
            Communicator::Mpi => {
                let fault = self.fault("exchange");
                spoiled(crate::messages::exchange(&sent, lengths), fault)
            }
        }
    }

    /// The `length` numbers of rank `from`, on rank 0; None on all others. `values` of ranks other than `from` do not
    /// matter.
    ///
    /// # Panics
    /// When the values of `from` have another length than was announced.
    #[track_caller]
    pub fn to_root(self, from: usize, values: Vec<f64>, length: usize) -> Option<Vec<f64>> {
        if self.rank() == from {
            assert_eq!(values.len(), length, "numbers of rank {from}");
        }
        match self {
            Communicator::Serial => Some(values),
            #[cfg(feature = "mpi")]
            Communicator::Mpi => {
                self.fault("to_root");
                crate::messages::to_root(from, values, length)
            }
        }
    }

    /// The bytes of rank 0, on all ranks; those of the others do not matter.
    #[track_caller]
    pub fn from_root(self, bytes: Vec<u8>) -> Vec<u8> {
        match self {
            Communicator::Serial => bytes,
            #[cfg(feature = "mpi")]
            Communicator::Mpi => {
                self.fault("from_root");
                crate::messages::from_root(bytes)
            }
        }
    }

    /// The bytes that rank 0 makes for this rank; only there, `of` is called, for one rank after the other, so that
    /// one message is in memory at a time. Its own is empty: what it would send itself, it has.
    #[track_caller]
    pub fn deal(self, of: impl FnMut(usize) -> Vec<u8>) -> Vec<u8> {
        match self {
            Communicator::Serial => {
                drop(of);
                Vec::new()
            }
            #[cfg(feature = "mpi")]
            Communicator::Mpi => {
                self.fault("deal");
                crate::messages::deal(of)
            }
        }
    }

    /// The result, if every rank has one. Otherwise an error on all: a rank's own, or what `elsewhere` makes of the
    /// lowest failed rank and its message. To be called before a collective, so that no rank waits for one that has
    /// given up.
    #[track_caller]
    pub fn agree<T, E: std::fmt::Display>(
        self,
        result: Result<T, E>,
        elsewhere: impl FnOnce(usize, String) -> E,
    ) -> Result<T, E> {
        match self {
            Communicator::Serial => {
                drop(elsewhere);
                result
            }
            #[cfg(feature = "mpi")]
            Communicator::Mpi => {
                let injected = self.fault("agree").is_some();
                let injected = injected.then(|| "an injected failure".to_string());
                let message = result.as_ref().err().map(E::to_string);
                let Some(first) = crate::messages::first_failure(message.or(injected)) else {
                    return result;
                };
                if !first.of_all && result.is_err() {
                    failing::note_own_failure();
                }
                Err(result.err().unwrap_or_else(|| elsewhere(first.rank, first.text)))
            }
        }
    }

    /// The lowest rank that gives a text, and that text, on all ranks.
    #[track_caller]
    pub fn first_text(self, text: Option<String>) -> Option<(usize, String)> {
        match self {
            Communicator::Serial => text.map(|text| (0, text)),
            #[cfg(feature = "mpi")]
            Communicator::Mpi => {
                self.fault("first_text");
                crate::messages::first_failure(text).map(|first| (first.rank, first.text))
            }
        }
    }

    /// Whether all ranks call this within some seconds. To be called by a rank whose computation has failed, before it
    /// exchanges anything more: all ranks compute the same and fail together, unless the numbers of one are wrong.
    pub fn all_failed(self) -> bool {
        match self {
            Communicator::Serial => true,
            #[cfg(feature = "mpi")]
            Communicator::Mpi => failing::all_failed(),
        }
    }

    /// Whether an agreement has failed by this rank and not by all: then its message has to name the rank.
    pub fn has_failed_alone(self) -> bool {
        failing::has_failed_alone()
    }

    /// Ends all ranks at once with an exit code.
    pub fn abort(self, code: u8) -> ! {
        #[cfg(feature = "mpi")]
        if self == Communicator::Mpi {
            crate::messages::abort(i32::from(code));
        }
        std::process::exit(i32::from(code))
    }

    /// The fault asked for at this message of the caller's caller; always None in a program for users.
    #[cfg(feature = "mpi")]
    #[cfg_attr(feature = "inject", track_caller)]
    fn fault(self, operation: &str) -> Option<&'static str> {
        #[cfg(feature = "inject")]
        return crate::inject::before(operation, self.rank(), std::panic::Location::caller());
        #[cfg(not(feature = "inject"))]
        {
            let _ = operation;
            None
        }
    }
}

/// Numbers, or none when a fault was asked for.
#[cfg(feature = "mpi")]
fn spoiled(mut numbers: Vec<f64>, fault: Option<&str>) -> Vec<f64> {
    if fault.is_some() {
        numbers.fill(f64::NAN);
    }
    numbers
}

/// Equal runs of `n` units of work for each of `size` ranks, in order.
pub fn shares(n: usize, size: usize) -> Vec<Range<usize>> {
    (0..size).map(|r| r * n / size..(r + 1) * n / size).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a run of one process would compute something else than its sums say.
    #[test]
    fn collectives_of_one_rank_are_the_identity() {
        let comm = Communicator::Serial;
        assert_eq!(comm.all_gather(vec![1.5, -0.0], &[2]), [1.5, -0.0]);
        assert_eq!(comm.exchange(vec![vec![2.5, 3.0]], &[2]), [2.5, 3.0]);
        assert_eq!(comm.to_root(0, vec![0.5, 7.0], 2), Some(vec![0.5, 7.0]));
        assert!(
            comm.deal(|rank| unreachable!("rank {rank} has what it has"))
                .is_empty()
        );
        let elsewhere = |_, _| unreachable!("there is no other rank");
        assert_eq!(comm.agree(Err::<(), _>("no memory"), elsewhere), Err("no memory"));
        assert_eq!(comm.agree(Ok::<_, &str>(7), elsewhere), Ok(7));
        assert_eq!((comm.rank(), comm.size(), comm.share(5)), (0, 1, 0..5));
    }

    /// Wrong: a unit of work would be done twice or by nobody, or one rank would do most of it.
    #[test]
    fn work_is_dealt_out_in_equal_runs() {
        for (n, size) in [(8, 3), (3, 8), (16, 4), (0, 2), (1, 1)] {
            let all: Vec<usize> = shares(n, size).into_iter().flatten().collect();
            assert!(all.iter().copied().eq(0..n), "{all:?}");
            let lengths: Vec<usize> = shares(n, size).iter().map(Range::len).collect();
            assert!(lengths.iter().max().unwrap() - lengths.iter().min().unwrap() <= 1);
        }
    }
}
