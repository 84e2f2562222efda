//! What step files hold of a list of bearings beyond each bearing's own state, and how a run of a list goes on.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use assembly::motion::ShaftLedger;
use assembly::{AssemblyMotion, AssemblyState};
use checkpoint::{FolderLock, StateArray, StepRecord, has_state, read_about, read_any_step, step_file_name};
use comm::print;
use results::about::{MAY_CHANGE, OVERRIDES, SCENE_FILE, require_named_files, scene_file};
use results::failure::{Failure, agree};
use results::list_folder::{ended_early, is_unfinished};
use results::reduction::take_arrays;
use results::several::{BEARINGS_TABLE, SCENE_TEXT};
use results::state_arrays::{self, Arrays};
use results::summary::{read_summary, scene_as_named};
use results::watch::Watch;
use scene::{AnyScene, BearingOnShaft, MeshFiles, Scene, SeveralScene, difference};

use crate::shared::{acquire, of_root};
use crate::stored::{OverTime, SCENE_IS_AWAY, is_finished};

const SHAFT: &str = "list_shaft";
const VELOCITY: &str = "list_shaft_velocity";
const LOADS: &str = "list_loads";
const LEDGER: &str = "list_shaft_ledger";
const NEWTON: &str = "list_newton_iterations";

/// A step of every bearing of a list.
pub struct StoredList {
    pub dir: PathBuf,
    pub scene: SeveralScene,
    pub course: OverTime,
    pub step: u64,
    pub bearings: Vec<StoredBearing>,
}

/// A step of one of them.
pub struct StoredBearing {
    pub folder: PathBuf,
    /// The lock of its folder, on rank 0.
    pub lock: Option<FolderLock>,
    /// Its scene with the shaft where it was at the start of the run.
    pub scene: Scene,
    pub record: StepRecord,
}

/// The state of a stored step.
pub struct Restored {
    pub state: AssemblyState,
    pub newton: u64,
    pub watches: Vec<Watch>,
    /// What each bearing knows of the whole run by `[output.reduction]`.
    pub reductions: Vec<Arrays>,
}

/// Whether a folder has results of a list of bearings: rank 0 looks for all.
pub fn is_list(dir: &Path) -> Result<bool, Failure> {
    let has = |name: &str| dir.join(name).exists();
    let begun = || Ok::<_, Failure>(has(BEARINGS_TABLE) && has(SCENE_TEXT) || is_unfinished(dir)?);
    let found = of_root(|| begun().map(u64::from))?;
    Ok(found == 1)
}

/// The state of the shaft, which every bearing's file has.
pub fn arrays_of_shaft(state: &AssemblyState, newton: u64) -> Arrays {
    let ledger = &state.ledger;
    let reals = [
        (SHAFT, state.shaft.clone()),
        (VELOCITY, state.velocity.clone()),
        (LOADS, state.loads.as_flattened().to_vec()),
        (LEDGER, ledger.to_numbers().to_vec()),
    ];
    let mut arrays: Arrays = reals
        .into_iter()
        .map(|(name, values)| (name.to_string(), StateArray::Real(values)))
        .collect();
    let newton = i64::try_from(newton).expect("nobody iterates 2^63 times");
    arrays.insert(NEWTON.to_string(), StateArray::Integer(vec![newton]));
    arrays
}

/// The state of a step of all bearings, whose shaft has `n` dofs.
pub fn restore(
    bearings: &[StoredBearing],
    motion: &AssemblyMotion<'_>,
    n: usize,
    (dir, step): (&Path, u64),
) -> Result<Restored, Failure> {
    let (mut states, mut watches, mut shaft) = (Vec::new(), Vec::new(), None);
    let mut reductions = Vec::new();
    for (bearing, motion) in bearings.iter().zip(&motion.bearings) {
        let at = || format!("step {step} of {}", bearing.folder.display());
        let mut arrays = bearing.record.state.clone();
        reductions.push(take_arrays(&mut arrays));
        let of_shaft = [SHAFT, VELOCITY, LOADS, LEDGER, NEWTON].map(|name| arrays.remove(name));
        if *shaft.get_or_insert_with(|| of_shaft.clone()) != of_shaft {
            return Err(other_shaft(&bearing.folder, (dir, step)));
        }
        let watch = Watch::take(&mut arrays, motion.n_balls());
        watches.push(watch.ok_or_else(|| anyhow!("{} has no count of contacts beyond their limits", at()))?);
        states.push(motion.own(state_arrays::load(&arrays, &motion.shape()).with_context(at)?));
    }
    let missing = || anyhow!("step {step} of {} has no state of the shaft", dir.display());
    let shaft = shaft.ok_or_else(missing)?;
    let real = |i: usize, length: usize| match &shaft[i] {
        Some(StateArray::Real(values)) if values.len() == length => Ok(values.clone()),
        _ => Err(missing()),
    };
    let newton = match &shaft[4] {
        Some(StateArray::Integer(count)) if count.len() == 1 => count[0].max(0) as u64,
        _ => return Err(missing().into()),
    };
    let ledger = ShaftLedger::from_numbers(&real(3, ShaftLedger::N)?).ok_or_else(missing)?;
    Ok(Restored {
        state: AssemblyState {
            step,
            shaft: real(0, n)?,
            velocity: real(1, n)?,
            loads: real(2, 5 * states.len())?.as_chunks::<5>().0.to_vec(),
            ledger,
            bearings: states,
        },
        newton,
        watches,
        reductions,
    })
}

