//! The folder of a run's results: chosen, found free and found writable before anything expensive, made when there
//! is something to put into it. A run that fails before its first equilibrium leaves no trace.

use std::ffi::OsString;
use std::os::unix::ffi::OsStringExt;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use checkpoint::{
    CheckpointError, FolderLock, INDEX_FILE, MESH_FILE, SERIES_FILE, clear_unfinished_start,
    is_unfinished_start,
};
use comm::{Communicator, print};
use input::shell_word;

use crate::failure::{Failure, agree};
use crate::reduction::REDUCTION_FILE;
use crate::seat::SEAT_TABLES;
use crate::summary::SUMMARY_FILE;
use crate::whole::make_asked_folder;

/// Largest number that a default result folder may carry.
const MAX_FOLDERS: usize = 10_000;

/// Files that say that a folder holds results, besides those of steps.
const RESULT_FILES: [&str; 14] = [
    SUMMARY_FILE,
    REDUCTION_FILE,
    "balls.csv",
    "shaft.csv",
    "energy.csv",
    "cage.csv",
    "probes.csv",
    "profiles.csv",
    "modes.csv",
    SEAT_TABLES[0],
    SEAT_TABLES[1],
    MESH_FILE,
    SERIES_FILE,
    INDEX_FILE,
];

/// Where the results of `scene` go: `out`, which must not hold results, or the next free `results/NAME`; what a run
/// left that ended before its first step is none. Rank 0 chooses for all.
pub fn choose(scene: &Path, out: Option<PathBuf>) -> Result<PathBuf, Failure> {
    choose_by(|| choose_alone(scene, out, is_unfinished_start))
}

/// The same for a list of bearings, where `is_unfinished` tells of a folder what a run of a list left in it.
pub fn choose_for_list(
    scene: &Path,
    out: Option<PathBuf>,
    is_unfinished: impl Fn(&Path) -> Result<bool, CheckpointError>,
) -> Result<PathBuf, Failure> {
    choose_by(|| choose_alone(scene, out, is_unfinished))
}

fn choose_by(find: impl FnOnce() -> Result<PathBuf, Failure>) -> Result<PathBuf, Failure> {
    let comm = Communicator::world();
    let chosen = agree(if comm.is_root() {
        find()
    } else {
        Ok(PathBuf::new())
    })?;
    let bytes = comm.from_root(chosen.into_os_string().into_vec());
    Ok(PathBuf::from(OsString::from_vec(bytes)))
}

fn choose_alone(
    scene: &Path,
    out: Option<PathBuf>,
    is_unfinished: impl Fn(&Path) -> Result<bool, CheckpointError>,
) -> Result<PathBuf, Failure> {
    let dir = match out {
        Some(dir) => dir,
        None => {
            let dir = next_free(scene)?;
            if let Some(earlier) = earlier(&dir) {
                print::note(format_args!(
                    "note: {} holds an earlier run; this one goes to {}, which plot, report and the like have to be \
                     told",
                    earlier.display(),
                    dir.display()
                ));
            }
            dir
        }
    };
    require_writable(&dir)?;
    require_no_results(&dir, is_unfinished)?;
    Ok(dir)
}

/// Name and number of a default folder: 1 where it has none.
fn numbered(dir: &Path) -> Option<(&str, usize)> {
    let name = dir.file_name()?.to_str()?;
    let split = name
        .rsplit_once('-')
        .and_then(|(stem, number)| Some((stem, number.parse().ok()?)));
    Some(split.filter(|&(_, number)| number > 1).unwrap_or((name, 1)))
}

/// The folder of the same name with another number.
fn with_number(dir: &Path, stem: &str, number: usize) -> PathBuf {
    match number {
        1 => dir.with_file_name(stem),
        _ => dir.with_file_name(format!("{stem}-{number}")),
    }
}

/// The default folder of the run before that of `dir`.
fn earlier(dir: &Path) -> Option<PathBuf> {
    let (stem, number) = numbered(dir)?;
    (number > 1).then(|| with_number(dir, stem, number - 1))
}

/// Says that a later run of the same default name has results in another folder, where a command shows those of `dir`.
pub fn say_later(dir: &Path) {
    if let Some(later) = later(dir) {
        print::note(format_args!(
            "note: {} holds a later run; this is {}",
            later.display(),
            dir.display()
        ));
    }
}

/// How to have a run again that ended in a folder before its first step.
pub fn start_again(dir: &Path) -> String {
    format!(
        "the run ended before its first one; start it again with raceway run SCENE --out {}",
        shell_word(dir.display())
    )
}

/// The folder of the last run that was given the default name of `dir` after it.
fn later(dir: &Path) -> Option<PathBuf> {
    let (stem, number) = numbered(dir)?;
    let following = (number + 1..MAX_FOLDERS).map(|next| with_number(dir, stem, next));
    // A run of the scene that is going on has no summary yet.
    let holds_run = |dir: &PathBuf| dir.join(SUMMARY_FILE).exists() || dir.join(MESH_FILE).exists();
    following.take_while(|dir| dir.exists()).filter(holds_run).last()
}

