//! One contact of a free ball over a step.

use std::sync::Arc;

use contact::{AcrossCompliance, ContactLaw, Meridian};

use super::jet::{Jet, N_LENGTHS, cross, dot, fixed, minus, plus, scaled, times};
use super::place::{Bodies, ContactFrame, GrooveCircle, SlipJets, Standing, frame, orbit, standing};
use super::ring_step::{ElasticPlace, Middle, RingStep, SlopeForce};
use super::rolling_surface::{OverSurface, RollingSurface, StripTerms};
use super::surface_force::{SurfaceForce, add_surface, over_surface};
use crate::interactions::contact_damping::{ContactDamping, StepDamping, Viscous};
use crate::interactions::discrete_gradient::{ContactScheme, MeanForce};
use crate::interactions::traction::{Ellipse, Resultant, Slip, Traction};

/// The slip that traction follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SlipAt {
    /// That of the end of the step.
    #[default]
    End,
    /// That of its middle.
    Middle,
}

/// A contact over a step.
#[derive(Clone, Debug)]
pub struct ContactStep {
    /// Step size, s.
    pub dt: f64,
    /// Place, velocity and angular velocity of the ball at the start.
    pub ball: [[f64; 3]; 3],
    /// The groove.
    pub groove: GrooveCircle,
    /// Force law.
    pub law: ContactLaw,
    /// By how much it yields under the force of the ball's other contact.
    pub across: AcrossCompliance,
    /// |l| at which ball and groove touch, m.
    pub touching: f64,
    /// Sign of the raceway's side.
    pub sign: f64,
    /// The surfaces over which it rolls; None: they are smooth.
    pub surface: Option<RollingSurface>,
    /// How normal forces are evaluated.
    pub scheme: ContactScheme,
    /// Damping along the normal.
    pub damping: Option<ContactDamping>,
    /// The ring.
    pub ring: RingStep,
    /// Traction.
    pub traction: Arc<Traction>,
    /// The contact's ellipse.
    pub ellipse: Ellipse,
    /// Slip s_v, m/s.
    pub small_slip: f64,
    /// Which slip traction follows.
    pub slip_at: SlipAt,
}

/// Where ball and ring stand over a step.
pub(super) struct StandingOver {
    /// Lengths at the end.
    pub x: [Jet; N_LENGTHS],
    /// At the start.
    pub start: Standing,
    /// At the end.
    pub last: Standing,
    /// In the middle.
    pub mid: Middle,
}

/// The normal force of a contact over a step.
pub(super) struct Pressed {
    /// On the ring.
    pub normal: MeanForce,
    /// The same, radial and axial, as it grows with the lengths.
    pub load: [Jet; 2],
}

/// l, m.
pub(super) fn reach_of(at: &Standing) -> Meridian {
    Meridian::from(at.reach.map(|x| x.value))
}

/// Forces and slips of a contact over a step.
#[derive(Clone, Debug)]
pub struct FoundContact {
    /// What resists the growth of the lengths, N and N m.
    pub resists: [Jet; N_LENGTHS],
    /// l at start and end, m.
    pub reach: [Meridian; 2],
    /// Normal force on the ring.
    pub normal: MeanForce,
    /// Traction on the ball.
    pub traction: Resultant,
    /// The slip that it follows.
    pub slip: Slip,
    /// Work of traction on both bodies and on the drive of the ring, J.
    pub work: f64,
    /// Part of it at the slip that traction follows, never positive, J.
    pub work_at_slip: f64,
    /// Torque about the ring's axis with which traction turns the ball, N m: the drive of the ring works against it.
    pub torque: f64,
    /// The slope force of an elastic ring.
    pub slope: SlopeForce,
    /// What a real surface does.
    pub surface: Option<SurfaceForce>,
}

impl FoundContact {
    /// Force on the ball along the rolling direction by traction and by the slope of a real surface, N: the ring has
    /// the opposite.
    pub fn along_track(&self) -> f64 {
        let track = self.surface.as_ref().map(|surface| surface.of_raceway);
        track.map_or(self.traction.action[0], |track| self.traction.action[0] + track)
    }
}

impl ContactStep {
    pub(super) fn placed(&self, [from, end]: [[f64; N_LENGTHS]; 2]) -> StandingOver {
        let x: [Jet; N_LENGTHS] = std::array::from_fn(|i| Jet::length(i, end[i]));
        let [start, last] = [self.start(&from), self.standing_at_end(&x)];
        let mid = self.middle(&start, &last, &x);
        StandingOver { x, start, last, mid }
    }

