//! What can go wrong when results are written or read.

use std::io;
use std::path::{Path, PathBuf};

/// An error of this crate.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// The folder for a new run is not free.
    #[error(
        "folder {} already holds results ({found}); choose another output folder, resume this run, or move the \
         old results away", path.display()
    )]
    ResultsPresent {
        /// The folder.
        path: PathBuf,
        /// What was found there.
        found: String,
    },
    /// The folder to resume or index holds no step.
    #[error("folder {} holds no committed step; expected files named step_000000.hdf and so on", path.display())]
    NoSteps {
        /// The folder.
        path: PathBuf,
    },
    /// The folder to resume holds steps, but no state.
    #[error("no step in folder {} holds a restart state; run the scene again", path.display())]
    NoState {
        /// The folder.
        path: PathBuf,
    },
    /// The step asked for is not there.
    #[error("folder {} has no step {step}; committed steps are {}", path.display(), range_and_nearest(steps, *step))]
    UnknownStep {
        /// The folder.
        path: PathBuf,
        /// The step asked for.
        step: u64,
        /// Numbers of the steps that are there, growing; at least one.
        steps: Vec<u64>,
    },
    /// Another process writes to the folder.
    #[error("{owner} is writing to folder {}; wait until it ends, or stop it", path.display())]
    Locked {
        /// The folder.
        path: PathBuf,
        /// The owner of the lock: process and machine.
        owner: String,
    },
    /// The operating system refused.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// What was tried: "write", "create folder", ...
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// The HDF5 library refused.
    #[error("cannot {action} {}: {cause}", path.display())]
    Hdf {
        /// What was tried: "write" or "read".
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// Innermost message of the library.
        cause: String,
    },
    /// A data set does not hold what was written.
    #[error(
        "data set {dataset} of {} is damaged: its checksum is {found:08x} and {expected:08x} was written; {}",
        path.display(), FileKind::of(path).advice()
    )]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Path of the data set inside the file.
        dataset: String,
        /// Checksum that was written.
        expected: u32,
        /// Checksum of what was read.
        found: u32,
    },
    /// A file is readable HDF5 but not what this crate writes.
    #[error("{} is {}: {what}; {}", path.display(), FileKind::of(path).refused(), FileKind::of(path).advice())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is missing or unexpected.
        what: String,
    },
    /// A field has the wrong number of points or cells.
    #[error("field {field} of step {step} has {found} {rows}, the mesh has {expected}")]
    FieldLength {
        /// Name of the field.
        field: &'static str,
        /// The step.
        step: u64,
        /// "points" or "cells".
        rows: &'static str,
        /// Points or cells of the mesh.
        expected: usize,
        /// Points or cells of the field.
        found: usize,
    },
    /// A field of the whole run has the wrong number of points.
    #[error("field {field} has {found} points, the mesh has {expected}")]
    TableLength {
        /// Name of the field.
        field: String,
        /// Points of the mesh.
        expected: usize,
        /// Points of the field.
        found: usize,
    },
    /// Steps must be written in order.
    #[error("step {step} at {time} s cannot follow step {last} at {last_time} s; both numbers must grow")]
    StepOrder {
        /// The refused step.
        step: u64,
        /// Its time, s.
        time: f64,
        /// Last committed step.
        last: u64,
        /// Its time, s.
        last_time: f64,
    },
    /// A step without a place on the time axis.
    #[error("step {step} has the time {time} s; expected a finite number")]
    Time {
        /// The step.
        step: u64,
        /// Its time, s.
        time: f64,
    },
    /// The run to resume was made with another mesh.
    #[error("{} was made with mesh {found}, this run has mesh {expected}; resume with the scene and meshes of that \
             run", path.display())]
    MeshMismatch {
        /// The file.
        path: PathBuf,
        /// Fingerprint of the bodies given.
        expected: String,
        /// Fingerprint in the file.
        found: String,
    },
    /// A step that was put into the folder of another run.
    #[error(
        "{} is a step of another run, {found}; the run in its folder is {expected}; move it away", path.display()
    )]
    OtherRun {
        /// The file.
        path: PathBuf,
        /// Identity of the run in the folder.
        expected: String,
        /// Identity in the file.
        found: String,
    },
    /// A body cannot be drawn.
    #[error("body \"{body}\": {what}")]
    Body {
        /// Name of the body.
        body: String,
        /// What is wrong and what was expected.
        what: String,
    },
    /// A name or text HDF5 cannot hold.
    #[error("cannot store {what} {text:?}: {reason}")]
    Text {
        /// What the text is.
        what: &'static str,
        /// The text, shortened.
        text: String,
        /// What was expected.
        reason: &'static str,
    },
    /// The thread that writes ended early, and the caller went on.
    #[error("no step can be written after a failed one; the first error was reported by an earlier call")]
    WriterStopped,
}

