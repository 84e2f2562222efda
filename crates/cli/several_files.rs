//! Files of a list of bearings over time: made for a new run, or opened where another has left them.

use std::path::{Path, PathBuf};
use std::time::Instant;

use assembly::{Assembly, MountedBearing};
use comm::{Communicator, print};
use dynamics::Model;
use results::bodies::{BodiesElsewhere, bodies_elsewhere, where_bodies_are};
use results::cut::{TableCut, last_row};
use results::failure::{Failure, agree};
use results::files::{Files, ResumedFrom};
use results::folder::remove_list_summary;
use results::list_folder::ListStart;
use results::memory::Forecasts;
use results::seat::{SeatFolder, SeatSummaries};
use results::several::{ListState, SHAFT_TABLE, SeveralTables};
use results::snapshot::Snapshot;
use results::state_arrays::Arrays;
use results::summary::{Findings, Summary};
use results::survey::Survey;
use scene::Scene;
use timer::Laps;

use crate::several::of_seats;
use crate::several_state::StoredBearing;

/// Makes the files of all bearings, which begin as their snapshots show, in the folder of a run that begins.
pub fn create_files(
    begun: ListStart,
    assembly: &Assembly,
    placed: &[Scene],
    first: Vec<Snapshot>,
    surveys: Vec<Survey>,
) -> Result<Vec<Files>, Failure> {
    let mut files = Vec::new();
    for (i, (placed, survey)) in placed.iter().zip(surveys).enumerate() {
        let mounted = &assembly.bearings[i];
        let own = begun.dir.join(&mounted.name);
        let made = Files::create_part(placed, &mounted.model, &own, &first[i], survey, &[]);
        files.push(agree(made)?);
    }
    agree(begun.end())?;
    Ok(files)
}

/// Opens the files of all bearings to go on after the step that was read, at which a bearing, by its number, is as in
/// what `found` gives; returns their scenes too.
pub fn resume_all<'m>(
    bearings: Vec<StoredBearing>,
    surveys: Vec<Survey>,
    found: impl Fn(usize) -> (&'m Model, Snapshot, &'m Arrays),
) -> Result<(Vec<Files>, Vec<Scene>), Failure> {
    let (mut files, mut placed) = (Vec::new(), Vec::new());
    for (i, (bearing, survey)) in bearings.into_iter().zip(surveys).enumerate() {
        let (model, own, reduction) = found(i);
        let (own, scene) = resume_files(bearing, model, survey, (own, reduction))?;
        files.push(own);
        placed.push(scene);
    }
    Ok((files, placed))
}

/// Opens the files of a bearing to go on after the step that was read, at which it is as in the snapshot; returns its
/// scene too.
fn resume_files(
    bearing: StoredBearing,
    model: &Model,
    survey: Survey,
    (own, reduction): (Snapshot, &Arrays),
) -> Result<(Files, Scene), Failure> {
    let from = ResumedFrom {
        step: bearing.record.step,
        tables: bearing.record.tables.as_ref(),
        warnings: &[],
        reduction,
    };
    let files = Files::resume(&bearing.scene, model, bearing.lock, &own, survey, &from);
    Ok((agree(files)?, bearing.scene))
}

/// Where the tables beside the folders of the bearings are to be cut to go on from the step that was read: behind the
/// last row that its file tells of in the first bearing. A run that stopped has a row more where none was due.
pub fn cuts_of_list(
    dir: &Path,
    first: &ListState,
    bearing: &StoredBearing,
) -> Result<Vec<TableCut>, Failure> {
    agree(find_cuts(dir, first, bearing).map_err(Failure::from))
}

fn find_cuts(dir: &Path, first: &ListState, bearing: &StoredBearing) -> anyhow::Result<Vec<TableCut>> {
    let step = bearing.record.step;
    let stamp = bearing
        .record
        .tables
        .as_ref()
        .and_then(|tables| tables.get(SHAFT_TABLE));
    let last = match stamp.filter(|_| Communicator::world().is_root()) {
        Some(stamp) => last_row(&bearing.folder.join(SHAFT_TABLE), (step, *stamp))?,
        None => None,
    };
    SeveralTables::cuts(dir, first, last.unwrap_or(step))
}

/// Closes the files of a bearing by its number, whose scene is `placed`, and writes its summary into its folder `own`;
/// the warnings of its seats, which are found when the files are closed. Collective.
pub fn close_bearing(
    files: Files,
    (placed, bearings, number): (&Scene, &[MountedBearing], usize),
    own: &Path,
    (findings, forecast, laps): (Findings, Forecasts, Laps),
    seats: impl FnOnce(SeatFolder<'_>) -> Result<SeatSummaries, Failure>,
    start: Instant,
) -> Result<Vec<String>, Failure> {
    let mounted = &bearings[number];
    let elsewhere = bodies_elsewhere(bearings, number);
    say_where_bodies_are(&mounted.name, &elsewhere);
    let costs = agree(files.finish(0.0, forecast, laps, start))?;
    let seats = agree(seats((own, Some(&mounted.name))))?;
    let warnings = of_seats(&mounted.name, &seats);
    let summary = Summary::new(placed, &mounted.model, findings, &costs).with_seats(seats);
    let summary = summary.with_bodies_shown_in(elsewhere);
    agree(summary.write(own).map_err(Failure::from))?;
    Ok(warnings)
}

/// Says where the bodies of a bearing are that its own files do not show.
pub fn say_where_bodies_are(bearing: &str, elsewhere: &BodiesElsewhere) {
    for line in where_bodies_are(elsewhere) {
        print::line(format_args!("bearing {bearing:?}: body {line}"));
    }
}

/// Opens the tables beside the folders of the bearings; what stands after the step is moved aside. The summary of the
/// run goes, which says nothing of the steps that follow.
pub fn resume_tables(cuts: &[TableCut], dir: &Path) -> Result<SeveralTables, Failure> {
    if Communicator::world().is_root() {
        results::files::say_folder(dir);
    }
    let mut aside = None;
    let mut make_aside = || -> anyhow::Result<PathBuf> {
        match &aside {
            Some(folder) => Ok(PathBuf::clone(folder)),
            None => Ok(aside.insert(checkpoint::new_superseded_folder(dir)?).clone()),
        }
    };
    let outdated = match Communicator::world().is_root() {
        true => remove_list_summary(dir),
        false => Ok(()),
    };
    agree(outdated.map_err(Failure::from))?;
    agree(SeveralTables::resume(cuts, &mut make_aside).map_err(Failure::from))
}
