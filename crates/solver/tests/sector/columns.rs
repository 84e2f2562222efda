//! Interfaces of many sectors, and solutions that stay by sector.

use mesh::ElementKind;
use solver::{Bordered, LinearSolver, SectorBordered, SparseVector, solve_refined};

use super::rings::{Held, Problem, irregular, ring};
use crate::common::{Numbers, relative_error};

/// From 16 sectors on the interface is reduced cyclically: powers of two, odd numbers at several levels, and, with 48
/// sectors of linear elements, sectors without an inside.
const MANY: [usize; 6] = [16, 17, 19, 23, 32, 48];

/// Wrong: an interface that is divided among ranks would be another than that of the ring.
#[test]
fn interfaces_of_many_sectors_solve_the_ring() {
    for (kind, held) in [
        (ElementKind::Hex8, Held::Inertia),
        (ElementKind::Hex20, Held::Clamped),
        (ElementKind::Hex8, Held::Mean),
    ] {
        for mesh in [ring(kind, 48), irregular(ring(kind, 48))] {
            let problem = Problem::new(mesh, held);
            let load = problem.balanced(Numbers::new(5).vector(problem.free.len()));
            let solve = |solver: &dyn LinearSolver| {
                let refined = solve_refined(solver, &problem.matrix(), &load, 1);
                problem.balanced(refined.solution)
            };
            let expected = solve(&problem.sparse());
            for n_sectors in MANY {
                let error = relative_error(&solve(&problem.sectors(n_sectors).unwrap()), &expected);
                assert!(
                    error < 1e-12,
                    "{kind:?} {held:?} {n_sectors} sectors: {error:.1e}"
                );
            }
        }
    }
}

/// Wrong: bits would depend on the number of threads where the interface is reduced.
#[test]
fn bits_of_many_sectors_do_not_depend_on_threads() {
    let problem = Problem::new(irregular(ring(ElementKind::Hex20, 24)), Held::Inertia);
    let rhs = Numbers::new(9).vector(3 * problem.free.len());
    let solved = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let mut x = rhs.clone();
            problem.sectors(16).unwrap().solve(&mut x, 3);
            x.into_iter().map(f64::to_bits).collect::<Vec<u64>>()
        })
    };
    let expected = solved(1);
    assert!([2, 3].into_iter().all(|threads| solved(threads) == expected));
}

/// Wrong: a ring that nothing holds would get a solution of round-off instead of an error that names a row.
#[test]
fn a_ring_without_hold_is_refused_by_a_reduced_interface() {
    let mut problem = Problem::new(ring(ElementKind::Hex8, 32), Held::Clamped);
    problem.free = (0..problem.mesh.n_dofs()).collect();
    let error = problem.sectors(16).unwrap_err();
    assert!(error.row().is_some_and(|row| row < problem.free.len()), "{error}");
}

/// Loads with few entries, in every sector and on interfaces.
fn sparse_loads(n: usize, count: usize) -> Vec<SparseVector> {
    let mut numbers = Numbers::new(21);
    (0..count)
        .map(|r| {
            (r..n)
                .step_by(n / 11 + r)
                .map(|row| (row, numbers.next()))
                .collect()
        })
        .collect()
}

/// Wrong: contact columns would differ from solutions of the whole ring, or values of one row be taken for those of
/// another.
#[test]
fn columns_left_by_sector_are_the_solutions() {
    let problem = Problem::new(irregular(ring(ElementKind::Hex20, 24)), Held::Inertia);
    let n = problem.free.len();
    let (dense, loads) = (Numbers::new(3).vector(n), sparse_loads(n, 5));
    let mut block = dense.clone();
    block.resize(6 * n, 0.0);
    for (column, load) in block[n..].chunks_exact_mut(n).zip(&loads) {
        load.iter().for_each(|&(row, value)| column[row] = value);
    }
    let rows: Vec<usize> = (0..n).rev().step_by(7).collect();
    let factors = [0.5, -2.0, 0.0, 1.0, 3.0, -1.0];
    for n_sectors in [1, 5, 16] {
        let solver = problem.sectors(n_sectors).unwrap();
        let mut expected = block.clone();
        solver.solve(&mut expected, 6);
        let columns = solver.columns(&dense, &loads);
        let values = columns.values_at(&rows);
        for (r, expected) in expected.chunks_exact(n).enumerate() {
            let found: Vec<f64> = values.chunks_exact(6).map(|v| v[r]).collect();
            let expected: Vec<f64> = rows.iter().map(|&row| expected[row]).collect();
            assert_eq!(found, expected, "{n_sectors} sectors, column {r}");
        }
        let sum: Vec<f64> = (0..n)
            .map(|i| (0..6).map(|r| factors[r] * expected[n * r + i]).sum())
            .collect();
        let [of_dense, of_loads] = solver.halves(&dense, &loads);
        let found = solver.finish(&[(&of_dense, &factors[..1]), (&of_loads, &factors[1..])]);
        assert!(relative_error(&found, &sum) < 1e-13, "{n_sectors} sectors");
        let measured = |load: &SparseVector| -> Vec<f64> {
            let of = |column: &[f64]| load.iter().map(|&(row, value)| value * column[row]).sum();
            expected.chunks_exact(n).map(of).collect()
        };
        let measured: Vec<Vec<f64>> = loads.iter().map(measured).collect();
        let (first, rest) = (of_loads.products(&of_dense), of_loads.products(&of_loads));
        let found = first
            .iter()
            .zip(rest.chunks_exact(5))
            .map(|(x, row)| [&[*x], row].concat());
        let found: Vec<f64> = found.flatten().collect();
        assert!(
            relative_error(&found, &measured.concat()) < 1e-12,
            "{n_sectors} sectors"
        );
        let at: Vec<f64> = solver.solve_at(&loads, &rows);
        let whole = problem.sparse().solve_at(&loads, &rows);
        assert!(relative_error(&at, &whole) < 1e-12, "{n_sectors} sectors");
    }
}

