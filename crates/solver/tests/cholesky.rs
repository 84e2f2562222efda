//! The sparse factorisation against dense solutions, and its errors.

use dense::DenseLu;
use solver::{
    LinearSolver, SolverError, SparseCholesky, Symbolic, expand, restrict, restrict_order, solve_refined,
};
use sprs::{CsMat, TriMat};

use crate::common::{Numbers, Ring, assert_close, count_fill, dense, product, shifted};

/// Condition numbers here are below 1e6, so solutions agree to 1e-10 when both are backward stable.
const AGREEMENT: f64 = 1e-10;

fn factor(matrix: &CsMat<f64>, order: &[usize]) -> Result<SparseCholesky, SolverError> {
    Symbolic::new(matrix, order)?.factor(matrix)
}

fn natural(n: usize) -> Vec<usize> {
    (0..n).collect()
}

/// A sparse random matrix, positive definite by a dominant diagonal.
fn random_matrix(n: usize, seed: u64) -> CsMat<f64> {
    let mut numbers = Numbers::new(seed);
    let mut triplets = TriMat::new((n, n));
    for i in 0..n {
        triplets.add_triplet(i, i, 5.0);
        for _ in 0..3 {
            let j = ((numbers.next().abs() * n as f64) as usize).min(n - 1);
            let value = 0.5 * numbers.next();
            if i != j {
                triplets.add_triplet(i, j, value);
                triplets.add_triplet(j, i, value);
            }
        }
        triplets.add_triplet(i, i, 3.0);
    }
    triplets.to_csr()
}

#[track_caller]
fn check_against_dense(matrix: &CsMat<f64>, order: &[usize]) {
    let n = matrix.rows();
    let solver = factor(matrix, order).unwrap();
    let reference = DenseLu::factor(n, &dense(matrix)).unwrap();
    for n_rhs in [0, 1, 3, 36] {
        let rhs = Numbers::new(7 + n_rhs as u64).vector(n * n_rhs);
        let (mut found, mut expected) = (rhs.clone(), rhs);
        solver.solve(&mut found, n_rhs);
        reference.solve(&mut expected, n_rhs);
        if n_rhs > 0 {
            assert_close(&found, &expected, AGREEMENT);
        }
    }
}

/// If this failed, the solver would return something other than the solution.
#[test]
fn random_systems_have_the_dense_solution() {
    for (n, seed) in [(1, 1), (2, 2), (17, 3), (150, 4)] {
        let reversed: Vec<usize> = (0..n).rev().collect();
        check_against_dense(&random_matrix(n, seed), &natural(n));
        check_against_dense(&random_matrix(n, seed), &reversed);
    }
}

/// If this failed, rings in their own elimination order would be solved wrongly.
#[test]
fn a_ring_has_the_dense_solution() {
    let ring = Ring::new(16, 2, 2);
    check_against_dense(&ring.stiffness_with_mass(0.01), &ring.order());
}

/// If this failed, a caller who stores half the matrix, or columns instead of rows, would get another solution.
#[test]
fn the_lower_triangle_by_rows_or_by_columns_is_enough() {
    let ring = Ring::new(8, 2, 1);
    let whole = ring.stiffness_with_mass(0.1);
    let mut triplets = TriMat::new(whole.shape());
    whole
        .iter()
        .filter(|(_, (i, j))| i >= j)
        .for_each(|(&value, (i, j))| triplets.add_triplet(i, j, value));
    let rhs = Numbers::new(5).vector(whole.rows());
    let mut expected = rhs.clone();
    factor(&whole, &ring.order()).unwrap().solve(&mut expected, 1);
    for matrix in [whole.to_csc(), triplets.to_csr(), triplets.to_csc()] {
        let mut found = rhs.clone();
        factor(&matrix, &ring.order()).unwrap().solve(&mut found, 1);
        assert_close(&found, &expected, 1e-13);
    }
}

/// If this failed, clamping would change more than the rows that are taken out.
#[test]
fn a_clamped_ring_is_solved_on_its_free_rows() {
    let ring = Ring::new(12, 2, 2);
    let springs = ring.springs();
    let free: Vec<usize> = (0..ring.n_dofs()).filter(|row| (row / 3) % 3 != 2).collect();
    let matrix = restrict(&springs, &free);
    check_against_dense(&matrix, &restrict_order(&ring.order(), &free));
}

