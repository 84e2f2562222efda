//! `[speed]`: how fast the rings turn.
//!
//! A constant, a ramp from one speed to another, or a table that is linear between its times and constant before the
//! first and after the last. Positive from +x towards +y.

use std::fmt;

use dynamics::effects::{self, Effects, SpeedRole};
use dynamics::kinematics::{BallSpeeds, RingSpeeds, Speed};
use input::{ANGULAR_SPEED, Problems, Quantity, TIME, bare_number, require_growing};
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Visitor};

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [speed]")]
pub struct RawSpeed {
    inner: Option<RawRingSpeed>,
    outer: Option<RawRingSpeed>,
    ball_speeds: Option<BallSpeeds>,
}

/// As typed: a speed, or a table over time.
#[derive(Debug)]
enum RawRingSpeed {
    Constant(Quantity<ANGULAR_SPEED>),
    Table(RawSpeedTable),
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a speed over time")]
struct RawSpeedTable {
    times: Option<Vec<Quantity<TIME>>>,
    values: Option<Vec<Quantity<ANGULAR_SPEED>>>,
    ramp: Option<RawSpeedRamp>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a ramp of speed")]
struct RawSpeedRamp {
    from: Quantity<ANGULAR_SPEED>,
    to: Quantity<ANGULAR_SPEED>,
    start: Quantity<TIME>,
    duration: Quantity<TIME>,
}

/// What the speed is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpeedUse {
    /// Motion in time.
    Motion,
    /// A force that an effect makes of it in an equilibrium, a film, a life or a heat balance.
    AtRest,
    /// An equilibrium without any of these.
    Nothing,
    /// Natural modes, which are those of a bearing at rest.
    Modes,
}

/// No ring turns faster: a slip of the unit, rad/s (almost a million revolutions per minute).
const MAX_SPEED: f64 = 1e5;

/// Whether an effect makes a force of the speed, in an equilibrium too.
pub(super) fn makes_force(takes: SpeedRole) -> bool {
    matches!(
        takes,
        SpeedRole::Force | SpeedRole::BallForce | SpeedRole::Optional
    )
}

/// Whether it is a force on balls.
fn loads_balls(takes: SpeedRole) -> bool {
    takes == SpeedRole::BallForce
}

impl RawSpeed {
    /// Contact angles that the speeds of balls follow, for the effects that need them.
    pub fn ball_speeds(&self, effects: &Effects, problems: &mut Problems) -> BallSpeeds {
        if self.ball_speeds.is_some() && !effects.use_speed(loads_balls) {
            problems.add(format!(
                "speed.ball_speeds does nothing without {}; add one, or remove it",
                effects::headers_that_use_speed(loads_balls)
            ));
        }
        self.ball_speeds.unwrap_or_default()
    }

    /// Whether it says which contact angles the speeds of balls follow.
    pub fn has_ball_speeds(&self) -> bool {
        self.ball_speeds.is_some()
    }

    /// Whether the speeds of balls follow their contact angles.
    pub fn follows_angles(&self) -> bool {
        self.ball_speeds == Some(BallSpeeds::OuterControl)
    }

    /// Checks sizes and the order of times; `None` when there are problems.
    pub fn check(&self, speed_use: SpeedUse, problems: &mut Problems) -> Option<RingSpeeds> {
        let before = problems.len();
        if speed_use == SpeedUse::Nothing {
            problems.add(format!(
                "[speed] does nothing in a scene at rest without [life], [heat], {}; add one, compute motion with \
                 [dynamic], or remove [speed]",
                effects::headers_that_use_speed(makes_force)
            ));
            return None;
        }
        if speed_use == SpeedUse::Modes {
            problems.add(
                "[speed] is given, but [modes] are those of a bearing that does not turn: without gyroscopic and \
                 centrifugal effects; remove [speed]",
            );
            return None;
        }
        if self.inner.is_none() && self.outer.is_none() {
            problems.add("[speed] needs inner, outer, or both, such as inner = \"1800 rpm\"");
        }
        let is_at_rest = speed_use == SpeedUse::AtRest;
        let mut of = |key: &str, speed: &Option<RawRingSpeed>| match speed {
            Some(speed) => speed.check(key, is_at_rest, problems),
            None => Speed::constant(0.0),
        };
        let (inner, outer) = (of("speed.inner", &self.inner), of("speed.outer", &self.outer));
        (problems.len() == before).then_some(RingSpeeds { inner, outer })
    }

