//! `raceway resume`: goes on with a run over time, a motion or equilibria, from one of its steps, to the same bits as
//! if it had not been interrupted.
//!
//! All that evolves comes from the step file, the model from the scene text stored in it. Only how long the run goes
//! and what it writes may change ([`MAY_CHANGE`]). The scene file and the meshes must still be those of the run: a
//! changed one is refused with the difference shown.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::slice;
use std::time::Instant;

use anyhow::{Context, anyhow};
use checkpoint::{StepRecord, has_state, newest_step, read_about, read_any_step, step_file_name};
use clap::Args;
use comm::print;
use input::shell_word;
use results::about::{MAY_CHANGE, OVERRIDES, SCENE_FILE, WARNINGS, require_named_files, scene_file};
use results::failure::{Failure, agree};
use results::folder::start_again;
use results::summary::scene_as_named;
use scene::{MeshFiles, Scene, difference};

use crate::options::Limits;
use crate::several_state::ListChanges;
use crate::shared::{acquire, note_unshared, of_root};
use crate::stored::{OverTime, SCENE_IS_AWAY, Stored, is_finished};
use crate::{motion, quasi_static};

/// What the command line asks for.
#[derive(Debug, Args)]
pub struct ResumeRequest {
    /// Folder of the results.
    pub dir: PathBuf,
    /// Step to go on from; default: the newest whole one with a restart state. Later steps are moved aside.
    #[arg(long)]
    pub step: Option<u64>,
    /// Changes how long the run goes or what it writes: duration and output_every of dynamic or quasi_static, output.*,
    /// life.*.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// Scene file of the run, when it is not where it was.
    #[arg(long)]
    scene: Option<PathBuf>,
    /// Goes on with the scene stored in the results, whatever became of the scene file.
    #[arg(long, conflicts_with = "scene")]
    stored_scene: bool,
    #[command(flatten)]
    pub limits: Limits,
}

impl ResumeRequest {
    /// What it says of the scene of a list of bearings.
    pub fn changes(&self) -> ListChanges<'_> {
        ListChanges {
            overrides: &self.overrides,
            scene: self.scene.as_deref(),
            is_stored: self.stored_scene,
        }
    }
}

/// Goes on with a run.
pub fn resume(request: &ResumeRequest) -> Result<(), Failure> {
    let start = Instant::now();
    let dir = &request.dir;
    let lock = agree(acquire(dir))?;
    // All ranks read before the first one writes.
    let step = of_root(|| choose_step(dir, request.step))?;
    let Read {
        record,
        about,
        scene,
        course,
        is_finished,
    } = agree(read(request, step))?;
    let at = format!("{step} of {}, t = {:.6e} s", course.n_steps(), record.time);
    if is_finished {
        course.say_finished(dir, &at);
        return Ok(());
    }
    print::note(format_args!("resuming {} after step {at}", dir.display()));
    note_unshared(&scene);
    let warnings = about.get(WARNINGS).map_or(Vec::new(), |text| lines(text));
    let stored = Stored {
        lock,
        dir: dir.clone(),
        step,
        warnings,
        tables: record.tables,
        time: record.time,
        arrays: record.state,
    };
    match &course {
        OverTime::Motion(dynamic) => motion::resume(&scene, dynamic, stored, &request.limits, start)?,
        OverTime::Equilibria(settings) => {
            quasi_static::resume(&scene, settings, stored, &request.limits, start)?;
        }
    }
    print::line(format_args!("results: {}", dir.display()));
    Ok(())
}

/// What a rank reads of a run that goes on.
struct Read {
    record: StepRecord,
    about: BTreeMap<String, String>,
    scene: Scene,
    course: OverTime,
    /// Whether nothing is left to do.
    is_finished: bool,
}

/// Reads a step and all that says how to go on from it. May fail on one rank alone.
fn read(request: &ResumeRequest, step: u64) -> Result<Read, Failure> {
    let dir = &request.dir;
    let path = dir.join(step_file_name(step));
    let (record, about) = (read_any_step(dir, step)?, read_about(&path)?);
    note_version(&about);
    if record.tables.is_none() {
        print::note(format_args!(
            "warning: step {} is of a version that kept no checksums of tables; only the steps in them are looked at",
            record.step
        ));
    }
    let scene = scene_of(request, &record, &about)?;
    let course = OverTime::of(&scene.analysis, dir, slice::from_ref(dir))?;
    require_named_files(&scene, &about)?;
    course.require_step(step, &format!("{step}, t = {} s", record.time))?;
    Ok(Read {
        is_finished: step == course.n_steps() && is_finished(dir, step)?,
        record,
        about,
        scene,
        course,
    })
}

/// The step asked for, or the newest whole one with a state, with a warning for every newer one that is damaged.
fn choose_step(dir: &Path, step: Option<u64>) -> Result<u64, Failure> {
    if checkpoint::is_unfinished_start(dir)? {
        return Err(anyhow!("{} holds no committed step: {}", dir.display(), start_again(dir)).into());
    }
    let Some(step) = step else {
        let mut damaged = 0;
        let newest = newest_step(dir, |error| {
            print::note(format_args!("warning: {error}; falling back to the step before"));
            damaged += 1;
        })?;
        note_repeated(dir, newest.step, damaged)?;
        return Ok(newest.step);
    };
    let steps = checkpoint::committed_steps(dir)?;
    if !steps.contains(&step) && checkpoint::all_steps(dir)?.contains(&step) {
        return Err(anyhow!(
            "step {step} is in a pack; raceway pack {} --undo makes files of the packed steps again",
            shell_word(dir.display())
        )
        .into());
    }
    if !steps.contains(&step) {
        return Err(checkpoint::CheckpointError::unknown_step(dir, step, steps).into());
    }
    require_state(dir, step, &steps)?;
    Ok(step)
}

