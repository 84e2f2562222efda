//! ```toml
#![doc = include_str!("example_heat.toml")]
//! ```
//! What `raceway heat` needs besides the bearing: friction, and how heat flows from body to body. A body without
//! conductance follows its neighbours: the shaft the inner ring, the housing the outer ring, the balls the mean of
//! both.

use std::collections::BTreeMap;

use input::{ANGULAR_SPEED, Conductance, Expansion, MOMENT, Problems, Quantity, Temperature, VISCOSITY};
use serde::Deserialize;

use super::oil::{ClassKeys, Oil};

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [heat]")]
pub struct RawHeat {
    ambient: Temperature,
    speed: Option<Quantity<ANGULAR_SPEED>>,
    torque: Option<Quantity<MOMENT>>,
    f_0: Option<f64>,
    f_1: Option<f64>,
    viscosity: Option<Quantity<VISCOSITY>>,
    viscosity_class: Option<f64>,
    viscosity_at_100: Option<Quantity<VISCOSITY>>,
    limit: Option<Temperature>,
    reference: Option<Temperature>,
    shaft_expansion: Option<Expansion>,
    housing_expansion: Option<Expansion>,
    conductance: BTreeMap<String, Conductance>,
}

/// Bodies that take part in a heat balance, in the order of its temperatures.
pub const BODIES: [&str; 5] = ["inner", "outer", "balls", "shaft", "housing"];
/// What stands for the surroundings.
const AMBIENT: &str = "ambient";
/// Number of the surroundings after the bodies.
pub const SURROUNDINGS: usize = BODIES.len();

/// What a heat balance needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Heat {
    /// Temperature of the surroundings, K.
    pub ambient: f64,
    /// Speed of the inner ring against the outer one, rad/s; None where the scene has `[speed]`.
    pub speed: Option<f64>,
    /// FrictionLaw torque.
    pub friction: FrictionLaw,
    /// Temperature from which on the balance has run away, K.
    pub limit: f64,
    /// Temperature at which dimensions hold, K; None: the usual one.
    pub reference: Option<f64>,
    /// Thermal expansion of shaft and housing, 1/K; None: that of the rings.
    pub partner_expansion: [Option<f64>; 2],
    /// Conductances, W/K, each between two numbers of [`BODIES`] or [`SURROUNDINGS`].
    pub conductances: Vec<([usize; 2], f64)>,
}

/// FrictionLaw torque of a bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrictionLaw {
    /// Known, N m.
    Given(f64),
    /// That of free balls in the equilibrium.
    FreeBalls,
    /// Palmgren's formula.
    Palmgren {
        /// Factor of the oil.
        oil_factor: f64,
        /// Factor of the load.
        load_factor: f64,
        /// The oil; a class has the mean temperature of the rings, not its own.
        oil: Oil,
    },
}

/// Temperature to which every catalogue bearing keeps its size (DIN 623-1, suffix SN), K.
const STABLE: f64 = 393.15;
/// Between these a machine stands, degC.
const PLAUSIBLE_CELSIUS: std::ops::RangeInclusive<f64> = -100.0..=150.0;
/// No bearing has a larger factor.
const MOST_OIL_FACTOR: f64 = 50.0;
const MOST_LOAD_FACTOR: f64 = 0.1;

impl RawHeat {
    /// Checks values and what belongs together; `has_speed`: whether the scene has `[speed]`; `has_free_balls`: whether
    /// their friction is a result.
    pub fn check(&self, has_speed: bool, has_free_balls: bool, problems: &mut Problems) -> Option<Heat> {
        problems.require(
            PLAUSIBLE_CELSIUS.contains(&self.ambient.celsius()),
            "heat.ambient",
            &self.ambient,
            "expected -100 degC to 150 degC",
        );
        let limit = self.limit.as_ref().map_or(STABLE, Temperature::kelvin);
        if let Some(given) = &self.limit {
            problems.require(
                limit > self.ambient.kelvin() && given.celsius() <= 350.0,
                "heat.limit",
                given,
                format!("expected more than the ambient {} to 350 degC", self.ambient),
            );
        }
        match (&self.speed, has_speed) {
            (Some(_), true) => {
                problems
                    .add("heat.speed is given, but [speed] says how fast the rings turn; remove heat.speed");
            }
            (None, false) => problems.add(
                "[heat] needs a speed; add heat.speed of the inner ring against the outer one, or [speed]",
            ),
            (Some(speed), false) => {
                let size = speed.si().abs();
                let rule = "expected a speed of at most 1e5 rad/s (955 000 rpm), and not 0";
                problems.require(size > 0.0 && size <= 1e5, "heat.speed", speed, rule);
            }
            (None, true) => {}
        }
        if let Some(reference) = &self.reference {
            let rule = "expected -100 degC to 150 degC";
            let is_plausible = PLAUSIBLE_CELSIUS.contains(&reference.celsius());
            problems.require(is_plausible, "heat.reference", reference, rule);
        }
        let partner_expansion = [
            ("heat.shaft_expansion", &self.shaft_expansion),
            ("heat.housing_expansion", &self.housing_expansion),
        ]
        .map(|(key, given)| {
            let expansion = given.as_ref()?;
            expansion.check(key, problems);
            Some(expansion.per_kelvin())
        });
        let conductances = self.conductances(problems);
        Some(Heat {
            ambient: self.ambient.kelvin(),
            speed: self.speed.as_ref().map(|speed| speed.si().abs()),
            friction: self.friction(has_free_balls, problems)?,
            limit,
            reference: self.reference.as_ref().map(Temperature::kelvin),
            partner_expansion,
            conductances,
        })
    }

