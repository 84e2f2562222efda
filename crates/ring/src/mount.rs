//! Columns of a ring's mount: what unit forces of the partner move.

use solver::LinearSolver;

use crate::sparse::{SparseLoad, fill, sparse_dot};

/// S^-1 times the functionals of the mount.
pub(crate) struct MountColumns {
    /// Column-major `[n][n_mount]`.
    pub columns: Vec<f64>,
    /// Their values at the functionals, row-major.
    pub compliance: Vec<f64>,
}

impl MountColumns {
    /// Those of a factor of n rows.
    pub fn new(factor: &dyn LinearSolver, mount: &[SparseLoad], n: usize) -> MountColumns {
        let m = mount.len();
        let mut columns = vec![0.0; n * m];
        fill(&mut columns, mount, n);
        factor.solve(&mut columns, m);
        let entry = |k: usize| sparse_dot(&mount[k / m], &columns[n * (k % m)..n * (k % m + 1)]);
        MountColumns {
            compliance: (0..m * m).map(entry).collect(),
            columns,
        }
    }
}