/// Wrong: a ring whose partner adds no dofs could not be solved.
#[test]
fn a_border_may_be_empty() {
    let problem = Problem::new(ring(ElementKind::Hex8, 24), Held::Inertia);
    let load = Numbers::new(8).vector(problem.free.len());
    let solver = SectorBordered::new(problem.sectors(5).unwrap(), Vec::new(), &[]).unwrap();
    let (mut found, mut expected) = (load.clone(), load);
    solver.solve(&mut found, 1);
    problem.sectors(5).unwrap().solve(&mut expected, 1);
    assert_eq!(found, expected);
    let [none, one] = solver.halves(&[], &[vec![(0, 1.0)]]);
    assert!(one.products(&none).is_empty());
    assert_eq!(solver.finish(&[(&none, &[])]), vec![0.0; found.len()]);
}

/// Wrong: a bore in sectors would not follow its shaft as that of a whole ring does.
#[test]
fn a_border_in_sectors_is_that_of_the_whole_ring() {
    let problem = Problem::new(ring(ElementKind::Hex20, 24), Held::Inertia);
    let (n, m) = (problem.free.len(), 3);
    let border: Vec<SparseVector> = sparse_loads(n, m)
        .into_iter()
        .map(|column| {
            column
                .into_iter()
                .map(|(row, value)| (row, 1e6 * value))
                .collect()
        })
        .collect();
    let mut dense = vec![0.0; n * m];
    for (column, entries) in dense.chunks_exact_mut(n).zip(&border) {
        entries.iter().for_each(|&(row, value)| column[row] = value);
    }
    let corner: Vec<f64> = (0..m * m)
        .map(|i| if i % (m + 1) == 0 { 1e10 } else { 1e8 })
        .collect();
    let whole = Bordered::new(problem.sparse(), &dense, m, &corner).unwrap();
    let load = Numbers::new(8).vector(n + m);
    let mut expected = load.clone();
    whole.solve(&mut expected, 1);
    let functionals = [
        vec![(3, 1.0), (n / 2, -2.0), (n + 1, 0.5)],
        vec![(n + m - 1, 1.0)],
        vec![],
    ];
    let sparse = functionals[0].clone();
    for n_sectors in [5, 16] {
        let solver =
            SectorBordered::new(problem.sectors(n_sectors).unwrap(), border.clone(), &corner).unwrap();
        let mut found = load.clone();
        solver.solve(&mut found, 1);
        assert!(relative_error(&found, &expected) < 1e-11, "{n_sectors} sectors");
        let [of_load, of_sparse] = solver.halves(&load, std::slice::from_ref(&sparse));
        let of = |x: &[f64], f: &SparseVector| f.iter().map(|&(i, v)| v * x[i]).sum::<f64>();
        for f in &functionals {
            let [_, half] = solver.halves(&[], std::slice::from_ref(f));
            let error = (half.products(&of_load)[0] - of(&expected, f)).abs();
            assert!(
                error <= 1e-11 * expected[n..].iter().fold(1e-12, |m: f64, x| m.max(x.abs())),
                "{error:e}"
            );
            // A functional measures under a load what that measures under the functional.
            let [there, back] = [half.products(&of_sparse)[0], of_sparse.products(&half)[0]];
            assert!((there - back).abs() <= 1e-11 * there.abs().max(1e-16));
        }
        let [mut twice, _] = solver.halves(&load, &[]);
        twice.add(&of_load);
        let doubled: Vec<f64> = expected.iter().map(|x| 2.0 * x).collect();
        assert!(relative_error(&solver.finish(&[(&twice, &[1.0])]), &doubled) < 1e-11);
    }
}
