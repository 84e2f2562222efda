//! Radial force on the shaft at the scene's load point; off the groove plane it also tilts.
//!
//! F = value f(t) (cos d, sin d, 0), d its direction, which is fixed in space, and f the factor of its schedule.

use input::{ANGLE, FORCE, Problems, Quantity, RawSchedule, Schedule, check_schedule, schedule_of};
use serde::Deserialize;

use super::loads::{Loads, Now};
use super::rules::PeakLoad;
use super::table::{self, About, Context, Setting, SpeedRole, require_load};
use crate::error::DynamicsError;
use crate::model::{Effect, Model};

const EXAMPLE: &str = r#"[effects.radial_force]
value = "1 kN"          # negative points the other way
direction = "0 deg"     # azimuth, from +x towards +y, fixed in space
schedule.step = { at = "1 ms" }     # optional: its factor over time, as of axial_force
"#;

/// The table of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [effects.radial_force]")]
pub struct RadialForceTable {
    /// Size; negative points the other way.
    pub value: Quantity<FORCE>,
    /// Azimuth it points to, from +x towards +y.
    pub direction: Quantity<ANGLE>,
    schedule: Option<RawSchedule>,
}

impl table::EffectTable for RadialForceTable {
    fn about() -> About {
        About {
            name: "radial_force",
            example: EXAMPLE,
            speed: SpeedRole::None,
            needs: &[],
            trial: None,
        }
    }

    fn check(&self, context: Context, problems: &mut Problems) {
        let owner = "effects.radial_force";
        let schedule = check_schedule(self.schedule.as_ref(), owner, context.clock, problems);
        require_load(&self.value, &schedule, "effects.radial_force.value", problems);
    }

    fn load(&self, _setting: Setting<'_>) -> Result<Option<Box<dyn Effect>>, DynamicsError> {
        Ok(Some(Box::new(RadialForce {
            value: self.value.si(),
            direction: self.direction.si(),
            schedule: table::EffectTable::schedule(self),
        })))
    }

    fn peak_load(&self, _speed: f64) -> PeakLoad {
        PeakLoad {
            radial: self.value.si().abs() * table::EffectTable::schedule(self).peak(),
            ..PeakLoad::default()
        }
    }

    fn schedule(&self) -> Schedule {
        schedule_of(self.schedule.as_ref())
    }
}

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
        loads.add_shaft_force_at(model.load_point, [value * cos, value * sin, 0.0]);
        Ok(())
    }
}
