//! `raceway run` of a `[quasi_static]` scene of one bearing, and how it goes on: equilibria in time, several of them
//! solved at the same time ([`crate::points_ahead`]).
//!
//! A step file holds what the next equilibria start from, so that a resumed run has the same bits.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use anyhow::{Context, anyhow};
use checkpoint::StateArray;
use comm::print;
use contact::Side;
use dynamics::kinematics::{Rolling, Speed};
use dynamics::points::{PointStart, SolvedPoint, points_per_start};
use dynamics::{Model, QuasiStaticMotion, StaticSolution};
use results::disk::Forecast;
use results::failure::{Failure, agree};
use results::files::{Files, ResumedFrom, say_folder};
use results::memory::Forecasts;
use results::motion_fields::{Recorded, RestartState};
use results::reduction::take_arrays;
use results::rest_state;
use results::shown::Shown;
use results::snapshot::Snapshot;
use results::state_arrays::Arrays;
use results::stop::Stop;
use results::summary::{Findings, Summary};
use results::survey::{Survey, build_surveyed};
use results::{console, seat};
use scene::{Scene, rolling};
use timer::{Laps, Stopwatch};

use crate::instants::{self, Due, OverInstants, PROGRESS_STEPS, WrittenSteps};
use crate::options::Limits;
use crate::points_ahead::{Grouping, PointAnswer, PointsAhead, Taken};
use crate::progress::Progress;
use crate::remarks::Remarks;
use crate::stored::Stored;

/// Array of a step file with what has been counted so far: rounds, Newton's iterations, instants with warnings.
const COUNTS: &str = "equilibrium_counts";

/// Array of a step file with the bytes of the warnings so far, a line each.
const WARNED: &str = "equilibrium_warnings";

/// Runs the equilibria from the first.
pub fn run(
    scene: &Scene,
    settings: &scene::QuasiStatic,
    dir: &Path,
    limits: &Limits,
    start: Instant,
) -> Result<(), Failure> {
    let mut progress = Progress::new(1 + settings.n_steps);
    let (model, survey, begun) = read_model(scene, (dir, 0), limits, &progress, start)?;
    let (bearing, group) = turning(scene, &model, settings, &progress)?;
    let solve = |n: u64, from: Option<&PointStart>| point(&bearing, n, from);
    let rolling = rolling(scene);
    progress.stage("first equilibrium");
    rayon::in_place_scope(|scope| {
        let mut ahead = PointsAhead::new(scope, &solve, group, None);
        let (first, ()) = ahead.take()?;
        let (first, laps) = (first.solution, first.laps);
        // The first solution makes the folder: a scene that has none leaves no files.
        let shown = Snapshot::of_equilibrium(&first, rolling.as_ref());
        let files = Files::create(scene, &model, dir, &shown, survey, &first.warnings);
        let mut series = QuasiStaticRun {
            scene,
            settings,
            model: &model,
            rolling: rolling.as_ref(),
            bearing: &bearing,
            ahead,
            laps,
            files: agree(files)?,
            counts: Counts::default(),
            warnings: Vec::new(),
            step: 0,
            last: first,
            written: WrittenSteps::default(),
            dir,
        };
        series.count();
        instants::record(&mut series, RestartState::Stored)?;
        progress.advance();
        series.finish_run(progress, limits, begun)
    })
}

