//! `raceway run` of a `[modes]` scene: natural frequencies and shapes of rings alone and of the loaded bearing.

use std::path::Path;
use std::time::Instant;

use anyhow::anyhow;
use comm::Communicator;
use contact::Side;
use dense::Searched;
use dynamics::modes::{bearing_modes, ring_modes};
use dynamics::{ModeSet, Model, ModesSettings, RingSupport, StaticSolution, StaticSolver};
use results::disk::Forecast;
use results::failure::Failure;
use results::memory::require_memory;
use results::modes::{ModeFiles, ModesSummary, print_modes};
use results::snapshot::Snapshot;
use results::survey::say_doubts;
use scene::{ModeBody, ModeSupport, Modes, RingName, Scene, SceneBody, build_model, doubts};

use crate::options::Limits;
use crate::progress::Progress;
use crate::remarks::Remarks;

/// Blocks of the search between two lines of progress in a log.
const PROGRESS_STEPS: usize = 10;

/// Share of the frequency up to which a body keeps its modes where those of ring and body are good to 1 %.
const RESOLVED: f64 = 0.25;

/// Computes the modes.
pub fn run(
    scene: &Scene,
    wanted: &Modes,
    dir: &Path,
    limits: &Limits,
    start: Instant,
) -> Result<(), Failure> {
    require_one_process()?;
    let mut progress = Progress::new(wanted.bodies.len() as u64);
    progress.stage("reading meshes");
    let (model, _) = build_model(scene)?;
    require_memory(scene, &model)?;
    let doubts = doubts(scene, &model);
    say_doubts(&doubts);
    let remarks = Remarks::on(scene, &model, doubts)?;
    Forecast::new(scene, &model, 0).require_space(dir, limits.ignore_disk_space)?;
    let equilibrium = if wanted.bodies.contains(&ModeBody::Bearing) {
        progress.stage("equilibrium");
        let mut statics = StaticSolver::new(&model).map_err(Failure::solving)?;
        Some(statics.solve(&model, None).map_err(Failure::solving)?)
    } else {
        None
    };
    let mut files: Option<ModeFiles> = None;
    let mut sets = Vec::new();
    for &body in &wanted.bodies {
        progress.stage(&format!("{}: factoring", name(body, wanted)));
        let set = modes_of(&model, body, wanted, equilibrium.as_ref(), &progress)?;
        // The first modes make the folder: a scene that has none leaves no files.
        let files = match &mut files {
            Some(files) => files,
            empty => empty.insert(ModeFiles::create(scene, &model, dir)?),
        };
        files.write(scene, &model, body, &set)?;
        sets.push((body, set));
        progress.advance();
    }
    progress.finish();
    let run = files.map_or(Ok(None), ModeFiles::finish)?;
    let snapshot = equilibrium.as_ref().map(|e| Snapshot::of_equilibrium(e, None));
    let mut warned = warnings(&sets, equilibrium.as_ref(), wanted);
    warned.extend(beyond_body(scene, &sets, wanted));
    let remarks = remarks.with(warned);
    let remarks = [remarks.warnings, remarks.advice];
    let summary = ModesSummary::new(scene, &model, &sets, snapshot.as_ref(), run, remarks, start);
    summary.write(dir)?;
    for (body, set) in &sets {
        print_modes(&name(*body, wanted), set);
    }
    summary.print_costs();
    Ok(())
}

/// Fails on several ranks.
pub fn require_one_process() -> Result<(), Failure> {
    let ranks = Communicator::world().size();
    if ranks > 1 {
        return Err(Failure::User(anyhow!(
            "the search for modes runs as one process, but the launcher started {ranks} tasks; start one and give it \
             the cores as threads"
        )));
    }
    Ok(())
}

/// A body in words, with its support.
pub fn name(body: ModeBody, wanted: &Modes) -> String {
    let support = match wanted.support {
        ModeSupport::Free => "free",
        ModeSupport::AsHeld => "as held",
    };
    match body {
        ModeBody::Inner => format!("inner ring alone, {support}"),
        ModeBody::Outer => format!("outer ring alone, {support}"),
        ModeBody::Bearing => "bearing".to_string(),
    }
}

