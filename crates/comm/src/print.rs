//! Lines for the user. Unlike `println!`, these do not panic when nobody reads any more (`raceway run ... | head`):
//! the run goes on, as its results are files. What else keeps standard output from being written, such as a full disk,
//! is remembered for the end. A command may keep standard output for one answer, say less, or keep a log of all that is
//! said; lines that begin with `warning: `, `error: ` or `stopped: ` are always said.

use std::fmt::{Arguments, Display};
use std::fs::File;
use std::io::{ErrorKind, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::communicator::Communicator;

/// How much is said, and where.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Manner {
    /// Standard output is kept for one answer at the end: its lines go to standard error.
    pub is_answer_only: bool,
    /// Of the lines about how it goes only warnings and errors are said.
    pub is_quiet: bool,
}

/// What has been said so far, for answers and logs. It touches no result.
#[derive(Debug)]
struct Spoken {
    manner: Manner,
    /// Lines of the result.
    output: Vec<String>,
    /// Without their first word.
    warnings: Vec<String>,
    /// Why standard output could not be written, if its reader was still there.
    unwritten: Option<String>,
    log: Log,
}

/// Where all that is said is kept.
#[derive(Debug)]
enum Log {
    /// Nowhere.
    Off,
    /// Until there is a file.
    Waiting(String),
    File(File),
}

static SAID: Mutex<Spoken> = Mutex::new(Spoken {
    manner: Manner {
        is_answer_only: false,
        is_quiet: false,
    },
    output: Vec::new(),
    warnings: Vec::new(),
    unwritten: None,
    log: Log::Off,
});

fn said() -> MutexGuard<'static, Spoken> {
    SAID.lock().unwrap_or_else(PoisonError::into_inner)
}

/// First words of lines that are said also when all else is quiet.
const WARNING: &str = "warning: ";
const ENDS: [&str; 2] = ["error: ", "stopped: "];

/// Sets how much is said; before the first line.
pub fn set_manner(manner: Manner) {
    said().manner = manner;
}

/// How much is said.
pub fn manner() -> Manner {
    said().manner
}

/// Lines of the result and warnings so far.
pub fn so_far() -> (Vec<String>, Vec<String>) {
    let said = said();
    (said.output.clone(), said.warnings.clone())
}

/// From now on all that is said is kept for a log.
pub fn keep_log() {
    said().log = Log::Waiting(String::new());
}

/// Writes what was kept into a file, and from now on all that is said.
pub fn log_to(mut file: File) -> std::io::Result<()> {
    let mut said = said();
    if let Log::Waiting(text) = &said.log {
        file.write_all(text.as_bytes())?;
        said.log = Log::File(file);
    }
    Ok(())
}

/// A line for the log alone; rank 0 speaks for all.
pub fn log(text: Arguments<'_>) {
    if Communicator::world().is_root() {
        let text = harmless(text.to_string());
        said().keep(&text);
    }
}

impl Spoken {
    /// Adds a line to the log. A disk that is full ends the log, not the run.
    fn keep(&mut self, line: &str) {
        match &mut self.log {
            Log::Off => {}
            Log::Waiting(text) => *text += &format!("{line}\n"),
            Log::File(file) => {
                if file.write_all(format!("{line}\n").as_bytes()).is_err() {
                    self.log = Log::Off;
                }
            }
        }
    }

    /// Remembers a line; whether it has to be said also where all is quiet.
    fn hear(&mut self, line: &str) -> bool {
        self.keep(line);
        let warning = line.strip_prefix(WARNING);
        if let Some(warning) = warning.filter(|warning| !self.warnings.iter().any(|w| w == warning)) {
            self.warnings.push(warning.to_string());
        }
        warning.is_some() || ENDS.iter().any(|end| line.starts_with(end))
    }
}

/// A line of the result, to standard output; rank 0 speaks for all.
pub fn line(text: Arguments<'_>) {
    if !Communicator::world().is_root() {
        return;
    }
    let line = harmless(text.to_string());
    let mut said = said();
    let has_to = said.hear(&line);
    let manner = said.manner;
    if manner.is_answer_only {
        said.output.push(line.clone());
    }
    drop(said);
    match manner {
        Manner {
            is_answer_only: false,
            ..
        } => to_standard_output(&line),
        Manner { is_quiet: true, .. } if !has_to => {}
        _ => to_standard_error(&line),
    }
}

