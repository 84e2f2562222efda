//! What lubricates the contacts. It changes what a run computes by traction with law = "limiting_shear" and by the room
//! that films take with `lift_load`, else nothing.
//!
//! ```toml
#![doc = include_str!("example_lubricant.toml")]
//! ```

use contact::BySide;
use contact::film::Lubricant;
use input::{
    DENSITY, DYNAMIC_VISCOSITY, FORCE, LENGTH, PRESSURE_COEFFICIENT, Problems, Quantity, Temperature,
    VISCOSITY,
};
use serde::Deserialize;

use super::oil::ClassKeys;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [lubricant]")]
pub struct RawLubricant {
    viscosity: Option<Quantity<DYNAMIC_VISCOSITY>>,
    viscosity_class: Option<f64>,
    viscosity_at_100: Option<Quantity<VISCOSITY>>,
    temperature: Option<Temperature>,
    density: Option<Quantity<DENSITY>>,
    pressure_coefficient: Quantity<PRESSURE_COEFFICIENT>,
    lift_load: Option<Quantity<FORCE>>,
    roughness: Option<RawRoughness>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with inner, outer, balls")]
struct RawRoughness {
    inner: Quantity<LENGTH>,
    outer: Quantity<LENGTH>,
    balls: Quantity<LENGTH>,
}

/// What lubricates the contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lubrication {
    /// The oil at the temperature of the contacts.
    pub lubricant: Lubricant,
    /// Load of a contact, N, whose film lifts all balls off their grooves; None: films take no room.
    pub lift_load: Option<f64>,
    /// Roughness of the surfaces; None: there is no lambda.
    pub roughness: Option<Roughness>,
}

/// Root mean square roughness of the surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roughness {
    /// Raceways, inner first, m.
    pub raceways: BySide<f64>,
    /// Balls, m.
    pub balls: f64,
}

/// How the rings of a bearing turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turns {
    /// At constant speeds.
    Steadily,
    /// At speeds that change.
    Changing,
}

/// No oil has a larger pressure coefficient, 1/Pa.
const MOST_COEFFICIENT: f64 = 1e-7;
/// No surface that rolls is rougher, m.
const MOST_ROUGHNESS: f64 = 1e-5;

impl RawLubricant {
    /// Checks values and what belongs together; `turns`: how the rings turn, None where no contact rolls.
    pub fn check(&self, turns: Option<Turns>, problems: &mut Problems) -> Option<Lubrication> {
        let xi = &self.pressure_coefficient;
        problems.require(
            xi.si() > 0.0 && xi.si() <= MOST_COEFFICIENT,
            "lubricant.pressure_coefficient",
            xi,
            "expected above 0 to 100 1/GPa, mineral oils have 15 to 30 1/GPa",
        );
        self.check_lift(turns, problems);
        if turns.is_none() {
            problems.add(
                "[lubricant] makes no film in a bearing that stands still; add [speed] with inner = \"1800 rpm\" to a \
                 scene in which it turns, or remove [lubricant]",
            );
        }
        let viscosity = self.viscosity(problems)?;
        Some(Lubrication {
            lubricant: Lubricant {
                viscosity,
                pressure_coefficient: xi.si(),
            },
            lift_load: self.lift_load.as_ref().map(Quantity::si),
            roughness: self.roughness.as_ref().map(|roughness| roughness.check(problems)),
        })
    }

    fn check_lift(&self, turns: Option<Turns>, problems: &mut Problems) {
        let Some(load) = &self.lift_load else { return };
        problems.require_positive(load, "lubricant.lift_load", "a load");
        if turns == Some(Turns::Changing) {
            problems.add(
                "lubricant.lift_load gives films of one thickness, but [speed] changes; give a constant speed, or \
                 remove it: films take no room then",
            );
        }
    }

    /// Dynamic viscosity, Pa s.
    fn viscosity(&self, problems: &mut Problems) -> Option<f64> {
        let keys = ClassKeys {
            table: "lubricant",
            class: self.viscosity_class,
            at_100: self.viscosity_at_100.as_ref(),
            temperature_key: "temperature",
            temperature: self.temperature.as_ref(),
        };
        keys.check_idle(problems);
        if self.density.is_some() && self.viscosity_class.is_none() {
            problems.add(
                "lubricant.density does nothing without lubricant.viscosity_class; add the class, or remove it",
            );
        }
        match (&self.viscosity, self.viscosity_class) {
            (Some(_), Some(_)) => {
                problems.add(
                    "lubricant.viscosity and lubricant.viscosity_class both say how thick the oil is; keep one of them",
                );
                None
            }
            (None, None) => {
                problems.add(
                    "[lubricant] has no viscosity; add viscosity, such as \"40 mPa s\", or viscosity_class with \
                     temperature and density",
                );
                None
            }
            (Some(viscosity), None) => {
                problems.require_positive(viscosity, "lubricant.viscosity", "a viscosity");
                Some(viscosity.si())
            }
            (None, Some(class)) => {
                let oil = keys.oil(class, problems)?;
                let Some(density) = &self.density else {
                    problems.add(
                        "lubricant.viscosity_class is a kinematic viscosity; add lubricant.density of the oil, such as \
                         \"870 kg/m3\"",
                    );
                    return None;
                };
                problems.require_positive(density, "lubricant.density", "a density");
                Some(oil.viscosity()? * density.si())
            }
        }
    }
}

impl RawRoughness {
    fn check(&self, problems: &mut Problems) -> Roughness {
        for (key, roughness) in [
            ("inner", &self.inner),
            ("outer", &self.outer),
            ("balls", &self.balls),
        ] {
            problems.require(
                roughness.si() > 0.0 && roughness.si() <= MOST_ROUGHNESS,
                &format!("lubricant.roughness.{key}"),
                roughness,
                "expected above 0 to 10 um, ground raceways have 0.02 um to 0.2 um",
            );
        }
        Roughness {
            raceways: [self.inner.si(), self.outer.si()],
            balls: self.balls.si(),
        }
    }
}
