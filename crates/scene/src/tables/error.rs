//! What can be wrong with a scene file.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why there is no scene.
#[derive(Debug, Error)]
pub enum SceneError {
    /// The file cannot be read.
    #[error("cannot read the scene {}: {reason}", path.display())]
    Unreadable {
        /// The scene file.
        path: PathBuf,
        /// That of the system, or what is there instead of a scene.
        reason: String,
    },
    /// A `--set` argument is not `path=value`, or its path leads nowhere.
    #[error("--set {argument:?}: {reason}")]
    Override {
        /// The argument.
        argument: String,
        /// What is wrong with it, and what was expected.
        reason: String,
    },
    /// The text is not TOML, or a key or value is not of the scene format.
    #[error("{}:{line}:{column}: {message}{}\n{excerpt}", path.display(), overridden(overrides))]
    Format {
        /// The scene file.
        path: PathBuf,
        /// The `--set` arguments that were applied to the text.
        overrides: Vec<String>,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// Key, value, what was expected.
        message: String,
        /// The line itself with a mark below.
        excerpt: String,
    },
    /// A list of bearings where one is expected.
    #[error(
        "{} has a list of bearings on one shaft, which this command does not take yet; expected one table [bearing]. \
         Lists are for raceway run, resume, check, mesh, info, export, stiffness, campbell, plot and report",
        path.display()
    )]
    Several {
        /// The scene file.
        path: PathBuf,
    },
    /// Values that make no sense, all of them.
    #[error("{}{} has {}", path.display(), overridden(overrides), list(problems))]
    Invalid {
        /// The scene file.
        path: PathBuf,
        /// The `--set` arguments that were applied to the text.
        overrides: Vec<String>,
        /// One per entry: key, value, what was expected.
        problems: Vec<String>,
    },
}

impl SceneError {
    /// A file that cannot be read, in other words than the system's where they say more.
    pub(super) fn unreadable(path: &Path, error: &io::Error) -> SceneError {
        let reason = match error.kind() {
            io::ErrorKind::InvalidData => "it is no text in UTF-8; expected a scene, saved as UTF-8".into(),
            io::ErrorKind::IsADirectory => "it is a folder; expected a scene file".into(),
            _ => error.to_string(),
        };
        SceneError::Unreadable {
            path: path.to_path_buf(),
            reason,
        }
    }
}

/// Says that the text is not quite that of the file.
fn overridden(overrides: &[String]) -> String {
    if overrides.is_empty() {
        return String::new();
    }
    let arguments: Vec<String> = overrides.iter().map(|o| format!("--set {o:?}")).collect();
    format!(" (with {})", arguments.join(" "))
}

fn list(problems: &[String]) -> String {
    match problems {
        [one] => format!("a problem: {one}"),
        many => format!("{} problems:\n  {}", many.len(), many.join("\n  ")),
    }
}
