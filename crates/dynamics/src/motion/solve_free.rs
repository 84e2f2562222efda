//! The forces of one part of a step with free balls.
//!
//! Traction makes the system non-symmetric and stiff: Newton starts from the course that goes on round the axis. Where
//! it stalls, it is led there by creep that is 100 and 10 times softer. A contact whose friction would do work over the
//! part takes the slip of the middle, and the part is solved again: dissipation is never negative.

use std::ops::Range;

use contact::Side;
use timer::SharedLaps;

use super::cage_state::CageSolution;
use super::solve::{StepSolution, policy};
use crate::bearing::{self, BearingParts, CONTACTS, CageParts, FIRST_BALL, FreeParts, SHAFT};
use crate::error::DynamicsError;
use crate::interactions::free_contact::{FoundContact, SlipAt};
use crate::model::Model;
use crate::system::newton::{NewtonSolution, Policy};
use crate::system::{BodyId, System};

/// Factors of the slip of creep that lead a Newton that stalls to the solution.
const SOFTER: [f64; 3] = [100.0, 10.0, 1.0];

impl BearingParts {
    /// Solves a part with free balls; `scale` is the largest force that acts at its start, N.
    pub(super) fn solve_free(
        &mut self,
        model: &Model,
        scale: f64,
        costs: &SharedLaps,
    ) -> Result<StepSolution, DynamicsError> {
        let mut iterations = 0;
        loop {
            let solved = self.with_friction(model, scale, costs)?;
            iterations += solved.iterations;
            let found = self.found_free(&solved.unknowns);
            let cage = self.cage_solution(&solved.unknowns);
            if !self.take_middle(&found, cage.as_ref()) {
                self.roll_over(&found);
                let solution = self.free_solution(model, &solved.unknowns, found, iterations);
                return Ok(StepSolution { cage, ..solution });
            }
        }
    }

    /// Lets contacts whose friction did work over the part take the slip of the middle; whether there are any.
    fn take_middle(&mut self, found: &[FoundContact], cage: Option<&CageSolution>) -> bool {
        let Some(free) = &mut self.free else { return false };
        let mut is_any = false;
        let mut decide = |work: f64, slip_at: &mut SlipAt| {
            if work > 0.0 && *slip_at == SlipAt::End {
                *slip_at = SlipAt::Middle;
                is_any = true;
            }
        };
        for (contact, found) in free.contacts.contacts.iter_mut().zip(found) {
            decide(found.work, &mut contact.slip_at);
        }
        if let (Some(parts), Some(found)) = (&mut free.cage, cage) {
            for (contact, found) in parts.pockets.contacts.iter_mut().zip(&found.pockets) {
                decide(found.friction_work, &mut contact.rubbing.slip_at);
            }
            for (contact, found) in parts.lands.contacts.iter_mut().zip(&found.lands) {
                decide(found.friction_work, &mut contact.rubbing.slip_at);
            }
        }
        is_any
    }

    /// Newton, led by softer creep where it stalls.
    fn with_friction(
        &mut self,
        model: &Model,
        scale: f64,
        costs: &SharedLaps,
    ) -> Result<NewtonSolution, DynamicsError> {
        let scales = self.lengths_per_unknown(model);
        let blocks = self.ball_blocks();
        let policy = Policy {
            blocks: &blocks,
            ends_at_floor: true,
            ..policy(scale, Some(&scales), costs)
        };
        let guess = self.system().guess();
        let stalled = match self.system().solve(guess.clone(), &policy) {
            Err(error @ (DynamicsError::NewtonStalled { .. } | DynamicsError::NotFinite { .. })) => error,
            other => return other,
        };
        let own: Vec<f64> = self.small_slips().map(|slip| *slip).collect();
        let mut solved = Err(stalled);
        let (mut x, mut iterations) = (guess, 0);
        for factor in SOFTER {
            self.small_slips()
                .zip(&own)
                .for_each(|(slip, own)| *slip = factor * own);
            solved = self.system().solve(x.clone(), &policy);
            if let Ok(found) = &solved {
                x.clone_from(&found.unknowns);
                iterations += found.iterations;
            }
        }
        solved.map(|found| NewtonSolution { iterations, ..found })
    }

