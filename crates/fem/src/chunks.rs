//! The loop over elements: computed in parallel, consumed in the order of the elements.
//!
//! Elements go in waves. While the threads compute a wave, the wave before it is scattered, element after element, so
//! that every sum has one order for any number of threads. Memory: two waves of element values.

use rayon::prelude::*;

use crate::error::FemError;

/// Elements computed as one task.
const TASK: usize = 32;
/// Elements per wave: enough tasks for tens of threads, and at most 15 MB of hex20 matrices.
const WAVE: usize = 512;

/// Calls `compute(e, values)` for every element, in parallel, with `n_values` values to overwrite (they hold an
/// earlier element's), and `scatter(e, values)` in the order of the elements. The error of the first failing element
/// is returned.
pub(crate) fn for_each_element<C, S>(
    n_elements: usize,
    n_values: usize,
    compute: C,
    mut scatter: S,
) -> Result<(), FemError>
where
    C: Fn(usize, &mut [f64]) -> Result<(), FemError> + Sync,
    S: FnMut(usize, &[f64]) + Send,
{
    let width = WAVE.min(n_elements) * n_values;
    let (mut current, mut next) = (vec![0.0; width], vec![0.0; width]);
    compute_wave(0, n_elements, n_values, &mut current, &compute)?;
    for start in (0..n_elements).step_by(WAVE) {
        let (computed, ()) = rayon::join(
            || compute_wave(start + WAVE, n_elements, n_values, &mut next, &compute),
            || {
                let n = WAVE.min(n_elements - start);
                for (i, values) in current.chunks_exact(n_values).take(n).enumerate() {
                    scatter(start + i, values);
                }
            },
        );
        computed?;
        std::mem::swap(&mut current, &mut next);
    }
    Ok(())
}

/// Computes the elements from `start` to the end of its wave.
fn compute_wave<C>(
    start: usize,
    n_elements: usize,
    n_values: usize,
    values: &mut [f64],
    compute: &C,
) -> Result<(), FemError>
where
    C: Fn(usize, &mut [f64]) -> Result<(), FemError> + Sync,
{
    let n = WAVE.min(n_elements.saturating_sub(start));
    let values = &mut values[..n * n_values];
    let outcomes: Vec<Result<(), FemError>> = values
        .par_chunks_mut(TASK * n_values)
        .enumerate()
        .map(|(task, values)| {
            let first = start + task * TASK;
            let mut elements = values.chunks_exact_mut(n_values).enumerate();
            elements.try_for_each(|(i, values)| compute(first + i, values))
        })
        .collect();
    outcomes.into_iter().collect()
}
