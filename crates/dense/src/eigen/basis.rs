//! A basis that is orthonormal in the inner product of M, and products of tall matrices. All sums run in one order.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, Mat, MatMut, MatRef, Par};

use super::problem::{EigenProblem, dot};
use crate::factors::DenseCholesky;

/// Length of a vector after orthogonalisation, over that before, below which nothing new is left in it.
const DEPENDENT: f64 = 1e-11;
/// Square of the part of a column that is new in its block, over that of the column, from which on the block is made
/// orthonormal by Cholesky. What that leaves, round-off over this, goes the second time.
const INDEPENDENT: f64 = 1e-8;

/// Entries of A that products A C take at a time: each thread keeps a copy of so many, else of all of A.
const PACKED_AT_ONCE: usize = 1 << 20;
/// Rows are taken in multiples of what the innermost loops take together.
const ROWS_OF_KERNEL: usize = 64;

/// A^T B, column-major `[n_a][n_b]`, of column-major A `[n][n_a]` and B `[n][n_b]`.
pub fn inner_products(n: usize, a: &[f64], n_a: usize, b: &[f64], n_b: usize) -> Vec<f64> {
    let mut product = vec![0.0; n_a * n_b];
    matmul(
        MatMut::from_column_major_slice_mut(&mut product, n_a, n_b),
        Accum::Replace,
        MatRef::from_column_major_slice(a, n, n_a).transpose(),
        MatRef::from_column_major_slice(b, n, n_b),
        1.0,
        Par::Seq,
    );
    product
}

/// A C, column-major `[n][n_c]`, of column-major A `[n][n_a]` and C `[n_a][n_c]`.
pub fn linear_combinations(n: usize, a: &[f64], n_a: usize, c: &[f64], n_c: usize) -> Vec<f64> {
    let mut product = vec![0.0; n * n_c];
    add_combinations(n, &mut product, (a, n_a), (c, n_c), 1.0);
    product
}

/// B += factor A C of column-major B `[n][n_c]`, A `[n][n_a]` and C `[n_a][n_c]`.
pub fn add_combinations(
    n: usize,
    b: &mut [f64],
    (a, n_a): (&[f64], usize),
    (c, n_c): (&[f64], usize),
    factor: f64,
) {
    let (a, c) = (
        MatRef::from_column_major_slice(a, n, n_a),
        MatRef::from_column_major_slice(c, n_a, n_c),
    );
    let mut b = MatMut::from_column_major_slice_mut(b, n, n_c);
    let rows = (PACKED_AT_ONCE / n_a.max(1)).next_multiple_of(ROWS_OF_KERNEL);
    for start in (0..n).step_by(rows) {
        let n_rows = rows.min(n - start);
        let of_rows = b.as_mut().subrows_mut(start, n_rows);
        matmul(of_rows, Accum::Add, a.subrows(start, n_rows), c, factor, Par::Seq);
    }
}

/// Vectors that are orthonormal in M, column-major `[n][m]`.
pub(super) struct Basis {
    n: usize,
    vectors: Vec<f64>,
}

/// An orthonormal block Q and what it came from: W = Q R.
pub(super) struct OrthonormalBlock {
    /// Q, column-major `[n][width]`.
    pub vectors: Vec<f64>,
    /// M Q, column-major `[n][width]`.
    pub mass: Vec<f64>,
    /// Number of its columns.
    pub width: usize,
    /// R, column-major `[width][n_w]`.
    pub factor: Vec<f64>,
}

impl Basis {
    pub fn new(n: usize) -> Basis {
        Basis {
            n,
            vectors: Vec::new(),
        }
    }

    /// Number of vectors.
    pub fn len(&self) -> usize {
        self.vectors.len() / self.n
    }

    /// Appends an orthonormal block that is orthogonal to the basis.
    pub fn append(&mut self, block: &[f64]) {
        self.vectors.extend_from_slice(block);
    }

