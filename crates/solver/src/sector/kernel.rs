//! Triangular solves of one right-hand side with one dense panel.
//!
//! A panel is column-major `[width][height]`, a lower trapezoid. Both sweeps read each entry once, in the order of
//! memory, which bounds their speed. How many columns are taken together is a matter of what the processor fetches ahead: one
//! after the other for short columns forwards, eight side by side else. Measured on panels in memory, one core, in units of the time to
//! read them (a prototype that split columns a little differently; 22 November 2026, loaded machine, AVX-512), with four columns always
//! taken together in brackets:
//!
//! | width x height | forwards | backwards |
//! |---|---|---|
//! | 12 x 60 | 1.0 (3.2) | 2.6 (3.3) |
//! | 24 x 150 | 1.2 (2.8) | 2.4 (3.1) |
//! | 60 x 400 | 0.9 (1.8) | 1.3 (1.7) |
//! | 200 x 900 | 0.9 (1.7) | 1.1 (1.6) |
//! | 570 x 1140 | 0.8 (1.5) | 1.0 (1.4) |
//!
//! Products and sums are not fused, and sums run in eight lanes whatever the processor has, so that the bits do not depend on it.

/// Columns taken together.
const COLUMNS: usize = 8;
/// Height from which they are, forwards.
const TALL: usize = 256;
/// Partial sums of a scalar product.
const LANES: usize = 8;

/// `[x; t] -> [L^-1 x; t - F L^-1 x]` with the panel [L; F]; `x` and `t` are `buffer`, `[height]`.
#[inline(always)]
pub(super) fn forward(panel: &[f64], width: usize, height: usize, buffer: &mut [f64]) {
    let mut first = 0;
    if height >= TALL {
        while first + COLUMNS <= width {
            let columns = [0, 1, 2, 3, 4, 5, 6, 7].map(|j| &panel[height * (first + j)..][first..height]);
            eliminate_columns(columns, &mut buffer[first..height]);
            first += COLUMNS;
        }
    }
    for j in first..width {
        let column = &panel[height * j..][j..height];
        if let ([x, tail @ ..], [pivot, below @ ..]) = (&mut buffer[j..height], column) {
            *x /= pivot;
            tail.iter_mut().zip(below).for_each(|(t, c)| *t -= c * *x);
        }
    }
}

/// Forward elimination with columns that start at their triangle.
#[inline(always)]
fn eliminate_columns(columns: [&[f64]; COLUMNS], buffer: &mut [f64]) {
    let (x, tail) = buffer.split_at_mut(COLUMNS);
    for j in 0..COLUMNS {
        x[j] /= columns[j][j];
        for i in j + 1..COLUMNS {
            x[i] -= columns[j][i] * x[j];
        }
    }
    let below = columns.map(|column| &column[COLUMNS..][..tail.len()]);
    let [c0, c1, c2, c3, c4, c5, c6, c7] = below;
    let [x0, x1, x2, x3, x4, x5, x6, x7] = [0, 1, 2, 3, 4, 5, 6, 7].map(|j| x[j]);
    for (i, t) in tail.iter_mut().enumerate() {
        let low = (c0[i] * x0 + c1[i] * x1) + (c2[i] * x2 + c3[i] * x3);
        let high = (c4[i] * x4 + c5[i] * x5) + (c6[i] * x6 + c7[i] * x7);
        *t -= low + high;
    }
}

/// `[x; t] -> [L^-T (x - F^T t); t]`.
#[inline(always)]
pub(super) fn backward(panel: &[f64], width: usize, height: usize, buffer: &mut [f64]) {
    let mut end = width;
    while !end.is_multiple_of(COLUMNS) {
        end -= 1;
        substitute_columns::<1>(panel, height, end, buffer);
    }
    while end > 0 {
        end -= COLUMNS;
        substitute_columns::<COLUMNS>(panel, height, end, buffer);
    }
}

/// Backward substitution in N columns from `first` on.
#[inline(always)]
fn substitute_columns<const N: usize>(panel: &[f64], height: usize, first: usize, buffer: &mut [f64]) {
    let mut columns = [&panel[..0]; N];
    for (j, column) in columns.iter_mut().enumerate() {
        *column = &panel[height * (first + j)..][first..height];
    }
    let (x, tail) = buffer[first..height].split_at_mut(N);
    let sums = dots(columns.map(|column| &column[N..]), tail);
    for j in (0..N).rev() {
        let mut value = x[j] - sums[j];
        for i in j + 1..N {
            value -= columns[j][i] * x[i];
        }
        x[j] = value / columns[j][j];
    }
}

/// Scalar products of several columns with one vector, all of the same length.
#[inline(always)]
fn dots<const N: usize>(columns: [&[f64]; N], x: &[f64]) -> [f64; N] {
    let (whole, rest) = x.as_chunks::<LANES>();
    let split = columns.map(|column| column.as_chunks::<LANES>());
    let chunks = split.map(|s| &s.0[..whole.len()]);
    let mut sums = [[0.0; LANES]; N];
    for (k, x) in whole.iter().enumerate() {
        for (sum, chunks) in sums.iter_mut().zip(&chunks) {
            for lane in 0..LANES {
                sum[lane] += chunks[k][lane] * x[lane];
            }
        }
    }
    for (sum, (_, column)) in sums.iter_mut().zip(&split) {
        for ((sum, c), x) in sum.iter_mut().zip(*column).zip(rest) {
            *sum += c * x;
        }
    }
    sums.map(|[a, b, c, d, e, f, g, h]| ((a + b) + (c + d)) + ((e + f) + (g + h)))
}
