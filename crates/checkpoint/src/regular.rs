//! Opening files for reading that must be plain files: a pipe in a result folder would be waited for without end.

use std::fs::File;
use std::io::{Error, ErrorKind};
use std::path::Path;

use crate::error::CheckpointError;

/// Opens a plain file for reading. Links are followed; a pipe, a device or a folder is refused.
pub fn open_regular(path: &Path) -> Result<File, CheckpointError> {
    open(path).map_err(CheckpointError::io("read", path))
}

/// Opens a plain file for reading that is to be written to later: a link is refused as well.
pub fn open_own(path: &Path) -> Result<File, CheckpointError> {
    require_no_link(path)
        .and_then(|()| open(path))
        .map_err(CheckpointError::io("read", path))
}

pub(crate) fn require_no_link(path: &Path) -> std::io::Result<()> {
    if !path.symlink_metadata()?.is_symlink() {
        return Ok(());
    }
    let what = "it is a link, and nothing is written through one; put the file itself in its place";
    Err(Error::new(ErrorKind::InvalidInput, what))
}

pub(crate) fn open(path: &Path) -> std::io::Result<File> {
    if std::fs::metadata(path)?.is_file() {
        return File::open(path);
    }
    let what = "it is no plain file; expected one that the run wrote";
    Err(Error::new(ErrorKind::InvalidInput, what))
}
