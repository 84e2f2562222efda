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
//! An elastic body on the shaft has the centrifugal and Euler forces of its undeformed shape with the ring on it
//! ([`Model::body_load`](crate::Model::body_load)). Those on its displacement act in motion whether or not the scene
//! asks for this effect ([`body::FrameForms`]).
//!
//! In motion, all but the load of the undeformed ring is left out where it is nothing, below a share `negligible` of
//! the forces ([`crate::motion::LeftOut`]).
//!
//! The stress of a turning ring stiffens it where the scene asks for it ([`ring::expansion`]). An equilibrium has no
//! use of it: what stands in space runs round the turning ring, and the inertia of the ring in that motion takes back
//! what the stress holds, rho W^2 r^2 in tension along the ring (that of a running chain, whatever its shape).
//!
//! Rule of thumb: growth u of the turning ring over the Hertz approach; u = rho omega^2 r^3 / E of a free ring, rho
//! omega^2 r t^2 / (2 E) of one of thickness t on a solid shaft (Timoshenko, Strength of Materials II, thin turning
//! ring).

use contact::Side;
use input::Problems;
use serde::Deserialize;

use super::loads::{FrameTurn, Loads, Now};
use super::rules::{Case, Remark, judge, judge_key, share_of};
use super::table::{self, About, Context, Need, Setting, SpeedRole, Trial};
use crate::error::DynamicsError;
use crate::kinematics::RingSpeeds;
use crate::model::{Effect, InertiaLimit, Model};
use ring::Hold;
use ring::division::body_load;

/// Share of a ball force that the oval shape of a turning bore in its mean motion makes: 0.04 % by 4.8 % of that shape,
/// measured in motion on a 7010C.
const OVAL_SHARE: f64 = 0.01;

const EXAMPLE: &str = "[effects.frame_rotation]        # needs [speed] and a flexible ring that turns\n\
stress_stiffening = true        # optional: their stress of turning stiffens them, in motion; default false\n\
negligible = 1e-6               # optional, 0 to 1e-2: inertia below this share of forces is left out; default 1e-6\n";

/// Share of the forces on a ring below which the inertia of its elastic part is left out.
const NEGLIGIBLE: f64 = 1e-6;
/// Largest such share.
const MOST_NEGLIGIBLE: f64 = 1e-2;

/// The table of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "a table [effects.frame_rotation]")]
pub struct FrameRotationTable {
    /// Whether the stress of turning rings stiffens them.
    #[serde(default)]
    pub stress_stiffening: bool,
    /// Share of the forces on a ring below which the inertia of its elastic part is left out; 0: never.
    #[serde(default = "default_negligible")]
    pub negligible: f64,
}

fn default_negligible() -> f64 {
    NEGLIGIBLE
}

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

    fn advice(table: Option<&Self>, case: &Case<'_>) -> Vec<Remark> {
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
            "the turning {} ring grows by {formula} = {:.4} um, {} of about {:.2} um",
            side.name(),
            1e6 * growth,
            share_of(ratio, "the Hertz approach"),
            1e6 * approach
        );
        let mut advice = judge("frame_rotation", table.is_some(), ratio, &estimate);
        advice.extend(stiffening_advice(table, case));
        advice
    }

    fn load(&self, setting: Setting<'_>) -> Result<Option<Box<dyn Effect>>, DynamicsError> {
        let speeds = setting.speeds.clone();
        let plain = FrameRotation::new(speeds).negligible_below(self.negligible);
        Ok(Some(Box::new(match self.stress_stiffening {
            true => plain.stiffened(),
            false => plain,
        })))
    }

    fn check(&self, context: Context, problems: &mut Problems) {
        problems.require(
            (0.0..=MOST_NEGLIGIBLE).contains(&self.negligible),
            "effects.frame_rotation.negligible",
            self.negligible,
            "expected a share of the forces from 0, which always keeps the inertia of the elastic part, to 0.01; 1e-6 \
             is usual",
        );
        if self.stress_stiffening && context.is_without_inertia {
            problems.add(
                "effects.frame_rotation.stress_stiffening does nothing in a scene without inertia: a shape that stands \
                 in space runs round the turning ring, whose inertia takes back what its stress holds; remove it, or \
                 compute motion with [dynamic]",
            );
        }
    }
}

