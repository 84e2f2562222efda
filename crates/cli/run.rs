//! `raceway run`: one equilibrium or a sweep of them, with results after every point.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::anyhow;
use contact::{BearingGeometry, Side};
use dynamics::points::{PointStart, SolvedPoint, points_per_start};
use dynamics::{Model, Pose, StaticSolution, StaticSolver};
use results::console::at_value;
use results::disk::Forecast;
use results::failure::{Failure, agree, of_all};
use results::files::Files;
use results::list_folder::{is_free_again, require_room};
use results::memory::Forecasts;
use results::motion_fields::RestartState;
use results::shown::Shown;
use results::snapshot::Snapshot;
use results::stop::Stop;
use results::summary::{Costs, Findings, Summary};
use results::survey::{Survey, build_surveyed};
use results::{console, fields, folder, seat};
use scene::{Analysis, AnyScene, Scene, SeveralScene, have_same_rings, model_with_rings, rolling};
use timer::Laps;

use crate::instants::{self, Due, OverInstants, WrittenSteps};
use crate::modes;
use crate::motion;
use crate::options::{Limits, SweepPart};
use crate::points_ahead::{Grouping, PointAnswer, PointsAhead};
use crate::progress::Progress;
use crate::quasi_static;
use crate::remarks::Remarks;
use crate::shared::note_unshared;
use crate::{several_modes, several_motion, several_quasi_static, several_rest};

/// One load case of a run: the swept value (None for a static scene) and its scene.
pub type SweptScene = (Option<f64>, Scene);

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
    part: Option<SweepPart>,
) -> Result<PathBuf, Failure> {
    let start = Instant::now();
    let scene = match agree(AnyScene::load(path, overrides).map_err(Failure::from))? {
        AnyScene::One(scene) => *scene,
        AnyScene::Several(list) => {
            return run_list(&list, out, (limits, part), start);
        }
    };
    if let Some(part) = part {
        part.check(&scene.path, &scene.analysis)?;
    }
    let dir = folder::choose(path, out)?;
    note_unshared(&scene);
    match &scene.analysis {
        Analysis::Dynamic(dynamic) => motion::run(&scene, dynamic, &dir, limits, start).map(|()| dir),
        Analysis::QuasiStatic(settings) => {
            quasi_static::run(&scene, settings, &dir, limits, start).map(|()| dir)
        }
        Analysis::Modes(wanted) => modes::run(&scene, wanted, &dir, limits, start).map(|()| dir),
        Analysis::Static | Analysis::Sweep(_) => run_points(&scene, part, &dir, limits, start).map(|()| dir),
    }
}

/// Runs the load cases of a scene, or a part of them.
fn run_points(
    scene: &Scene,
    part: Option<SweepPart>,
    dir: &Path,
    limits: &Limits,
    start: Instant,
) -> Result<(), Failure> {
    let all = agree(points(scene))?;
    let scene = &with_common_assumptions(scene, &all);
    let chosen = part.map_or(0..all.len(), SweepPart::range);
    let (first, points) = (chosen.start as u64, &all[chosen]);
    let mut progress = Progress::new(points.len() as u64);
    progress.stage("reading meshes");
    let (model, mut survey) = agree(build_surveyed(&points[0].1, scene, dir, |model| {
        Forecast::new(scene, model, 0).require_space(dir, limits.ignore_disk_space)
    }))?;
    let remarks = Remarks::on(scene, &model, std::mem::take(&mut survey.doubts))?;
    let read = start.elapsed().as_secs_f64();
    progress.stage("factoring the stiffness of the rings");
    let solver = StaticSolver::new(&model).map_err(Failure::solving)?;
    say_solvers(&solver, &progress);
    let rings = model.rings.clone();
    let solve = |n: u64, from: Option<&PointStart>| -> PointAnswer<SolvedPoint, Model> {
        let model = model_with_rings(&points[n as usize].1, rings.clone())?;
        let found = solver.point(&model, &Pose::default(), from);
        Ok((found.map_err(Failure::solving)?, model))
    };
    let group = Grouping {
        size: points_per_start(&model),
        last: points.len() as u64 - 1,
    };
    let mut stop = agree(Stop::of_points(points.len(), start, limits.wall_time).map_err(Failure::from))?;
    let (sweep, ended) = rayon::in_place_scope(|scope| {
        let mut sweep = LoadCases {
            scene,
            points,
            first,
            placed: model.geometry,
            model,
            ahead: PointsAhead::new(scope, &solve, group, None),
            laps: Laps::default(),
            survey,
            files: None,
            solutions: Vec::new(),
            written: WrittenSteps::default(),
            dir,
        };
        let ended = instants::run(&mut sweep, first, stop.as_mut(), &mut progress);
        (sweep.solved(), ended)
    });
    progress.finish();
    sum_up(scene, (sweep, &solver), &ended, remarks, (read, start), dir)?;
    ended
}

