//! Lines for the user. Unlike `println!`, these do not panic when nobody reads any more (`raceway run ... | head`):
//! the run goes on, as its results are files.

use std::fmt::Arguments;
use std::io::Write;

/// A line of the result, to standard output.
pub fn line(text: Arguments<'_>) {
    let _ = writeln!(std::io::stdout().lock(), "{text}");
}

/// A line about how it goes, to standard error.
pub fn note(text: Arguments<'_>) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}
