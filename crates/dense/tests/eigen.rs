//! Eigenpairs of dense symmetric matrices, and their errors.

mod common;

use common::Numbers;
use dense::{DenseError, symmetric_eigen};

/// Wrong: the projected problem would be solved with wrong values or vectors.
#[test]
fn symmetric_matrices_have_their_eigenpairs() {
    let n = 40;
    let mut numbers = Numbers::new(9);
    let mut a = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            a[n * i + j] = numbers.next();
            a[n * j + i] = a[n * i + j];
        }
    }
    let (values, vectors) = symmetric_eigen(n, &a).unwrap();
    assert!(values.windows(2).all(|pair| pair[0] <= pair[1]));
    for (value, x) in values.iter().zip(vectors.chunks_exact(n)) {
        for i in 0..n {
            let ax: f64 = (0..n).map(|j| a[n * i + j] * x[j]).sum();
            assert!((ax - value * x[i]).abs() < 1e-13, "{ax} {}", value * x[i]);
        }
    }
    a[5] = f64::NAN;
    assert_eq!(symmetric_eigen(n, &a), Err(DenseError::EigenNotFinite));
}

/// Wrong: small entries would cost digits: the thresholds by which the library divides large matrices are absolute. A
/// power of two times the matrix has that times the values and the same vectors, bit for bit.
#[test]
fn the_eigenvectors_of_a_matrix_do_not_depend_on_its_unit() {
    let (n, mut numbers) = (200, Numbers::new(9));
    let a: Vec<f64> = (0..n * n).map(|_| numbers.next()).collect();
    let (values, vectors) = symmetric_eigen(n, &a).unwrap();
    for unit in [(-40f64).exp2(), (-400f64).exp2(), 60f64.exp2()] {
        let scaled: Vec<f64> = a.iter().map(|x| unit * x).collect();
        let (small, same) = symmetric_eigen(n, &scaled).unwrap();
        assert!(vectors == same, "{unit:e}");
        assert!(values.iter().zip(&small).all(|(a, b)| unit * a == *b), "{unit:e}");
    }
    let (values, _) = symmetric_eigen(n, &vec![0.0; n * n]).unwrap();
    assert!(values.iter().all(|x| *x == 0.0));
}
