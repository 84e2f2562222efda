//! Lowest eigenpairs against closed forms and the dense method.

use std::f64::consts::PI;

use crate::common::{Numbers, product};
use dense::{DenseError, EigenProblem, Eigenpairs, LanczosSettings, dense_lowest, lanczos, lowest_pairs};
use solver::{LinearSolver, SparseCholesky, Symbolic};
use sprs::{CsMat, TriMat};

/// Sparse matrices with a factor of K + s M.
struct Sparse {
    k: CsMat<f64>,
    m: CsMat<f64>,
    shift: f64,
    factor: SparseCholesky,
}

impl Sparse {
    fn new(k: CsMat<f64>, m: CsMat<f64>, shift: f64) -> Sparse {
        let shifted = &k + &m.map(|x| shift * x);
        let order: Vec<usize> = (0..k.rows()).collect();
        let factor = Symbolic::new(&shifted, &order).unwrap().factor(&shifted).unwrap();
        Sparse { k, m, shift, factor }
    }
}

fn columns(matrix: &CsMat<f64>, x: &[f64]) -> Vec<f64> {
    x.chunks_exact(matrix.rows())
        .flat_map(|x| product(matrix, x))
        .collect()
}

impl EigenProblem for Sparse {
    fn n(&self) -> usize {
        self.k.rows()
    }

    fn shift(&self) -> f64 {
        self.shift
    }

    fn stiffness(&self, x: &[f64], _: usize) -> Vec<f64> {
        columns(&self.k, x)
    }

    fn mass(&self, x: &[f64], _: usize) -> Vec<f64> {
        columns(&self.m, x)
    }

    fn solve(&self, mut b: Vec<f64>, n_vectors: usize) -> Vec<f64> {
        self.factor.solve(&mut b, n_vectors);
        b
    }
}

/// Masses 1 and springs 1 between neighbours of `copies` separate rows of n; row ends are fixed, or joined to a ring.
fn chains(copies: usize, n: usize, is_ring: bool, shift: f64) -> Sparse {
    let (mut k, mut m) = (
        TriMat::new((copies * n, copies * n)),
        TriMat::new((copies * n, copies * n)),
    );
    for copy in 0..copies {
        for i in 0..n {
            let row = copy * n + i;
            k.add_triplet(row, row, 2.0);
            m.add_triplet(row, row, 1.0);
            if i + 1 < n || is_ring {
                let other = copy * n + (i + 1) % n;
                k.add_triplet(row, other, -1.0);
                k.add_triplet(other, row, -1.0);
            }
        }
    }
    Sparse::new(k.to_csr(), m.to_csr(), shift)
}

/// Eigenvalues of a row of n masses with fixed ends: 4 sin^2(k pi / (2 (n + 1))), k = 1, 2, ...
fn fixed(n: usize, k: usize) -> f64 {
    4.0 * (k as f64 * PI / (2.0 * (n as f64 + 1.0))).sin().powi(2)
}

/// Eigenvalues of a ring of n masses: 0, then 4 sin^2(k pi / n) twice each.
fn ring(n: usize, i: usize) -> f64 {
    4.0 * (i.div_ceil(2) as f64 * PI / n as f64).sin().powi(2)
}

fn search(problem: &dyn EigenProblem, n_pairs: usize, block: usize) -> Eigenpairs {
    lanczos(problem, LanczosSettings::new(n_pairs, block), &mut |_| ()).unwrap()
}

#[track_caller]
fn assert_values(found: &Eigenpairs, shift: f64, tolerance: f64, expected: impl Fn(usize) -> f64) {
    for (i, value) in found.values.iter().enumerate() {
        let error = (value - expected(i)).abs() / (expected(i) + shift);
        assert!(
            error < tolerance,
            "{i}: {value:e}, expected {:e}, error {error:.1e}",
            expected(i)
        );
    }
}

/// Wrong: natural frequencies would not be those of the body. A row of masses and springs (Rayleigh, Theory of Sound,
/// section 120); round-off of K x is 1e-16 |K| / lambda = 4e-12 here.
#[test]
fn a_row_of_springs_has_its_closed_frequencies() {
    let n = 1000;
    let problem = chains(1, n, false, 1e-5);
    let pairs = search(&problem, 12, 3);
    assert_eq!(pairs.values.len(), 12);
    assert_values(&pairs, 1e-5, 1e-10, |i| fixed(n, i + 1));
    // Shapes are sines.
    for (i, x) in pairs.vectors.chunks_exact(n).enumerate() {
        let sine = |j: usize| ((i + 1) as f64 * (j + 1) as f64 * PI / (n as f64 + 1.0)).sin();
        let scale = (2.0 / (n as f64 + 1.0)).sqrt() * x[0].signum();
        let error = (0..n).map(|j| (x[j] - scale * sine(j)).abs()).fold(0.0, f64::max);
        assert!(error < 1e-8, "{i}: {error:e}");
    }
}

