//! ```toml
//! [effects.ball_centrifugal]      # needs [speed]
//! ```
//! Centrifugal force of the balls, m omega_c^2 r, omega_c the cage's speed: it presses balls outwards, so the outer contact
//! angle falls and the inner one rises. The force grows with the ball's radial displacement.

use super::{Effect, Loads, Now};
use crate::error::DynamicsError;
use crate::model::Model;
use crate::motion::balls::{Kinematics, Speed};

/// Centrifugal force of the balls.
pub struct BallCentrifugal {
    /// Speed of the inner ring.
    pub speed: Speed,
    /// Slip ratios at the inner and outer raceway.
    pub slip: [f64; 2],
}

impl Effect for BallCentrifugal {
    fn name(&self) -> &'static str {
        "ball_centrifugal"
    }

    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        let cage = Kinematics::new(&model.geometry, self.slip).cage * self.speed.at(now.time);
        let slope = model.ball_mass() * cage * cage;
        let radius = model.geometry.ball_centre()[0];
        loads.balls.iter_mut().for_each(|f| f[0] += slope * radius);
        loads.ball_slope += slope;
        Ok(())
    }
}
