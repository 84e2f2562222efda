//! What a part of a step asks of loads, rings and shaft, and the bodies and contacts they make.

use contact::{Meridian, Side};
use ring::{ElasticStep, Feet, PortForces, StepScheme};

use super::cache::Ahead;
use super::place::Placing;
use super::run::Motion;
use super::solve::StepSolution;
use super::span::PartSpan;
use super::state::MotionState;
use super::state::PatchPlace;
use crate::bearing::{BearingParts, ContactList, SeatStep};
use crate::bodies::{FlatBody, FrameInertia, Inertia, LargeTilt, Name, ShaftStart, StepTakes};
use crate::effects::{Loads, Now};
use crate::error::DynamicsError;
use crate::interactions::discrete_gradient::MeanForce;
use crate::interactions::raceway_contact::Means;
use crate::system::Interval;

/// Force scale of a bearing on which nothing acts, N.
const LEAST_FORCE: f64 = 1e-9;

/// The steps of the flexible rings during a part.
pub(super) type RingSteps<'m> = [Option<Box<dyn ElasticStep + 'm>>; 2];

/// Forces on a ring.
pub(super) struct RingForces {
    /// On its contacts, N.
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
    /// Mean loads over an interval of `width` seconds about a time, those that follow the contact angles with the
    /// angles expected.
    pub(super) fn loads_at(
        &self,
        places: &[PatchPlace],
        time: f64,
        width: f64,
    ) -> Result<Loads, DynamicsError> {
        let angles: Vec<f64> = places.iter().map(|place| place.angle).collect();
        let now = Now {
            time,
            width,
            cage_angle: self.cage_angle(time),
            angles: Some(&angles),
            seen: None,
        };
        self.model.timed_loads(&now, &self.costs)
    }

