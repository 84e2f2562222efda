//! A factored matrix with a few dense rows and columns more.
//!
//! `[A B; B^T D] [x; y] = [f; g]` by block elimination: with Z = A^-1 B and the Schur complement C = D - B^T Z,
//! `y = C^-1 (g - Z^T f)`, `x = A^-1 f - Z y` (Golub and Van Loan, *Matrix Computations*, 4th ed. 2013, section 4.2.6).
//!
//! For rigid partners: when held nodes follow m dofs q, w = R q, then B = A_fh R and D = R^T A_hh R, free and held rows
//! being f and h. Cost: m solves once, then 4 n m operations per right-hand side beside the solve; memory n m numbers.

use dense::DenseCholesky;

use crate::error::SolverError;
use crate::linear_solver::LinearSolver;

/// Factor of a bordered symmetric positive definite matrix; the rows of the border come last.
#[derive(Clone, Debug)]
pub struct Bordered<S> {
    inner: S,
    /// A^-1 B, column-major `[n][m]`.
    columns: Vec<f64>,
    schur: DenseCholesky,
}

impl<S: LinearSolver> Bordered<S> {
    /// Borders the matrix A of `inner` with B, column-major `[n][m]`, and the symmetric D, row-major `[m][m]`, of which
    /// the lower triangle counts. Errors name rows of the whole, those of the border from n on.
    ///
    /// # Panics
    /// When the sizes disagree.
    pub fn new(inner: S, border: &[f64], m: usize, corner: &[f64]) -> Result<Bordered<S>, SolverError> {
        let n = inner.n();
        assert_eq!(border.len(), n * m, "a border of {m} columns of {n} rows");
        assert_eq!(corner.len(), m * m, "a corner of {m} rows");
        if let Some(place) = border.iter().position(|x| !x.is_finite()) {
            let (row, column, value) = (place % n, n + place / n, border[place]);
            return Err(SolverError::NonFinite { row, column, value });
        }
        let mut columns = border.to_vec();
        inner.solve(&mut columns, m);
        let mut complement = corner.to_vec();
        for i in 0..m {
            for j in 0..=i {
                complement[m * i + j] -= dot(&border[n * i..n * (i + 1)], &columns[n * j..n * (j + 1)]);
            }
        }
        Ok(Bordered {
            schur: factor_complement(n, &complement, corner)?,
            inner,
            columns,
        })
    }

    /// The factor inside.
    pub fn inner(&self) -> &S {
        &self.inner
    }

    /// A^-1 B, column-major `[n][m]`.
    pub fn columns(&self) -> &[f64] {
        &self.columns
    }

    /// Factor of the Schur complement `D - B^T A^-1 B`, m rows.
    pub fn schur(&self) -> &DenseCholesky {
        &self.schur
    }
}

/// Smallest accepted diagonal entry of the Schur complement relative to that of D: the rest would be round-off.
const SCHUR_LIMIT: f64 = 1e-12;

/// Factor of the Schur complement of a corner `corner`, both row-major, behind n rows.
pub(crate) fn factor_complement(
    n: usize,
    complement: &[f64],
    corner: &[f64],
) -> Result<DenseCholesky, SolverError> {
    let m = corner.len().isqrt();
    for i in 0..m {
        // Written so that NaN is refused as well.
        let is_positive = complement[m * i + i] > SCHUR_LIMIT * corner[m * i + i].abs();
        if !is_positive {
            return Err(SolverError::NotPositiveDefinite { row: n + i, n: n + m });
        }
    }
    let factored = DenseCholesky::factor(m, complement);
    factored.map_err(|error| SolverError::from(error).in_whole(n + m, |row| n + row))
}

impl<S: LinearSolver> LinearSolver for Bordered<S> {
    fn n(&self) -> usize {
        self.inner.n() + self.schur.n()
    }

    fn solve(&self, rhs: &mut [f64], n_rhs: usize) {
        let (n, m) = (self.inner.n(), self.schur.n());
        assert_eq!(
            rhs.len(),
            (n + m) * n_rhs,
            "{n_rhs} right-hand sides of {} rows",
            n + m
        );
        let mut x = Vec::with_capacity(n * n_rhs);
        let mut y = Vec::with_capacity(m * n_rhs);
        for column in rhs.chunks_exact((n + m).max(1)) {
            let (f, g) = column.split_at(n);
            x.extend_from_slice(f);
            y.extend((0..m).map(|i| g[i] - dot(&self.columns[n * i..n * (i + 1)], f)));
        }
        self.inner.solve(&mut x, n_rhs);
        self.schur.solve(&mut y, n_rhs);
        for (r, column) in rhs.chunks_exact_mut((n + m).max(1)).enumerate() {
            let (solution, border) = column.split_at_mut(n);
            solution.copy_from_slice(&x[n * r..n * (r + 1)]);
            border.copy_from_slice(&y[m * r..m * (r + 1)]);
            for (i, &y) in border.iter().enumerate() {
                let z = &self.columns[n * i..n * (i + 1)];
                solution.iter_mut().zip(z).for_each(|(x, z)| *x -= z * y);
            }
        }
    }

    fn factor_bytes(&self) -> usize {
        self.inner.factor_bytes() + self.schur.factor_bytes() + size_of::<f64>() * self.columns.capacity()
    }

    fn name(&self) -> &'static str {
        self.inner.name()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
