//! Solves of a ring in sectors whose solutions stay by sector: of the columns of contacts and mount, ranks exchange
//! what contacts and mount measure, and of an increment its sum. Memory: one number per dof owned and column.

use solver::{BorderedColumns, SectorBordered};

use crate::sparse::SparseLoad;

/// The factor of one ring in sectors, and the solutions under the mount's functionals.
pub struct SectorFactor {
    /// The factor, with the border of the shaft's dofs.
    pub solver: SectorBordered,
    mount: BorderedColumns,
}

/// A step's predictor, and the increments per unit contact force, by sector.
pub struct StepColumns {
    /// The predictor, and behind it the contacts where they were when it was solved for.
    predictor: BorderedColumns,
    /// The contacts where they are now, if they have moved since.
    moved: Option<BorderedColumns>,
}

/// Motions of contacts and mount under a step's columns.
pub struct Motions {
    /// Under the predictor, `[functionals]`.
    pub predicted: Vec<f64>,
    /// Per unit contact force, row-major `[functionals][n_contacts]`.
    pub by_contacts: Vec<f64>,
}

impl SectorFactor {
    /// Solves for the mount once. Collective, as all here.
    pub fn new(solver: SectorBordered, mount: &[SparseLoad]) -> SectorFactor {
        SectorFactor {
            mount: solver.columns(&[], mount),
            solver,
        }
    }

    /// Compliance of the mount, row-major.
    pub fn mount_compliance(&self, mount: &[SparseLoad]) -> Vec<f64> {
        let all: Vec<&SparseLoad> = mount.iter().collect();
        self.solver.measure(&self.mount, &all)
    }

    /// Predictor under the right-hand side `side`, `[n]`, and columns of the contacts; `all` are the functionals to
    /// measure.
    pub fn prepare(
        &self,
        side: &[f64],
        contacts: &[SparseLoad],
        all: &[&SparseLoad],
    ) -> (StepColumns, Motions) {
        let predictor = self.solver.columns(side, contacts);
        let measured = self.solver.measure(&predictor, all);
        let rows = measured.chunks_exact(1 + contacts.len());
        let motions = Motions {
            predicted: rows.clone().map(|row| row[0]).collect(),
            by_contacts: rows.flat_map(|row| &row[1..]).copied().collect(),
        };
        let moved = None;
        (StepColumns { predictor, moved }, motions)
    }

    /// Columns of contacts that have moved, in place of the former; the predictor stays.
    pub fn move_contacts(
        &self,
        columns: &mut StepColumns,
        contacts: &[SparseLoad],
        all: &[&SparseLoad],
    ) -> Motions {
        columns.moved = None;
        columns.predictor = columns.predictor.first();
        let moved = self.solver.columns(&[], contacts);
        let motions = Motions {
            predicted: self.solver.measure(&columns.predictor, all),
            by_contacts: self.solver.measure(&moved, all),
        };
        columns.moved = Some(moved);
        motions
    }

    /// Adds the solution of a load to a predictor; returns the motions it makes.
    pub fn add_load(&self, columns: &mut StepColumns, load: &[f64], all: &[&SparseLoad]) -> Vec<f64> {
        let more = self.solver.columns(load, &[]);
        columns.predictor.add_to_first(&more);
        self.solver.measure(&more, all)
    }

    /// Predictor and columns under forces on contacts and mount, `[n]`.
    pub fn increment(&self, columns: &StepColumns, contacts: &[f64], mount: &[f64]) -> Vec<f64> {
        let (predictor, mount) = (&columns.predictor, (&self.mount, mount));
        match &columns.moved {
            None => self
                .solver
                .sum(&[(predictor, &[&[1.0], contacts].concat()), mount]),
            Some(moved) => self.solver.sum(&[(predictor, &[1.0]), (moved, contacts), mount]),
        }
    }

    /// Bytes on this rank.
    pub fn bytes(&self) -> usize {
        solver::LinearSolver::factor_bytes(&self.solver) + self.mount.bytes()
    }
}
