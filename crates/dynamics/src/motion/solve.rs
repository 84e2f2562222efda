//! The forces of one part of a step: bodies and contacts of the bearing over it, solved, and what cannot be a solution.
//!
//! Unknowns are the displacements at the end of the part. Residuals are forces: inertia and loads of balls and shaft at
//! the weighted time, and for every flexible ring what it asks for at its ports.

use contact::{Meridian, Side};
use timer::SharedLaps;

use super::cage_state::CageSolution;
use crate::bearing::{BearingParts, CONTACTS, FIRST_BALL, SHAFT, lengths};
use crate::bodies::AXES;
use crate::error::DynamicsError;
use crate::footprint::require_in_groove;
use crate::interactions::discrete_gradient::MeanForce;
use crate::interactions::free_contact::FoundContact;
use crate::interactions::raceway_contact::SiteState;
use crate::model::{MAX_TILT, Model};
use crate::system::System;
use crate::system::newton::{KeptTangent, Policy, RoundOff, Shortening};

/// Newton iterations before a step counts as failed.
const MOST_ITERATIONS: usize = 40;
/// Residual over the force scale at which iteration may stop; it goes on while it improves.
const RESIDUAL_LIMIT: f64 = 1e-9;
/// Halvings of a Newton step: to below 1e-3.
const HALVINGS: u32 = 10;

/// Solution of a part.
#[derive(Default)]
pub struct StepSolution {
    /// Shaft at the end, m and rad.
    pub shaft: [f64; 5],
    /// Balls at the end, m.
    pub balls: Vec<Meridian>,
    /// The seat of the outer ring along z at the end, m; 0 unless it slides.
    pub seat: f64,
    /// l of every contact at start and end, `[2 n_sites]`, m.
    pub(super) reaches: [Vec<f64>; 2],
    /// Mean forces, by site, without the dead ones.
    pub forces: Vec<MeanForce>,
    /// Forces that the contacts ask of the shaft, but for those that its ring hands on, N and N m.
    pub on_shaft: [f64; 5],
    /// Forces of the partners on the mounts of inner and outer ring, in the ring's frame.
    pub mounts: [Vec<f64>; 2],
    /// Motion of the ports of contacts of free balls on inner and outer ring at the end, m.
    pub ports: [Vec<f64>; 2],
    /// Displacement and rotation of free balls over the part, m and rad.
    pub free_ends: Vec<[f64; 6]>,
    /// Contacts of free balls, by site.
    pub free_contacts: Vec<FoundContact>,
    /// The cage, if it is free.
    pub cage: Option<CageSolution>,
    /// Newton iterations.
    pub iterations: usize,
    /// Newton's unknowns.
    pub unknowns: Vec<f64>,
}

impl StepSolution {
    /// l of a contact at the start and at the end of the part, m.
    pub fn reach(&self, site: usize) -> [Meridian; 2] {
        lengths(&self.reaches).of(site).map(Meridian::from)
    }

    /// Contacts at the start, 0, or at the end, 1, of the part.
    pub fn states(&self, parts: &BearingParts, end: usize) -> Vec<SiteState> {
        parts.contacts.states(&self.reaches[end])
    }
}

impl BearingParts {
    /// Solves the part; `scale` is the largest force that acts at its start, N.
    pub fn solve_step(&self, scale: f64, costs: &SharedLaps) -> Result<StepSolution, DynamicsError> {
        self.solve_step_from(None, &policy(scale, None, costs), &mut None)
    }

