//! The result folder of one run: created, filled step by step, resumed.
//!
//! A step is committed when its file has its final name; the file is complete and on the disk by then. A run
//! killed at any instant loses at most the step it was writing. Committed steps are never rewritten: a run that
//! resumes from an earlier step moves the later ones into a folder `superseded_N` beside them.

use std::fs;
use std::path::{Path, PathBuf};

use crate::atomic;
use crate::body::Body;
use crate::error::CheckpointError;
use crate::grid::Grid;
use crate::index::{INDEX_FILE, rebuild_index};
use crate::mesh_file::{MESH_FILE, require_same_mesh, write_mesh};
use crate::record::StepRecord;
use crate::series::{SERIES_FILE, write_series};
use crate::step::{read_step_time, write_step_file};
use crate::storage::Storage;

/// A result folder open for writing. One process writes to a folder at a time.
#[derive(Debug)]
pub struct Output {
    dir: PathBuf,
    storage: Storage,
    n_points: usize,
    mesh_hash: String,
    /// Number and time, s, of the committed steps, growing.
    steps: Vec<(u64, f64)>,
}

impl Output {
    /// Creates the folder `dir` (and its parents) and writes the mesh. A folder that already holds results is
    /// refused; other files in it do not matter.
    pub fn create(dir: &Path, bodies: &[Body], storage: Storage) -> Result<Output, CheckpointError> {
        let grid = Grid::join(bodies)?;
        fs::create_dir_all(dir).map_err(CheckpointError::io("create folder", dir))?;
        require_no_results(dir)?;
        write_mesh(dir, &grid)?;
        Ok(Output::new(dir, &grid, storage, Vec::new()))
    }

    /// Opens the folder of an earlier run of the same bodies to continue after its committed step `last`. Later
    /// steps are moved aside, leftovers of an interrupted write are removed. Only names and times of the steps are
    /// read here: read the step to continue from with [`crate::read_step`] first, which verifies it.
    pub fn resume(
        dir: &Path,
        bodies: &[Body],
        storage: Storage,
        last: u64,
    ) -> Result<Output, CheckpointError> {
        let grid = Grid::join(bodies)?;
        let mut steps = committed_steps(dir)?;
        let (Some(&first), Some(&newest)) = (steps.first(), steps.last()) else {
            return Err(CheckpointError::NoSteps {
                path: dir.to_path_buf(),
            });
        };
        if !steps.contains(&last) {
            let path = dir.to_path_buf();
            return Err(CheckpointError::UnknownStep {
                path,
                step: last,
                first,
                last: newest,
            });
        }
        require_same_mesh(dir, &grid)?;
        let superseded = steps.split_off(steps.partition_point(|&step| step <= last));
        let steps = read_times(dir, &steps)?;
        remove_leftovers(dir)?;
        // The views first: a view may for a moment list too little, never what is not there.
        write_series(dir, &steps)?;
        remove_if_present(&dir.join(INDEX_FILE))?;
        move_aside(dir, &superseded)?;
        Ok(Output::new(dir, &grid, storage, steps))
    }

    fn new(dir: &Path, grid: &Grid, storage: Storage, steps: Vec<(u64, f64)>) -> Output {
        let (n_points, mesh_hash) = (grid.points.len(), grid.fingerprint());
        Output {
            dir: dir.to_path_buf(),
            storage,
            n_points,
            mesh_hash,
            steps,
        }
    }

    /// Writes one step and returns the path of its file. When this returns, the step survives a crash. Steps and
    /// times must grow.
    pub fn write_step(&mut self, record: &StepRecord) -> Result<PathBuf, CheckpointError> {
        record.validate(self.n_points)?;
        if let Some(&(last, last_time)) = self.steps.last()
            && (record.step <= last || record.time <= last_time)
        {
            let (step, time) = (record.step, record.time);
            return Err(CheckpointError::StepOrder {
                step,
                time,
                last,
                last_time,
            });
        }
        let name = step_file_name(record.step);
        write_step_file(&self.dir, &name, record, &self.mesh_hash, self.storage)?;
        self.steps.push((record.step, record.time));
        write_series(&self.dir, &self.steps)?;
        Ok(self.dir.join(name))
    }

    /// Builds the temporal index over all committed steps. A run without steps needs none.
    pub fn finish(self) -> Result<(), CheckpointError> {
        if self.steps.is_empty() {
            return Ok(());
        }
        rebuild_index(&self.dir).map(|_| ())
    }

