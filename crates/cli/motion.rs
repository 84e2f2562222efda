//! `raceway run` of a `[dynamic]` scene: static start, then steps in time with histories, step files and the ledger.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use comm::print;
use contact::Side;
use dynamics::Model;
use dynamics::costs::{EFFECTS, FACTOR};
use dynamics::motion::ledger::LOSSY;
use dynamics::motion::{Motion, MotionState, StepCache};
use results::console;
use results::disk::Forecast;
use results::failure::{Failure, agree};
use results::files::{Files, ResumedFrom, say_folder};
use results::memory::Forecasts;
use results::motion_fields::{Recorded, RestartState};
use results::seat;
use results::shown::Shown;
use results::snapshot::Snapshot;
use results::stop::Stop;
use results::summary::{Findings, Summary};
use results::survey::build_surveyed;
use results::watch::Watch;
use scene::{Dynamic, KeptFields, Scene, settings};
use timer::{Laps, Stopwatch};

use crate::instants::{self, Due, OverInstants, PROGRESS_STEPS, WrittenSteps};
use crate::ledger_check::check_ledger;
use crate::options::Limits;
use crate::progress::Progress;
use crate::remarks::Remarks;
use crate::start::settle;
use crate::stored::{RestartedFrom, Stored};

/// What is saved when a step fails.
pub const LAST_GOOD: &str = "the last good state";

/// Runs the motion from its static equilibrium.
pub fn run(
    scene: &Scene,
    dynamic: &Dynamic,
    dir: &Path,
    limits: &Limits,
    start: Instant,
) -> Result<(), Failure> {
    let progress = Progress::new(dynamic.n_steps);
    progress.stage("reading meshes");
    let (model, mut survey) = agree(build_surveyed(scene, scene, dir, |model| {
        Forecast::new(scene, model, 0).require_space(dir, limits.ignore_disk_space)
    }))?;
    let remarks = Remarks::on(scene, &model, std::mem::take(&mut survey.doubts))?;
    let read = start.elapsed().as_secs_f64();
    let settled = settle(scene, &model, dynamic, &progress)?;
    let mut laps = settled.timing.clone();
    progress.stage("factoring the effective matrices");
    let motion = factored(&model, scene, dynamic, &mut laps)?;
    say_solvers(&motion, &progress);
    let state = settled.first_state(&motion, dynamic)?;
    let first = Snapshot::of_motion(&motion, &state);
    let files = agree(Files::create(
        scene,
        &model,
        dir,
        &first,
        survey,
        &settled.warnings(),
    ))?;
    let mut march = March {
        scene,
        dynamic,
        model: &model,
        motion: &motion,
        files,
        state,
        cache: StepCache::default(),
        newton: 0,
        laps,
        watch: Watch::new(model.geometry.n_balls),
        written: WrittenSteps::default(),
        dir,
    };
    instants::record(&mut march, RestartState::Stored)?;
    let costs = StartCosts {
        read,
        forecast: Forecasts::of_motion(settled.forecast, &motion, (scene, dynamic)),
        start,
    };
    march.finish_run(progress, limits, remarks.with(settled.warnings()), costs)
}

/// Goes on with the motion from a stored step.
pub fn resume(
    scene: &Scene,
    dynamic: &Dynamic,
    stored: Stored,
    limits: &Limits,
    start: Instant,
) -> Result<(), Failure> {
    let dir = stored.dir.clone();
    let mut progress = Progress::new(dynamic.n_steps);
    progress.start_at(stored.step);
    progress.stage("reading meshes");
    let (model, mut survey) = agree(build_surveyed(scene, scene, &dir, |model| {
        Forecast::new(scene, model, stored.step).require_space(&dir, limits.ignore_disk_space)
    }))?;
    let remarks = Remarks::on(scene, &model, std::mem::take(&mut survey.doubts))?;
    let read = start.elapsed().as_secs_f64();
    progress.stage("factoring the effective matrices");
    let mut laps = Laps::default();
    let motion = factored(&model, scene, dynamic, &mut laps)?;
    say_solvers(&motion, &progress);
    let RestartedFrom {
        state,
        newton,
        watch,
        reduction,
    } = agree(stored.state(&motion))?;
    let (first, warnings) = (Snapshot::of_motion(&motion, &state), stored.warnings);
    let from = ResumedFrom {
        step: state.step,
        tables: stored.tables.as_ref(),
        warnings: &warnings,
        reduction: &reduction,
    };
    let files = agree(Files::resume(scene, &model, stored.lock, &first, survey, &from))?;
    if files.are_written_here() {
        say_folder(&dir);
    }
    let march = March {
        scene,
        dynamic,
        model: &model,
        motion: &motion,
        files,
        written: WrittenSteps::all_of(state.step),
        state,
        cache: StepCache::default(),
        newton,
        laps,
        watch,
        dir: &dir,
    };
    let costs = StartCosts {
        read,
        forecast: Forecasts::of_motion([None, None], &motion, (scene, dynamic)),
        start,
    };
    march.finish_run(progress, limits, remarks.with(warnings), costs)
}