/// What the rule of thumb says of the stiffness by the stress of turning rings.
fn stiffening_advice(table: Option<&FrameRotationTable>, case: &Case<'_>) -> Vec<Remark> {
    let is_on = table.is_some_and(|table| table.stress_stiffening);
    if !case.has_inertia {
        return Vec::new();
    }
    let shares = Side::BOTH
        .into_iter()
        .filter_map(|side| Some((side, stiffening(case, side)?)));
    let Some((side, share)) = shares.reduce(|a, b| if b.1 > a.1 { b } else { a }) else {
        return Vec::new();
    };
    let ratio = OVAL_SHARE * share;
    let estimate = format!(
        "the stress of the turning {} ring holds 3 rho omega^2 r^4 / (E h^2) = {}, about {}",
        side.name(),
        share_of(share, "what bends it oval"),
        share_of(ratio, "a ball force")
    );
    judge_key(
        "effects.frame_rotation.stress_stiffening",
        is_on,
        ratio,
        &estimate,
    )
}

/// Share that the stress of a flexible ring at its largest speed adds to its stiffness against an oval shape; of one
/// that is clamped, as good as nothing.
fn stiffening(case: &Case<'_>, side: Side) -> Option<f64> {
    let ring = case.model.ring(side)?;
    let (groove, held) = case.radii(side);
    let (radius, height) = (0.5 * (groove + held), (groove - held).abs());
    let speed = case.speed(side);
    let strain = case.ring_steel.density * (speed * radius).powi(2) / case.ring_steel.young_modulus;
    Some(match ring.hold {
        Hold::Clamped => 0.0,
        Hold::MeanMotion | Hold::Free => 3.0 * strain * (radius / height).powi(2),
    })
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
    speeds: RingSpeeds,
    /// Whether the stress of the rings stiffens them.
    stiffens: bool,
    /// Share of the forces on a ring below which the inertia of its elastic part is left out.
    negligible: f64,
}

impl FrameRotation {
    /// That of rings with these speeds, which their stress does not stiffen.
    pub fn new(speeds: impl Into<RingSpeeds>) -> FrameRotation {
        FrameRotation {
            speeds: speeds.into(),
            stiffens: false,
            negligible: 0.0,
        }
    }

    /// The same, without the inertia of the elastic part of a ring where its share of the forces stays below this.
    pub fn negligible_below(self, negligible: f64) -> FrameRotation {
        FrameRotation { negligible, ..self }
    }

    /// The same of rings that the stress of their turning stiffens ([`ring::expansion`]).
    pub fn stiffened(self) -> FrameRotation {
        FrameRotation {
            stiffens: true,
            ..self
        }
    }
}

impl Effect for FrameRotation {
    fn name(&self) -> &'static str {
        "frame_rotation"
    }

    fn turns_frame(&self, side: Side) -> bool {
        !self.speeds.of(side).is_zero()
    }

    fn frame_turn(&self, side: Side, time: f64) -> Option<FrameTurn> {
        let speed = self.speeds.of(side);
        self.turns_frame(side).then(|| FrameTurn {
            speed: speed.at(time),
            acceleration: speed.rate(time),
        })
    }

    fn inertia_limit(&self, side: Side) -> Option<InertiaLimit> {
        let speed = self.speeds.of(side);
        self.turns_frame(side).then(|| InertiaLimit {
            largest_speed: speed.largest(),
            largest_acceleration: speed.largest_rate(),
            negligible: self.negligible,
        })
    }

    fn stiffens(&self, side: Side) -> bool {
        self.stiffens && self.turns_frame(side)
    }

    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        for side in Side::BOTH.into_iter().filter(|side| model.ring(*side).is_some()) {
            let turn = self.frame_turn(side, now.time);
            loads.frames[side.index()] = turn.or(loads.frames[side.index()]);
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