/// If this failed, the memory check before a run would promise what the run does not keep, or forecast the work of
/// another matrix. Bounds: supernodes store their upper corner and some zeros on top of nnz(L).
#[test]
fn forecasts_of_memory_and_work_hold() {
    let ring = Ring::new(40, 4, 3);
    let matrix = ring.stiffness_with_mass(0.1);
    let symbolic = Symbolic::new(&matrix, &ring.order()).unwrap();
    let (entries, flops) = count_fill(&matrix, &ring.order());
    let solver = symbolic.factor(&matrix).unwrap();
    assert_eq!(symbolic.factor_bytes(), solver.factor_bytes());
    let overhead = symbolic.factor_bytes() as f64 / (8 * entries) as f64;
    assert!(
        (1.0..1.5).contains(&overhead),
        "stored bytes are {overhead} of nnz(L)"
    );
    let extra = symbolic.flops() / flops;
    assert!(
        (1.0..1.4).contains(&extra),
        "flops are {extra} of the column count"
    );
    assert!(symbolic.peak_bytes() > symbolic.factor_bytes() + 8 * matrix.nnz() / 2);
}

/// If this failed, postordering would change the factor's fill, for which it must be neutral.
#[test]
fn postordering_keeps_the_fill() {
    let ring = Ring::new(20, 3, 2);
    let matrix = ring.springs();
    let order = ring.order();
    let symbolic = Symbolic::new(&matrix, &order).unwrap();
    assert_ne!(symbolic.order(), order);
    assert_eq!(count_fill(&matrix, symbolic.order()), count_fill(&matrix, &order));
}

/// If this failed, a second step size would be solved with the first one's analysis wrongly, or a matrix of another
/// pattern accepted.
#[test]
fn one_analysis_serves_all_matrices_of_its_pattern_and_no_other() {
    let ring = Ring::new(10, 2, 2);
    let springs = ring.springs();
    let symbolic = Symbolic::new(&springs, &ring.order()).unwrap();
    for mass in [0.1, 10.0] {
        let matrix = shifted(&springs, mass);
        let x = Numbers::new(3).vector(matrix.rows());
        let mut found = product(&matrix, &x);
        symbolic.factor(&matrix).unwrap().solve(&mut found, 1);
        assert_close(&found, &x, AGREEMENT);
    }
    let other = Ring::new(10, 2, 2).springs().to_csc();
    let error = symbolic.factor(&other).unwrap_err();
    assert!(matches!(error, SolverError::PatternChanged { .. }), "{error}");
}

/// If this failed, an unsound matrix would be blamed on another node, or pass as sound.
#[test]
fn an_indefinite_matrix_is_refused_at_the_row_that_spoils_it() {
    let ring = Ring::new(12, 3, 2);
    for row in [0, 100, ring.n_dofs() - 1] {
        let mut matrix = ring.stiffness_with_mass(0.1);
        *matrix.get_mut(row, row).unwrap() = -1.0;
        let error = factor(&matrix, &ring.order()).unwrap_err();
        assert_eq!(
            error,
            SolverError::NotPositiveDefinite {
                row,
                n: ring.n_dofs()
            }
        );
        assert_eq!(error.row(), Some(row));
        assert!(
            error.to_string().contains(&format!("breaks down at row {row};")),
            "{error}"
        );
    }
}

/// If this failed, a ring that nothing holds would be "solved" with displacements that are round-off times 1e16.
#[test]
fn a_free_ring_is_refused_as_singular() {
    for ring in [Ring::new(8, 1, 1), Ring::new(24, 2, 2), Ring::new(60, 5, 3)] {
        for order in [ring.order(), natural(ring.n_dofs())] {
            let error = factor(&ring.springs(), &order).unwrap_err();
            let named = matches!(
                error,
                SolverError::Singular { .. } | SolverError::NotPositiveDefinite { .. }
            );
            assert!(named, "{error}");
            assert!(error.row().is_some_and(|row| row < ring.n_dofs()));
        }
        // The same ring held by nothing but a little mass is sound: the limit leaves four digits of room.
        factor(&ring.stiffness_with_mass(1e-7), &ring.order()).unwrap();
    }
}