/// A scene that leaves open what all its points leave open alike: what a point makes of its own value is not of all.
fn with_common_assumptions(scene: &Scene, points: &[SweptScene]) -> Scene {
    let mut common = scene.clone();
    let is_of_all = |line: &String| points.iter().all(|(_, point)| point.assumed.contains(line));
    common.assumed.retain(is_of_all);
    common
}

/// Closes the files and writes the summary of what was solved, whatever came after it; the scene was read until `read`,
/// s, after `start`.
fn sum_up(
    scene: &Scene,
    (sweep, solver): (SolvedCases, &StaticSolver),
    ended: &Result<(), Failure>,
    remarks: Remarks,
    (read, start): (f64, Instant),
    dir: &Path,
) -> Result<(), Failure> {
    let Some(files) = sweep.files else { return Ok(()) };
    let forecast = Side::BOTH.map(|side| solver.ring(side).map(|r| r.solver.memory));
    let forecast = Forecasts::of_points(forecast, (scene, &sweep.model), sweep.n_points);
    let costs = agree(files.finish(read, forecast, solver.laps_with(&sweep.laps), start));
    // A run that failed says why, not what its failure did to the files.
    let costs = match (costs, ended) {
        (Err(_), Err(_)) => return Ok(()),
        (costs, _) => costs?,
    };
    conclude(
        scene,
        (&sweep.model, &sweep.solutions),
        ended,
        remarks,
        &costs,
        dir,
    )
}

/// Load cases under way: their numbers stand for times.
struct LoadCases<'a, 's, 'scope> {
    scene: &'a Scene,
    points: &'a [SweptScene],
    /// Number of the first of them in the whole sweep.
    first: u64,
    /// Geometry with which the rings were placed.
    placed: BearingGeometry,
    model: Model,
    ahead: PointsAhead<'s, 'scope, SolvedPoint, Model>,
    /// Wall time of all points, summed over threads.
    laps: Laps,
    /// What the files begin with, until there are some.
    survey: Survey,
    /// The first solution makes the folder: a scene that has none leaves no files.
    files: Option<Files>,
    solutions: Vec<Solved>,
    written: WrittenSteps,
    dir: &'a Path,
}

/// What has been solved of the load cases.
struct SolvedCases {
    /// That of the last of them.
    model: Model,
    files: Option<Files>,
    solutions: Vec<Solved>,
    /// Number of all load cases.
    n_points: u64,
    laps: Laps,
}

impl LoadCases<'_, '_, '_> {
    fn solved(self) -> SolvedCases {
        SolvedCases {
            model: self.model,
            files: self.files,
            solutions: self.solutions,
            n_points: self.points.len() as u64,
            laps: self.laps,
        }
    }

    fn point(&self, n: u64) -> &SweptScene {
        &self.points[(n - self.first) as usize]
    }

    /// What has been solved last, with its files and its load case.
    fn last(&mut self) -> (&mut Files, Shown<'_>, &Solved, &SweptScene) {
        let point = &self.points[self.solutions.len() - 1];
        let files = self.files.as_mut().expect("a solution has made the files");
        let solved = self.solutions.last().expect("a load case has been solved");
        let shown = Shown::at_rest(&self.model, &self.placed, &solved.solution);
        (files, shown, solved, point)
    }
}