/// The model ready to move, with its matrices and factors.
fn factored<'a>(
    model: &'a Model,
    scene: &Scene,
    dynamic: &Dynamic,
    laps: &mut Laps,
) -> Result<Motion<'a>, Failure> {
    let motion = laps.time(FACTOR, || Motion::new(model, settings(scene, dynamic)));
    motion.map_err(Failure::solving)
}

/// Says how each ring is solved.
fn say_solvers(motion: &Motion<'_>, progress: &Progress) {
    for side in Side::BOTH {
        let notes = [
            motion.solver_note(side),
            motion.left_out(side).map(|of| of.note()),
        ];
        for note in notes.into_iter().flatten() {
            progress.stage(&format!("{} ring: {note}", side.name()));
        }
    }
}

/// What the start of a run cost.
struct StartCosts {
    read: f64,
    forecast: Forecasts,
    start: Instant,
}

/// A run under way.
struct March<'a> {
    scene: &'a Scene,
    dynamic: &'a Dynamic,
    model: &'a Model,
    motion: &'a Motion<'a>,
    files: Files,
    /// The last good state.
    state: MotionState,
    cache: StepCache,
    /// Newton iterations so far.
    newton: u64,
    /// Wall time so far, files and effects apart.
    laps: Laps,
    /// Contacts beyond their limits so far.
    watch: Watch,
    written: WrittenSteps,
    dir: &'a Path,
}

impl March<'_> {
    /// Steps to the end of the run, closes the files and sums up, also when the run ends early.
    fn finish_run(
        mut self,
        mut progress: Progress,
        limits: &Limits,
        remarks: Remarks,
        costs: StartCosts,
    ) -> Result<(), Failure> {
        let mut clock = Stopwatch::start();
        let first = self.state.step;
        let mut stop = agree(Stop::listen(costs.start, limits.wall_time).map_err(Failure::from))?;
        let ended = instants::run(&mut self, first + 1, Some(&mut stop), &mut progress);
        progress.finish();
        let seconds = clock.lap();
        let (mut laps, effects) = (self.laps, self.motion.costs.laps());
        laps.merge_into(EFFECTS, &effects);
        let finished = self.files.finish(costs.read, costs.forecast, laps, costs.start);
        let costs = agree(finished);
        // A run that failed says why, not what its failure did to the files; one that stopped must have its step.
        let costs = match (costs, &ended) {
            (Err(_), Err(Failure::User(_) | Failure::Numerical(_))) => return ended,
            (costs, _) => costs?,
        };
        let (state, motion) = (&self.state, self.motion);
        let mut warnings = remarks.warnings;
        warnings.extend(self.watch.warnings(motion.surfaces(), |step| motion.time(step)));
        warnings.extend(lossy(state));
        let findings = Findings {
            status: ended
                .as_ref()
                .err()
                .map_or("finished".to_string(), Failure::status),
            last: Snapshot::of_motion(motion, state),
            points: Vec::new(),
            iterations: BTreeMap::from([("steps", state.step as usize), ("newton", self.newton as usize)]),
            warnings,
            advice: remarks.advice,
        };
        let summary = Summary::new(self.scene, self.model, findings, &costs)
            .with_life(life::of_run(self.scene, self.dir))
            .with_seats(agree(seat::of_motion(motion, state, (self.dir, None)))?);
        agree(summary.write(self.dir).map_err(Failure::from))?;
        ended?;
        console::print_snapshot(&Snapshot::of_motion(motion, state));
        print::line(format_args!(
            "{}; energy defect {:.1e} of the largest energy",
            instants::pace(state.step - first, self.dynamic.step, seconds),
            state.ledger.relative_defect()
        ));
        summary.print_costs();
        Ok(())
    }

    /// The fields that the file of this step holds.
    fn kept(&self) -> KeptFields {
        let (apart, last) = (self.dynamic.output_every, self.dynamic.n_steps);
        self.scene.output.every.kept(self.state.step, apart, last)
    }
}

