//! ```toml
//! [effects.radial_force]
//! value = "1 kN"
//! direction = "0 deg"     # azimuth, fixed in space
//! ```
//! A radial force on the shaft at the scene's load point; off the groove plane it also tilts.

use super::{Effect, Loads, Now};
use crate::error::DynamicsError;
use crate::model::Model;

/// Radial force on the shaft.
pub struct RadialForce {
    /// Force, N.
    pub value: f64,
    /// Azimuth of its direction, rad.
    pub direction: f64,
}

impl Effect for RadialForce {
    fn name(&self) -> &'static str {
        "radial_force"
    }

    fn add_loads(&self, model: &Model, _now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        let (sin, cos) = self.direction.sin_cos();
        loads.add_shaft_force(model, [self.value * cos, self.value * sin, 0.0]);
        Ok(())
    }
}