impl OverInstants for LoadCases<'_, '_, '_> {
    fn due(&self) -> Due {
        Due {
            last: self.first + self.points.len() as u64 - 1,
            tables_every: 1,
            files_every: 1,
        }
    }

    fn written(&mut self) -> &mut WrittenSteps {
        &mut self.written
    }

    fn dir(&self) -> &Path {
        self.dir
    }

    fn now(&self) -> u64 {
        self.first + self.solutions.len() as u64 - 1
    }

    fn time(&self, n: u64) -> f64 {
        n as f64
    }

    fn stage(&self, n: u64, _first: u64) -> Option<String> {
        Some(stage_text(self.scene, self.point(n).0))
    }

    fn stop(&mut self, reason: &str) -> Failure {
        let counted = (self.first, self.solutions.len() as u64, self.due().last);
        instants::stopped_sweep(reason, counted, self.dir)
    }

    fn advance(&mut self, n: u64, _progress: &mut Progress) -> Result<(), Failure> {
        let (value, point) = &self.points[(n - self.first) as usize];
        let done = self.solutions.len();
        let found = self.ahead.take();
        let (found, model) =
            found.map_err(|failure| of_all(at_point(failure, self.scene, *value, self.dir, done)))?;
        self.laps.merge(&found.laps);
        let solution = found.solution;
        self.model = model;
        let snapshot = Snapshot::of_equilibrium(&solution, rolling(point).as_ref());
        if self.files.is_none() {
            let survey = std::mem::take(&mut self.survey);
            let files = Files::create(self.scene, &self.model, self.dir, &snapshot, survey, &[]);
            self.files = Some(agree(files)?);
        }
        // Fields of a long sweep would fill the memory.
        if let Some(earlier) = self.solutions.last_mut() {
            earlier.solution.elastic = [None, None];
        }
        self.solutions.push(Solved {
            value: value.unwrap_or(0.0),
            solution,
            snapshot,
        });
        Ok(())
    }

    fn reduce(&mut self) -> Result<(), Failure> {
        let (step, scene) = (self.now(), self.scene);
        let (files, shown, ..) = self.last();
        files.reduce(step, step as f64, &shown, scene)
    }

    fn append_rows(&mut self) -> Result<(), Failure> {
        let step = self.now();
        let (files, shown, solved, (value, _)) = self.last();
        files.write_tables(step, step as f64, *value, &solved.snapshot)?;
        files.write_probes(step, step as f64, *value, &shown)
    }

    fn append_profiles(&mut self) -> Result<(), Failure> {
        let step = self.now();
        let (files, shown, _, (value, _)) = self.last();
        files.write_profiles(step, step as f64, *value, &shown)
    }

    fn append_files(&mut self, _restart: RestartState) -> Result<(), Failure> {
        let (step, last) = (self.now(), self.due().last);
        let kept = self.scene.output.every.kept(step, 1, last);
        let (files, shown, solved, (_, point)) = self.last();
        let (time, solution) = (step as f64, &solved.solution);
        let gathered = files.gather_stress(&shown, kept);
        files.write_fields(|stress| {
            fields::record(&shown, solution, (stress, gathered), (step, time), (point, kept))
        })
    }
}

/// Runs a list of bearings and returns the folder of its results.
fn run_list(
    list: &SeveralScene,
    out: Option<PathBuf>,
    (limits, part): (&Limits, Option<SweepPart>),
    start: Instant,
) -> Result<PathBuf, Failure> {
    if let Some(part) = part {
        part.check(&list.path, &list.analysis)?;
    }
    let dir = folder::choose_for_list(&list.path, out, |dir| is_free_again(&list.path, dir))?;
    agree(require_room(&list.path, &dir))?;
    note_unshared(&list.bearings[0].scene);
    match &list.analysis {
        Analysis::Dynamic(dynamic) => several_motion::run(list, dynamic, &dir, limits, start)?,
        Analysis::QuasiStatic(settings) => several_quasi_static::run(list, settings, &dir, limits, start)?,
        Analysis::Modes(wanted) => several_modes::run(list, wanted, &dir, limits, start)?,
        Analysis::Static | Analysis::Sweep(_) => several_rest::run(list, part, &dir, limits, start)?,
    }
    Ok(dir)
}

/// Writes the summary of points that were solved, and prints the results of a run without a failure.
fn conclude(
    scene: &Scene,
    (model, solutions): (&Model, &[Solved]),
    ended: &Result<(), Failure>,
    remarks: Remarks,
    costs: &Costs,
    dir: &Path,
) -> Result<(), Failure> {
    let findings = findings(scene, solutions, ended, remarks);
    let summary = summary(scene, (model, solutions), findings, costs, dir)?;
    agree(summary.write(dir).map_err(Failure::from))?;
    if ended.is_ok() {
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
    let seat = last.map_or(Ok([None, None]), |last| {
        seat::of_run(model, &last.solution, (dir, None))
    });
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

fn findings(scene: &Scene, solutions: &[Solved], ended: &Result<(), Failure>, remarks: Remarks) -> Findings {
    let last = solutions.last().expect("a finished run has a solution");
    let points = solutions.iter().map(|s| (s.value, s.snapshot.clone()));
    Findings {
        status: ended
            .as_ref()
            .err()
            .map_or("finished".to_string(), Failure::status),
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
        Analysis::Sweep(sweep) => format!("{}: ", at_value(&sweep.column, *value)),
        _ => String::new(),
    };
    solution.warnings.iter().map(|w| format!("{at}{w}")).collect()
}

/// The load cases of a scene: one, or those of its sweep.
pub fn points(scene: &Scene) -> Result<Vec<SweptScene>, Failure> {
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
        (Analysis::Sweep(sweep), Some(value)) => format!("contacts at {}", at_value(&sweep.column, value)),
        _ => "contacts".to_string(),
    }
}

fn at_point(failure: Failure, scene: &Scene, value: Option<f64>, dir: &Path, done: usize) -> Failure {
    let (Analysis::Sweep(sweep), Some(value)) = (&scene.analysis, value) else {
        return failure;
    };
    let at = at_value(&sweep.column, value);
    let context = match done {
        0 => format!("{at}, the first point of the sweep"),
        _ => format!(
            "{at} failed after {done} finished points, which are kept in {}",
            dir.display()
        ),
    };
    failure.context(context)
}
