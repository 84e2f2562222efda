//! `run.log` in the folder of a run: what the command said, from its first line on.
//!
//! Each command that writes into the folder, a run and those that resume it, begins with a line that has the date, the
//! version and the command line, and ends with one that has the exit code.

use std::fs::{File, OpenOptions};
use std::io::{Error, ErrorKind, Read};
use std::path::Path;

use comm::print;
use jiff::Timestamp;

use crate::about::SOURCE_COMMIT;
use crate::failure::Failure;

/// Its name.
pub const LOG_FILE: &str = "run.log";

/// First words of a log.
const HEAD: &str = "# raceway ";

/// From now on all lines are kept; the first says who speaks.
pub fn keep(arguments: &[String]) {
    print::keep_log();
    print::log(format_args!(
        "{HEAD}{} ({SOURCE_COMMIT}), {}: {}",
        env!("CARGO_PKG_VERSION"),
        now(),
        arguments.join(" ")
    ));
}

/// Puts the log into the folder of a run. One that cannot be written is warned of: the run does not need it.
pub fn begin(dir: &Path) {
    let path = dir.join(LOG_FILE);
    if let Err(error) = open(&path).and_then(print::log_to) {
        print::note(format_args!(
            "warning: {} is not written: {error}",
            path.display()
        ));
    }
}

/// Says in the log how the command ended.
pub fn end(failure: Option<&Failure>) {
    let code = failure.map_or(0, Failure::number);
    print::log(format_args!("# exit code {code}, {}", now()));
}

/// A new log, or the end of one that this program has begun.
fn open(path: &Path) -> std::io::Result<File> {
    match OpenOptions::new().append(true).create_new(true).open(path) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
        made => return made,
    }
    let other = || Error::new(ErrorKind::AlreadyExists, "the file there is no log of raceway");
    if !std::fs::symlink_metadata(path)?.is_file() {
        return Err(other());
    }
    let mut head = [0; HEAD.len()];
    let is_log = File::open(path)?.read_exact(&mut head).is_ok() && head == *HEAD.as_bytes();
    match is_log {
        true => OpenOptions::new().append(true).open(path),
        false => Err(other()),
    }
}

/// Date and time, UTC.
fn now() -> String {
    Timestamp::now().strftime("%Y-%m-%d %H:%M:%S UTC").to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a file of the user would be added to, or a log replaced.
    #[test]
    fn only_logs_are_added_to() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join(LOG_FILE);
        assert!(open(&path).is_ok() && path.exists());
        for text in ["", "mine\n"] {
            std::fs::write(&path, text).unwrap();
            assert_eq!(
                open(&path).unwrap_err().to_string(),
                "the file there is no log of raceway"
            );
        }
        std::fs::write(&path, "# raceway 0.1.0 (x), 2026-11-23: raceway run a.toml\n").unwrap();
        assert!(open(&path).is_ok());
        assert!(
            std::fs::read_to_string(&path)
                .unwrap()
                .starts_with("# raceway 0.1.0")
        );
        std::fs::rename(&path, dir.path().join("log")).unwrap();
        std::os::unix::fs::symlink("log", &path).unwrap();
        assert!(open(&path).is_err());
    }
}
