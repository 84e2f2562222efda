//! `raceway run` of a `[dynamic]` scene: static start, then steps in time with histories, step files and the ledger.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::anyhow;
use contact::Side;
use dynamics::motion::balls::Speed;
use dynamics::motion::contacts::{ContactDamping, ContactScheme};
use dynamics::motion::{Integrator, Motion, MotionSettings, MotionState};
use dynamics::{Model, StaticSolver, Timing};

use crate::build::build_model;
use crate::failure::Failure;
use crate::print;
use crate::progress::Progress;
use crate::results::files::Files;
use crate::results::probes::Probes;
use crate::results::shown::Shown;
use crate::results::snapshot::Snapshot;
use crate::results::summary::{Findings, Summary};
use crate::results::{console, motion_fields};
use crate::scene::{self, Dynamic, IntegratorChoice, Scene};

/// Steps between two lines of progress in a log.
const PROGRESS_STEPS: u64 = 50;

/// Runs the motion and returns the folder of its results.
pub fn run(scene: &Scene, dynamic: &Dynamic, dir: PathBuf, start: Instant) -> Result<PathBuf, Failure> {
    let mut progress = Progress::new(dynamic.n_steps);
    progress.stage("reading meshes");
    let (model, tags) = build_model(scene)?;
    let probes = Probes::new(scene, &model, &tags)?;
    let read = start.elapsed().as_secs_f64();
    progress.stage("static start");
    let mut statics = StaticSolver::new(&model).map_err(Failure::solving)?;
    let equilibrium = statics.solve(&model, None).map_err(Failure::solving)?;
    let forecast = Side::BOTH.map(|side| statics.ring(side).map(|r| r.memory));
    let timing = statics.timing;
    // The static factors are not needed any more; the motion has its own.
    drop(statics);
    progress.stage("factoring the effective matrices");
    let motion = Motion::new(&model, settings(scene, dynamic)).map_err(Failure::solving)?;
    let state = motion.start(&equilibrium);
    let mut files = Files::create(scene, &model, &dir, &Snapshot::of_motion(&motion, &state))?;
    files.add_probes(scene, &dir, probes)?;
    files
        .write_fields(|recoveries| motion_fields::record(&model, &motion, &state, recoveries, &scene.text))?;
    write_tables(&mut files, &model, &motion, &state)?;
    let clock = Instant::now();
    let mut march = March {
        scene,
        dynamic,
        model: &model,
        motion: &motion,
        files: &mut files,
        state,
        newton: 0,
    };
    let ended = march.run(&mut progress, &dir);
    let (state, newton) = (march.state, march.newton);
    progress.finish();
    let seconds = clock.elapsed().as_secs_f64();
    let spent = Timing {
        newton: timing.newton + seconds,
        ..timing
    };
    let costs = files.finish(read, forecast, spent, start)?;
    let findings = Findings {
        status: ended
            .as_ref()
            .err()
            .map_or("finished".to_string(), |f| format!("failed: {}", f.text())),
        last: Snapshot::of_motion(&motion, &state),
        points: Vec::new(),
        iterations: BTreeMap::from([("steps", state.step as usize), ("newton", newton)]),
        warnings: equilibrium.warnings.clone(),
        effect_seconds: motion.costs.seconds(),
    };
    let summary = Summary::new(scene, &model, findings, &costs);
    summary.write(&dir)?;
    ended?;
    console::print_snapshot(&Snapshot::of_motion(&motion, &state));
    print::line(format_args!(
        "{} steps of {} s, {:.1} ms per step; energy defect {:.1e} of the largest energy",
        state.step,
        dynamic.step,
        1e3 * seconds / dynamic.n_steps as f64,
        state.ledger.relative_defect()
    ));
    summary.print_costs();
    Ok(dir)
}

/// A run under way.
struct March<'a> {
    scene: &'a Scene,
    dynamic: &'a Dynamic,
    model: &'a Model,
    motion: &'a Motion<'a>,
    files: &'a mut Files,
    /// The last good state.
    state: MotionState,
    /// Newton iterations so far.
    newton: usize,
}