    /// The same by a policy, from given unknowns or from the guess of the system, with a tangent that is kept.
    pub(super) fn solve_step_from(
        &self,
        start: Option<Vec<f64>>,
        policy: &Policy<'_>,
        kept: &mut Option<KeptTangent>,
    ) -> Result<StepSolution, DynamicsError> {
        let (system, costs) = (self.system(), policy.costs);
        let solved = system.solve_again(start.unwrap_or_else(|| system.guess()), policy, kept)?;
        let (x, reaches) = (&solved.unknowns, self.reaches(&solved.unknowns));
        let means = self.contacts.means;
        let balls = means.map(|means| self.contacts.mean_forces(lengths(&reaches), means, costs));
        let forces: Vec<_> = balls.iter().flatten().flat_map(|b| b.contacts).collect();
        let on_shaft = system.forces_on(SHAFT, CONTACTS, x, &self.with_dead(&forces));
        Ok(StepSolution {
            shaft: system.coordinates(SHAFT, x),
            balls: (0..self.balls.len())
                .map(|ball| system.coordinates(FIRST_BALL + ball, x).into())
                .collect(),
            seat: self.seat_end(&system, x),
            forces,
            on_shaft,
            reaches,
            mounts: Side::BOTH.map(|side| self.mount(&system, side, x)),
            iterations: solved.iterations,
            unknowns: solved.unknowns,
            ..StepSolution::default()
        })
    }

    /// Forces of the partner on the mount of a ring for the unknowns `x`, in the ring's frame.
    pub(super) fn mount(&self, system: &System<'_>, side: Side, x: &[f64]) -> Vec<f64> {
        let elastic = self.elastic(side).zip(self.rings[side.index()].as_ref());
        let forces = elastic.map(|(body, ports)| system.port_forces(body, x)[ports.n_moving..].to_vec());
        forces.unwrap_or_default()
    }
}

/// What a part, short as a rule, asks of Newton; `scale` is the largest force that acts at its start, N.
pub(super) fn policy<'p>(scale: f64, scales: Option<&'p [f64]>, costs: &'p SharedLaps) -> Policy<'p> {
    Policy {
        most_iterations: MOST_ITERATIONS,
        residual_limit: RESIDUAL_LIMIT,
        force_scale: scale,
        round_off: RoundOff::Unknowns,
        ends_at_floor: false,
        keeps_factors: true,
        blocks: &[],
        scales,
        proximal: 0.0,
        longest_step: f64::INFINITY,
        search: Shortening::Residual(HALVINGS),
        watch: &|_| Ok(()),
        costs,
    }
}

/// Fails when a ball presses where no groove can be.
fn check_grooves(parts: &BearingParts, solution: &StepSolution) -> Result<(), DynamicsError> {
    for (index, site) in parts.contacts.sites.iter().enumerate() {
        let [_, end] = solution.reach(index);
        if end.norm() > site.touching {
            require_in_groove(site, site.angle(end))?;
        }
    }
    Ok(())
}

/// Fails when shaft or balls are where small motions and the search for equilibrium end.
pub(super) fn check_range(
    model: &Model,
    parts: &BearingParts,
    solution: &StepSolution,
) -> Result<(), DynamicsError> {
    let diameter = model.geometry.ball_diameter;
    let in_mm = |x: f64| format!("{:.3} mm", 1e3 * x);
    let left = |what, value, limit| Err(DynamicsError::LeftBearing { what, value, limit });
    for (dof, q) in solution.shaft.into_iter().enumerate() {
        let (limit, text): (f64, fn(f64) -> String) = match dof {
            0..3 => (0.5 * diameter, in_mm),
            _ => (MAX_TILT, |x| format!("{x:.3} rad")),
        };
        if q.abs() > limit {
            return left(format!("{} of the shaft", AXES[dof]), text(q), text(limit));
        }
    }
    for (ball, moved) in solution.balls.iter().enumerate() {
        if moved.norm() > diameter {
            return left(format!("ball {ball}"), in_mm(moved.norm()), in_mm(diameter));
        }
    }
    check_grooves(parts, solution)
}

/// Fails when a contact is beyond what its patch leaves of Hertz's law.
pub(super) fn check_patches(parts: &BearingParts, solution: &StepSolution) -> Result<(), DynamicsError> {
    let contacts = parts.contacts.sites.iter().zip(&solution.forces);
    for ((site, force), state) in contacts.zip(solution.states(parts, 1)) {
        if state.force.beyond_limit {
            let (ball, side) = (site.ball, site.side.name());
            let force = Meridian::from(force.force).norm();
            return Err(DynamicsError::PatchTooSmall { ball, side, force });
        }
    }
    Ok(())
}
