//! Gyroscopic moment of the balls.
//!
//! A ball spins with omega_b about an axis that is tilted by beta against the axis of the
//! bearing, and the cage turns this axis with omega_c. Without pivoting on the outer raceway (outer raceway control)
//!
//! ```text
//! tan beta = sin a_o / (cos a_o + gamma),   gamma = D_w / D_m
//! M_g = J omega_b omega_c sin beta,         J = m D_w^2 / 10
//! ```
//!
//! Harris, Rolling Bearing Analysis, 4th ed., chapter 5; Jones, ASME J. Basic Eng. 81 (1959) 1. The axis is that of
//! outer raceway control whatever the shares. omega_b and omega_c are those of the kinematic cage (`kinematics`),
//! with the free contact angle and the cage slip; only beta follows the present angle a_o of each ball. (7010C, 30
//! 000 rpm, 2 kN: Harris's speeds at the angles of the solution, 27.2 and 13.4 deg, are 3 % higher, and M_g would
//! be 6 % larger.) With `speed.ball_speeds = "outer_control"` they are Harris's, of the contact angles of each ball
//! (`BallSpeeds`).
//!
//! **Signs**, from first principles, at azimuth 0, with e_r = x, e_z = z, e_psi = y. The inner raceway (turning by +
//! about z) drags the ball's inner side along +e_psi, so relative to the cage the ball turns with omega_b (sin beta
//! e_r - cos beta e_z). The cage turns this vector: the angular momentum grows by omega_c e_z x J omega_b sin beta
//! e_r = M_g e_psi per second. Friction must supply this moment: forces lambda M_g / D_w across the contact normals,
//! on the ball
//!
//! ```text
//! outer: lambda_o M_g / D_w (  sin a_o, -cos a_o )   [radial, axial]
//! inner: lambda_i M_g / D_w ( -sin a_i,  cos a_i )
//! ```
//!
//! each at D_w / 2 from the ball's centre, so that with lambda_i + lambda_o = 2 their couple is M_g. On the outer
//! raceway the force helps to push the ball back along -z: the outer contact angle falls further than from the
//! centrifugal force alone. A reversed speed changes no sign (omega_b and omega_c both reverse). The rings get the
//! opposite forces at their groove centres and the shaft the couple of moving them there from the inner contacts;
//! the local twist of a flexible ring by that couple is left out. Friction is not limited, but statics warns where
//! lambda M_g / D_w is more than 0.15 times the contact force.
//!
//! Rule of thumb: the force across the contact normal that it asks for, 2 M_g / (D_w Q) with M_g = J omega_b
//! omega_c sin a and Q the load of a ball. Friction holds balls while M_g < 0.02 Q D_w: else they turn about the
//! tangent of their path.

use contact::Side;
use input::Problems;
use serde::Deserialize;

use super::loads::{Loads, Now};
use super::rules::{Case, Remark, judge, share_of};
use super::table::{self, About, Context, Setting, SpeedRole, Trial};
use crate::error::DynamicsError;
use crate::kinematics::SlipRatios;
use crate::kinematics::{BallSpeeds, RingSpeeds, pitch_angle};
use crate::model::{Effect, Model};

const EXAMPLE: &str = "[effects.gyroscopic_moment]     # needs [speed]
inner_share = 0.0               # share of the moment that friction at the inner raceway carries
outer_share = 2.0               # 0 and 2: outer raceway control (default); 1 and 1: both alike; the sum is 2
";

/// Both shares together: each is a force of share / D_w at D_w / 2 from the ball's centre.
const SUM: f64 = 2.0;
/// Shares such as 0.7 and 1.3 add up to 2 but for round-off.
const ROUND_OFF: f64 = 1e-12;
/// Friction coefficient that holds a ball against its gyroscopic moment, M_g < 0.02 Q D_w (Harris, chapter 5).
const HOLD: f64 = 0.02;

/// The table of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [effects.gyroscopic_moment]")]
pub struct GyroscopicMomentTable {
    inner_share: Option<f64>,
    outer_share: Option<f64>,
}

impl GyroscopicMomentTable {
    /// Shares of the raceways; one that is not given is the rest of 2, without any the outer raceway carries all.
    pub fn shares(&self) -> MomentShares {
        let inner = self.inner_share.unwrap_or(SUM - self.outer_share.unwrap_or(SUM));
        MomentShares {
            inner,
            outer: self.outer_share.unwrap_or(SUM - inner),
        }
    }
}

/// Shares lambda of the raceways in the gyroscopic moment; their sum is 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentShares {
    /// Share of the inner raceway.
    pub inner: f64,
    /// Share of the outer raceway.
    pub outer: f64,
}