    /// The contact under a normal force.
    pub(super) fn found(
        &self,
        at: StandingOver,
        pressed: Pressed,
        over: Option<OverSurface>,
    ) -> FoundContact {
        let StandingOver { x, start, last, mid } = at;
        let Pressed { normal, load } = pressed;
        let slip = match self.slip_at {
            SlipAt::End => self.slip_at_end(&last, &x),
            SlipAt::Middle => mid.slip,
        };
        let force = Meridian::from(normal.force).norm();
        let number = slip.slip.map(|s| s.value);
        let slipping = self.slip_of(number);
        let traction = self.traction.places.traction(
            &self.traction.law,
            &self.ellipse,
            &slipping,
            (force, self.small_slip),
        );
        let action = actions(&traction, &slip, (force, load));
        let mut resists = [Jet::default(); N_LENGTHS];
        self.add_normal(&mid, (&start, &last), load, &mut resists);
        let torque = self.add_traction(&mid, action, &mut resists);
        let slope = self.add_slope(&mid, load, &x, &mut resists);
        let surface =
            over.map(|over| add_surface(&self.ring, (&mid, &x), (&start, &last), over, &mut resists));
        let mean = mid.slip.slip.map(|s| s.value);
        // Place by place where it is the slip of the middle, so that no round-off makes it positive.
        let work_at_slip = self.dt * traction.power;
        let work = match self.slip_at {
            SlipAt::End => self.dt * (0..5).map(|i| traction.action[i] * mean[i]).sum::<f64>(),
            SlipAt::Middle => work_at_slip,
        };
        FoundContact {
            resists,
            reach: [start.reach, last.reach].map(|l| l.map(|x| x.value).into()),
            normal,
            traction,
            slip: slipping,
            work,
            work_at_slip,
            torque,
            slope,
            surface,
        }
    }

    /// Force, N, that the round-off of the lengths makes.
    pub fn round_off(&self, [_, end]: [[f64; N_LENGTHS]; 2]) -> f64 {
        let x: [Jet; N_LENGTHS] = std::array::from_fn(|i| Jet::constant(end[i]));
        let last = self.standing_at_end(&x);
        let place = 2.0 * f64::EPSILON * last.radius.value;
        let length = Meridian::from(last.reach.map(|l| l.value)).norm();
        (place * self.law.evaluate(length - self.touching).tangent).max(self.law.evaluate(place).force)
    }

    fn start(&self, from: &[f64; N_LENGTHS]) -> Standing {
        let carrier = self.ring.carrier[0].map(Jet::constant);
        let motion = self.ring.elastic.map_or([0.0; 2], |_| [from[6], from[7]]);
        standing(
            &self.groove,
            fixed(self.ball[0]),
            carrier,
            motion.map(Jet::constant),
        )
    }

    fn standing_at_end(&self, x: &[Jet; N_LENGTHS]) -> Standing {
        let place = plus(fixed(self.ball[0]), [x[0], x[1], x[2]]);
        standing(
            &self.groove,
            place,
            self.ring.carrier_at_end(x),
            self.groove_motion(x),
        )
    }

    fn groove_motion(&self, x: &[Jet; N_LENGTHS]) -> [Jet; 2] {
        match self.ring.elastic {
            Some(_) => [x[6], x[7]],
            None => [Jet::default(); 2],
        }
    }

    /// Mean velocity of the elastic patch along t and q.
    fn patch_velocity(&self, x: &[Jet; N_LENGTHS]) -> [Jet; 2] {
        let of = |at: ElasticPlace| [2, 3].map(|i| (x[6 + i] + -at.start[i]) * (1.0 / self.dt));
        self.ring.elastic.map_or([Jet::default(); 2], of)
    }

