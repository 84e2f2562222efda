//! Products and forms of dense symmetric matrices.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, Mat, MatMut, MatRef, Par};

use crate::error::DenseError;
use crate::factors::{DenseCholesky, check_dense};

/// S = D - D (G^-1 + D)^-1 D, row-major `[n][n]`, of symmetric G and D, G and G^-1 + D positive definite. With
/// G = L L^T it is D - W (1 + L^T W)^-1 W^T, W = D L: no inverse of G. Errors name rows of G. Time 4 n^3.
pub fn update(n: usize, g: &[f64], d: &[f64]) -> Result<Vec<f64>, DenseError> {
    check_dense(n, d)?;
    let lower = DenseCholesky::factor(n, g)?.into_lower();
    let l = Mat::from_fn(n, n, |i, j| if i >= j { lower[(i, j)] } else { 0.0 });
    let d = MatRef::from_row_major_slice(d, n, n);
    let (mut w, mut inner) = (Mat::zeros(n, n), Mat::<f64>::identity(n, n));
    let sum = |c: MatMut<'_, f64>, a: MatRef<'_, f64>, b: MatRef<'_, f64>, by: f64| {
        matmul(c, Accum::Add, a, b, by, Par::Seq);
    };
    sum(w.as_mut(), d, l.as_ref(), 1.0);
    sum(inner.as_mut(), l.transpose(), w.as_ref(), 1.0);
    let inner: Vec<f64> = (0..n * n).map(|ij| inner[(ij / n, ij % n)]).collect();
    let inner = DenseCholesky::factor(n, &inner)?;
    // Columns of (1 + L^T W)^-1 W^T.
    let mut solved: Vec<f64> = (0..n * n).map(|ij| w[(ij / n, ij % n)]).collect();
    inner.solve(&mut solved, n);
    let mut s = d.to_owned();
    sum(
        s.as_mut(),
        w.as_ref(),
        MatRef::from_column_major_slice(&solved, n, n),
        -1.0,
    );
    let symmetric = |ij: usize| 0.5 * (s[(ij / n, ij % n)] + s[(ij % n, ij / n)]);
    Ok((0..n * n).map(symmetric).collect())
}

/// C^T A^-1 C, row-major `[n][n]`, exactly symmetric, of the symmetric positive definite A, row-major `[m][m]`, and
/// C, row-major `[m][n]`. Time m^2 (m/3 + n) + m n^2.
pub fn inverse_form(m: usize, n: usize, a: &[f64], c: &[f64]) -> Result<Vec<f64>, DenseError> {
    assert_eq!(c.len(), m * n, "{m} rows of {n}");
    let lower = DenseCholesky::factor(m, a)?.into_lower();
    let mut w = MatRef::from_row_major_slice(c, m, n).to_owned();
    solve_lower_triangular_in_place(lower.as_ref(), w.as_mut(), Par::Seq);
    let mut form = Mat::<f64>::zeros(n, n);
    matmul(
        form.as_mut(),
        Accum::Replace,
        w.transpose(),
        w.as_ref(),
        1.0,
        Par::Seq,
    );
    let symmetric = |ij: usize| 0.5 * (form[(ij / n, ij % n)] + form[(ij % n, ij / n)]);
    Ok((0..n * n).map(symmetric).collect())
}

/// A X, row-major `[n][width]` as X, of a symmetric A, row-major `[n][n]`.
pub fn symmetric_product(a: &[f64], x: &[f64], width: usize) -> Vec<f64> {
    let n = x.len() / width.max(1);
    assert_eq!(a.len(), n * n, "{n} rows of {width}");
    let mut product = vec![0.0; x.len()];
    // Row-major matrices are the columns of their transposes.
    matmul(
        MatMut::from_column_major_slice_mut(&mut product, width, n),
        Accum::Replace,
        MatRef::from_column_major_slice(x, width, n),
        MatRef::from_column_major_slice(a, n, n),
        1.0,
        Par::Seq,
    );
    product
}

/// X^T A X, row-major `[width][width]`, exactly symmetric, of a symmetric A, row-major `[n][n]`, and X, row-major
/// `[n][width]`.
pub fn symmetric_form(a: &[f64], x: &[f64], width: usize) -> Vec<f64> {
    let (n, product) = (x.len() / width.max(1), symmetric_product(a, x, width));
    let mut form = Mat::<f64>::zeros(width, width);
    matmul(
        form.as_mut(),
        Accum::Replace,
        MatRef::from_column_major_slice(x, width, n),
        MatRef::from_row_major_slice(&product, n, width),
        1.0,
        Par::Seq,
    );
    let symmetric = |ij: usize| 0.5 * (form[(ij / width, ij % width)] + form[(ij % width, ij / width)]);
    (0..width * width).map(symmetric).collect()
}
