//! Temperatures of rings, balls, shaft and housing: grooves and balls grow, and seats move with their partners.
//!
//! A body has one temperature, constant or by a schedule over time; a ring may have one by radius instead, constant in
//! time. All bodies are free of strain at the reference. Its strain is alpha (T - T_ref), with alpha
//! of `[materials.rings]` and `[materials.balls]`; shaft and housing are of ring steel unless a key says otherwise.
//! What it does to rings, seats and clearance: [`crate::mounting`]. A clamped seat has the temperature of its partner,
//! which stresses the ring if they differ; a ring in its mean motion and a rigid one grow freely, unless a fit holds
//! them.
//!
//! Young's modulus, Hertz stiffness, masses and the speed of the cage stay those of the reference. What a schedule does
//! to the contacts is a line of the energy ledger, `temperature_work_j`. Bodies grow at once and without inertia: real
//! temperatures change in minutes.
//!
//! Rule of thumb: change of the radial clearance over the approach of a ball.

use std::fmt;

use input::{Clock, Expansion, LENGTH, Problems, Quantity, TIME, Temperature, bare_number, require_growing};
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Visitor};

use super::table::{self, About, Context, Need, SpeedRole, Trial};
use crate::mounting::{Conditions, RadialProfile, RingTemperature, TemperatureSchedule, Temperatures};

const EXAMPLE: &str = r#"[effects.temperature]           # needs expansion in [materials.rings] and [materials.balls]
inner = "60 degC"               # inner ring; each may be a table:
                                #   inner = { times = ["0 s", "1 s"], values = ["20 degC", "60 degC"] }
                                #   inner.ramp = { from = "20 degC", to = "60 degC", start = "0 s", duration = "1 s" }
                                # linear between the times, with [dynamic] or [quasi_static]; of a ring also by radius:
                                #   inner = { radii = ["25 mm", "28 mm"], values = ["60 degC", "68 degC"] }
outer = "45 degC"               # outer ring
balls = "65 degC"
shaft = "60 degC"               # optional, default: that of the inner ring
housing = "40 degC"             # optional, default: that of the outer ring
reference = "20 degC"           # optional, default 20 degC: at which all dimensions and fits hold
shaft_expansion = "11.5e-6 /K"  # optional, default: that of the rings
housing_expansion = "23e-6 /K"  # optional, default: that of the rings
"#;

/// Reference temperature of dimensions (ISO 1), K.
const REFERENCE: f64 = 293.15;
/// Between these bearing steel is elastic as at room temperature, degC.
const PLAUSIBLE_CELSIUS: std::ops::RangeInclusive<f64> = -200.0..=350.0;

/// The table of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [effects.temperature]")]
pub struct TemperatureTable {
    inner: BodyTemperature,
    outer: BodyTemperature,
    balls: BodyTemperature,
    shaft: Option<BodyTemperature>,
    housing: Option<BodyTemperature>,
    reference: Option<Temperature>,
    shaft_expansion: Option<Expansion>,
    housing_expansion: Option<Expansion>,
}

/// Temperature of a body: one, or a table.
#[derive(Clone, Debug, PartialEq)]
enum BodyTemperature {
    One(Temperature),
    Table(BodyTable),
}

/// Temperatures over time or radius.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "temperatures over time or radius")]
struct BodyTable {
    times: Option<Vec<Quantity<TIME>>>,
    radii: Option<Vec<Quantity<LENGTH>>>,
    values: Option<Vec<Temperature>>,
    ramp: Option<Ramp>,
}

/// A temperature that changes linearly.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "a ramp of temperature")]
struct Ramp {
    from: Temperature,
    to: Temperature,
    start: Quantity<TIME>,
    duration: Quantity<TIME>,
}

/// What a table is over.
enum Over {
    Time(TemperatureSchedule),
    Radius(RadialProfile),
}

impl table::EffectTable for TemperatureTable {
    fn about() -> About {
        About {
            name: "temperature",
            example: EXAMPLE,
            speed: SpeedRole::None,
            needs: &[Need::Expansion],
            trial: Some(Trial {
                what: "inner ring, balls and shaft 10 K warmer",
                keys: &[("inner", "30 degC"), ("outer", "20 degC"), ("balls", "30 degC")],
            }),
        }
    }

    fn check(&self, context: Context, problems: &mut Problems) {
        let bodies = [
            ("inner", Some(&self.inner)),
            ("outer", Some(&self.outer)),
            ("balls", Some(&self.balls)),
            ("shaft", self.shaft.as_ref()),
            ("housing", self.housing.as_ref()),
        ];
        for (name, body) in bodies {
            let Some(body) = body else { continue };
            let key = format!("effects.temperature.{name}");
            match body {
                BodyTemperature::One(temperature) => require_plausible(temperature, &key, problems),
                BodyTemperature::Table(table) => {
                    table.check(&key, matches!(name, "inner" | "outer"), context.clock, problems)
                }
            }
        }
        if let Some(reference) = &self.reference {
            require_plausible(reference, "effects.temperature.reference", problems);
        }
        for (key, expansion) in [
            ("effects.temperature.shaft_expansion", &self.shaft_expansion),
            ("effects.temperature.housing_expansion", &self.housing_expansion),
        ] {
            if let Some(expansion) = expansion {
                expansion.check(key, problems);
            }
        }
    }

