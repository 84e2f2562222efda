//! Many steps in one file, for file systems on which the number of files hurts: `pack_NNNNNN_NNNNNN.hdf`, named after
//! its first and last step.
//!
//! Each step is a group `step_NNNNNN` with the arrays, texts and checksums of its file. `run.vtkhdf` shows packed steps
//! like all others; `run.hdf.series` cannot, it needs a file per step. A pack is sealed and on the disk, and every step
//! in it has been read back, before the first step file is removed; if this is interrupted, steps are there twice, and
//! the file of its own counts. Unpacking gives the same bytes again. The newest steps stay files of their own: a run
//! resumes from those only.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::atomic::{self, Format};
use crate::dataset::{create_group, create_vtkhdf};
use crate::error::CheckpointError;
use crate::folder::{committed_steps, remove_if_present, remove_leftovers, require_run, run_of};
use crate::index::rebuild_index;
use crate::lock::FolderLock;
use crate::names::{group_name, pack_name, step_file_name};
use crate::places::{StepPlace, packs};
use crate::record::StepRecord;
use crate::seal::verify_seal;
use crate::step::{
    StepOrigin, fill_step, has_state, read_mesh_hash, read_record, read_step, read_storage, read_texts,
    read_version, run_of_file, write_step_file,
};
use crate::storage::Storage;

/// A step with all that its file says.
struct WholeStep {
    record: StepRecord,
    program_version: String,
    mesh_hash: String,
    run: Option<String>,
    about: BTreeMap<String, String>,
    storage: Storage,
}

impl WholeStep {
    /// Reads a step of a file whose structure has been verified.
    fn read(place: &StepPlace) -> Result<WholeStep, CheckpointError> {
        let file = place.open()?;
        Ok(WholeStep {
            record: read_record(&file, &place.path)?,
            program_version: read_version(&file)?,
            mesh_hash: read_mesh_hash(&file)?,
            run: run_of_file(&file)?,
            about: read_texts(&file)?,
            storage: read_storage(&file)?,
        })
    }

    fn origin(&self) -> StepOrigin<'_> {
        StepOrigin {
            program_version: &self.program_version,
            mesh_hash: &self.mesh_hash,
            run: self.run.as_deref(),
            about: &self.about,
        }
    }
}

/// Puts all committed steps but the newest `keep` (at least one) into packs of `per_file` steps; the newest step with a
/// state and all after it stay besides, so that the run can go on. Returns how many steps were packed. The run that
/// writes them must have ended: the lock says so.
pub fn pack_steps(lock: &FolderLock, keep: usize, per_file: usize) -> Result<usize, CheckpointError> {
    let dir = lock.dir();
    // What a killed command has left is as large as the steps, and hidden.
    remove_leftovers(dir)?;
    let mut steps = committed_steps(dir)?;
    let most = steps.len().saturating_sub(keep.max(1));
    steps.truncate(most.min(newest_state(dir, &steps).unwrap_or(most)));
    let mut packed = BTreeMap::new();
    for (path, known) in packs(dir)? {
        packed.extend(known.into_iter().map(|step| (step, path.clone())));
    }
    let new: Vec<u64> = steps
        .iter()
        .copied()
        .filter(|step| !packed.contains_key(step))
        .collect();
    for chunk in new.chunks(per_file.max(1)) {
        let path = write_pack(dir, chunk)?;
        packed.extend(chunk.iter().map(|&step| (step, path.clone())));
    }
    // All is read back before the first file goes.
    for step in &steps {
        read_record(&StepPlace::packed(&packed[step], *step).open()?, &packed[step])?;
    }
    for &step in &steps {
        let hidden = dir.join(format!(".{}.tmp", step_file_name(step)));
        // Out of sight first: the views are built over what stays.
        fs::rename(dir.join(step_file_name(step)), &hidden)
            .map_err(CheckpointError::io("remove", &hidden))?;
    }
    rebuild_index(dir)?;
    for &step in &steps {
        remove_if_present(&dir.join(format!(".{}.tmp", step_file_name(step))))?;
    }
    atomic::sync_dir(dir)?;
    Ok(steps.len())
}

/// StepPlace among `steps` of the newest with a state. A damaged one has none to go on from.
fn newest_state(dir: &Path, steps: &[u64]) -> Option<usize> {
    let has_state = |&step: &u64| has_state(&dir.join(step_file_name(step))).unwrap_or(false);
    steps.iter().rposition(has_state)
}

/// Writes a new pack of these steps, every byte of which is verified before and after.
fn write_pack(dir: &Path, steps: &[u64]) -> Result<PathBuf, CheckpointError> {
    let name = pack_name(steps[0], steps[steps.len() - 1]);
    let path = dir.join(&name);
    let (mut failure, run) = (None, run_of(dir)?);
    let written = atomic::write_hdf(dir, &name, Format::Earliest, |file| {
        let mut contents = Vec::new();
        for &step in steps {
            let place = StepPlace::single(dir, step);
            let whole = verify_seal(&place.path)
                .and_then(|()| require_run(&place.path, run.as_deref()))
                .and_then(|()| WholeStep::read(&place));
            let whole = match whole {
                Ok(whole) => whole,
                Err(error) => {
                    let text = error.to_string();
                    failure = Some(error);
                    return Err(text.into());
                }
            };
            let group = create_group(file, &group_name(step))?;
            create_vtkhdf(&group, [1, 0])?;
            let arrays = fill_step(&group, &whole.record, &whole.origin(), whole.storage)?;
            contents.extend(arrays.iter().map(|array| format!("/{}{array}", group_name(step))));
        }
        Ok(contents)
    });
    // The damage of a step says more than that the pack could not be written.
    if let Some(error) = failure {
        return Err(error);
    }
    written?;
    verify_seal(&path)?;
    Ok(path)
}

/// Makes a file of every packed step again, of the same bytes as before, and removes the packs. Returns how many.
pub fn unpack_steps(lock: &FolderLock) -> Result<usize, CheckpointError> {
    let dir = lock.dir();
    remove_leftovers(dir)?;
    let mut n_steps = 0;
    for (path, steps) in packs(dir)? {
        verify_seal(&path)?;
        for step in steps {
            let single = StepPlace::single(dir, step);
            if single.path.exists() && read_step(&single.path).is_ok() {
                continue;
            }
            let whole = WholeStep::read(&StepPlace::packed(&path, step))?;
            write_step_file(
                dir,
                &single.file_name(),
                &whole.record,
                &whole.origin(),
                whole.storage,
            )?
            .publish()?;
            read_step(&single.path)?;
            n_steps += 1;
        }
        remove_if_present(&path)?;
    }
    rebuild_index(dir)?;
    Ok(n_steps)
}