    fn conductances(&self, problems: &mut Problems) -> Vec<([usize; 2], f64)> {
        let mut found: Vec<([usize; 2], f64)> = Vec::new();
        for (name, conductance) in &self.conductance {
            let key = format!("heat.conductance.{name}");
            conductance.check(&key, problems);
            let number = |name: &str| match name {
                AMBIENT => Some(SURROUNDINGS),
                _ => BODIES.iter().position(|body| *body == name),
            };
            let ends = name
                .split_once('_')
                .and_then(|(a, b)| Some([number(a)?, number(b)?]));
            let Some([a, b]) = ends.filter(|[a, b]| a != b) else {
                problems.add(format!(
                    "{key} joins no two bodies; expected two of inner, outer, balls, shaft, housing and ambient, such \
                     as heat.conductance.outer_housing"
                ));
                continue;
            };
            let ends = [a.min(b), a.max(b)];
            if found.iter().any(|(other, _)| *other == ends) {
                problems.add(format!(
                    "{key} joins what another key joins already; keep one of them"
                ));
            }
            found.push((ends, conductance.watt_per_kelvin()));
        }
        for (ring, name) in BODIES.iter().enumerate().take(2) {
            if !reaches(ring, &found) {
                problems.add(format!(
                    "heat.conductance leads no heat from the {name} ring to the surroundings; add {name}_ambient, or a \
                     chain such as {name}_{partner} and {partner}_ambient",
                    partner = ["shaft", "housing"][ring]
                ));
            }
        }
        for (body, name) in BODIES.iter().enumerate().skip(2) {
            if found.iter().any(|(ends, _)| ends.contains(&body)) && !reaches(body, &found) {
                problems.add(format!(
                    "heat.conductance leads no heat from the {name} to the surroundings"
                ));
            }
        }
        found
    }

    fn friction(&self, has_free_balls: bool, problems: &mut Problems) -> Option<FrictionLaw> {
        let of_formula = [
            ("f_0", self.f_0.is_some()),
            ("f_1", self.f_1.is_some()),
            ("viscosity", self.viscosity.is_some()),
            ("viscosity_class", self.viscosity_class.is_some()),
        ];
        if has_free_balls {
            let torque = ("torque", self.torque.is_some());
            let given = of_formula.iter().chain(std::iter::once(&torque));
            for (key, _) in given.filter(|(_, is_given)| *is_given) {
                problems.add(format!(
                    "heat.{key} stands beside balls.motion = \"free\", whose friction is a result; remove it, or use \
                     balls.motion = \"kinematic\""
                ));
            }
            return Some(FrictionLaw::FreeBalls);
        }
        if let Some(torque) = &self.torque {
            problems.require_positive(torque, "heat.torque", "a torque");
            for (key, _) in of_formula.iter().filter(|(_, is_given)| *is_given) {
                problems.add(format!(
                    "heat.torque and heat.{key} both say how much friction there is; keep one way"
                ));
            }
            return Some(FrictionLaw::Given(torque.si()));
        }
        let (Some(f_0), Some(f_1)) = (self.f_0, self.f_1) else {
            problems.add(
                "[heat] has no friction; add heat.torque, or heat.f_0, heat.f_1 and a viscosity of Palmgren's formula; \
                 or free balls",
            );
            return None;
        };
        for (key, factor, most) in [
            ("heat.f_0", f_0, MOST_OIL_FACTOR),
            ("heat.f_1", f_1, MOST_LOAD_FACTOR),
        ] {
            let rule =
                format!("expected 0 to {most}; catalogues have f_0 of 0.7 to 12 and f_1 of 0.0002 to 0.002");
            problems.require((0.0..=most).contains(&factor), key, factor, rule);
        }
        Some(FrictionLaw::Palmgren {
            oil_factor: f_0,
            load_factor: f_1,
            oil: self.oil(problems)?,
        })
    }

    fn oil(&self, problems: &mut Problems) -> Option<Oil> {
        match (&self.viscosity, self.viscosity_class) {
            (Some(_), Some(_)) => {
                problems.add(
                    "heat.viscosity and heat.viscosity_class both say how thick the oil is; keep one of them",
                );
                None
            }
            (None, None) => {
                problems.add(
                    "Palmgren's formula of [heat] has no viscosity; add heat.viscosity, such as \"24 mm2/s\", or \
                     heat.viscosity_class with heat.viscosity_at_100",
                );
                None
            }
            (Some(viscosity), None) => {
                problems.require_positive(viscosity, "heat.viscosity", "a viscosity");
                Some(Oil::Viscosity(viscosity.si()))
            }
            (None, Some(class)) => {
                if self.viscosity_at_100.is_none() {
                    problems.add(
                        "heat.viscosity_class is the viscosity at 40 degC, and the bearing has the temperature that is \
                         found; add heat.viscosity_at_100 from the data sheet of the oil, or give heat.viscosity",
                    );
                    return None;
                }
                let keys = ClassKeys {
                    table: "heat",
                    class: Some(class),
                    at_100: self.viscosity_at_100.as_ref(),
                    temperature_key: "ambient",
                    temperature: Some(&self.ambient),
                };
                keys.oil(class, problems)
            }
        }
    }
}

/// Whether heat flows from a body to the surroundings.
fn reaches(from: usize, conductances: &[([usize; 2], f64)]) -> bool {
    let mut seen = [false; SURROUNDINGS + 1];
    seen[from] = true;
    for _ in 0..seen.len() {
        for ([a, b], _) in conductances {
            let either = seen[*a] || seen[*b];
            (seen[*a], seen[*b]) = (either, either);
        }
        // The surroundings hand no heat on.
        if seen[SURROUNDINGS] {
            return true;
        }
    }
    false
}
