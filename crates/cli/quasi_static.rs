//! `raceway run` of a `[quasi_static]` scene: equilibria in time, each started from the one before.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use comm::print;
use contact::Side;
use dynamics::kinematics::{Rolling, Speed};
use dynamics::{Model, QuasiStatic, StaticSolution};
use results::disk::Forecast;
use results::failure::{Failure, agree, of_all};
use results::files::Files;
use results::memory::Forecasts;
use results::shown::Shown;
use results::snapshot::Snapshot;
use results::summary::{Findings, Summary};
use results::survey::build_surveyed;
use results::{console, fields, seat};
use scene::{Scene, rolling};
use timer::Stopwatch;

use crate::options::Limits;
use crate::progress::Progress;
use crate::remarks::Remarks;

/// Steps between two lines of progress in a log.
const PROGRESS_STEPS: u64 = 50;

/// Runs the equilibria.
pub fn run(
    scene: &Scene,
    settings: &scene::QuasiStatic,
    dir: &Path,
    limits: &Limits,
    start: Instant,
) -> Result<(), Failure> {
    let mut progress = Progress::new(1 + settings.n_steps);
    progress.stage("reading meshes");
    let (model, mut survey) = agree(build_surveyed(scene, scene, dir, |model| {
        Forecast::new(scene, model, 0).require_space(dir, limits.ignore_disk_space)
    }))?;
    let remarks = Remarks::on(scene, &model, std::mem::take(&mut survey.doubts))?;
    let read = start.elapsed().as_secs_f64();
    progress.stage("factoring the stiffness of the rings");
    let rolling = rolling(scene);
    let at_rest = || Rolling::new(&model.geometry, Speed::constant(0.0), [0.0; 2]);
    let turning = rolling.clone().unwrap_or_else(at_rest);
    let mut bearing = QuasiStatic::new(&model, turning, settings.step).map_err(Failure::solving)?;
    progress.stage("first equilibrium");
    let first = bearing.step(0, None).map_err(Failure::solving)?;
    // The first solution makes the folder: a scene that has none leaves no files.
    let files = Files::create(
        scene,
        &model,
        dir,
        &Snapshot::of_equilibrium(&first, rolling.as_ref()),
        survey,
        &first.warnings,
    );
    let mut files = agree(files)?;
    let mut series = Series {
        scene,
        settings,
        model: &model,
        rolling: rolling.as_ref(),
        files: &mut files,
        iterations: [0; 3],
        warnings: Vec::new(),
        warned: 0,
        last: first,
    };
    let mut clock = Stopwatch::start();
    let ended = series.run(&mut bearing, &mut progress, dir);
    let seconds = clock.lap();
    progress.finish();
    let seat = seat::of_run(&model, &series.last, dir);
    let findings = series.findings(&ended, remarks);
    let snapshot = findings.last.clone();
    let forecast = Side::BOTH.map(|side| bearing.solver.ring(side).map(|r| r.solver.memory));
    let costs = agree(files.finish(
        read,
        Forecasts::at_rest(forecast, &model),
        bearing.solver.laps(),
        start,
    ));
    // A run that failed says why, not what its failure did to the files.
    let costs = match (costs, &ended) {
        (Err(_), Err(_)) => return ended,
        (costs, _) => costs?,
    };
    let summary = Summary::new(scene, &model, findings, &costs)
        .with_life(life::of_run(scene, dir))
        .with_seats(agree(seat)?);
    agree(summary.write(dir).map_err(Failure::from))?;
    ended?;
    console::print_snapshot(&snapshot);
    let steps = settings.n_steps;
    print::line(format_args!(
        "{steps} steps of {} s, {:.1} ms per step",
        settings.step,
        1e3 * seconds / steps as f64
    ));
    summary.print_costs();
    Ok(())
}

/// A run under way.
struct Series<'a> {
    scene: &'a Scene,
    settings: &'a scene::QuasiStatic,
    model: &'a Model,
    rolling: Option<&'a Rolling>,
    files: &'a mut Files,
    /// Steps done, rounds and Newton iterations so far.
    iterations: [usize; 3],
    /// Those of the first instant that had any.
    warnings: Vec<String>,
    /// Number of instants that had some.
    warned: u64,
    /// The last equilibrium.
    last: StaticSolution,
}

