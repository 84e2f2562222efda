//! Whether the tables of a run are still what it wrote: each step file holds length and checksum of every
//! table up to its step.

use std::path::Path;

use checkpoint::{
    FileStamp, Stamps, committed_steps, has_state, read_stamps, require_run, run_of, start_of, step_file_name,
};
use comm::print;

use crate::summary::{SUMMARY_FILE, other_version, read_summary, require_known_summary};

/// What is wrong with tables and summary in `dir`, a sentence each; nothing if they are as written, or if no
/// step tells of them. Fails if the summary is none that this program knows.
pub fn doubts(dir: &Path) -> anyhow::Result<Vec<String>> {
    require_known_summary(dir)?;
    let run = run_of(dir)?;
    let mut doubts = doubt_of_summary(dir, run.as_deref());
    for &step in committed_steps(dir)?.iter().rev() {
        // A step that is damaged or of another run says nothing; an older one may.
        let path = dir.join(step_file_name(step));
        let stamps = require_run(&path, run.as_deref()).and_then(|()| read_stamps(&path));
        if let Ok(stamps) = stamps {
            let more = stamps.map_or(Ok(Vec::new()), |stamps| doubts_at(dir, step, &stamps));
            doubts.extend(more?);
            break;
        }
    }
    Ok(doubts)
}

/// A summary that was copied from elsewhere.
fn doubt_of_summary(dir: &Path, run: Option<&str>) -> Vec<String> {
    let found = read_summary(dir).and_then(|summary| Some(summary["run"].as_str()?.to_string()));
    let other = found.zip(run).filter(|(found, run)| found != run);
    let text = |(found, run): (String, &str)| {
        let path = dir.join(SUMMARY_FILE);
        format!(
            "{} is of another run, {found}; the run in its folder is {run}",
            path.display()
        )
    };
    other.map(text).into_iter().collect()
}

/// Prints what is wrong with the tables in `dir`, and whether another version of the program wrote them.
pub fn warn_of_doubts(dir: &Path) -> anyhow::Result<()> {
    for doubt in doubts(dir)?.into_iter().chain(other_version(dir)) {
        print::note(format_args!("warning: {doubt}"));
    }
    Ok(())
}

fn doubts_at(dir: &Path, step: u64, stamps: &Stamps) -> anyhow::Result<Vec<String>> {
    let is_finished = read_summary(dir).is_some_and(|summary| summary["status"] == "finished");
    let mut doubts = Vec::new();
    for (name, stamp) in stamps {
        let path = dir.join(name);
        let found = start_of(&path, stamp.length);
        let text = match found {
            Err(error) => Some(error.to_string()),
            Ok(_) => doubt(&path, *stamp, step)?,
        };
        let length = std::fs::metadata(&path).map_or(0, |data| data.len());
        let more = length.saturating_sub(stamp.length);
        let added = || format!("{} has {more} bytes more than the run wrote", path.display());
        doubts.extend(text.or_else(|| (is_finished && more > 0).then(added)));
    }
    Ok(doubts)
}

/// How a table differs from what the file of `step` tells of it; None if it does not.
pub fn doubt(path: &Path, stamp: FileStamp, step: u64) -> anyhow::Result<Option<String>> {
    let (found, file) = (start_of(path, stamp.length)?, step_file_name(step));
    if found == stamp {
        return Ok(None);
    }
    let path = path.display();
    Ok(Some(match found.length < stamp.length {
        true => format!(
            "{path} is not as the run wrote it: it has {} bytes, {file} tells of {}",
            found.length, stamp.length
        ),
        false => format!(
            "{path} is not as the run wrote it: its first {} bytes have the checksum {:08x}, {file} says {:08x}",
            stamp.length, found.crc, stamp.crc
        ),
    }))
}

/// The newest step before `step` that a run can go on from and of which all tables are as written. What a table lost
/// at one step it lacks at all later ones.
pub fn newest_agreeing(dir: &Path, step: u64) -> Option<u64> {
    let mut steps = committed_steps(dir).ok()?;
    steps.retain(|&n| n < step);
    let agrees = |&n: &u64| {
        let stamps = read_stamps(&dir.join(step_file_name(n)));
        let fits = |(name, stamp): (&String, &FileStamp)| {
            start_of(&dir.join(name), stamp.length).is_ok_and(|s| s == *stamp)
        };
        stamps.is_ok_and(|stamps| stamps.is_some_and(|stamps| stamps.iter().all(fits)))
    };
    let n = steps.partition_point(agrees);
    let has_state = |n: &&u64| has_state(&dir.join(step_file_name(**n))).unwrap_or(false);
    steps[..n].iter().rev().find(has_state).copied()
}
