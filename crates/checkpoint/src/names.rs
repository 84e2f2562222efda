//! Names of the files of a result folder, and of the groups of steps in packs.

/// The file that shows all steps of a run.
pub const INDEX_FILE: &str = "run.vtkhdf";
/// The file that lists the step files and their times.
pub const SERIES_FILE: &str = "run.hdf.series";

/// File name of a step: `step_000042.hdf`; more than six digits when needed.
pub fn step_file_name(step: u64) -> String {
    format!("step_{step:06}.hdf")
}

/// The number in a step's file name; names this crate would not write are not steps.
pub(crate) fn step_number(name: &str) -> Option<u64> {
    let step = name.strip_prefix("step_")?.strip_suffix(".hdf")?.parse().ok()?;
    (step_file_name(step) == name).then_some(step)
}

/// The group of a step in a pack.
pub(crate) fn group_name(step: u64) -> String {
    format!("step_{step:06}")
}

/// File name of a pack by its first and last step.
pub(crate) fn pack_name(first: u64, last: u64) -> String {
    format!("pack_{first:06}_{last:06}.hdf")
}

/// First and last step in the name of a pack.
pub(crate) fn pack_range(name: &str) -> Option<(u64, u64)> {
    let (first, last) = name
        .strip_prefix("pack_")?
        .strip_suffix(".hdf")?
        .split_once('_')?;
    let range = (first.parse().ok()?, last.parse().ok()?);
    (pack_name(range.0, range.1) == name).then_some(range)
}
