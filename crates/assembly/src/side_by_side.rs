//! Bearings that work side by side: none sees another, so threads change no bit.
//!
//! Ranks that share the rings of bearings meet in each of them, so there bearings work one after the other.

use comm::Communicator;
use rayon::prelude::*;

use crate::error::AssemblyError;

/// What each bearing gives, in their order, or the error of the first that fails.
pub fn of_each<B: Send, T: Send>(
    bearings: impl Iterator<Item = B>,
    of: impl Fn(B) -> Result<T, AssemblyError> + Sync + Send,
) -> Result<Vec<T>, AssemblyError> {
    let comm = Communicator::world();
    match comm.size() {
        1 => side_by_side(bearings.collect(), of),
        _ => one_after_the_other(bearings, of, comm),
    }
}

fn side_by_side<B: Send, T: Send>(
    bearings: Vec<B>,
    of: impl Fn(B) -> Result<T, AssemblyError> + Sync + Send,
) -> Result<Vec<T>, AssemblyError> {
    let found: Vec<Result<T, AssemblyError>> = bearings.into_par_iter().map(of).collect();
    found.into_iter().collect()
}

/// The same by ranks that share rings. Where all fail, the bearings that follow get on too, as side by side: the next
/// try begins from what they have found. A rank that fails alone exchanges nothing more.
fn one_after_the_other<B, T>(
    bearings: impl Iterator<Item = B>,
    of: impl Fn(B) -> Result<T, AssemblyError>,
    comm: Communicator,
) -> Result<Vec<T>, AssemblyError> {
    let (mut found, mut first) = (Vec::new(), None);
    for bearing in bearings {
        match of(bearing) {
            Ok(value) => found.push(value),
            Err(error) if comm.all_failed() => first = first.or(Some(error)),
            Err(error) => return Err(error),
        }
    }
    first.map_or(Ok(found), Err)
}
