//! Solves of a periodic ring that stay in harmonic space: the predictor of a step, what contacts and partner measure of it,
//! and the increment under their forces. Only nodes that they touch are transformed in between.

use solver::LinearSolver;

use super::effective::CyclicFactor;
use crate::sparse::{SparseLoad, sparse_dot};

impl CyclicFactor {
    /// S^-1 of a generalised load, `[n]`: harmonics of the free nodes, and the rows of the border.
    pub fn solve(&self, load: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let ring = self.solver.inner().ring();
        let (free, border) = load.split_at(ring.n());
        let mut harmonic = vec![0.0; ring.harmonic_len()];
        ring.to_harmonic(free, &mut harmonic);
        let mut border = border.to_vec();
        self.solver.solve_harmonic(&mut [&mut harmonic], &mut border);
        (harmonic, border)
    }

    /// Values of functionals on the touched nodes and the border, and those of the rows of a defect.
    pub fn motions(&self, harmonic: &[f64], border: &[f64], functionals: &[&SparseLoad]) -> [Vec<f64>; 2] {
        let ring = self.solver.inner().ring();
        let mut x = vec![0.0; self.solver.n()];
        let (free, rows) = x.split_at_mut(ring.n());
        ring.from_harmonic_at(&self.touched, harmonic, free);
        rows.copy_from_slice(border);
        let rows = self.defect.iter().flat_map(|defect| defect.rows());
        [
            functionals.iter().map(|g| sparse_dot(g, &x)).collect(),
            rows.map(|&row| x[row]).collect(),
        ]
    }

    /// The predictor, harmonics and border, plus S^-1 of a load on touched nodes and border: coordinates, `[n]`.
    pub fn increment(&self, predictor: (&[f64], &[f64]), mut load: Vec<f64>) -> Vec<f64> {
        let ring = self.solver.inner().ring();
        let (free, border) = load.split_at_mut(ring.n());
        let mut harmonic = vec![0.0; ring.harmonic_len()];
        ring.to_harmonic_from(&self.touched, free, &mut harmonic);
        self.solver.solve_harmonic(&mut [&mut harmonic], border);
        harmonic.iter_mut().zip(predictor.0).for_each(|(d, p)| *d += p);
        border.iter_mut().zip(predictor.1).for_each(|(d, p)| *d += p);
        ring.from_harmonic(&harmonic, free);
        load
    }
}
