//! One step of iterative refinement with the true matrix, and the backward error that says whether it was enough.
//!
//! The backward error of a column is the normwise one of Rigal and Gaches, `|b - A x| / (|A| |x| + |b|)` in the
//! maximum norm (Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed. 2002, theorem 7.1): the smallest
//! relative change of A and b for which x is exact. The plain residual |r|/|b| is no measure where a rigid motion is
//! almost free: |x| is then huge and |r|/|b| stays large however well the system is solved.

use sprs::CsMat;

use crate::linear_solver::LinearSolver;

/// Result of [`solve_refined`].
#[derive(Clone, Debug, PartialEq)]
pub struct Refined {
    /// Solution after one step of refinement, column-major `[n][n_rhs]`.
    pub solution: Vec<f64>,
    /// Largest backward error of the columns before the step.
    pub first_backward_error: f64,
    /// Largest backward error of the columns of `solution`.
    pub backward_error: f64,
}

/// Solves A x = b with a factorisation of A, or of a matrix near A, and one step of refinement. `matrix` is A whole,
/// both triangles; `rhs` is column-major `[n][n_rhs]`. Cost: two solves and two products with A.
///
/// # Panics
/// When sizes disagree.
pub fn solve_refined(solver: &dyn LinearSolver, matrix: &CsMat<f64>, rhs: &[f64], n_rhs: usize) -> Refined {
    let n = solver.n();
    assert_eq!(matrix.shape(), (n, n), "matrix of the factorisation's size");
    assert_eq!(rhs.len(), n * n_rhs, "{n_rhs} right-hand sides of {n} rows");
    let matrix_norm = max_row_sum(matrix);
    let mut solution = rhs.to_vec();
    solver.solve(&mut solution, n_rhs);
    let mut residual = residuals(matrix, &solution, rhs, n);
    let first_backward_error = largest_backward_error(matrix_norm, &solution, rhs, &residual, n);
    solver.solve(&mut residual, n_rhs);
    solution
        .iter_mut()
        .zip(&residual)
        .for_each(|(x, correction)| *x += correction);
    let residual = residuals(matrix, &solution, rhs, n);
    let backward_error = largest_backward_error(matrix_norm, &solution, rhs, &residual, n);
    Refined {
        solution,
        first_backward_error,
        backward_error,
    }
}

/// b - A x of every column. A is symmetric, so its storage may be read by rows whichever it is.
fn residuals(matrix: &CsMat<f64>, solution: &[f64], rhs: &[f64], n: usize) -> Vec<f64> {
    let mut residual = rhs.to_vec();
    if n == 0 {
        return residual;
    }
    for (x, r) in solution.chunks_exact(n).zip(residual.chunks_exact_mut(n)) {
        for (row, r_row) in matrix.outer_iterator().zip(r) {
            *r_row -= row.iter().map(|(column, value)| value * x[column]).sum::<f64>();
        }
    }
    residual
}

fn largest_backward_error(norm: f64, solution: &[f64], rhs: &[f64], residual: &[f64], n: usize) -> f64 {
    if n == 0 {
        return 0.0;
    }
    let columns = solution
        .chunks_exact(n)
        .zip(rhs.chunks_exact(n))
        .zip(residual.chunks_exact(n));
    columns.fold(0.0, |largest, ((x, b), r)| {
        let scale = norm * max_abs(x) + max_abs(b);
        // A NaN must win, so the comparison is written the way round that keeps it.
        let error = if scale == 0.0 { 0.0 } else { max_abs(r) / scale };
        if error <= largest { largest } else { error }
    })
}

/// Largest magnitude; NaN when there is one.
fn max_abs(values: &[f64]) -> f64 {
    values.iter().fold(
        0.0,
        |largest: f64, v| if v.abs() <= largest { largest } else { v.abs() },
    )
}

/// Maximum norm of a symmetric matrix.
fn max_row_sum(matrix: &CsMat<f64>) -> f64 {
    matrix
        .outer_iterator()
        .map(|row| row.data().iter().map(|v| v.abs()).sum::<f64>())
        .fold(0.0, f64::max)
}
