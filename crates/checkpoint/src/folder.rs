//! What lies in a result folder: its steps by name, the newest whole one, leftovers, superseded steps.

use std::fs;
use std::path::{Path, PathBuf};

use crate::atomic;
use crate::dataset::CheckedFile;
use crate::error::CheckpointError;
use crate::lock::FolderLock;
use crate::mesh_file::MESH_FILE;
use crate::names::{INDEX_FILE, SERIES_FILE, pack_range, step_file_name, step_number};
use crate::record::StepRecord;
use crate::seal::verify_structure;
use crate::series::write_series;
use crate::step::{has_state, read_step, read_step_number, read_step_time, require_run_in, run_of_file};

/// Numbers of the committed steps in a folder, growing. Only names are looked at.
pub fn committed_steps(dir: &Path) -> Result<Vec<u64>, CheckpointError> {
    let mut steps: Vec<u64> = file_names(dir)?
        .iter()
        .filter_map(|name| step_number(name))
        .collect();
    steps.sort_unstable();
    Ok(steps)
}

/// Identity of the run in `dir`: that of its mesh, or of its first sound step if the mesh has none. None
/// where no file has one, as in results of earlier versions.
pub fn run_of(dir: &Path) -> Result<Option<String>, CheckpointError> {
    let run = |name: &str| {
        let path = dir.join(name);
        verify_structure(&path)?;
        run_of_file(&CheckedFile::open(&path)?)
    };
    if let Ok(Some(run)) = run(MESH_FILE) {
        return Ok(Some(run));
    }
    let steps = committed_steps(dir)?;
    Ok(steps.iter().find_map(|&step| run(&step_file_name(step)).ok()?))
}

/// Fails if the step file at `path` is damaged in its structure, of another run than `run`, or holds another
/// step than its name says.
pub fn require_run(path: &Path, run: Option<&str>) -> Result<(), CheckpointError> {
    verify_structure(path)?;
    let file = CheckedFile::open(path)?;
    require_run_in(&file, path, run)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let (named, held) = (step_number(&name), read_step_number(&file, path)?);
    match named.filter(|&named| named != held) {
        None => Ok(()),
        Some(_) => Err(CheckpointError::malformed(path, format!("it holds step {held}"))),
    }
}

/// Number and time, s, of those of `steps` whose structure is sound and that are of the folder's run, and
/// why the others are not.
pub(crate) fn sound_steps(dir: &Path, steps: &[u64]) -> (Vec<(u64, f64)>, Vec<CheckpointError>) {
    let (mut sound, mut damaged) = (Vec::new(), Vec::new());
    let run = run_of(dir).ok().flatten();
    for &step in steps {
        let path = dir.join(step_file_name(step));
        match require_run(&path, run.as_deref()).and_then(|()| read_step_time(&path)) {
            Ok(time) => sound.push((step, time)),
            Err(error) => damaged.push(error),
        }
    }
    (sound, damaged)
}

/// The newest step that a run can go on from: whole, every byte verified, and with a state. `skipped` hears of newer
/// ones that are damaged.
pub fn newest_step(
    dir: &Path,
    mut skipped: impl FnMut(&CheckpointError),
) -> Result<StepRecord, CheckpointError> {
    let path = dir.to_path_buf();
    let (steps, run) = (committed_steps(dir)?, run_of(dir)?);
    let mut error = match steps.is_empty() {
        true => CheckpointError::NoSteps { path },
        false => CheckpointError::NoState { path },
    };
    for &step in steps.iter().rev() {
        let path = dir.join(step_file_name(step));
        let read = || match has_state(&path)? {
            true => read_step(&path).map(Some),
            false => Ok(None),
        };
        match require_run(&path, run.as_deref()).and_then(|()| read()) {
            Ok(Some(record)) => return Ok(record),
            Ok(None) => {}
            Err(damage) => {
                skipped(&damage);
                error = damage;
            }
        }
    }
    Err(error)
}

/// A new folder `superseded_N` in `dir`, for what a resumed run replaces.
pub fn new_superseded_folder(dir: &Path) -> Result<PathBuf, CheckpointError> {
    let aside = (1_u64..)
        .map(|n| dir.join(format!("superseded_{n}")))
        .find(|path| !path.exists());
    let aside = aside.expect("fewer than 2^64 folders exist");
    fs::create_dir(&aside).map_err(CheckpointError::io("create folder", &aside))?;
    Ok(aside)
}

