//! ```toml
//! [effects.moment]
//! x = "3 N m"
//! y = "0 N m"
//! ```
//! A tilting moment on the shaft; right-hand rule about +x and +y. With a sub-table `schedule` it changes in time.

use input::Schedule;

use super::{Effect, Loads, Now};
use crate::error::DynamicsError;
use crate::model::Model;

/// Tilting moment on the shaft.
pub struct Moment {
    /// Moment about x and y, N m.
    pub value: [f64; 2],
    /// Its factor over time.
    pub schedule: Schedule,
}

impl Effect for Moment {
    fn name(&self) -> &'static str {
        "moment"
    }

    fn add_loads(&self, _model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        let factor = now.factor(&self.schedule);
        loads.shaft[3] += factor * self.value[0];
        loads.shaft[4] += factor * self.value[1];
        Ok(())
    }
}
