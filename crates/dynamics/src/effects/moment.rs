//! Tilting moment on the shaft; right-hand rule about +x and +y.

use input::{MOMENT, Problems, Quantity, RawSchedule, Schedule, check_schedule, schedule_of};
use serde::Deserialize;

use super::loads::{Loads, Now};
use super::table::{self, About, Context, Setting, SpeedRole, require_load};
use crate::error::DynamicsError;
use crate::model::{Effect, Model};

const EXAMPLE: &str = r#"[effects.moment]
x = "3 N m"
y = "0 N m"
schedule.harmonic = { frequency = "50 Hz" }     # optional: its factor over time, as of axial_force
"#;

/// The table of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [effects.moment]")]
pub struct MomentTable {
    /// Moment about x.
    pub x: Quantity<MOMENT>,
    /// Moment about y.
    pub y: Quantity<MOMENT>,
    schedule: Option<RawSchedule>,
}

impl table::EffectTable for MomentTable {
    fn about() -> About {
        About {
            name: "moment",
            example: EXAMPLE,
            speed: SpeedRole::None,
            needs: &[],
            trial: None,
        }
    }

    fn check(&self, context: Context, problems: &mut Problems) {
        let owner = "effects.moment";
        let schedule = check_schedule(self.schedule.as_ref(), owner, context.clock, problems);
        require_load(&self.x, &schedule, "effects.moment.x", problems);
        require_load(&self.y, &schedule, "effects.moment.y", problems);
    }

    fn load(&self, _setting: Setting<'_>) -> Result<Option<Box<dyn Effect>>, DynamicsError> {
        Ok(Some(Box::new(Moment {
            value: [self.x.si(), self.y.si()],
            schedule: table::EffectTable::schedule(self),
        })))
    }

    fn schedule(&self) -> Schedule {
        schedule_of(self.schedule.as_ref())
    }
}

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
