//! `[balls]`: how the balls move.
//!
//! ```toml
#![doc = include_str!("example_balls.toml")]
//! ```
//!
//! Free balls need [`[effects.traction]`](dynamics::effects::traction), which needs them. What prescribes their motion
//! or forces that come with their inertia is refused beside them: it would not be redundant but wrong.

use dynamics::effects::{Effects, REPLACED_BY_FREE_BALLS};
use input::Problems;
use serde::Deserialize;

/// How the balls move.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum BallMotion {
    /// Azimuth and turning follow the rings in pure rolling; two dofs in the meridian plane are free.
    #[default]
    Kinematic,
    /// All six dofs are free.
    Free,
}

/// As typed.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [balls]")]
pub struct RawBalls {
    #[serde(default)]
    motion: BallMotion,
}

/// What the balls have to go with.
#[derive(Clone, Copy, Debug)]
pub struct BallsContext<'a> {
    /// Loads and other effects.
    pub effects: &'a Effects,
    /// Whether `speed.ball_speeds` is given.
    pub has_ball_speeds: bool,
    /// Whether motion in time is computed.
    pub is_dynamic: bool,
    /// Whether natural modes are computed.
    pub is_modes: bool,
    /// Whether a ring turns.
    pub has_speed: bool,
    /// Whether the integrator conserves energy.
    pub conserves: bool,
}

/// Effects that free balls in motion do not know: they move grooves and change the balls.
const NOT_BESIDE: [&str; 3] = ["fit", "temperature", "seat_form"];

impl RawBalls {
    /// What the scene asks for.
    pub fn motion(&self) -> BallMotion {
        self.motion
    }

    /// Checks what stands beside free balls.
    pub fn check(&self, context: BallsContext<'_>, problems: &mut Problems) -> BallMotion {
        let names = context.effects.names();
        let has_traction = names.contains(&"traction");
        if self.motion == BallMotion::Kinematic {
            if has_traction {
                problems.add(
                    "[effects.traction] needs free balls: balls whose motion is kinematic roll without friction; write \
                     [balls] with motion = \"free\", or remove it",
                );
            }
            if names.contains(&"ball_drag") {
                problems.add(
                    "[effects.ball_drag] needs free balls: nothing slows down balls whose motion is kinematic; write \
                     [balls] with motion = \"free\", or remove it",
                );
            }
            return self.motion;
        }
        if !has_traction {
            problems.add(
                "balls.motion is \"free\", but nothing carries the balls round; add [effects.traction] with law = \
                 \"coulomb\" and friction (0 is frictionless)",
            );
        }
        if context.is_modes {
            problems.add(
                "balls.motion is \"free\", whose traction natural modes do not know; use motion = \"kinematic\"",
            );
        } else if !context.is_dynamic && !context.has_speed {
            problems.add(
                "balls.motion is \"free\", but nothing turns: balls of an equilibrium roll; add [speed] with inner = \
                 \"1800 rpm\", or use motion = \"kinematic\"",
            );
        } else if context.is_dynamic && !context.conserves {
            problems.add(
                "balls.motion is \"free\", which needs the energy of the balls to be kept; use dynamic.integrator = \
                 \"average_acceleration\"",
            );
        }
        refuse_effects(&names, context.is_dynamic, problems);
        if context.has_ball_speeds {
            problems.add(
                "speed.ball_speeds stands beside balls.motion = \"free\", but the speeds of free balls are results; \
                 remove it",
            );
        }
        self.motion
    }
}

/// Reports effects that free balls replace, or that motion does not compute beside them.
fn refuse_effects(names: &[&str], is_dynamic: bool, problems: &mut Problems) {
    for (name, why) in REPLACED_BY_FREE_BALLS
        .iter()
        .filter(|(name, _)| names.contains(name))
    {
        problems.add(format!(
            "[effects.{name}] stands beside balls.motion = \"free\", but {why}; remove it"
        ));
    }
    let unknown = NOT_BESIDE
        .iter()
        .filter(|name| is_dynamic && names.contains(name));
    for name in unknown {
        problems.add(format!(
            "[effects.{name}] stands beside balls.motion = \"free\", which is not computed; remove it, or use \
             balls.motion = \"kinematic\""
        ));
    }
}
