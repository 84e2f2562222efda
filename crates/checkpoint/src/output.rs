//! The result folder of one run: created, filled step by step, resumed.
//!
//! A step is committed when its file has its final name; the file is complete and on the disk by then. A run
//! killed at any instant loses at most the step it was writing. Committed steps are never rewritten: a run that
//! resumes from an earlier step moves the later ones into a folder `superseded_N` beside them.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::body::Body;
use crate::error::CheckpointError;
use crate::folder::{
    committed_steps, move_aside, note_first_step, note_start, remove_if_present, remove_leftovers,
    require_no_results, sound_steps,
};
use crate::index::{Views, rebuild_index};
use crate::lock::FolderLock;
use crate::mesh_file::{MESH_FILE, MeshFile, read_mesh, require_same_mesh};
use crate::names::{INDEX_FILE, step_file_name};
use crate::point_table::PointTable;
use crate::record::{StepRecord, require_texts};
use crate::series::write_series;
use crate::step::read_about;
use crate::step_writer::{StepWriter, WrittenStep};
use crate::storage::Storage;

/// A result folder open for writing; it is locked against other processes.
#[derive(Debug)]
pub struct Output {
    lock: FolderLock,
    writer: StepWriter,
    /// Number and time, s, of the committed steps, growing.
    steps: Vec<(u64, f64)>,
}

/// A folder opened to go on with a run, and what became of the steps that are not part of it any more.
#[derive(Debug)]
pub struct Resumed {
    /// The folder.
    pub output: Output,
    /// The folder into which later steps were moved.
    pub superseded: Option<PathBuf>,
    /// Earlier steps that are damaged: they stay where they are, but out of the views.
    pub damaged: Vec<CheckpointError>,
    /// What was wrong with `mesh.hdf`, if it has been written again: "missing" or "damaged".
    pub mesh_restored: Option<&'static str>,
}

/// Writes `mesh.hdf` again when it is missing or damaged and the step to resume from is of this mesh. Says
/// what was wrong.
fn restore_mesh(dir: &Path, mesh: &MeshFile, step: u64) -> Result<Option<&'static str>, CheckpointError> {
    let fault = match (dir.join(MESH_FILE).exists(), read_mesh(dir)) {
        (true, Ok(_)) => return Ok(None),
        (true, Err(_)) => "damaged",
        (false, _) => "missing",
    };
    let path = dir.join(step_file_name(step));
    let (expected, found) = (mesh.hash.clone(), read_about(&path)?["mesh_hash"].clone());
    if expected != found {
        return Err(CheckpointError::MeshMismatch {
            path,
            expected,
            found,
        });
    }
    mesh.write(dir)?;
    Ok(Some(fault))
}

impl Output {
    /// Creates the folder `dir` (and its parents), locks it and writes the mesh. A folder that already holds results
    /// is refused; other files in it do not matter.
    pub fn create(dir: &Path, bodies: &[Body], storage: Storage) -> Result<Output, CheckpointError> {
        Output::create_of(dir, &MeshFile::new(bodies)?, storage)
    }

    /// The same of a mesh file that was prepared.
    pub fn create_of(dir: &Path, mesh: &MeshFile, storage: Storage) -> Result<Output, CheckpointError> {
        fs::create_dir_all(dir).map_err(CheckpointError::io("create folder", dir))?;
        Output::create_in(FolderLock::acquire(dir)?, mesh, storage)
    }

    /// The same in a folder that is there and locked.
    pub fn create_in(lock: FolderLock, mesh: &MeshFile, storage: Storage) -> Result<Output, CheckpointError> {
        let dir = lock.dir();
        require_no_results(dir)?;
        remove_leftovers(dir)?;
        note_start(dir)?;
        mesh.write(dir)?;
        Ok(Output::new(lock, mesh, storage, Vec::new()))
    }

    /// Opens the locked folder of an earlier run of the same bodies to continue after its committed step `last`. Later
    /// steps are moved aside, leftovers of an interrupted write are removed. Only names, structure and times of the
    /// steps are read here: read the step to continue from with [`crate::read_step`] first, which verifies it.
    pub fn resume(
        lock: FolderLock,
        bodies: &[Body],
        storage: Storage,
        last: u64,
    ) -> Result<Resumed, CheckpointError> {
        Output::resume_of(lock, &MeshFile::new(bodies)?, storage, last)
    }

