//! What the tests share: small meshes, a solver that is not ours, and comparisons that print what they compare.

pub mod grids;

use std::collections::BTreeMap;

use faer::Side;
use faer::linalg::solvers::Solve;
use faer::sparse::{SparseColMat, Triplet};
use fem::Material;
use mesh::Mesh;
use sprs::CsMat;

/// Steel, as in the reference bearing.
pub fn steel() -> Material {
    Material::new(207e9, 0.3, 7800.0).unwrap()
}

/// Fails, with both values, unless `found` is within `tolerance` of `expected`.
#[track_caller]
pub fn assert_close(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = (found - expected).abs();
    assert!(
        error <= tolerance,
        "{what}: found {found:e}, expected {expected:e}, error {error:e} > {tolerance:e}"
    );
}

/// Largest absolute difference of two arrays.
pub fn max_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Largest absolute value of an array.
pub fn max_abs(a: &[f64]) -> f64 {
    a.iter().fold(0.0, |largest, value| largest.max(value.abs()))
}

/// Product of a CSR matrix and a vector.
pub fn multiply(matrix: &CsMat<f64>, x: &[f64]) -> Vec<f64> {
    matrix
        .outer_iterator()
        .map(|row| row.iter().map(|(c, v)| v * x[c]).sum())
        .collect()
}

/// Values of a vector field at the nodes, flat.
pub fn nodal_field(mesh: &Mesh, field: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<f64> {
    mesh.nodes.iter().flat_map(|&x| field(x)).collect()
}

/// All degrees of freedom of the nodes of the named groups with the values of a field.
pub fn clamp(mesh: &Mesh, groups: &[&str], field: impl Fn([f64; 3]) -> [f64; 3]) -> BTreeMap<usize, f64> {
    let mut fixed = BTreeMap::new();
    for node in groups.iter().flat_map(|group| mesh.group_nodes(group)) {
        for (i, value) in field(mesh.nodes[node]).into_iter().enumerate() {
            fixed.insert(3 * node + i, value);
        }
    }
    fixed
}

/// Solves `K u = f` with prescribed values, by faer's sparse Cholesky factorisation.
pub fn solve(k: &CsMat<f64>, load: &[f64], fixed: &BTreeMap<usize, f64>) -> Vec<f64> {
    let free: Vec<usize> = (0..load.len()).filter(|dof| !fixed.contains_key(dof)).collect();
    let place: BTreeMap<usize, usize> = free
        .iter()
        .enumerate()
        .map(|(place, &dof)| (dof, place))
        .collect();
    let mut right = faer::Mat::<f64>::zeros(free.len(), 1);
    let mut entries = Vec::new();
    for (r, &dof) in free.iter().enumerate() {
        right[(r, 0)] = load[dof];
        for (column, &value) in k.outer_view(dof).unwrap().iter() {
            match fixed.get(&column) {
                Some(prescribed) => right[(r, 0)] -= value * prescribed,
                None => entries.push(Triplet::new(r, place[&column], value)),
            }
        }
    }
    let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(free.len(), free.len(), &entries).unwrap();
    let solution = matrix.sp_cholesky(Side::Lower).unwrap().solve(&right);
    let mut u = vec![0.0; load.len()];
    for (&dof, &value) in fixed {
        u[dof] = value;
    }
    for (r, &dof) in free.iter().enumerate() {
        u[dof] = solution[(r, 0)];
    }
    u
}

/// Ascending eigenvalues of a symmetric matrix.
pub fn eigenvalues(matrix: &CsMat<f64>) -> Vec<f64> {
    let mut dense = faer::Mat::<f64>::zeros(matrix.rows(), matrix.cols());
    for (&value, (r, c)) in matrix.iter() {
        dense[(r, c)] = value;
    }
    dense.self_adjoint_eigenvalues(Side::Lower).unwrap()
}

/// Fails unless errors on meshes refined by `ratios` (h coarse over h fine) fall with `order`: not less by more than
/// 0.25 (terms of higher order on coarse meshes), and not so much better that the error measured would be another.
#[track_caller]
pub fn assert_order(errors: &[f64], ratios: &[f64], order: f64, what: &str) {
    for (pair, ratio) in errors.windows(2).zip(ratios) {
        let found = (pair[0] / pair[1]).ln() / ratio.ln();
        println!("{what}: errors {:.3e} {:.3e}, order {found:.2}", pair[0], pair[1]);
        assert!(
            found > order - 0.25,
            "{what}: order {found:.2}, expected {order}; errors {errors:?}"
        );
        assert!(
            found < order + 1.3,
            "{what}: order {found:.2} is too good for {order}; errors {errors:?}"
        );
    }
}