/// Goes on with the equilibria from a stored step.
pub fn resume(
    scene: &Scene,
    settings: &scene::QuasiStatic,
    stored: Stored,
    limits: &Limits,
    start: Instant,
) -> Result<(), Failure> {
    let (dir, step) = (stored.dir.clone(), stored.step);
    let mut progress = Progress::new(1 + settings.n_steps);
    progress.start_at(1 + step);
    let (model, survey, begun) = read_model(scene, (&dir, step), limits, &progress, start)?;
    let (bearing, group) = turning(scene, &model, settings, &progress)?;
    let RestoredPoint {
        taken,
        counts,
        warnings,
        reduction,
    } = agree(restore(&stored, &model))?;
    // What the step shows: nothing is written of it, unless no step follows.
    let (last, ()) = point(&bearing, taken.n, taken.from.as_ref())?;
    let last = last.solution;
    let rolling = rolling(scene);
    let shown = Snapshot::of_equilibrium(&last, rolling.as_ref());
    let from = ResumedFrom {
        step,
        tables: stored.tables.as_ref(),
        warnings: &stored.warnings,
        reduction: &reduction,
    };
    let files = agree(Files::resume(scene, &model, stored.lock, &shown, survey, &from))?;
    if files.are_written_here() {
        say_folder(&dir);
    }
    let solve = |n: u64, from: Option<&PointStart>| point(&bearing, n, from);
    rayon::in_place_scope(|scope| {
        let series = QuasiStaticRun {
            scene,
            settings,
            model: &model,
            rolling: rolling.as_ref(),
            bearing: &bearing,
            ahead: PointsAhead::new(scope, &solve, group, Some(taken)),
            laps: Laps::default(),
            files,
            counts,
            warnings,
            step,
            last,
            written: WrittenSteps::all_of(step),
            dir: &dir,
        };
        series.finish_run(progress, limits, begun)
    })
}

/// What is known before the first equilibrium.
struct Begun {
    remarks: Remarks,
    /// When the meshes were read, s after `start`.
    read: f64,
    start: Instant,
}

/// Reads the meshes of a run that has `done` so many steps in a folder.
fn read_model(
    scene: &Scene,
    (dir, done): (&Path, u64),
    limits: &Limits,
    progress: &Progress,
    start: Instant,
) -> Result<(Model, Survey, Begun), Failure> {
    progress.stage("reading meshes");
    let (model, mut survey) = agree(build_surveyed(scene, scene, dir, |model| {
        Forecast::new(scene, model, done).require_space(dir, limits.ignore_disk_space)
    }))?;
    let begun = Begun {
        remarks: Remarks::on(scene, &model, std::mem::take(&mut survey.doubts))?,
        read: start.elapsed().as_secs_f64(),
        start,
    };
    Ok((model, survey, begun))
}

/// A bearing ready to turn, and which of its instants start from the same one.
fn turning<'m>(
    scene: &Scene,
    model: &'m Model,
    settings: &scene::QuasiStatic,
    progress: &Progress,
) -> Result<(QuasiStaticMotion<'m>, Grouping), Failure> {
    progress.stage("factoring the stiffness of the rings");
    let at_rest = || Rolling::new(&model.geometry, Speed::constant(0.0), [0.0; 2]);
    let turning = rolling(scene).unwrap_or_else(at_rest);
    let bearing = QuasiStaticMotion::new(model, turning, settings.step).map_err(Failure::solving)?;
    let group = Grouping {
        size: points_per_start(model),
        last: settings.n_steps,
    };
    Ok((bearing, group))
}

/// The equilibrium of an instant.
fn point(bearing: &QuasiStaticMotion<'_>, n: u64, from: Option<&PointStart>) -> PointAnswer<SolvedPoint, ()> {
    Ok((bearing.point(n, from).map_err(Failure::solving)?, ()))
}

/// What has been counted of a run.
#[derive(Clone, Copy, Default)]
struct Counts {
    rounds: u64,
    newton: u64,
    /// Instants with warnings.
    warned: u64,
}

/// What a run goes on with.
struct RestoredPoint {
    taken: Taken<PointStart>,
    counts: Counts,
    warnings: Vec<String>,
    /// What is known of the whole run by `[output.reduction]`.
    reduction: Arrays,
}

/// The arrays of a step file.
fn arrays(taken: &Taken<PointStart>, counts: Counts, warnings: &[String]) -> Arrays {
    let start = (taken.start != taken.before).then_some(&taken.start);
    let from = taken.from.as_ref().filter(|from| **from != taken.start);
    let mut arrays = rest_state::store_point(&taken.before, [start, from]);
    let Counts {
        rounds,
        newton,
        warned,
    } = counts;
    let stored = |count: u64| i64::try_from(count).expect("nobody counts to 2^63");
    let counts = [rounds, newton, warned].map(stored);
    arrays.insert(COUNTS.to_string(), StateArray::Integer(counts.to_vec()));
    if !warnings.is_empty() {
        let text = warnings.join("\n").into_bytes().into_iter().map(i64::from);
        arrays.insert(WARNED.to_string(), StateArray::Integer(text.collect()));
    }
    arrays
}

