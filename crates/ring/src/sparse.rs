//! Products with sparse matrices, each row summed by one thread in its own order: the same bits on any number of
//! threads.

use mesh::Mesh;
use rayon::prelude::*;
use sprs::CsMat;

/// A functional or generalised load with few entries: index and value, indices distinct.
pub type SparseLoad = solver::SparseVector;

/// Rows per task: below, splitting costs more than it gains.
const ROWS: usize = 2048;

/// A x.
pub fn product(a: &CsMat<f64>, x: &[f64]) -> Vec<f64> {
    let (starts, columns, values) = (a.indptr(), a.indices(), a.data());
    let starts = starts.raw_storage();
    (0..a.rows())
        .into_par_iter()
        .with_min_len(ROWS)
        .map(|i| {
            let range = starts[i]..starts[i + 1];
            columns[range.clone()]
                .iter()
                .zip(&values[range])
                .map(|(&j, v)| v * x[j])
                .sum()
        })
        .collect()
}

/// (m x identity) x for nodal vectors `[n_nodes][3]` flat: every entry of `m` serves three components.
pub fn node_product(m: &CsMat<f64>, x: &[f64]) -> Vec<f64> {
    let (starts, columns, values) = (m.indptr(), m.indices(), m.data());
    let starts = starts.raw_storage();
    let rows: Vec<[f64; 3]> = (0..m.rows())
        .into_par_iter()
        .with_min_len(ROWS)
        .map(|i| {
            let mut sum = [0.0; 3];
            for k in starts[i]..starts[i + 1] {
                let (value, at) = (values[k], 3 * columns[k]);
                (0..3).for_each(|c| sum[c] += value * x[at + c]);
            }
            sum
        })
        .collect();
    rows.concat()
}

/// m x identity(3): the mass matrix of all nodal dofs.
pub fn kronecker(m: &CsMat<f64>) -> CsMat<f64> {
    let n = 3 * m.rows();
    let (mut starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    for row in m.outer_iterator() {
        for c in 0..3 {
            for (j, value) in row.iter() {
                columns.push(3 * j + c);
                values.push(*value);
            }
            starts.push(columns.len());
        }
    }
    CsMat::new((n, n), starts, columns, values)
}

/// Value of a functional.
pub fn sparse_dot(load: &SparseLoad, x: &[f64]) -> f64 {
    load.iter().map(|&(i, value)| value * x[i]).sum()
}

/// Elimination order of the free dofs of a ring (nodal dofs, ascending).
pub(crate) fn elimination_order(mesh: &Mesh, free: &[usize]) -> Vec<usize> {
    let nodes = solver::angular_dissection(&mesh.nodes, &mesh.connectivity, mesh.kind.n_nodes());
    solver::restrict_order(&solver::expand(&nodes, 3), free)
}

/// Writes sparse loads into zeroed columns.
pub(crate) fn fill(columns: &mut [f64], loads: &[SparseLoad], n: usize) {
    for (column, load) in columns.chunks_exact_mut(n).zip(loads) {
        load.iter().for_each(|&(i, value)| column[i] = value);
    }
}
