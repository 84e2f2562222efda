//! The factor of a periodic ring: the first and second half of a solve in harmonic space, and what contacts and
//! partner measure in between. Only nodes that they touch are transformed.
//!
//! The predictor of a step is the first half of a solve ([`solver::CyclicRing::ending_with`]), which has the motion
//! of the touched nodes; forces on these come in, and the second half makes the increment. Of a ring with a defect
//! the first half is all.

use solver::cyclic::{CyclicBordered, Defect, Loose, PartHarmonics, ResponseTable};
use solver::{LinearSolver, SectionPart};

use super::defect_step::{DefectFactor, DefectStep};
use crate::mount::MountColumns;
use crate::sparse::SparseLoad;
use crate::step::PortForces;
use crate::vectors::add;

/// Harmonics of a periodic ring under S.
pub(crate) struct CyclicFactor {
    /// The factor with the border of the shaft's dofs, if any.
    pub solver: CyclicBordered,
    /// What contacts, partner and defect need of it.
    pub responses: Responses,
    /// Columns of the mount.
    pub mount: MountColumns,
    /// Inverse of the border's compliance where S has one, row-major.
    pub border_inverse: Option<Vec<f64>>,
}

/// Responses of the nodes that are touched.
pub(crate) struct Responses {
    /// Responses of all raceway nodes under S without its border: contacts need no columns.
    pub table: ResponseTable,
    /// Nodes that contacts and partner load and measure.
    pub met: SectionPart,
    /// The same and those that the defect loads.
    pub touched: SectionPart,
    /// The ring's defect, which the factor and the table are without.
    pub defect: Option<DefectFactor>,
}

impl CyclicFactor {
    /// Bytes of the factor and of the table.
    pub fn bytes(&self) -> usize {
        let responses = &self.responses;
        let defect = responses.defect.as_ref().map_or(0, DefectFactor::bytes);
        self.solver.factor_bytes() + responses.table.bytes() + defect
    }

    /// Of a ring with a defect, see [`solver::cyclic::Defect::iterations`].
    pub fn iterations(&self) -> Option<usize> {
        let defect = self.responses.defect.as_ref();
        defect.map(|defect| defect.answer.iterations())
    }

    /// The first half of S^-1 of harmonics and border, in place.
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
    pub(super) fn loose(&self) -> Option<&Loose> {
        self.responses.defect.as_ref()?.answer.loose()
    }

    /// Values of functionals on raceway, mount and border under harmonics and border `x`.
    pub fn measure(&self, x: &[f64], functionals: &[&SparseLoad]) -> Vec<f64> {
        let ring = self.solver.inner().ring();
        let (harmonics, border) = x.split_at(ring.harmonic_len());
        let rows = functionals.iter().flat_map(|g| g.iter().map(|&(row, _)| row));
        let nodes = rows.filter(|&row| row < ring.n()).map(|row| row / 3);
        let field = ring.field_at_nodes(&self.responses.met, nodes, harmonics);
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
        let field = ring.field_at_nodes(&self.responses.touched, free.map(|row| row / 3), harmonics);
        let value = |&row: &usize| match row.checked_sub(ring.n()) {
            Some(k) => border[k],
            None => field.value(row),
        };
        defect.rows().iter().map(value).collect()
    }

    /// Forces of a defect on its rows, index and value, in a step with these forces on contacts and mount.
    pub fn by_defect(&self, step: Option<&DefectStep>, forces: PortForces<'_>) -> Vec<(usize, f64)> {
        match (&self.responses.defect, step) {
            (Some(defect), Some(step)) => {
                step.loads(&defect.answer, &[forces.contacts, forces.mount].concat())
            }
            _ => Vec::new(),
        }
    }

    /// Loads on touched nodes and border, index and value: harmonics of the nodes, and the rows of the border and of
    /// those that the regular ring lacks.
    pub fn forces(&self, loads: impl Iterator<Item = (usize, f64)>) -> (PartHarmonics<'_>, Vec<f64>) {
        let ring = self.solver.inner().ring();
        let n_loose = self.loose().map_or(0, Loose::len);
        let mut border = vec![0.0; self.solver.n() - ring.n() + n_loose];
        let mut field = ring.no_loads(&self.responses.touched);
        for (row, value) in loads {
            match row.checked_sub(ring.n()) {
                Some(k) => border[k] += value,
                None => field.add(row, value),
            }
        }
        (field.into_harmonics(), border)
    }
}
