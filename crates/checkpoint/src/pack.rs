//! Many steps in one file, for file systems on which the number of files hurts: `pack_NNNNNN_NNNNNN.hdf`, named after
//! its first and last step.
//!
//! Each step is a group `step_NNNNNN` with the arrays, texts and checksums of its file. `run.vtkhdf` shows packed steps
//! like all others; `run.hdf.series` cannot, it needs a file per step. A pack is sealed and on the disk, and every step
//! in it has been read back, before the first step file is removed; if this is interrupted, steps are there twice, and
//! the file of its own counts. Unpacking gives the same bytes again. The newest steps stay files of their own: a run
//! resumes from those only.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::atomic::{self, Format};
use crate::dataset::{CheckedFile, create_group, create_vtkhdf};
use crate::error::CheckpointError;
use crate::folder::{committed_steps, file_names, remove_if_present, require_run, run_of, step_file_name};
use crate::index::rebuild_index;
use crate::lock::FolderLock;
use crate::record::StepRecord;
use crate::seal::{verify_seal, verify_structure};
use crate::step::{
    Origin, POINT_DATA, fill_step, has_state, read_mesh_hash, read_record, read_step, read_storage,
    read_texts, read_time, read_version, require_run_in, run_of_file, write_step_file,
};
use crate::storage::Storage;

/// Where a step is.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    /// Its number.
    pub step: u64,
    /// The file.
    pub path: PathBuf,
    /// The group in the file at which its paths start.
    root: String,
}

impl Place {
    fn single(dir: &Path, step: u64) -> Place {
        Place {
            step,
            path: dir.join(step_file_name(step)),
            root: "/".to_string(),
        }
    }