/// Says which steps are computed again because they hold no state; `damaged` newer ones have been told of.
fn note_repeated(dir: &Path, from: u64, damaged: usize) -> Result<(), Failure> {
    let mut later = checkpoint::committed_steps(dir)?;
    later.retain(|&step| step > from);
    if let [.., last] = later[..]
        && later.len() > damaged
    {
        print::note(format_args!(
            "the newest restart state is that of step {from}; the steps after it, to {last}, are computed again"
        ));
    }
    Ok(())
}

/// Fails unless the file of a step holds a state. One that is damaged says so when it is read.
fn require_state(dir: &Path, step: u64, steps: &[u64]) -> Result<(), Failure> {
    let has_state = |step: u64| has_state(&dir.join(step_file_name(step)));
    if has_state(step).unwrap_or(true) {
        return Ok(());
    }
    let with_state = |n: &&u64| has_state(**n).unwrap_or(false);
    let (before, after) = steps.split_at(steps.partition_point(|&n| n <= step));
    let near = [
        before.iter().rev().find(with_state),
        after.iter().find(with_state),
    ];
    let near: Vec<String> = near.into_iter().flatten().map(u64::to_string).collect();
    let expected = match near.is_empty() {
        true => "no step does; run the scene again".to_string(),
        false => format!("the nearest that do are {}", near.join(" and ")),
    };
    Err(anyhow!(
        "step {step} of {} holds no restart state (output.restart_every); {expected}",
        dir.display()
    )
    .into())
}

fn note_version(about: &BTreeMap<String, String>) {
    let (then, now) = (&about["program_version"], env!("CARGO_PKG_VERSION"));
    if then != now {
        print::note(format_args!(
            "warning: the step was written by version {then}, this is {now}: later steps may differ in their last \
             digits"
        ));
    }
}

/// The stored scene with the changes asked for, when these and the scene file allow it.
fn scene_of(
    request: &ResumeRequest,
    record: &StepRecord,
    about: &BTreeMap<String, String>,
) -> Result<Scene, Failure> {
    let overrides = about.get(OVERRIDES).map_or(Vec::new(), |text| lines(text));
    let path = match (&request.scene, about.get(SCENE_FILE)) {
        (Some(path), _) => path.clone(),
        (None, Some(path)) => scene_as_named(&request.dir, scene_file(&request.dir, path)),
        (None, None) => {
            let step = request.dir.join(step_file_name(record.step));
            return Err(OverTime::without_scene_file(&step, &request.dir));
        }
    };
    if request.scene.is_some() || path.exists() {
        if !request.stored_scene {
            require_same_file(&path, &overrides, (&record.scene, &request.dir))?;
        }
    } else {
        print::note(format_args!(
            "note: the scene file {} is not there any more; going on with the scene stored in step {}",
            path.display(),
            record.step
        ));
    }
    let parsed = Scene::parse(&record.scene, &path, &request.overrides, MeshFiles::MustExist);
    let mut scene = match parsed {
        Err(error) if !path.exists() => {
            return Err(anyhow::Error::from(error).context(SCENE_IS_AWAY).into());
        }
        parsed => parsed?,
    };
    let changes = difference(&record.scene, &scene.text)?;
    if let Some(change) = changes.iter().find(|change| !change.is_below(&MAY_CHANGE)) {
        return Err(anyhow!(
            "--set would change {change}; a resumed run may change only {}",
            MAY_CHANGE.join(", ")
        )
        .into());
    }
    // With these, the scene file gives the text that the next steps hold.
    scene.overrides = [overrides, request.overrides.clone()].concat();
    Ok(scene)
}

/// Fails when the scene file says something else than the scene stored in a folder, besides what may change.
fn require_same_file(path: &Path, overrides: &[String], (stored, dir): (&str, &Path)) -> Result<(), Failure> {
    let now = Scene::load_with(path, overrides, MeshFiles::MayBeMissing)
        .map_err(anyhow::Error::from)
        .context(
            "the scene file of the run cannot be compared any more; --stored-scene goes on without it",
        )?;
    let changes = difference(stored, &now.text)?;
    let refused: Vec<String> = changes
        .iter()
        .filter(|change| !change.is_below(&MAY_CHANGE))
        .map(|change| change.to_string())
        .collect();
    if refused.is_empty() {
        return Ok(());
    }
    // Each step of a sweep holds the scene of its point.
    if !changes.iter().any(|change| change.is_below(&OverTime::TABLES)) {
        OverTime::of(&now.analysis, dir, &[dir.to_path_buf()])?;
    }
    Err(anyhow!(
        "the scene file {} has changed since the run: {}; put it back, or go on with the scene of the run: \
         --stored-scene",
        path.display(),
        refused.join("; ")
    )
    .into())
}

fn lines(text: &str) -> Vec<String> {
    text.lines().map(str::to_string).collect()
}