/// Wrong: rings would show one of two equal modes, or the rigid motion would make the factorisation fail or come out
/// with a frequency.
#[test]
fn a_free_ring_has_one_rigid_motion_and_double_modes() {
    let n = 1000;
    let shift = 1e-5;
    let problem = chains(1, n, true, shift);
    let pairs = search(&problem, 11, 3);
    assert_values(&pairs, shift, 1e-10, |i| ring(n, i));
    assert!(
        pairs.values[0].abs() < 1e-10 * pairs.values[1],
        "{}",
        pairs.values[0]
    );
    for i in 0..11 {
        for j in 0..=i {
            let (a, b) = (
                &pairs.vectors[n * i..n * (i + 1)],
                &pairs.vectors[n * j..n * (j + 1)],
            );
            let product: f64 = a.iter().zip(b).map(|(x, y)| x * y).sum();
            let expected = if i == j { 1.0 } else { 0.0 };
            assert!((product - expected).abs() < 1e-11, "{i} {j}: {product:e}");
        }
    }
}

/// Wrong: eigenvalues of higher multiplicity than the block would be reported once or twice, and later ones taken in
/// their place. Six equal rows, a block of two: only the search in the complement finds the others.
#[test]
fn multiplicities_above_the_block_are_found() {
    let n = 120;
    let problem = chains(6, n, false, 1e-3);
    let pairs = search(&problem, 18, 2);
    assert_values(&pairs, 1e-3, 1e-10, |i| fixed(n, i / 6 + 1));
}

/// Wrong: Lanczos would miss or invent pairs of general matrices, of dofs without mass, or of a space that ends.
#[test]
fn lanczos_agrees_with_the_dense_method_also_without_mass() {
    let n = 160;
    let mut numbers = Numbers::new(3);
    let (mut k, mut m) = (TriMat::new((n, n)), TriMat::new((n, n)));
    for i in 0..n {
        k.add_triplet(i, i, 3.0 + numbers.next());
        // Every fifth dof has no mass.
        m.add_triplet(i, i, if i % 5 == 0 { 0.0 } else { 2.0 + numbers.next() });
        for distance in [1, 7] {
            if i + distance < n {
                let value = 0.7 * numbers.next();
                k.add_triplet(i, i + distance, value);
                k.add_triplet(i + distance, i, value);
            }
        }
    }
    let problem = Sparse::new(k.to_csr(), m.to_csr(), 0.5);
    let dense = dense_lowest(&problem, n).unwrap();
    assert_eq!(dense.values.len(), n - n / 5, "finite eigenvalues");
    for (n_pairs, block) in [(20, 4), (1, 1), (128, 7)] {
        let pairs = search(&problem, n_pairs, block);
        assert_eq!(pairs.values.len(), n_pairs);
        assert_values(&pairs, 0.5, 1e-11, |i| dense.values[i]);
    }
}

/// Wrong: an error bound would be exceeded by the error it bounds. Loose tolerance, so that errors are no round-off.
#[test]
fn bounds_hold() {
    let n = 2000;
    let problem = chains(1, n, false, 1e-3);
    let settings = LanczosSettings {
        tolerance: 1e-2,
        ..LanczosSettings::new(6, 1)
    };
    let pairs = lanczos(&problem, settings, &mut |_| ()).unwrap();
    let mut largest = 0.0f64;
    for (i, (value, bound)) in pairs.values.iter().zip(&pairs.bounds).enumerate() {
        let error = (value - fixed(n, i + 1)).abs();
        assert!(error <= bound + 1e-14, "{i}: error {error:e}, bound {bound:e}");
        largest = largest.max(*bound);
    }
    assert!(largest > 1e-9, "the bounds test nothing: {largest:e}");
    let exact = search(&problem, 6, 3);
    for (bound, value) in exact.bounds.iter().zip(&exact.values) {
        assert!(*bound < 1e-8 * (value + 1e-3), "{bound:e}");
    }
    assert!(exact.residuals.iter().all(|r| *r < 1e-6), "{:?}", exact.residuals);
}

/// Wrong: a search that fails would give numbers instead of an error.
#[test]
fn a_search_that_ends_early_says_so() {
    let problem = chains(1, 1000, false, 1e-3);
    let settings = LanczosSettings {
        max_steps: 3,
        ..LanczosSettings::new(10, 2)
    };
    let error = lowest_pairs(&problem, settings, &mut |_| ()).unwrap_err();
    let DenseError::SearchNotConverged {
        wanted: 10, steps: 3, ..
    } = error
    else {
        panic!("{error}");
    };
    assert!(
        error
            .to_string()
            .contains("of 10 eigenpairs have converged after 3 blocks"),
        "{error}"
    );
}

/// Wrong: a search that must restart would lose what it has found when lambda is large, as in metres and kilograms:
/// 90 pairs of a row of springs with omega^2 up to 1e15.
#[test]
fn restarts_keep_what_was_found_in_any_unit() {
    let stiff = 4e14;
    let soft = chains(1, 2000, false, 1e-3);
    let problem = Sparse::new(soft.k.map(|x| stiff * x), soft.m.clone(), stiff * 1e-3);
    let pairs = lanczos(&problem, LanczosSettings::new(90, 2), &mut |_| ()).unwrap();
    println!("{} steps", pairs.steps);
    assert!(pairs.steps < 150, "{}", pairs.steps);
    for (i, value) in pairs.values.iter().enumerate() {
        let expected = stiff * fixed(2000, i + 1);
        assert!(
            (value / expected - 1.0).abs() < 1e-9,
            "{i}: {value:e} {expected:e}"
        );
    }
}
