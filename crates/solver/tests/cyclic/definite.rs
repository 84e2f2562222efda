//! Whether a shifted stiffness is positive definite, as elimination by harmonics tells.

use dense::DenseCholesky;
use solver::cyclic::{Definite, DefiniteTest};
use solver::{
    LinearSolver, SparseVector, Symbolic, angular_dissection, expand, restrict_lower, restrict_order,
};
use sprs::CsMat;

use super::rings::{Ring, rings, steel};
use crate::common::dense;

/// K - s M of the assembled ring, for any s.
fn assembled(ring: &Ring) -> impl Fn(f64) -> CsMat<f64> {
    let stiffness = ring.assembled(0.0);
    let mass = fem::assemble_mass(&ring.mesh, &steel()).unwrap();
    move |s| {
        let mut matrix = stiffness.clone();
        let entries = matrix.data_mut().iter_mut().zip(mass.data());
        entries.for_each(|(k, m)| *k -= s * m);
        matrix
    }
}

/// Lowest eigenvalue of K x = lambda M x, 1/s^2, to a share of 2e-3, by a factorisation that says whether K - s M is
/// positive definite.
fn lowest(is_positive: impl Fn(f64) -> bool) -> f64 {
    // From 16 Hz to the highest frequency of an element.
    let (mut low, mut high) = (1e4, 1e16_f64);
    assert!(is_positive(low) && !is_positive(high));
    while high > low * (1.0 + 2e-3) {
        let middle = (low * high).sqrt();
        if is_positive(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// The answers to a hundredth below and above an eigenvalue, and far from it.
#[track_caller]
fn assert_answers(test: &DefiniteTest<'_>, ring: &Ring, keep: Option<&[usize]>, lowest: f64, last: Definite) {
    let answer = |factor: f64| {
        let matrix = ring
            .stiffness
            .combined(1.0, -factor * lowest, &ring.mass)
            .unwrap();
        let matrix = keep.map_or(matrix.clone(), |keep| matrix.restricted(keep));
        let answers = [1, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| test.of(&matrix).unwrap())
        });
        assert_eq!(answers[0], answers[1], "threads decide at {factor}");
        answers[0]
    };
    for factor in [1e-3, 0.5, 0.99] {
        assert_eq!(answer(factor), Definite::Yes, "{factor} of {lowest:e}");
    }
    for factor in [1.01, 2.0, 30.0] {
        assert_eq!(answer(factor), Definite::No, "{factor} of {lowest:e}");
    }
    assert_eq!(answer(1e6), last, "a million times {lowest:e}");
}

/// Wrong: a matrix with negative eigenvalues in a harmonic would pass for positive definite, or the reverse, so that a
/// bound of a frequency would not hold. A clamped bore, of all rings: beside the sparse factor of the assembled matrix.
#[test]
fn a_clamped_ring_is_positive_definite_below_its_lowest_eigenvalue() {
    for (ring, _) in rings() {
        let [keep, free] = ring.without_bore();
        let mesh = &ring.mesh;
        let nodes = angular_dissection(&mesh.nodes, &mesh.connectivity, mesh.kind.n_nodes());
        let order = restrict_order(&expand(&nodes, 3), &free);
        let symbolic = Symbolic::new(&restrict_lower(&ring.assembled(0.0), &free), &order).unwrap();
        let assembled = assembled(&ring);
        let sparse = |s: f64| symbolic.factor(&restrict_lower(&assembled(s), &free));
        let restricted = ring
            .ring
            .restricted(&ring.stiffness.restricted(&keep), &keep)
            .unwrap();
        let test = DefiniteTest::new(&restricted, &[]).unwrap();
        let lowest = lowest(|s| sparse(s).is_ok_and(|factor| factor.n() == free.len()));
        assert_answers(&test, &ring, Some(&keep), lowest, Definite::No);
    }
}

/// Wrong: a ring held in the mean motion of its bore would be judged with the springs that hold it for the moment, or
/// with its rigid motions. Beside the matrix of the assembled ring without six dofs, which follow from the others. The
/// oval shape decides, or, of functionals that hardly feel a motion along z or x, harmonics 0 and 1, which have these.
#[test]
fn a_ring_in_its_mean_motion_is_positive_definite_below_its_lowest_eigenvalue() {
    for (ring, _) in &rings()[2..4] {
        let assembled = assembled(ring);
        let mut eigenvalues = Vec::new();
        for hardly in [None, Some(2), Some(0)] {
            let held = mean_motion(ring, hardly);
            let (n, follow) = (ring.mesh.n_dofs(), followers(&held));
            let test = DefiniteTest::new(&ring.ring, &held).unwrap();
            let positive = |s: f64| {
                let (m, reduced) = reduced(n, &dense(&assembled(s)), &held, &follow);
                DenseCholesky::factor(m, &reduced).is_ok()
            };
            let lowest = lowest(positive);
            assert_answers(&test, ring, None, lowest, Definite::No);
            eigenvalues.push(lowest);
        }
        println!("{eigenvalues:?} 1/s^2");
        assert!(eigenvalues[0] > 4.0 * eigenvalues[1] && eigenvalues[0] > 4.0 * eigenvalues[2]);
        // Nothing holds it.
        let free = DefiniteTest::new(&ring.ring, &[]).unwrap();
        let shifted = ring.stiffness.combined(1.0, -1e6, &ring.mass).unwrap();
        assert_eq!(free.of(&shifted).unwrap(), Definite::No);
    }
}

/// Sums over the bore of the displacement along each rigid motion; of one that they feel `hardly` less 0.99 of the mean
/// of all nodes.
fn mean_motion(ring: &Ring, hardly: Option<usize>) -> Vec<SparseVector> {
    let bore = ring.mesh.group_nodes("bore");
    let share = 0.99 * bore.len() as f64 / ring.mesh.n_nodes() as f64;
    let motions = fem::rigid_modes(&ring.mesh, [0.0; 3]);
    let row = |(k, motion): (usize, &Vec<f64>)| {
        let weight = |dof: usize| {
            let all = if hardly == Some(k) { share } else { 0.0 };
            f64::from(u8::from(bore.contains(&(dof / 3)))) - all
        };
        (0..motion.len())
            .map(|dof| (dof, weight(dof) * motion[dof]))
            .collect()
    };
    motions.iter().enumerate().map(row).collect()
}

/// Six dofs, by elimination with complete pivoting, that functionals make follow from the others.
fn followers(held: &[SparseVector]) -> Vec<usize> {
    let mut rows: Vec<Vec<f64>> = held
        .iter()
        .map(|row| row.iter().map(|entry| entry.1).collect())
        .collect();
    let mut chosen = Vec::new();
    for k in 0..rows.len() {
        let largest = |row: &Vec<f64>| {
            let entries = row.iter().enumerate().map(|(i, x)| (x.abs(), i));
            entries.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
        };
        let best = (k..rows.len()).max_by(|&a, &b| largest(&rows[a]).0.total_cmp(&largest(&rows[b]).0));
        rows.swap(k, best.unwrap());
        let pivot = rows[k].clone();
        let place = largest(&pivot).1;
        chosen.push(held[0][place].0);
        for row in &mut rows[k + 1..] {
            let share = row[place] / pivot[place];
            row.iter_mut().zip(&pivot).for_each(|(x, p)| *x -= share * p);
        }
    }
    chosen
}

/// N^T A N where `follow` of u = N v are such that all functionals vanish; its size and its entries.
fn reduced(n: usize, a: &[f64], held: &[SparseVector], follow: &[usize]) -> (usize, Vec<f64>) {
    let of = |row: &SparseVector, dof: usize| {
        row.iter()
            .find(|entry| entry.0 == dof)
            .map_or(0.0, |entry| entry.1)
    };
    let square: Vec<f64> = held
        .iter()
        .flat_map(|row| follow.iter().map(|&dof| of(row, dof)))
        .collect();
    let inverse = dense::DenseLu::factor(follow.len(), &square).unwrap();
    let others: Vec<usize> = (0..n).filter(|dof| !follow.contains(dof)).collect();
    let m = others.len();
    // Columns of N: each of the others, and the followers that it moves.
    let columns: Vec<Vec<(usize, f64)>> = others
        .iter()
        .map(|&dof| {
            let mut moved: Vec<f64> = held.iter().map(|row| -of(row, dof)).collect();
            inverse.solve(&mut moved, 1);
            let moved = follow.iter().copied().zip(moved).filter(|entry| entry.1 != 0.0);
            std::iter::once((dof, 1.0)).chain(moved).collect()
        })
        .collect();
    let work = |x: &[(usize, f64)], y: &[(usize, f64)]| -> f64 {
        let of_row = |&(i, x): &(usize, f64)| y.iter().map(move |&(j, y)| x * a[n * i + j] * y).sum::<f64>();
        x.iter().map(of_row).sum()
    };
    let row = |x: &Vec<(usize, f64)>| columns.iter().map(|y| work(x, y)).collect::<Vec<f64>>();
    (m, columns.iter().flat_map(row).collect())
}
