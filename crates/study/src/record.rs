//! `point.json`: what became of one point of a study, beside the results of its run.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use results::about::{SOURCE_COMMIT, checksum_text};
use results::whole;
use scene::{MeshFiles, Scene, named_files};
use serde::{Deserialize, Serialize};

use super::plan::{Plan, Point, arguments};

/// Name of the file in the folder of a point.
const FILE: &str = "point.json";
/// Folder of the results in the folder of a point.
pub const RUN: &str = "run";
/// What the program printed.
pub const LOG: &str = "log.txt";

/// A point that was run, to its end or not.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
pub struct Record {
    /// Its number.
    pub index: usize,
    /// Its values, in words.
    pub name: String,
    /// Its `--set` arguments; `{out}` stands for the folder of the study.
    pub set: Vec<String>,
    /// Text of the scene before the arguments.
    pub scene: String,
    /// Length and checksum of the files that the scene names, by its keys.
    #[serde(default)]
    pub files: BTreeMap<String, String>,
    /// Threads of the run.
    pub threads: usize,
    /// Version and commit of the program.
    pub program: String,
    /// Why there are no results; `None` when there are.
    pub failure: Option<String>,
    /// Costs of every repeat; empty when it failed.
    pub costs: Vec<Cost>,
}

/// What one run cost.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
pub struct Cost {
    /// From start to end, s.
    pub wall_s: f64,
    /// Work of all processors, s.
    pub cpu_s: f64,
    /// Largest resident memory, bytes.
    pub peak_memory_bytes: u64,
    /// Size of all files of the results, bytes.
    pub bytes_written: u64,
    /// Why the times are not its own, if so.
    pub disturbed: Option<String>,
}

/// Folder of a point.
pub fn folder(out: &Path, index: usize) -> PathBuf {
    out.join("points").join(format!("{index:04}"))
}

/// Version and commit of this program.
pub fn program() -> String {
    format!("{} {}", env!("CARGO_PKG_VERSION"), SOURCE_COMMIT)
}

/// The record of a point; `None` when it was not run, or not to an end. A record of another scene or of other
/// settings is an error.
pub fn find(plan: &Plan, point: &Point, out: &Path) -> anyhow::Result<Option<Record>> {
    let dir = folder(out, point.index);
    let path = dir.join(FILE);
    if !path.exists() {
        return Ok(None);
    }
    let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let record: Record = serde_json::from_str(&text).with_context(|| {
        format!(
            "{} is no record of a point; remove its folder to run it again",
            path.display()
        )
    })?;
    let changed = [
        ("other settings", record.set != point.set),
        (
            "another text of the scene",
            record.scene != plan.whole_scene(&point.set)?,
        ),
        ("another number of threads", record.threads != plan.threads),
    ];
    let now = files(plan, &arguments(&point.set, out))?;
    let file = now
        .iter()
        .find(|(key, file)| record.files.get(*key).is_some_and(|old| old != *file));
    let file = file.map(|(key, _)| format!("other contents of the file of {key}"));
    let what = changed
        .iter()
        .find(|(_, is)| *is)
        .map(|(what, _)| what.to_string());
    if let Some(what) = what.or(file) {
        bail!(
            "{} was run with {what} than {} asks for now; choose another --out, or remove that folder to run the point \
             again",
            dir.display(),
            plan.path.display()
        );
    }
    Ok(Some(record))
}

/// Length and checksum of the files that the scene names with these arguments, by its keys.
pub fn files(plan: &Plan, set: &[String]) -> anyhow::Result<BTreeMap<String, String>> {
    let scene = Scene::parse(&plan.scene_text, &plan.scene, set, MeshFiles::MayBeMissing)?;
    let named = named_files(&scene)?.into_iter();
    named
        .map(|(key, path)| Ok((key, checksum_text(&path)?)))
        .collect()
}

/// Writes a record: complete or not at all.
pub fn write(record: &Record, out: &Path) -> anyhow::Result<()> {
    write_whole(&folder(out, record.index).join(FILE), &to_json(record)?)
}

/// JSON as all files of a study have it.
pub fn to_json(value: &impl Serialize) -> anyhow::Result<String> {
    Ok(serde_json::to_string_pretty(value).context("cannot format JSON")? + "\n")
}

/// Writes a text file of a study: complete or not at all, and only over one that a study wrote.
pub fn write_whole(path: &Path, text: &str) -> anyhow::Result<()> {
    // Pages say who made them; tables and JSON begin with the same key.
    let start = &text.as_bytes()[..text.len().min(KEY)];
    whole::write(path, text.as_bytes(), |old| {
        whole::holds(old, "Made by `raceway ") || old.starts_with(start)
    })
}

/// Bytes that hold the first key of a file.
const KEY: usize = 12;
