//! Static condensation of a matrix on its first rows: what those feel when nothing acts on the others.
//!
//! With the first rows s and the rest r of K, the rest follows by T = -K_rr^-1 K_rs, and
//!
//! ```text
//! K_c = K_ss + K_sr T,      C_c = C_ss + C_sr T + L C_rs + L C_rr T,      L = -K_sr K_rr^-1
//! ```
//!
//! C_c is the growth with s, at s = 0, of the condensed K + s C: damping of slow motions. K may be unsymmetric.

use std::ops::Range;

use dense::{BlockLu, DenseError, DenseLu};

/// Least share of a diagonal that [`hold_sliding`] leaves to a pivot, over that of a singular one.
const SAFETY: f64 = 16.0;

/// How the rows that are condensed out of a matrix follow the others.
pub struct Condensation {
    n: usize,
    kept: usize,
    /// T by columns, `[kept][n - kept]`.
    follow: Vec<f64>,
    /// L by rows, `[kept][n - kept]`.
    answer: Vec<f64>,
}

impl Condensation {
    /// Of the matrix of `n` rows, row-major, on its first `kept`.
    pub fn new(n: usize, kept: usize, matrix: &[f64]) -> Result<Condensation, DenseError> {
        let rest = n - kept;
        let at = |i: usize, j: usize| matrix[n * i + j];
        let solve = |block: Vec<f64>, mut columns: Vec<f64>| -> Result<Vec<f64>, DenseError> {
            DenseLu::factor(rest, &block)?.solve(&mut columns, kept);
            columns.iter_mut().for_each(|x| *x = -*x);
            Ok(columns)
        };
        let block = |entry: &dyn Fn(usize, usize) -> f64, rows: std::ops::Range<usize>| -> Vec<f64> {
            rows.flat_map(|i| (kept..n).map(|j| entry(i, j)).collect::<Vec<_>>())
                .collect()
        };
        let transposed = |i: usize, j: usize| at(j, i);
        Ok(Condensation {
            follow: solve(block(&at, kept..n), block(&transposed, 0..kept))?,
            answer: solve(block(&transposed, kept..n), block(&at, 0..kept))?,
            n,
            kept,
        })
    }

    /// A matrix of the same rows, condensed, row-major.
    pub fn apply(&self, matrix: &[f64]) -> Vec<f64> {
        let (n, m) = (self.n, self.kept);
        let rest = n - m;
        // The columns of M [1; T], of all rows.
        let column = |j: usize| -> Vec<f64> {
            let follow = &self.follow[rest * j..rest * (j + 1)];
            (0..n)
                .map(|i| {
                    let row = &matrix[n * i..n * (i + 1)];
                    row[j] + product(&row[m..], follow)
                })
                .collect()
        };
        let mut condensed = vec![0.0; m * m];
        for j in 0..m {
            let moved = column(j);
            for i in 0..m {
                let answer = &self.answer[rest * i..rest * (i + 1)];
                condensed[m * i + j] = moved[i] + product(answer, &moved[m..]);
            }
        }
        condensed
    }

    /// What rows over all unknowns are over those that are kept when the rest follow, row-major.
    pub fn followed(&self, rows: &[f64]) -> Vec<f64> {
        let rest = self.n - self.kept;
        let entry = |row: &[f64], j: usize| {
            row[j] + product(&row[self.kept..], &self.follow[rest * j..rest * (j + 1)])
        };
        let of_row = |row: &[f64]| (0..self.kept).map(|j| entry(row, j)).collect::<Vec<f64>>();
        rows.chunks_exact(self.n).flat_map(of_row).collect()
    }
}

/// K_c of a matrix of `n` rows, row-major, on its first N, by one factorisation. `blocks` of the rest, counted from its
/// first row, are eliminated first.
pub fn condensed<const N: usize>(
    n: usize,
    matrix: &[f64],
    blocks: &[Range<usize>],
) -> Result<[[f64; N]; N], DenseError> {
    let rows = || matrix.chunks_exact(n);
    let of_rest: Vec<f64> = rows().skip(N).flat_map(|row| &row[N..]).copied().collect();
    let factors = BlockLu::factor(n - N, &of_rest, blocks)?;
    let mut found = [[0.0; N]; N];
    for j in 0..N {
        let mut follow: Vec<f64> = rows().skip(N).map(|row| -row[j]).collect();
        factors.solve(&mut follow);
        for (found, row) in found.iter_mut().zip(rows()) {
            found[j] = row[j] + product(&row[N..], &follow);
        }
    }
    Ok(found)
}