impl OverInstants for March<'_> {
    fn due(&self) -> Due {
        Due {
            last: self.dynamic.n_steps,
            tables_every: self.scene.output.tables_every,
            files_every: self.dynamic.output_every,
        }
    }

    fn written(&mut self) -> &mut WrittenSteps {
        &mut self.written
    }

    fn dir(&self) -> &Path {
        self.dir
    }

    fn now(&self) -> u64 {
        self.state.step
    }

    fn time(&self, n: u64) -> f64 {
        self.motion.time(n)
    }

    fn stage(&self, n: u64, first: u64) -> Option<String> {
        (n == first || n % PROGRESS_STEPS == 1).then(|| {
            let waited = self.files.waited().as_secs_f64();
            format!("{}, waited {waited:.2} s for the disk", self.step_text(n))
        })
    }

    fn advance(&mut self, n: u64, progress: &mut Progress) -> Result<(), Failure> {
        let found = self.motion.step(&self.state, &mut self.cache);
        let (next, report) =
            found.map_err(|error| instants::failed(self, LAST_GOOD, Failure::solving(error)))?;
        self.newton += report.newton_iterations as u64;
        self.laps.merge(&report.laps);
        if let Err(failure) = check_ledger(self.dynamic, self.motion, &next, self.dir) {
            return Err(instants::rejected(self, failure, |march| march.state = next));
        }
        self.state = next;
        let found = self.motion.exceeded(&self.state);
        for text in self.watch.note(n, self.motion.time(n), &found) {
            progress.warn(&text);
        }
        Ok(())
    }

    fn restart_at(&self, n: u64) -> RestartState {
        RestartState::at(n, self.dynamic, &self.scene.output)
    }

    fn reduce(&mut self) -> Result<(), Failure> {
        let (model, motion) = (self.model, self.motion);
        if !self.files.reduces(self.state.step, motion.time(self.state.step)) {
            return Ok(());
        }
        let state = &*motion.gathered(&self.state);
        let shown = Shown::Motion { model, motion, state };
        self.files
            .reduce(state.step, motion.time(state.step), &shown, self.scene)
    }

    /// What is collective comes before what rank 0 alone may fail in.
    fn append_rows(&mut self) -> Result<(), Failure> {
        let (model, motion) = (self.model, self.motion);
        let state = match self.scene.probes.is_empty() {
            true => Cow::Borrowed(&self.state),
            false => motion.gathered(&self.state),
        };
        let (state, time) = (&*state, motion.time(self.state.step));
        let snapshot = Snapshot::of_motion(motion, state);
        self.files.write_tables(state.step, time, None, &snapshot)?;
        let shown = Shown::Motion { model, motion, state };
        self.files.write_probes(state.step, time, None, &shown)
    }

    fn append_profiles(&mut self) -> Result<(), Failure> {
        if self.scene.probes.profiles.is_empty() {
            return Ok(());
        }
        let (model, motion) = (self.model, self.motion);
        let state = &*motion.gathered(&self.state);
        let (shown, time) = (Shown::Motion { model, motion, state }, motion.time(state.step));
        self.files.write_profiles(state.step, time, None, &shown)
    }

    fn append_files(&mut self, restart: RestartState) -> Result<(), Failure> {
        let (model, motion) = (self.model, self.motion);
        let state = &*motion.gathered(&self.state);
        let shown = Shown::Motion { model, motion, state };
        let kept = self.kept();
        let gathered = self.files.gather_stress(&shown, kept);
        if !self.files.are_written_here() {
            return Ok(());
        }
        let shown = Recorded::new(model, motion, state, gathered, (self.scene, kept), restart)?;
        let (newton, watch) = (self.newton, self.watch.clone());
        self.files.write_fields_later(restart, move |stress| {
            let mut record = shown.record(stress);
            if restart == RestartState::Stored {
                Stored::add_counts(&mut record, newton, &watch);
            }
            record
        })
    }
}

/// A warning when the integrator took much of the energy.
fn lossy(state: &MotionState) -> Option<String> {
    let share = state.ledger.numerical_share();
    (share > LOSSY).then(|| {
        format!(
            "the integrator took {:.0} % of the largest energy of the motion; if that is not wanted, take a smaller \
             step or less of its damping",
            100.0 * share
        )
    })
}
