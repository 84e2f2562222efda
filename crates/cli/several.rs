//! `raceway run` of a scene with a list of bearings on one shaft.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::anyhow;
use assembly::{Assembly, AssemblyError, AssemblySolution, AssemblySolver};
use comm::Communicator;
use contact::Side;
use results::failure::{Failure, agree, of_all};
use results::files::{Files, say_folder};
use results::memory::Forecasts;
use results::seat::{self, SeatSummaries, SeatSummary};
use results::several::{ListState, SCENE_TEXT, SeveralFindings, SeveralSummary, SeveralTables};
use results::several_print::{print_solution, print_sweep_head, print_sweep_point};
use results::shown::Shown;
use results::snapshot::Snapshot;
use results::summary::{Findings, READ, Summary, TOTAL};
use results::survey::{Survey, require_same_scene};
use results::whole::{make_asked_folder, write_new};
use scene::{Analysis, BuildError, KeptFields, Rings, Scene, SeveralScene, assembly_with_rings};

use crate::progress::Progress;
use crate::several_read::{ReadList, read_list, require_memory_of_all};

/// One load case: the swept value (None for a static scene) and its scene.
pub type SeveralPoint = (Option<f64>, SeveralScene);

/// Runs a scene at rest; its results go into a folder.
pub fn run(scene: &SeveralScene, dir: &Path, start: Instant) -> Result<(), Failure> {
    require_same_list(scene)?;
    let points = agree(points(scene))?;
    let mut progress = Progress::new(points.len() as u64);
    progress.stage("reading meshes");
    let ReadList {
        mut assembly,
        doubts: mut warnings,
        surveys,
    } = agree(read_list(&points[0].1, scene, |assembly| {
        require_memory_of_all(scene, assembly)
    }))?;
    let read = start.elapsed().as_secs_f64();
    progress.stage("factoring the stiffness of the rings");
    let mut solver = AssemblySolver::new(&assembly).map_err(solving)?;
    say_types(&solver, &assembly, &progress);
    let column = column(scene);
    let (mut written, mut failure, mut before) = (None, None, None);
    let mut surveys = Some(surveys);
    let mut iterations = 0;
    for (step, (value, point)) in points.iter().enumerate() {
        progress.stage(&stage_text(column, *value));
        assembly = assembly_with_rings(point, rings(assembly)).map_err(Failure::from)?;
        let solution = match solver.solve(&mut assembly, before.as_ref()) {
            Ok(solution) => solution,
            Err(error) => {
                failure = Some(of_all(at_point(solving(error), column, *value)));
                break;
            }
        };
        // The first solution makes the folder: a scene that has none leaves no files.
        let files = match &mut written {
            Some(files) => files,
            none => {
                let surveys = surveys.take().unwrap_or_default();
                none.insert(SeveralFiles::create((scene, surveys), &assembly, &solution, dir)?)
            }
        };
        files.append(step as u64, *value, (&assembly, point), &solution)?;
        warnings.extend(warnings_at(&words_of(column, *value), &assembly, &solution));
        iterations += solution.shaft.iterations;
        before = Some(solution);
        progress.advance();
    }
    progress.finish();
    if let (Some(files), Some(last)) = (written, before) {
        let mut laps = solver.laps();
        laps.add(READ, read);
        laps.add(TOTAL, start.elapsed().as_secs_f64());
        warnings.extend(files.finish(scene, (&assembly, &last), &solver, start)?);
        let findings = SeveralFindings {
            status: failure.as_ref().map_or("finished".to_string(), Failure::status),
            iterations,
            residual: last.shaft.error,
            warnings,
            laps,
        };
        let shown = ListState::of_equilibrium(&assembly, &last);
        let summary = SeveralSummary::new(scene, &assembly, &shown, findings);
        agree(summary.write(dir).map_err(Failure::from))?;
        if failure.is_none() {
            if column.is_none() {
                print_solution(&assembly, &shown);
            }
            summary.print_costs();
        }
    }
    failure.map_or(Ok(()), Err)
}

