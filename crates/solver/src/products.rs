//! Products of sparse matrices with blocks of vectors.

use rayon::prelude::*;
use sprs::CsMat;

/// Rows per task: below, splitting costs more than it gains.
const ROWS: usize = 2048;

/// A X of a block of vectors, column-major. The matrix is read once for every four vectors. A row is summed by one
/// thread in its own order: the same bits on any number of threads.
pub fn products(a: &CsMat<f64>, x: &[f64], n_vectors: usize) -> Vec<f64> {
    let n = a.rows();
    let mut result = Vec::with_capacity(n * n_vectors);
    for group in x.chunks(n * LANES) {
        let mut columns = [&group[..n]; LANES];
        for (column, x) in columns.iter_mut().zip(group.chunks_exact(n)) {
            *column = x;
        }
        let rows = lane_products(a, columns);
        for lane in 0..group.len() / n {
            result.extend(rows.iter().map(|row| row[lane]));
        }
    }
    result
}

/// Vectors that are multiplied together.
const LANES: usize = 4;

fn lane_products(a: &CsMat<f64>, x: [&[f64]; LANES]) -> Vec<[f64; LANES]> {
    let (starts, columns, values) = (a.indptr(), a.indices(), a.data());
    let starts = starts.raw_storage();
    let row = |i: usize| {
        let range = starts[i]..starts[i + 1];
        let mut sums = [0.0; LANES];
        for (&j, value) in columns[range.clone()].iter().zip(&values[range]) {
            for (sum, x) in sums.iter_mut().zip(&x) {
                *sum += value * x[j];
            }
        }
        sums
    };
    let all = (0..a.rows()).into_par_iter().with_min_len(ROWS);
    all.map(row).collect()
}
