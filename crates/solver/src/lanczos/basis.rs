//! A basis that is orthonormal in the inner product of M, and products of tall matrices. All sums run in one order.

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};

use crate::eigenproblem::{EigenProblem, dot};

/// Length of a vector after orthogonalisation, over that before, below which nothing new is left in it.
const DEPENDENT: f64 = 1e-11;

/// A^T B, column-major `[n_a][n_b]`, of column-major A `[n][n_a]` and B `[n][n_b]`.
pub(crate) fn inner_products(n: usize, a: &[f64], n_a: usize, b: &[f64], n_b: usize) -> Vec<f64> {
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
pub(crate) fn linear_combinations(n: usize, a: &[f64], n_a: usize, c: &[f64], n_c: usize) -> Vec<f64> {
    let mut product = vec![0.0; n * n_c];
    add_combinations(n, &mut product, a, n_a, c, n_c, 1.0);
    product
}

/// B += factor A C.
fn add_combinations(n: usize, b: &mut [f64], a: &[f64], n_a: usize, c: &[f64], n_c: usize, factor: f64) {
    matmul(
        MatMut::from_column_major_slice_mut(b, n, n_c),
        Accum::Add,
        MatRef::from_column_major_slice(a, n, n_a),
        MatRef::from_column_major_slice(c, n_a, n_c),
        factor,
        Par::Seq,
    );
}

/// Vectors that are orthonormal in M, column-major `[n][m]`.
pub(crate) struct Basis {
    n: usize,
    vectors: Vec<f64>,
}

/// An orthonormal block Q and what it came from: W = Q R.
pub(crate) struct Block {
    /// Q, column-major `[n][width]`.
    pub vectors: Vec<f64>,
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

    /// Makes the block of `width` vectors orthogonal to the basis by two passes; returns V^T M W of what came in,
    /// column-major `[m][width]`.
    pub fn orthogonalise(&self, problem: &dyn EigenProblem, block: &mut [f64], width: usize) -> Vec<f64> {
        let m = self.len();
        let mut coefficients = vec![0.0; m * width];
        if m == 0 || width == 0 {
            return coefficients;
        }
        for _ in 0..2 {
            let mass = problem.mass(block, width);
            let pass = inner_products(self.n, &self.vectors, m, &mass, width);
            add_combinations(self.n, block, &self.vectors, m, &pass, width, -1.0);
            coefficients.iter_mut().zip(&pass).for_each(|(c, p)| *c += p);
        }
        coefficients
    }

    /// Orthonormal block of a block W that was made orthogonal to the basis; `lengths` are the lengths of its columns
    /// before that. Columns with nothing new in them are left out.
    pub fn orthonormalise(&self, problem: &dyn EigenProblem, mut block: Vec<f64>, lengths: &[f64]) -> Block {
        let first = gram_schmidt(problem, &mut block, lengths);
        let mut vectors = first.vectors;
        // Cancellation has spoiled columns that became short: once more, now at length one.
        self.orthogonalise(problem, &mut vectors, first.width);
        let second = gram_schmidt(problem, &mut vectors, &vec![0.0; first.width]);
        Block {
            vectors: second.vectors,
            ..first
        }
    }
}

/// Gram-Schmidt in M, every column twice against those before it.
fn gram_schmidt(problem: &dyn EigenProblem, block: &mut [f64], lengths: &[f64]) -> Block {
    let (n, n_columns) = (problem.n(), lengths.len());
    let mut mass = problem.mass(block, n_columns);
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
    Block {
        vectors: kept,
        width,
        factor: factor.collect(),
    }
}