    /// Keeps the first `m` vectors.
    pub fn truncate(&mut self, m: usize) {
        self.vectors.truncate(self.n * m);
    }

    /// Combinations V C, column-major `[n][n_c]`.
    pub fn combine(&self, c: &[f64], n_c: usize) -> Vec<f64> {
        linear_combinations(self.n, &self.vectors, self.len(), c, n_c)
    }

    /// Replaces the basis by the combinations V C.
    pub fn replace(&mut self, c: &[f64], n_c: usize) {
        self.vectors = self.combine(c, n_c);
    }

    /// Makes a block W orthogonal to the basis and orthonormal, both twice: W = V C + Q R. Also returns C = V^T M W,
    /// column-major `[m][width]`. Columns with nothing new in them are left out of Q.
    pub fn orthonormalise(
        &self,
        problem: &dyn EigenProblem,
        mut w: Vec<f64>,
        width: usize,
    ) -> (OrthonormalBlock, Vec<f64>) {
        let (n, m) = (self.n, self.len());
        let mass = problem.mass(&w, width);
        let columns = w.chunks_exact(n).zip(mass.chunks_exact(n));
        let lengths: Vec<f64> = columns.map(|(x, mx)| dot(x, mx).max(0.0).sqrt()).collect();
        let mut coefficients = self.subtract_projection(&mut w, &mass, width);
        let mass = problem.mass(&w, width);
        let first = orthonormal(n, w, mass, &lengths);
        let (mut vectors, kept) = (first.vectors, first.width);
        // Cancellation has spoiled columns that became short, and what M makes of them: once more, now at length one.
        let mass = problem.mass(&vectors, kept);
        let again = self.subtract_projection(&mut vectors, &mass, kept);
        if m > 0 && kept > 0 {
            add_combinations(m, &mut coefficients, (&again, kept), (&first.factor, width), 1.0);
        }
        let mass = problem.mass(&vectors, kept);
        let second = orthonormal(n, vectors, mass, &vec![0.0; kept]);
        let factor = match kept {
            0 => Vec::new(),
            _ => linear_combinations(second.width, &second.factor, kept, &first.factor, width),
        };
        (OrthonormalBlock { factor, ..second }, coefficients)
    }

    /// W -= V C with C = V^T (M W), which is returned.
    fn subtract_projection(&self, w: &mut [f64], mass: &[f64], width: usize) -> Vec<f64> {
        let m = self.len();
        if m == 0 || width == 0 {
            return vec![0.0; m * width];
        }
        let coefficients = inner_products(self.n, &self.vectors, m, mass, width);
        add_combinations(self.n, w, (&self.vectors, m), (&coefficients, width), -1.0);
        coefficients
    }
}

/// Q R = W in M; `lengths` are what columns count against to be new. Columns that are not are left out.
fn orthonormal(n: usize, block: Vec<f64>, mass: Vec<f64>, lengths: &[f64]) -> OrthonormalBlock {
    cholesky_qr(n, &block, &mass, lengths).unwrap_or_else(|| gram_schmidt(n, block, mass, lengths))
}

/// The same by W^T M W = R^T R, Q = W R^-1, in products of blocks; None where a column is nearly or wholly dependent on
/// those before it (Yamamoto et al., ETNA 44 (2015) 306: twice is as good as Householder).
fn cholesky_qr(n: usize, block: &[f64], mass: &[f64], lengths: &[f64]) -> Option<OrthonormalBlock> {
    let width = lengths.len();
    let gram = inner_products(n, block, width, mass, width);
    let value = |i: usize, j: usize| 0.5 * (gram[width * j + i] + gram[width * i + j]);
    let symmetric: Vec<f64> = (0..width * width).map(|k| value(k / width, k % width)).collect();
    let lower = DenseCholesky::factor(width, &symmetric).ok()?.into_lower();
    // Written so that a NaN is refused too.
    let is_new = |j: usize| {
        let left = lower[(j, j)].powi(2);
        left > INDEPENDENT * value(j, j) && left.sqrt() > DEPENDENT * lengths[j]
    };
    if !(0..width).all(is_new) {
        return None;
    }
    let mut inverse = Mat::<f64>::identity(width, width);
    solve_lower_triangular_in_place(lower.as_ref(), inverse.as_mut(), Par::Seq);
    // R and its inverse are transposes of L and its own.
    let upper = |of: &Mat<f64>| -> Vec<f64> {
        let entry = |k: usize| {
            if k % width <= k / width {
                of[(k / width, k % width)]
            } else {
                0.0
            }
        };
        (0..width * width).map(entry).collect()
    };
    let [factor, inverse] = [lower, inverse].map(|of| upper(&of));
    let [vectors, mass] = [block, mass].map(|of| linear_combinations(n, of, width, &inverse, width));
    Some(OrthonormalBlock {
        vectors,
        mass,
        width,
        factor,
    })
}