    /// Whether it names a ring, inner first; one that names none is taken to lack the inner.
    pub fn has(&self) -> [bool; 2] {
        [self.inner.is_some() || self.outer.is_none(), self.outer.is_some()]
    }
}

impl RawRingSpeed {
    /// The speed under a key; any if it has problems.
    fn check(&self, key: &str, is_at_rest: bool, problems: &mut Problems) -> Speed {
        match self {
            RawRingSpeed::Constant(value) => {
                require_plausible(value, key, problems);
                Speed::constant(value.si())
            }
            RawRingSpeed::Table(_) if is_at_rest => {
                problems.add(format!(
                    "{key} is a table over time, but a scene at rest has no time; expected one speed such as \
                     \"1800 rpm\""
                ));
                Speed::constant(0.0)
            }
            RawRingSpeed::Table(table) => table.check(key, problems),
        }
    }
}

impl RawSpeedTable {
    fn check(&self, key: &str, problems: &mut Problems) -> Speed {
        match (&self.times, &self.values, &self.ramp) {
            (Some(times), Some(values), None) => check_table(key, times, values, problems),
            (None, None, Some(ramp)) => ramp.check(key, problems),
            _ => {
                problems.add(format!("{key} needs either both times and values, or ramp"));
                Speed::constant(0.0)
            }
        }
    }
}

fn check_table(
    key: &str,
    times: &[Quantity<TIME>],
    values: &[Quantity<ANGULAR_SPEED>],
    problems: &mut Problems,
) -> Speed {
    let (n_times, n_values) = (times.len(), values.len());
    require_growing(times, key, problems);
    for (i, value) in values.iter().enumerate() {
        require_plausible(value, &format!("{key}.values[{i}]"), problems);
    }
    if n_times == 0 || n_times != n_values {
        problems.add(format!(
            "{key} has {n_times} times and {n_values} values; expected as many of both, at least one"
        ));
        return Speed::constant(0.0);
    }
    Speed::table(
        times.iter().map(Quantity::si).collect(),
        values.iter().map(Quantity::si).collect(),
    )
}

impl RawSpeedRamp {
    fn check(&self, key: &str, problems: &mut Problems) -> Speed {
        require_plausible(&self.from, &format!("{key}.ramp.from"), problems);
        require_plausible(&self.to, &format!("{key}.ramp.to"), problems);
        let (start, duration) = (self.start.si(), self.duration.si());
        // A duration that is lost in the round-off of the start takes no time either.
        problems.require(
            start + duration > start,
            &format!("{key}.ramp.duration"),
            &self.duration,
            "a duration must be positive; a ring cannot change its speed in no time",
        );
        Speed::table(vec![start, start + duration], vec![self.from.si(), self.to.si()])
    }
}

fn require_plausible(speed: &Quantity<ANGULAR_SPEED>, key: &str, problems: &mut Problems) {
    problems.require(
        speed.si().abs() <= MAX_SPEED,
        key,
        speed,
        "that is more than 1e5 rad/s (955 000 rpm), check its unit",
    );
}

impl<'de> Deserialize<'de> for RawRingSpeed {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct SpeedVisitor;

        const EXPECTED: &str = "an angular speed such as \"1800 rpm\" or a table with times and values";

        impl<'de> Visitor<'de> for SpeedVisitor {
            type Value = RawRingSpeed;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(EXPECTED)
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<RawRingSpeed, E> {
                Quantity::parse_expecting(text, EXPECTED)
                    .map(RawRingSpeed::Constant)
                    .map_err(E::custom)
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<RawRingSpeed, E> {
                Err(E::custom(bare_number(value, EXPECTED)))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<RawRingSpeed, E> {
                Err(E::custom(bare_number(value, EXPECTED)))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawRingSpeed, A::Error> {
                RawSpeedTable::deserialize(MapAccessDeserializer::new(map)).map(RawRingSpeed::Table)
            }
        }

        deserializer.deserialize_any(SpeedVisitor)
    }
}
