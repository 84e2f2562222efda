//! Words of commands that a user may copy into a shell.

use std::fmt::Display;

/// A text as one word of a POSIX shell: as it is, or in single quotes where a shell would take it apart.
/// ```
/// assert_eq!(input::shell_word("out/a.toml"), "out/a.toml");
/// assert_eq!(input::shell_word("own one.toml"), "'own one.toml'");
/// assert_eq!(input::shell_word("it's"), r"'it'\''s'");
/// ```
pub fn shell_word(text: impl Display) -> String {
    let text = text.to_string();
    let is_plain = |c: char| c.is_alphanumeric() || "/._-+=:,@%".contains(c);
    match !text.is_empty() && text.chars().all(is_plain) {
        true => text,
        false => shell_quoted(&text),
    }
}

/// A text as one word of a POSIX shell, in single quotes.
pub fn shell_quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', r"'\''"))
}
