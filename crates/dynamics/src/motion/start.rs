//! The start of a motion: static equilibrium, at rest but for the turning of the rings.

use body::BesideRing;
use contact::{Meridian, Side};
use ring::{ElasticBody, Integrator, RingState};

use super::cache::StepCache;
use super::free::friction_at_start;
use super::ledger::Ledger;
use super::rolling_start::EquilibriumRates;
use super::run::Motion;
use super::state::PatchPlace;
use super::state::{Ladder, MotionSettings, MotionState};
use crate::error::DynamicsError;
use crate::interactions::discrete_gradient::ContactScheme;
use crate::interactions::raceway_contact::{RacewayContacts, Site, on_rings};
use crate::solution::StaticSolution;

impl Motion<'_> {
    /// The state at static equilibrium, at rest but for the turning of the rings and what drives the shaft.
    pub fn start(&self, solution: &StaticSolution) -> MotionState {
        self.start_with(solution, None)
    }

    /// The same, with the velocities of shaft and balls if they are given.
    pub fn start_with(&self, solution: &StaticSolution, rates: Option<&EquilibriumRates>) -> MotionState {
        let model = self.model;
        let q = solution.displacements.shaft;
        let n = model.geometry.n_balls;
        let balls = rates.map_or_else(|| vec![Meridian::default(); n], |rates| rates.balls.clone());
        // A driven shaft moves already.
        let free = |dof: usize| rates.map_or(0.0, |rates| rates.shaft[dof]);
        let velocity =
            [0, 1, 2, 3, 4].map(|dof| model.prescribed_rate(dof, 0.0).unwrap_or_else(|| free(dof)));
        let seat = [0.0, 0.0, solution.displacements.seat, 0.0, 0.0];
        let ring = |side: Side| {
            let moving = self.rings[side.index()].as_ref()?;
            let elastic = solution.elastic[side.index()].as_ref()?;
            let (q, velocity) = side.choose((q, velocity), (seat, [0.0; 5]));
            let omega = self.settings.speeds.of(side).at(0.0);
            let load = solution.body_load(model, side);
            Some(ring_at_start(
                &**moving.body,
                (elastic, model.acting(side, load)),
                q,
                velocity,
                omega,
            ))
        };
        let contacts = solution.parts.states_at(&solution.displacements);
        let places: Vec<PatchPlace> = contacts.iter().map(PatchPlace::of).collect();
        let mut state = MotionState {
            step: 0,
            rung: 0,
            rings: Side::BOTH.map(ring),
            balls: solution.displacements.balls.clone(),
            ball_velocities: balls,
            ball_accelerations: vec![Meridian::default(); n],
            shaft: q,
            shaft_velocity: velocity,
            shaft_acceleration: [0.0; 5],
            seat: model.seat().map(|_| [solution.displacements.seat, 0.0, 0.0]),
            trend: vec![Meridian::default(); 3 * n],
            forces: on_rings(&contacts),
            places: [(); 3].map(|()| places.clone()),
            angles: contacts.iter().map(|c| c.angle).collect(),
            approaches: contacts.iter().map(|c| c.force.approach).collect(),
            free: None,
            ledger: Ledger::default(),
        };
        state.ledger.hertz = solution.hertz_energy;
        state.free = self.free_start(&state, solution.steady.as_ref());
        self.with_energies(state)
    }
}