/// A bearing whose step has another state of the shaft than the bearings before it.
pub fn other_shaft(folder: &Path, (dir, step): (&Path, u64)) -> Failure {
    anyhow!(
        "step {step} of {} has another state of the shaft than the other bearings of {}: its files are of another run",
        folder.display(),
        dir.display()
    )
    .into()
}

/// What the command line says of the scene of a run that goes on.
#[derive(Clone, Copy)]
pub struct ListChanges<'a> {
    /// How long it goes and what it writes.
    pub overrides: &'a [String],
    /// The scene file, where it is not where it was.
    pub scene: Option<&'a Path>,
    /// Whether the scene file is left out of it.
    pub is_stored: bool,
}

/// Reads the step from which a run goes on; `asked` is the one asked for. None if the run has finished. Collective.
pub fn read(dir: &Path, asked: Option<u64>, changes: ListChanges<'_>) -> Result<Option<StoredList>, Failure> {
    let Locked { text, folders, locks } = agree(lock(dir))?;
    // All ranks read before the first one writes.
    let step = of_root(|| choose(dir, &folders, asked))?;
    let stored = agree(read_step(dir, (&text, &folders, step), changes))?;
    Ok(stored.map(|mut stored| {
        let bearings = stored.bearings.iter_mut().zip(locks);
        bearings.for_each(|(bearing, lock)| bearing.lock = lock);
        stored
    }))
}

/// The results of a list, of which nobody else writes.
struct Locked {
    /// The scene of the list.
    text: String,
    /// By bearing.
    folders: Vec<PathBuf>,
    /// Their locks, on rank 0.
    locks: Vec<Option<FolderLock>>,
}

/// Locks the folders of all bearings.
fn lock(dir: &Path) -> Result<Locked, Failure> {
    if !dir.is_dir() {
        return Err(anyhow!("{} is no folder; expected the results of a run", dir.display()).into());
    }
    if is_unfinished(dir)? {
        return Err(ended_early(dir));
    }
    let path = dir.join(SCENE_TEXT);
    let text =
        std::fs::read_to_string(&path).with_context(|| format!("{} cannot be read", path.display()))?;
    let names = scene::names_of_bearings(&text);
    let folders: Vec<PathBuf> = names.iter().map(|name| dir.join(name)).collect();
    if let Some(missing) = folders.iter().find(|folder| !folder.is_dir()) {
        return Err(anyhow!(
            "the folder {} of a bearing is not there; run the scene again with another --out",
            missing.display()
        )
        .into());
    }
    let locks = folders.iter().map(|folder| acquire(folder));
    Ok(Locked {
        locks: locks.collect::<Result<_, Failure>>()?,
        folders,
        text,
    })
}

/// Reads a step of all bearings, and all that says how to go on from it; None if nothing is left to do. May fail on
/// one rank alone.
fn read_step(
    dir: &Path,
    (text, folders, step): (&str, &[PathBuf], u64),
    changes: ListChanges<'_>,
) -> Result<Option<StoredList>, Failure> {
    let overrides = changes.overrides;
    let first = folders[0].join(step_file_name(step));
    let about = read_about(&first)?;
    let path = match (changes.scene, about.get(SCENE_FILE)) {
        (Some(path), _) => path.to_path_buf(),
        (None, Some(path)) => scene_as_named(&folders[0], scene_file(&folders[0], path)),
        (None, None) => return Err(OverTime::without_scene_file(&first, dir)),
    };
    let before: Vec<String> = about
        .get(OVERRIDES)
        .map_or(Vec::new(), |text| text.lines().map(str::to_string).collect());
    let scene = scene_of(text, &path, &before, changes)?;
    let course = OverTime::of(&scene.analysis, dir, folders)?;
    let n_steps = course.n_steps();
    course.require_step(step, &step.to_string())?;
    if step == n_steps && is_list_finished(dir, folders, step)? {
        course.say_finished(dir, &format!("{step} of {n_steps}"));
        return Ok(None);
    }
    let mut bearings = Vec::new();
    for (i, folder) in folders.iter().enumerate() {
        let now = &scene.bearings[i];
        bearings.push(stored_bearing(folder, step, now, (&path, &before, overrides))?);
    }
    print::note(format_args!(
        "resuming {} after step {step} of {}",
        dir.display(),
        n_steps
    ));
    Ok(Some(StoredList {
        dir: dir.to_path_buf(),
        scene,
        course,
        step,
        bearings,
    }))
}

