//! Eigenpairs of dense real matrices that need not be symmetric. Time about 25 n^3, memory 4 n^2.
//!
//! **Equal pairs.** Of values that agree to round-off the vectors of the library lose half their digits. Such a vector
//! is found anew by inverse iteration (Golub and Van Loan, Matrix Computations, 7.6.1), from what of it is across the
//! known vectors of the values that it agrees with. Time 5 n^3 each, memory 8 n^2.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, evd_real, evd_scratch};
use faer::{Mat, MatRef, Par};

use crate::error::DenseError;
use crate::factors::DenseLu;

/// Residual of a vector over the size of the matrix above which it is found anew: round-off leaves 1e-13.
const PRECISE: f64 = 1e-12;
/// Distance from an eigenvalue, over the size of the matrix, at which its vector is iterated, and how often. A vector
/// of another value, a share s of the size away, falls by s / 1e-12 each time.
const SHIFT: f64 = 1e-12;
const ITERATIONS: usize = 4;
/// Difference of two values over the size of the matrix up to which they count as equal.
const EQUAL: f64 = 1e-9;

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
    let size = a.iter().map(|x| x * x).sum::<f64>().sqrt();
    let (mut known, lost): (Vec<_>, Vec<_>) = pairs
        .into_iter()
        .partition(|pair: &ComplexPair| pair.residual(a) <= PRECISE * size);
    for mut pair in lost {
        pair.iterate((a, size), &known);
        known.push(pair);
    }
    Ok(known)
}

impl ComplexPair {
    /// |A v - q v| / |v| with its Rayleigh quotient q, which need not be the value to its last digit.
    fn residual(&self, a: &[f64]) -> f64 {
        let n = self.vector.len();
        let times = |i: usize, part: usize| (0..n).map(|j| a[n * i + j] * self.vector[j][part]).sum();
        let mut left: Vec<ComplexNumber> = (0..n).map(|i| [times(i, 0), times(i, 1)]).collect();
        take_away(&mut left, &self.vector);
        (norm_square(&left) / norm_square(&self.vector)).sqrt()
    }

    /// Finds the vector by inverse iteration, from what of it is across the known ones of equal values. One that
    /// does not become better stays as it was.
    fn iterate(&mut self, (a, size): (&[f64], f64), known: &[ComplexPair]) {
        let n = self.vector.len();
        let [re, im] = [self.value[0] + SHIFT * size, self.value[1]];
        // A complex number x + iy as [x, y]: times a number it is [[re, -im], [im, re]].
        let mut shifted = vec![0.0; 4 * n * n];
        for i in 0..n {
            for part in 0..2 {
                let row = 2 * n * (2 * i + part);
                (0..n).for_each(|j| shifted[row + 2 * j + part] = a[n * i + j]);
                shifted[row + 2 * i + part] -= re;
                shifted[row + 2 * i + 1 - part] = if part == 0 { im } else { -im };
            }
        }
        let Ok(factor) = DenseLu::factor(2 * n, &shifted) else {
            return;
        };
        let mut found = self.clone();
        let distance = |other: &&ComplexPair| (other.value[0] - self.value[0]).hypot(other.value[1] - im);
        for other in known.iter().filter(|other| distance(other) < EQUAL * size) {
            take_away(&mut found.vector, &other.vector);
        }
        for _ in 0..ITERATIONS {
            let scale = norm_square(&found.vector).sqrt().recip();
            let mut flat: Vec<f64> = found.vector.iter().flatten().map(|x| scale * x).collect();
            factor.solve(&mut flat, 1);
            found.vector = flat.as_chunks::<2>().0.to_vec();
        }
        if found.residual(a) < self.residual(a) {
            *self = found;
        }
    }
}

/// Takes away what of a vector is along another one.
fn take_away(vector: &mut [ComplexNumber], other: &[ComplexNumber]) {
    let pairs = vector.iter().zip(other);
    let products = pairs.map(|([x, y], [p, q])| [p * x + q * y, p * y - q * x]);
    let [re, im] = products.fold([0.0; 2], |[a, b], [x, y]| [a + x, b + y]);
    let [re, im] = [re, im].map(|part| part / norm_square(other));
    for ([x, y], [p, q]) in vector.iter_mut().zip(other) {
        *x -= re * p - im * q;
        *y -= re * q + im * p;
    }
}

fn norm_square(vector: &[ComplexNumber]) -> f64 {
    vector.iter().flatten().map(|x| x * x).sum()
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

    /// Wrong: of two equal pairs the second vector would be of neither. Two chains of masses that do not feel each
    /// other, as a first-order inverse; what each pair moves must swing with its frequency.
    #[test]
    fn equal_pairs_have_vectors_of_their_own_motions() {
        let n_masses = 24;
        let n = 2 * n_masses;
        let spring = |i: usize| 1.0 + 40.0 * ((i * 7) % 11) as f64;
        // K^-1 of a chain held at one end: the sum of 1/k up to the nearer mass.
        let give = |i: usize, j: usize| (0..=i.min(j)).map(|k| 1.0 / spring(k)).sum::<f64>();
        let mut a = vec![0.0; 4 * n * n];
        for i in 0..n {
            a[2 * n * (n + i) + i] = 1.0;
            for j in (0..n).filter(|j| j % 2 == i % 2) {
                a[2 * n * i + n + j] = -give(i / 2, j / 2);
            }
        }
        let mut pairs = general_eigen(2 * n, &a).unwrap();
        assert_eq!(pairs.len(), n);
        let size = a.iter().map(|x| x * x).sum::<f64>().sqrt();
        for ComplexPair { value, vector } in &pairs {
            let length = vector.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
            for i in 0..2 * n {
                let times = |part: usize| {
                    (0..2 * n)
                        .map(|j| a[2 * n * i + j] * vector[j][part])
                        .sum::<f64>()
                };
                let [re, im] = vector[i];
                let expected = [value[0] * re - value[1] * im, value[0] * im + value[1] * re];
                for part in 0..2 {
                    let off = (times(part) - expected[part]).abs() / (size * length);
                    assert!(off < 1e-11, "{value:?}: {off:e}");
                }
            }
        }
        // Two vectors of a value are two motions.
        pairs.sort_by(|a, b| a.value[1].total_cmp(&b.value[1]));
        for two in pairs.chunks_exact(2) {
            assert!((two[0].value[1] - two[1].value[1]).abs() < 1e-12 * size);
            let mut other = two[1].clone();
            take_away(&mut other.vector, &two[0].vector);
            let across = norm_square(&other.vector) / norm_square(&two[1].vector);
            assert!(across > 1e-3, "{:?}: {across:e}", two[0].value);
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
