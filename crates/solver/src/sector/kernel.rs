//! Triangular solves of one right-hand side with one dense panel, four columns at a time.
//!
//! A panel is column-major `[width][height]`, a lower trapezoid. Both sweeps read each entry once, in the order of
//! memory, which bounds their speed. Products and sums are not fused, and sums run in eight lanes whatever the
//! processor has, so that the bits do not depend on it.

/// Columns taken together.
const COLUMNS: usize = 4;
/// Partial sums of a scalar product.
const LANES: usize = 8;

/// `[x; t] -> [L^-1 x; t - F L^-1 x]` with the panel [L; F]; `x` and `t` are `buffer`, `[height]`.
#[inline(always)]
pub(super) fn forward(panel: &[f64], width: usize, height: usize, buffer: &mut [f64]) {
    let column = |j: usize| &panel[height * j..height * (j + 1)];
    let mut first = 0;
    while first < width {
        let end = (first + COLUMNS).min(width);
        for j in first..end {
            let c = column(j);
            buffer[j] /= c[j];
            for i in j + 1..end {
                buffer[i] -= c[i] * buffer[j];
            }
        }
        let (head, tail) = buffer.split_at_mut(end);
        let x = &head[first..];
        if let &[x0, x1, x2, x3] = x {
            let [c0, c1, c2, c3] = [0, 1, 2, 3].map(|j| &column(first + j)[end..]);
            let columns = c0.iter().zip(c1).zip(c2).zip(c3);
            for (t, (((a, b), c), d)) in tail.iter_mut().zip(columns) {
                *t -= (a * x0 + b * x1) + (c * x2 + d * x3);
            }
        } else {
            for (j, x) in x.iter().enumerate() {
                let c = &column(first + j)[end..];
                tail.iter_mut().zip(c).for_each(|(t, c)| *t -= c * x);
            }
        }
        first = end;
    }
}

/// `[x; t] -> [L^-T (x - F^T t); t]`.
#[inline(always)]
pub(super) fn backward(panel: &[f64], width: usize, height: usize, buffer: &mut [f64]) {
    let column = |j: usize| &panel[height * j..height * (j + 1)];
    let mut end = width;
    while end > 0 {
        let first = (end - 1) / COLUMNS * COLUMNS;
        let mut sums = [0.0; COLUMNS];
        let tail = &buffer[end..height];
        if end - first == COLUMNS {
            sums = dots([0, 1, 2, 3].map(|j| &column(first + j)[end..]), tail);
        } else {
            for (j, sum) in sums.iter_mut().enumerate().take(end - first) {
                *sum = dots([&column(first + j)[end..]], tail)[0];
            }
        }
        for j in (first..end).rev() {
            let c = column(j);
            let mut x = buffer[j] - sums[j - first];
            for i in j + 1..end {
                x -= c[i] * buffer[i];
            }
            buffer[j] = x / c[j];
        }
        end = first;
    }
}

/// Scalar products of several columns with one vector, all of the same length.
#[inline(always)]
fn dots<const N: usize>(columns: [&[f64]; N], x: &[f64]) -> [f64; N] {
    let mut sums = [[0.0; LANES]; N];
    let (whole, rest) = x.as_chunks::<LANES>();
    let split = columns.map(|c| c.as_chunks::<LANES>());
    for (k, x) in whole.iter().enumerate() {
        for (sum, column) in sums.iter_mut().zip(&split) {
            let c = &column.0[k];
            for lane in 0..LANES {
                sum[lane] += c[lane] * x[lane];
            }
        }
    }
    let mut result = [0.0; N];
    for (j, sum) in sums.iter().enumerate() {
        let [a, b, c, d, e, f, g, h] = *sum;
        let tail: f64 = split[j].1.iter().zip(rest).map(|(c, x)| c * x).sum();
        result[j] = ((a + b) + (c + d)) + ((e + f) + (g + h)) + tail;
    }
    result
}
