//! What launchers say of the tasks they start.

/// Task counts that launchers put into the environment of what they start: Open MPI's mpirun, MPICH's and its kin's
/// or Slurm's PMI, and srun. The count of a whole Slurm allocation is not among them, because a batch script, which
/// is one process, has it as well.
pub(crate) const TASK_COUNTS: [&str; 3] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"];

/// The variable that counts the tasks of this launch, and their number, from the environment, given as a function
/// from name to value. None without a launcher, or with one task. The innermost launcher decides: Slurm's step that
/// carries mpirun's daemons does not count.
pub(crate) fn tasks(value: impl Fn(&str) -> Option<String>) -> Option<(&'static str, usize)> {
    let count = |variable| {
        value(variable)?
            .trim()
            .parse()
            .ok()
            .map(|tasks| (variable, tasks))
    };
    TASK_COUNTS
        .into_iter()
        .find_map(count)
        .filter(|&(_, tasks)| tasks > 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn launch(environment: &[(&str, &str)]) -> Option<(&'static str, usize)> {
        tasks(|name| {
            environment
                .iter()
                .find(|(variable, _)| *variable == name)
                .map(|(_, value)| value.to_string())
        })
    }

    /// If this failed, several copies of one run would overwrite each other's results.
    #[test]
    fn a_launch_of_several_tasks_is_seen() {
        for variable in TASK_COUNTS {
            assert_eq!(launch(&[(variable, "4")]), Some((variable, 4)));
        }
    }

    /// If this failed, a plain run, a run of one task or a run inside a larger batch allocation would not start.
    #[test]
    fn one_task_may_run_wherever_it_is() {
        assert_eq!(launch(&[]), None);
        assert_eq!(launch(&[("PMI_SIZE", "1")]), None);
        assert_eq!(launch(&[("SLURM_NTASKS", "8"), ("SLURM_PROCID", "0")]), None);
        assert_eq!(
            launch(&[("SLURM_STEP_NUM_TASKS", "2"), ("OMPI_COMM_WORLD_SIZE", "1")]),
            None
        );
        assert_eq!(launch(&[("PMI_SIZE", "not a number")]), None);
    }
}