fn next_free(scene: &Path) -> Result<PathBuf, Failure> {
    let stem = scene
        .file_stem()
        .map_or_else(|| "run".into(), |s| s.to_string_lossy());
    let first = PathBuf::from("results").join(stem.as_ref());
    let numbered = (2..MAX_FOLDERS).map(|i| PathBuf::from("results").join(format!("{stem}-{i}")));
    std::iter::once(first)
        .chain(numbered)
        .find(|dir| !dir.exists())
        .ok_or_else(|| {
            Failure::User(anyhow!(
                "results/{stem} has {MAX_FOLDERS} runs; give --out or remove some"
            ))
        })
}

/// The folder must exist or be possible to make: writes and removes an empty file in it, or in the nearest folder
/// above it that exists.
fn require_writable(dir: &Path) -> Result<(), Failure> {
    let above = dir
        .ancestors()
        .find(|path| path.exists())
        .unwrap_or(Path::new("."));
    if !above.is_dir() {
        return Err(Failure::User(anyhow!(
            "cannot write results to {}: {} is a file; expected a folder or nothing there, choose another --out",
            dir.display(),
            above.display()
        )));
    }
    let probe = above.join(format!(".raceway-{}", std::process::id()));
    std::fs::File::create_new(&probe)
        .and_then(|_| std::fs::remove_file(&probe))
        .with_context(|| format!("cannot write results to {}; choose another --out", dir.display()))?;
    Ok(())
}

/// Tables that a run may write, and other files with a name of their own.
const TABLES: [&str; 10] = [
    REDUCTION_FILE,
    "balls.csv",
    "shaft.csv",
    "energy.csv",
    "cage.csv",
    "probes.csv",
    "profiles.csv",
    "modes.csv",
    SEAT_TABLES[0],
    SEAT_TABLES[1],
];

/// Makes the folder `dir` and locks it. What a run left there that ended before its first step is removed.
pub fn prepare(dir: &Path) -> Result<FolderLock, Failure> {
    make_asked_folder(dir)?;
    let lock = FolderLock::acquire(dir)?;
    if clear_unfinished_start(&lock, &TABLES)? {
        print::note(format_args!(
            "note: the run in {} ended before its first step; it is started anew",
            dir.display()
        ));
    }
    Ok(lock)
}

fn require_no_results(
    dir: &Path,
    is_unfinished: impl Fn(&Path) -> Result<bool, CheckpointError>,
) -> Result<(), Failure> {
    if !dir.exists() || is_unfinished(dir)? && !dir.join(SUMMARY_FILE).exists() {
        return Ok(());
    }
    let file = RESULT_FILES
        .iter()
        .find(|name| dir.join(name).exists())
        .map(|name| name.to_string());
    let step = checkpoint::committed_steps(dir)?
        .first()
        .map(|&step| checkpoint::step_file_name(step));
    match file.or(step) {
        None => Ok(()),
        Some(name) => Err(Failure::User(anyhow!(
            "{} already holds results of a run ({name}); choose another --out or remove them",
            dir.display()
        ))),
    }
}

/// Removes the files of the end of a run. What they say is not true any more until it ends again, or gets to its next
/// state.
pub(crate) fn remove_outdated(dir: &Path) -> anyhow::Result<()> {
    remove_old(dir, SUMMARY_FILE)?;
    remove_old(dir, REDUCTION_FILE)
}

/// Removes the summary of a list of bearings whose run goes on, for the same reason.
pub fn remove_list_summary(dir: &Path) -> anyhow::Result<()> {
    remove_old(dir, SUMMARY_FILE)
}

fn remove_old(dir: &Path, name: &str) -> anyhow::Result<()> {
    match std::fs::remove_file(dir.join(name)) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(anyhow!("cannot remove the old {name}: {error}"))
        }
        _ => Ok(()),
    }
}

/// Says what the mesh file was before it was written again, if it was.
pub(crate) fn note_restored(fault: Option<&str>, dir: &Path) {
    if let Some(fault) = fault {
        print::note(format_args!(
            "note: mesh.hdf was {fault} in {} and is written again",
            dir.display()
        ));
    }
}

/// Names the folder of what a run wrote after the step that it goes on from, if it wrote any.
pub(crate) fn note_superseded(folder: Option<&Path>, step: u64) {
    if let Some(folder) = folder {
        print::note(format_args!(
            "what the run wrote after step {step} is kept in {}",
            folder.display()
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: `plot` of a folder would show an old run without a word on the later one, or call another folder one.
    #[test]
    fn later_runs_of_a_default_folder_are_found() {
        let root = tempfile::tempdir().unwrap();
        for name in ["a", "a-2", "a-3", "a-5", "b-7"] {
            let dir = root.path().join(name);
            std::fs::create_dir(&dir).unwrap();
            std::fs::write(dir.join(SUMMARY_FILE), "{}").unwrap();
        }
        let later =
            |name: &str| later(&root.path().join(name)).map(|dir| dir.file_name().unwrap().to_owned());
        assert_eq!(later("a"), Some("a-3".into()));
        assert_eq!(later("a-2"), Some("a-3".into()));
        assert_eq!(later("a-3"), None);
        assert_eq!(later("b-7"), None);
        assert_eq!(earlier(&root.path().join("a-2")), Some(root.path().join("a")));
        assert_eq!(earlier(&root.path().join("a")), None);
    }
}