impl MomentShares {
    /// The outer raceway carries all: outer raceway control.
    pub const OUTER_CONTROL: MomentShares = MomentShares {
        inner: 0.0,
        outer: SUM,
    };
}

impl table::EffectTable for GyroscopicMomentTable {
    fn about() -> About {
        About {
            name: "gyroscopic_moment",
            example: EXAMPLE,
            speed: SpeedRole::BallForce,
            needs: &[],
            trial: Some(Trial {
                what: "outer raceway control",
                keys: &[],
            }),
        }
    }

    fn advice(table: Option<&Self>, case: &Case<'_>) -> Vec<Remark> {
        let load = case.ball_load();
        if load == 0.0 {
            return Vec::new();
        }
        let diameter = case.model.geometry.ball_diameter;
        let inertia = case.model.ball_moment();
        let moment = inertia * case.gyroscopic_rate() * case.contact_angle().sin();
        let ratio = 2.0 * moment / (diameter * load);
        let estimate = format!(
            "the gyroscopic moment of a ball, J omega_b omega_c sin a = {moment:.2e} N m, asks for 2 M_g / D_w = {} \
             as friction",
            share_of(ratio, "its load")
        );
        let mut lines = judge("gyroscopic_moment", table.is_some(), ratio, &estimate);
        let hold = HOLD * load * diameter;
        if moment > hold {
            let text = format!(
                "friction may not hold the balls: the gyroscopic moment {moment:.2e} N m is more than {HOLD} Q D_w \
                 = {hold:.2e} N m (Harris), and balls that turn with it are not modelled"
            );
            lines.push(text.into());
        }
        lines
    }

    fn check(&self, _context: Context, problems: &mut Problems) {
        let MomentShares { inner, outer } = self.shares();
        for (name, share) in [("inner_share", inner), ("outer_share", outer)] {
            problems.require(
                (0.0..=SUM).contains(&share),
                &format!("effects.gyroscopic_moment.{name}"),
                share,
                "expected 0 to 2: inner 0 and outer 2 is outer raceway control, 1 and 1 both alike",
            );
        }
        if (inner + outer - SUM).abs() > ROUND_OFF {
            problems.add(format!(
                "[effects.gyroscopic_moment] has inner_share {inner} and outer_share {outer}; their sum must be 2, or \
                 the moment is not balanced"
            ));
        }
    }

    fn load(&self, setting: Setting<'_>) -> Result<Option<Box<dyn Effect>>, DynamicsError> {
        Ok(Some(Box::new(GyroscopicMoment {
            speeds: setting.speeds.clone(),
            slip: setting.slip,
            shares: self.shares(),
            ball_speeds: setting.ball_speeds,
        })))
    }
}

/// Gyroscopic moment of the balls.
pub struct GyroscopicMoment {
    /// Speeds of the rings.
    pub speeds: RingSpeeds,
    /// Slip ratios at the inner and outer raceway.
    pub slip: SlipRatios,
    /// Shares of the raceways.
    pub shares: MomentShares,
    /// Contact angles that the speeds follow.
    pub ball_speeds: BallSpeeds,
}

impl GyroscopicMoment {
    /// Moment M_g of one ball at an instant, N m, about e_psi.
    pub fn moment(&self, model: &Model, now: &Now, ball: usize) -> f64 {
        let geometry = &model.geometry;
        let kinematics = self.ball_speeds.of_ball(geometry, now, self.slip, ball);
        let spin = kinematics.spin(&self.speeds, now.time);
        let cage = kinematics.cage_speed(&self.speeds, now.time);
        let pitch = pitch_angle(geometry, now.contact_angle(geometry, ball, Side::Outer));
        let inertia = model.ball_moment();
        inertia * spin * cage * pitch.sin()
    }
}

impl Effect for GyroscopicMoment {
    fn name(&self) -> &'static str {
        "gyroscopic_moment"
    }

    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        loads.follows_angles = true;
        for ball in 0..model.geometry.n_balls {
            let moment = self.moment(model, now, ball);
            for side in Side::BOTH {
                let size =
                    side.choose(self.shares.inner, self.shares.outer) * moment / model.geometry.ball_diameter;
                let (sin, cos) = now.contact_angle(&model.geometry, ball, side).sin_cos();
                // The ring gets the negative of the force on the ball.
                let sign = side.sign();
                loads.add_contact_force(ball, side, [-sign * size * sin, sign * size * cos].into());
                if side == Side::Inner {
                    // From the contact to the groove centre, a groove radius away.
                    let couple = -model.geometry.groove_radius(side) * size;
                    let (sin, cos) = (model.geometry.azimuth(ball) + now.cage_angle).sin_cos();
                    loads.shaft[3] -= couple * sin;
                    loads.shaft[4] += couple * cos;
                }
            }
        }
        Ok(())
    }
}
