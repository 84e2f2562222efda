//! What the page takes from `summary.json` and from the scene in the step files.

use std::path::Path;

use anyhow::Context;
use checkpoint::{all_steps, open_regular, read_about, read_any_step, step_file_name};
use comm::print::counted;
use results::about::COMMIT;
use results::failure::Failure;
use results::integrity::doubts;
use results::list_folder::not_ended;
use results::summary::{SUMMARY_FILE, other_version, require_known_summary};
use serde_json::Value;

/// The run.
pub struct ReportedRun {
    /// `summary.json`.
    pub summary: Value,
    /// What is wrong with the tables.
    pub doubts: Vec<String>,
    /// Text of the scene with its overrides; none if no step was kept.
    pub scene: Option<String>,
    /// Commit of the source of the program; empty if no step file has it.
    pub commit: String,
    /// When the run ended, UTC; empty if the system does not tell.
    pub ended: String,
    /// Name and size of the files of the run, bytes.
    pub files: Vec<(String, u64)>,
}

/// Reads the run in `dir`, which must have ended: its summary is what the page is about.
pub fn read(dir: &Path) -> Result<ReportedRun, Failure> {
    let path = dir.join(SUMMARY_FILE);
    if !path.exists() {
        return Err(not_ended(dir));
    }
    let file = open_regular(&path)?;
    let text = std::io::read_to_string(file).with_context(|| format!("cannot read {}", path.display()))?;
    let summary = serde_json::from_str(&text).with_context(|| format!("{} is damaged", path.display()))?;
    require_known_summary(dir)?;
    let (scene, commit) = match all_steps(dir)?.last() {
        Some(&step) => {
            let record = read_any_step(dir, step)?;
            // A step in a pack has no file of its own.
            let about = read_about(&dir.join(step_file_name(step))).unwrap_or_default();
            let commit = about.get(COMMIT).cloned().unwrap_or_default();
            (Some(record.scene), commit)
        }
        None => (None, String::new()),
    };
    Ok(ReportedRun {
        summary,
        doubts: doubts(dir)?.into_iter().chain(other_version(dir)).collect(),
        scene,
        commit,
        ended: ended(&path),
        files: files(dir)?,
    })
}

/// When a file was written, such as `2026-11-23 09:15`.
fn ended(path: &Path) -> String {
    let time = std::fs::metadata(path).and_then(|data| data.modified()).ok();
    let time = time.and_then(|time| jiff::Timestamp::try_from(time).ok());
    time.map_or(String::new(), |time| {
        time.to_zoned(jiff::tz::TimeZone::UTC)
            .strftime("%Y-%m-%d %H:%M UTC")
            .to_string()
    })
}

/// Files of the folder in the order of their names; steps are added up.
fn files(dir: &Path) -> anyhow::Result<Vec<(String, u64)>> {
    let cannot = || format!("cannot read folder {}", dir.display());
    let (mut files, mut steps, mut step_bytes) = (Vec::new(), 0, 0);
    for entry in std::fs::read_dir(dir).with_context(cannot)? {
        let entry = entry.with_context(cannot)?;
        let (name, data) = (
            entry.file_name().to_string_lossy().into_owned(),
            entry.metadata()?,
        );
        if !data.is_file() || name.starts_with('.') || name.ends_with(".html") {
            continue;
        }
        if name.starts_with("step_") {
            (steps, step_bytes) = (steps + 1, step_bytes + data.len());
        } else {
            files.push((name, data.len()));
        }
    }
    files.sort();
    if steps > 0 {
        files.push((counted(steps, "step file"), step_bytes));
    }
    Ok(files)
}
