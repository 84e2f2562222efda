//! Solves of a periodic ring that stay in harmonic space: the predictor of a step, what contacts and partner measure of it,
//! and the increment under their forces. Only nodes that they touch are transformed in between.
//!
//! The predictor is the first half of a solve ([`solver::CyclicRing::ending_with`]), which has the motion of the touched nodes; forces on
//! these come in, and the second half makes the increment. Of a ring with a defect the first half is all.

use solver::LinearSolver;
use solver::cyclic::{Defect, Loose, PartHarmonics};

use super::defect::DefectStep;
use super::effective::CyclicFactor;
use super::space::{Space, from_harmonics, to_harmonics};
use super::vectors::add;
use crate::sparse::SparseLoad;

impl CyclicFactor {
    /// The first half of S^-1 of a generalised load in the space of the ring: harmonics of the free nodes, then the rows of the border, and what
    /// [`solver::cyclic::Loose::take`] says of rows that the regular ring lacks.
    pub fn begin(&self, space: &Space, mut load: Vec<f64>) -> Vec<f64> {
        let mut x = match space {
            Space::Harmonic(_) => load,
            Space::Nodal => {
                let alone = self.loose().map(|loose| loose.take(&mut load));
                let mut x = to_harmonics(self.solver.inner().ring(), &load);
                x.extend(alone.into_iter().flatten());
                x
            }
        };
        self.begin_in_place(&mut x);
        x
    }

    /// The same in place, harmonics and border.
    pub(super) fn begin_in_place(&self, x: &mut [f64]) {
        let (harmonics, border) = self.split(x);
        self.solver.begin_harmonic(harmonics, border);
    }

    /// The increment under loads on touched nodes and border beyond the predictor, in harmonic space.
    pub(super) fn finish(&self, (loads, rows): (PartHarmonics<'_>, Vec<f64>), predictor: &[f64]) -> Vec<f64> {
        let mut x = vec![0.0; predictor.len()];
        let (harmonics, behind) = x.split_at_mut(self.solver.inner().ring().harmonic_len());
        loads.write(harmonics);
        behind.copy_from_slice(&rows);
        let (harmonics, border) = self.split(&mut x);
        self.solver.begin_trailing_harmonic(harmonics, border);
        add(&mut x, predictor);
        self.solver.finish_harmonic(self.split(&mut x).0);
        x
    }

    /// Harmonics and border of a vector.
    fn split<'x>(&self, x: &'x mut [f64]) -> (&'x mut [f64], &'x mut [f64]) {
        let (harmonics, border) = x.split_at_mut(self.solver.inner().ring().harmonic_len());
        let n_border = border.len() - self.loose().map_or(0, Loose::len);
        (harmonics, &mut border[..n_border])
    }

    /// Rows that the regular ring lacks.
    fn loose(&self) -> Option<&Loose> {
        self.defect.as_ref()?.answer.loose()
    }

    /// Values of functionals on raceway, mount and border under harmonics and border `x`.
    pub fn measure(&self, x: &[f64], functionals: &[&SparseLoad]) -> Vec<f64> {
        let ring = self.solver.inner().ring();
        let (harmonics, border) = x.split_at(ring.harmonic_len());
        let rows = functionals.iter().flat_map(|g| g.iter().map(|&(row, _)| row));
        let nodes = rows.filter(|&row| row < ring.n()).map(|row| row / 3);
        let field = ring.field_at_nodes(&self.met, nodes, harmonics);
        let measure = |g: &&SparseLoad| {
            let by_border = |&(row, weight): &(usize, f64)| Some(weight * border[row.checked_sub(ring.n())?]);
            let free = g.iter().copied().filter(|&(row, _)| row < ring.n());
            field.measure(free) + g.iter().filter_map(by_border).sum::<f64>()
        };
        functionals.iter().map(measure).collect()
    }

    /// Values of the rows of a defect under harmonics and border `x`.
    pub fn at_rows(&self, defect: &Defect, x: &[f64]) -> Vec<f64> {
        let ring = self.solver.inner().ring();
        let (harmonics, border) = x.split_at(ring.harmonic_len());
        let free = defect.rows().iter().filter(|&&row| row < ring.n());
        let field = ring.field_at_nodes(&self.touched, free.map(|row| row / 3), harmonics);
        let value = |&row: &usize| match row.checked_sub(ring.n()) {
            Some(k) => border[k],
            None => field.value(row),
        };
        defect.rows().iter().map(value).collect()
    }

    /// Forces of a defect on its rows, index and value, in a step with these forces on contacts and mount.
    pub fn by_defect(&self, step: Option<&DefectStep>, contacts: &[f64], mount: &[f64]) -> Vec<(usize, f64)> {
        match (&self.defect, step) {
            (Some(defect), Some(step)) => step.loads(&defect.answer, &[contacts, mount].concat()),
            _ => Vec::new(),
        }
    }

    /// Loads on touched nodes and border, index and value: harmonics of the nodes, and the rows of the border and of those that the
    /// regular ring lacks.
    pub fn forces(&self, loads: impl Iterator<Item = (usize, f64)>) -> (PartHarmonics<'_>, Vec<f64>) {
        let ring = self.solver.inner().ring();
        let n_loose = self.loose().map_or(0, Loose::len);
        let mut border = vec![0.0; self.solver.n() - ring.n() + n_loose];
        let mut field = ring.no_loads(&self.touched);
        for (row, value) in loads {
            match row.checked_sub(ring.n()) {
                Some(k) => border[k] += value,
                None => field.add(row, value),
            }
        }
        (field.into_harmonics(), border)
    }

    /// S^-1 of what the predictor is the first half of, and of loads on touched nodes and border, index and value: in the space of the
    /// ring.
    pub fn increment(
        &self,
        space: &Space,
        predictor: &[f64],
        loads: impl Iterator<Item = (usize, f64)>,
    ) -> Vec<f64> {
        let ring = self.solver.inner().ring();
        let x = self.finish(self.forces(loads), predictor);
        match space {
            Space::Harmonic(_) => x,
            Space::Nodal => match self.loose() {
                None => from_harmonics(ring, &x),
                Some(loose) => {
                    let (x, alone) = x.split_at(x.len() - loose.len());
                    let mut y = from_harmonics(ring, x);
                    loose.put(alone, &mut y);
                    y
                }
            },
        }
    }
}