fn modes_of(
    model: &Model,
    body: ModeBody,
    wanted: &Modes,
    equilibrium: Option<&StaticSolution>,
    progress: &Progress,
) -> Result<ModeSet, Failure> {
    let settings = ModesSettings {
        number: wanted.number,
        shift: wanted.shift,
        backend: model.backend,
    };
    let support = match wanted.support {
        ModeSupport::Free => RingSupport::Free,
        ModeSupport::AsHeld => RingSupport::AsHeld,
    };
    let name_of_body = name(body, wanted);
    let mut report = |searched: Searched| report(progress, (&name_of_body, wanted.number), searched);
    let mut alone = |side: Side| {
        let ring = model
            .ring(side)
            .expect("the scene was refused when a ring without a body is named");
        ring_modes(side, ring, support, settings, &mut report)
    };
    match (body, equilibrium) {
        (ModeBody::Inner, _) => alone(Side::Inner),
        (ModeBody::Outer, _) => alone(Side::Outer),
        (ModeBody::Bearing, equilibrium) => {
            let equilibrium = equilibrium.expect("the equilibrium of a bearing was found first");
            bearing_modes(model, equilibrium, settings, &mut report)
        }
    }
    .map_err(Failure::solving)
}

/// Tells how far a search is, from time to time.
pub fn report(progress: &Progress, (name, number): (&str, usize), searched: Searched) {
    if searched.steps.is_multiple_of(PROGRESS_STEPS) {
        progress.stage(&format!(
            "{name}: {} of {number} modes after {} blocks",
            searched.converged, searched.steps
        ));
    }
}

/// Warns of modes that a body of a ring does not resolve.
fn beyond_body(scene: &Scene, sets: &[(ModeBody, ModeSet)], wanted: &Modes) -> Vec<String> {
    let warning = |body: &SceneBody| {
        let other = match body.ring {
            RingName::Inner => ModeBody::Outer,
            RingName::Outer => ModeBody::Inner,
        };
        let in_body = sets.iter().filter(|(of, _)| *of != other);
        let last = in_body.filter_map(|(of, set)| Some((of, set.modes.last()?.frequency)));
        let (of, highest) = last.max_by(|a, b| a.1.total_cmp(&b.1))?;
        beyond(body, &name(*of, wanted), highest)
    };
    scene.bodies.iter().flatten().filter_map(warning).collect()
}

/// Warns where a body keeps too few modes of its own for a frequency, Hz.
pub fn beyond(body: &SceneBody, name: &str, highest: f64) -> Option<String> {
    let below = body.modes_below?;
    (highest > RESOLVED * below).then(|| {
        format!(
            "{name}: the highest mode has {highest:.0} Hz, but body {:?} keeps its own modes up to {below} Hz; raise \
             body.modes_below to {:.0} times that frequency or more",
            body.name,
            1.0 / RESOLVED
        )
    })
}

/// What a user should know: those of the equilibrium, missing modes, and balls without load.
fn warnings(
    sets: &[(ModeBody, ModeSet)],
    equilibrium: Option<&StaticSolution>,
    wanted: &Modes,
) -> Vec<String> {
    let mut warnings: Vec<String> = equilibrium.map_or(Vec::new(), |e| e.warnings.clone());
    for (body, set) in sets {
        warnings.extend(too_few(&name(*body, wanted), set.modes.len(), wanted.number));
        let rigid = set.modes.iter().filter(|m| m.is_rigid).count();
        if *body == ModeBody::Bearing && rigid > 0 {
            warnings.push(without_stiffness("bearing", rigid));
        }
        warnings.extend(loose_balls("bearing", set.loose_balls));
    }
    warnings
}

/// Warns where there are fewer modes than were asked for.
pub fn too_few(name: &str, found: usize, wanted: usize) -> Option<String> {
    (found < wanted).then(|| format!("{name}: it has only {found} modes, not {wanted}"))
}

/// Says that some modes have no stiffness.
pub fn without_stiffness(name: &str, n: usize) -> String {
    let are = if n == 1 {
        "mode is a motion"
    } else {
        "modes are motions"
    };
    format!("{name}: {n} {are} without stiffness")
}

/// Says how many balls take no part.
pub fn loose_balls(name: &str, n: usize) -> Option<String> {
    let carry = if n == 1 { "ball carries" } else { "balls carry" };
    (n > 0).then(|| {
        format!(
            "{name}: {n} {carry} nothing, with neither stiffness nor coupling; {} motions at zero frequency are left \
             out of the modes",
            2 * n
        )
    })
}