/// What a message on a point of a sweep begins with; empty without a sweep.
pub fn words_of(column: Option<&str>, value: Option<f64>) -> String {
    let words = |(column, value): (&str, f64)| format!("{column} = {value}: ");
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

/// The files of a run: tables of all bearings, and a folder for each.
struct SeveralFiles {
    tables: SeveralTables,
    bearings: Vec<(PathBuf, Files)>,
    /// Snapshots of the last step.
    last: Vec<Snapshot>,
    column: Option<String>,
}

impl SeveralFiles {
    fn create(
        (scene, surveys): (&SeveralScene, Vec<Survey>),
        assembly: &Assembly,
        solution: &AssemblySolution,
        dir: &Path,
    ) -> Result<SeveralFiles, Failure> {
        agree(make_folder(scene, dir))?;
        let column = column(scene).map(str::to_string);
        let first = ListState::of_equilibrium(assembly, solution);
        let tables = SeveralTables::create(dir, column.as_deref(), &first);
        let tables = agree(tables.map_err(Failure::from))?;
        let mut bearings = Vec::new();
        for (((bearing, mounted), found), survey) in scene
            .bearings
            .iter()
            .zip(&assembly.bearings)
            .zip(&solution.bearings)
            .zip(surveys)
        {
            let own = dir.join(&bearing.name);
            let placed = agree(placed(&bearing.scene, found))?;
            let snapshot = snapshot(found);
            let files = Files::create_part(&placed, &mounted.model, &own, &snapshot, survey, &[]);
            bearings.push((own, agree(files)?));
        }
        if column.is_some() {
            print_sweep_head(column.as_deref().unwrap_or_default(), assembly);
        }
        Ok(SeveralFiles {
            tables,
            bearings,
            last: Vec::new(),
            column,
        })
    }

    /// Writes a point. Collective.
    fn append(
        &mut self,
        step: u64,
        value: Option<f64>,
        (assembly, point): (&Assembly, &SeveralScene),
        solution: &AssemblySolution,
    ) -> Result<(), Failure> {
        // All ranks recover the stress of all bearings; then rank 0 writes, and may fail alone.
        let mut gathered = Vec::new();
        for (i, (_, files)) in self.bearings.iter_mut().enumerate() {
            let (model, found) = (&assembly.bearings[i].model, &solution.bearings[i]);
            let shown = Shown::at_rest(model, &model.geometry, found);
            gathered.push(files.gather_stress(&shown, KeptFields::ALL));
        }
        let write = || {
            let (time, found) = (step as f64, ListState::of_equilibrium(assembly, solution));
            self.tables.append((step, time), value, assembly, &found)?;
            if let (Some(value), true) = (value, self.column.is_some()) {
                print_sweep_point(value, &found);
            }
            self.last.clear();
            for (i, ((_, files), gathered)) in self.bearings.iter_mut().zip(gathered).enumerate() {
                let (model, found) = (&assembly.bearings[i].model, &solution.bearings[i]);
                let snapshot = snapshot(found);
                let placed = placed(&point.bearings[i].scene, found)?;
                let shown = Shown::at_rest(model, &model.geometry, found);
                files.write_tables(step, time, None, &snapshot)?;
                files.write_fields(|stress| {
                    let at = (step, time);
                    results::fields::record(&shown, found, (stress, gathered), at, (&placed, KeptFields::ALL))
                })?;
                self.last.push(snapshot);
            }
            Ok(())
        };
        agree(write())
    }

    /// Closes the files of the bearings; warns of their seats. Collective.
    fn finish(
        self,
        scene: &SeveralScene,
        (assembly, solution): (&Assembly, &AssemblySolution),
        solver: &AssemblySolver,
        start: Instant,
    ) -> Result<Vec<String>, Failure> {
        let mut warnings = Vec::new();
        for (i, ((dir, files), last)) in self.bearings.into_iter().zip(self.last).enumerate() {
            let factors = solver.of_bearing(i);
            let forecast = Side::BOTH.map(|side| factors.ring(side).map(|r| r.solver.memory));
            let costs = agree(files.finish(
                0.0,
                Forecasts::at_rest(forecast, &assembly.bearings[i].model),
                factors.laps(),
                start,
            ))?;
            let found = &solution.bearings[i];
            let findings = Findings {
                status: "finished".to_string(),
                last,
                points: Vec::new(),
                iterations: std::collections::BTreeMap::from([
                    ("rounds", found.rounds),
                    ("newton", found.newton_iterations),
                ]),
                warnings: found.warnings.clone(),
                advice: Vec::new(),
            };
            let bearing = &scene.bearings[i].scene;
            let model = &assembly.bearings[i].model;
            let seats = agree(seat::of_run(model, found, &dir))?;
            warnings.extend(of_seats(&scene.bearings[i].name, &seats));
            let summary = Summary::new(bearing, model, findings, &costs).with_seats(seats);
            agree(summary.write(&dir).map_err(Failure::from))?;
        }
        Ok(warnings)
    }
}

/// What the seats of a bearing in bodies ask for.
pub fn of_seats(name: &str, seats: &SeatSummaries) -> Vec<String> {
    let warnings = seats.iter().flatten().filter_map(SeatSummary::warning);
    warnings
        .map(|warning| format!("bearing {name:?}: {warning}"))
        .collect()
}

/// Makes the folder of a run, with the scene beside the results of its bearings. Rank 0 does it for all.
pub fn make_folder(scene: &SeveralScene, dir: &Path) -> Result<(), Failure> {
    if !Communicator::world().is_root() {
        return Ok(());
    }
    make_asked_folder(dir)?;
    say_folder(dir);
    Ok(write_new(&dir.join(SCENE_TEXT), |file| {
        file.write_all(scene.text.as_bytes())
    })?)
}

fn snapshot(solution: &dynamics::StaticSolution) -> Snapshot {
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
        Some((column, value)) => failure.context(format!("{column} = {value}")),
        None => failure,
    }
}

/// What is computed at a point, for progress.
pub fn stage_text(column: Option<&str>, value: Option<f64>) -> String {
    match column.zip(value) {
        Some((column, value)) => format!("bearings at {column} = {value}"),
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

/// Refuses options that are for one bearing.
pub fn refuse(option: Option<&str>, scene: &SeveralScene) -> Result<(), Failure> {
    match option {
        None => Ok(()),
        Some(option) => Err(Failure::User(anyhow!(
            "{option} is not for a list of bearings, and {} has one; leave it out",
            scene.path.display()
        ))),
    }
}
