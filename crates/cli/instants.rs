//! The one driver over instants: those of a motion or of equilibria in time, of one bearing or a list, and the points
//! of a sweep. It goes on from instant to instant, has tables and step files written when they are due, stops when it
//! is asked to, and knows what has been written, so that a run which ends early leaves its last state behind.

use std::path::Path;

use anyhow::anyhow;
use comm::print;
use input::shell_word;
use results::failure::{Failure, agree, of_all};
use results::motion_fields::RestartState;
use results::stop::Stop;

use crate::progress::Progress;

/// Instants between two lines of progress in a log.
pub const PROGRESS_STEPS: u64 = 50;

/// What is due at which instant.
#[derive(Clone, Copy)]
pub struct Due {
    /// The last instant.
    pub last: u64,
    /// Tables have rows every so many instants.
    pub tables_every: u64,
    /// Step files are written every so many instants, and at the last.
    pub files_every: u64,
}

impl Due {
    fn has_files(&self, n: u64) -> bool {
        n == self.last || n.is_multiple_of(self.files_every)
    }

    /// Each step file that is due has rows besides.
    fn has_rows(&self, n: u64) -> bool {
        n.is_multiple_of(self.tables_every) || self.has_files(n)
    }
}

/// What has been written of a run.
#[derive(Clone, Copy, Default)]
pub struct WrittenSteps {
    /// The last instant handed over to be written as step files.
    file: Option<u64>,
    /// The last one handed over with its restart state.
    state: Option<u64>,
    /// The last one with rows in the tables.
    row: Option<u64>,
}

impl WrittenSteps {
    /// All of an instant, that of a run which goes on.
    pub fn all_of(step: u64) -> WrittenSteps {
        let step = Some(step);
        WrittenSteps {
            file: step,
            state: step,
            row: step,
        }
    }
}

/// A run over instants. All of it is collective.
pub trait OverInstants {
    /// What is due.
    fn due(&self) -> Due;
    /// What has been written.
    fn written(&mut self) -> &mut WrittenSteps;
    /// Folder of the results.
    fn dir(&self) -> &Path;
    /// Number of the instant that is known.
    fn now(&self) -> u64;
    /// Time of an instant, s.
    fn time(&self, n: u64) -> f64;

    /// A step and its time, for a line of progress.
    fn step_text(&self, n: u64) -> String {
        format!("step {n} of {}, t = {:.4e} s", self.due().last, self.time(n))
    }
    /// The line of progress before an instant is computed, where one is due; `first` is the first of this process.
    fn stage(&self, n: u64, first: u64) -> Option<String> {
        (n == first || n % PROGRESS_STEPS == 1).then(|| self.step_text(n))
    }
    /// Computes the instant `n` from the one before, which stays the known one on failure.
    fn advance(&mut self, n: u64, progress: &mut Progress) -> Result<(), Failure>;

    /// Takes the known instant into account in what is found of the whole run. Rank 0 alone may fail.
    fn reduce(&mut self) -> Result<(), Failure>;
    /// Appends a line per table. Rank 0 alone may fail.
    fn append_rows(&mut self) -> Result<(), Failure>;
    /// Appends the lines of tables that only instants with step files have. Rank 0 alone may fail.
    fn append_profiles(&mut self) -> Result<(), Failure> {
        Ok(())
    }
    /// Writes the step files of the known instant, or hands them over to be written; ranks recover its stress first,
    /// then rank 0 alone may fail.
    fn append_files(&mut self, restart: RestartState) -> Result<(), Failure>;
    /// Stops before the instant that follows the known one: saves what is to go on from, and says how.
    fn stop(&mut self, reason: &str) -> Failure
    where
        Self: Sized,
    {
        stopped(self, reason)
    }

    /// Whether a step file has the restart state.
    fn restart_at(&self, _n: u64) -> RestartState {
        RestartState::Stored
    }
}

/// Goes from the instant `first` to the last.
pub fn run(
    course: &mut impl OverInstants,
    first: u64,
    mut stop: Option<&mut Stop>,
    progress: &mut Progress,
) -> Result<(), Failure> {
    for n in first..=course.due().last {
        let reason = stop.as_mut().and_then(|stop| stop.reason());
        let written = *course.written();
        // A step whose file is there without its state is not one to stop at: the next one will be.
        if let Some(reason) = &reason
            && (written.file != n.checked_sub(1) || written.state == n.checked_sub(1))
        {
            return Err(course.stop(reason));
        }
        if let Some(text) = course.stage(n, first) {
            progress.stage(&text);
        }
        course.advance(n, progress)?;
        let restart = match reason {
            Some(_) => RestartState::Stored,
            None => course.restart_at(n),
        };
        record(course, restart)?;
        progress.advance();
    }
    Ok(())
}

