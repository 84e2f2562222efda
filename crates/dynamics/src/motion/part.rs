//! What a part of a step asks of loads, rings and shaft, and the small system they make.

use contact::{NodalWeights, Side};
use ring::{ElasticStep, PortForces};

use super::cache::Ahead;
use super::inertia::Inertia;
use super::newton::SmallSolution;
use super::run::Motion;
use super::shaft::ShaftStep;
use super::small::{RingAnswer, SmallSystem};
use super::span::Span;
use super::state::MotionState;
use crate::compliance;
use crate::effects::{self, Loads, Now};
use crate::error::DynamicsError;
use crate::problem::Site;

/// Force scale of a bearing on which nothing acts, N.
const LEAST_FORCE: f64 = 1e-9;

/// The steps of the flexible rings during a part.
pub(super) type RingSteps<'m> = [Option<Box<dyn ElasticStep + 'm>>; 2];

/// Forces on a ring.
pub(super) struct RingForces {
    /// On its contacts, `[2 n_balls]`, N.
    contacts: Vec<f64>,
    /// On its mount, N and N m.
    mount: Vec<f64>,
}

impl RingForces {
    pub fn at_ports(&self) -> PortForces<'_> {
        PortForces {
            contacts: &self.contacts,
            mount: &self.mount,
        }
    }
}

impl Motion<'_> {
    /// Mean loads over an interval of `width` seconds about a time, those that follow the contact angles with the angles expected.
    pub(super) fn loads_at(
        &self,
        places: &[[f64; 2]],
        time: f64,
        width: f64,
    ) -> Result<Loads, DynamicsError> {
        let angles: Vec<f64> = places.iter().map(|p| p[0]).collect();
        let now = Now {
            time,
            width,
            cage_angle: self.cage_angle(time),
            angles: Some(&angles),
        };
        effects::timed_loads(self.model, &now, &self.costs)
    }

    /// Both rings under their known loads, with contacts at `feet`.
    pub(super) fn begin_rings<'m>(
        &'m self,
        state: &'m MotionState,
        ahead: Ahead,
        feet: &[Vec<NodalWeights>; 2],
    ) -> Result<RingSteps<'m>, DynamicsError> {
        let rung = self.rung(ahead.loads.span.rung)?;
        let begin = |side: Side| {
            let i = side.index();
            let (factor, old) = (rung[i].as_ref()?, state.rings[i].as_ref()?);
            let known = ahead.rings[i].clone();
            let known =
                known.unwrap_or_else(|| factor.predict(old, self.known_load(side, &ahead.loads)).into());
            Some(factor.begin(old, known, &feet[i]))
        };
        let (inner, outer) = self
            .model
            .backend
            .both(|| begin(Side::Inner), || begin(Side::Outer));
        Ok([inner, outer])
    }

    pub(super) fn system(
        &self,
        state: &MotionState,
        span: Span,
        sites: Vec<Site>,
        rings: &RingSteps<'_>,
        loads: &Loads,
    ) -> Result<SmallSystem, DynamicsError> {
        let mass = self.model.ball_mass();
        let balls = (0..self.model.geometry.n_balls).map(|b| {
            [0, 1].map(|i| Inertia {
                mass,
                start: [
                    state.balls[b][i],
                    state.ball_velocities[b][i],
                    state.ball_accelerations[b][i],
                ],
                load: loads.balls[b][i],
                load_slope: if i == 0 { loads.ball_slopes[b] } else { 0.0 },
            })
        });
        let answer = |side: Side| -> Result<Option<RingAnswer>, DynamicsError> {
            let Some(step) = &rings[side.index()] else {
                return Ok(None);
            };
            let (answer, n_balls) = (step.answer(), self.model.geometry.n_balls);
            let n = answer.start.len();
            Ok(Some(RingAnswer {
                start: answer.start.clone(),
                predicted: answer.predicted.clone(),
                stiffness: compliance::inverse(side, n, n_balls, &answer.compliance)?,
            }))
        };
        Ok(SmallSystem {
            dt: span.dt,
            integrator: self.settings.integrator,
            sites,
            balls: balls.collect(),
            shaft: self.shaft_step(state, span, loads),
            rings: [answer(Side::Inner)?, answer(Side::Outer)?],
            scheme: self.settings.scheme,
            damping: self.settings.contact_damping,
            extra: loads.contacts.clone(),
        })
    }

    /// Largest force that acts at the start of a part, N: of the contacts, on shaft, balls and rings.
    pub(super) fn force_scale(&self, state: &MotionState, loads: &Loads) -> f64 {
        let arm = self.model.geometry.centre_radius(Side::Inner);
        let forces = state.forces.iter().chain(&loads.balls).flatten().copied();
        let moments = loads.shaft[3..].iter().map(|m| m / arm);
        let rings = Side::BOTH.into_iter().flat_map(|side| {
            let load = loads.rings[side.index()].as_deref().unwrap_or_default();
            let add = |sum: [f64; 3], f: &[f64; 3]| [0, 1, 2].map(|i| sum[i] + f[i]);
            load.as_chunks().0.iter().fold([0.0; 3], add)
        });
        forces
            .chain(loads.shaft[..3].iter().copied())
            .chain(moments)
            .chain(rings)
            .fold(LEAST_FORCE, |m, f| m.max(f.abs()))
    }

    fn shaft_step(&self, state: &MotionState, span: Span, loads: &Loads) -> ShaftStep {
        let inertia = [
            self.model.shaft_mass,
            self.model.shaft_mass,
            self.model.shaft_mass,
            0.0,
            0.0,
        ];
        let bodies = [0, 1, 2, 3, 4].map(|i| Inertia {
            mass: inertia[i],
            start: [
                state.shaft[i],
                state.shaft_velocity[i],
                state.shaft_acceleration[i],
            ],
            load: loads.shaft[i],
            load_slope: 0.0,
        });
        let imposed = [0, 1, 2, 3, 4].map(|i| self.model.prescribed(i, span.at(1.0)));
        let angle = |share: f64| self.frame_angle(Side::Inner, span.at(share));
        ShaftStep {
            bodies,
            imposed,
            frame: [angle(1.0 - self.settings.integrator.alpha_f), angle(1.0)],
        }
    }
}

impl SmallSystem {
    /// Forces at the ports of a ring.
    pub(super) fn forces_at_ports(&self, side: Side, solution: &SmallSolution) -> RingForces {
        RingForces {
            contacts: self.ring_loads(side, solution),
            mount: solution.mounts[side.index()].clone(),
        }
    }

    /// Forces on a ring's contacts, `[2 n_balls]`, N.
    pub(super) fn ring_loads(&self, side: Side, solution: &SmallSolution) -> Vec<f64> {
        let n = self.balls.len();
        (0..n)
            .flat_map(|ball| {
                let site = 2 * ball + side.index();
                let extra = self.extra.get(site).copied().unwrap_or_default();
                let force = solution.forces[site].force;
                [force[0] + extra[0], force[1] + extra[1]]
            })
            .collect()
    }
}
