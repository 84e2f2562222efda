//! Where something was found.

use std::fmt;
use std::path::{Path, PathBuf};

/// A line of a file, or a file, and what is there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// Path from the root.
    pub path: PathBuf,
    /// Line from 1; the whole file, if absent.
    pub line: Option<usize>,
    /// What is there.
    pub text: String,
}

impl Place {
    /// A whole file.
    pub fn of_file(path: &Path, text: String) -> Place {
        Place {
            path: path.to_path_buf(),
            line: None,
            text,
        }
    }

    /// A line of a file.
    pub fn of_line(path: &Path, line: usize, text: String) -> Place {
        Place {
            line: Some(line),
            ..Place::of_file(path, text)
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "{}:{line}: {}", self.path.display(), self.text),
            None => write!(f, "{}: {}", self.path.display(), self.text),
        }
    }
}
