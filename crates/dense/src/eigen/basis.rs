//! A basis that is orthonormal in the inner product of M, and products of tall matrices. All sums run in one order.

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};

use super::problem::{EigenProblem, dot};

/// Length of a vector after orthogonalisation, over that before, below which nothing new is left in it.
const DEPENDENT: f64 = 1e-11;

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

    /// Makes a block W orthogonal to the basis by two passes and orthonormal. Also returns V^T M W of what came in,
    /// column-major `[m][width]`. Columns with nothing new in them are left out.
    pub fn orthonormalise(
        &self,
        problem: &dyn EigenProblem,
        mut w: Vec<f64>,
        width: usize,
    ) -> (OrthonormalBlock, Vec<f64>) {
        let (n, m) = (self.n, self.len());
        let mut coefficients = vec![0.0; m * width];
        let mut mass = problem.mass(&w, width);
        let columns = w.chunks_exact(n).zip(mass.chunks_exact(n));
        let lengths: Vec<f64> = columns.map(|(x, mx)| dot(x, mx).max(0.0).sqrt()).collect();
        for _ in 0..2 {
            let pass = self.subtract_projection(&mut w, &mass, width);
            coefficients.iter_mut().zip(&pass).for_each(|(c, p)| *c += p);
            mass = problem.mass(&w, width);
        }
        let first = gram_schmidt(n, w, mass, &lengths);
        let mut vectors = first.vectors;
        // Cancellation has spoiled columns that became short: once more, now at length one.
        self.subtract_projection(&mut vectors, &first.mass, first.width);
        let mass = problem.mass(&vectors, first.width);
        let second = gram_schmidt(n, vectors, mass, &vec![0.0; first.width]);
        let block = OrthonormalBlock {
            factor: first.factor,
            ..second
        };
        (block, coefficients)
    }

    /// W -= V C with C = V^T (M W), which is returned.
    fn subtract_projection(&self, w: &mut [f64], mass: &[f64], width: usize) -> Vec<f64> {
        let m = self.len();
        if m == 0 || width == 0 {
            return vec![0.0; m * width];
        }
        let coefficients = inner_products(self.n, &self.vectors, m, mass, width);
        add_combinations(self.n, w, &self.vectors, m, &coefficients, width, -1.0);
        coefficients
    }
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
