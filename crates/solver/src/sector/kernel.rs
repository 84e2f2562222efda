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
pub(super) fn forward(strip: &[f64], width: usize, height: usize, buffer: &mut [f64]) {
    for j in 0..width {
        let column = &strip[height * j..][j..height];
        if let ([x, below @ ..], [pivot, column @ ..]) = (&mut buffer[j..height], column) {
            *x /= pivot;
            below.iter_mut().zip(column).for_each(|(t, c)| *t -= c * *x);
        }
    }
}

/// `[x; t] -> [L^-T (x - F^T t); t]`.
#[inline(always)]
pub(super) fn backward(strip: &[f64], width: usize, height: usize, buffer: &mut [f64]) {
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
