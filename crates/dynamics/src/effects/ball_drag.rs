//! Drag of oil and air on free balls.
//!
//! F = -1/2 rho C_d pi r^2 |v| v on the centre of a ball, v its velocity in space and rho the effective density of the
//! mixture in the bearing (e.g. Harris, 4th ed., chapter 14). Over a step v is the mean velocity, so that the drag only
//! takes energy. Turning balls feel no moment of it.
//!
//! Rule of thumb: the drag of a ball that rolls over the friction, mu Q at 0.07, that its inner contact has.

use input::{DENSITY, Problems, Quantity};
use serde::Deserialize;

use super::loads::{Loads, Now};
use super::rules::{Case, Remark, judge, newtons, share_of};
use super::table::{self, About, Context, Setting, SpeedRole};
use crate::error::DynamicsError;
use crate::kinematics::BothRings;
use crate::model::{Effect, Model};

const EXAMPLE: &str = r#"[effects.ball_drag]             # needs [balls] with motion = "free"
coefficient = 0.5               # drag coefficient of a ball, on its cross-section
density = "20 kg/m3"            # effective density of oil and air in the bearing
"#;

/// A coefficient of friction to compare with.
const USUAL_FRICTION: f64 = 0.07;
/// A drag coefficient beyond this is a slip of the finger: a ball has 0.4 to 1.
const MOST_COEFFICIENT: f64 = 1e3;

/// The table of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [effects.ball_drag]")]
pub struct BallDragTable {
    coefficient: f64,
    density: Quantity<DENSITY>,
}

impl table::EffectTable for BallDragTable {
    fn about() -> About {
        About {
            name: "ball_drag",
            example: EXAMPLE,
            speed: SpeedRole::None,
            needs: &[],
            // It comes with another kind of balls, which is not varied.
            trial: None,
        }
    }

    fn advice(table: Option<&Self>, case: &Case<'_>) -> Vec<Remark> {
        let (Some(table), load) = (table, case.ball_load()) else {
            return Vec::new();
        };
        if load == 0.0 {
            return Vec::new();
        }
        let turning = case.kinematics();
        let size = |speeds: BothRings| turning.of_cage(speeds).abs();
        let speed = case.model.geometry.ball_centre().radial * size(case.speeds.at_largest(size));
        let force = table.drag().coefficient(case.model) * speed * speed;
        let ratio = force / (USUAL_FRICTION * load);
        let estimate = format!(
            "the drag of a ball, {force:.3} N, is {} of about {}",
            share_of(ratio, "the friction of its load"),
            newtons(load)
        );
        judge("ball_drag", true, ratio, &estimate)
    }

    fn check(&self, _context: Context, problems: &mut Problems) {
        problems.require(
            (0.0..=MOST_COEFFICIENT).contains(&self.coefficient),
            "effects.ball_drag.coefficient",
            self.coefficient,
            "expected 0 to 1000, a ball has 0.4 to 1",
        );
        problems.require(
            self.density.si() >= 0.0,
            "effects.ball_drag.density",
            &self.density,
            "a density cannot be negative",
        );
    }

    fn load(&self, _setting: Setting<'_>) -> Result<Option<Box<dyn Effect>>, DynamicsError> {
        Ok(Some(Box::new(self.drag())))
    }
}

impl BallDragTable {
    fn drag(&self) -> BallDrag {
        BallDrag {
            pressure: 0.5 * self.density.si() * self.coefficient,
        }
    }
}

/// Drag on free balls.
pub struct BallDrag {
    /// 1/2 rho C_d, kg/m^3.
    pub pressure: f64,
}

impl BallDrag {
    /// Force over the square of the speed, N s^2/m^2.
    pub fn coefficient(&self, model: &Model) -> f64 {
        self.pressure * std::f64::consts::FRAC_PI_4 * model.geometry.ball_diameter.powi(2)
    }
}

impl Effect for BallDrag {
    fn name(&self) -> &'static str {
        "ball_drag"
    }

    fn add_loads(&self, _model: &Model, _now: &Now, _loads: &mut Loads) -> Result<(), DynamicsError> {
        // It follows the velocity of a ball, inside its own balance.
        Ok(())
    }

    fn drag(&self, model: &Model) -> f64 {
        self.coefficient(model)
    }
}