/// Holds the two rows i and i + 1 of a matrix of `n` rows, row-major, where they all but slide in one direction: by as
/// much as a factorisation asks for, which is round-off beside their stiffness in the other.
///
/// So are the rows of a ball that just touches both raceways. Round-off presses it by about 1e-17 m: the slopes of its
/// contacts hold it along their normal, but across it there is nothing but Q/|l| of forces of some 1e-15 N.
pub fn hold_sliding(n: usize, i: usize, matrix: &mut [f64]) {
    let at = |row: usize, column: usize| matrix[n * row + column];
    let (sum, product) = (at(i, i) + at(i + 1, i + 1), at(i, i) * at(i + 1, i + 1));
    let least = SAFETY * n as f64 * f64::EPSILON;
    if (product - at(i, i + 1) * at(i + 1, i)).abs() < least * sum * sum {
        for row in [i, i + 1] {
            matrix[n * row + row] += least * sum.abs();
        }
    }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a ball between contacts that round-off presses would stop the solution of its bearing, or one that
    /// carries would be held. It slides across two springs in line; what the other end of one feels is both in series.
    #[test]
    fn rows_that_all_but_slide_are_held_and_others_keep_their_bits() {
        let (a, b, n) = (3.0, 7.0, 3);
        let [c, s] = [0.8, 0.6];
        let of = |across: f64| -> Vec<f64> {
            let block = |normal: f64, side: f64| (a + b) * normal + across * side;
            vec![
                a,
                -a * c,
                -a * s,
                -a * c,
                block(c * c, s * s),
                block(c * s, -c * s),
                -a * s,
                block(c * s, -c * s),
                block(s * s, c * c),
            ]
        };
        for across in [0.0, 1e-17, -1e-17] {
            let mut matrix = of(across);
            hold_sliding(n, 1, &mut matrix);
            let found = Condensation::new(n, 1, &matrix).unwrap().apply(&matrix)[0];
            assert!((found - a * b / (a + b)).abs() < 1e-12, "{across}: {found}");
        }
        let mut matrix = of(1e-9);
        hold_sliding(n, 1, &mut matrix);
        assert_eq!(matrix, of(1e-9));
    }

    /// Wrong: the rest would not follow without force, or an unsymmetric matrix would be taken for a symmetric one.
    /// Two springs in series, one of which answers with twice its force.
    #[test]
    fn springs_in_series_have_their_stiffness_and_damping() {
        let [a, b, twice] = [3.0, 7.0, 2.0];
        let series = |a: f64, b: f64| vec![a, -a, -twice * a, twice * a + b];
        let stiffness = series(a, b);
        let condensation = Condensation::new(2, 1, &stiffness).unwrap();
        let found = condensation.apply(&stiffness)[0];
        assert!((found - a * b / (twice * a + b)).abs() < 1e-15, "{found}");
        // Damping in proportion to stiffness stays in proportion.
        let damping: Vec<f64> = stiffness.iter().map(|k| 0.1 * k).collect();
        assert!((condensation.apply(&damping)[0] - 0.1 * found).abs() < 1e-15);
        // Difference quotient of the condensed K + s C.
        let damping = series(0.2, 0.5);
        let h = 1e-5;
        let at = |s: f64| {
            let sum: Vec<f64> = stiffness.iter().zip(&damping).map(|(k, c)| k + s * c).collect();
            Condensation::new(2, 1, &sum).unwrap().apply(&sum)[0]
        };
        let slope = (at(h) - at(-h)) / (2.0 * h);
        assert!((condensation.apply(&damping)[0] - slope).abs() < 1e-9, "{slope}");
    }
}