/// Writes what is due at the known instant.
pub fn record(course: &mut impl OverInstants, restart: RestartState) -> Result<(), Failure> {
    let (due, n) = (course.due(), course.now());
    agree(course.reduce())?;
    if n.is_multiple_of(due.tables_every) {
        agree(append_rows(course))?;
    }
    if due.has_files(n) {
        agree(append_files(course, restart))?;
    }
    Ok(())
}

/// Appends a line per table.
pub fn append_rows(course: &mut impl OverInstants) -> Result<(), Failure> {
    course.append_rows()?;
    course.written().row = Some(course.now());
    Ok(())
}

/// Hands over the known instant to be written as step files, unless it was. To be called by all ranks or none: they
/// must have agreed on what was written before.
///
/// A step file vouches for the tables up to its step, and a run that goes on from it cuts them there. Where only the
/// end of this process asks for a file, rows that are not due are written behind it: the run that goes on drops them.
fn append_files(course: &mut impl OverInstants, restart: RestartState) -> Result<(), Failure> {
    let (n, written) = (course.now(), *course.written());
    if written.file == Some(n) {
        return Ok(());
    }
    if restart == RestartState::Stored {
        course.written().state = Some(n);
    }
    let due = course.due();
    append_missing(course, [due.has_rows(n), due.has_files(n)])?;
    agree(course.append_files(restart))?;
    course.written().file = Some(n);
    append_missing(course, [!due.has_rows(n), !due.has_files(n)])
}

/// Appends rows of the known instant, unless they are there, and those that step files have besides.
fn append_missing(course: &mut impl OverInstants, [rows, profiles]: [bool; 2]) -> Result<(), Failure> {
    let n = course.now();
    if rows && course.written().row != Some(n) {
        agree(append_rows(course))?;
    }
    match profiles {
        true => agree(course.append_profiles()),
        false => Ok(()),
    }
}

/// Saves the state and says that the run can be resumed.
fn stopped(course: &mut impl OverInstants, reason: &str) -> Failure {
    if let Err(error) = agree(append_files(course, RestartState::Stored)) {
        return error.context(format!("{reason}, but the state could not be saved"));
    }
    let n = course.now();
    Failure::Stopped(anyhow!(
        "{reason}; the state after step {n} of {}, t = {:.6e} s, is saved: go on with raceway resume {}",
        course.due().last,
        course.time(n),
        shell_word(course.dir().display())
    ))
}

/// That more instants warn than the first, whose warnings stand for all.
pub fn more_warn(warned: u64) -> Option<String> {
    (warned > 1).then(|| format!("{warned} instants have warnings; those of the first are given"))
}

/// How fast `steps` of `step` s went in so many seconds.
pub fn pace(steps: u64, step: f64, seconds: f64) -> String {
    let each = 1e3 * seconds / steps.max(1) as f64;
    format!(
        "{} of {step} s, {each:.1} ms per step",
        print::counted(steps, "step")
    )
}

/// Says what there is of a sweep that stops, with so many points solved from its point `first` to `last`, and how to
/// have the others. Points are written as they are solved.
pub fn stopped_sweep(reason: &str, (first, solved, last): (u64, u64, u64), dir: &Path) -> Failure {
    let (total, next) = (last + 1 - first, first + solved);
    Failure::Stopped(match solved {
        0 => anyhow!("{reason}; none of the {total} points of the sweep has been solved"),
        _ => anyhow!(
            "{reason}; the first {solved} of the {total} points of the sweep are in {}; for the others: the same \
             command with --points {next}-{last} and another --out",
            dir.display()
        ),
    })
}

/// Saves the last good state after the instant that follows it has failed, and says where it is; `what` names it.
pub fn failed(course: &mut impl OverInstants, what: &str, failure: Failure) -> Failure {
    let failure = of_all(failure);
    let saved = append_files(course, RestartState::Stored);
    let (n, state) = (course.now(), course.written().state);
    // The file of the last good step may have been written without its state.
    let earlier = match state {
        Some(step) if step < n => format!(" that is stored, that of step {step},"),
        _ => String::new(),
    };
    let place = format!("step {}, t = {:.6e} s", n + 1, course.time(n + 1));
    match saved {
        Ok(()) => failure.context(format!(
            "{place}; {what}{earlier} is in {}",
            course.dir().display()
        )),
        Err(unsaved) => failure.context(format!("{place}; {what} could not be saved: {}", unsaved.text())),
    }
}

/// Saves the last good state of a run whose next state is rejected; `take` makes the rejected state the known one, of
/// which the tables get a line, but no step file.
pub fn rejected<C: OverInstants>(course: &mut C, failure: Failure, take: impl FnOnce(&mut C)) -> Failure {
    let failure = of_all(failure);
    let saved = append_files(course, RestartState::Stored);
    take(course);
    match saved.and_then(|()| append_rows(course)) {
        Ok(()) => failure,
        Err(unsaved) => failure.context(format!(
            "the last good state could not be saved: {}",
            unsaved.text()
        )),
    }
}
