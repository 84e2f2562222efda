//! The solution does not depend on the cut, and its bits not on the threads.

use mesh::ElementKind;
use solver::{DenseCholesky, LinearSolver, solve_refined};

use crate::common::{Numbers, dense, relative_error};
use crate::rings::{Held, Problem, irregular, ring};

const KINDS: [ElementKind; 3] = [ElementKind::Hex8, ElementKind::Hex20, ElementKind::Tet10];
/// Sectors of a ring of 16 layers: with 16, no sector of linear elements has an interior.
const SECTORS: [usize; 8] = [1, 2, 3, 4, 5, 7, 12, 16];
/// The condition numbers are 1e3 to 1e6; the solutions differ by what round-off makes of it.
const AGREEMENT: f64 = 1e-12;

/// Wrong: a ring in sectors would be another ring, for some element, hold, mesh or number of sectors.
#[test]
fn sectors_sparse_and_dense_have_the_same_solution() {
    for kind in KINDS {
        for held in [Held::Clamped, Held::Mean, Held::Inertia] {
            for mesh in [ring(kind, 16), irregular(ring(kind, 16))] {
                let problem = Problem::new(mesh, held);
                let load = problem.balanced(Numbers::new(5).vector(problem.free.len()));
                let sparse = solution(&problem, &problem.sparse(), &load);
                let whole = dense(&problem.matrix());
                let reference = DenseCholesky::factor(problem.free.len(), &whole).unwrap();
                let exact = solution(&problem, &reference, &load);
                for n_sectors in SECTORS {
                    let found = solution(&problem, &problem.sectors(n_sectors).unwrap(), &load);
                    for (name, expected) in [("sparse", &sparse), ("dense", &exact)] {
                        let error = relative_error(&found, expected);
                        assert!(
                            error < AGREEMENT,
                            "{kind:?} {held:?} {n_sectors} sectors: differs from {name} by {error:.1e}"
                        );
                    }
                }
            }
        }
    }
}

/// Fixed at six dofs only, a ring is so badly conditioned (1e7) that each solution is refined once.
fn solution(problem: &Problem, solver: &dyn LinearSolver, load: &[f64]) -> Vec<f64> {
    if problem.held == Held::Mean {
        return problem.balanced(solve_refined(solver, &problem.matrix(), load, 1).solution);
    }
    let mut x = load.to_vec();
    solver.solve(&mut x, 1);
    x
}

/// Wrong: many right-hand sides, which have kernels of their own, would have other solutions than each alone.
#[test]
fn many_right_hand_sides_have_the_solutions_of_each() {
    let problem = Problem::new(irregular(ring(ElementKind::Hex20, 12)), Held::Clamped);
    let (solver, n) = (problem.sectors(5).unwrap(), problem.free.len());
    for n_rhs in [0, 1, 2, 3, 36] {
        let mut block = Numbers::new(3).vector(n * n_rhs);
        // A load in few places leaves most panels untouched.
        if let Some(column) = block.chunks_exact_mut(n).nth(1) {
            column[7..].fill(0.0);
        }
        let mut single = block.clone();
        solver.solve(&mut block, n_rhs);
        for (found, column) in block.chunks_exact(n).zip(single.chunks_exact_mut(n)) {
            solver.solve(column, 1);
            assert!(relative_error(found, column) < 1e-13, "{n_rhs} right-hand sides");
        }
    }
}

/// Wrong: a run on another machine or with other settings would end elsewhere.
#[test]
fn bits_do_not_depend_on_the_number_of_threads() {
    let problem = Problem::new(irregular(ring(ElementKind::Hex20, 24)), Held::Inertia);
    let rhs = Numbers::new(9).vector(3 * problem.free.len());
    let solved = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let solver = problem.sectors(7).unwrap();
            let (mut one, mut three) = (rhs[..problem.free.len()].to_vec(), rhs.clone());
            solver.solve(&mut one, 1);
            solver.solve(&mut three, 3);
            let bits = |x: Vec<f64>| x.into_iter().map(f64::to_bits).collect::<Vec<u64>>();
            (bits(one), bits(three))
        })
    };
    let expected = solved(1);
    for threads in [2, 3, 4] {
        assert!(solved(threads) == expected, "{threads} threads");
    }
}

/// Wrong: cutting a ring would cost memory and time, as the cuts are not where the ring's own separators are.
#[test]
fn a_cut_ring_fills_like_the_whole_one() {
    let problem = Problem::new(ring(ElementKind::Hex8, 96), Held::Clamped);
    let whole = problem.sparse().factor_bytes() as f64;
    for n_sectors in [2, 4, 8] {
        let parts = problem.sectors(n_sectors).unwrap().factor_bytes() as f64;
        assert!(
            parts < 1.1 * whole,
            "{n_sectors} sectors: {parts} bytes, whole {whole}"
        );
    }
}

/// Wrong: one sector of a ring that is finer on one side would be most of the work.
#[test]
fn sectors_of_a_refined_ring_have_equal_numbers_of_elements() {
    let problem = Problem::new(irregular(ring(ElementKind::Tet10, 48)), Held::Clamped);
    let symbolic = problem.symbolic(6);
    let costs = symbolic.costs();
    let elements: Vec<usize> = costs.iter().map(|c| c.n_elements).collect();
    let (least, most) = (elements.iter().min().unwrap(), elements.iter().max().unwrap());
    assert!(10 * most < 13 * least, "{elements:?}");
    assert_eq!(elements.iter().sum::<usize>(), problem.mesh.n_elements());
    assert!(costs.iter().all(|c| c.flops > 0.0 && c.factor_bytes > 0));
}