impl March<'_> {
    /// Steps to the end of the run. On failure the last good state has its step file.
    fn run(&mut self, progress: &mut Progress, dir: &Path) -> Result<(), Failure> {
        let n_steps = self.dynamic.n_steps;
        for n in 1..=n_steps {
            if n % PROGRESS_STEPS == 1 {
                progress.stage(&format!(
                    "step {n} of {n_steps}, t = {:.4e} s",
                    self.motion.time(n)
                ));
            }
            match self.motion.step(&self.state) {
                Ok((next, report)) => {
                    self.newton += report.newton_iterations;
                    self.state = next;
                }
                Err(error) => {
                    if !self.has_file(n - 1) {
                        self.write_fields()?;
                    }
                    let time = self.motion.time(n);
                    let place = format!(
                        "step {n}, t = {time:.6e} s; the last good state is in {}",
                        dir.display()
                    );
                    return Err(Failure::solving(error).context(place));
                }
            }
            if self.has_file(n) {
                self.write_fields()?;
            }
            write_tables(self.files, self.model, self.motion, &self.state)?;
            check_ledger(self.dynamic, self.motion, &self.state, dir)?;
            progress.advance();
        }
        Ok(())
    }

    /// Whether a step's fields are written.
    fn has_file(&self, step: u64) -> bool {
        step == self.dynamic.n_steps || step.is_multiple_of(self.dynamic.output_every)
    }

    fn write_fields(&mut self) -> Result<(), Failure> {
        let (model, motion, state, text) = (self.model, self.motion, &self.state, &self.scene.text);
        self.files
            .write_fields(|recoveries| motion_fields::record(model, motion, state, recoveries, text))
    }
}

fn write_tables(
    files: &mut Files,
    model: &Model,
    motion: &Motion<'_>,
    state: &MotionState,
) -> Result<(), Failure> {
    let time = motion.time(state.step);
    files.write_tables(state.step, time, None, &Snapshot::of_motion(motion, state))?;
    let shown = Shown::Motion { model, motion, state };
    files.write_probes(state.step, time, None, &shown)
}

/// Stops a run whose energy ledger does not close.
fn check_ledger(
    dynamic: &Dynamic,
    motion: &Motion<'_>,
    state: &MotionState,
    dir: &Path,
) -> Result<(), Failure> {
    let defect = state.ledger.relative_defect();
    // A dissipating scheme of the rings may lose energy, but nothing may gain any.
    let may_lose = !integrator_of(dynamic).is_conserving();
    if defect.abs() <= dynamic.ledger_tolerance || (may_lose && defect < 0.0) {
        return Ok(());
    }
    Err(Failure::Numerical(anyhow!(
        "the energy ledger does not close at step {}, t = {:.6e} s: the defect is {defect:.3e} of the largest energy, \
         dynamic.ledger_tolerance is {:.1e}; use contact = \"discrete_gradient\" with integrator = \
         \"average_acceleration\", a smaller step, or a larger tolerance; histories up to here are in {}",
        state.step,
        motion.time(state.step),
        dynamic.ledger_tolerance,
        dir.display()
    )))
}

fn integrator_of(dynamic: &Dynamic) -> Integrator {
    match dynamic.integrator {
        IntegratorChoice::AverageAcceleration => Integrator::average_acceleration(),
        IntegratorChoice::ChungHulbert { rho } => Integrator::chung_hulbert(rho),
        IntegratorChoice::Hht { alpha } => Integrator::hht(alpha),
        IntegratorChoice::Newmark { beta, gamma } => Integrator::newmark(beta, gamma),
    }
}

fn settings(scene: &Scene, dynamic: &Dynamic) -> MotionSettings {
    let integrator = integrator_of(dynamic);
    MotionSettings {
        dt: dynamic.step,
        integrator,
        scheme: match dynamic.contact {
            scene::ContactScheme::DiscreteGradient => ContactScheme::DiscreteGradient,
            scene::ContactScheme::Pointwise => ContactScheme::Pointwise {
                weight: integrator.alpha_f,
            },
        },
        speed: speed(scene),
        slip: scene.effects.cage_slip.unwrap_or([0.0; 2]),
        contact_damping: scene.effects.contact_damping.map(|d| ContactDamping {
            coefficient: d.coefficient,
            full_approach: d.full_approach,
        }),
        rayleigh: scene
            .effects
            .rayleigh_damping
            .map_or([0.0; 2], |d| [d.mass, d.stiffness]),
    }
}

/// Speed of the inner ring; at rest when the scene names none.
pub fn speed(scene: &Scene) -> Speed {
    match &scene.speed {
        Some(table) => Speed::table(table.times.clone(), table.values.clone()),
        None => Speed::constant(0.0),
    }
}
