//! The folder of a run of a list of bearings: free for it, and used again where a run ended before its first step.
//!
//! A mark in the folder says that a run begins there, until each bearing has a folder with the mark of its own. That
//! one goes with the first step of the bearing: as long as one is there, no step is whole in all bearings.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use checkpoint::{CheckpointError, FolderLock, MESH_FILE, all_steps, begin_anew, is_unfinished_start, lock};
use comm::{Communicator, print};
use input::shell_word;
use scene::{SeveralScene, names_of_bearings};

use crate::failure::Failure;
use crate::folder::{remove_outdated, start_again};
use crate::modes::TABLE as MODES_TABLE;
use crate::several::{BALLS_TABLE, BEARINGS_TABLE, ENERGY_TABLE, SCENE_TEXT, SHAFT_TABLE};
use crate::several_modes::SHAFT_TABLE as MODE_SHAFT_TABLE;
use crate::summary::SUMMARY_FILE;
use crate::whole::{make_asked_folder, require_free, write_new};

/// The mark.
const STARTING: &str = ".raceway.starting_list";

/// What a run makes beside the folders of its bearings before its first step.
const FIRST_FILES: [&str; 7] = [
    SCENE_TEXT,
    BALLS_TABLE,
    BEARINGS_TABLE,
    SHAFT_TABLE,
    ENERGY_TABLE,
    MODES_TABLE,
    MODE_SHAFT_TABLE,
];

/// A run of a list whose bearings have no folders yet.
pub struct ListStart {
    /// The folder of the run.
    pub dir: PathBuf,
    /// Held by rank 0.
    lock: Option<FolderLock>,
}

impl ListStart {
    /// Makes the folder with the scene in it, locked until all bearings have theirs. What a run left there that ended
    /// before its first step is removed. Rank 0 does it for all, and may fail alone.
    pub fn begin(scene: &SeveralScene, dir: &Path) -> Result<ListStart, Failure> {
        let start = |lock| ListStart {
            dir: dir.to_path_buf(),
            lock,
        };
        if !Communicator::world().is_root() {
            return Ok(start(None));
        }
        make_asked_folder(dir)?;
        let lock = FolderLock::acquire(dir)?;
        if is_free_again(&scene.path, dir)? {
            clear(dir)?;
        } else {
            require_free(dir, &FIRST_FILES)?;
            mark(dir)?;
        }
        write_new(&dir.join(SCENE_TEXT), |file| {
            file.write_all(scene.text.as_bytes())
        })?;
        Ok(start(Some(lock)))
    }

    /// All bearings have their folders. Rank 0 may fail alone.
    pub fn end(self) -> Result<(), Failure> {
        match self.lock {
            Some(lock) => Ok(remove(&lock.dir().join(STARTING))?),
            None => Ok(()),
        }
    }
}

/// Fails where something stands in the way of a new run of a list, which no earlier one has left that ended before its
/// first step.
pub fn require_room(scene: &Path, dir: &Path) -> Result<(), Failure> {
    match is_free_again(scene, dir)? {
        true => Ok(()),
        false => Ok(require_free(dir, &FIRST_FILES)?),
    }
}

/// Whether a run of a list ended in a folder before its first step, so that another one may begin there. A scene that
/// lies in its place is not replaced by what it says.
pub fn is_free_again(scene: &Path, dir: &Path) -> Result<bool, CheckpointError> {
    let own = dir.join(SCENE_TEXT).canonicalize().ok();
    let is_scene = own.is_some() && own == scene.canonicalize().ok();
    Ok(!is_scene && is_unfinished(dir)?)
}

/// Whether a folder holds only what a run of a list left that ended before its first step was whole in all bearings.
pub fn is_unfinished(dir: &Path) -> Result<bool, CheckpointError> {
    let holds = |name: &str| dir.join(name).exists();
    if holds(SUMMARY_FILE) || holds(MESH_FILE) {
        return Ok(false);
    }
    if holds(STARTING) {
        return Ok(true);
    }
    let folders = folders(dir);
    if !holds(BEARINGS_TABLE) || folders.iter().any(|folder| !folder.is_dir()) {
        return Ok(false);
    }
    for folder in &folders {
        if is_unfinished_start(folder)? {
            return Ok(true);
        }
    }
    Ok(false)
}