    /// Its damping from l at the start, m.
    fn step_damping(&self, start: Meridian) -> Option<StepDamping<'_>> {
        let law = self.damping.as_ref()?;
        Some(StepDamping {
            law,
            dt: self.dt,
            passing: self.passing(start),
        })
    }

    /// By how much it closes in the step because its ball passes along an elastic ring, of which lengths have the
    /// motion where the contact is in the middle of the step, m. Those on a rigid ring have the passing in them.
    fn passing(&self, start: Meridian) -> f64 {
        let Some(elastic) = self.ring.elastic else {
            return 0.0;
        };
        let [place, velocity, _] = self.ball;
        let normal = start.map(|l| l / start.norm());
        -(orbit(place, velocity) - self.ring.spin[0]) * self.dt * normal.dot(Meridian::from(elastic.slope))
    }

    /// What damping does along the normal, from l at the start to l at the end, m.
    pub(super) fn viscous(&self, reach: [Meridian; 2]) -> Option<Viscous> {
        let damping = self.step_damping(reach[0])?;
        Some(damping.viscous(self.touching, reach.map(Meridian::to_array)))
    }

    /// The contact on the surfaces over which it rolls; None where they are smooth.
    pub(super) fn over_surface(&self, at: &StandingOver) -> Option<OverSurface> {
        let terms = StripTerms {
            compliance: self.law.compliance(),
            touching: self.touching,
            sign: self.sign,
            scheme: self.scheme,
            damping: self.step_damping(reach_of(&at.start)),
        };
        let surface = self.surface.as_ref()?;
        let (course, middle) = ((&at.start, &at.last), (&at.mid, &at.x));
        Some(over_surface(surface, terms, &self.ring, course, middle))
    }

    /// Slip at the end of the step in the frame of the end.
    fn slip_at_end(&self, end: &Standing, x: &[Jet; N_LENGTHS]) -> SlipJets {
        let last = |change: Jet, before: f64| change * (2.0 / self.dt) + -before;
        let ball = |first: usize, before: [f64; 3]| [0, 1, 2].map(|i| last(x[first + i], before[i]));
        let [from, velocity] = self.ring.carrier;
        let carrier = self.ring.carrier_at_end(x);
        let rate = std::array::from_fn(|i| {
            let change = carrier[i] + -from[i];
            match (self.ring.elastic, self.ring.has_inertia[i]) {
                (Some(_), _) => Jet::default(),
                (None, true) => last(change, velocity[i]),
                (None, false) => change * (1.0 / self.dt),
            }
        });
        let patch = self.patch_velocity(x);
        let bodies = Bodies {
            ball: [
                plus(fixed(self.ball[0]), [x[0], x[1], x[2]]),
                ball(0, self.ball[1]),
                ball(3, self.ball[2]),
            ],
            carrier: [carrier, rate],
            groove: self.groove_motion(x),
            patch,
            spin: self.ring.spin[1],
        };
        let tilts = [carrier[3], carrier[4]];
        frame(end.seen, end.reach, tilts).slip(&self.groove, &bodies)
    }

    /// The middle of the step: where forces act.
    fn middle(&self, start: &Standing, end: &Standing, x: &[Jet; N_LENGTHS]) -> Middle {
        let from = self.ring.carrier[0];
        let change: [Jet; 5] = {
            let carrier = self.ring.carrier_at_end(x);
            std::array::from_fn(|i| carrier[i] + -from[i])
        };
        let change = if self.ring.elastic.is_some() {
            [Jet::default(); 5]
        } else {
            change
        };
        let carrier: [Jet; 5] = std::array::from_fn(|i| change[i] * 0.5 + from[i]);
        let rate = change.map(|x| x * (1.0 / self.dt));
        let patch = self.patch_velocity(x);
        let motion = [x[0], x[1], x[2]];
        let place = plus(fixed(self.ball[0]), scaled(0.5, motion));
        let bodies = Bodies {
            ball: [
                place,
                scaled(1.0 / self.dt, motion),
                scaled(1.0 / self.dt, [x[3], x[4], x[5]]),
            ],
            carrier: [carrier, rate],
            groove: self.groove_motion(x),
            patch,
            spin: self.ring.spin[0],
        };
        let reach = [0, 1].map(|i| start.reach[i] + end.reach[i]);
        let frame = frame(plus(start.seen, end.seen), reach, [carrier[3], carrier[4]]);
        let origin = plus(
            fixed([0.0, 0.0, self.groove.height]),
            [carrier[0], carrier[1], carrier[2]],
        );
        Middle {
            arm: minus(place, origin),
            slip: frame.slip(&self.groove, &bodies),
            frame,
        }
    }

    /// Adds the normal force on the ring along l, `load`.
    fn add_normal(
        &self,
        mid: &Middle,
        (start, end): (&Standing, &Standing),
        load: [Jet; 2],
        resists: &mut [Jet; N_LENGTHS],
    ) {
        let across = load[0] * (start.radius + end.radius).recip();
        let [x, y] = [0, 1].map(|i| (start.seen[i] + end.seen[i]) * across);
        let [e_x, e_y, e_z] = mid.frame.columns;
        let on_ring = plus(plus(times(x, e_x), times(y, e_y)), times(load[1], e_z));
        for i in 0..3 {
            resists[i] = resists[i] + on_ring[i];
        }
        if self.ring.elastic.is_some() {
            for i in 0..2 {
                resists[6 + i] = resists[6 + i] - load[i];
            }
            return;
        }
        mid.add_to_ring(on_ring, cross(mid.arm, on_ring), resists);
    }

    /// Adds the traction on the ball, `action` in (t, q) and about (t, q, n); returns its torque about the ring's axis.
    fn add_traction(&self, mid: &Middle, action: [Jet; 5], resists: &mut [Jet; N_LENGTHS]) -> f64 {
        let ContactFrame {
            rolling,
            lateral,
            normal,
            columns,
            ..
        } = mid.frame;
        let force = plus(times(action[0], rolling), times(action[1], lateral));
        let moment = plus(
            plus(times(action[2], rolling), times(action[3], lateral)),
            times(action[4], normal),
        );
        let lever = scaled(self.groove.lever, normal);
        let about_ball = plus(moment, cross(lever, force));
        let about_ring = plus(moment, cross(plus(mid.arm, lever), force));
        for i in 0..3 {
            resists[i] = resists[i] - force[i];
            resists[3 + i] = resists[3 + i] - about_ball[i];
        }
        if self.ring.elastic.is_some() {
            resists[8] = resists[8] + action[0];
            resists[9] = resists[9] + action[1];
        } else {
            mid.add_to_ring(scaled(-1.0, force), scaled(-1.0, about_ring), resists);
        }
        dot(about_ring, columns[2]).value
    }

    /// Adds the slope force of an elastic ring.
    fn add_slope(
        &self,
        mid: &Middle,
        load: [Jet; 2],
        x: &[Jet; N_LENGTHS],
        resists: &mut [Jet; N_LENGTHS],
    ) -> SlopeForce {
        let Some(at) = self.ring.elastic else {
            return SlopeForce::default();
        };
        let out = (mid.arm[0] * mid.arm[0] + mid.arm[1] * mid.arm[1]).sqrt();
        let along = (load[0] * at.slope[0] + load[1] * at.slope[1]) * out.recip();
        let force = times(along, mid.frame.rolling);
        for i in 0..3 {
            resists[i] = resists[i] - force[i];
        }
        SlopeForce {
            force: along.value,
            work: (0..3).map(|i| force[i].value * x[i].value).sum(),
            torque: cross(mid.arm, force)[2].value,
        }
    }

    fn slip_of(&self, number: [f64; 5]) -> Slip {
        Slip {
            centre: [number[0], number[1]],
            turning: [number[2], number[3], number[4]],
        }
    }

    /// Directions t, q, n of the middle of the step, in space.
    pub fn directions(&self, [from, end]: [[f64; N_LENGTHS]; 2]) -> [[f64; 3]; 3] {
        let x: [Jet; N_LENGTHS] = std::array::from_fn(|i| Jet::constant(end[i]));
        let [start, last] = [self.start(&from), self.standing_at_end(&x)];
        self.middle(&start, &last, &x).frame.directions()
    }
}

/// A component of the normal force as it grows with l at the end.
pub(super) fn chain(value: f64, tangent: Meridian, reach: [Jet; 2]) -> Jet {
    let mut jet = reach[0] * tangent.radial + reach[1] * tangent.axial;
    jet.value = value;
    jet
}

/// Traction as it grows with slip and normal force.
fn actions(traction: &Resultant, slip: &SlipJets, (force, load): (f64, [Jet; 2])) -> [Jet; 5] {
    let grown = if force > 0.0 {
        load[0] * (load[0].value / force) + load[1] * (load[1].value / force)
    } else {
        Jet::default()
    };
    std::array::from_fn(|i| {
        let by_load = if force > 0.0 {
            traction.action[i] / force
        } else {
            0.0
        };
        let mut jet = grown * by_load;
        for (s, slope) in slip.slip.iter().zip(traction.slope[i]) {
            jet = jet + *s * slope;
        }
        jet.value = traction.action[i];
        jet
    })
}
