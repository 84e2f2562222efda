//! `raceway run`: one equilibrium or a sweep of them, with results after every point.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::anyhow;
use contact::Side;
use dynamics::{DynamicsError, Model, StaticSolution, StaticSolver};
use results::disk::Forecast;
use results::failure::{Failure, agree, of_all};
use results::files::Files;
use results::memory::Forecasts;
use results::shown::Shown;
use results::snapshot::Snapshot;
use results::summary::{Costs, Findings, Summary};
use results::survey::build_surveyed;
use results::{console, fields, folder, seat};
use scene::{Analysis, AnyScene, Scene, SeveralScene, have_same_rings, model_with_rings, rolling};

use crate::modes;
use crate::motion;
use crate::options::{Limits, Part};
use crate::progress::Progress;
use crate::quasi_static;
use crate::remarks::Remarks;
use crate::shared::note_unshared;
use crate::{several, several_modes, several_motion};

/// One load case of a run: the swept value (None for a static scene) and its scene.
pub type Point = (Option<f64>, Scene);

/// A finished point.
struct Solved {
    /// The swept value, 0 in a static scene.
    value: f64,
    solution: StaticSolution,
    snapshot: Snapshot,
}

/// Runs a scene and returns the folder of its results.
pub fn run(
    path: &Path,
    overrides: &[String],
    out: Option<PathBuf>,
    limits: &Limits,
    part: Option<Part>,
) -> Result<PathBuf, Failure> {
    let start = Instant::now();
    let scene = match agree(AnyScene::load(path, overrides).map_err(Failure::from))? {
        AnyScene::One(scene) => *scene,
        AnyScene::Several(list) => {
            return run_list(&list, out, (limits, part), start);
        }
    };
    if let Some(part) = part {
        part.check(&scene)?;
    }
    let dir = folder::choose(path, out)?;
    note_unshared(&scene);
    match &scene.analysis {
        Analysis::Dynamic(dynamic) => {
            return motion::run(&scene, dynamic, &dir, limits, start).map(|()| dir);
        }
        Analysis::QuasiStatic(settings) => {
            return quasi_static::run(&scene, settings, &dir, limits, start).map(|()| dir);
        }
        Analysis::Modes(wanted) => {
            return modes::run(&scene, wanted, &dir, limits, start).map(|()| dir);
        }
        Analysis::Static | Analysis::Sweep(_) => {}
    }
    let all = agree(points(&scene))?;
    let chosen = part.map_or(0..all.len(), Part::range);
    let (first, points) = (chosen.start, &all[chosen]);
    let mut progress = Progress::new(points.len() as u64);
    progress.stage("reading meshes");
    let (mut model, mut survey) = agree(build_surveyed(&points[0].1, &scene, &dir, |model| {
        Forecast::new(&scene, model, 0).require_space(&dir, limits.ignore_disk_space)
    }))?;
    let remarks = Remarks::on(&scene, &model, std::mem::take(&mut survey.doubts))?;
    let placed = model.geometry;
    let read = start.elapsed().as_secs_f64();
    progress.stage("factoring the stiffness of the rings");
    let mut solver = StaticSolver::new(&model).map_err(Failure::solving)?;
    say_solvers(&solver, &progress);
    let mut solutions: Vec<Solved> = Vec::new();
    let mut results: Option<Files> = None;
    let mut failure = None;
    for (step, (value, point)) in points.iter().enumerate() {
        progress.stage(&stage_text(&scene, *value));
        model = model_with_rings(point, model.rings)?;
        let before = solutions.last().map(|s| &s.solution);
        let solution = match solver.solve(&model, before) {
            Ok(solution) => solution,
            Err(error) => {
                failure = Some(of_all(at_point(error, &scene, *value, &dir, step)));
                break;
            }
        };
        // The first solution makes the folder: a scene that has none leaves no files.
        let snapshot = Snapshot::of_equilibrium(&solution, rolling(point).as_ref());
        let files = match &mut results {
            Some(files) => files,
            empty => {
                let files = Files::create(&scene, &model, &dir, &snapshot, std::mem::take(&mut survey), &[]);
                empty.insert(agree(files)?)
            }
        };
        // The points of a sweep have no time; their number stands for it.
        let step = first + step;
        let (step, time) = (step as u64, step as f64);
        let shown = Shown::at_rest(&model, &placed, &solution);
        // All ranks recover stress; then rank 0 writes, and may fail alone.
        let last = (first + points.len() - 1) as u64;
        let kept = scene.output.every.kept(step, 1, last);
        let gathered = files.gather_stress(&shown, kept);
        let write = || {
            files.reduce(step, time, &shown, &scene)?;
            files.write_tables(step, time, *value, &snapshot)?;
            files.write_probes(step, time, *value, &shown)?;
            files.write_profiles(step, time, *value, &shown)?;
            files.write_fields(|stress| {
                fields::record(&shown, &solution, (stress, gathered), (step, time), (point, kept))
            })
        };
        agree(write())?;
        // Later points start from displacements of the contacts only; fields of a long sweep would fill the memory.
        if let Some(earlier) = solutions.last_mut() {
            earlier.solution.elastic = [None, None];
        }
        solutions.push(Solved {
            value: value.unwrap_or(0.0),
            solution,
            snapshot,
        });
        progress.advance();
    }
    progress.finish();
    // Points that were solved get their summary, whatever came after them.
    if let Some(files) = results {
        let forecast = Side::BOTH.map(|side| solver.ring(side).map(|r| r.solver.memory));
        let costs = agree(files.finish(read, Forecasts::at_rest(forecast, &model), solver.laps(), start))?;
        conclude(&scene, (&model, &solutions), &failure, remarks, &costs, &dir)?;
    }
    failure.map_or(Ok(dir), Err)
}

