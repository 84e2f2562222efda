//! What is reported of a state: shaft, balls, ring displacements.

use std::borrow::Cow;

use body::BodyLoad;
use contact::patch_shape::PatchShape;
use contact::{LoadedPatch, Meridian, Side};

use super::free_state::FreeState;
use super::place::Course;
use super::run::{Motion, MovingRing};
use super::state::MotionState;
use crate::balls::{BallResult, CageResult, ContactResult, FreeBallResult, Friction, TractionResult};
use crate::effects::Now;
use crate::error::DynamicsError;
use crate::footprint::on_groove;
use crate::interactions::carried_site::across_on_ball;
use crate::interactions::traction::largest_pv;
use ring::rigid::RigidInertia;
use ring::{ElasticBody, RingState};

impl Motion<'_> {
    /// Results of every ball: mean forces of the last step, angles and approaches at its end.
    pub fn balls(&self, state: &MotionState) -> Vec<BallResult> {
        let contact = |ball: usize, side: Side| {
            let index = 2 * ball + side.index();
            let force = state.forces[index].norm();
            let hertz = &self.model.hertz[side.index()];
            let semi_axes = hertz.semi_axes(force);
            let bearing = self.strip_bearing(state, (ball, side), force);
            let peak = bearing.as_ref().map_or(1.0, |bearing| bearing.peak);
            ContactResult {
                force_n: force,
                contact_angle_rad: state.angles[index],
                approach_m: state.approaches[index],
                semi_axes_m: semi_axes,
                peak_pressure_pa: peak * hertz.peak_pressure(force),
                ellipse: bearing.map(|bearing| bearing.kind),
            }
        };
        let turn = 2.0 * std::f64::consts::PI;
        let ball = |b: usize| {
            let [inner, outer] = Side::BOTH.map(|side| contact(b, side));
            BallResult {
                azimuth_rad: self.azimuth_now(state, b).rem_euclid(turn),
                inner,
                outer,
                displacement_m: state.balls[b],
                across_n: self.across(state, b),
                free: state.free.as_ref().map(|free| self.free_result(state, free, b)),
            }
        };
        (0..self.model.geometry.n_balls).map(ball).collect()
    }

    /// Force on a ball of the kinematic cage across its meridian plane, N.
    fn across(&self, state: &MotionState, ball: usize) -> Option<f64> {
        let azimuth = self.azimuth_now(state, ball);
        let found = across_on_ball(self.model, azimuth, &state.shaft, state.forces[2 * ball]);
        found.filter(|_| state.free.is_none())
    }

    /// What a free ball has besides.
    fn free_result(&self, state: &MotionState, free: &FreeState, ball: usize) -> FreeBallResult {
        let contact = |side: Side| {
            let index = 2 * ball + side.index();
            let (of, force) = (&free.contacts[index], state.forces[index].norm());
            let [f_t, f_q, moment @ ..] = of.action;
            let ellipse = self.model.ellipse(side, force);
            let bearing = self.strip_bearing(state, (ball, side), force);
            let lines = bearing.map(|bearing| bearing.lines).unwrap_or_default();
            TractionResult {
                slip_m_per_s: of.slip.centre,
                spin_rad_per_s: of.slip.turning[2],
                traction_n: [f_t, f_q],
                traction_moment_n_m: moment,
                slope_force_n: free.track.get(index).map(|track| track[0]),
                slope_moment_n_m: free.track.get(index).map(|[_, moment @ ..]| *moment),
                pv_w_per_m2: largest_pv(&ellipse, &lines, &of.slip),
                friction_power_w: of.power,
            }
        };
        FreeBallResult {
            inner: contact(Side::Inner),
            outer: contact(Side::Outer),
            omega_rad_per_s: free.turnings[ball],
            orbit_rad_per_s: free.orbit(ball),
        }
    }

    /// Azimuth of a ball in a state, rad.
    pub(super) fn azimuth_now(&self, state: &MotionState, ball: usize) -> f64 {
        match &state.free {
            Some(free) => free.azimuth(ball),
            None => self.ball_azimuth(ball, self.time(state.step)),
        }
    }

    /// Torques with which all balls and a cage on its land brake the rings, N m, positive against a ring that turns
    /// positively; power lost at all contacts with raceways, W; mean speed of the balls round the axis and that of pure
    /// rolling, rad/s. None where balls are not free.
    pub fn friction(&self, state: &MotionState) -> Option<Friction> {
        let free = state.free.as_ref()?;
        let n = free.places.len();
        let torque = |side: Side| {
            let contacts = free.contacts.iter().skip(side.index()).step_by(2);
            contacts.map(|contact| contact.torque).sum::<f64>() + self.land_torque(free, side)
        };
        let [torque_n_m, outer_torque_n_m] = Side::BOTH.map(torque);
        Some(Friction {
            torque_n_m,
            outer_torque_n_m,
            power_w: free.contacts.iter().map(|contact| contact.power).sum(),
            cage_speed_rad_per_s: (0..n).map(|ball| free.orbit(ball)).sum::<f64>() / n as f64,
            kinematic_cage_speed_rad_per_s: self.kinematic_cage_speed(state),
        })
    }

    /// Speed of a cage of pure rolling at the free contact angle, rad/s.
    fn kinematic_cage_speed(&self, state: &MotionState) -> f64 {
        self.kinematics
            .cage_speed(&self.settings.speeds, self.time(state.step))
    }

    /// Torque with which a cage brakes a ring on its land, N m.
    fn land_torque(&self, free: &FreeState, side: Side) -> f64 {
        let land = self.model.cage.as_ref().and_then(|cage| cage.land);
        match (land, &free.cage) {
            (Some(land), Some(cage)) if land.side == side => cage.torques[1],
            _ => 0.0,
        }
    }

    /// The cage; None where there is no free one.
    pub fn cage(&self, state: &MotionState) -> Option<CageResult> {
        let cage = state.free.as_ref()?.cage.as_ref()?;
        let [x, y, z, tilt_x, tilt_y, turn_rad] = cage.place;
        let land = |end: usize| cage.lands.get(end).copied().unwrap_or_default();
        Some(CageResult {
            position_m: [x, y, z],
            tilt_rad: [tilt_x, tilt_y],
            turn_rad,
            speed_rad_per_s: cage.rates[5],
            kinematic_speed_rad_per_s: self.kinematic_cage_speed(state),
            pocket_forces_n: cage.pockets.clone(),
            land_forces_n: [land(0), land(1)],
            torques_n_m: cage.torques,
        })
    }

    /// Contact forces on a flexible ring at the end of the last step, and the patches over which they are spread, by
    /// ball, with azimuths in the ring's frame; empty for a rigid ring. Forces are means over the step.
    pub fn patches(&self, state: &MotionState, side: Side) -> Result<Vec<LoadedPatch>, DynamicsError> {
        let Some(moving) = &self.rings[side.index()] else {
            return Ok(Vec::new());
        };
        let (time, hertz) = (self.time(state.step), &self.model.hertz[side.index()]);
        let patch = |ball: usize| {
            let index = 2 * ball + side.index();
            let force = state.forces[index].norm();
            let azimuth = self.azimuth_now(state, ball) - self.frame_angle(side, time);
            let place = state.places[0][index];
            let least = self.model.contact.least_patch;
            let patch_angle = on_groove(&moving.raceway.surface, place.angle, force > 0.0);
            let shape = PatchShape::new(
                &moving.raceway.surface,
                azimuth,
                patch_angle,
                hertz.semi_axes(place.force),
                least,
            )?;
            Ok(LoadedPatch {
                azimuth,
                force,
                angle: state.angles[index],
                semi_axes: hertz.semi_axes(force),
                patch_angle,
                patch_axes: shape.semi_axes,
            })
        };
        (0..self.model.geometry.n_balls).map(patch).collect()
    }

    /// Angle by which the frame of a ring is turned in space, rad.
    pub fn angle_of_frame(&self, state: &MotionState, side: Side) -> f64 {
        self.frame_angle(side, self.time(state.step))
    }

    /// Load on all of the body of a ring at the time of a state, in the frame of the ring; None where it takes none.
    pub fn body_load(&self, state: &MotionState, side: Side) -> Option<BodyLoad> {
        let time = self.time(state.step);
        let now = Now {
            time,
            cage_angle: self.cage_angle(time),
            ..Now::default()
        };
        self.model.body_load(side, &now, self.frame_angle(side, time))
    }

    /// A state for results, of whose rings rank 0 has all: of rings whose vectors ranks divide, others keep their own
    /// part. Collective.
    pub fn gathered<'s>(&self, state: &'s MotionState) -> Cow<'s, MotionState> {
        let is_divided = |moving: &MovingRing| moving.body.is_divided();
        if !self.rings.iter().flatten().any(is_divided) {
            return Cow::Borrowed(state);
        }
        Cow::Owned(self.with_rings(state.clone(), |body, ring| body.state_to_root(ring)))
    }

    /// This rank's part of a state of which each rank has all.
    pub fn own(&self, whole: MotionState) -> MotionState {
        self.with_rings(whole, |body, ring| body.own_state(ring))
    }

    fn with_rings(
        &self,
        mut state: MotionState,
        of: impl Fn(&dyn ElasticBody, RingState) -> RingState,
    ) -> MotionState {
        for (ring, moving) in state.rings.iter_mut().zip(&self.rings) {
            let both = ring.take().zip(moving.as_ref());
            *ring = both.map(|(ring, moving)| of(&**moving.body, ring));
        }
        state
    }

    /// Total nodal displacement of a flexible ring in its own frame, m, `[n_nodes][3]` flat, and the angle by which
    /// that frame is turned in space, rad; of a state that [`Motion::gathered`] gives.
    pub fn ring_displacement(&self, state: &MotionState, side: Side) -> Option<(Vec<f64>, f64)> {
        let moving = self.rings[side.index()].as_ref()?;
        let ring = state.rings[side.index()].as_ref()?;
        Some((
            moving.body.nodal_of_whole(ring.displacement()),
            self.angle_of_frame(state, side),
        ))
    }

    /// The same at the chosen nodes; others may be NaN. Of a periodic ring only these are transformed.
    pub fn ring_displacement_at(
        &self,
        state: &MotionState,
        side: Side,
        nodes: &[usize],
    ) -> Option<(Vec<f64>, f64)> {
        let moving = self.rings[side.index()].as_ref()?;
        let ring = state.rings[side.index()].as_ref()?;
        let turned = self.frame_angle(side, self.time(state.step));
        Some((moving.body.nodal_at(ring.displacement(), nodes), turned))
    }

    /// Acceleration of the chosen nodes of a flexible ring in its own frame, m/s^2, `[n_nodes][3]` flat; others may be
    /// NaN.
    pub fn ring_acceleration_at(&self, state: &MotionState, side: Side, nodes: &[usize]) -> Option<Vec<f64>> {
        let moving = self.rings[side.index()].as_ref()?;
        let ring = state.rings[side.index()].as_ref()?;
        Some(moving.body.nodal_at(ring.acceleration(), nodes))
    }

    /// Displacement, velocity and acceleration of the coordinates of a flexible ring, `[n]`, SI, whatever solves it.
    /// Collective.
    pub fn ring_coordinates(&self, state: &MotionState, side: Side) -> Option<[Vec<f64>; 3]> {
        let moving = self.rings[side.index()].as_ref()?;
        let ring = state.rings[side.index()].as_ref()?;
        let parts = [ring.displacement(), ring.velocity(), ring.acceleration()];
        Some(parts.map(|x| moving.body.coordinates(x)))
    }

    /// Linear momentum, kg m/s, and moment of momentum about the groove's centre on the axis, kg m^2/s, of a flexible
    /// ring in its own frame. Collective.
    pub fn ring_momentum(&self, state: &MotionState, side: Side) -> Option<[[f64; 3]; 2]> {
        let moving = self.rings[side.index()].as_ref()?;
        Some(moving.body.momentum(state.rings[side.index()].as_ref()?))
    }

    /// Mean motion of the groove centre under a ball over a step of one part, m, measured by the
    /// patch of that step; zero on a rigid ring. Collective.
    pub fn groove_motion(
        &self,
        from: &MotionState,
        to: &MotionState,
        ball: usize,
        side: Side,
    ) -> Result<Meridian, DynamicsError> {
        let share = 1.0 - self.settings.integrator.alpha_f;
        let time = self.time(from.step) + share * self.settings.dt;
        let course = Course {
            time,
            azimuths: (0..self.n_balls())
                .map(|ball| self.ball_azimuth(ball, time))
                .collect(),
            is_free: false,
            passed: None,
            start: time,
            end: time,
        };
        let feet = self.place(&to.places[0], &course)?.feet;
        let i = side.index();
        let (Some(moving), Some(old), Some(new)) = (&self.rings[i], &from.rings[i], &to.rings[i]) else {
            return Ok(Meridian::default());
        };
        let measure = |ring: &RingState| {
            let field = moving.body.nodal(ring.displacement());
            Meridian::from(feet[i][ball].measure(&field))
        };
        Ok((measure(old) + measure(new)).map(|sum| 0.5 * sum))
    }

    /// Inertia of a flexible ring as a rigid body about the centre of its groove circle; None for a rigid one.
    /// Collective.
    pub fn rigid_inertia(&self, side: Side) -> Option<RigidInertia> {
        Some(self.rings[side.index()].as_ref()?.body.rigid_inertia())
    }

    /// Speed of every ball's rotation about its own axis relative to the cage, rad/s; None when the bearing never
    /// turns, and where each ball has its own.
    pub fn spin(&self, state: &MotionState) -> Option<f64> {
        let speeds = &self.settings.speeds;
        (!speeds.is_zero() && state.free.is_none())
            .then(|| self.kinematics.spin(speeds, self.time(state.step)))
    }
}