/// The one line of an answer, to standard output; rank 0 speaks for all.
pub fn answer(text: &str) {
    if Communicator::world().is_root() {
        to_standard_output(text);
    }
}

/// A line to standard output as it is. That nobody reads any more is no error.
pub fn to_standard_output(line: &str) {
    let mut out = std::io::stdout().lock();
    let written = writeln!(out, "{line}").and_then(|()| out.flush());
    if let Err(error) = written
        && error.kind() != ErrorKind::BrokenPipe
    {
        said().unwritten.get_or_insert(error.to_string());
    }
}

/// Why standard output could not be written, the first time; None if it could, or if nobody reads any more.
pub fn unwritten() -> Option<String> {
    said().unwritten.clone()
}

/// A line about how it goes, to standard error; rank 0 speaks for all.
pub fn note(text: Arguments<'_>) {
    if !Communicator::world().is_root() {
        return;
    }
    let line = harmless(text.to_string());
    let mut said = said();
    let has_to = said.hear(&line);
    let is_said = has_to || !said.manner.is_quiet;
    drop(said);
    if is_said {
        to_standard_error(&line);
    }
}

/// A line to standard error from whatever rank this is, also where all is quiet.
pub fn from_any_rank(text: Arguments<'_>) {
    let line = harmless(text.to_string());
    said().keep(&line);
    to_standard_error(&line);
}

/// In one write, or the lines of several ranks mix.
fn to_standard_error(line: &str) {
    let _ = std::io::stderr().lock().write_all(format!("{line}\n").as_bytes());
}

/// Most characters of a line that are shown: texts may come from files.
const LONGEST: usize = 4000;

/// A text that cannot steer a terminal or fill it: control characters other than tabs and ends of lines are
/// spelled out, and lines of more than `LONGEST` characters are cut.
pub fn harmless(text: String) -> String {
    let steers = |c: char| c.is_control() && !['\n', '\t'].contains(&c);
    let is_harmless = |line: &str| line.len() <= LONGEST && !line.contains(steers);
    if text.lines().all(is_harmless) {
        return text;
    }
    let shown = |line: &str| {
        let n = line.chars().count();
        let mut shown = String::new();
        for c in line.chars().take(LONGEST) {
            match steers(c) {
                true => shown.extend(c.escape_default()),
                false => shown.push(c),
            }
        }
        if n > LONGEST {
            shown += &format!("... ({} more characters)", n - LONGEST);
        }
        shown
    };
    text.split('\n').map(shown).collect::<Vec<_>>().join("\n")
}

/// A number of things by the name of one: `1 pack`, `2 packs`.
pub fn counted<N: Display + PartialEq + From<u8>>(n: N, one: &str) -> String {
    let end = if n == N::from(1) { "" } else { "s" };
    format!("{n} {one}{end}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a title or a damaged cell of a file would move the cursor of a terminal, or fill it.
    #[test]
    fn texts_from_files_cannot_steer_a_terminal() {
        let plain = "error: größer\nthan µ".to_string();
        assert_eq!(harmless(plain.clone()), plain);
        assert_eq!(
            harmless("a\u{1b}[2Jb\rc\0\n".to_string()),
            "a\\u{1b}[2Jb\\rc\\u{0}\n"
        );
        let long = harmless("x".repeat(100_000) + "\nend");
        assert!(
            long.ends_with("x... (96000 more characters)\nend"),
            "{}",
            &long[3990..]
        );
        assert_eq!(long.lines().count(), 2);
    }

    /// Wrong: a line would speak of 1 packs, or of 0 pack.
    #[test]
    fn one_thing_has_no_plural() {
        assert_eq!(counted(0_usize, "pack"), "0 packs");
        assert_eq!(counted(1_u64, "step file"), "1 step file");
        assert_eq!(counted(18_usize, "gauge"), "18 gauges");
    }
}
