//! `raceway resume` of the results of a list of bearings: of a motion, or of equilibria in time.

use std::path::Path;
use std::time::Instant;

use comm::print;
use results::failure::Failure;

use crate::options::Limits;
use crate::several::require_same_list;
use crate::several_state::{self, ListChanges};
use crate::shared::note_unshared;
use crate::stored::OverTime;
use crate::{several_motion, several_quasi_static};

/// Goes on with a run in a folder of a list.
pub fn resume_run(
    dir: &Path,
    step: Option<u64>,
    changes: ListChanges<'_>,
    limits: &Limits,
) -> Result<(), Failure> {
    let start = Instant::now();
    let Some(stored) = several_state::read(dir, step, changes)? else {
        return Ok(());
    };
    require_same_list(&stored.scene)?;
    note_unshared(&stored.scene.bearings[0].scene);
    match stored.course {
        OverTime::Motion(dynamic) => several_motion::resume(stored, dynamic, limits, start)?,
        OverTime::Equilibria(settings) => several_quasi_static::resume(stored, settings, limits, start)?,
    }
    print::line(format_args!("results: {}", dir.display()));
    Ok(())
}
