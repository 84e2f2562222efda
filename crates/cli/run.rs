//! `raceway run`: one equilibrium or a sweep of them, with results after every point.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::anyhow;
use contact::Side;
use dynamics::{DynamicsError, StaticSolution, StaticSolver};

use crate::build::{build_model, model_with_rings};
use crate::failure::Failure;
use crate::modes;
use crate::motion;
use crate::progress::Progress;
use crate::results::files::Files;
use crate::results::snapshot::Snapshot;
use crate::results::summary::{Findings, Summary};
use crate::results::{console, fields, folder};
use crate::scene::{Analysis, Scene};

/// One load case of a run: the swept value (None for a static scene) and its scene.
type Point = (Option<f64>, Scene);

/// Runs a scene and returns the folder of its results.
pub fn run(path: &Path, overrides: &[String], out: Option<PathBuf>) -> Result<PathBuf, Failure> {
    let start = Instant::now();
    let scene = Scene::load(path, overrides)?;
    let dir = folder::choose(path, out)?;
    if let Analysis::Dynamic(dynamic) = &scene.analysis {
        return motion::run(&scene, dynamic, dir, start);
    }
    if let Analysis::Modes(wanted) = &scene.analysis {
        return modes::run(&scene, wanted, dir, start);
    }
    let points = points(&scene)?;
    let mut progress = Progress::new(points.len() as u64);
    progress.stage("reading meshes");
    let mut model = build_model(&points[0].1)?;
    let placed = model.geometry;
    let read = start.elapsed().as_secs_f64();
    progress.stage("factoring the stiffness of the rings");
    let mut solver = StaticSolver::new(&model).map_err(Failure::solving)?;
    let mut solutions: Vec<(f64, StaticSolution)> = Vec::new();
    let mut results: Option<Files> = None;
    let mut failure = None;
    for (step, (value, point)) in points.iter().enumerate() {
        progress.stage(&stage_text(&scene, *value));
        model = model_with_rings(point, model.rings)?;
        let before = solutions.last().map(|s| &s.1);
        let solution = match solver.solve(&model, before) {
            Ok(solution) => solution,
            Err(error) => {
                failure = Some(at_point(error, &scene, *value, &dir, step));
                break;
            }
        };
        // The first solution makes the folder: a scene that has none leaves no files.
        let snapshot = Snapshot::of_equilibrium(&solution);
        let files = match &mut results {
            Some(files) => files,
            empty => empty.insert(Files::create(&scene, &model, &dir, &snapshot)?),
        };
        let step = step as u64;
        files.write_fields(|recoveries| {
            fields::record(&model, &placed, &solution, recoveries, step, &point.text)
        })?;
        // The points of a sweep have no time; their number stands for it.
        files.write_tables(step, step as f64, *value, &snapshot)?;
        // Later points start from displacements of the contacts only; fields of a long sweep would fill the memory.
        if let Some((_, earlier)) = solutions.last_mut() {
            earlier.elastic = [None, None];
        }
        solutions.push((value.unwrap_or(0.0), solution));
        progress.advance();
    }
    progress.finish();
    let forecast = Side::BOTH.map(|side| solver.ring(side).map(|r| r.memory));
    // Points that were solved get their summary, whatever came after them.
    if let Some(files) = results {
        let costs = files.finish(read, forecast, solver.timing, start)?;
        let summary = Summary::new(&scene, &model, findings(&scene, &solutions, &failure), &costs);
        summary.write(&dir)?;
        if failure.is_none() {
            print_results(&scene, &solutions, &summary);
        }
    }
    failure.map_or(Ok(dir), Err)
}

fn print_results(scene: &Scene, solutions: &[(f64, StaticSolution)], summary: &Summary) {
    match &scene.analysis {
        Analysis::Static | Analysis::Dynamic(_) | Analysis::Modes(_) => {
            console::print_snapshot(&Snapshot::of_equilibrium(&solutions[0].1))
        }
        Analysis::Sweep(sweep) => console::print_sweep(&sweep.column, solutions),
    }
    summary.print_costs();
}

fn findings(scene: &Scene, solutions: &[(f64, StaticSolution)], failure: &Option<Failure>) -> Findings {
    let last = &solutions.last().expect("a finished run has a solution").1;
    let points = solutions
        .iter()
        .map(|(value, s)| (*value, Snapshot::of_equilibrium(s)));
    Findings {
        status: failure
            .as_ref()
            .map_or("finished".to_string(), |f| format!("failed: {}", f.text())),
        last: Snapshot::of_equilibrium(last),
        points: points.collect(),
        iterations: BTreeMap::from([("rounds", last.rounds), ("newton", last.newton_iterations)]),
        warnings: solutions
            .iter()
            .flat_map(|point| warnings(scene, point))
            .collect(),
    }
}

/// Warnings of one point; in a sweep they say which.
fn warnings(scene: &Scene, (value, solution): &(f64, StaticSolution)) -> Vec<String> {
    let at = match &scene.analysis {
        Analysis::Sweep(sweep) => format!("{} = {value}: ", sweep.column),
        Analysis::Static | Analysis::Dynamic(_) | Analysis::Modes(_) => String::new(),
    };
    solution.warnings.iter().map(|w| format!("{at}{w}")).collect()
}

/// The load cases of a scene: one, or those of its sweep.
fn points(scene: &Scene) -> Result<Vec<Point>, Failure> {
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
        if !same_rings(scene, point) {
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

/// Whether two scenes have the same finite-element rings, so that one factorisation serves both.
fn same_rings(a: &Scene, b: &Scene) -> bool {
    let grooves = |s: &Scene| {
        let b = &s.bearing;
        [
            b.inner_raceway_diameter,
            b.outer_raceway_diameter,
            b.inner_groove_radius,
            b.outer_groove_radius,
        ]
    };
    let same_bodies = a.inner.body == b.inner.body && a.outer.body == b.outer.body;
    let rigid = a.inner.body.is_none() && a.outer.body.is_none();
    same_bodies
        && a.contact.mode == b.contact.mode
        && (rigid || (a.materials.rings == b.materials.rings && grooves(a) == grooves(b)))
}

fn stage_text(scene: &Scene, value: Option<f64>) -> String {
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