/// Runs a list of bearings and returns the folder of its results.
fn run_list(
    list: &SeveralScene,
    out: Option<PathBuf>,
    (limits, part): (&Limits, Option<Part>),
    start: Instant,
) -> Result<PathBuf, Failure> {
    several::refuse(part.map(|_| "--points"), list)?;
    let dir = folder::choose(&list.path, out)?;
    note_unshared(&list.bearings[0].scene);
    match &list.analysis {
        Analysis::Dynamic(dynamic) => several_motion::run(list, dynamic, &dir, limits, start)?,
        Analysis::Modes(wanted) => several_modes::run(list, wanted, &dir, limits, start)?,
        _ => several::run(list, &dir, start)?,
    }
    Ok(dir)
}

/// Writes the summary of points that were solved, and prints the results of a run without a failure.
fn conclude(
    scene: &Scene,
    (model, solutions): (&Model, &[Solved]),
    failure: &Option<Failure>,
    remarks: Remarks,
    costs: &Costs,
    dir: &Path,
) -> Result<(), Failure> {
    let findings = findings(scene, solutions, failure, remarks);
    let summary = summary(scene, (model, solutions), findings, costs, dir)?;
    agree(summary.write(dir).map_err(Failure::from))?;
    if failure.is_none() {
        print_results(scene, solutions, &summary);
    }
    Ok(())
}

/// The summary of points that were solved; writes what the seat of a ring in a body carries at the last.
fn summary(
    scene: &Scene,
    (model, solutions): (&Model, &[Solved]),
    findings: Findings,
    costs: &Costs,
    dir: &Path,
) -> Result<Summary, Failure> {
    let last = solutions.last();
    let seat = last.map_or(Ok([None, None]), |last| seat::of_run(model, &last.solution, dir));
    let summary = Summary::new(scene, model, findings, costs).with_life(life::of_run(scene, dir));
    Ok(summary.with_seats(agree(seat)?))
}

/// Says how each ring is solved.
fn say_solvers(solver: &StaticSolver, progress: &Progress) {
    for side in Side::BOTH {
        if let Some(ring) = solver.ring(side) {
            progress.stage(&format!("{} ring: {}", side.name(), ring.solver.solver_note()));
        }
    }
}

fn print_results(scene: &Scene, solutions: &[Solved], summary: &Summary) {
    match &scene.analysis {
        Analysis::Sweep(sweep) => {
            let points: Vec<_> = solutions.iter().map(|s| (s.value, &s.solution)).collect();
            console::print_sweep(&sweep.column, &points);
        }
        _ => console::print_snapshot(&solutions[0].snapshot),
    }
    summary.print_costs();
}

fn findings(scene: &Scene, solutions: &[Solved], failure: &Option<Failure>, remarks: Remarks) -> Findings {
    let last = solutions.last().expect("a finished run has a solution");
    let points = solutions.iter().map(|s| (s.value, s.snapshot.clone()));
    Findings {
        status: failure.as_ref().map_or("finished".to_string(), Failure::status),
        last: last.snapshot.clone(),
        points: points.collect(),
        iterations: BTreeMap::from([
            ("rounds", last.solution.rounds),
            ("newton", last.solution.newton_iterations),
        ]),
        warnings: remarks
            .warnings
            .into_iter()
            .chain(solutions.iter().flat_map(|point| warnings(scene, point)))
            .collect(),
        advice: remarks.advice,
    }
}

/// Warnings of one point; in a sweep they say which.
fn warnings(scene: &Scene, Solved { value, solution, .. }: &Solved) -> Vec<String> {
    let at = match &scene.analysis {
        Analysis::Sweep(sweep) => format!("{} = {value}: ", sweep.column),
        _ => String::new(),
    };
    solution.warnings.iter().map(|w| format!("{at}{w}")).collect()
}

/// The load cases of a scene: one, or those of its sweep.
pub fn points(scene: &Scene) -> Result<Vec<Point>, Failure> {
    let Analysis::Sweep(sweep) = &scene.analysis else {
        return Ok(vec![(None, scene.clone())]);
    };
    let scenes = scene.sweep_scenes()?;
    for point in &scenes {
        if point.bearing.balls != scene.bearing.balls {
            return Err(Failure::User(anyhow!(
                "{}: [sweep] key {} changes the number of balls, and with it the tables and the result files; run one \
                 scene per value with --set",
                scene.path.display(),
                sweep.key
            )));
        }
        if !have_same_rings(scene, point) {
            return Err(Failure::User(anyhow!(
                "{}: [sweep] key {} changes the rings themselves; sweep loads, contacts, supports of the shaft or the \
                 ball phase, or run one scene per value with --set",
                scene.path.display(),
                sweep.key
            )));
        }
    }
    Ok(sweep.points.iter().map(|p| Some(p.value)).zip(scenes).collect())
}

/// What is computed at a point, for progress.
pub fn stage_text(scene: &Scene, value: Option<f64>) -> String {
    match (&scene.analysis, value) {
        (Analysis::Sweep(sweep), Some(value)) => format!("contacts at {} = {value}", sweep.column),
        _ => "contacts".to_string(),
    }
}

fn at_point(error: DynamicsError, scene: &Scene, value: Option<f64>, dir: &Path, done: usize) -> Failure {
    let (Analysis::Sweep(sweep), Some(value)) = (&scene.analysis, value) else {
        return Failure::solving(error);
    };
    let context = match done {
        0 => format!("{} = {value}, the first point of the sweep", sweep.column),
        _ => format!(
            "{} = {value} failed after {done} finished points, which are kept in {}",
            sweep.column,
            dir.display()
        ),
    };
    Failure::solving(error).context(context)
}