/// Gram-Schmidt in M, every column twice against those before it; `lengths` are what columns count against to be new.
fn gram_schmidt(n: usize, mut block: Vec<f64>, mut mass: Vec<f64>, lengths: &[f64]) -> OrthonormalBlock {
    let n_columns = lengths.len();
    let (mut kept, mut kept_mass): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut rows = vec![0.0; n_columns * n_columns];
    let mut width = 0;
    for j in 0..n_columns {
        let column = &mut block[n * j..n * (j + 1)];
        let mass_column = &mut mass[n * j..n * (j + 1)];
        for _ in 0..2 {
            for i in 0..width {
                let (q, mq) = (&kept[n * i..n * (i + 1)], &kept_mass[n * i..n * (i + 1)]);
                let c = dot(q, mass_column);
                column.iter_mut().zip(q).for_each(|(x, q)| *x -= c * q);
                mass_column.iter_mut().zip(mq).for_each(|(x, q)| *x -= c * q);
                rows[n_columns * j + i] += c;
            }
        }
        let length = dot(column, mass_column).max(0.0).sqrt();
        // Written so that a NaN is left out too.
        if !(length > DEPENDENT * lengths[j] && length > 0.0) {
            continue;
        }
        rows[n_columns * j + width] = length;
        kept.extend(column.iter().map(|x| x / length));
        kept_mass.extend(mass_column.iter().map(|x| x / length));
        width += 1;
    }
    let factor = (0..n_columns).flat_map(|j| rows[n_columns * j..n_columns * j + width].to_vec());
    OrthonormalBlock {
        vectors: kept,
        mass: kept_mass,
        width,
        factor: factor.collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Masses alone.
    struct Masses(Vec<f64>);

    impl EigenProblem for Masses {
        fn n(&self) -> usize {
            self.0.len()
        }

        fn shift(&self) -> f64 {
            1.0
        }

        fn stiffness(&self, x: &[f64], _: usize) -> Vec<f64> {
            x.to_vec()
        }

        fn mass(&self, x: &[f64], _: usize) -> Vec<f64> {
            x.iter().zip(self.0.iter().cycle()).map(|(x, m)| m * x).collect()
        }

        fn solve(&self, b: Vec<f64>, _: usize) -> Vec<f64> {
            b
        }
    }

    const N: usize = 60;

    /// Columns without an order, of very different lengths.
    fn columns(width: usize, first: usize) -> Vec<f64> {
        let value = |k: usize| {
            (1.3 + 0.7 * ((first + k) * (first + k)) as f64).sin() * 10f64.powi((k / N % 3) as i32)
        };
        (0..N * width).map(value).collect()
    }

    fn masses() -> Masses {
        Masses((0..N).map(|i| 0.2 + (i % 7) as f64).collect())
    }

    /// Largest entry of A - 1.
    fn off_identity(n: usize, a: &[f64]) -> f64 {
        let off = |k: usize| (a[k] - f64::from(u8::from(k / n == k % n))).abs();
        (0..n * n).map(off).fold(0.0, f64::max)
    }

    /// Wrong: blocks would not be orthonormal, or the projection and the residuals of a search would be of others: W =
    /// V C + Q R. Columns are independent, nearly dependent, or with one that has nothing new.
    #[test]
    fn a_block_is_its_projection_and_an_orthonormal_rest() {
        let problem = masses();
        let empty = Basis::new(N);
        let (start, _) = empty.orthonormalise(&problem, columns(5, 0), 5);
        let mut basis = Basis::new(N);
        basis.append(&start.vectors);
        for (near, width, by_cholesky) in [(1.0, 6, true), (1e-6, 6, false), (0.0, 5, false)] {
            let mut w = columns(6, 1000);
            // The last column is that before it, but for a share; what the basis has of it is large.
            for i in 0..N {
                w[5 * N + i] = near * w[5 * N + i] + 3.0 * w[4 * N + i];
            }
            let mass = problem.mass(&w, 6);
            assert_eq!(
                cholesky_qr(N, &w, &mass, &[0.0; 6]).is_some(),
                by_cholesky,
                "{near}"
            );
            (0..N).for_each(|i| w[5 * N + i] += 50.0 * start.vectors[i]);
            let (found, coefficients) = basis.orthonormalise(&problem, w.clone(), 6);
            assert_eq!(found.width, width, "{near}");
            let all = [&start.vectors[..], &found.vectors].concat();
            let n_all = 5 + width;
            let gram = inner_products(N, &all, n_all, &problem.mass(&all, n_all), n_all);
            assert!(off_identity(n_all, &gram) < 1e-13, "{near}");
            let mut rest = w.clone();
            add_combinations(N, &mut rest, (&start.vectors, 5), (&coefficients, 6), -1.0);
            add_combinations(N, &mut rest, (&found.vectors, width), (&found.factor, 6), -1.0);
            let size = w.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            let left = rest.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            assert!(left < 1e-12 * size, "{near}: {left:e} of {size:e}");
            assert!(
                found
                    .mass
                    .iter()
                    .zip(problem.mass(&found.vectors, width))
                    .all(|(a, b)| (a - b).abs() < 1e-12)
            );
        }
    }

    /// Wrong: rows of a combination at the border of two blocks would be left out, or added twice.
    #[test]
    fn combinations_of_many_rows_are_those_of_each_row() {
        let (n_a, n_c) = (300, 3);
        let n = 2 * (PACKED_AT_ONCE / n_a) + ROWS_OF_KERNEL + 5;
        let number = |k: usize| (0.7 * k as f64).sin();
        let a: Vec<f64> = (0..n * n_a).map(number).collect();
        let c: Vec<f64> = (0..n_a * n_c).map(|k| number(3 * k + 1)).collect();
        let mut b = vec![1.0; n * n_c];
        add_combinations(n, &mut b, (&a, n_a), (&c, n_c), -2.0);
        for (k, found) in b.iter().enumerate() {
            let (row, column) = (k % n, k / n);
            let sum: f64 = (0..n_a).map(|j| a[n * j + row] * c[n_a * column + j]).sum();
            let expected = 1.0 - 2.0 * sum;
            // A sum of 300 terms of up to one.
            assert!(
                (found - expected).abs() < 1e-12,
                "{row} {column}: {found} {expected}"
            );
        }
    }

    /// Wrong: the two ways to an orthonormal block would be two blocks.
    #[test]
    fn cholesky_and_gram_schmidt_give_the_same_block() {
        let (problem, w) = (masses(), columns(6, 7));
        let mass = problem.mass(&w, 6);
        let found = cholesky_qr(N, &w, &mass, &[0.0; 6]).unwrap();
        let expected = gram_schmidt(N, w, mass, &[0.0; 6]);
        for (a, b) in [
            (&found.vectors, &expected.vectors),
            (&found.mass, &expected.mass),
            (&found.factor, &expected.factor),
        ] {
            let size = b.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            assert!(a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-10 * size));
        }
    }
}
