//! Centrifugal force of the balls: it presses them outwards, so the outer contact angle falls and the inner one rises.
//!
//! m omega_c^2 r, omega_c the cage's speed; the force grows with the ball's radial displacement. With
//! `speed.ball_speeds = "outer_control"` each ball has the speed omega_c of its own contact angles
//! ([`BallSpeeds`]).
//!
//! Rule of thumb: m r omega_c^2 over the load Q of a ball.

use serde::Deserialize;

use super::loads::{Loads, Now};
use super::rules::{Case, Remark, judge, newtons, share_of};
use super::table::{self, About, Setting, SpeedRole, Trial};
use crate::balls::BallResult;
use crate::error::DynamicsError;
use crate::kinematics::SlipRatios;
use crate::kinematics::{BallSpeeds, Kinematics, RingSpeeds};
use crate::model::{Effect, Model};

const EXAMPLE: &str = "[effects.ball_centrifugal]      # needs [speed]\n";

/// Error of a contact force that is worth a warning.
const MATTERS: f64 = 0.01;

/// The table of a scene: it has no keys.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the empty table [effects.ball_centrifugal]")]
pub struct BallCentrifugalTable {}

impl table::EffectTable for BallCentrifugalTable {
    fn about() -> About {
        About {
            name: "ball_centrifugal",
            example: EXAMPLE,
            speed: SpeedRole::BallForce,
            needs: &[],
            trial: Some(Trial { what: "", keys: &[] }),
        }
    }

    fn advice(table: Option<&Self>, case: &Case<'_>) -> Vec<Remark> {
        let load = case.ball_load();
        if load == 0.0 {
            return Vec::new();
        }
        let force = case.centrifugal_force();
        let ratio = force / load;
        let estimate = format!(
            "the centrifugal force of a ball, m r omega_c^2 = {force:.3} N, is {} of about {}",
            share_of(ratio, "its load"),
            newtons(load)
        );
        judge("ball_centrifugal", table.is_some(), ratio, &estimate)
    }

    fn load(&self, setting: Setting<'_>) -> Result<Option<Box<dyn Effect>>, DynamicsError> {
        Ok(Some(Box::new(BallCentrifugal {
            speeds: setting.speeds.clone(),
            slip: setting.slip,
            ball_speeds: setting.ball_speeds,
        })))
    }
}

/// Centrifugal force of the balls.
pub struct BallCentrifugal {
    /// Speeds of the rings.
    pub speeds: RingSpeeds,
    /// Slip ratios at the inner and outer raceway.
    pub slip: SlipRatios,
    /// Contact angles that the speeds follow.
    pub ball_speeds: BallSpeeds,
}

impl Effect for BallCentrifugal {
    fn name(&self) -> &'static str {
        "ball_centrifugal"
    }

    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        let radius = model.geometry.ball_centre().radial;
        for ball in 0..model.geometry.n_balls {
            let turning = self.ball_speeds.of_ball(&model.geometry, now, self.slip, ball);
            let cage = turning.cage_speed(&self.speeds, now.time);
            let slope = model.ball_mass() * cage * cage;
            loads.balls[ball].radial += slope * radius;
            loads.ball_slopes[ball] += slope;
        }
        loads.follows_angles |= self.ball_speeds == BallSpeeds::OuterControl;
        Ok(())
    }

    fn warning(&self, model: &Model, now: &Now, balls: &[BallResult]) -> Option<String> {
        if self.ball_speeds == BallSpeeds::OuterControl {
            return None;
        }
        let cage = |kinematics: Kinematics| kinematics.cage_speed(&self.speeds, now.time);
        let free = cage(Kinematics::new(&model.geometry, self.slip));
        let slope = model.ball_mass() * free.powi(2);
        let force = slope * model.geometry.ball_centre().radial;
        // By what share of the force its angles change that of a ball, over its contact force.
        let error = |ball: &BallResult| {
            let angles = [ball.inner.contact_angle_rad, ball.outer.contact_angle_rad];
            let own = cage(Kinematics::outer_control(&model.geometry, self.slip, angles));
            let change = (own / free).powi(2) - 1.0;
            [change, change.abs() * force / ball.outer.force_n]
        };
        let loaded = balls.iter().enumerate().filter(|(_, b)| b.inner.force_n > 0.0);
        let errors = loaded.map(|(i, ball)| (i, error(ball)));
        let (ball, [change, error]) = errors.max_by(|a, b| a.1[1].total_cmp(&b.1[1]))?;
        (error > MATTERS).then(|| {
            let degrees = [balls[ball].inner, balls[ball].outer].map(|c| c.contact_angle_rad.to_degrees());
            format!(
                "ball {ball} rolls at contact angles of {:.1} deg inside and {:.1} deg outside, which would change its \
                 centrifugal force by {:+.1} %, or {}: the cage has the speed of the free contact \
                 angle; speed.ball_speeds = \"outer_control\" gives each ball that of its own angles",
                degrees[0],
                degrees[1],
                100.0 * change,
                share_of(error, "its contact force")
            )
        })
    }
}