impl Series<'_> {
    /// Steps to the end of the run. On failure the last equilibrium has its step file.
    fn run(
        &mut self,
        bearing: &mut QuasiStatic<'_>,
        progress: &mut Progress,
        dir: &Path,
    ) -> Result<(), Failure> {
        self.write(bearing, 0)?;
        progress.advance();
        let n_steps = self.settings.n_steps;
        for n in 1..=n_steps {
            if n % PROGRESS_STEPS == 1 {
                progress.stage(&format!("step {n} of {n_steps}, t = {:.4e} s", bearing.time(n)));
            }
            match bearing.step(n, Some(&self.last)) {
                Ok(next) => self.last = next,
                Err(error) => {
                    let failure = of_all(Failure::solving(error));
                    if !self.has_file(n - 1) {
                        if !(n - 1).is_multiple_of(self.scene.output.tables_every) {
                            agree(self.write_tables(bearing.time(n - 1), n - 1))?;
                        }
                        agree(self.write_fields(bearing, n - 1))?;
                    }
                    let place = format!(
                        "step {n}, t = {:.6e} s; the last equilibrium is in {}",
                        bearing.time(n),
                        dir.display()
                    );
                    return Err(failure.context(place));
                }
            }
            self.write(bearing, n)?;
            progress.advance();
        }
        Ok(())
    }

    /// Whether a step's fields are written.
    fn has_file(&self, step: u64) -> bool {
        step == self.settings.n_steps || step.is_multiple_of(self.settings.output_every)
    }

    /// Writes a step and takes note of what it took. Collective.
    fn write(&mut self, bearing: &QuasiStatic<'_>, step: u64) -> Result<(), Failure> {
        self.iterations[0] = step as usize;
        self.iterations[1] += self.last.rounds;
        self.iterations[2] += self.last.newton_iterations;
        self.note_warnings(bearing.time(step));
        let reduced = self.files.reduce(
            step,
            bearing.time(step),
            &shown(self.model, &self.last),
            self.scene,
        );
        agree(reduced)?;
        if step.is_multiple_of(self.scene.output.tables_every) || self.has_file(step) {
            agree(self.write_tables(bearing.time(step), step))?;
        }
        if self.has_file(step) {
            agree(self.write_fields(bearing, step))?;
        }
        Ok(())
    }

    /// Appends a line per table.
    fn write_tables(&mut self, time: f64, step: u64) -> Result<(), Failure> {
        let snapshot = Snapshot::of_equilibrium(&self.last, self.rolling);
        self.files.write_tables(step, time, None, &snapshot)?;
        let shown = shown(self.model, &self.last);
        self.files.write_probes(step, time, None, &shown)
    }

    /// A long run warns at thousands of instants: the first stands for all.
    fn note_warnings(&mut self, time: f64) {
        if self.last.warnings.is_empty() {
            return;
        }
        if self.warned == 0 {
            let at = |warning: &String| format!("t = {time:.6e} s: {warning}");
            self.warnings = self.last.warnings.iter().map(at).collect();
        }
        self.warned += 1;
    }

    /// Writes the fields of a step; ranks recover its stress first.
    fn write_fields(&mut self, bearing: &QuasiStatic<'_>, step: u64) -> Result<(), Failure> {
        let (model, last, scene) = (self.model, &self.last, self.scene);
        let kept = scene
            .output
            .every
            .kept(step, self.settings.output_every, self.settings.n_steps);
        let gathered = self.files.gather_stress(&shown(model, last), kept);
        let at = (step, bearing.time(step));
        self.files.write_profiles(step, at.1, None, &shown(model, last))?;
        self.files.write_fields(|stress| {
            fields::record(&shown(model, last), last, (stress, gathered), at, (scene, kept))
        })
    }

    fn findings(self, ended: &Result<(), Failure>, remarks: Remarks) -> Findings {
        let [steps, rounds, newton] = self.iterations;
        let mut warnings = [remarks.warnings, self.warnings].concat();
        if self.warned > 1 {
            warnings.push(format!(
                "{} instants have warnings; those of the first are given",
                self.warned
            ));
        }
        Findings {
            status: ended
                .as_ref()
                .err()
                .map_or("finished".to_string(), Failure::status),
            last: Snapshot::of_equilibrium(&self.last, self.rolling),
            points: Vec::new(),
            iterations: BTreeMap::from([("steps", steps), ("rounds", rounds), ("newton", newton)]),
            warnings,
            advice: remarks.advice,
        }
    }
}

fn shown<'a>(model: &'a Model, solution: &'a StaticSolution) -> Shown<'a> {
    Shown::at_rest(model, &model.geometry, solution)
}
