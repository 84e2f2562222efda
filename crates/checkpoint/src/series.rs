//! The file `run.hdf.series`: names and times of the steps, the form in which ParaView opens a run since 5.11.

use std::path::Path;

use crate::atomic;
use crate::error::CheckpointError;
use crate::names::{SERIES_FILE, step_file_name};

/// Replaces the series file by one that lists `steps`: number and time, s, of each.
pub(crate) fn write_series(dir: &Path, steps: &[(u64, f64)]) -> Result<(), CheckpointError> {
    atomic::write_text(dir, SERIES_FILE, &series_text(steps))
}

/// Rust prints the shortest decimal number that reads back as the same f64, which is valid JSON when finite.
fn series_text(steps: &[(u64, f64)]) -> String {
    let entry = |&(step, time): &(u64, f64)| {
        format!(
            "    {{\"name\": \"{}\", \"time\": {time:?}}}",
            step_file_name(step)
        )
    };
    let entries: Vec<String> = steps.iter().map(entry).collect();
    format!(
        "{{\n  \"file-series-version\": \"1.0\",\n  \"files\": [\n{}\n  ]\n}}\n",
        entries.join(",\n")
    )
}
