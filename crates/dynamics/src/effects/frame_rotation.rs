//! Inertia of turning rings in their own frames.
//!
//! With the frame's speed W, acceleration A and u the displacement,
//!
//! ```text
//! f = rho [ W^2 (X + u)_xy  -  2 W e_z x u'  -  A e_z x (X + u) ]      per volume
//! ```
//!
//! centrifugal force with spin softening, Coriolis force, Euler force (e.g. Shabana, Dynamics of Multibody Systems,
//! 4th ed., ch. 5). They are small against the stiffness (W dt ~ 1e-3), so they stay on the right-hand side of
//! every step and are iterated there; S keeps its one factor. Statics takes the centrifugal and Euler forces of the
//! undeformed rings: the rest is (W / first natural frequency)^2 of it.
//!
//! Rule of thumb: growth u of the turning ring over the Hertz approach; u = rho omega^2 r^3 / E of a free ring, rho
//! omega^2 r t^2 / (2 E) of one of thickness t on a solid shaft (Timoshenko, Strength of Materials II, thin turning
//! ring).

use contact::Side;
use serde::Deserialize;

use super::loads::{FrameTurn, Loads, Now};
use super::rules::{Case, judge, percent};
use super::table::{self, About, Need, Setting, SpeedRole, Trial};
use crate::error::DynamicsError;
use crate::kinematics::RingSpeeds;
use crate::model::{Effect, Model};
use ring::Hold;
use ring::division::body_load;

const EXAMPLE: &str = "[effects.frame_rotation]        # needs [speed] and a flexible ring that turns\n";

/// The table of a scene: it has no keys.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the empty table [effects.frame_rotation]")]
pub struct FrameRotationTable {}

impl table::EffectTable for FrameRotationTable {
    fn about() -> About {
        About {
            name: "frame_rotation",
            example: EXAMPLE,
            speed: SpeedRole::Force,
            needs: &[Need::FlexibleTurning],
            trial: Some(Trial { what: "", keys: &[] }),
        }
    }

    fn advice(table: Option<&Self>, case: &Case<'_>) -> Vec<String> {
        if case.ball_load() == 0.0 {
            return Vec::new();
        }
        let growths = Side::BOTH
            .into_iter()
            .filter_map(|side| Some((side, growth(case, side)?)));
        let Some((side, (growth, formula))) = growths.reduce(|a, b| if b.1.0 > a.1.0 { b } else { a }) else {
            return Vec::new();
        };
        let approach = case.approach();
        let ratio = growth * case.contact_angle().cos() / approach;
        let estimate = format!(
            "the turning {} ring grows by {formula} = {:.4} um, {} of the Hertz approach of about {:.2} um",
            side.name(),
            1e6 * growth,
            percent(ratio),
            1e6 * approach
        );
        judge("frame_rotation", table.is_some(), ratio, &estimate)
    }

    fn load(&self, setting: Setting<'_>) -> Result<Option<Box<dyn Effect>>, DynamicsError> {
        let speeds = setting.speeds.clone();
        Ok(Some(Box::new(FrameRotation { speeds })))
    }
}

/// Growth of the raceway of a flexible ring at its largest speed, m, and its formula.
fn growth(case: &Case<'_>, side: Side) -> Option<(f64, &'static str)> {
    let ring = case.model.ring(side)?;
    let (speed, steel) = (case.speed(side), &case.ring_steel);
    let (radius, held) = case.radii(side);
    let square = steel.density * speed * speed * radius / steel.young_modulus;
    Some(match ring.hold {
        Hold::Clamped => (
            0.5 * square * (radius - held).powi(2),
            "rho omega^2 r t^2 / (2 E)",
        ),
        Hold::MeanMotion | Hold::Free => (square * radius * radius, "rho omega^2 r^3 / E"),
    })
}

/// Inertia of the turning frames of flexible rings.
pub struct FrameRotation {
    /// Speeds of the rings.
    pub speeds: RingSpeeds,
}

impl Effect for FrameRotation {
    fn name(&self) -> &'static str {
        "frame_rotation"
    }

    fn turns_frame(&self, side: Side) -> bool {
        !self.speeds.of(side).is_zero()
    }

    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        let turns = |side: &Side| self.turns_frame(*side) && model.ring(*side).is_some();
        for side in Side::BOTH.into_iter().filter(turns) {
            let speed = self.speeds.of(side);
            loads.frames[side.index()] = Some(FrameTurn {
                speed: speed.at(now.time),
                acceleration: speed.rate(now.time),
            });
        }
        Ok(())
    }
}

/// Inertia of the undeformed rings in their own frames, inner first, N, `[n_nodes][3]` flat: what statics sees of
/// turning frames. Collective.
pub fn static_inertia(model: &Model, loads: &Loads) -> Result<[Option<Vec<f64>>; 2], DynamicsError> {
    Side::try_both(|side| {
        let (Some(turn), Some(ring)) = (loads.frames[side.index()], model.ring(side)) else {
            return Ok(None);
        };
        let density = ring.material.density;
        let (square, rate) = (turn.speed * turn.speed, turn.acceleration);
        let inertia =
            |[x, y, _]: [f64; 3]| [square * x + rate * y, square * y - rate * x, 0.0].map(|f| density * f);
        Ok(Some(body_load(ring, side.name(), model.backend, inertia)?))
    })
}
