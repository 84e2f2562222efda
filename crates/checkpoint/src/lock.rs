//! The right to write into a result folder, which one process has at a time.
//!
//! It is an advisory lock of the operating system (`flock`) on the file `.raceway.lock`, so it ends with its process,
//! however that ends. The file holds a line about the owner while the lock is held and is empty otherwise; a line
//! without a lock is left by a process that died. The file stays: removing it would let two processes lock two
//! files of the same name.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::error::CheckpointError;

/// Name of the file in the result folder.
const LOCK_FILE: &str = ".raceway.lock";

/// A held lock; it ends when this is dropped.
#[derive(Debug)]
pub struct FolderLock {
    dir: PathBuf,
    file: File,
    dead_owner: Option<String>,
}

impl FolderLock {
    /// Takes the lock of the folder `dir`, or says who has it.
    pub fn acquire(dir: &Path) -> Result<FolderLock, CheckpointError> {
        let path = dir.join(LOCK_FILE);
        let mut file = open_lock(&path)?;
        let locked = file.try_lock();
        let mut owner = String::new();
        file.read_to_string(&mut owner)
            .map_err(CheckpointError::io("read", &path))?;
        let owner = owner.trim().to_string();
        match locked {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let path = dir.to_path_buf();
                return Err(CheckpointError::Locked { path, owner });
            }
            Err(TryLockError::Error(source)) => return Err(not_locked(&path, source)),
        }
        let text = format!("process {} on {}\n", std::process::id(), host());
        rewrite(&mut file, &text).map_err(CheckpointError::io("write", &path))?;
        Ok(FolderLock {
            dir: dir.to_path_buf(),
            file,
            dead_owner: (!owner.is_empty()).then_some(owner),
        })
    }

    /// The folder.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Who had the lock and died with it.
    pub fn dead_owner(&self) -> Option<&str> {
        self.dead_owner.as_deref()
    }
}

/// Opens a file that is locked, or makes it. A link is not followed.
pub fn open_lock(path: &Path) -> Result<File, CheckpointError> {
    require_plain(path)?;
    let mut options = OpenOptions::new();
    let opened = options.read(true).write(true).create(true).truncate(false);
    opened.open(path).map_err(|error| {
        let source = match may_not_write(&error) {
            true => {
                let advice = "the command writes into this folder; copy it to where you may write";
                std::io::Error::new(error.kind(), format!("{error}; {advice}"))
            }
            false => error,
        };
        CheckpointError::io("open the lock", path)(source)
    })
}

/// Whether a place may not be written to, so that another one is the way out.
pub fn may_not_write(error: &std::io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem
    )
}

/// Fails if the lock is a link or a pipe: what is written into it would go elsewhere.
fn require_plain(path: &Path) -> Result<(), CheckpointError> {
    if path.symlink_metadata().is_ok_and(|data| !data.is_file()) {
        let what = "it is no plain file; remove it if no run is writing here";
        let source = std::io::Error::new(ErrorKind::InvalidInput, what);
        return Err(CheckpointError::io("open the lock", path)(source));
    }
    Ok(())
}

/// Who writes to the folder `dir` now; changes nothing.
pub fn writer(dir: &Path) -> Result<Option<String>, CheckpointError> {
    let path = dir.join(LOCK_FILE);
    if !path.exists() {
        return Ok(None);
    }
    require_plain(&path)?;
    let mut file = File::open(&path).map_err(CheckpointError::io("read", &path))?;
    match file.try_lock_shared() {
        Ok(()) => Ok(None),
        Err(TryLockError::WouldBlock) => {
            let mut owner = String::new();
            file.read_to_string(&mut owner)
                .map_err(CheckpointError::io("read", &path))?;
            Ok(Some(owner.trim().to_string()))
        }
        Err(TryLockError::Error(source)) => Err(not_locked(&path, source)),
    }
}

/// That a file is not locked, and what to do where its file system knows no locks.
fn not_locked(path: &Path, source: std::io::Error) -> CheckpointError {
    let source = match source.kind() {
        ErrorKind::Unsupported => {
            let advice = "the file system knows no locks (flock), which keep two runs out of one folder; have it \
                          mounted with them (Lustre: -o flock), or write to another one";
            std::io::Error::new(source.kind(), format!("{source}; {advice}"))
        }
        _ => source,
    };
    CheckpointError::io("lock", path)(source)
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        // If this fails the next owner reports a dead one, which is harmless.
        let _ = self.file.set_len(0);
    }
}

fn rewrite(file: &mut File, text: &str) -> std::io::Result<()> {
    file.set_len(0)?;
    file.seek(SeekFrom::Start(0))?;
    file.write_all(text.as_bytes())
}

/// Name of this machine, as far as the system tells.
fn host() -> String {
    std::fs::read_to_string("/proc/sys/kernel/hostname")
        .map_or_else(|_| "this machine".to_string(), |name| name.trim().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: who writes to a file system without locks would read a number of the system and not what to do.
    #[test]
    fn a_file_system_without_locks_is_named() {
        let told = |kind: ErrorKind| not_locked(Path::new("run/.lock"), kind.into()).to_string();
        let text = told(ErrorKind::Unsupported);
        let advice = "the file system knows no locks (flock), which keep two runs out of one folder; have it mounted \
                      with them (Lustre: -o flock), or write to another one";
        assert!(
            text.starts_with("cannot lock run/.lock: ") && text.ends_with(advice),
            "{text}"
        );
        assert!(!told(ErrorKind::PermissionDenied).contains("flock"));
    }
}
