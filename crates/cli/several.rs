//! What commands on a list of bearings on one shaft share: its load cases, its folder, words of messages.

use std::path::Path;

use anyhow::anyhow;
use assembly::{Assembly, AssemblyError, AssemblySolution, AssemblySolver};
use comm::Communicator;
use contact::Side;
use results::console::at_value;
use results::failure::Failure;
use results::files::say_folder;
use results::list_folder::ListStart;
use results::seat::{SeatSummaries, SeatSummary};
use results::snapshot::Snapshot;
use results::survey::require_same_scene;
use scene::{Analysis, BuildError, Rings, Scene, SeveralScene};
use timer::Laps;

use crate::progress::Progress;

/// One load case: the swept value (None for a static scene) and its scene.
pub type SeveralPoint = (Option<f64>, SeveralScene);

/// What a message on a point of a sweep begins with; empty without a sweep.
pub fn words_of(column: Option<&str>, value: Option<f64>) -> String {
    let words = |(column, value)| format!("{}: ", at_value(column, value));
    column.zip(value).map_or(String::new(), words)
}

/// Warnings of all bearings, behind the words on the point.
pub fn warnings_at(at: &str, assembly: &Assembly, solution: &AssemblySolution) -> Vec<String> {
    let pairs = assembly.bearings.iter().zip(&solution.bearings);
    let of = |(bearing, found): (&assembly::MountedBearing, &dynamics::StaticSolution)| {
        let own = found.warnings.iter();
        own.map(|w| format!("{at}bearing {:?}: {w}", bearing.name))
            .collect::<Vec<_>>()
    };
    pairs.flat_map(of).collect()
}

/// What the seats of a bearing in bodies ask for.
pub fn of_seats(name: &str, seats: &SeatSummaries) -> Vec<String> {
    let warnings = seats.iter().flatten().filter_map(SeatSummary::warning);
    warnings
        .map(|warning| format!("bearing {name:?}: {warning}"))
        .collect()
}

/// Makes the folder of a run, with the scene beside the results of its bearings. Rank 0 does it for all.
pub fn make_folder(scene: &SeveralScene, dir: &Path) -> Result<ListStart, Failure> {
    let start = ListStart::begin(scene, dir)?;
    if Communicator::world().is_root() {
        say_folder(dir);
    }
    Ok(start)
}

/// Adds the wall time of a point, by type of bearing, to that of others.
pub fn add_laps(sums: &mut Vec<Laps>, of_point: &[Laps]) {
    sums.resize_with(of_point.len(), Laps::default);
    let pairs = sums.iter_mut().zip(of_point);
    pairs.for_each(|(sum, laps)| sum.merge(laps));
}

/// The numbers of a bearing at rest.
pub fn snapshot(solution: &dynamics::StaticSolution) -> Snapshot {
    Snapshot::of_equilibrium(solution, None)
}

/// The scene of a bearing with its shaft where it stands.
pub fn placed(scene: &Scene, found: &dynamics::StaticSolution) -> Result<Scene, Failure> {
    Ok(scene.with_shaft_at(found.displacements.shaft)?)
}

/// Fails unless all ranks have the list of rank 0 and its types. Collective.
pub fn require_same_list(scene: &SeveralScene) -> Result<(), Failure> {
    require_same_scene(&scene.text)?;
    scene.bearings.iter().try_for_each(|bearing| {
        let same = require_same_scene(&bearing.scene.text);
        same.map_err(|failure| failure.context(format!("bearing {:?}", bearing.name)))
    })
}

/// The load cases of a scene: one, or those of its sweep.
pub fn points(scene: &SeveralScene) -> Result<Vec<SeveralPoint>, Failure> {
    let Analysis::Sweep(sweep) = &scene.analysis else {
        return Ok(vec![(None, scene.clone())]);
    };
    let scenes = scene.sweep_scenes()?;
    let n_balls = |s: &SeveralScene| {
        s.bearings
            .iter()
            .map(|b| b.scene.bearing.balls)
            .collect::<Vec<_>>()
    };
    for point in &scenes {
        let pairs = || scene.bearings.iter().zip(&point.bearings);
        let same = |(a, b): (&scene::BearingOnShaft, &scene::BearingOnShaft)| {
            scene::have_same_rings(&a.scene, &b.scene)
        };
        if n_balls(point) != n_balls(scene) || !pairs().all(same) {
            return Err(Failure::User(anyhow!(
                "{}: [sweep] key {} changes the bearings themselves; sweep loads, pairing.offset or supports of the \
                 shaft, or run one scene per value with --set",
                scene.path.display(),
                sweep.key
            )));
        }
    }
    Ok(sweep.points.iter().map(|p| Some(p.value)).zip(scenes).collect())
}

/// Column of the swept value.
pub fn column(scene: &SeveralScene) -> Option<&str> {
    match &scene.analysis {
        Analysis::Sweep(sweep) => Some(&sweep.column),
        _ => None,
    }
}

/// The rings of an assembly, for another one.
pub fn rings(assembly: Assembly) -> Vec<Rings> {
    assembly.bearings.into_iter().map(|b| b.model.rings).collect()
}

/// A failure of the solution.
pub fn solving(error: AssemblyError) -> Failure {
    match error {
        AssemblyError::ShaftBody { .. } | AssemblyError::NoInertia { .. } => {
            Failure::from(BuildError::from(error))
        }
        AssemblyError::Bearing { name, source } => {
            Failure::solving(source).context(format!("bearing {name:?}"))
        }
        other => Failure::Numerical(anyhow::Error::from(other)),
    }
}

/// A failure with the point of a sweep.
pub fn at_point(failure: Failure, column: Option<&str>, value: Option<f64>) -> Failure {
    match column.zip(value) {
        Some((column, value)) => failure.context(at_value(column, value)),
        None => failure,
    }
}

/// What is computed at a point, for progress.
pub fn stage_text(column: Option<&str>, value: Option<f64>) -> String {
    match column.zip(value) {
        Some((column, value)) => format!("bearings at {}", at_value(column, value)),
        None => "bearings".to_string(),
    }
}

/// Says how the rings of each type are solved.
pub fn say_types(solver: &AssemblySolver, assembly: &Assembly, progress: &Progress) {
    for (first, factors) in solver.types() {
        for side in Side::BOTH {
            if let Some(ring) = factors.ring(side) {
                progress.stage(&format!(
                    "{} ring as in {:?}: {}",
                    side.name(),
                    assembly.bearings[first].name,
                    ring.solver.solver_note()
                ));
            }
        }
    }
}