impl CheckpointError {
    /// Of a step that is not among the `steps` of a folder, which grow.
    pub fn unknown_step(path: &Path, step: u64, steps: Vec<u64>) -> CheckpointError {
        let path = path.to_path_buf();
        match steps.is_empty() {
            true => CheckpointError::NoSteps { path },
            false => CheckpointError::UnknownStep { path, step, steps },
        }
    }

    /// For `map_err` after calls of the operating system.
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self + use<> {
        let path = path.to_path_buf();
        move |source| CheckpointError::Io { action, path, source }
    }

    /// For `map_err` after calls of the HDF5 library.
    pub(crate) fn hdf(action: &'static str, path: &Path) -> impl FnOnce(hdf5::Error) -> Self + use<> {
        let path = path.to_path_buf();
        move |error| CheckpointError::Hdf {
            action,
            path,
            cause: innermost_cause(&error),
        }
    }

    /// A step file that lacks something.
    pub(crate) fn malformed(path: &Path, what: impl Into<String>) -> Self {
        CheckpointError::Malformed {
            path: path.to_path_buf(),
            what: what.into(),
        }
    }
}

/// First and last of some growing numbers, and those next to one that is not among them.
fn range_and_nearest(steps: &[u64], step: u64) -> String {
    let at = steps.partition_point(|&there| there < step);
    let ends = [steps.first(), steps.last()].map(|end| end.copied().unwrap_or_default());
    let range = format!("{} to {}", ends[0], ends[1]);
    match (
        at.checked_sub(1).and_then(|before| steps.get(before)),
        steps.get(at),
    ) {
        (Some(before), Some(after)) => format!("{range}, the nearest are {before} and {after}"),
        (Some(one), None) | (None, Some(one)) => format!("{range}, the nearest is {one}"),
        (None, None) => range,
    }
}

/// The library's outer messages only say that something failed; the operating system's reason, if there is one,
/// stands in the innermost frame as `error message = '...'`.
fn innermost_cause(error: &hdf5::Error) -> String {
    let Some(stack) = error.stack() else {
        return error.to_string();
    };
    for frame in stack.iter().rev() {
        if let Some((_, rest)) = frame.desc().split_once("error message = '")
            && let Some((reason, _)) = rest.split_once('\'')
        {
            return reason.to_string();
        }
    }
    stack
        .last()
        .map_or_else(|| error.to_string(), |frame| frame.desc().to_string())
}

/// What a file is by its name.
#[derive(Clone, Copy, PartialEq, Eq)]
enum FileKind {
    Mesh,
    Step,
    Pack,
    Other,
}

impl FileKind {
    fn of(path: &Path) -> FileKind {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        match &*name {
            MESH_FILE => FileKind::Mesh,
            name if name.starts_with("step_") => FileKind::Step,
            name if name.starts_with("pack_") => FileKind::Pack,
            _ => FileKind::Other,
        }
    }

    /// What a file of this kind is not.
    fn refused(self) -> &'static str {
        match self {
            FileKind::Mesh => "not a complete mesh of results",
            FileKind::Step => "not a complete step file",
            FileKind::Pack => "not a complete pack of steps",
            FileKind::Other => "no file of results",
        }
    }

    /// What to do about damage.
    fn advice(self) -> &'static str {
        match self {
            FileKind::Mesh => {
                "raceway resume writes it again; results that cannot be resumed are to be computed again"
            }
            FileKind::Step => "use an earlier step",
            FileKind::Pack => "use steps outside of it",
            FileKind::Other => "expected mesh.hdf, step_*.hdf or pack_*.hdf as raceway writes them",
        }
    }
}

/// Name of the mesh in a result folder.
pub const MESH_FILE: &str = "mesh.hdf";
