//! How a command ends when it does not end well: the exit code and the message.

use std::fmt;

use anyhow::anyhow;
use comm::{Communicator, print};
use dynamics::DynamicsError;

/// Exit code of a user error: bad input, missing files, results that would be overwritten.
const USER: u8 = 2;
/// Exit code of a solution that was not found.
const NUMERICAL: u8 = 3;
/// Exit code of a run that was asked to stop and can be resumed.
const STOPPED: u8 = 75;

/// A failed command.
#[derive(Debug)]
pub enum Failure {
    /// The input is wrong or a file cannot be used.
    User(anyhow::Error),
    /// The input is sound but no solution was found.
    Numerical(anyhow::Error),
    /// The run was asked to stop before its end and left a step to resume from.
    Stopped(anyhow::Error),
}

/// An error and its causes; a cause that is said already is not said again.
pub fn one_line(error: &anyhow::Error) -> String {
    let mut text = error.to_string();
    for cause in error.chain().skip(1).map(ToString::to_string) {
        if !text.contains(&cause) {
            text = format!("{text}: {cause}");
        }
    }
    text
}

impl Failure {
    /// Exit code of the process.
    pub fn number(&self) -> u8 {
        match self {
            Failure::User(_) => USER,
            Failure::Numerical(_) => NUMERICAL,
            Failure::Stopped(_) => STOPPED,
        }
    }

    /// The message with its causes, on one line.
    pub fn text(&self) -> String {
        match self {
            Failure::User(error) | Failure::Numerical(error) | Failure::Stopped(error) => one_line(error),
        }
    }

    /// What kind of end this is: the first word of its message.
    pub fn kind(&self) -> &'static str {
        match self {
            Failure::User(_) | Failure::Numerical(_) => "error",
            Failure::Stopped(_) => "stopped",
        }
    }

    /// The end of the run in its summary.
    pub fn status(&self) -> String {
        match self {
            Failure::User(_) | Failure::Numerical(_) => format!("failed: {}", self.text()),
            Failure::Stopped(_) => format!("stopped: {}", self.text()),
        }
    }

    /// A failure of the solver: numerical unless the scene leaves something unheld or asks for what cannot be, or a
    /// mesh has a hole.
    pub fn solving(error: impl Into<DynamicsError>) -> Failure {
        let error = error.into();
        if error.is_of_input() {
            Failure::User(error.into())
        } else {
            Failure::Numerical(error.into())
        }
    }
}

impl Failure {
    /// That standard output could not be written, such as to a full disk, if so.
    pub fn unwritten() -> Option<Failure> {
        print::unwritten().map(|cause| {
            Failure::User(anyhow::anyhow!(
                "cannot write to standard output: {cause}; lines of the answer are lost"
            ))
        })
    }

    /// The same failure with where it happened in front.
    pub fn context(self, text: String) -> Failure {
        match self {
            Failure::User(e) => Failure::User(e.context(text)),
            Failure::Numerical(e) => Failure::Numerical(e.context(text)),
            Failure::Stopped(e) => Failure::Stopped(e.context(text)),
        }
    }
}

/// The result of all ranks: one that fails is a failure of all. To be called where a rank may fail alone, such as
/// with its files, before ranks meet again.
#[track_caller]
pub fn agree<T>(result: Result<T, Failure>) -> Result<T, Failure> {
    let result = result.map_err(Coded);
    Communicator::world()
        .agree(result, Coded::elsewhere)
        .map_err(|coded| coded.0)
}

/// A failure of what all ranks compute, for a rank that goes on to save what it has: all have failed. A rank that has
/// failed alone ends all with its message, because the others wait for other messages than those it would send.
pub fn of_all(failure: Failure) -> Failure {
    let comm = Communicator::world();
    if comm.all_failed() {
        return failure;
    }
    say_of_rank(&failure);
    comm.abort(failure.number())
}

/// Says that this rank has failed alone, and why.
pub fn say_of_rank(failure: &Failure) {
    let (kind, text, rank) = (failure.kind(), failure.text(), Communicator::world().rank());
    print::from_any_rank(format_args!("{kind}: on rank {rank}: {text}"));
}

/// A failure as ranks tell each other of it: its exit code, then its text.
struct Coded(Failure);

impl fmt::Display for Coded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.0.number(), self.0.text())
    }
}

impl Coded {
    fn elsewhere(rank: usize, message: String) -> Coded {
        let (code, text) = message.split_once(' ').unwrap_or(("", &message));
        let error = anyhow!("on rank {rank}: {text}");
        Coded(match code.parse() {
            Ok(NUMERICAL) => Failure::Numerical(error),
            Ok(STOPPED) => Failure::Stopped(error),
            _ => Failure::User(error),
        })
    }
}

impl<E: Into<anyhow::Error>> From<E> for Failure {
    fn from(error: E) -> Failure {
        Failure::User(error.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a message that goes on after its cause, with what to do, would say the cause a second time.
    #[test]
    fn a_cause_in_the_middle_of_a_message_is_said_once() {
        let error = anyhow!("a row is empty").context("no solution: a row is empty; check the loads");
        let failure = Failure::Numerical(error).context("bearing \"a\"".to_string());
        assert_eq!(
            failure.text(),
            "bearing \"a\": no solution: a row is empty; check the loads"
        );
        let failure = Failure::User(anyhow!("no such file").context("cannot read it"));
        assert_eq!(failure.text(), "cannot read it: no such file");
    }
}