impl Motion<'_> {
    /// A bearing without elastic deformation: shaft and inner ring at displacement `q` (m, rad) with velocity
    /// `velocity` (m/s, rad/s) in space, balls at their just-touching position, at rest. Imposed dofs are where they
    /// are imposed.
    pub fn rest(&self, mut q: [f64; 5], mut velocity: [f64; 5]) -> MotionState {
        let n = self.model.geometry.n_balls;
        for dof in 0..5 {
            q[dof] = self.model.prescribed(dof, 0.0).unwrap_or(q[dof]);
            velocity[dof] = self.model.prescribed_rate(dof, 0.0).unwrap_or(velocity[dof]);
        }
        let ring = |side: Side| {
            let omega = self.settings.speeds.of(side).at(0.0);
            let body = &*self.rings[side.index()].as_ref()?.body;
            let none = vec![0.0; body.held().coordinates.expanded()];
            let (q, v) = side.choose((q, velocity), ([0.0; 5], [0.0; 5]));
            Some(ring_at_start(
                &**body,
                (&none, BesideRing::default()),
                q,
                v,
                omega,
            ))
        };
        let unloaded = PatchPlace {
            angle: self.model.geometry.free_contact_angle(),
            force: 0.0,
        };
        let mut state = MotionState {
            step: 0,
            rung: 0,
            rings: Side::BOTH.map(ring),
            balls: vec![Meridian::default(); n],
            ball_velocities: vec![Meridian::default(); n],
            ball_accelerations: vec![Meridian::default(); n],
            shaft: q,
            shaft_velocity: velocity,
            shaft_acceleration: [0.0; 5],
            seat: self.model.seat().map(|_| [0.0; 3]),
            // Nothing is known of the accelerations.
            trend: vec![Meridian::new(f64::NAN, f64::NAN); 3 * n],
            forces: vec![Meridian::default(); 2 * n],
            places: [(); 3].map(|()| vec![unloaded; 2 * n]),
            angles: vec![self.model.geometry.free_contact_angle(); 2 * n],
            approaches: vec![0.0; 2 * n],
            free: None,
            ledger: Ledger::default(),
        };
        self.note_contacts(&mut state);
        state.free = self.free_start(&state, None);
        self.with_energies(state)
    }

    /// The state with accelerations that fit its displacements and velocities: schemes that dissipate remember them,
    /// and would be of first order without. They are means over a trial step of the conserving scheme, which needs
    /// none.
    pub fn with_accelerations(&self, mut state: MotionState) -> Result<MotionState, DynamicsError> {
        if self.settings.integrator.is_conserving() {
            return Ok(state);
        }
        let conserving = MotionSettings {
            integrator: Integrator::average_acceleration(),
            scheme: ContactScheme::DiscreteGradient,
            ladder: Ladder {
                tolerance: None,
                ..self.settings.ladder
            },
            ..self.settings.clone()
        };
        let (next, _) = Motion::new(self.model, conserving)?.step(&state, &mut StepCache::default())?;
        let mean = |v1: f64, v0: f64| (v1 - v0) / self.settings.dt;
        for (start, moved) in state.rings.iter_mut().zip(&next.rings) {
            if let (Some(ring), Some(moved)) = (start.take(), moved) {
                *start = Some(ring.with_mean_acceleration(moved, self.settings.dt));
            }
        }
        for (b, moved) in next.ball_velocities.iter().enumerate() {
            state.ball_accelerations[b] =
                (*moved - state.ball_velocities[b]).map(|change| change / self.settings.dt);
        }
        if let (Some(seat), Some(moved), Some(model)) = (&mut state.seat, next.seat, self.model.seat())
            && model.mass > 0.0
        {
            seat[2] = mean(moved[1], seat[1]);
        }
        for (dof, mass) in self.model.shaft_masses().into_iter().enumerate() {
            if mass > 0.0 {
                state.shaft_acceleration[dof] = mean(next.shaft_velocity[dof], state.shaft_velocity[dof]);
            }
        }
        Ok(state)
    }

    /// The state with a ledger that begins here: after its velocities were set by hand.
    pub fn with_energies(&self, mut state: MotionState) -> MotionState {
        let hertz = state.ledger.hertz;
        state.ledger = Ledger {
            hertz,
            friction: friction_at_start(self.model),
            cage: self.cage_ledger(&state),
            ..Ledger::default()
        };
        self.measure_energies(&mut state);
        state.ledger.initial = state.ledger.total();
        state.ledger.note_scale();
        state
    }

    /// Contacts of rigid bodies at the state's displacements: angles, approaches, forces and their energy.
    fn note_contacts(&self, state: &mut MotionState) {
        let n_contacts = state.forces.len();
        let mounting = self.model.mounting.at(0.0);
        let site = |index: usize| {
            let (ball, side) = (index / 2, Side::BOTH[index % 2]);
            Site::new(self.model, &mounting, ball, side, self.ball_azimuth(ball, 0.0))
        };
        let contacts = RacewayContacts::new((0..n_contacts).map(site).collect(), Vec::new(), None);
        let reach = |site: &Site| site.reach_of_rigid(state.shaft, state.balls[site.ball]);
        let lengths: Vec<f64> = contacts
            .sites
            .iter()
            .flat_map(|site| reach(site).to_array())
            .collect();
        for (index, contact) in contacts.states(&lengths).into_iter().enumerate() {
            state.approaches[index] = contact.force.approach;
            state.angles[index] = contact.angle;
            state.forces[index] = contact.on_ring();
            for places in &mut state.places {
                places[index] = PatchPlace::of(&contact);
            }
            state.ledger.hertz += contact.force.energy;
        }
    }
}

/// State of a ring: elastic part plus the rigid motion `q`, and in its frame, which turns at `omega`, the velocity of
/// that motion, which has `velocity` in space. What is `acting` acts on its body besides.
fn ring_at_start(
    body: &dyn ElasticBody,
    (elastic, acting): (&[f64], BesideRing<'_>),
    q: [f64; 5],
    velocity: [f64; 5],
    omega: f64,
) -> RingState {
    let turned = [omega * q[1], -omega * q[0], 0.0, omega * q[4], -omega * q[3]];
    let rate = [0, 1, 2, 3, 4].map(|i| velocity[i] + turned[i]);
    body.rigid_state((elastic, acting), [q, rate], omega)
}
