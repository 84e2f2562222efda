//! One flexible ring in statics, factored: its displacement under loads.

use ::solver::{LinearSolver, SparseVector};
use contact::NodalWeights;
use timer::{Laps, Stopwatch};

use super::prepared::{Prepared, StaticSettings};
use super::stiffness::Numbers;
use crate::error::RingError;
use crate::inventory::Inventory;
use crate::memory::RingMemory;
use crate::model::RingModel;
use crate::support::Support;

/// Lap: assembly of the stiffness.
pub const ASSEMBLE: &str = "assemble";
/// Lap: ordering, analysis and factorisation.
pub const FACTOR: &str = "factor";

/// Factored stiffness of one ring.
pub struct RingSolver {
    support: Support,
    factor: Box<dyn LinearSolver>,
    /// Columns that are solved for together.
    block: usize,
    /// The linear solver and why it is that one, for a log.
    note: String,
    n_dofs: usize,
    /// Wall time of [`ASSEMBLE`] and [`FACTOR`].
    pub laps: Laps,
    /// Memory forecast from the analysis, before the factorisation.
    pub memory: RingMemory,
}

impl RingSolver {
    /// Assembles and factors the stiffness of a ring.
    pub fn new(ring: &RingModel, settings: StaticSettings) -> Result<RingSolver, RingError> {
        let (mut laps, mut clock) = (Laps::default(), Stopwatch::start());
        let prepared = Prepared::new(ring, settings, Numbers::Assembled)?;
        laps.add(ASSEMBLE, clock.lap());
        let Prepared { support, stiffness } = prepared;
        let (memory, mut note) = (stiffness.memory(), stiffness.note());
        let block = stiffness.block(settings.n_contacts);
        let (factor, iterations) = stiffness.factor(settings.name, ring, &support)?;
        if let Some(iterations) = iterations {
            note.push_str(&iterations_note(iterations));
        }
        laps.add(FACTOR, clock.lap());
        Ok(RingSolver {
            n_dofs: ring.mesh.n_dofs(),
            laps,
            memory,
            support,
            factor,
            block,
            note,
        })
    }

    /// The linear solver and why it is that one, for a log.
    pub fn solver_note(&self) -> &str {
        &self.note
    }

    /// Elastic displacements, m, column-major `[n_dofs][n]`, under `n` load vectors (N) of the same layout.
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

    /// Compliance of contacts, m/N, row-major `[2 n][2 n]` over (contact, [radial, axial]): motion of every groove
    /// centre under a unit force at every other. Symmetric to round-off, then made so exactly.
    pub fn compliance(&self, contacts: &[NodalWeights]) -> Vec<f64> {
        let n = 2 * contacts.len();
        let mut compliance = vec![0.0; n * n];
        let rows = self.rows_of(contacts);
        let mut at: Vec<usize> = contacts
            .iter()
            .flat_map(|weights| &weights.nodes)
            .copied()
            .collect();
        at.sort_unstable();
        at.dedup();
        let mut field = vec![0.0; self.n_dofs];
        for first in (0..n).step_by(self.block) {
            let numbers = first..n.min(first + self.block);
            let loads: Vec<SparseVector> = numbers.clone().map(|j| self.unit_load(contacts, j)).collect();
            let values = self.factor.solve_at(&loads, &rows);
            for (r, j) in numbers.clone().enumerate() {
                field.fill(0.0);
                for (&row, values) in rows.iter().zip(values.chunks_exact(numbers.len())) {
                    field[self.support.free[row]] = values[r];
                }
                self.support.remove_rigid_at(&at, &mut field);
                for (i, weights) in contacts.iter().enumerate() {
                    let motion = weights.measure(&field);
                    compliance[n * (2 * i) + j] = motion[0];
                    compliance[n * (2 * i + 1) + j] = motion[1];
                }
            }
        }
        for i in 0..n {
            for j in 0..i {
                let mean = 0.5 * (compliance[n * i + j] + compliance[n * j + i]);
                (compliance[n * i + j], compliance[n * j + i]) = (mean, mean);
            }
        }
        compliance
    }

    /// A unit force on contact direction j, balanced, by rows of the factor.
    fn unit_load(&self, contacts: &[NodalWeights], j: usize) -> SparseVector {
        let mut load = vec![0.0; self.n_dofs];
        let unit = if j.is_multiple_of(2) {
            [1.0, 0.0]
        } else {
            [0.0, 1.0]
        };
        contacts[j / 2].add_load(unit, &mut load);
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
    fn rows_of(&self, contacts: &[NodalWeights]) -> Vec<usize> {
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

    /// Dofs, and the factor.
    pub fn inventory(&self) -> Inventory {
        Inventory {
            dofs: self.n_dofs,
            matrices: [&*self.factor].len(),
        }
    }

    /// Number of dofs of the ring, held ones included.
    pub fn n_dofs(&self) -> usize {
        self.n_dofs
    }
}

/// What a log says of the iterations of a defect.
pub fn iterations_note(iterations: usize) -> String {
    format!(
        "; conjugate gradients preconditioned by the equal sectors need {iterations} iterations on the defect, solved directly"
    )
}
