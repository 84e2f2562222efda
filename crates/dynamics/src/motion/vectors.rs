//! Sums of long vectors, number by number: the same bits on any number of threads.

use rayon::prelude::*;

/// Numbers of one task.
pub(super) const TASK: usize = 1 << 14;

/// s[0] x + s[1] y.
pub(super) fn combined(s: [f64; 2], x: &[f64], y: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; x.len()];
    sum.par_chunks_mut(TASK)
        .zip(x.par_chunks(TASK).zip(y.par_chunks(TASK)))
        .for_each(|(sum, (x, y))| combine_part(s, [x, y], sum));
    sum
}

/// Adds x to the sum.
pub(super) fn add(sum: &mut [f64], x: &[f64]) {
    sum.par_chunks_mut(TASK)
        .zip(x.par_chunks(TASK))
        .for_each(|(sum, x)| add_part(sum, x));
}

/// s[0] x + s[1] y by one thread.
pub(super) fn combine_part(s: [f64; 2], [x, y]: [&[f64]; 2], sum: &mut [f64]) {
    let terms = sum.iter_mut().zip(x.iter().zip(y));
    terms.for_each(|(sum, (x, y))| *sum = s[0] * x + s[1] * y);
}

/// Adds x to the sum by one thread.
pub(super) fn add_part(sum: &mut [f64], x: &[f64]) {
    sum.iter_mut().zip(x).for_each(|(sum, x)| *sum += x);
}