    /// The result folder.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Points of all bodies together; every field has this many rows.
    pub fn n_points(&self) -> usize {
        self.n_points
    }

    /// Fingerprint of the mesh, as stored in every step.
    pub fn mesh_hash(&self) -> &str {
        &self.mesh_hash
    }

    /// Number and time, s, of the last committed step.
    pub fn last_step(&self) -> Option<(u64, f64)> {
        self.steps.last().copied()
    }
}

/// File name of a step: `step_000042.hdf`; more than six digits when needed.
pub fn step_file_name(step: u64) -> String {
    format!("step_{step:06}.hdf")
}

/// Numbers of the committed steps in a folder, growing. Only names are looked at.
pub fn committed_steps(dir: &Path) -> Result<Vec<u64>, CheckpointError> {
    let mut steps: Vec<u64> = file_names(dir)?
        .iter()
        .filter_map(|name| step_number(name))
        .collect();
    steps.sort_unstable();
    Ok(steps)
}

/// Number and time, s, of each of `steps`.
pub(crate) fn read_times(dir: &Path, steps: &[u64]) -> Result<Vec<(u64, f64)>, CheckpointError> {
    let read = |&step: &u64| Ok((step, read_step_time(&dir.join(step_file_name(step)))?));
    steps.iter().map(read).collect()
}

/// The number in a step's file name; names this crate would not write are not steps.
fn step_number(name: &str) -> Option<u64> {
    let step = name.strip_prefix("step_")?.strip_suffix(".hdf")?.parse().ok()?;
    (step_file_name(step) == name).then_some(step)
}

fn file_names(dir: &Path) -> Result<Vec<String>, CheckpointError> {
    let list = || -> std::io::Result<Vec<String>> {
        fs::read_dir(dir)?
            .map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned()))
            .collect()
    };
    list().map_err(CheckpointError::io("list folder", dir))
}

fn require_no_results(dir: &Path) -> Result<(), CheckpointError> {
    let names = file_names(dir)?;
    let steps = committed_steps(dir)?;
    let mut found = match steps[..] {
        [] => Vec::new(),
        [only] => vec![step_file_name(only)],
        [first, .., last] => {
            vec![format!("{} steps from {first} to {last}", steps.len())]
        }
    };
    let known = [MESH_FILE, SERIES_FILE, INDEX_FILE];
    found.extend(
        known
            .iter()
            .filter(|&&name| names.iter().any(|n| n == name))
            .map(|name| name.to_string()),
    );
    if found.is_empty() {
        return Ok(());
    }
    Err(CheckpointError::ResultsPresent {
        path: dir.to_path_buf(),
        found: found.join(", "),
    })
}

fn remove_leftovers(dir: &Path) -> Result<(), CheckpointError> {
    for name in file_names(dir)?.iter().filter(|name| atomic::is_temporary(name)) {
        remove_if_present(&dir.join(name))?;
    }
    Ok(())
}

fn remove_if_present(path: &Path) -> Result<(), CheckpointError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(CheckpointError::io("remove", path)(error))
        }
        _ => Ok(()),
    }
}

/// Moves steps into a new folder `superseded_N`, the newest first, so that what remains has no gap if this is
/// interrupted. A link to the mesh beside them keeps them viewable.
fn move_aside(dir: &Path, steps: &[u64]) -> Result<(), CheckpointError> {
    if steps.is_empty() {
        return Ok(());
    }
    let aside = (1_u64..)
        .map(|n| dir.join(format!("superseded_{n}")))
        .find(|path| !path.exists());
    let aside = aside.expect("fewer than 2^64 folders exist");
    fs::create_dir(&aside).map_err(CheckpointError::io("create folder", &aside))?;
    let (mesh, mesh_aside) = (dir.join(MESH_FILE), aside.join(MESH_FILE));
    if fs::hard_link(&mesh, &mesh_aside).is_err() {
        fs::copy(&mesh, &mesh_aside).map_err(CheckpointError::io("write", &mesh_aside))?;
    }
    for &step in steps.iter().rev() {
        let (from, to) = (dir.join(step_file_name(step)), aside.join(step_file_name(step)));
        fs::rename(&from, &to).map_err(CheckpointError::io("move aside", &from))?;
    }
    write_series(&aside, &read_times(&aside, steps)?)?;
    atomic::sync_dir(&aside)?;
    atomic::sync_dir(dir)
}