/// What the arrays of a step say.
fn restore(stored: &Stored, model: &Model) -> Result<RestoredPoint, Failure> {
    let at = || format!("step {} of {}", stored.step, stored.dir.display());
    let mut arrays = stored.arrays.clone();
    let reduction = take_arrays(&mut arrays);
    let counts = match arrays.remove(COUNTS) {
        Some(StateArray::Integer(counts)) if counts.len() == 3 => counts,
        _ => {
            return Err(anyhow!(
                "{} has no restart state of equilibria over time, as of an older version; run the scene again",
                at()
            )
            .into());
        }
    };
    let [rounds, newton, warned] = [0, 1, 2].map(|i| u64::try_from(counts[i]).unwrap_or(0));
    let warnings = match arrays.remove(WARNED) {
        Some(StateArray::Integer(bytes)) => {
            let bytes: Vec<u8> = bytes
                .into_iter()
                .filter_map(|byte| byte.try_into().ok())
                .collect();
            String::from_utf8_lossy(&bytes)
                .lines()
                .map(str::to_string)
                .collect()
        }
        _ => Vec::new(),
    };
    let (before, [start, from]) = rest_state::load_point(arrays, model).with_context(at)?;
    let start = start.unwrap_or_else(|| before.clone());
    Ok(RestoredPoint {
        taken: Taken {
            n: stored.step,
            from: from.or_else(|| (stored.step > 0).then(|| start.clone())),
            start,
            before,
        },
        counts: Counts {
            rounds,
            newton,
            warned,
        },
        warnings,
        reduction,
    })
}

/// A run under way.
struct QuasiStaticRun<'a, 's, 'scope> {
    scene: &'a Scene,
    settings: &'a scene::QuasiStatic,
    model: &'a Model,
    rolling: Option<&'a Rolling>,
    bearing: &'a QuasiStaticMotion<'a>,
    ahead: PointsAhead<'s, 'scope, SolvedPoint, ()>,
    /// Wall time of all points, summed over threads.
    laps: Laps,
    files: Files,
    counts: Counts,
    /// Those of the first instant that had any.
    warnings: Vec<String>,
    /// Number of the last equilibrium.
    step: u64,
    /// The last equilibrium.
    last: StaticSolution,
    written: WrittenSteps,
    dir: &'a Path,
}

impl QuasiStaticRun<'_, '_, '_> {
    /// Takes note of what the last equilibrium took.
    fn count(&mut self) {
        self.counts.rounds += self.last.rounds as u64;
        self.counts.newton += self.last.newton_iterations as u64;
        self.note_warnings();
    }

    /// A long run warns at thousands of instants: the first stands for all.
    fn note_warnings(&mut self) {
        let time = self.time(self.step);
        if self.last.warnings.is_empty() {
            return;
        }
        if self.warnings.is_empty() {
            let at = |warning: &String| format!("t = {time:.6e} s: {warning}");
            self.warnings = self.last.warnings.iter().map(at).collect();
        }
        self.counts.warned += 1;
    }

    /// Steps to the end of the run, closes the files and sums up, also when the run ends early.
    fn finish_run(mut self, mut progress: Progress, limits: &Limits, begun: Begun) -> Result<(), Failure> {
        let Begun { remarks, read, start } = begun;
        let (mut clock, first) = (Stopwatch::start(), self.step);
        let mut stop = agree(Stop::listen(start, limits.wall_time).map_err(Failure::from))?;
        let ended = instants::run(&mut self, first + 1, Some(&mut stop), &mut progress);
        self.ahead.end();
        let seconds = clock.lap();
        progress.finish();
        let (scene, model, settings) = (self.scene, self.model, self.settings);
        let seat = seat::of_run(model, &self.last, (self.dir, None));
        let findings = self.findings(&ended, remarks);
        let snapshot = findings.last.clone();
        let solver = &self.bearing.solver;
        let forecast = Side::BOTH.map(|side| solver.ring(side).map(|r| r.solver.memory));
        let forecast = Forecasts::of_points(forecast, (scene, model), 1 + settings.n_steps);
        let laps = solver.laps_with(&self.laps);
        let costs = agree(self.files.finish(read, forecast, laps, start));
        // A run that failed says why, not what its failure did to the files; one that stopped must have its step.
        let costs = match (costs, &ended) {
            (Err(_), Err(Failure::User(_) | Failure::Numerical(_))) => return ended,
            (costs, _) => costs?,
        };
        let summary = Summary::new(scene, model, findings, &costs)
            .with_life(life::of_run(scene, self.dir))
            .with_seats(agree(seat)?);
        agree(summary.write(self.dir).map_err(Failure::from))?;
        ended?;
        console::print_snapshot(&snapshot);
        let steps = self.step - first;
        print::line(format_args!("{}", instants::pace(steps, settings.step, seconds)));
        summary.print_costs();
        Ok(())
    }

    fn findings(&self, ended: &Result<(), Failure>, remarks: Remarks) -> Findings {
        let Counts {
            rounds,
            newton,
            warned,
        } = self.counts;
        let counted = [("steps", self.step), ("rounds", rounds), ("newton", newton)];
        let mut warnings = [remarks.warnings, self.warnings.clone()].concat();
        warnings.extend(instants::more_warn(warned));
        Findings {
            status: ended
                .as_ref()
                .err()
                .map_or("finished".to_string(), Failure::status),
            last: Snapshot::of_equilibrium(&self.last, self.rolling),
            points: Vec::new(),
            iterations: BTreeMap::from(counted.map(|(name, count)| (name, count as usize))),
            warnings,
            advice: remarks.advice,
        }
    }
}

