//! Solves of a ring in sectors that stop half way: until the forces of a step are known, right-hand sides stay swept
//! forwards, by sector. What contacts and mount move are products of them ([`solver::SectorHalves`]).

use solver::{BorderedHalves, SectorBordered};

use super::columns::{Moved, column_compliance};
use crate::sparse::SparseLoad;

/// The factor of one ring in sectors, and the mount's functionals half solved.
pub struct SectorFactor {
    /// The factor, with the border of the shaft's dofs.
    solver: SectorBordered,
    mount: BorderedHalves,
    /// Compliance of the mount, row-major.
    mount_compliance: Vec<f64>,
}

/// A step's predictor and the functionals of its contacts.
pub struct StepHalves {
    predictor: BorderedHalves,
    contacts: BorderedHalves,
}

impl SectorFactor {
    /// Sweeps the mount's functionals once. Collective, as all here.
    pub fn new(solver: SectorBordered, mount: &[SparseLoad]) -> SectorFactor {
        let [_, mount] = solver.halves(&[], mount);
        SectorFactor {
            mount_compliance: mount.products(&mount),
            mount,
            solver,
        }
    }

    /// Predictor under the right-hand side `side`, `[n]`, and contacts.
    pub fn prepare(&self, side: &[f64], contacts: &[SparseLoad]) -> StepHalves {
        let [predictor, contacts] = self.solver.halves(side, contacts);
        StepHalves { predictor, contacts }
    }

    /// What contacts and mount see.
    pub fn moved(&self, halves: &StepHalves) -> Moved {
        let StepHalves { predictor, contacts } = halves;
        let own = contacts.products(contacts);
        let (n, m) = (contacts.n_columns(), self.mount.n_columns());
        let of_mount = contacts.products(&self.mount);
        Moved {
            predicted: self.values(contacts, predictor),
            compliance: column_compliance([n + m, n], &self.mount_compliance, |i, j| match i < n {
                true => own[n * i + j],
                false => of_mount[m * j + i - n],
            }),
        }
    }

    /// Values at contacts and mount of the solutions of right-hand sides.
    fn values(&self, contacts: &BorderedHalves, of: &BorderedHalves) -> Vec<f64> {
        [contacts.products(of), self.mount.products(of)].concat()
    }

    /// Contacts elsewhere; the predictor stays.
    pub fn move_contacts(&self, halves: &mut StepHalves, contacts: &[SparseLoad]) {
        [_, halves.contacts] = self.solver.halves(&[], contacts);
    }

    /// Adds a load, `[n]`, to a predictor; returns what contacts and mount move more.
    pub fn add_load(&self, halves: &mut StepHalves, load: &[f64]) -> Vec<f64> {
        let [more, _] = self.solver.halves(load, &[]);
        halves.predictor.add(&more);
        self.values(&halves.contacts, &more)
    }

    /// Predictor and contacts under forces on contacts and mount, `[n]`.
    pub fn increment(&self, halves: &StepHalves, contacts: &[f64], mount: &[f64]) -> Vec<f64> {
        self.solver.finish(&[
            (&halves.predictor, &[1.0]),
            (&halves.contacts, contacts),
            (&self.mount, mount),
        ])
    }

    /// Bytes on this rank.
    pub fn bytes(&self) -> usize {
        solver::LinearSolver::factor_bytes(&self.solver) + self.mount.bytes()
    }
}
