//! Preload by a spring: the outer ring slides in its seat along the axis, and a spring between it and the housing
//! presses it along -z against the balls.
//!
//! ```text
//! F = F0 + k u          u the displacement of the seat along +z, where the balls push it
//! V = F0 u + k u^2 / 2
//! ```
//!
//! In balance the axial force of the balls on the outer ring is F, whatever the position of the shaft: a bearing with a
//! soft spring keeps its preload when the shaft grows. The seat slides without friction and does not tilt. A flexible
//! outer ring brings its own mass; that of a rigid one, and of a sleeve or washer that slides with the ring, is `mass`.
//! Without any the seat has no inertia and follows the forces at once. Gravity acts on `mass` as on a flexible ring.
//!
//! Something must hold the axis: a shaft whose z is locked or prescribed, or a spring with stiffness against a load on
//! the shaft. Two forces alone, F0 and an axial force on a free shaft, leave its place open, which is an error.
//!
//! Ledger: the spring is a load, its work -V stands in `load_work`. Output: `shaft.csv` has u as `outer_seat_z_m`.

use input::{FORCE, MASS, Problems, Quantity, STIFFNESS};
use serde::Deserialize;

use super::loads::{Loads, Now};
use super::rules::PeakLoad;
use super::table::{self, About, Context, Setting, SpeedRole};
use crate::error::DynamicsError;
use crate::interactions::seat_spring::Seat;
use crate::model::{Effect, Model};

const EXAMPLE: &str = r#"[effects.spring_preload]        # the outer ring slides along the axis
force = "300 N"                 # presses it along -z against the balls, at zero displacement of the ring
stiffness = "200 N/mm"          # optional: of the spring; default 0, a constant force
mass = "50 g"                   # optional: what slides besides a flexible ring; default 0
"#;

/// A larger force is a slip of the unit, N.
const MAX_FORCE: f64 = 1e9;
/// So is a larger stiffness, N/m,
const MAX_STIFFNESS: f64 = 1e12;
/// and a larger mass, kg.
const MAX_MASS: f64 = 1e5;

/// The table of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [effects.spring_preload]")]
pub struct SpringPreloadTable {
    force: Quantity<FORCE>,
    stiffness: Option<Quantity<STIFFNESS>>,
    mass: Option<Quantity<MASS>>,
}

impl SpringPreloadTable {
    /// Mass of what slides besides a flexible ring, kg.
    pub fn mass(&self) -> f64 {
        self.mass.as_ref().map_or(0.0, Quantity::si)
    }
}

impl table::EffectTable for SpringPreloadTable {
    fn about() -> About {
        About {
            name: "spring_preload",
            example: EXAMPLE,
            speed: SpeedRole::None,
            needs: &[],
            trial: None,
        }
    }

    fn check(&self, _context: Context, problems: &mut Problems) {
        let force = self.force.si();
        problems.require(
            force > 0.0 && force <= MAX_FORCE,
            "effects.spring_preload.force",
            &self.force,
            "expected more than 0 and at most 1e9 N: the spring presses the outer ring along -z against the balls",
        );
        if let Some(stiffness) = &self.stiffness {
            problems.require(
                (0.0..=MAX_STIFFNESS).contains(&stiffness.si()),
                "effects.spring_preload.stiffness",
                stiffness,
                "expected 0 to 1e12 N/m; 0 is a constant force",
            );
        }
        if let Some(mass) = &self.mass {
            problems.require(
                (0.0..=MAX_MASS).contains(&mass.si()),
                "effects.spring_preload.mass",
                mass,
                "expected 0 to 1e5 kg, check its unit",
            );
        }
    }

    fn load(&self, _setting: Setting<'_>) -> Result<Option<Box<dyn Effect>>, DynamicsError> {
        Ok(Some(Box::new(SpringPreload {
            seat: Seat {
                mass: self.mass(),
                force: self.force.si(),
                stiffness: self.stiffness.as_ref().map_or(0.0, Quantity::si),
            },
        })))
    }

    fn peak_load(&self, _speed: f64) -> PeakLoad {
        PeakLoad {
            spring: self.force.si(),
            ..PeakLoad::default()
        }
    }
}

/// A spring that presses the outer ring along -z.
pub struct SpringPreload {
    /// The seat that slides, and its spring.
    pub seat: Seat,
}

impl Effect for SpringPreload {
    fn name(&self) -> &'static str {
        "spring_preload"
    }

    fn add_loads(&self, _model: &Model, _now: &Now, _loads: &mut Loads) -> Result<(), DynamicsError> {
        Ok(())
    }

    fn seat(&self) -> Option<Seat> {
        Some(self.seat)
    }
}
