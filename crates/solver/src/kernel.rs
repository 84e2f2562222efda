//! Triangular solves of one right-hand side with one strip of a panel.
//!
//! A strip is column-major `[width][height]`, a lower trapezoid. Forwards it is read column by column from its first
//! entry to its last, backwards from its last to its first: memory comes fastest in one stream, up or down alike, and
//! each entry is read once. Four or eight columns side by side, or columns backwards with their rows forwards, take
//! two to three times as long when columns are shorter than 300 rows.
//!
//! Products and sums are not fused, and sums run in eight lanes whatever the processor has, so that the bits do not
//! depend on it.

/// Partial sums of a scalar product.
const LANES: usize = 8;

/// `[x; t] -> [L^-1 x; t - F L^-1 x]` with the strip [L; F]; `x` and `t` are `buffer`, `[height]`.
#[inline(always)]
pub(crate) fn forward(strip: &[f64], width: usize, height: usize, buffer: &mut [f64]) {
    for j in 0..width {
        let column = &strip[height * j..][j..height];
        if let ([x, below @ ..], [pivot, column @ ..]) = (&mut buffer[j..height], column) {
            *x /= pivot;
            below.iter_mut().zip(column).for_each(|(t, c)| *t -= c * *x);
        }
    }
}

/// Columns of a strip that meet the rows below them together.
const COLUMNS: usize = 4;

/// [`forward`] of several right-hand sides, one every `stride` numbers of `buffer`.
#[inline(always)]
pub(crate) fn forward_few(strip: &[f64], width: usize, height: usize, buffer: &mut [f64], stride: usize) {
    for first in (0..width).step_by(COLUMNS) {
        let end = width.min(first + COLUMNS);
        for x in buffer.chunks_mut(stride) {
            for j in first..end {
                let column = &strip[height * j..height * (j + 1)];
                x[j] /= column[j];
                let value = x[j];
                x[j + 1..end]
                    .iter_mut()
                    .zip(&column[j + 1..end])
                    .for_each(|(x, c)| *x -= c * value);
            }
        }
        let below = |j: usize| &strip[height * j + end..height * (j + 1)];
        for x in buffer.chunks_mut(stride) {
            let (x, t) = x[..height].split_at_mut(end);
            match x[first..] {
                [x0, x1, x2, x3] => {
                    let [c0, c1, c2, c3] = [0, 1, 2, 3].map(|k| below(first + k));
                    for ((((t, c0), c1), c2), c3) in t.iter_mut().zip(c0).zip(c1).zip(c2).zip(c3) {
                        *t -= (c0 * x0 + c1 * x1) + (c2 * x2 + c3 * x3);
                    }
                }
                ref x => {
                    for (j, x) in (first..end).zip(x) {
                        t.iter_mut().zip(below(j)).for_each(|(t, c)| *t -= c * x);
                    }
                }
            }
        }
    }
}

/// `[x; t] -> [L^-T (x - F^T t); t]`.
#[inline(always)]
pub(crate) fn backward(strip: &[f64], width: usize, height: usize, buffer: &mut [f64]) {
    for j in (0..width).rev() {
        let column = &strip[height * j..][j..height];
        if let ([x, below @ ..], [pivot, column @ ..]) = (&mut buffer[j..height], column) {
            *x = (*x - dot_from_end(column, below)) / pivot;
        }
    }
}

/// Scalar product of two vectors of one length, from the last entry to the first.
#[inline(always)]
fn dot_from_end(a: &[f64], b: &[f64]) -> f64 {
    let ((a_rest, a), (b_rest, b)) = (a.as_rchunks::<LANES>(), b.as_rchunks::<LANES>());
    let mut sums = [0.0; LANES];
    for (a, b) in a.iter().zip(b).rev() {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    let [a, b, c, d, e, f, g, h] = sums;
    (((a + e) + (c + g)) + ((b + f) + (d + h))) + rest
}
