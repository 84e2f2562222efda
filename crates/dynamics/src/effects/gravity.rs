//! ```toml
//! [effects.gravity]
//! acceleration = "9.81 m/s2"
//! direction = [0.0, -1.0, 0.0]
//! ```
//! Weight of the balls (in their meridian planes; the cage carries the rest), of flexible rings and of the shaft's
//! own mass, which acts at the load point. With a sub-table `schedule` its size changes in time.

use contact::Side;

use super::{Effect, Loads, Now};
use crate::error::DynamicsError;
use crate::model::Model;
use crate::schedule::Schedule;

/// Uniform gravity.
pub struct Gravity {
    /// Acceleration, m/s^2.
    pub acceleration: [f64; 3],
    /// Its factor over time.
    pub schedule: Schedule,
}

impl Effect for Gravity {
    fn name(&self) -> &'static str {
        "gravity"
    }

    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        let factor = self.schedule.at(now.time);
        let g = self.acceleration.map(|a| factor * a);
        let mass = model.ball_mass();
        for (ball, load) in loads.balls.iter_mut().enumerate() {
            let (sin, cos) = (model.geometry.azimuth(ball) + now.cage_angle).sin_cos();
            load[0] += mass * (g[0] * cos + g[1] * sin);
            load[1] += mass * g[2];
        }
        loads.add_shaft_force(model, g.map(|a| model.shaft_mass * a));
        for side in Side::BOTH {
            if let Some(ring) = model.ring(side) {
                let weight = g.map(|a| ring.material.density * a);
                let load =
                    fem::loads::body_load(&ring.mesh, |_| weight).map_err(|source| DynamicsError::Fem {
                        side: side.name(),
                        source,
                    })?;
                loads.add_ring_load(model, side, load);
            }
        }
        Ok(())
    }
}
