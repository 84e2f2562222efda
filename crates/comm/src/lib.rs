//! The handful of message-passing operations of a run, for one process.
//!
//! A run is written as if it had several ranks: sums over ranks are taken in rank order, and ranks agree on success
//! before the next collective. With one process every operation is the identity, at no cost; what matters is
//! [`refuse_parallel_launch`], without which `mpirun -n 4` would start four runs that overwrite each other's files.

use std::ops::Range;

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
}

/// The ranks of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Communicator {
    /// One process: rank 0 of 1.
    #[default]
    Serial,
}

impl Communicator {
    /// Number of this rank, from 0.
    pub fn rank(self) -> usize {
        match self {
            Communicator::Serial => 0,
        }
    }

    /// Number of ranks.
    pub fn size(self) -> usize {
        match self {
            Communicator::Serial => 1,
        }
    }

    /// The ranks that the launcher has started.
    pub fn world() -> Communicator {
        Communicator::Serial
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
    pub fn all_gather(self, values: Vec<f64>, lengths: &[usize]) -> Vec<f64> {
        assert_eq!(
            values.len(),
            lengths[self.rank()],
            "numbers of rank {}",
            self.rank()
        );
        match self {
            Communicator::Serial => values,
        }
    }

    /// The result, if every rank has one. Otherwise an error on all: a rank's own, or what `elsewhere` makes of the lowest
    /// failed rank and its message. To be called before a collective, so that no rank waits for one that has given up.
    pub fn agree<T, E: std::fmt::Display>(
        self,
        result: Result<T, E>,
        _elsewhere: impl FnOnce(usize, String) -> E,
    ) -> Result<T, E> {
        match self {
            Communicator::Serial => result,
        }
    }
}

/// Equal runs of `n` units of work for each of `size` ranks, in order.
pub fn shares(n: usize, size: usize) -> Vec<Range<usize>> {
    (0..size).map(|r| r * n / size..(r + 1) * n / size).collect()
}

/// Task counts that launchers put into the environment of what they start: Open MPI's mpirun, MPICH's and its kin's
/// or Slurm's PMI, and srun. The count of a whole Slurm allocation is not among them, because a batch script, which
/// is one process, has it as well.
const TASK_COUNTS: [&str; 3] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"];

/// Refuses to run when a launcher has started more than one task of this program, as they could not talk to each
/// other. The innermost launcher decides: Slurm's step that carries mpirun's daemons does not count.
pub fn refuse_parallel_launch() -> Result<(), CommError> {
    check_launch(|name| std::env::var(name).ok())
}

/// Decides from the environment, given as a function from name to value.
fn check_launch(value: impl Fn(&str) -> Option<String>) -> Result<(), CommError> {
    let count = |variable| {
        value(variable)?
            .trim()
            .parse()
            .ok()
            .map(|tasks| (variable, tasks))
    };
    match TASK_COUNTS.into_iter().find_map(count) {
        Some((variable, tasks)) if tasks > 1 => Err(CommError::ParallelLaunch { variable, tasks }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn launch(environment: &[(&str, &str)]) -> Result<(), CommError> {
        check_launch(|name| {
            environment
                .iter()
                .find(|(variable, _)| *variable == name)
                .map(|(_, value)| value.to_string())
        })
    }

    /// If this failed, several copies of one run would overwrite each other's results.
    #[test]
    fn a_launch_of_several_tasks_is_refused_with_what_to_do() {
        for variable in TASK_COUNTS {
            let error = launch(&[(variable, "4")]).unwrap_err();
            assert_eq!(error, CommError::ParallelLaunch { variable, tasks: 4 });
            let text = error.to_string();
            assert!(
                text.starts_with(&format!("the launcher started 4 tasks ({variable}=4)")),
                "{text}"
            );
            assert!(
                text.ends_with("start one task (-n 1) and give it the cores as threads"),
                "{text}"
            );
        }
    }

    /// If this failed, a plain run, a run of one task or a run inside a larger batch allocation would not start.
    #[test]
    fn one_task_may_run_wherever_it_is() {
        assert_eq!(launch(&[]), Ok(()));
        assert_eq!(launch(&[("PMI_SIZE", "1")]), Ok(()));
        assert_eq!(launch(&[("SLURM_NTASKS", "8"), ("SLURM_PROCID", "0")]), Ok(()));
        assert_eq!(
            launch(&[("SLURM_STEP_NUM_TASKS", "2"), ("OMPI_COMM_WORLD_SIZE", "1")]),
            Ok(())
        );
        assert_eq!(launch(&[("PMI_SIZE", "not a number")]), Ok(()));
    }

    /// Wrong: a run of one process would compute something else than its sums say.
    #[test]
    fn collectives_of_one_rank_are_the_identity() {
        let comm = Communicator::Serial;
        assert_eq!(comm.all_gather(vec![1.5, -0.0], &[2]), [1.5, -0.0]);
        let elsewhere = |_, _| unreachable!("there is no other rank");
        assert_eq!(comm.agree(Err::<(), _>("no memory"), elsewhere), Err("no memory"));
        assert_eq!(comm.agree(Ok::<_, &str>(7), elsewhere), Ok(7));
        assert_eq!((comm.rank(), comm.size(), comm.share(5)), (0, 1, 0..5));
    }
}
