//! Writing a step before it is committed: what needs no knowledge of the steps before it but the number of the last.
//!
//! So a thread can write a step while another brings the one before to the disk.

use std::collections::BTreeMap;
use std::path::PathBuf;

use crate::atomic::Unsealed;
use crate::error::CheckpointError;
use crate::mesh_file::MeshFile;
use crate::names::step_file_name;
use crate::point_table::{PointTable, write_table};
use crate::record::StepRecord;
use crate::step::{StepOrigin, write_step_file};
use crate::storage::Storage;

/// What the step files of a run have in common.
#[derive(Clone, Debug)]
pub(crate) struct StepWriter {
    pub dir: PathBuf,
    pub storage: Storage,
    pub n_points: usize,
    pub n_cells: usize,
    pub mesh_hash: String,
    pub run: Option<String>,
    pub about: BTreeMap<String, String>,
}

/// A step whose file is written, without a name yet.
#[derive(Debug)]
pub(crate) struct WrittenStep {
    pub file: Unsealed,
    pub step: u64,
    /// s.
    pub time: f64,
}

impl StepWriter {
    /// Of the steps of a mesh in a folder.
    pub fn new(dir: PathBuf, mesh: &MeshFile, storage: Storage) -> StepWriter {
        StepWriter {
            dir,
            storage,
            n_points: mesh.n_points,
            n_cells: mesh.n_cells,
            mesh_hash: mesh.hash.clone(),
            run: mesh.run.clone(),
            about: BTreeMap::new(),
        }
    }

    /// Writes a step that follows `last`, number and time, s.
    pub fn write(
        &self,
        record: &StepRecord,
        last: Option<(u64, f64)>,
    ) -> Result<WrittenStep, CheckpointError> {
        record.validate(self.n_points, self.n_cells)?;
        let (step, time) = (record.step, record.time);
        if let Some((last, last_time)) = last
            && (step <= last || time <= last_time)
        {
            return Err(CheckpointError::StepOrder {
                step,
                time,
                last,
                last_time,
            });
        }
        let name = step_file_name(step);
        let file = write_step_file(&self.dir, &name, record, &self.origin(), self.storage)?;
        Ok(WrittenStep { file, step, time })
    }

    /// Writes fields of the run as a whole, as a file that gets its name later: its name, and the step up to which it
    /// knows the run. Its precision is that of stress.
    pub fn write_table(&self, named: (&str, u64), table: &PointTable) -> Result<Unsealed, CheckpointError> {
        let written = (&self.origin(), self.storage.stress);
        write_table(&self.dir, named, table, self.n_points, written)
    }

    /// What the files of the run say about it.
    pub fn origin(&self) -> StepOrigin<'_> {
        StepOrigin {
            program_version: env!("CARGO_PKG_VERSION"),
            mesh_hash: &self.mesh_hash,
            run: self.run.as_deref(),
            about: &self.about,
        }
    }
}
