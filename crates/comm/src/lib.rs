//! The handful of message-passing operations of a run, for one process.
//!
//! A run is written as if it had several ranks: sums over ranks are taken in rank order, and ranks agree on success
//! before the next collective. With one process every operation is the identity, at no cost; what matters is
//! [`refuse_parallel_launch`], without which `mpirun -n 4` would start four runs that overwrite each other's files.

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

/// One process: rank 0 of 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Serial;

impl Serial {
    /// Number of this rank, from 0.
    pub fn rank(self) -> usize {
        0
    }

    /// Number of ranks.
    pub fn size(self) -> usize {
        1
    }

    /// Replaces `values`, `[n]`, by their sums over the ranks, added in rank order.
    pub fn all_reduce_sum(self, _values: &mut [f64]) {}

    /// Replaces `values`, `[n]`, by their maxima over the ranks.
    pub fn all_reduce_max(self, _values: &mut [f64]) {}

    /// Replaces `bytes` on every rank by those of rank `root`.
    ///
    /// # Panics
    /// When there is no such rank.
    pub fn broadcast_bytes(self, _bytes: &mut Vec<u8>, root: usize) {
        self.check_rank(root);
    }

    /// The `bytes` of all ranks in rank order, on rank `root`; nothing on the others.
    ///
    /// # Panics
    /// When there is no such rank.
    pub fn gather_bytes(self, bytes: &[u8], root: usize) -> Option<Vec<Vec<u8>>> {
        self.check_rank(root);
        Some(vec![bytes.to_vec()])
    }

    /// Returns when every rank has called it.
    pub fn barrier(self) {}

    /// The result, if every rank has one; otherwise the error of the lowest rank that has none. To be called before a
    /// collective, so that no rank waits for one that has given up.
    pub fn agree<T, E>(self, result: Result<T, E>) -> Result<T, E> {
        result
    }

    fn check_rank(self, root: usize) {
        assert!(
            root < self.size(),
            "rank {root} of {} does not exist",
            self.size()
        );
    }
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

    /// If this failed, the same program would compute something else with one rank than its sums say.
    #[test]
    fn collectives_of_one_rank_are_the_identity() {
        let comm = Serial;
        let mut values = [1.5, -0.0, f64::MAX];
        comm.all_reduce_sum(&mut values);
        comm.all_reduce_max(&mut values);
        assert_eq!(values.map(f64::to_bits), [1.5, -0.0, f64::MAX].map(f64::to_bits));
        let mut bytes = vec![1, 2, 3];
        comm.broadcast_bytes(&mut bytes, 0);
        assert_eq!(comm.gather_bytes(&bytes, 0), Some(vec![vec![1, 2, 3]]));
        comm.barrier();
        assert_eq!(comm.agree(Err::<(), _>("no memory")), Err("no memory"));
        assert_eq!(comm.agree(Ok::<_, ()>(7)), Ok(7));
        assert_eq!((comm.rank(), comm.size()), (0, 1));
    }

    /// If this failed, a wrong root would pass with one rank and hang with several.
    #[test]
    #[should_panic(expected = "rank 1 of 1 does not exist")]
    fn a_root_that_does_not_exist_is_a_program_error() {
        Serial.broadcast_bytes(&mut Vec::new(), 1);
    }
}
