//! Files that grow beside the steps, such as the tables of a run, and how the steps vouch for them.
//!
//! A step holds length and CRC-32 of each of them as it was when the step was handed over. Whether its start is
//! still what the run wrote can be told at any time, and a run that resumes knows where to cut. Cost: one pass
//! over what is written.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use crc32fast::Hasher;

use crate::error::CheckpointError;
use crate::regular;

/// Length and checksum of the start of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileStamp {
    /// Bytes from the start.
    pub length: u64,
    /// Their CRC-32.
    pub crc: u32,
}

/// Stamps by the name of the file.
pub type Stamps = BTreeMap<String, FileStamp>;

/// A file open for appending that knows its own stamp.
#[derive(Debug)]
pub struct GrowingFile {
    path: PathBuf,
    file: File,
    hasher: Hasher,
    length: u64,
}

impl GrowingFile {
    /// Makes an empty file; there must be nothing of this name, not even a link.
    pub fn create(path: &Path) -> Result<GrowingFile, CheckpointError> {
        let file = File::create_new(path).map_err(CheckpointError::io("create", path))?;
        Ok(GrowingFile {
            path: path.to_path_buf(),
            file,
            hasher: Hasher::new(),
            length: 0,
        })
    }

    /// Goes on behind the start of a file that `start` tells of; what follows it is cut off.
    pub fn reopen(path: &Path, start: FileStamp) -> Result<GrowingFile, CheckpointError> {
        let open = || {
            regular::require_no_link(path)?;
            let file = OpenOptions::new().append(true).open(path)?;
            if file.metadata()?.len() > start.length {
                file.set_len(start.length)?;
                file.sync_all()?;
            }
            Ok(file)
        };
        Ok(GrowingFile {
            path: path.to_path_buf(),
            file: open().map_err(CheckpointError::io("write", path))?,
            hasher: Hasher::new_with_initial_len(start.crc, start.length),
            length: start.length,
        })
    }

    /// What has been written so far.
    pub fn stamp(&self) -> FileStamp {
        FileStamp {
            length: self.length,
            crc: self.hasher.clone().finalize(),
        }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file itself, for a thread that brings it to the disk.
    pub fn handle(&self) -> Result<File, CheckpointError> {
        let file = self.file.try_clone();
        file.map_err(CheckpointError::io("write", &self.path))
    }
}

impl Write for GrowingFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let n = self.file.write(bytes)?;
        self.hasher.update(&bytes[..n]);
        self.length += n as u64;
        Ok(n)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file.flush()
    }
}

/// The stamp of the first `length` bytes of a file, or of all if it has fewer.
pub fn start_of(path: &Path, length: u64) -> Result<FileStamp, CheckpointError> {
    let sum = || {
        let mut file = regular::open(path)?.take(length);
        let (mut hasher, mut block, mut length) = (Hasher::new(), vec![0; 1 << 16], 0);
        loop {
            match file.read(&mut block)? {
                0 => break,
                n => {
                    hasher.update(&block[..n]);
                    length += n as u64;
                }
            }
        }
        let crc = hasher.finalize();
        Ok(FileStamp { length, crc })
    };
    sum().map_err(CheckpointError::io("read", path))
}

/// Stamps as a step file holds them: a line `CRC LENGTH NAME` per file.
pub(crate) fn stamps_text(stamps: &Stamps) -> String {
    let line = |(name, stamp): (&String, &FileStamp)| format!("{:08x} {} {name}", stamp.crc, stamp.length);
    stamps.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// The stamps of such a text; None if it is no such text.
pub(crate) fn parse_stamps(text: &str) -> Option<Stamps> {
    let stamp = |line: &str| {
        let mut words = line.splitn(3, ' ');
        let crc = u32::from_str_radix(words.next()?, 16).ok()?;
        let length = words.next()?.parse().ok()?;
        Some((words.next()?.to_string(), FileStamp { length, crc }))
    };
    text.lines().map(stamp).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a table that was continued would not have the checksum of one written at once.
    #[test]
    fn a_file_written_in_parts_has_the_stamp_of_the_whole() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("t.csv");
        let mut file = GrowingFile::create(&path).unwrap();
        file.write_all(b"step,x\n0,1.5\n").unwrap();
        let first = file.stamp();
        file.write_all(b"1,2.5\n").unwrap();
        drop(file);
        assert_eq!(start_of(&path, first.length).unwrap(), first);
        let mut file = GrowingFile::reopen(&path, first).unwrap();
        file.write_all(b"1,3.5\n").unwrap();
        assert_eq!(start_of(&path, u64::MAX).unwrap(), file.stamp());
        assert_eq!(std::fs::read(&path).unwrap(), b"step,x\n0,1.5\n1,3.5\n");
        let stamps = Stamps::from([("t.csv".to_string(), first)]);
        assert_eq!(parse_stamps(&stamps_text(&stamps)), Some(stamps));
        assert_eq!(parse_stamps("12 t.csv"), None);
    }

    /// Wrong: a link in the place of a table would lead a run to write over another file.
    #[test]
    fn nothing_is_written_through_a_link() {
        let dir = tempfile::tempdir().unwrap();
        let (other, link) = (dir.path().join("other"), dir.path().join("t.csv"));
        std::fs::write(&other, "mine").unwrap();
        std::os::unix::fs::symlink(&other, &link).unwrap();
        let text = GrowingFile::create(&link).unwrap_err().to_string();
        assert!(text.starts_with("cannot create "), "{text}");
        let start = start_of(&other, 2).unwrap();
        let text = format!("{:?}", GrowingFile::reopen(&link, start).unwrap_err());
        assert!(
            text.contains("it is a link, and nothing is written through one"),
            "{text}"
        );
        assert_eq!(std::fs::read(&other).unwrap(), b"mine");
    }
}