impl OverInstants for QuasiStaticRun<'_, '_, '_> {
    fn due(&self) -> Due {
        Due {
            last: self.settings.n_steps,
            tables_every: self.scene.output.tables_every,
            files_every: self.settings.output_every,
        }
    }

    fn written(&mut self) -> &mut WrittenSteps {
        &mut self.written
    }

    fn dir(&self) -> &Path {
        self.dir
    }

    fn now(&self) -> u64 {
        self.step
    }

    fn time(&self, n: u64) -> f64 {
        self.bearing.time(n)
    }

    fn stage(&self, n: u64, _first: u64) -> Option<String> {
        (n % PROGRESS_STEPS == 1).then(|| self.step_text(n))
    }

    fn advance(&mut self, n: u64, _progress: &mut Progress) -> Result<(), Failure> {
        let next = self.ahead.take();
        let (next, ()) = next.map_err(|failure| instants::failed(self, "the last equilibrium", failure))?;
        self.laps.merge(&next.laps);
        self.last = next.solution;
        self.step = n;
        self.count();
        Ok(())
    }

    fn reduce(&mut self) -> Result<(), Failure> {
        let time = self.time(self.step);
        let shown = shown(self.model, &self.last);
        self.files.reduce(self.step, time, &shown, self.scene)
    }

    fn append_rows(&mut self) -> Result<(), Failure> {
        let (step, time) = (self.step, self.time(self.step));
        let snapshot = Snapshot::of_equilibrium(&self.last, self.rolling);
        self.files.write_tables(step, time, None, &snapshot)?;
        let shown = shown(self.model, &self.last);
        self.files.write_probes(step, time, None, &shown)
    }

    fn append_profiles(&mut self) -> Result<(), Failure> {
        let (step, time) = (self.step, self.time(self.step));
        self.files
            .write_profiles(step, time, None, &shown(self.model, &self.last))
    }

    fn append_files(&mut self, restart: RestartState) -> Result<(), Failure> {
        let (model, last, scene) = (self.model, &self.last, self.scene);
        let at = (self.step, self.time(self.step));
        let (apart, n_steps) = (self.settings.output_every, self.settings.n_steps);
        let kept = scene.output.every.kept(at.0, apart, n_steps);
        let gathered = self.files.gather_stress(&shown(model, last), kept);
        if !self.files.are_written_here() {
            return Ok(());
        }
        let taken = self.ahead.taken().expect("the last equilibrium has been taken");
        let state = arrays(taken, self.counts, &self.warnings);
        let record = Recorded::of_equilibrium(&shown(model, last), at, gathered, (scene, kept), state)?;
        self.files
            .write_fields_later(restart, move |stress| record.record(stress))
    }
}

fn shown<'a>(model: &'a Model, solution: &'a StaticSolution) -> Shown<'a> {
    Shown::at_rest(model, &model.geometry, solution)
}