    /// Both rings under their known loads, with contacts as they are placed.
    pub(super) fn begin_rings<'m>(
        &'m self,
        state: &'m MotionState,
        ahead: Ahead,
        placing: &Placing,
    ) -> Result<RingSteps<'m>, DynamicsError> {
        let rung = self.rung(ahead.loads.span.rung)?;
        let begin = |side: Side| {
            let i = side.index();
            let (factor, old) = (rung[i].as_ref()?, state.rings[i].as_ref()?);
            let known = ahead.rings[i].clone();
            let known =
                known.unwrap_or_else(|| factor.predict(old, self.known_load(side, &ahead.loads)).into());
            Some(factor.begin(old, known, self.feet(side, placing)))
        };
        Ok(self.model.backend.on_sides(begin))
    }

    /// Where contacts meet a ring.
    pub(super) fn feet<'p>(&self, side: Side, placing: &'p Placing) -> Feet<'p> {
        Feet {
            weights: &placing.feet[side.index()],
            per_contact: self.feet_per_contact(),
            seen: &placing.slopes[side.index()],
        }
    }

    /// Bodies and contacts of a part.
    pub(super) fn parts(
        &self,
        state: &MotionState,
        span: PartSpan,
        (placing, places): (&Placing, &[PatchPlace]),
        rings: &RingSteps<'_>,
        loads: &Loads,
    ) -> Result<BearingParts, DynamicsError> {
        let mut sites = placing.sites.clone();
        self.pass_elastic((state, span), places, rings, &mut sites);
        let ports = |side: Side| {
            let step = rings[side.index()].as_deref();
            step.map(|step| self.ports(state, span, side, step)).transpose()
        };
        let (integrator, dt) = (self.settings.integrator, span.dt);
        let contacts = ContactList {
            sites: self.on_surfaces(span, sites),
            dead: loads.contacts.clone(),
            means: Some(Means {
                dt,
                scheme: self.settings.scheme,
                weight: integrator.alpha_f,
                damping: self.settings.contact_damping,
            }),
        };
        let free = self.free_parts(state, span, &contacts.sites, rings);
        let n_kinematic = if free.is_some() { 0 } else { self.n_balls() };
        let mut parts = BearingParts::new(
            Interval::Step(StepScheme { integrator, dt }),
            self.shaft(state, span, loads),
            (0..n_kinematic)
                .map(|ball| self.ball(state, ball, loads))
                .collect(),
            Side::try_both(ports)?,
            contacts,
            self.seat(state, loads),
        );
        parts.shaft.tilted = parts.tilted_loads(loads);
        Ok(parts.with_free(free))
    }

    fn seat(&self, state: &MotionState, loads: &Loads) -> Option<SeatStep> {
        let (seat, start) = (self.model.seat()?, state.seat?);
        Some(SeatStep {
            seat,
            axial: Inertia {
                mass: seat.mass,
                start,
                // A flexible ring brings its own loads to the seat.
                load: loads.seat,
                ..Inertia::default()
            },
            weight: self.settings.integrator.alpha_f,
        })
    }

    /// The middle of a part.
    pub(super) fn now(&self, span: PartSpan) -> Now<'static> {
        let time = self.weighted_time(span);
        Now {
            time,
            width: span.dt,
            cage_angle: self.cage_angle(time),
            angles: None,
            seen: None,
        }
    }

    fn ball(&self, state: &MotionState, ball: usize, loads: &Loads) -> FlatBody<2> {
        let course = [&state.balls, &state.ball_velocities, &state.ball_accelerations];
        let course = course.map(|of_balls| of_balls[ball].to_array());
        let load = loads.balls[ball].to_array();
        let dofs = [0, 1].map(|i| Inertia {
            mass: self.model.ball_mass(),
            start: course.map(|at| at[i]),
            load: load[i],
            load_slope: if i == 0 { loads.ball_slopes[ball] } else { 0.0 },
        });
        FlatBody::new(Name::Ball(ball), dofs, [None; 2])
    }

    fn shaft(&self, state: &MotionState, span: PartSpan, loads: &Loads) -> FlatBody<5> {
        let masses = self.model.shaft_masses();
        let dofs = [0, 1, 2, 3, 4].map(|i| Inertia {
            mass: masses[i],
            start: [
                state.shaft[i],
                state.shaft_velocity[i],
                state.shaft_acceleration[i],
            ],
            load: loads.shaft[i],
            load_slope: 0.0,
        });
        let imposed = [0, 1, 2, 3, 4].map(|i| self.model.prescribed(i, span.at(1.0)));
        let mut shaft = FlatBody::new(Name::Shaft, dofs, imposed);
        shaft.turning = self.frame_inertia(state, span).map(Box::new);
        shaft.large_tilt = self.large_tilt(state, span).map(Box::new);
        shaft
    }

    fn shaft_start(&self, state: &MotionState, span: PartSpan) -> ShaftStart {
        ShaftStart {
            start: [state.shaft, state.shaft_velocity, state.shaft_acceleration],
            remembers: self.model.shaft_masses().map(|mass| mass > 0.0),
            scheme: StepScheme {
                integrator: self.settings.integrator,
                dt: span.dt,
            },
        }
    }

    /// Inertia of what moves with the shaft beyond that of small tilts.
    fn large_tilt(&self, state: &MotionState, span: PartSpan) -> Option<LargeTilt> {
        Some(LargeTilt {
            inertia: self.tilting?,
            shaft: self.shaft_start(state, span),
            speeds: [0.0, 1.0].map(|share| self.settings.speeds.inner.at(span.at(share))),
        })
    }

    /// Rigid inertia of what turns with the shaft that neither its dofs nor the step of the ring take.
    fn frame_inertia(&self, state: &MotionState, span: PartSpan) -> Option<FrameInertia> {
        let inertia = self.turning?;
        let inner = Side::Inner;
        let integrator = self.settings.integrator;
        Some(FrameInertia {
            inertia,
            shaft_polar: self.model.shaft_inertia.polar,
            body_polar: self.model.carried_inertia().map_or(0.0, |body| body.polar),
            tilt_by_stress: self.tilt_by_stress,
            takes: if self.has_elastic_inertia(inner) {
                StepTakes::Turning
            } else {
                StepTakes::Still
            },
            shaft: self.shaft_start(state, span),
            angles: [0.0, 1.0 - integrator.alpha_f, 1.0].map(|share| self.frame_angle(inner, span.at(share))),
            speeds: [0.0, 1.0].map(|share| self.settings.speeds.inner.at(span.at(share))),
        })
    }

    /// Largest force that acts at the start of a part, N: of the contacts, on shaft, balls and rings.
    pub(super) fn force_scale(&self, state: &MotionState, loads: &Loads) -> f64 {
        let arm = self.model.geometry.centre_radius(Side::Inner);
        let forces = state
            .forces
            .iter()
            .chain(&loads.balls)
            .flat_map(|force| force.to_array());
        let moments = loads.shaft[3..].iter().map(|m| m / arm);
        let rings = Side::BOTH.into_iter().flat_map(|side| {
            let load = loads.rings[side.index()].as_deref().unwrap_or_default();
            let add = |sum: [f64; 3], f: &[f64; 3]| [0, 1, 2].map(|i| sum[i] + f[i]);
            let sum = load.as_chunks().0.iter().fold([0.0; 3], add);
            let weight =
                loads.weights[side.index()].map_or([0.0; 3], |of| of.acceleration.map(|a| of.mass * a));
            add(sum, &weight)
        });
        let seat = self.model.seat().zip(state.seat);
        let seat = seat.map(|(seat, [z, ..])| [loads.seat, seat.force + seat.stiffness * z]);
        forces
            .chain(loads.shaft[..3].iter().copied())
            .chain(moments)
            .chain(rings)
            .chain(seat.into_iter().flatten())
            .fold(LEAST_FORCE, |m, f| m.max(f.abs()))
    }
}

impl BearingParts {
    /// Forces at the ports of a ring.
    pub(super) fn forces_at_ports(&self, side: Side, solution: &StepSolution) -> RingForces {
        RingForces {
            contacts: self.ring_loads(side, solution),
            mount: solution.mounts[side.index()].clone(),
        }
    }

    /// Forces on a ring's contacts by ball, N: on the groove; of a free one on the patch too.
    pub(super) fn ring_loads(&self, side: Side, solution: &StepSolution) -> Vec<f64> {
        let all = self.with_dead(&solution.forces);
        let of_ball = |ball: usize| {
            let site = 2 * ball + side.index();
            let groove = [all[2 * site], all[2 * site + 1]];
            let patch = solution.free_contacts.get(site);
            let patch = patch.map(|found| [-found.along_track(), -found.traction.action[1]]);
            groove.into_iter().chain(patch.into_iter().flatten())
        };
        (0..self.n_balls()).flat_map(of_ball).collect()
    }

    /// Forces on the rings at all contacts, the dead ones with them, `[2 n_sites]`, N.
    pub(super) fn with_dead(&self, forces: &[MeanForce]) -> Vec<f64> {
        let of_site = |(site, force): (usize, &MeanForce)| {
            let dead = self.contacts.dead.get(site).copied().unwrap_or_default();
            (Meridian::from(force.force) + dead).to_array()
        };
        forces.iter().enumerate().flat_map(of_site).collect()
    }
}
