//! The solution does not depend on the cut, and its bits not on the threads.

use dense::DenseCholesky;
use mesh::ElementKind;
use solver::{LinearSolver, solve_refined};

use super::refined::refined;
use super::rings::{Held, Problem, irregular, ring};
use crate::common::{Numbers, dense, relative_error};

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

/// Wrong: ranks would wait for the one whose sectors lie where a ring is finer, with more nodes in each
/// cross-section: of equal numbers of elements, the largest factor would be 1.74 times the mean.
#[test]
fn sectors_of_a_refined_ring_have_near_equal_work() {
    let place = [0.02, 0.0, 0.008];
    let away = |x: [f64; 3]| (0..3).map(|c| (x[c] - place[c]).powi(2)).sum::<f64>().sqrt();
    let mesh = refined(&ring(ElementKind::Tet10, 96), |x| 0.0015 + 0.3 * away(x));
    let problem = Problem::new(mesh, Held::Clamped);
    let costs = problem.symbolic(8).costs();
    let bytes: Vec<usize> = costs.iter().map(|c| c.factor_bytes).collect();
    let (most, sum) = (*bytes.iter().max().unwrap(), bytes.iter().sum::<usize>());
    assert!(8 * 4 * most < 5 * sum, "more than 1.25 times the mean: {bytes:?}");
    let elements: Vec<usize> = costs.iter().map(|c| c.n_elements).collect();
    assert_eq!(elements.iter().sum::<usize>(), problem.mesh.n_elements());
    assert!(
        2 * elements.iter().min().unwrap() < *elements.iter().max().unwrap(),
        "{elements:?}"
    );
    assert!(costs.iter().all(|c| c.flops > 0.0));
}

/// Wrong: round-off, which decides the order of elements of one azimuth, would move the cuts of a ring whose layers
/// are alike.
#[test]
fn sectors_of_a_ring_of_equal_layers_are_equal() {
    for (kind, layers, n_sectors) in [
        (ElementKind::Hex8, 90, 6),
        (ElementKind::Hex8, 91, 7),
        (ElementKind::Hex20, 48, 16),
        (ElementKind::Tet10, 40, 5),
    ] {
        let problem = Problem::new(ring(kind, layers), Held::Inertia);
        let layout = problem.layout(n_sectors);
        let elements: Vec<usize> = layout.sectors().iter().map(|s| s.elements.len()).collect();
        let equal = problem.mesh.n_elements() / n_sectors;
        assert!(elements.iter().all(|&n| n == equal), "{kind:?}: {elements:?}");
    }
}
