//! How a command ends when it does not end well: the exit code and the message.

use std::process::ExitCode;

use contact::ContactError;
use dynamics::DynamicsError;
use solver::SolverError;

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

impl Failure {
    /// Exit code of the process.
    pub fn code(&self) -> ExitCode {
        ExitCode::from(match self {
            Failure::User(_) => USER,
            Failure::Numerical(_) => NUMERICAL,
            Failure::Stopped(_) => STOPPED,
        })
    }

    /// The message with its causes, on one line.
    pub fn text(&self) -> String {
        match self {
            Failure::User(error) | Failure::Numerical(error) | Failure::Stopped(error) => {
                format!("{error:#}")
            }
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
    pub fn solving(error: DynamicsError) -> Failure {
        let user = matches!(
            error,
            DynamicsError::NotHeld { .. }
                | DynamicsError::Unheld { .. }
                | DynamicsError::Fem { .. }
                | DynamicsError::NotInMotion { .. }
                | DynamicsError::Contact(ContactError::Hole { .. })
                | DynamicsError::Solver {
                    source: SolverError::BadSectors { .. },
                    ..
                }
        );
        if user {
            Failure::User(error.into())
        } else {
            Failure::Numerical(error.into())
        }
    }
}

impl Failure {
    /// The same failure with where it happened in front.
    pub fn context(self, text: String) -> Failure {
        match self {
            Failure::User(e) => Failure::User(e.context(text)),
            Failure::Numerical(e) => Failure::Numerical(e.context(text)),
            Failure::Stopped(e) => Failure::Stopped(e.context(text)),
        }
    }
}

impl<E: Into<anyhow::Error>> From<E> for Failure {
    fn from(error: E) -> Failure {
        Failure::User(error.into())
    }
}