/// A run that has made its folder and has no step yet; what is there is of no use to anybody. Removed with
/// the first step.
const STARTING: &str = ".raceway.starting";

/// Whether the folder holds only what a run left that ended before its first step was committed.
pub fn is_unfinished_start(dir: &Path) -> Result<bool, CheckpointError> {
    if !dir.join(STARTING).exists() {
        return Ok(false);
    }
    let has_pack = file_names(dir)?.iter().any(|name| pack_range(name).is_some());
    Ok(committed_steps(dir)?.is_empty() && !has_pack)
}

/// Removes what a run left that ended before its first step: its own files and these `tables`. True if there
/// was such a run.
pub fn clear_unfinished_start(lock: &FolderLock, tables: &[&str]) -> Result<bool, CheckpointError> {
    let dir = lock.dir();
    if !is_unfinished_start(dir)? {
        return Ok(false);
    }
    for name in [MESH_FILE, SERIES_FILE, INDEX_FILE].iter().chain(tables) {
        remove_if_present(&dir.join(name))?;
    }
    Ok(true)
}

/// Makes the folder one of a run without a step, for a run that needs steps of other folders too and has none there:
/// its own are moved aside, into the folder returned if there are any.
pub fn begin_anew(lock: &FolderLock) -> Result<Option<PathBuf>, CheckpointError> {
    let dir = lock.dir();
    let aside = move_aside(dir, &committed_steps(dir)?)?;
    note_start(dir)?;
    Ok(aside)
}

/// Says that a run begins here.
pub(crate) fn note_start(dir: &Path) -> Result<(), CheckpointError> {
    let path = dir.join(STARTING);
    remove_if_present(&path)?;
    let made = fs::File::create_new(&path).map(drop);
    made.map_err(CheckpointError::io("create", &path))?;
    atomic::sync_dir(dir)
}

/// Says that a run has its first step.
pub(crate) fn note_first_step(dir: &Path) -> Result<(), CheckpointError> {
    remove_if_present(&dir.join(STARTING))
}

pub(crate) fn file_names(dir: &Path) -> Result<Vec<String>, CheckpointError> {
    let list = || -> std::io::Result<Vec<String>> {
        fs::read_dir(dir)?
            .map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned()))
            .collect()
    };
    list().map_err(CheckpointError::io("list folder", dir))
}

pub(crate) fn require_no_results(dir: &Path) -> Result<(), CheckpointError> {
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
    found.extend(names.into_iter().filter(|name| pack_range(name).is_some()));
    if found.is_empty() {
        return Ok(());
    }
    Err(CheckpointError::ResultsPresent {
        path: dir.to_path_buf(),
        found: found.join(", "),
    })
}

pub(crate) fn remove_leftovers(dir: &Path) -> Result<(), CheckpointError> {
    for name in file_names(dir)?.iter().filter(|name| atomic::is_temporary(name)) {
        remove_if_present(&dir.join(name))?;
    }
    Ok(())
}

pub(crate) fn remove_if_present(path: &Path) -> Result<(), CheckpointError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(CheckpointError::io("remove", path)(error))
        }
        _ => Ok(()),
    }
}

/// Moves steps into a new folder `superseded_N`, the newest first, so that what remains has no gap if this is
/// interrupted. A link to the mesh beside them keeps them viewable.
pub(crate) fn move_aside(dir: &Path, steps: &[u64]) -> Result<Option<PathBuf>, CheckpointError> {
    if steps.is_empty() {
        return Ok(None);
    }
    let aside = new_superseded_folder(dir)?;
    let (mesh, mesh_aside) = (dir.join(MESH_FILE), aside.join(MESH_FILE));
    if fs::hard_link(&mesh, &mesh_aside).is_err() {
        fs::copy(&mesh, &mesh_aside).map_err(CheckpointError::io("write", &mesh_aside))?;
    }
    for &step in steps.iter().rev() {
        let (from, to) = (dir.join(step_file_name(step)), aside.join(step_file_name(step)));
        fs::rename(&from, &to).map_err(CheckpointError::io("move aside", &from))?;
    }
    // Damaged ones are kept too, but not shown.
    write_series(&aside, &sound_steps(&aside, steps).0)?;
    atomic::sync_dir(&aside)?;
    atomic::sync_dir(dir)?;
    Ok(Some(aside))
}
