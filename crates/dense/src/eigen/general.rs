//! Eigenpairs of dense real matrices that need not be symmetric. Time about 25 n^3, memory 4 n^2.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, evd_real, evd_scratch};
use faer::{Mat, MatRef, Par};

use crate::error::DenseError;

/// A complex number: real and imaginary part.
pub type ComplexNumber = [f64; 2];

/// An eigenvalue and its vector.
#[derive(Clone, Debug, PartialEq)]
pub struct ComplexPair {
    /// Eigenvalue.
    pub value: ComplexNumber,
    /// Vector, `[n]`, of no particular length.
    pub vector: Vec<ComplexNumber>,
}

/// Eigenpairs of `a`, row-major `[n][n]`; of a conjugate pair the one with the positive imaginary part.
///
/// # Panics
/// When `a.len() != n * n`.
pub fn general_eigen(n: usize, a: &[f64]) -> Result<Vec<ComplexPair>, DenseError> {
    assert_eq!(a.len(), n * n, "a dense matrix of {n} rows");
    if n == 0 {
        return Ok(Vec::new());
    }
    if !a.iter().all(|x| x.is_finite()) {
        return Err(DenseError::EigenNotFinite);
    }
    let (mut real, mut imaginary) = (Diag::<f64>::zeros(n), Diag::<f64>::zeros(n));
    let mut vectors = Mat::<f64>::zeros(n, n);
    let request = evd_scratch::<f64>(
        n,
        ComputeEigenvectors::No,
        ComputeEigenvectors::Yes,
        Par::Seq,
        Default::default(),
    );
    evd_real(
        MatRef::from_row_major_slice(a, n, n),
        real.as_mut(),
        imaginary.as_mut(),
        None,
        Some(vectors.as_mut()),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(request)),
        Default::default(),
    )
    .map_err(|_| DenseError::EigenNotConverged { n })?;
    let mut pairs = Vec::new();
    let mut i = 0;
    while i < n {
        // A conjugate pair stands in two columns: real part, imaginary part of the vector of the first.
        let is_pair = imaginary[i] != 0.0;
        let sign = if imaginary[i] < 0.0 { -1.0 } else { 1.0 };
        let part = |row: usize| {
            let other = if is_pair { vectors[(row, i + 1)] } else { 0.0 };
            [vectors[(row, i)], sign * other]
        };
        pairs.push(ComplexPair {
            value: [real[i], imaginary[i].abs()],
            vector: (0..n).map(part).collect(),
        });
        i += if is_pair { 2 } else { 1 };
    }
    Ok(pairs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: values and vectors would not belong to the matrix, or parts of a pair would be mixed up. Residuals of a
    /// matrix without symmetry, with real values and pairs among its own.
    #[test]
    fn pairs_satisfy_the_matrix() {
        let n = 9;
        let a: Vec<f64> = (0..n * n)
            .map(|k| ((k * k * 7 + 3 * k) % 23) as f64 - 11.0)
            .collect();
        let pairs = general_eigen(n, &a).unwrap();
        let of_value = |pair: &ComplexPair| if pair.value[1] > 0.0 { 2 } else { 1 };
        assert_eq!(pairs.iter().map(of_value).sum::<usize>(), n);
        assert!(pairs.iter().any(|p| p.value[1] > 0.0) && pairs.iter().any(|p| p.value[1] == 0.0));
        for ComplexPair { value, vector } in &pairs {
            let size = vector.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
            for i in 0..n {
                let times = |part: usize| (0..n).map(|j| a[n * i + j] * vector[j][part]).sum::<f64>();
                let [re, im] = vector[i];
                let expected = [value[0] * re - value[1] * im, value[0] * im + value[1] * re];
                for part in 0..2 {
                    assert!((times(part) - expected[part]).abs() < 1e-11 * size, "{value:?}");
                }
            }
        }
    }

    /// Wrong: a damped oscillator would not ring down as it does: x'' + 2 z w x' + w^2 x = 0.
    #[test]
    fn a_damped_oscillator_has_its_closed_form() {
        let (w, z) = (3.0f64, 0.1f64);
        let pairs = general_eigen(2, &[0.0, 1.0, -w * w, -2.0 * z * w]).unwrap();
        assert_eq!(pairs.len(), 1);
        let expected = [-z * w, w * (1.0 - z * z).sqrt()];
        (0..2).for_each(|i| assert!((pairs[0].value[i] - expected[i]).abs() < 1e-14));
    }
}
