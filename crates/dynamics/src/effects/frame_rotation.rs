//! ```toml
//! [effects.frame_rotation]        # needs [speed] and a flexible inner ring
//! ```
//! Inertia of the turning inner ring in its own frame: with the frame's speed W, acceleration A and u the displacement,
//!
//! ```text
//! f = rho [ W^2 (X + u)_xy  -  2 W e_z x u'  -  A e_z x (X + u) ]      per volume
//! ```
//!
//! centrifugal force with spin softening, Coriolis force, Euler force (e.g. Shabana, Dynamics of Multibody Systems, 4th ed.,
//! ch. 5). They are small against the stiffness (W dt ~ 1e-3), so they stay on the right-hand side of every step and are
//! iterated there; S keeps its one factor. Statics takes the centrifugal and Euler forces of the undeformed ring: the rest is
//! (W / first natural frequency)^2 of it.

use contact::Side;

use super::{Effect, FrameTurn, Loads, Now};
use crate::error::DynamicsError;
use crate::kinematics::Speed;
use crate::model::Model;
use ring::division::body_load;

/// Inertia of the inner ring's turning frame.
pub struct FrameRotation {
    /// Speed of the inner ring.
    pub speed: Speed,
}

impl Effect for FrameRotation {
    fn name(&self) -> &'static str {
        "frame_rotation"
    }

    fn turns_frame(&self) -> bool {
        true
    }

    fn add_loads(&self, _: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        loads.frame = Some(FrameTurn {
            speed: self.speed.at(now.time),
            acceleration: self.speed.rate(now.time),
        });
        Ok(())
    }
}

/// Inertia of the undeformed inner ring in its own frame, N, `[n_nodes][3]` flat: what statics sees of a turning frame. Collective.
pub fn static_inertia(model: &Model, loads: &Loads) -> Result<Option<Vec<f64>>, DynamicsError> {
    let (Some(turn), Some(ring)) = (loads.frame, model.ring(Side::Inner)) else {
        return Ok(None);
    };
    let density = ring.material.density;
    let (square, rate) = (turn.speed * turn.speed, turn.acceleration);
    let inertia =
        |[x, y, _]: [f64; 3]| [square * x + rate * y, square * y - rate * x, 0.0].map(|f| density * f);
    let load = body_load(ring, Side::Inner.name(), model.backend, inertia)?;
    Ok(Some(load))
}
