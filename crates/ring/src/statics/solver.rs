//! One flexible ring in statics, factored: its displacement under loads.

use ::solver::{LinearSolver, SparseVector};
use body::SeatFunctions;
use contact::NodalWeights;
use timer::{Laps, Stopwatch};

use super::prepared::{Prepared, StaticSettings};
use super::stiffness::Numbers;
use super::tie::{RingTie, SeatResponse};
use crate::error::RingError;
use crate::inventory::Inventory;
use crate::memory::RingMemory;
use crate::model::{Hold, RingModel};
use crate::support::AppliedHold;
use crate::vectors::dot;

/// Lap: assembly of the stiffness.
pub const ASSEMBLE: &str = "assemble";
/// Lap: ordering, analysis and factorisation.
pub const FACTOR: &str = "factor";

/// Factored stiffness of one ring.
pub struct RingSolver {
    support: AppliedHold,
    factor: Box<dyn LinearSolver>,
    /// Columns that are solved for together.
    block: usize,
    /// The linear solver and why it is that one, for a log.
    note: String,
    n_dofs: usize,
    tie: Option<RingTie>,
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
        let mut solver = RingSolver {
            n_dofs: ring.mesh.n_dofs(),
            laps,
            memory,
            support,
            factor,
            block,
            note,
            tie: None,
        };
        if let (Some(tie), Some(functions)) = (&ring.tie, ring.seat_functions(settings.name)?) {
            assert!(
                ring.hold == Hold::MeanMotion,
                "a ring on a body is held in its mean motion"
            );
            let tied = RingTie::new(solver.seat_compliance(&functions), ring, functions, tie)?;
            solver.note += &format!(
                "; its {} is tied to a body by {} functions",
                ring.held_group,
                tied.n_functions()
            );
            solver.tie = Some(tied);
        }
        solver.laps.add(FACTOR, clock.lap());
        Ok(solver)
    }

    /// The linear solver and why it is that one, for a log.
    pub fn solver_note(&self) -> &str {
        &self.note
    }

    /// Bytes of the joint with a body; 0 without one.
    pub fn tie_bytes(&self) -> usize {
        self.tie.as_ref().map_or(0, RingTie::bytes)
    }

    /// Elastic displacements, m, column-major `[n_dofs][n]`, under `n` load vectors (N) of the same layout: relative to
    /// the rigid partner, or to what holds the body to which the ring is tied.
    pub fn solve(&self, loads: Vec<f64>, n: usize) -> Vec<f64> {
        self.solve_on(loads, n, None)
    }

    /// The same where others move the seat of the body, by functions, m.
    pub fn solve_on(&self, mut loads: Vec<f64>, n: usize, seat: Option<&[f64]>) -> Vec<f64> {
        let Some(tie) = &self.tie else {
            return self.solve_held(loads, n);
        };
        let held = self.solve_held(loads.clone(), n);
        let columns = held
            .chunks_exact(self.n_dofs)
            .zip(loads.chunks_exact(self.n_dofs));
        let mut couplings: Vec<f64> = columns.flat_map(|(u, f)| tie.coupling(u, f)).collect();
        if let Some(seat) = seat {
            let columns = couplings.chunks_exact_mut(tie.n());
            columns.for_each(|column| column.iter_mut().zip(seat).for_each(|(g, d)| *g -= d));
        }
        let answers = tie.answer(&couplings);
        for (load, answer) in loads
            .chunks_exact_mut(self.n_dofs)
            .zip(answers.chunks_exact(tie.n()))
        {
            tie.add_forces(answer, load);
        }
        let mut displacements = self.solve_held(loads, n);
        let columns = displacements.chunks_exact_mut(self.n_dofs);
        columns
            .zip(answers.chunks_exact(tie.n()))
            .for_each(|(u, answer)| tie.add_motion(answer, u));
        displacements
    }

    /// A = Phi^T K_h^-1 Phi of functions of the held surface, m/N, `[n][n]` flat, exactly symmetric.
    fn seat_compliance(&self, functions: &SeatFunctions) -> Vec<f64> {
        let n = functions.n();
        let mut compliance = Vec::with_capacity(n * n);
        for first in (0..n).step_by(self.block) {
            let chunk = first..n.min(first + self.block);
            let mut loads = vec![0.0; self.n_dofs * chunk.len()];
            for (function, load) in chunk.clone().zip(loads.chunks_exact_mut(self.n_dofs)) {
                functions.add_unit_load(function, 1.0, load);
            }
            let fields = self.solve_held(loads, chunk.len());
            compliance.extend(
                fields
                    .chunks_exact(self.n_dofs)
                    .flat_map(|field| functions.measure(field)),
            );
        }
        make_symmetric(n, &mut compliance);
        compliance
    }

    /// The same as [`Self::solve`] of a ring that no body is tied to.
    fn solve_held(&self, mut loads: Vec<f64>, n: usize) -> Vec<f64> {
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
        let (mut compliance, couplings) = self.held_compliance(contacts);
        if let Some(tie) = &self.tie {
            add_body(tie, &couplings, &mut compliance);
        }
        make_symmetric(2 * contacts.len(), &mut compliance);
        compliance
    }

    /// What the contacts and the forces of the body do when others move the seat; None where no body is tied to the
    /// ring. Cost: as [`Self::compliance`].
    pub fn seat_response(&self, contacts: &[NodalWeights]) -> Option<SeatResponse> {
        let tie = self.tie.as_ref()?;
        let (_, couplings) = self.held_compliance(contacts);
        Some(tie.response(&couplings))
    }

    /// Compliance of contacts on the ring that no body is tied to, and their couplings with one, `[2 n][tie.n()]`.
    fn held_compliance(&self, contacts: &[NodalWeights]) -> (Vec<f64>, Vec<f64>) {
        let n = 2 * contacts.len();
        let mut compliance = vec![0.0; n * n];
        let rows = self.rows_of(contacts);
        let mut at: Vec<usize> = contacts
            .iter()
            .flat_map(|weights| &weights.nodes)
            .copied()
            .chain(self.tie.iter().flat_map(|tie| tie.nodes().iter().copied()))
            .collect();
        at.sort_unstable();
        at.dedup();
        let mut field = vec![0.0; self.n_dofs];
        let mut couplings = Vec::new();
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
                if let Some(tie) = &self.tie {
                    couplings.extend(tie.coupling(&field, &self.force(contacts, j)));
                }
            }
        }
        (compliance, couplings)
    }

    /// A unit force on contact direction j, N, `[n_dofs]`.
    fn force(&self, contacts: &[NodalWeights], j: usize) -> Vec<f64> {
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
    fn unit_load(&self, contacts: &[NodalWeights], j: usize) -> SparseVector {
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

/// What the body adds to the compliance of contacts with these couplings, `[n][tie.n()]`.
fn add_body(tie: &RingTie, couplings: &[f64], compliance: &mut [f64]) {
    let n = couplings.len() / tie.n();
    let answers = tie.answer(couplings);
    for (i, coupling) in couplings.chunks_exact(tie.n()).enumerate() {
        for (j, answer) in answers.chunks_exact(tie.n()).enumerate() {
            compliance[n * i + j] += dot(coupling, answer);
        }
    }
}

/// Takes the mean of mirrored entries.
fn make_symmetric(n: usize, matrix: &mut [f64]) {
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
