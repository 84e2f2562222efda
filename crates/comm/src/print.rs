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
    let _ = writeln!(std::io::stdout().lock(), "{text}");
}

/// A line about how it goes, to standard error; rank 0 speaks for all.
pub fn note(text: Arguments<'_>) {
    if Communicator::world().is_root() {
        from_any_rank(text);
    }
}

/// A line to standard error from whatever rank this is.
pub fn from_any_rank(text: Arguments<'_>) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}