/// If this failed, a step that has gone wrong would spread its NaN through both rings.
#[test]
fn entries_that_are_not_finite_are_named() {
    let ring = Ring::new(6, 1, 1);
    for bad in [f64::NAN, f64::INFINITY] {
        let mut matrix = ring.stiffness_with_mass(1.0);
        *matrix.get_mut(4, 3).unwrap() = bad;
        let error = factor(&matrix, &ring.order()).unwrap_err();
        assert!(
            matches!(
                error,
                SolverError::NonFinite {
                    row: 4,
                    column: 3,
                    ..
                }
            ),
            "{error}"
        );
        assert!(
            error
                .to_string()
                .starts_with(&format!("matrix entry (4, 3) is {bad}")),
            "{error}"
        );
    }
}

/// If this failed, a program error would surface inside the factorisation instead of as a sentence.
#[test]
fn shapes_and_orders_that_do_not_fit_are_refused() {
    let wide = CsMat::<f64>::zero((2, 3));
    assert_eq!(
        Symbolic::new(&wide, &[0, 1]).unwrap_err(),
        SolverError::NotSquare { rows: 2, columns: 3 }
    );
    let matrix = random_matrix(3, 1);
    let error = Symbolic::new(&matrix, &[0, 2, 2]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the elimination order has 3 entries for 3 rows and is wrong at position 2; expected every row exactly once"
    );
}

/// If this failed, results would depend on what else runs: same bits are promised for any number of threads.
#[test]
fn repeated_and_concurrent_solves_have_the_same_bits() {
    let ring = Ring::new(30, 3, 2);
    let matrix = ring.stiffness_with_mass(0.01);
    let solvers = [0, 1].map(|_| factor(&matrix, &ring.order()).unwrap());
    let rhs = Numbers::new(11).vector(3 * ring.n_dofs());
    let solve = |solver: &SparseCholesky| {
        let mut x = rhs.clone();
        solver.solve(&mut x, 3);
        x.into_iter().map(f64::to_bits).collect::<Vec<u64>>()
    };
    let expected = solve(&solvers[0]);
    assert_eq!(solve(&solvers[1]), expected);
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(|| solve(&solvers[0]))).collect();
        for thread in threads {
            assert_eq!(thread.join().unwrap(), expected);
        }
    });
}

/// If this failed, a factor of last step's matrix could not be used for this step's. One step multiplies the error
/// by |S^-1 (A - S)| <= 0.01 / 1, so the backward error must fall at least tenfold.
#[test]
fn refinement_reduces_the_backward_error_of_a_nearby_factor() {
    let ring = Ring::new(20, 2, 2);
    let matrix = ring.stiffness_with_mass(1.01);
    let nearby = factor(&ring.stiffness_with_mass(1.0), &ring.order()).unwrap();
    let rhs = Numbers::new(13).vector(2 * ring.n_dofs());
    let refined = solve_refined(&nearby, &matrix, &rhs, 2);
    assert!(
        refined.first_backward_error > 1e-6,
        "{:e}",
        refined.first_backward_error
    );
    assert!(
        refined.backward_error < 0.1 * refined.first_backward_error,
        "{:e}",
        refined.backward_error
    );
    let exact = factor(&matrix, &ring.order()).unwrap();
    let refined = solve_refined(&exact, &matrix, &rhs, 2);
    assert!(
        refined.backward_error < 4.0 * f64::EPSILON,
        "{:e}",
        refined.backward_error
    );
    let mut x = rhs.clone();
    exact.solve(&mut x, 2);
    assert_close(&refined.solution, &x, AGREEMENT);
}

/// If this failed, dofs of one node would be torn apart or a body without rows would crash.
#[test]
fn an_empty_matrix_is_factored_and_solved() {
    let solver = factor(&CsMat::zero((0, 0)), &expand(&[], 3)).unwrap();
    solver.solve(&mut [], 4);
    assert_eq!((solver.n(), solver.factor_bytes()), (0, 0));
}
