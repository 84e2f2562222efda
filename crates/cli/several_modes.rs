//! `raceway run` of a `[modes]` scene with a list of bearings: natural modes of all of them with their shaft.

use std::path::Path;
use std::time::Instant;

use assembly::modes::{free_dofs, modes};
use assembly::{Assembly, AssemblySolution, AssemblySolver};
use dense::Searched;
use dynamics::modes::ModesOfSeveral;
use dynamics::{ModeSet, ModesSettings};
use results::bodies::bodies_elsewhere;
use results::failure::Failure;
use results::modes::{FrequenciesSummary, ModeFiles, ModesSummary, print_modes};
use results::several::{ListState, SeveralFindings, SeveralSummary, SeveralTables};
use results::several_modes::{set_of_several, write_tables_of_several};
use results::snapshot::Snapshot;
use results::summary::{READ, TOTAL};
use scene::{ModeBody, Modes, SeveralScene};

use crate::modes::{beyond, loose_balls, report, require_one_process, too_few, without_stiffness};
use crate::options::Limits;
use crate::progress::Progress;
use crate::several::{make_folder, placed, say_types, solving, warnings_at, words_of};
use crate::several_files::say_where_bodies_are;
use crate::several_read::{ReadList, read_list, require_memory_of_all};
use crate::several_ready::require_space;

/// What vibrates, in words.
const NAME: &str = "bearings on their shaft";

/// Computes the modes about the equilibrium.
pub fn run(
    scene: &SeveralScene,
    wanted: &Modes,
    dir: &Path,
    limits: &Limits,
    start: Instant,
) -> Result<(), Failure> {
    require_one_process()?;
    let mut progress = Progress::new(1);
    progress.stage("reading meshes");
    let ReadList {
        mut assembly,
        remarks,
        ..
    } = read_list(scene, scene, |assembly| require_memory_of_all(scene, assembly))?;
    require_space(scene, &assembly, (dir, 0), limits)?;
    let read = start.elapsed().as_secs_f64();
    progress.stage("factoring the stiffness of the rings");
    let mut solver = AssemblySolver::new(&assembly).map_err(solving)?;
    say_types(&solver, &assembly, &progress);
    progress.stage("equilibrium");
    let solution = solver.solve(&mut assembly, None).map_err(solving)?;
    let mut laps = solver.laps();
    // Their factors are not those of the modes.
    drop(solver);
    progress.stage(&format!("{NAME}: factoring"));
    let settings = ModesSettings {
        number: wanted.number,
        shift: wanted.shift,
        backend: assembly.bearings[0].model.backend,
    };
    let mut told = |searched: Searched| report(&progress, (NAME, wanted.number), searched);
    let found = modes(&assembly, &solution, settings, &mut told).map_err(solving)?;
    progress.advance();
    progress.finish();
    let remarks = remarks
        .with(warnings_at(&words_of(None, None), &assembly, &solution))
        .with(warnings_of(scene, &found, wanted));
    let whole = set_of_several(&found, |mode| &mode.whole);
    write((scene, &assembly), &solution, &found, dir, start)?;
    laps.merge(&found.laps);
    laps.add(READ, read);
    laps.add(TOTAL, start.elapsed().as_secs_f64());
    let findings = SeveralFindings {
        status: "finished".to_string(),
        iterations: solution.shaft.iterations,
        residual: solution.shaft.error,
        warnings: remarks.warnings,
        advice: remarks.advice,
        laps,
    };
    let shown = ListState::of_equilibrium(&assembly, &solution);
    let summary = SeveralSummary::new(scene, &assembly, &shown, findings);
    let summary = summary.with_modes(FrequenciesSummary::new(&whole));
    summary.write(dir)?;
    print_modes(NAME, &whole);
    summary.print_costs();
    Ok(())
}

/// Writes the tables of all of it, and a folder for each bearing.
fn write(
    (scene, assembly): (&SeveralScene, &Assembly),
    solution: &AssemblySolution,
    found: &ModesOfSeveral,
    dir: &Path,
    start: Instant,
) -> Result<(), Failure> {
    let begun = make_folder(scene, dir)?;
    let shown = ListState::of_equilibrium(assembly, solution);
    let mut tables = SeveralTables::create(dir, None, &shown)?;
    // All folders are there, and say that they have begun, before the first has a mode: what a run leaves that is
    // killed here is known as such.
    let mut begun_files = Vec::new();
    for (i, bearing) in scene.bearings.iter().enumerate() {
        let placed = placed(&bearing.scene, &solution.bearings[i])?;
        let files = ModeFiles::create_part(&placed, &assembly.bearings[i].model, &dir.join(&bearing.name))?;
        begun_files.push((placed, files));
    }
    begun.end()?;
    tables.append((0, 0.0), None, assembly, &shown)?;
    write_tables_of_several(dir, assembly, found, &free_dofs(assembly))?;
    for ((i, bearing), (placed, mut files)) in scene.bearings.iter().enumerate().zip(begun_files) {
        let (model, equilibrium) = (&assembly.bearings[i].model, &solution.bearings[i]);
        let own = dir.join(&bearing.name);
        let set: ModeSet = set_of_several(found, |mode| &mode.bearings[i]);
        files.write(&placed, model, ModeBody::Bearing, &set)?;
        let run = files.finish()?;
        let snapshot = Snapshot::of_equilibrium(equilibrium, None);
        let remarks = [equilibrium.warnings.clone(), Vec::new()];
        let sets = [(ModeBody::Bearing, set)];
        let summary = ModesSummary::new(&bearing.scene, model, &sets, Some(&snapshot), run, remarks, start);
        let elsewhere = bodies_elsewhere(&assembly.bearings, i);
        say_where_bodies_are(&bearing.name, &elsewhere);
        summary.with_bodies_shown_in(elsewhere).write(&own)?;
    }
    Ok(())
}

/// What a user should know of the modes.
fn warnings_of(scene: &SeveralScene, found: &ModesOfSeveral, wanted: &Modes) -> Vec<String> {
    let mut warnings: Vec<String> = too_few(NAME, found.modes.len(), wanted.number)
        .into_iter()
        .collect();
    let rigid = found.modes.iter().filter(|mode| mode.whole.is_rigid).count();
    if rigid > 0 {
        warnings.push(without_stiffness(NAME, rigid));
    }
    warnings.extend(loose_balls(NAME, found.loose_balls));
    let highest = found.modes.last().map_or(0.0, |mode| mode.whole.frequency);
    for body in scene
        .bearings
        .iter()
        .flat_map(|bearing| bearing.scene.bodies.iter().flatten())
    {
        let warning = beyond(body, NAME, highest).filter(|warning| !warnings.contains(warning));
        warnings.extend(warning);
    }
    warnings
}
