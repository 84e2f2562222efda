//! ```toml
//! [effects.gravity]
//! acceleration = "9.81 m/s2"
//! direction = [0.0, -1.0, 0.0]
//! ```
//! Weight of the balls (in their meridian planes; the cage carries the rest), of flexible rings and of the shaft's
//! own mass, which acts at the load point. With a sub-table `schedule` its size changes in time.
//!
//! The weight of a ring is its nodal masses, the integrals of rho N_a over the ring, times the acceleration: they are
//! integrated once per ring, so an instant costs one pass over the nodes. Memory: 8 bytes per node.

use std::sync::Arc;

use contact::Side;
use input::Schedule;

use super::{Effect, Loads, Now};
use crate::error::DynamicsError;
use crate::model::Model;
use ring::{NodeMasses, RingError, RingModel};

/// Uniform gravity.
pub struct Gravity {
    /// Acceleration, m/s^2.
    acceleration: [f64; 3],
    /// Its factor over time.
    schedule: Schedule,
    /// Nodal masses of the flexible rings; None is a rigid ring.
    node_masses: [Option<Arc<NodeMasses>>; 2],
}

impl Gravity {
    /// Gravity of an acceleration (m/s^2) and its schedule on a bearing with the given flexible rings.
    pub fn new(
        acceleration: [f64; 3],
        schedule: Schedule,
        rings: &[Option<Arc<RingModel>>; 2],
    ) -> Result<Gravity, DynamicsError> {
        let masses = |side: Side| {
            let masses = |ring: &Arc<RingModel>| {
                let side = side.name();
                ring.node_masses()
                    .map_err(|source| RingError::Fem { side, source })
            };
            rings[side.index()].as_ref().map(masses).transpose()
        };
        Ok(Gravity {
            acceleration,
            schedule,
            node_masses: [masses(Side::Inner)?, masses(Side::Outer)?],
        })
    }
}

impl Effect for Gravity {
    fn name(&self) -> &'static str {
        "gravity"
    }

    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        let factor = now.factor(&self.schedule);
        let g = self.acceleration.map(|a| factor * a);
        let mass = model.ball_mass();
        for (ball, load) in loads.balls.iter_mut().enumerate() {
            let (sin, cos) = (model.geometry.azimuth(ball) + now.cage_angle).sin_cos();
            load[0] += mass * (g[0] * cos + g[1] * sin);
            load[1] += mass * g[2];
        }
        loads.add_shaft_force(model, g.map(|a| model.shaft_mass * a));
        for side in Side::BOTH {
            let (Some(ring), Some(of_ring)) = (model.ring(side), &self.node_masses[side.index()]) else {
                continue;
            };
            let NodeMasses {
                masses,
                total,
                moment,
            } = &**of_ring;
            let weights = masses.iter().flat_map(|m| g.map(|a| m * a));
            // Moment of all weights about the shaft's origin: that of the mass moment.
            let [x, y, z] = [moment[0], moment[1], moment[2] - total * ring.groove.centre_z];
            let about_x = y * g[2] - z * g[1];
            let about_y = z * g[0] - x * g[2];
            let resultant = [total * g[0], total * g[1], total * g[2], about_x, about_y];
            loads.add_ring_load(side, weights.collect(), resultant);
        }
        Ok(())
    }
}
