//! A stored step that a run over time goes on from.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use checkpoint::{
    FolderLock, Stamps, StateArray, StepRecord, all_steps, require_run, run_of, step_file_name,
};
use comm::print;
use dynamics::motion::{Motion, MotionState};
use results::answer;
use results::failure::Failure;
use results::integrity::doubts;
use results::reduction::take_arrays;
use results::state_arrays::{self, Arrays};
use results::summary::read_summary;
use results::watch::Watch;
use scene::{Analysis, Dynamic, QuasiStatic};

use crate::options::SweepPart;

/// Array of a step file that counts Newton's iterations since the start of the run.
const NEWTON: &str = "newton_iterations";

/// Why files that a scene names are not found when it is not where it was.
pub const SCENE_IS_AWAY: &str = "the meshes are looked for from the place of the scene file, which is not there: \
                                 --scene says where it is";

/// What goes on from a step.
#[derive(Clone, Copy)]
pub enum OverTime {
    Motion(Dynamic),
    Equilibria(QuasiStatic),
}

impl OverTime {
    /// The tables of scenes that say how long they go.
    pub const TABLES: [&str; 2] = ["dynamic", "quasi_static"];

    /// That of an analysis, whose results are in `dir`, with the step files of each bearing in one of `folders`.
    pub fn of(analysis: &Analysis, dir: &Path, folders: &[PathBuf]) -> Result<OverTime, Failure> {
        let kind = match analysis {
            Analysis::Dynamic(dynamic) => return Ok(OverTime::Motion(*dynamic)),
            Analysis::QuasiStatic(settings) => return Ok(OverTime::Equilibria(*settings)),
            Analysis::Static => "[static]",
            Analysis::Sweep(sweep) => {
                let is_there = points_there(sweep.points.len(), folders)?;
                return Err(OverTime::rest_of_sweep(&is_there, dir));
            }
            Analysis::Modes(_) => "[modes]",
        };
        Err(OverTime::none_of(kind, dir))
    }

    /// Why a sweep is not gone on with, which of its points are there, and how to have the others.
    fn rest_of_sweep(is_there: &[bool], dir: &Path) -> Failure {
        let parts_where = |there: bool| {
            let numbers = is_there.iter().enumerate().filter(|(_, is)| **is == there);
            SweepPart::of_numbers(numbers.map(|(number, _)| number))
        };
        let missing = parts_where(false);
        let rest = match missing.is_empty() {
            true => format!("{} there", points_are(&parts_where(true))),
            false => {
                let calls: Vec<String> = missing.iter().map(|part| format!("--points {part}")).collect();
                let each = if calls.len() > 1 { "each with" } else { "and" };
                format!(
                    "{} there, {} missing; the same command with {}, {each} another --out, computes the missing ones",
                    points_are(&parts_where(true)),
                    points_are(&missing),
                    calls.join(", with ")
                )
            }
        };
        anyhow!(
            "{} holds results of a [sweep] scene; only a run over time, a scene with [dynamic] or [quasi_static], can \
             be resumed; {rest}",
            dir.display()
        )
        .into()
    }

    /// Why a step that does not say where its scene is cannot be gone on from: steps of modes do not.
    pub fn without_scene_file(step: &Path, dir: &Path) -> Failure {
        // A run that was killed has no summary; steps of all others say where their scene is.
        match read_summary(dir).is_none_or(|summary| summary["analysis"] == "modes") {
            true => OverTime::none_of("[modes]", dir),
            false => anyhow!("{} does not say where its scene is", step.display()).into(),
        }
    }

    fn none_of(kind: &str, dir: &Path) -> Failure {
        anyhow!(
            "{} holds results of a {kind} scene; only a run over time, a scene with [dynamic] or [quasi_static], can \
             be resumed, run the scene again",
            dir.display()
        )
        .into()
    }

    /// The table of the scene that says how long it goes.
    pub fn table(&self) -> &'static str {
        match self {
            OverTime::Motion(_) => OverTime::TABLES[0],
            OverTime::Equilibria(_) => OverTime::TABLES[1],
        }
    }

    /// Number of its last step.
    pub fn n_steps(&self) -> u64 {
        match self {
            OverTime::Motion(dynamic) => dynamic.n_steps,
            OverTime::Equilibria(settings) => settings.n_steps,
        }
    }

    /// Refuses a step that comes after its end; `at` is the step as a message has it.
    pub fn require_step(&self, step: u64, at: &str) -> Result<(), Failure> {
        if step <= self.n_steps() {
            return Ok(());
        }
        let duration = match self {
            OverTime::Motion(dynamic) => dynamic.duration,
            OverTime::Equilibria(settings) => settings.duration,
        };
        Err(anyhow!(
            "the run is at step {at}, beyond {}.duration = {duration} s; expected a longer duration, or an earlier \
             --step",
            self.table()
        )
        .into())
    }

    /// Says that a run has finished with its last step at a place, and names its folder in the answer of the command.
    pub fn say_finished(&self, dir: &Path, at: &str) {
        answer::add_results(dir);
        print::line(format_args!(
            "nothing to do: {} has finished with step {at}; a longer duration goes on from there, --set \
             {}.duration=...",
            dir.display(),
            self.table()
        ));
    }
}

