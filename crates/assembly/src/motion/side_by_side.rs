//! Bearings that work side by side: none sees another, so threads change no bit.

use rayon::prelude::*;

use crate::error::AssemblyError;

/// What each bearing gives, in their order, or the error of the first that fails.
pub fn in_order<T: Send>(
    of_bearings: impl IndexedParallelIterator<Item = Result<T, AssemblyError>>,
) -> Result<Vec<T>, AssemblyError> {
    let found: Vec<Result<T, AssemblyError>> = of_bearings.collect();
    found.into_iter().collect()
}
