//! ```toml
//! [effects.axial_force]
//! value = "2 kN"      # + presses the inner ring along +z into the balls (preload)
//! ```
//! An axial force on the shaft. On the axis, so it has no moment. With a sub-table `schedule` it changes in time.

use input::Schedule;

use super::{Effect, Loads, Now};
use crate::error::DynamicsError;
use crate::model::Model;

/// Axial force on the shaft.
pub struct AxialForce {
    /// Force along +z, N.
    pub value: f64,
    /// Its factor over time.
    pub schedule: Schedule,
}

impl Effect for AxialForce {
    fn name(&self) -> &'static str {
        "axial_force"
    }

    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        loads.add_shaft_force(model, [0.0, 0.0, self.value * now.factor(&self.schedule)]);
        Ok(())
    }
}
