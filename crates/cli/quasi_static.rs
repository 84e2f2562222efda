//! `raceway run` of a `[quasi_static]` scene: equilibria in time, each started from the one before.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use comm::print;
use contact::Side;
use dynamics::kinematics::{Rolling, Speed};
use dynamics::{Model, QuasiStaticMotion, StaticSolution};
use results::disk::Forecast;
use results::failure::{Failure, agree};
use results::files::Files;
use results::memory::Forecasts;
use results::motion_fields::RestartState;
use results::shown::Shown;
use results::snapshot::Snapshot;
use results::summary::{Findings, Summary};
use results::survey::build_surveyed;
use results::{console, fields, seat};
use scene::{Scene, rolling};
use timer::Stopwatch;

use crate::instants::{self, Due, OverInstants, PROGRESS_STEPS, WrittenSteps};
use crate::options::Limits;
use crate::progress::Progress;
use crate::remarks::Remarks;

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
    let mut bearing = QuasiStaticMotion::new(&model, turning, settings.step).map_err(Failure::solving)?;
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
    let files = agree(files)?;
    let mut series = QuasiStaticRun {
        scene,
        settings,
        model: &model,
        rolling: rolling.as_ref(),
        bearing: &mut bearing,
        files,
        iterations: [0; 3],
        warnings: Vec::new(),
        warned: 0,
        step: 0,
        last: first,
        written: WrittenSteps::default(),
        dir,
    };
    let mut clock = Stopwatch::start();
    let ended = series.run(&mut progress);
    let seconds = clock.lap();
    progress.finish();
    series.finish_run((ended, seconds), remarks, (read, start))
}

/// A run under way.
struct QuasiStaticRun<'a, 'm> {
    scene: &'a Scene,
    settings: &'a scene::QuasiStatic,
    model: &'a Model,
    rolling: Option<&'a Rolling>,
    bearing: &'a mut QuasiStaticMotion<'m>,
    files: Files,
    /// Steps done, rounds and Newton iterations so far.
    iterations: [usize; 3],
    /// Those of the first instant that had any.
    warnings: Vec<String>,
    /// Number of instants that had some.
    warned: u64,
    /// Number of the last equilibrium.
    step: u64,
    /// The last equilibrium.
    last: StaticSolution,
    written: WrittenSteps,
    dir: &'a Path,
}

impl QuasiStaticRun<'_, '_> {
    /// Steps to the end of the run. On failure the last equilibrium has its step file.
    fn run(&mut self, progress: &mut Progress) -> Result<(), Failure> {
        self.count();
        instants::record(self, RestartState::Stored)?;
        progress.advance();
        instants::run(self, 1, None, progress)
    }

    /// Takes note of what the last equilibrium took.
    fn count(&mut self) {
        self.iterations[0] = self.step as usize;
        self.iterations[1] += self.last.rounds;
        self.iterations[2] += self.last.newton_iterations;
        self.note_warnings();
    }

    /// A long run warns at thousands of instants: the first stands for all.
    fn note_warnings(&mut self) {
        let time = self.time(self.step);
        if self.last.warnings.is_empty() {
            return;
        }
        if self.warned == 0 {
            let at = |warning: &String| format!("t = {time:.6e} s: {warning}");
            self.warnings = self.last.warnings.iter().map(at).collect();
        }
        self.warned += 1;
    }

    /// Closes the files, writes the summary, and prints the results of a run without a failure, which took so many
    /// seconds; it was read until `read`, s, after `start`.
    fn finish_run(
        self,
        (ended, seconds): (Result<(), Failure>, f64),
        remarks: Remarks,
        (read, start): (f64, Instant),
    ) -> Result<(), Failure> {
        let (scene, model, settings) = (self.scene, self.model, self.settings);
        let seat = seat::of_run(model, &self.last, self.dir);
        let findings = self.findings(&ended, remarks);
        let snapshot = findings.last.clone();
        let solver = &self.bearing.solver;
        let forecast = Side::BOTH.map(|side| solver.ring(side).map(|r| r.solver.memory));
        let forecast = Forecasts::at_rest(forecast, model);
        let costs = agree(self.files.finish(read, forecast, solver.laps(), start));
        // A run that failed says why, not what its failure did to the files.
        let costs = match (costs, &ended) {
            (Err(_), Err(_)) => return ended,
            (costs, _) => costs?,
        };
        let summary = Summary::new(scene, model, findings, &costs)
            .with_life(life::of_run(scene, self.dir))
            .with_seats(agree(seat)?);
        agree(summary.write(self.dir).map_err(Failure::from))?;
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

    fn findings(&self, ended: &Result<(), Failure>, remarks: Remarks) -> Findings {
        let [steps, rounds, newton] = self.iterations;
        let mut warnings = [remarks.warnings, self.warnings.clone()].concat();
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

impl OverInstants for QuasiStaticRun<'_, '_> {
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
        let next = self.bearing.step(n, Some(&self.last));
        self.last =
            next.map_err(|error| instants::failed(self, "the last equilibrium", Failure::solving(error)))?;
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

    fn append_files(&mut self, _restart: RestartState) -> Result<(), Failure> {
        let (model, last, scene) = (self.model, &self.last, self.scene);
        let at = (self.step, self.time(self.step));
        let (apart, n_steps) = (self.settings.output_every, self.settings.n_steps);
        let kept = scene.output.every.kept(at.0, apart, n_steps);
        let gathered = self.files.gather_stress(&shown(model, last), kept);
        self.files.write_profiles(at.0, at.1, None, &shown(model, last))?;
        self.files.write_fields(|stress| {
            fields::record(&shown(model, last), last, (stress, gathered), at, (scene, kept))
        })
    }
}

fn shown<'a>(model: &'a Model, solution: &'a StaticSolution) -> Shown<'a> {
    Shown::at_rest(model, &model.geometry, solution)
}
