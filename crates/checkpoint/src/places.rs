//! Where the steps of a run are: in files of their own, or in packs. Steps are read wherever they are.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::dataset::CheckedFile;
use crate::error::CheckpointError;
use crate::folder::{committed_steps, file_names, require_run, run_of};
use crate::names::{group_name, pack_name, pack_range, step_file_name};
use crate::record::StepRecord;
use crate::seal::verify_structure;
use crate::step::{POINT_DATA, read_record, read_step, read_time, require_run_in};

/// Where a step is.
#[derive(Clone, Debug)]
pub(crate) struct StepPlace {
    /// Its number.
    pub step: u64,
    /// The file.
    pub path: PathBuf,
    /// The group in the file at which its paths start.
    root: String,
}

impl StepPlace {
    /// Of a file of its own.
    pub fn single(dir: &Path, step: u64) -> StepPlace {
        StepPlace {
            step,
            path: dir.join(step_file_name(step)),
            root: "/".to_string(),
        }
    }

    /// In a pack.
    pub fn packed(path: &Path, step: u64) -> StepPlace {
        StepPlace {
            step,
            path: path.to_path_buf(),
            root: format!("/{}", group_name(step)),
        }
    }

    /// Opens the step.
    pub fn open(&self) -> Result<CheckedFile<'_>, CheckpointError> {
        CheckedFile::open_at(&self.path, &self.root)
    }

    /// Whether the step shares its file with others.
    pub fn is_packed(&self) -> bool {
        self.root != "/"
    }

    /// Name of the file in its folder.
    pub fn file_name(&self) -> String {
        let name = self.path.file_name().expect("a place is a file");
        name.to_string_lossy().into_owned()
    }

    /// An array of the step, as a path from the root of the file.
    pub fn below(&self, array: &str) -> String {
        format!("{}{array}", self.root.trim_end_matches('/'))
    }
}

/// Packs of a folder with the steps in each, growing. Only names are looked at, and the groups of the packs.
pub fn packs(dir: &Path) -> Result<Vec<(PathBuf, Vec<u64>)>, CheckpointError> {
    let mut ranges: Vec<_> = file_names(dir)?
        .iter()
        .filter_map(|name| pack_range(name))
        .collect();
    ranges.sort_unstable();
    let steps = |(first, last)| {
        let path = dir.join(pack_name(first, last));
        verify_structure(&path)?;
        let groups = CheckedFile::open(&path)?.members("/")?;
        let steps = groups
            .iter()
            .filter_map(|name| name.strip_prefix("step_")?.parse().ok());
        let mut steps: Vec<u64> = steps.collect();
        steps.sort_unstable();
        Ok((path, steps))
    };
    ranges.into_iter().map(steps).collect()
}

/// Time, s, and place of steps, and why others are not among them.
type SoundPlaces = (Vec<(f64, StepPlace)>, Vec<CheckpointError>);

/// Time and place of every step of the folder's run with a sound structure, growing, and why others are not.
pub(crate) fn sound_places(dir: &Path) -> Result<SoundPlaces, CheckpointError> {
    let (mut places, mut damaged) = (BTreeMap::new(), Vec::new());
    for (path, steps) in packs(dir)? {
        places.extend(
            steps
                .into_iter()
                .map(|step| (step, StepPlace::packed(&path, step))),
        );
    }
    // A file of its own counts before a pack.
    for step in committed_steps(dir)? {
        places.insert(step, StepPlace::single(dir, step));
    }
    let (mut sound, run) = (Vec::new(), run_of(dir)?);
    let time_of = |place: &StepPlace| {
        let file = place.open()?;
        require_run_in(&file, &place.path, run.as_deref())?;
        read_time(&file)
    };
    for place in places.into_values() {
        let structure = if place.is_packed() {
            Ok(())
        } else {
            verify_structure(&place.path)
        };
        match structure.and_then(|()| time_of(&place)) {
            Ok(time) => sound.push((time, place)),
            Err(error) => damaged.push(error),
        }
    }
    Ok((sound, damaged))
}

/// Numbers of all committed steps, packed or not, growing.
pub fn all_steps(dir: &Path) -> Result<Vec<u64>, CheckpointError> {
    let mut steps = committed_steps(dir)?;
    steps.extend(packs(dir)?.into_iter().flat_map(|(_, packed)| packed));
    steps.sort_unstable();
    steps.dedup();
    Ok(steps)
}

/// Where a step of the run in `dir` is; a file of its own counts before a pack.
fn place_of(dir: &Path, step: u64) -> Result<StepPlace, CheckpointError> {
    let single = StepPlace::single(dir, step);
    // Also what is there and is no file has its own error where it is read.
    if single.path.symlink_metadata().is_ok() {
        return Ok(single);
    }
    let packed = packs(dir)?.into_iter().find(|(_, steps)| steps.contains(&step));
    match packed {
        Some((path, _)) => Ok(StepPlace::packed(&path, step)),
        None => Err(CheckpointError::unknown_step(dir, step, all_steps(dir)?)),
    }
}

/// Names of the fields over points that a step of the run in `dir` holds, packed or not; no values are read.
pub fn point_field_names(dir: &Path, step: u64) -> Result<Vec<String>, CheckpointError> {
    let place = place_of(dir, step)?;
    if !place.is_packed() {
        verify_structure(&place.path)?;
    }
    place.open()?.members(POINT_DATA)
}

/// Reads a step of the run in `dir`, packed or not; every value read is verified.
pub fn read_any_step(dir: &Path, step: u64) -> Result<StepRecord, CheckpointError> {
    let (place, run) = (place_of(dir, step)?, run_of(dir)?);
    if !place.is_packed() {
        require_run(&place.path, run.as_deref())?;
        return read_step(&place.path);
    }
    let file = place.open()?;
    require_run_in(&file, &place.path, run.as_deref())?;
    read_record(&file, &place.path)
}