    fn mount(&self, conditions: &mut Conditions) {
        let expansion = |expansion: &Option<Expansion>| expansion.as_ref().map(Expansion::per_kelvin);
        conditions.temperatures = Some(Temperatures {
            rings: [&self.inner, &self.outer].map(|body| match body.over() {
                Over::Time(schedule) => RingTemperature::Uniform(schedule),
                Over::Radius(profile) => RingTemperature::Radial(profile),
            }),
            balls: self.balls.schedule(),
            partners: [&self.shaft, &self.housing].map(|body| body.as_ref().map(BodyTemperature::schedule)),
            reference: self.reference.as_ref().map_or(REFERENCE, Temperature::kelvin),
            partner_expansion: [
                expansion(&self.shaft_expansion),
                expansion(&self.housing_expansion),
            ],
        });
    }
}

impl BodyTemperature {
    /// What was checked.
    fn over(&self) -> Over {
        match self {
            BodyTemperature::One(temperature) => {
                Over::Time(TemperatureSchedule::constant(temperature.kelvin()))
            }
            BodyTemperature::Table(table) => table.over(),
        }
    }

    /// The same of a body that has one temperature at a time.
    fn schedule(&self) -> TemperatureSchedule {
        match self.over() {
            Over::Time(schedule) => schedule,
            Over::Radius(profile) => TemperatureSchedule::constant(profile.values[0]),
        }
    }
}

impl BodyTable {
    fn over(&self) -> Over {
        let values = || self.values.iter().flatten().map(Temperature::kelvin);
        match (&self.ramp, &self.times, &self.radii) {
            (Some(ramp), ..) => {
                let start = ramp.start.si();
                Over::Time(TemperatureSchedule {
                    times: vec![start, start + ramp.duration.si()],
                    values: vec![ramp.from.kelvin(), ramp.to.kelvin()],
                })
            }
            (None, Some(times), _) => Over::Time(TemperatureSchedule {
                times: times.iter().map(Quantity::si).collect(),
                values: values().collect(),
            }),
            (None, None, radii) => Over::Radius(RadialProfile {
                radii: radii.iter().flatten().map(Quantity::si).collect(),
                values: values().collect(),
            }),
        }
    }

    fn check(&self, key: &str, is_ring: bool, clock: Clock, problems: &mut Problems) {
        let is_timed = match (&self.times, &self.radii, &self.values, &self.ramp) {
            (Some(times), None, Some(values), None) => {
                require_as_many((times.len(), "times"), values, key, problems);
                require_growing(times, key, problems);
                true
            }
            (None, Some(radii), Some(values), None) => {
                require_as_many((radii.len(), "radii"), values, key, problems);
                require_radii(radii, key, problems);
                false
            }
            (None, None, None, Some(ramp)) => {
                let duration = format!("{key}.ramp.duration");
                problems.require_positive(&ramp.duration, &duration, "a duration");
                require_plausible(&ramp.from, &format!("{key}.ramp.from"), problems);
                require_plausible(&ramp.to, &format!("{key}.ramp.to"), problems);
                true
            }
            _ => {
                return problems.add(format!(
                    "{key} needs a temperature, or times and values, or ramp, or of a ring radii and values"
                ));
            }
        };
        for (i, value) in self.values.iter().flatten().enumerate() {
            require_plausible(value, &format!("{key}.values[{i}]"), problems);
        }
        if is_timed && clock == Clock::AtRest {
            problems.add(format!(
                "{key} changes over time, but a scene at rest has no time; give one temperature, or give it time with \
                 [dynamic] or [quasi_static]"
            ));
        }
        if !is_timed && !is_ring {
            problems.add(format!(
                "{key} is given by radius, which only rings are; give one temperature, or one over time"
            ));
        }
    }
}

fn require_as_many((n, what): (usize, &str), values: &[Temperature], key: &str, problems: &mut Problems) {
    if n == 0 || n != values.len() {
        problems.add(format!(
            "{key} has {n} {what} and {} values; expected as many of both, at least one",
            values.len()
        ));
    }
}

fn require_radii(radii: &[Quantity<LENGTH>], key: &str, problems: &mut Problems) {
    for (i, radius) in radii.iter().enumerate() {
        problems.require_positive(radius, &format!("{key}.radii[{i}]"), "a radius");
    }
    for (i, pair) in radii.windows(2).enumerate() {
        let rule = format!("radii must grow, the one before is {}", pair[0]);
        let key = format!("{key}.radii[{}]", i + 1);
        problems.require(pair[1].si() > pair[0].si(), &key, &pair[1], rule);
    }
}

fn require_plausible(temperature: &Temperature, key: &str, problems: &mut Problems) {
    problems.require(
        PLAUSIBLE_CELSIUS.contains(&temperature.celsius()),
        key,
        temperature,
        "expected -200 degC to 350 degC, where rings are elastic as they are at 20 degC",
    );
}

impl<'de> Deserialize<'de> for BodyTemperature {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct BodyVisitor;

        const EXPECTED: &str = "a temperature such as \"70 degC\" or a table over time or radius";

        impl<'de> Visitor<'de> for BodyVisitor {
            type Value = BodyTemperature;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(EXPECTED)
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<BodyTemperature, E> {
                text.parse().map(BodyTemperature::One).map_err(E::custom)
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<BodyTemperature, E> {
                Err(E::custom(bare_number(value, EXPECTED)))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<BodyTemperature, E> {
                Err(E::custom(bare_number(value, EXPECTED)))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<BodyTemperature, A::Error> {
                BodyTable::deserialize(MapAccessDeserializer::new(map)).map(BodyTemperature::Table)
            }
        }

        deserializer.deserialize_any(BodyVisitor)
    }
}
