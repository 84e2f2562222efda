//! Lines for the user. Unlike `println!`, these do not panic when nobody reads any more (`raceway run ... | head`):
//! the run goes on, as its results are files.

use std::fmt::Arguments;
use std::io::Write;

use crate::communicator::Communicator;

/// A line of the result, to standard output; rank 0 speaks for all.
pub fn line(text: Arguments<'_>) {
    if !Communicator::world().is_root() {
        return;
    }
    let _ = writeln!(std::io::stdout().lock(), "{}", harmless(text.to_string()));
}

/// A line about how it goes, to standard error; rank 0 speaks for all.
pub fn note(text: Arguments<'_>) {
    if Communicator::world().is_root() {
        from_any_rank(text);
    }
}

/// A line to standard error from whatever rank this is: in one write, or the lines of several ranks mix.
pub fn from_any_rank(text: Arguments<'_>) {
    let line = harmless(text.to_string()) + "\n";
    let _ = std::io::stderr().lock().write_all(line.as_bytes());
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
}
