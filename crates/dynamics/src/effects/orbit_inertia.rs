//! Inertia of balls that move in their meridian planes as they go round, in equilibria.
//!
//! Under a load across, or a moment, each azimuth has its own place of a ball, x(psi), which all balls take as they
//! pass with the speed W of the cage. So a ball has the acceleration W^2 d2x/dpsi2 beside that of its circle, m W^2 r,
//! which is [`super::ball_centrifugal`]. Here its force -m W^2 d2x/dpsi2 acts on each ball of an equilibrium, with the
//! derivative of [`course_slopes`]. A motion has this inertia of itself; the effect gives it the start at which it
//! rests. `[dynamic.start.rolling]` brings it, beside the velocities of the balls.
//!
//! It needs the centrifugal force, which presses all balls on a raceway: the inertia of balls that hardly touch
//! anything would move them without end.
//!
//! Balls must follow each other on one course that stands in space: surfaces, balls of several sizes and loads that
//! turn with a ring are refused. In quasi-static runs the course is that of each instant: what its change adds is left
//! out, as all inertia of a change is there.
//!
//! Rule of thumb: m W^2 over the stiffness of a loaded ball along the axis, 3/4 Q sin^2(a) / d of its contacts and
//! Q cos^2(a) / A of its load across them, A the distance of the groove centres.

use contact::Meridian;
use serde::Deserialize;

use super::loads::{AtEquilibrium, Loads, Now};
use super::rules::{Case, Remark, judge, share_of};
use super::table::{self, About, Need, Setting, SpeedRole, Trial};
use crate::error::DynamicsError;
use crate::kinematics::{Kinematics, RingSpeeds, SlipRatios, course_slopes};
use crate::model::{Effect, Model};

const EXAMPLE: &str = "[effects.orbit_inertia]         # needs [effects.ball_centrifugal]; for equilibria\n";

/// The table of a scene: it has no keys.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the empty table [effects.orbit_inertia]")]
pub struct OrbitInertiaTable {}

impl table::EffectTable for OrbitInertiaTable {
    fn about() -> About {
        About {
            name: "orbit_inertia",
            example: EXAMPLE,
            speed: SpeedRole::Force,
            needs: &[Need::OneCourse, Need::BallCentrifugal],
            trial: Some(Trial { what: "", keys: &[] }),
        }
    }

    fn advice(table: Option<&Self>, case: &Case<'_>) -> Vec<Remark> {
        // Under thrust alone balls stay on their circle; a moment is in no estimate.
        if case.load.radial == 0.0 || case.has_inertia {
            return Vec::new();
        }
        let ratio = share_of_stiffness(case);
        let estimate = format!(
            "the inertia of balls that move along the axis as they go round, m omega_c^2, is {}",
            share_of(ratio, "the stiffness of a loaded ball there")
        );
        judge("orbit_inertia", table.is_some(), ratio, &estimate)
    }

    fn load(&self, setting: Setting<'_>) -> Result<Option<Box<dyn Effect>>, DynamicsError> {
        Ok(Some(Box::new(OrbitInertia {
            speeds: setting.speeds.clone(),
            slip: setting.slip,
        })))
    }
}

/// m W^2 over the stiffness of a loaded ball along the axis.
pub fn share_of_stiffness(case: &Case<'_>) -> f64 {
    let slope = case.centrifugal_force() / case.model.geometry.ball_centre().radial;
    let (sin, cos) = case.contact_angle().sin_cos();
    // Without a contact angle the load alone holds a ball along the axis.
    let across = cos * cos / case.model.geometry.groove_distance();
    slope / (case.ball_load() * (0.75 * sin * sin / case.approach() + across))
}

/// Inertia of balls on their orbits.
pub struct OrbitInertia {
    /// Speeds of the rings.
    pub speeds: RingSpeeds,
    /// Slip ratios at the inner and outer raceway.
    pub slip: SlipRatios,
}

impl Effect for OrbitInertia {
    fn name(&self) -> &'static str {
        "orbit_inertia"
    }

    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        let Some(AtEquilibrium { forces, balls, .. }) = now.seen else {
            return Ok(());
        };
        let touched: Vec<bool> = forces
            .chunks(2)
            .map(|site| site.iter().any(|f| *f > 0.0))
            .collect();
        let slopes = course_slopes(&touched);
        let slope = |along: &[Meridian], ball: usize| {
            let row = slopes[balls.len() * ball..].iter().zip(along);
            row.fold(Meridian::default(), |sum, (d, x)| sum + x.map(|x| d * x))
        };
        let first: Vec<Meridian> = (0..balls.len()).map(|ball| slope(balls, ball)).collect();
        let speed = self.speed(model, now.time);
        for (ball, load) in loads.balls.iter_mut().enumerate() {
            *load = *load + slope(&first, ball).map(|x| -model.ball_mass() * speed * speed * x);
        }
        loads.follows_angles = true;
        Ok(())
    }

    fn orbit_speed(&self, model: &Model, time: f64) -> Option<f64> {
        Some(self.speed(model, time))
    }
}

impl OrbitInertia {
    /// Speed of the cage, rad/s.
    fn speed(&self, model: &Model, time: f64) -> f64 {
        Kinematics::new(&model.geometry, self.slip).cage_speed(&self.speeds, time)
    }
}
