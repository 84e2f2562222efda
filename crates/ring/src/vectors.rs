//! Sums of long vectors, number by number: the same bits on any number of threads.

use std::ops::Range;

use rayon::prelude::*;

/// Numbers of one task.
pub(crate) const TASK: usize = 1 << 14;

/// s[0] x + s[1] y.
pub(crate) fn combined(s: [f64; 2], x: &[f64], y: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; x.len()];
    sum.par_chunks_mut(TASK)
        .zip(x.par_chunks(TASK).zip(y.par_chunks(TASK)))
        .for_each(|(sum, (x, y))| combine_part(s, [x, y], sum));
    sum
}

/// Adds x to the sum.
pub(crate) fn add(sum: &mut [f64], x: &[f64]) {
    sum.par_chunks_mut(TASK)
        .zip(x.par_chunks(TASK))
        .for_each(|(sum, x)| add_part(sum, x));
}

/// s[0] x + s[1] y by one thread.
pub(crate) fn combine_part(s: [f64; 2], [x, y]: [&[f64]; 2], sum: &mut [f64]) {
    let terms = sum.iter_mut().zip(x.iter().zip(y));
    terms.for_each(|(sum, (x, y))| *sum = s[0] * x + s[1] * y);
}

/// Adds x to the sum by one thread.
pub(crate) fn add_part(sum: &mut [f64], x: &[f64]) {
    sum.iter_mut().zip(x).for_each(|(sum, x)| *sum += x);
}

/// a . b, summed in order.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Some rows of a block of columns of `n` rows, column-major.
pub fn rows_of(columns: &[f64], n: usize, rows: &Range<usize>) -> Vec<f64> {
    let mut own = Vec::with_capacity(columns.len() / n.max(1) * rows.len());
    let columns = columns.chunks_exact(n.max(1));
    columns.for_each(|column| own.extend_from_slice(&column[rows.clone()]));
    own
}

/// Component-wise a + b.
pub(crate) fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}