/// What to say of a folder with [`is_unfinished`] that a command cannot go on in: nothing has ended where a process
/// still writes.
pub fn ended_early(dir: &Path) -> Failure {
    for folder in std::iter::once(dir.to_path_buf()).chain(folders(dir)) {
        match lock::writer(&folder) {
            Ok(None) => {}
            Ok(Some(owner)) => return CheckpointError::Locked { path: folder, owner }.into(),
            Err(error) => return error.into(),
        }
    }
    Failure::User(anyhow!(
        "{} holds no step that is whole in all bearings: {}",
        dir.display(),
        start_again(dir)
    ))
}

/// What to say of a folder of one bearing or of a list that has no summary: whether a process still writes, or how to
/// go on with a run that was killed.
pub fn not_ended(dir: &Path) -> Failure {
    let folders: Vec<PathBuf> = std::iter::once(dir.to_path_buf()).chain(folders(dir)).collect();
    let writer = folders
        .iter()
        .find_map(|folder| lock::writer(folder).ok().flatten());
    let has_steps = |folder: &PathBuf| all_steps(folder).is_ok_and(|steps| !steps.is_empty());
    let rest = match writer {
        Some(owner) => format!(", and {owner} still writes to it"),
        None if folders.iter().any(has_steps) => format!(
            "; if it was killed, raceway resume {} goes on with a run over time, and says of others what to do",
            shell_word(dir.display())
        ),
        None => String::new(),
    };
    Failure::User(anyhow!(
        "{} has no {SUMMARY_FILE}; expected the results of a run that has ended{rest}",
        dir.display()
    ))
}

/// Folders of the bearings of the scene in a folder.
fn folders(dir: &Path) -> Vec<PathBuf> {
    let text = fs::read_to_string(dir.join(SCENE_TEXT)).unwrap_or_default();
    names_of_bearings(&text)
        .iter()
        .map(|name| dir.join(name))
        .collect()
}

/// Removes what a run left that ended before its first step. Steps that only some bearings have are moved aside.
fn clear(dir: &Path) -> Result<(), Failure> {
    let made = folders(dir).into_iter().filter(|folder| folder.is_dir());
    // None of them is touched while another process writes to one.
    let locks = made.map(|folder| FolderLock::acquire(&folder));
    let locks = locks.collect::<Result<Vec<FolderLock>, CheckpointError>>()?;
    // Before the run had made all folders, one without its mark is not of that run.
    let all_made = !dir.join(STARTING).exists();
    for lock in locks.iter().filter(|_| all_made) {
        if !is_unfinished_start(lock.dir())? {
            note_alone(begin_anew(lock)?.as_deref());
            remove_outdated(lock.dir())?;
        }
    }
    mark(dir)?;
    for name in FIRST_FILES {
        remove(&dir.join(name))?;
    }
    print::note(format_args!(
        "note: the run in {} ended before its first step was whole in all bearings; it is started anew",
        dir.display()
    ));
    Ok(())
}

/// Names the folder of steps that a bearing had without the others, if there are any.
fn note_alone(folder: Option<&Path>) {
    if let Some(folder) = folder {
        print::note(format_args!(
            "steps of one bearing without the others are kept in {}",
            folder.display()
        ));
    }
}

fn remove(path: &Path) -> anyhow::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(()),
        removed => removed.with_context(|| format!("cannot remove {}", path.display())),
    }
}

/// Says that a run begins in a folder.
fn mark(dir: &Path) -> Result<(), Failure> {
    let path = dir.join(STARTING);
    let made = fs::OpenOptions::new().append(true).create(true).open(&path);
    Ok(made
        .map(drop)
        .with_context(|| format!("cannot create {}", path.display()))?)
}