/// Whether a run got to its end: its last step is the newest, and all that is written after it is there.
pub fn is_finished(dir: &Path, step: u64) -> Result<bool, Failure> {
    let newest = checkpoint::committed_steps(dir)?.last() == Some(&step);
    let summary = read_summary(dir);
    let finished = summary.is_some_and(|summary| summary["status"] == "finished");
    let is_whole = dir.join("run.vtkhdf").exists() && checkpoint::read_mesh(dir).is_ok();
    // Tables that are not as written are refused, or cut, where a run goes on.
    Ok(newest && finished && is_whole && doubts(dir)?.is_empty())
}

/// Which of so many points of a sweep have whole step files in all `folders`, packed or not.
fn points_there(n_points: usize, folders: &[PathBuf]) -> Result<Vec<bool>, Failure> {
    let mut times_there = vec![0; n_points];
    for folder in folders {
        let run = run_of(folder)?;
        for step in all_steps(folder)? {
            let path = folder.join(step_file_name(step));
            let is_whole = !path.exists() || require_run(&path, run.as_deref()).is_ok();
            if let Some(times) = times_there.get_mut(step as usize)
                && is_whole
            {
                *times += 1;
            }
        }
    }
    Ok(times_there
        .into_iter()
        .map(|times| times == folders.len())
        .collect())
}

/// The points of some parts as the subject of a sentence, with its verb.
fn points_are(parts: &[SweepPart]) -> String {
    let texts: Vec<String> = parts.iter().map(SweepPart::to_string).collect();
    match parts.iter().map(|part| part.n_points()).sum::<usize>() {
        0 => "none of its points is".to_string(),
        1 => format!("point {} is", texts.join("")),
        _ => format!("points {} are", texts.join(", ")),
    }
}

/// A step to go on from.
pub struct Stored {
    /// The lock of its folder, on rank 0.
    pub lock: Option<FolderLock>,
    /// The folder.
    pub dir: PathBuf,
    /// Its number.
    pub step: u64,
    /// Warnings of the start of the run.
    pub warnings: Vec<String>,
    /// What the step tells of the tables; None if it is of a version that kept no checksums of them.
    pub tables: Option<Stamps>,
    /// Time of the step, s.
    pub time: f64,
    /// Its restart state.
    pub arrays: BTreeMap<String, StateArray>,
}

/// What a run goes on from.
pub struct RestartedFrom {
    /// All that evolves.
    pub state: MotionState,
    /// Newton's iterations so far.
    pub newton: u64,
    /// Contacts beyond their limits so far.
    pub watch: Watch,
    /// What is known of the whole run by `[output.reduction]`.
    pub reduction: Arrays,
}

impl Stored {
    /// Adds what the run counts besides its state.
    pub fn add_counts(record: &mut StepRecord, newton: u64, watch: &Watch) {
        let newton = i64::try_from(newton).expect("nobody iterates 2^63 times");
        record
            .state
            .insert(NEWTON.to_string(), StateArray::Integer(vec![newton]));
        watch.put(&mut record.state);
    }

    /// The state, and what the run counts besides.
    pub fn state(&self, motion: &Motion<'_>) -> Result<RestartedFrom, Failure> {
        let at = || format!("step {} of {}", self.step, self.dir.display());
        let mut arrays = self.arrays.clone();
        let reduction = take_arrays(&mut arrays);
        let newton = match arrays.remove(NEWTON) {
            Some(StateArray::Integer(count)) if count.len() == 1 => count[0].max(0) as u64,
            _ => return Err(anyhow!("{} has no count of iterations", at()).into()),
        };
        let watch = Watch::take(&mut arrays, motion.n_balls());
        let watch = watch.ok_or_else(|| anyhow!("{} has no count of contacts beyond their limits", at()))?;
        let state = motion.own(state_arrays::load(&arrays, &motion.shape()).with_context(at)?);
        let time = motion.time(state.step);
        if state.step != self.step || time.to_bits() != self.time.to_bits() {
            return Err(anyhow!(
                "{} says t = {:?} s, but its state is that of step {} at {time:?} s",
                at(),
                self.time,
                state.step
            )
            .into());
        }
        Ok(RestartedFrom {
            state,
            newton,
            watch,
            reduction,
        })
    }
}