/// Whether a run got to its end: what is written after its last step is there, of the list and of all bearings.
fn is_list_finished(dir: &Path, folders: &[PathBuf], step: u64) -> Result<bool, Failure> {
    let summed_up = read_summary(dir).is_some_and(|summary| summary["status"] == "finished");
    let mut whole = folders.iter().map(|folder| is_finished(folder, step));
    whole.try_fold(summed_up, |all, one| Ok(all && one?))
}

/// The step of a bearing, whose scene and meshes must be those that the list has `now`; scenes are read at `path`, with
/// what the run and this command have changed.
fn stored_bearing(
    folder: &Path,
    step: u64,
    now: &BearingOnShaft,
    (path, before, overrides): (&Path, &[String], &[String]),
) -> Result<StoredBearing, Failure> {
    let record = read_any_step(folder, step)?;
    let own = Scene::parse(&record.scene, path, overrides, MeshFiles::MustExist)?;
    let changes = difference(&own.text, &now.scene.text)?;
    if let Some(change) = changes.iter().find(|change| !change.is_below(&["shaft"])) {
        return Err(anyhow!(
            "bearing {:?} has changed since the run: {change}; put its type back as it was",
            now.name
        )
        .into());
    }
    require_named_files(&own, &read_about(&folder.join(step_file_name(step)))?)?;
    Ok(StoredBearing {
        folder: folder.to_path_buf(),
        lock: None,
        scene: Scene {
            overrides: [before, overrides].concat(),
            ..own
        },
        record,
    })
}

/// The scene of the run with what may change changed.
fn scene_of(
    text: &str,
    path: &Path,
    before: &[String],
    changes: ListChanges<'_>,
) -> Result<SeveralScene, Failure> {
    let overrides = changes.overrides;
    let of_list = |text: &str, overrides: &[String]| {
        let parsed = AnyScene::parse(text, path, overrides, MeshFiles::MustExist);
        match parsed.map_err(anyhow::Error::from) {
            Ok(AnyScene::Several(scene)) => Ok(*scene),
            Ok(AnyScene::One(_)) => Err(Failure::from(anyhow!(
                "{} has one bearing; expected the list of the run",
                path.display()
            ))),
            Err(error) if !path.exists() => Err(error.context(SCENE_IS_AWAY).into()),
            Err(error) => Err(error.into()),
        }
    };
    // Those of the types are not in the text.
    let stored = of_list(text, &scene::overrides_of_types(before))?;
    if path.exists() && !changes.is_stored {
        let now =
            std::fs::read_to_string(path).with_context(|| format!("{} cannot be read", path.display()))?;
        let now = of_list(&now, before)?;
        if let Some(change) = difference(&stored.text, &now.text)?
            .iter()
            .find(|change| !change.is_below(&MAY_CHANGE))
        {
            return Err(anyhow!(
                "the scene file {} has changed since the run: {change}; put it back, or go on with the scene of the \
                 run: --stored-scene",
                path.display()
            )
            .into());
        }
    }
    let all = [scene::overrides_of_types(before), overrides.to_vec()].concat();
    let scene = of_list(text, &all)?;
    let changes = difference(&stored.text, &scene.text)?;
    if let Some(change) = changes.iter().find(|change| !change.is_below(&MAY_CHANGE)) {
        return Err(anyhow!(
            "--set would change {change}; a resumed run may change only {}",
            MAY_CHANGE.join(", ")
        )
        .into());
    }
    Ok(SeveralScene {
        overrides: [before, overrides].concat(),
        ..scene
    })
}

/// The newest step that every bearing has whole and with its state, or the one asked for.
fn choose(dir: &Path, folders: &[PathBuf], asked: Option<u64>) -> Result<u64, Failure> {
    let mut common: Option<Vec<u64>> = None;
    for folder in folders {
        let mut steps = checkpoint::committed_steps(folder)?;
        let holds_state = |step: u64| has_state(&folder.join(step_file_name(step))).unwrap_or(false);
        steps.retain(|&step| holds_state(step) && common.as_ref().is_none_or(|all| all.contains(&step)));
        common = Some(steps);
    }
    let common = common.unwrap_or_default();
    if let Some(step) = asked {
        if common.contains(&step) {
            return Ok(step);
        }
        let known: Vec<String> = common.iter().map(u64::to_string).collect();
        return Err(anyhow!(
            "{} has no step {step} with a restart state of all bearings; there are {}",
            dir.display(),
            known.join(", ")
        )
        .into());
    }
    for &step in common.iter().rev() {
        let damage = folders
            .iter()
            .find_map(|folder| checkpoint::read_step(&folder.join(step_file_name(step))).err());
        match damage {
            None => return Ok(step),
            Some(error) => print::note(format_args!("warning: {error}; falling back to the step before")),
        }
    }
    Err(anyhow!(
        "{} has no step that is whole in all bearings; run the scene again",
        dir.display()
    )
    .into())
}
