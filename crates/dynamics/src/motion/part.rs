//! What a part of a step asks of loads, rings and shaft, and the small system they make.

use std::sync::Arc;

use contact::{NodalWeights, Side};

use super::ahead::{Foreseen, Known};
use super::body::RingBody;
use super::frame::turn_nodal;
use super::newton::SmallSolution;
use super::pool::PooledVector;
use super::ring::{RingFactor, RingState, RingStep};
use super::run::Motion;
use super::shaft::ShaftStep;
use super::small::{Inertia, RingAnswer, SmallSystem};
use super::state::MotionState;
use super::substep::Span;
use super::vectors::combined;
use crate::compliance;
use crate::effects::{self, FrameTurn, Loads, Now};
use crate::error::DynamicsError;
use crate::problem::Site;

/// Force scale of a bearing on which nothing acts, N.
const LEAST_FORCE: f64 = 1e-9;

/// A flexible ring during a part.
pub(super) struct Moving<'m> {
    pub body: &'m RingBody,
    pub factor: &'m RingFactor,
    pub old: &'m RingState,
    pub step: RingStep,
    /// Loads, and first guess of the inertia of the turning frame.
    pub known: Arc<Known>,
    /// Inertia load of the turning frame that acts, when there is one.
    pub inertia: Option<(FrameTurn, Arc<PooledVector>)>,
    /// Increment of a ring whose state is not in harmonic space, once it is found.
    pub increment: Option<Vec<f64>>,
}

impl Moving<'_> {
    /// Increment under forces on contacts (N, `[2 n_contacts]`) and mount (N and N m).
    pub fn increment_under(&self, contacts: &[f64], mount: &[f64]) -> Vec<f64> {
        self.factor.increment(self.body, &self.step, contacts, mount)
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

    /// Both rings under their known loads.
    pub(super) fn prepare<'m>(
        &'m self,
        state: &'m MotionState,
        foreseen: &Arc<Foreseen>,
        feet: &[Vec<NodalWeights>; 2],
    ) -> Result<[Option<Moving<'m>>; 2], DynamicsError> {
        let rung = self.rung(foreseen.span.rung)?;
        let prepare = |side: Side| {
            let i = side.index();
            let body = self.rings[i].as_ref()?;
            let (factor, old) = (rung[i].as_ref()?, state.rings[i].as_ref()?);
            let known = self.known(side, (body, factor), old, foreseen);
            let inertia = known.inertia.as_ref().map(|(_, f)| &f[..]);
            let step = match (&known.solved, known.load.as_deref(), inertia) {
                (Some(solved), ..) => {
                    let turn = known.inertia.as_ref().map(|(turn, _)| *turn);
                    factor.prepare_solved(body, (old, turn), solved.clone(), &feet[i])
                }
                (None, Some(load), Some(f)) => {
                    let both = combined([1.0; 2], load, f);
                    factor.prepare(body, old, Some(&both), &feet[i])
                }
                (None, load, f) => factor.prepare(body, old, load.or(f), &feet[i]),
            };
            Some(Moving {
                body,
                factor,
                old,
                step,
                inertia: known.inertia.clone(),
                increment: None,
                known,
            })
        };
        let (inner, outer) = self
            .model
            .backend
            .both(|| prepare(Side::Inner), || prepare(Side::Outer));
        Ok([inner, outer])
    }

    /// Generalised body load of a ring. Loads are fixed in space: those of the inner ring are turned into its frame.
    pub(super) fn ring_load(
        &self,
        body: &RingBody,
        side: Side,
        loads: &Loads,
        span: Span,
    ) -> Option<Vec<f64>> {
        let back = -self.frame_angle(side, span.at(1.0 - self.settings.integrator.alpha_f));
        let load = loads.rings[side.index()].as_ref()?;
        let reduced = body.coordinates.reduce(&turn_nodal(load, back));
        Some(body.space.of_coordinates(reduced))
    }

    pub(super) fn system(
        &self,
        state: &MotionState,
        span: Span,
        sites: Vec<Site>,
        moving: &[Option<Moving<'_>>; 2],
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
        let answer = |side: Side| {
            let answer = |m: &Moving<'_>| -> Result<RingAnswer, DynamicsError> {
                let (n, n_balls) = (m.step.start.len(), self.model.geometry.n_balls);
                Ok(RingAnswer {
                    start: m.step.start.clone(),
                    predicted: m.step.predicted.clone(),
                    stiffness: compliance::inverse(side, n, n_balls, &m.step.compliance)?,
                })
            };
            moving[side.index()].as_ref().map(answer).transpose()
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
