//! The interface of everything that holds a factorisation.

use dense::DenseCholesky;

/// A right-hand side or functional with few entries: row and value, rows distinct.
pub type SparseVector = Vec<(usize, f64)>;

/// A factorisation of a fixed symmetric positive definite matrix S. Making one is the expensive part; a value of
/// this type can only solve, so it may be shared by threads.
pub trait LinearSolver: Send + Sync {
    /// Number of rows n of S.
    fn n(&self) -> usize;

    /// Replaces the right-hand sides by the solutions of S X = B.
    ///
    /// `rhs` is column-major, `[n][n_rhs]` with `rhs[i + n * column]`. The bits of the result depend on S and
    /// `rhs` only: not on earlier or concurrent solves. They may depend on `n_rhs`.
    ///
    /// # Panics
    /// When `rhs.len() != n * n_rhs`.
    fn solve(&self, rhs: &mut [f64], n_rhs: usize);

    /// Values at a few `rows` of the solutions for right-hand sides with few entries, row-major
    /// `[rows.len()][loads.len()]`.
    fn solve_at(&self, loads: &[SparseVector], rows: &[usize]) -> Vec<f64> {
        let n = self.n();
        let mut block = vec![0.0; n * loads.len()];
        for (column, load) in block.chunks_exact_mut(n.max(1)).zip(loads) {
            load.iter().for_each(|&(row, value)| column[row] += value);
        }
        self.solve(&mut block, loads.len());
        let at = |&row: &usize| (0..loads.len()).map(move |r| (row, r));
        rows.iter()
            .flat_map(at)
            .map(|(row, r)| block[n * r + row])
            .collect()
    }

    /// Bytes held by the factor's values.
    fn factor_bytes(&self) -> usize;

    /// Name for logs.
    fn name(&self) -> &'static str;
}

impl LinearSolver for DenseCholesky {
    fn n(&self) -> usize {
        self.n()
    }

    fn solve(&self, rhs: &mut [f64], n_rhs: usize) {
        self.solve(rhs, n_rhs);
    }

    fn factor_bytes(&self) -> usize {
        size_of::<f64>() * self.n() * self.n()
    }

    fn name(&self) -> &'static str {
        "dense Cholesky"
    }
}
