//! Inertia of the turning inner ring in its own frame.
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
//! undeformed ring: the rest is (W / first natural frequency)^2 of it.
//!
//! Rule of thumb: growth u of the turning ring over the Hertz approach; u = rho omega^2 r^3 / E of a free ring, rho
//! omega^2 r t^2 / (2 E) of one of thickness t on a solid shaft (Timoshenko, Strength of Materials II, thin turning
//! ring).

use contact::Side;
use serde::Deserialize;

use super::loads::{Effect, FrameTurn, Loads, Now};
use super::rules::{Case, judge, percent};
use super::table::{self, About, Need, Setting, SpeedRole, Trial};
use crate::error::DynamicsError;
use crate::kinematics::Speed;
use crate::model::Model;
use ring::Hold;
use ring::division::body_load;

const EXAMPLE: &str = "[effects.frame_rotation]        # needs [speed] and a flexible inner ring\n";

/// The table of a scene: it has no keys.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the empty table [effects.frame_rotation]")]
pub struct Table {}

impl table::Table for Table {
    fn about() -> About {
        About {
            name: "frame_rotation",
            example: EXAMPLE,
            speed: SpeedRole::Force,
            needs: &[Need::FlexibleInner],
            trial: Some(Trial { what: "", keys: &[] }),
        }
    }

    fn advice(table: Option<&Self>, case: &Case<'_>) -> Vec<String> {
        let Some(ring) = case.model.ring(Side::Inner) else {
            return Vec::new();
        };
        if case.ball_load() == 0.0 {
            return Vec::new();
        }
        let radius = case.inner_radius();
        let thickness = radius - 0.5 * case.bore_diameter;
        let steel = &case.ring_steel;
        let square = steel.density * case.speed * case.speed * radius / steel.young_modulus;
        let (growth, formula) = match ring.hold {
            Hold::Clamped => (0.5 * square * thickness * thickness, "rho omega^2 r t^2 / (2 E)"),
            Hold::MeanMotion | Hold::Free => (square * radius * radius, "rho omega^2 r^3 / E"),
        };
        let approach = case.approach();
        let ratio = growth * case.contact_angle().cos() / approach;
        let estimate = format!(
            "the turning inner ring grows by {formula} = {:.4} um, {} of the Hertz approach of about {:.2} um",
            1e6 * growth,
            percent(ratio),
            1e6 * approach
        );
        judge("frame_rotation", table.is_some(), ratio, &estimate)
    }

    fn load(&self, setting: Setting<'_>) -> Result<Option<Box<dyn Effect>>, DynamicsError> {
        let speed = setting.speed.clone();
        Ok(Some(Box::new(FrameRotation { speed })))
    }
}

/// Inertia of the inner ring's turning frame.
pub struct FrameRotation {
    /// Speed of the inner ring.
    pub speed: Speed,
}

impl Effect for FrameRotation {
    fn name(&self) -> &'static str {
        "frame_rotation"
    }

    fn turns_frame(&self) -> bool {
        true
    }

    fn add_loads(&self, _: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        loads.frame = Some(FrameTurn {
            speed: self.speed.at(now.time),
            acceleration: self.speed.rate(now.time),
        });
        Ok(())
    }
}

/// Inertia of the undeformed inner ring in its own frame, N, `[n_nodes][3]` flat: what statics sees of a turning
/// frame. Collective.
pub fn static_inertia(model: &Model, loads: &Loads) -> Result<Option<Vec<f64>>, DynamicsError> {
    let (Some(turn), Some(ring)) = (loads.frame, model.ring(Side::Inner)) else {
        return Ok(None);
    };
    let density = ring.material.density;
    let (square, rate) = (turn.speed * turn.speed, turn.acceleration);
    let inertia =
        |[x, y, _]: [f64; 3]| [square * x + rate * y, square * y - rate * x, 0.0].map(|f| density * f);
    let load = body_load(ring, Side::Inner.name(), model.backend, inertia)?;
    Ok(Some(load))
}