    fn packed(path: &Path, step: u64) -> Place {
        Place {
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

/// A step with all that its file says.
struct Whole {
    record: StepRecord,
    program_version: String,
    mesh_hash: String,
    run: Option<String>,
    about: BTreeMap<String, String>,
    storage: Storage,
}

impl Whole {
    /// Reads a step of a file whose structure has been verified.
    fn read(place: &Place) -> Result<Whole, CheckpointError> {
        let file = place.open()?;
        Ok(Whole {
            record: read_record(&file, &place.path)?,
            program_version: read_version(&file)?,
            mesh_hash: read_mesh_hash(&file)?,
            run: run_of_file(&file)?,
            about: read_texts(&file)?,
            storage: read_storage(&file)?,
        })
    }

    fn origin(&self) -> Origin<'_> {
        Origin {
            program_version: &self.program_version,
            mesh_hash: &self.mesh_hash,
            run: self.run.as_deref(),
            about: &self.about,
        }
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
type SoundPlaces = (Vec<(f64, Place)>, Vec<CheckpointError>);

/// Time and place of every step of the folder's run with a sound structure, growing, and why others are not.
pub(crate) fn sound_places(dir: &Path) -> Result<SoundPlaces, CheckpointError> {
    let (mut places, mut damaged) = (BTreeMap::new(), Vec::new());
    for (path, steps) in packs(dir)? {
        places.extend(steps.into_iter().map(|step| (step, Place::packed(&path, step))));
    }
    // A file of its own counts before a pack.
    for step in committed_steps(dir)? {
        places.insert(step, Place::single(dir, step));
    }
    let (mut sound, run) = (Vec::new(), run_of(dir)?);
    let time_of = |place: &Place| {
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

/// Puts all committed steps but the newest `keep` (at least one) into packs of `per_file` steps; the newest step with a
/// state and all after it stay besides, so that the run can go on. Returns how many steps were packed. The run that
/// writes them must have ended: the lock says so.
pub fn pack_steps(lock: &FolderLock, keep: usize, per_file: usize) -> Result<usize, CheckpointError> {
    let dir = lock.dir();
    let mut steps = committed_steps(dir)?;
    let most = steps.len().saturating_sub(keep.max(1));
    steps.truncate(most.min(newest_state(dir, &steps).unwrap_or(most)));
    let mut packed = BTreeMap::new();
    for (path, known) in packs(dir)? {
        packed.extend(known.into_iter().map(|step| (step, path.clone())));
    }
    let new: Vec<u64> = steps
        .iter()
        .copied()
        .filter(|step| !packed.contains_key(step))
        .collect();
    for chunk in new.chunks(per_file.max(1)) {
        let path = write_pack(dir, chunk)?;
        packed.extend(chunk.iter().map(|&step| (step, path.clone())));
    }
    // All is read back before the first file goes.
    for step in &steps {
        read_record(&Place::packed(&packed[step], *step).open()?, &packed[step])?;
    }
    for &step in &steps {
        let hidden = dir.join(format!(".{}.tmp", step_file_name(step)));
        // Out of sight first: the views are built over what stays.
        fs::rename(dir.join(step_file_name(step)), &hidden)
            .map_err(CheckpointError::io("remove", &hidden))?;
    }
    rebuild_index(dir)?;
    for &step in &steps {
        remove_if_present(&dir.join(format!(".{}.tmp", step_file_name(step))))?;
    }
    atomic::sync_dir(dir)?;
    Ok(steps.len())
}

/// Place among `steps` of the newest with a state. A damaged one has none to go on from.
fn newest_state(dir: &Path, steps: &[u64]) -> Option<usize> {
    let has_state = |&step: &u64| has_state(&dir.join(step_file_name(step))).unwrap_or(false);
    steps.iter().rposition(has_state)
}

/// Writes a new pack of these steps, every byte of which is verified before and after.
fn write_pack(dir: &Path, steps: &[u64]) -> Result<PathBuf, CheckpointError> {
    let name = pack_name(steps[0], steps[steps.len() - 1]);
    let path = dir.join(&name);
    let (mut failure, run) = (None, run_of(dir)?);
    let written = atomic::write_hdf(dir, &name, Format::Earliest, |file| {
        let mut contents = Vec::new();
        for &step in steps {
            let place = Place::single(dir, step);
            let whole = verify_seal(&place.path)
                .and_then(|()| require_run(&place.path, run.as_deref()))
                .and_then(|()| Whole::read(&place));
            let whole = match whole {
                Ok(whole) => whole,
                Err(error) => {
                    let text = error.to_string();
                    failure = Some(error);
                    return Err(text.into());
                }
            };
            let group = create_group(file, &group_name(step))?;
            create_vtkhdf(&group, [1, 0])?;
            let arrays = fill_step(&group, &whole.record, &whole.origin(), whole.storage)?;
            contents.extend(arrays.iter().map(|array| format!("/{}{array}", group_name(step))));
        }
        Ok(contents)
    });
    // The damage of a step says more than that the pack could not be written.
    if let Some(error) = failure {
        return Err(error);
    }
    written?;
    verify_seal(&path)?;
    Ok(path)
}

/// Makes a file of every packed step again, of the same bytes as before, and removes the packs. Returns how many.
pub fn unpack_steps(lock: &FolderLock) -> Result<usize, CheckpointError> {
    let dir = lock.dir();
    let mut n_steps = 0;
    for (path, steps) in packs(dir)? {
        verify_seal(&path)?;
        for step in steps {
            let single = Place::single(dir, step);
            if single.path.exists() && read_step(&single.path).is_ok() {
                continue;
            }
            let whole = Whole::read(&Place::packed(&path, step))?;
            write_step_file(
                dir,
                &single.file_name(),
                &whole.record,
                &whole.origin(),
                whole.storage,
            )?;
            read_step(&single.path)?;
            n_steps += 1;
        }
        remove_if_present(&path)?;
    }
    rebuild_index(dir)?;
    Ok(n_steps)
}

/// Numbers of all committed steps, packed or not, growing.
pub fn all_steps(dir: &Path) -> Result<Vec<u64>, CheckpointError> {
    let mut steps = committed_steps(dir)?;
    steps.extend(packs(dir)?.into_iter().flat_map(|(_, packed)| packed));
    steps.sort_unstable();
    steps.dedup();
    Ok(steps)
}

/// Names of the fields over points that a step of the run in `dir` holds, packed or not; no values are read.
pub fn point_field_names(dir: &Path, step: u64) -> Result<Vec<String>, CheckpointError> {
    let single = Place::single(dir, step);
    let packed = packs(dir)?.into_iter().find(|(_, steps)| steps.contains(&step));
    match packed {
        Some((path, _)) if !single.path.exists() => Place::packed(&path, step).open()?.members(POINT_DATA),
        _ => {
            verify_structure(&single.path)?;
            single.open()?.members(POINT_DATA)
        }
    }
}

/// Reads a step of the run in `dir`, packed or not; every value read is verified.
pub fn read_any_step(dir: &Path, step: u64) -> Result<StepRecord, CheckpointError> {
    let single = Place::single(dir, step);
    let (mut packs, run) = (packs(dir)?.into_iter(), run_of(dir)?);
    match packs.find(|(_, steps)| steps.contains(&step)) {
        Some((path, _)) if !single.path.exists() => {
            let place = Place::packed(&path, step);
            let file = place.open()?;
            require_run_in(&file, &path, run.as_deref())?;
            read_record(&file, &path)
        }
        _ => {
            require_run(&single.path, run.as_deref())?;
            read_step(&single.path)
        }
    }
}

fn group_name(step: u64) -> String {
    format!("step_{step:06}")
}

fn pack_name(first: u64, last: u64) -> String {
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
