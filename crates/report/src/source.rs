//! What the page takes from `summary.json` and from the scene in the step files.

use std::path::Path;

use anyhow::{Context, anyhow};
use checkpoint::{all_steps, open_regular, read_any_step};
use results::failure::Failure;
use results::integrity::doubts;
use results::summary::SUMMARY_FILE;
use serde_json::Value;

/// The run.
pub struct Source {
    /// `summary.json`.
    pub summary: Value,
    /// What is wrong with the tables.
    pub doubts: Vec<String>,
    /// Text of the scene with its overrides; none if no step was kept.
    pub scene: Option<String>,
    /// Name and size of the files of the run, bytes.
    pub files: Vec<(String, u64)>,
}

/// Reads the run in `dir`, which must have ended: its summary is what the page is about.
pub fn read(dir: &Path) -> Result<Source, Failure> {
    let path = dir.join(SUMMARY_FILE);
    if !path.exists() {
        return Err(anyhow!(
            "{} has no {SUMMARY_FILE}; expected the results of a run that has ended",
            dir.display()
        )
        .into());
    }
    let file = open_regular(&path)?;
    let text = std::io::read_to_string(file).with_context(|| format!("cannot read {}", path.display()))?;
    let summary = serde_json::from_str(&text).with_context(|| format!("{} is damaged", path.display()))?;
    let scene = match all_steps(dir)?.last() {
        Some(&step) => Some(read_any_step(dir, step)?.scene),
        None => None,
    };
    Ok(Source {
        summary,
        doubts: doubts(dir)?,
        scene,
        files: files(dir)?,
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
        files.push((format!("{steps} step files"), step_bytes));
    }
    Ok(files)
}
