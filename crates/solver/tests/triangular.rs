//! The halves of a sparse solve, and forward solutions that stay sparse, against whole solves.

use solver::{LinearSolver, SparseCholesky, SparseVector, Symbolic, TriangularFactor};
use sprs::{CsMat, TriMat};

use crate::common::{Numbers, Ring, assert_close, relative_error};

/// Condition numbers here are below 1e6, so solutions agree to 1e-10 when both are backward stable.
const AGREEMENT: f64 = 1e-10;

fn ring() -> (Ring, CsMat<f64>) {
    let ring = Ring::new(40, 4, 3);
    let matrix = ring.stiffness_with_mass(1e-2);
    (ring, matrix)
}

fn factor(ring: &Ring, matrix: &CsMat<f64>) -> SparseCholesky {
    Symbolic::new(matrix, &ring.order())
        .unwrap()
        .factor(matrix)
        .unwrap()
}

/// Loads on nodes near each other: a few at one azimuth after the other, of one, none and all components.
fn loads(ring: &Ring, n: usize) -> Vec<SparseVector> {
    let mut numbers = Numbers::new(3);
    let n_nodes = ring.points.len();
    let load = |k: usize| {
        let nodes = (0..k % 7).map(|i| (k * n_nodes / n + 3 * i) % n_nodes);
        nodes
            .flat_map(|node| (0..3).map(move |c| 3 * node + c))
            .collect::<Vec<_>>()
    };
    (0..n)
        .map(|k| load(k).into_iter().map(|row| (row, numbers.next())).collect())
        .collect()
}

fn dense_load(load: &SparseVector, n: usize) -> Vec<f64> {
    let mut dense = vec![0.0; n];
    load.iter().for_each(|&(row, value)| dense[row] += value);
    dense
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// If this failed, a step of a ring would end in something other than its solution.
#[test]
fn two_halves_make_the_whole_solve() {
    let (ring, matrix) = ring();
    let n = matrix.rows();
    let whole = factor(&ring, &matrix);
    let halves = TriangularFactor::new(factor(&ring, &matrix));
    assert!(
        halves.bytes() < whole.factor_bytes() + 64 * n,
        "{} bytes",
        halves.bytes()
    );
    let load = Numbers::new(1).vector(n);
    let mut expected = load.clone();
    whole.solve(&mut expected, 1);
    assert_close(&halves.backward(halves.forward(&load)), &expected, AGREEMENT);
    for n_rhs in [0, 1, 3, 11] {
        let rhs = Numbers::new(7 + n_rhs as u64).vector(n * n_rhs);
        let (mut found, mut expected) = (rhs.clone(), rhs);
        halves.solve(&mut found, n_rhs);
        whole.solve(&mut expected, n_rhs);
        if n_rhs > 0 {
            assert_close(&found, &expected, AGREEMENT);
        }
    }
}

/// If this failed, contacts would meet a ring of another compliance, or move it by other forces than their own.
#[test]
fn forward_solutions_give_compliance_motion_and_solution() {
    let (ring, matrix) = ring();
    let n = matrix.rows();
    let whole = factor(&ring, &matrix);
    let halves = TriangularFactor::new(factor(&ring, &matrix));
    // More columns than go through the kernel of few at the top, and fewer.
    for n_loads in [1, 6, 25] {
        let loads = loads(&ring, n_loads);
        let load = Numbers::new(5).vector(n);
        let (z, columns) = halves.forward_with(&load, &loads);
        let solutions: Vec<Vec<f64>> = loads
            .iter()
            .map(|load| {
                let mut x = dense_load(load, n);
                whole.solve(&mut x, 1);
                x
            })
            .collect();
        let pairs = loads
            .iter()
            .flat_map(|a| solutions.iter().map(move |x| dot(&dense_load(a, n), x)));
        let compliance: Vec<f64> = pairs.collect();
        let mut x = load.clone();
        whole.solve(&mut x, 1);
        let motion: Vec<f64> = loads.iter().map(|load| dot(&dense_load(load, n), &x)).collect();
        if n_loads > 1 {
            assert_close(&columns.products(&columns), &compliance, AGREEMENT);
            assert_close(&columns.values(&z), &motion, AGREEMENT);
        }
        let forces = Numbers::new(9).vector(n_loads);
        let mut end = z.clone();
        columns.add_to(&mut end, &forces);
        for (solution, f) in solutions.iter().zip(&forces) {
            x.iter_mut().zip(solution).for_each(|(x, s)| *x += f * s);
        }
        assert_close(&halves.backward(end), &x, AGREEMENT);
        let some = halves.columns(&loads[..n_loads / 2]);
        let cross = some.products(&columns);
        assert_eq!(cross.len(), (n_loads / 2) * n_loads);
        if n_loads > 1 {
            assert_close(&cross, &compliance[..cross.len()], AGREEMENT);
        }
    }
}

/// If this failed, bodies that do not touch, or do not fill a subtree, would be solved wrongly or not at all.
#[test]
fn a_forest_and_a_single_row_are_solved() {
    for n in [1, 2, 30] {
        let mut triplets = TriMat::new((n, n));
        (0..n).for_each(|i| triplets.add_triplet(i, i, 4.0 + i as f64));
        let matrix: CsMat<f64> = triplets.to_csr();
        let order: Vec<usize> = (0..n).rev().collect();
        let halves = TriangularFactor::new(Symbolic::new(&matrix, &order).unwrap().factor(&matrix).unwrap());
        let columns = halves.columns(&[vec![(0, 2.0)], vec![], vec![(n - 1, 3.0)]]);
        let own = columns.products(&columns);
        assert_close(&own[..1], &[1.0], 1e-15);
        assert_eq!(own[4], 0.0, "a load without entries moves nothing");
        assert_close(&own[8..], &[9.0 / (3.0 + n as f64)], 1e-15);
        let x = halves.backward(halves.forward(&vec![1.0; n]));
        let expected: Vec<f64> = (0..n).map(|i| 1.0 / (4.0 + i as f64)).collect();
        assert!(relative_error(&x, &expected) < 1e-15);
    }
}

/// If this failed, results would depend on the number of threads.
#[test]
fn halves_have_the_same_bits_on_any_number_of_threads() {
    let (ring, matrix) = ring();
    let n = matrix.rows();
    let halves = TriangularFactor::new(factor(&ring, &matrix));
    let (load, loads) = (Numbers::new(5).vector(n), loads(&ring, 25));
    let bits = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let (z, columns) = halves.forward_with(&load, &loads);
            let all = [
                columns.products(&columns),
                columns.values(&z),
                z.clone(),
                halves.backward(z),
            ]
            .concat();
            all.iter().map(|x| x.to_bits()).collect::<Vec<_>>()
        })
    };
    let one = bits(1);
    for threads in [2, 3, 8] {
        assert!(bits(threads) == one, "{threads} threads");
    }
}
