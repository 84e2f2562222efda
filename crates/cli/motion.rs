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
    let model = build_model(scene)?;
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
    write(&mut files, scene, &model, &motion, &state, Fields::Write)?;
    let clock = Instant::now();
    let (state, newton) = march(
        scene,
        dynamic,
        &model,
        &motion,
        state,
        &mut files,
        &mut progress,
        &dir,
    )?;
    progress.finish();
    let seconds = clock.elapsed().as_secs_f64();
    let costs = files.finish(
        read,
        forecast,
        Timing {
            newton: timing.newton + seconds,
            ..timing
        },
        start,
    )?;
    let last = Snapshot::of_motion(&motion, &state);
    console::print_snapshot(&last);
    let findings = Findings {
        last,
        points: Vec::new(),
        iterations: BTreeMap::from([("steps", state.step as usize), ("newton", newton)]),
        warnings: equilibrium.warnings.clone(),
    };
    print::line(format_args!(
        "{} steps of {} s, {:.1} ms per step; energy defect {:.1e} of the largest energy",
        state.step,
        dynamic.step,
        1e3 * seconds / dynamic.n_steps as f64,
        state.ledger.relative_defect()
    ));
    let summary = Summary::new(scene, &model, findings, &costs);
    summary.write(&dir)?;
    summary.print_costs();
    Ok(dir)
}

/// Whether a step's fields are written besides its tables.
#[derive(Clone, Copy, PartialEq)]
enum Fields {
    Write,
    Skip,
}

#[expect(
    clippy::too_many_arguments,
    reason = "the parts of one run; a struct of them would have no other use"
)]
fn march(
    scene: &Scene,
    dynamic: &Dynamic,
    model: &Model,
    motion: &Motion<'_>,
    mut state: MotionState,
    files: &mut Files,
    progress: &mut Progress,
    dir: &Path,
) -> Result<(MotionState, usize), Failure> {
    let mut newton = 0;
    for n in 1..=dynamic.n_steps {
        if n % PROGRESS_STEPS == 1 {
            progress.stage(&format!(
                "step {n} of {}, t = {:.4e} s",
                dynamic.n_steps,
                motion.time(n)
            ));
        }
        let (next, report) = match motion.step(&state) {
            Ok(done) => done,
            Err(error) => {
                // The last good state is the one worth looking at.
                write(files, scene, model, motion, &state, Fields::Write)?;
                let place = format!(
                    "step {n}, t = {:.6e} s; the last good state is in {}",
                    motion.time(n),
                    dir.display()
                );
                return Err(Failure::solving(error).context(place));
            }
        };
        newton += report.newton_iterations;
        state = next;
        let last = n == dynamic.n_steps;
        let fields = if last || n.is_multiple_of(dynamic.output_every) {
            Fields::Write
        } else {
            Fields::Skip
        };
        write(files, scene, model, motion, &state, fields)?;
        check_ledger(dynamic, motion, &state, dir)?;
        progress.advance();
    }
    Ok((state, newton))
}

fn write(
    files: &mut Files,
    scene: &Scene,
    model: &Model,
    motion: &Motion<'_>,
    state: &MotionState,
    fields: Fields,
) -> Result<(), Failure> {
    if fields == Fields::Write {
        files.write_fields(|recoveries| {
            motion_fields::record(model, motion, state, recoveries, &scene.text)
        })?;
    }
    files.write_tables(
        state.step,
        motion.time(state.step),
        None,
        &Snapshot::of_motion(motion, state),
    )
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