    /// Unknowns of each ball: balls do not see each other.
    fn ball_blocks(&self) -> Vec<Range<usize>> {
        let system = self.system();
        (0..self.n_balls())
            .map(|ball| system.unknowns(BodyId::Lumped(FIRST_BALL + ball)))
            .collect()
    }

    fn small_slips(&mut self) -> impl Iterator<Item = &mut f64> {
        let contacts = self.free.iter_mut().flat_map(|free| &mut free.contacts.contacts);
        contacts.map(|contact| &mut contact.small_slip)
    }

    /// What makes lengths of all unknowns: rotations of balls at their surface, tilts at the grooves.
    fn lengths_per_unknown(&self, model: &Model) -> Vec<f64> {
        let system = self.system();
        let mut scales = vec![1.0; system.n()];
        let tilts = self.shaft.free().zip(system.unknowns(BodyId::Lumped(SHAFT)));
        for (dof, unknown) in tilts.filter(|(dof, _)| *dof >= 3) {
            scales[unknown] = 1.0 / model.geometry.centre_radius(Side::Inner);
            debug_assert!(dof < 5, "a shaft has five dofs");
        }
        for ball in 0..self.n_balls() {
            let own = system.unknowns(BodyId::Lumped(FIRST_BALL + ball));
            scales[own][3..].fill(2.0 / model.geometry.ball_diameter);
        }
        if self.cage().is_some() {
            let own = system.unknowns(BodyId::Lumped(self.cage_body()));
            scales[own][3..].fill(1.0 / model.geometry.ball_centre().radial);
        }
        scales
    }

    fn cage_body(&self) -> usize {
        CageParts::number(self.n_balls(), self.seat.is_some())
    }

    /// The cage at the solution `x`, if it is free.
    fn cage_solution(&self, x: &[f64]) -> Option<CageSolution> {
        let cage = self.cage()?;
        let system = self.system();
        let lengths = [0, 1].map(|family| system.lengths_at(self.pockets() + family, x));
        let [pockets, lands] = &lengths;
        let pockets = cage.pockets.found(bearing::lengths(pockets));
        let on_lands = cage.lands.found(bearing::lengths(lands));
        let mut solution = CageSolution {
            end: system.coordinates(self.cage_body(), x),
            pockets: pockets.into_iter().map(|(force, _)| force).collect(),
            ..CageSolution::default()
        };
        for (i, (force, resists)) in on_lands.into_iter().enumerate() {
            let [_, end] = bearing::lengths(lands).of(i);
            let [loss, torque] = cage.lands.contacts[i].drag(end);
            (0..5).for_each(|dof| solution.on_shaft[dof] += resists[6 + dof].value);
            solution.drag = [solution.drag[0] + loss, solution.drag[1] + torque];
            solution.lands.push(force);
        }
        Some(solution)
    }

    /// Contacts of free balls at the solution `x`.
    fn found_free(&self, x: &[f64]) -> Vec<FoundContact> {
        let lengths = self.system().lengths_at(CONTACTS, x);
        let found = |free: &FreeParts| free.contacts.found(bearing::lengths(&lengths));
        self.free.as_ref().map_or_else(Vec::new, found)
    }

    fn free_solution(
        &self,
        model: &Model,
        x: &[f64],
        found: Vec<FoundContact>,
        iterations: usize,
    ) -> StepSolution {
        let system: System<'_> = self.system();
        let ends: Vec<[f64; 6]> = (0..self.n_balls())
            .map(|ball| system.coordinates(FIRST_BALL + ball, x))
            .collect();
        let reach = |i: usize| found.iter().flat_map(|found| found.reach[i].to_array()).collect();
        StepSolution {
            shaft: system.coordinates(SHAFT, x),
            balls: self.free_displacements(model, &ends),
            seat: self.seat_end(&system, x),
            reaches: [reach(0), reach(1)],
            forces: found.iter().map(|found| found.normal).collect(),
            mounts: Side::BOTH.map(|side| self.mount(&system, side, x)),
            ports: Side::BOTH.map(|side| {
                let body = self.elastic(side).map(BodyId::Elastic);
                body.map_or_else(Vec::new, |body| x[system.unknowns(body)].to_vec())
            }),
            free_ends: ends,
            free_contacts: found,
            iterations,
            ..StepSolution::default()
        }
    }
}