    /// The same of a mesh file that was prepared.
    pub fn resume_of(
        lock: FolderLock,
        mesh: &MeshFile,
        storage: Storage,
        last: u64,
    ) -> Result<Resumed, CheckpointError> {
        let dir = lock.dir().to_path_buf();
        let mut steps = committed_steps(&dir)?;
        if !steps.contains(&last) {
            return Err(CheckpointError::unknown_step(&dir, last, steps));
        }
        let mesh_restored = restore_mesh(&dir, mesh, last)?;
        require_same_mesh(&dir, mesh)?;
        let later = steps.split_off(steps.partition_point(|&step| step <= last));
        let (steps, mut damaged) = sound_steps(&dir, &steps);
        if steps.last().is_none_or(|&(step, _)| step != last) {
            return Err(damaged.pop().expect("a step that is not sound is damaged"));
        }
        remove_leftovers(&dir)?;
        // The views first: a view may for a moment list too little, never what is not there.
        write_series(&dir, &steps)?;
        remove_if_present(&dir.join(INDEX_FILE))?;
        let superseded = move_aside(&dir, &later)?;
        Ok(Resumed {
            output: Output::new(lock, mesh, storage, steps),
            superseded,
            damaged,
            mesh_restored,
        })
    }

    fn new(lock: FolderLock, mesh: &MeshFile, storage: Storage, steps: Vec<(u64, f64)>) -> Output {
        let writer = StepWriter::new(lock.dir().to_path_buf(), mesh, storage);
        Output { lock, writer, steps }
    }

    /// Sets the texts that every step from now on holds about its run, by name (letters, digits, `_`), besides the
    /// scene: where things came from. [`crate::read_about`] reads them.
    pub fn describe(&mut self, about: BTreeMap<String, String>) -> Result<(), CheckpointError> {
        require_texts(&about)?;
        self.writer.about = about;
        Ok(())
    }

    /// Writes one step and returns the path of its file. When this returns, the step survives a crash. Steps and
    /// times must grow.
    pub fn write_step(&mut self, record: &StepRecord) -> Result<PathBuf, CheckpointError> {
        let written = self.writer.write(record, self.last_step())?;
        self.commit(written)
    }

    /// Brings a step to the disk that follows the last one, and names it.
    pub(crate) fn commit(&mut self, written: WrittenStep) -> Result<PathBuf, CheckpointError> {
        let WrittenStep { file, step, time } = written;
        file.publish()?;
        let dir = self.lock.dir();
        if self.steps.is_empty() {
            note_first_step(dir)?;
        }
        self.steps.push((step, time));
        write_series(dir, &self.steps)?;
        Ok(dir.join(step_file_name(step)))
    }

    /// Writes steps beside this, which commits them.
    pub(crate) fn step_writer(&self) -> StepWriter {
        self.writer.clone()
    }

    /// Writes fields of the run as a whole as a file `name`, in place of an earlier one. Its precision is that of
    /// stress.
    pub fn write_table(&self, name: &str, table: &PointTable) -> Result<(), CheckpointError> {
        let step = self.last_step().map_or(0, |(step, _)| step);
        self.writer.write_table((name, step), table)?.publish()
    }

    /// Builds the temporal index over all committed steps and returns what it shows; `None` for a run without steps,
    /// which needs none.
    pub fn finish(self) -> Result<Option<Views>, CheckpointError> {
        if self.steps.is_empty() {
            return Ok(None);
        }
        rebuild_index(self.dir()).map(Some)
    }

    /// The result folder.
    pub fn dir(&self) -> &Path {
        self.lock.dir()
    }

    /// The lock of the folder.
    pub fn lock(&self) -> &FolderLock {
        &self.lock
    }

    /// Points of all bodies together; every field over points has this many rows.
    pub fn n_points(&self) -> usize {
        self.writer.n_points
    }

    /// Cells of all bodies together; every field over cells has this many rows.
    pub fn n_cells(&self) -> usize {
        self.writer.n_cells
    }

    /// Fingerprint of the mesh, as stored in every step.
    pub fn mesh_hash(&self) -> &str {
        &self.writer.mesh_hash
    }

    /// Identity of the run, as stored in every file; None if it was not given.
    pub fn run(&self) -> Option<&str> {
        self.writer.run.as_deref()
    }

    /// Number and time, s, of the last committed step.
    pub fn last_step(&self) -> Option<(u64, f64)> {
        self.steps.last().copied()
    }
}
