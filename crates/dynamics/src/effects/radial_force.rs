//! ```toml
//! [effects.radial_force]
//! value = "1 kN"
//! direction = "0 deg"     # azimuth, fixed in space
//! ```
//! A radial force on the shaft at the scene's load point; off the groove plane it also tilts. With a sub-table
//! `schedule` it changes in time.

use input::Schedule;

use super::{Effect, Loads, Now};
use crate::error::DynamicsError;
use crate::model::Model;

/// Radial force on the shaft.
pub struct RadialForce {
    /// Force, N.
    pub value: f64,
    /// Azimuth of its direction, rad.
    pub direction: f64,
    /// Factor of the force over time.
    pub schedule: Schedule,
}

impl Effect for RadialForce {
    fn name(&self) -> &'static str {
        "radial_force"
    }

    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        let (sin, cos) = self.direction.sin_cos();
        let value = self.value * now.factor(&self.schedule);
        loads.add_shaft_force(model, [value * cos, value * sin, 0.0]);
        Ok(())
    }
}
