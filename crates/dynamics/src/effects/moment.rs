//! ```toml
//! [effects.moment]
//! x = "3 N m"
//! y = "0 N m"
//! ```
//! A tilting moment on the shaft; right-hand rule about +x and +y.

use super::{Effect, Loads, Now};
use crate::error::DynamicsError;
use crate::model::Model;

/// Tilting moment on the shaft.
pub struct Moment {
    /// Moment about x and y, N m.
    pub value: [f64; 2],
}

impl Effect for Moment {
    fn name(&self) -> &'static str {
        "moment"
    }

    fn add_loads(&self, _model: &Model, _now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        loads.shaft[3] += self.value[0];
        loads.shaft[4] += self.value[1];
        Ok(())
    }
}
