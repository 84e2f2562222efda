//! `raceway run`: one equilibrium or a sweep of them, with results after every point.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::anyhow;
use checkpoint::{Compression, Output, Precision, Storage};
use contact::Side;
use dynamics::{DynamicsError, Model, RingMemory, StaticSolution, StaticSolver};
use fem::StressRecovery;

use crate::build::{build_model, model_with_rings};
use crate::failure::Failure;
use crate::progress::Progress;
use crate::results::summary::{Costs, Summary};
use crate::results::tables::Tables;
use crate::results::{console, fields, folder};
use crate::scene::{self, Analysis, Scene};

/// One load case of a run: the swept value (None for a static scene) and its scene.
type Point = (Option<f64>, Scene);

/// Runs a scene and returns the folder of its results.
pub fn run(path: &Path, overrides: &[String], out: Option<PathBuf>) -> Result<PathBuf, Failure> {
    let start = Instant::now();
    let scene = Scene::load(path, overrides)?;
    let dir = folder::choose(path, out)?;
    let points = points(&scene)?;
    let mut progress = Progress::new(points.len() as u64);
    progress.stage("reading meshes");
    let mut model = build_model(&points[0].1)?;
    let read = start.elapsed().as_secs_f64();
    progress.stage("factoring the stiffness of the rings");
    let mut solver = StaticSolver::new(&model).map_err(Failure::solving)?;
    let mut solutions: Vec<(f64, StaticSolution)> = Vec::new();
    let mut results: Option<Results> = None;
    for (step, (value, point)) in points.iter().enumerate() {
        progress.stage(&stage_text(&scene, *value));
        model = model_with_rings(point, model.rings)?;
        let before = solutions.last().map(|s| &s.1);
        let solution = solver
            .solve(&model, before)
            .map_err(|e| at_point(e, &scene, *value, &dir, step))?;
        // The first solution makes the folder: a scene that has none leaves no files.
        let files = match &mut results {
            Some(files) => files,
            empty => empty.insert(Results::create(&scene, &model, &dir)?),
        };
        files.write(&model, step as u64, *value, point, &solution)?;
        // Later points start from displacements of the contacts only; fields of a long sweep would fill the memory.
        if let Some((_, earlier)) = solutions.last_mut() {
            earlier.elastic = [None, None];
        }
        solutions.push((value.unwrap_or(0.0), solution));
        progress.advance();
    }
    progress.finish();
    let forecast = Side::BOTH.map(|side| solver.ring(side).map(|r| r.memory));
    let results = results.expect("a scene has at least one point");
    let costs = results.finish(read, forecast, &solver, start)?;
    let summary = Summary::new(&scene, &model, &solutions, &costs);
    summary.write(&dir)?;
    match &scene.analysis {
        Analysis::Static => console::print_static(&solutions[0].1),
        Analysis::Sweep(sweep) => console::print_sweep(&sweep.column, &solutions),
    }
    summary.print_costs();
    Ok(dir)
}

/// The load cases of a scene: one, or those of its sweep.
fn points(scene: &Scene) -> Result<Vec<Point>, Failure> {
    let Analysis::Sweep(sweep) = &scene.analysis else {
        return Ok(vec![(None, scene.clone())]);
    };
    let scenes = scene.sweep_scenes()?;
    for point in &scenes {
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
    a.inner.body == b.inner.body
        && a.outer.body == b.outer.body
        && a.materials.rings == b.materials.rings
        && a.contact.mode == b.contact.mode
        && (grooves(a) == grooves(b) || (a.inner.body.is_none() && a.outer.body.is_none()))
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
    match Failure::solving(error) {
        Failure::User(e) => Failure::User(e.context(context)),
        Failure::Numerical(e) => Failure::Numerical(e.context(context)),
    }
}

/// Everything that is written while a run goes on.
struct Results {
    output: Output,
    tables: Tables,
    recoveries: [Option<StressRecovery>; 2],
    stress_seconds: f64,
    output_seconds: f64,
}

impl Results {
    fn create(scene: &Scene, model: &Model, dir: &Path) -> Result<Results, Failure> {
        let clock = Instant::now();
        let output = Output::create(dir, &fields::bodies(model), storage(scene))?;
        let swept = match &scene.analysis {
            Analysis::Sweep(sweep) => Some(sweep.column.as_str()),
            Analysis::Static => None,
        };
        let tables = Tables::create(dir, swept)?;
        let output_seconds = clock.elapsed().as_secs_f64();
        let recoveries = fields::recoveries(model, scene.output.stress)?;
        Ok(Results {
            output,
            tables,
            recoveries,
            stress_seconds: 0.0,
            output_seconds,
        })
    }

    fn write(
        &mut self,
        model: &Model,
        step: u64,
        value: Option<f64>,
        point: &Scene,
        solution: &StaticSolution,
    ) -> Result<(), Failure> {
        let clock = Instant::now();
        let record = fields::record(model, solution, &self.recoveries, step, &point.text);
        self.stress_seconds += clock.elapsed().as_secs_f64();
        let clock = Instant::now();
        self.output.write_step(&record)?;
        self.tables.append(step, record.time, value, solution)?;
        self.output_seconds += clock.elapsed().as_secs_f64();
        Ok(())
    }

    fn finish(
        self,
        read: f64,
        forecast: [Option<RingMemory>; 2],
        solver: &StaticSolver,
        start: Instant,
    ) -> Result<Costs, Failure> {
        let clock = Instant::now();
        self.output.finish()?;
        Ok(Costs {
            read,
            stress: self.stress_seconds,
            output: self.output_seconds + clock.elapsed().as_secs_f64(),
            total: start.elapsed().as_secs_f64(),
            forecast,
            solver: solver.timing,
        })
    }
}

fn storage(scene: &Scene) -> Storage {
    Storage {
        stress: match scene.output.precision {
            scene::Precision::F32 => Precision::F32,
            scene::Precision::F64 => Precision::F64,
        },
        compression: match scene.output.compression {
            0 => Compression::None,
            level => Compression::Deflate(level),
        },
    }
}
