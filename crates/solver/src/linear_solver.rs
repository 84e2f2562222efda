//! The interface of everything that holds a factorisation.

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

    /// Bytes held by the factor's values.
    fn factor_bytes(&self) -> usize;

    /// Name for logs.
    fn name(&self) -> &'static str;
}
