//! One flexible ring in statics, factored: its displacement under loads.

use std::sync::Arc;

use ::solver::SparseVector;
use contact::NodalWeights;
use timer::{Laps, Stopwatch};

use super::held::{HeldFactor, make_symmetric};
use super::prepared::{Prepared, StaticSettings};
use super::stiffness::Numbers;
use super::tie::{RingTie, SeatOfRing, SeatResponse};
use crate::error::RingError;
use crate::inventory::Inventory;
use crate::memory::RingMemory;
use crate::model::{Hold, RingModel};
use crate::vectors::dot;

/// Lap: assembly of the stiffness.
pub const ASSEMBLE: &str = "assemble";
/// Lap: ordering, analysis and factorisation.
pub const FACTOR: &str = "factor";

/// Factored stiffness of one ring.
pub struct RingSolver {
    settings: StaticSettings,
    /// The ring without a body, which other rings may share.
    held: Arc<HeldFactor>,
    tie: Option<RingTie>,
    /// The linear solver and why it is that one, for a log.
    note: String,
    /// Wall time of [`ASSEMBLE`] and [`FACTOR`], without that of what others have made.
    pub laps: Laps,
    /// Memory forecast from the analysis, before the factorisation.
    pub memory: RingMemory,
}

impl RingSolver {
    /// Assembles and factors the stiffness of a ring.
    pub fn new(ring: &RingModel, settings: StaticSettings) -> Result<RingSolver, RingError> {
        RingSolver::beside(ring, settings, &[])
    }

    /// The same beside rings that are made: what does not depend on its body it shares with one that is alike.
    /// Collective.
    pub fn beside(
        ring: &RingModel,
        settings: StaticSettings,
        made: &[(&RingModel, &RingSolver)],
    ) -> Result<RingSolver, RingError> {
        let (mut laps, mut clock) = (Laps::default(), Stopwatch::start());
        let is_alike =
            |(of, made): &&(&RingModel, &RingSolver)| made.settings == settings && of.is_like(ring);
        let alike = made.iter().find(is_alike).map(|(_, made)| *made);
        let held = match alike {
            Some(alike) => alike.held.clone(),
            None => {
                let prepared = Prepared::new(ring, settings, Numbers::Assembled)?;
                laps.add(ASSEMBLE, clock.lap());
                Arc::new(HeldFactor::new(ring, settings, prepared)?)
            }
        };
        let (mut tied, mut note) = (None, held.note.clone());
        if let (Some(tie), Some(functions)) = (&ring.tie, ring.seat_functions(settings.name)?) {
            assert!(
                ring.hold == Hold::MeanMotion,
                "a ring on a body is held in its mean motion"
            );
            let known = alike.and_then(|alike| alike.tie.as_ref()?.seat_with(&functions));
            let seat = known.unwrap_or_else(|| Arc::new(SeatOfRing::new(&held, functions)));
            let joint = RingTie::new(seat, ring, tie)?;
            note += &format!(
                "; its {} is tied to a body by {} functions",
                ring.held_group,
                joint.n_functions()
            );
            tied = Some(joint);
        }
        laps.add(FACTOR, clock.lap());
        Ok(RingSolver {
            settings,
            memory: held.memory,
            held,
            tie: tied,
            note,
            laps,
        })
    }

    /// Whether its factor is that of another: one serves both.
    pub fn shares_factor(&self, other: &RingSolver) -> bool {
        Arc::ptr_eq(&self.held, &other.held)
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
            return self.held.solve(loads, n);
        };
        let held = self.held.solve(loads.clone(), n);
        let columns = held
            .chunks_exact(self.held.n_dofs)
            .zip(loads.chunks_exact(self.held.n_dofs));
        let mut couplings: Vec<f64> = columns.flat_map(|(u, f)| tie.coupling(u, f)).collect();
        if let Some(seat) = seat {
            let columns = couplings.chunks_exact_mut(tie.n());
            columns.for_each(|column| column.iter_mut().zip(seat).for_each(|(g, d)| *g -= d));
        }
        let answers = tie.answer(&couplings);
        for (load, answer) in loads
            .chunks_exact_mut(self.held.n_dofs)
            .zip(answers.chunks_exact(tie.n()))
        {
            tie.add_forces(answer, load);
        }
        let mut displacements = self.held.solve(loads, n);
        let columns = displacements.chunks_exact_mut(self.held.n_dofs);
        columns
            .zip(answers.chunks_exact(tie.n()))
            .for_each(|(u, answer)| tie.add_motion(answer, u));
        displacements
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
        let rows = self.held.rows_of(contacts);
        let mut at: Vec<usize> = contacts
            .iter()
            .flat_map(|weights| &weights.nodes)
            .copied()
            .chain(self.tie.iter().flat_map(|tie| tie.nodes().iter().copied()))
            .collect();
        at.sort_unstable();
        at.dedup();
        let mut field = vec![0.0; self.held.n_dofs];
        let mut couplings = Vec::new();
        for first in (0..n).step_by(self.held.block) {
            let numbers = first..n.min(first + self.held.block);
            let loads: Vec<SparseVector> = numbers
                .clone()
                .map(|j| self.held.unit_load(contacts, j))
                .collect();
            let values = self.held.factor.solve_at(&loads, &rows);
            for (r, j) in numbers.clone().enumerate() {
                field.fill(0.0);
                for (&row, values) in rows.iter().zip(values.chunks_exact(numbers.len())) {
                    field[self.held.support.free[row]] = values[r];
                }
                self.held.support.remove_rigid_at(&at, &mut field);
                for (i, weights) in contacts.iter().enumerate() {
                    let motion = weights.measure(&field);
                    compliance[n * (2 * i) + j] = motion[0];
                    compliance[n * (2 * i + 1) + j] = motion[1];
                }
                if let Some(tie) = &self.tie {
                    couplings.extend(tie.coupling(&field, &self.held.force(contacts, j)));
                }
            }
        }
        (compliance, couplings)
    }

    /// Dofs, and the factor.
    pub fn inventory(&self) -> Inventory {
        Inventory {
            dofs: self.held.n_dofs,
            matrices: [&*self.held.factor].len(),
        }
    }

    /// Number of dofs of the ring, held ones included.
    pub fn n_dofs(&self) -> usize {
        self.held.n_dofs
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
