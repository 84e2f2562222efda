//! Axial force on the shaft, on the axis, so it has no moment.
//!
//! F = value f(t) e_z, f the factor of its schedule.

use input::{FORCE, Problems, Quantity, RawSchedule, Schedule, check_schedule, schedule_of};
use serde::Deserialize;

use super::loads::{Loads, Now};
use super::rules::PeakLoad;
use super::table::{self, About, Context, Setting, SpeedRole, require_load};
use crate::error::DynamicsError;
use crate::model::{Effect, Model};

const EXAMPLE: &str = r#"[effects.axial_force]
value = "2 kN"          # + presses the inner ring along +z into the balls (preload)
schedule.ramp = { start = "0 s", duration = "1 ms" }    # optional: its factor over time. from = 0, to = 1 if not given.
# schedule.step = { at = "1 ms" }       # before = 0, after = 1 if not given. At exactly its time it has happened.
# schedule.impact = { start = "1 ms", duration = "0.5 ms" }     # half sine with the peak 1, 0 before and after.
# schedule.harmonic = { frequency = "50 Hz", phase = "0 deg" }  # mean + amplitude sin(2 pi frequency t + phase).
                        # mean = 0, amplitude = 1 if not given.
# schedule.table = { times = ["0 s", "1 ms"], factors = [1, 0.5] }      # linear between the times, constant outside.
                        # A motion takes the means over its steps.
"#;

/// The table of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [effects.axial_force]")]
pub struct AxialForceTable {
    /// Force along +z.
    pub value: Quantity<FORCE>,
    schedule: Option<RawSchedule>,
}

impl table::EffectTable for AxialForceTable {
    fn about() -> About {
        About {
            name: "axial_force",
            example: EXAMPLE,
            speed: SpeedRole::None,
            needs: &[],
            trial: None,
        }
    }

    fn check(&self, context: Context, problems: &mut Problems) {
        let owner = "effects.axial_force";
        let schedule = check_schedule(self.schedule.as_ref(), owner, context.clock, problems);
        require_load(&self.value, &schedule, "effects.axial_force.value", problems);
    }

    fn load(&self, _setting: Setting<'_>) -> Result<Option<Box<dyn Effect>>, DynamicsError> {
        Ok(Some(Box::new(AxialForce {
            value: self.value.si(),
            schedule: table::EffectTable::schedule(self),
        })))
    }

    fn peak_load(&self, _speed: f64) -> PeakLoad {
        PeakLoad {
            axial: self.value.si().abs() * table::EffectTable::schedule(self).peak(),
            ..PeakLoad::default()
        }
    }

    fn schedule(&self) -> Schedule {
        schedule_of(self.schedule.as_ref())
    }
}

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
        loads.add_shaft_force_at(
            model.load_point,
            [0.0, 0.0, self.value * now.factor(&self.schedule)],
        );
        Ok(())
    }
}
