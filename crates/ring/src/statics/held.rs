//! A ring in its hold as no body is tied to it, factored: what rings of one type share, whatever each is tied to.

use ::solver::{LinearSolver, SparseVector};
use body::SeatFunctions;
use contact::NodalWeights;

use super::prepared::{Prepared, StaticSettings};
use crate::error::RingError;
use crate::memory::RingMemory;
use crate::model::RingModel;
use crate::support::AppliedHold;

/// The factored stiffness of a ring that no body is tied to. It does not change.
pub(super) struct HeldFactor {
    pub support: AppliedHold,
    pub factor: Box<dyn LinearSolver>,
    /// Columns that are solved for together.
    pub block: usize,
    /// The linear solver and why it is that one, for a log.
    pub note: String,
    /// Memory forecast from the analysis, before the factorisation.
    pub memory: RingMemory,
    pub n_dofs: usize,
}

impl HeldFactor {
    /// Factors a ring. Collective.
    pub fn new(
        ring: &RingModel,
        settings: StaticSettings,
        Prepared { support, stiffness }: Prepared,
    ) -> Result<HeldFactor, RingError> {
        let (memory, mut note) = (stiffness.memory(), stiffness.note());
        let block = stiffness.block(settings.n_contacts);
        let (factor, iterations) = stiffness.factor(settings.name, ring, &support)?;
        if let Some(iterations) = iterations {
            note.push_str(&iterations_note(iterations));
        }
        Ok(HeldFactor {
            support,
            factor,
            block,
            note,
            memory,
            n_dofs: ring.mesh.n_dofs(),
        })
    }

    /// Elastic displacements relative to the rigid partner, m, column-major `[n_dofs][n]`, under `n` load vectors, N.
    pub fn solve(&self, mut loads: Vec<f64>, n: usize) -> Vec<f64> {
        let n_free = self.support.free.len();
        let mut rhs = Vec::with_capacity(n_free * n);
        for load in loads.chunks_exact_mut(self.n_dofs) {
            self.support.balance(load);
            rhs.extend(self.support.free.iter().map(|&d| load[d]));
        }
        self.factor.solve(&mut rhs, n);
        for (displacement, x) in loads.chunks_exact_mut(self.n_dofs).zip(rhs.chunks_exact(n_free)) {
            displacement.fill(0.0);
            for (&d, &value) in self.support.free.iter().zip(x) {
                displacement[d] = value;
            }
            self.support.remove_rigid(displacement);
        }
        loads
    }

    /// A = Phi^T K_h^-1 Phi of functions of the held surface, m/N, `[n][n]` flat, exactly symmetric.
    pub fn seat_compliance(&self, functions: &SeatFunctions) -> Vec<f64> {
        let n = functions.n();
        let mut compliance = Vec::with_capacity(n * n);
        for first in (0..n).step_by(self.block) {
            let chunk = first..n.min(first + self.block);
            let mut loads = vec![0.0; self.n_dofs * chunk.len()];
            for (function, load) in chunk.clone().zip(loads.chunks_exact_mut(self.n_dofs)) {
                functions.add_unit_load(function, 1.0, load);
            }
            let fields = self.solve(loads, chunk.len());
            compliance.extend(
                fields
                    .chunks_exact(self.n_dofs)
                    .flat_map(|field| functions.measure(field)),
            );
        }
        make_symmetric(n, &mut compliance);
        compliance
    }

    /// A unit force on contact direction j, N, `[n_dofs]`.
    pub fn force(&self, contacts: &[NodalWeights], j: usize) -> Vec<f64> {
        let mut load = vec![0.0; self.n_dofs];
        let unit = if j.is_multiple_of(2) {
            [1.0, 0.0]
        } else {
            [0.0, 1.0]
        };
        contacts[j / 2].add_load(unit, &mut load);
        load
    }

    /// The same, balanced, by rows of the factor.
    pub fn unit_load(&self, contacts: &[NodalWeights], j: usize) -> SparseVector {
        let mut load = self.force(contacts, j);
        self.support.balance_at(&contacts[j / 2].nodes, &mut load);
        let entries = self
            .support
            .free
            .iter()
            .enumerate()
            .map(|(row, &dof)| (row, load[dof]));
        entries.filter(|entry| entry.1 != 0.0).collect()
    }

    /// Rows of the factor that contacts and the mean motion of the held surface measure.
    pub fn rows_of(&self, contacts: &[NodalWeights]) -> Vec<usize> {
        let of_contacts = contacts.iter().flat_map(|weights| &weights.nodes).copied();
        let mut dofs: Vec<usize> = of_contacts
            .chain(self.support.measured_nodes())
            .flat_map(|node| 3 * node..3 * node + 3)
            .collect();
        dofs.sort_unstable();
        dofs.dedup();
        let rows = dofs
            .iter()
            .filter_map(|dof| self.support.free.binary_search(dof).ok());
        rows.collect()
    }
}

/// Takes the mean of mirrored entries.
pub fn make_symmetric(n: usize, matrix: &mut [f64]) {
    for i in 0..n {
        for j in 0..i {
            let mean = 0.5 * (matrix[n * i + j] + matrix[n * j + i]);
            (matrix[n * i + j], matrix[n * j + i]) = (mean, mean);
        }
    }
}

/// What a log says of the iterations of a defect.
pub fn iterations_note(iterations: usize) -> String {
    format!(
        "; conjugate gradients preconditioned by the equal sectors need {iterations} iterations on the defect, solved \
         directly"
    )
}
