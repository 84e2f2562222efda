//! A thermal conductance: `"5 W/K"`, held in W/K.
//!
//! Temperatures are no dimension of a [`Quantity`](crate::Quantity), so what is counted per kelvin is none either.

use std::fmt;
use std::str::FromStr;

use serde::de::{Deserialize, Deserializer, Error, Visitor};

use crate::problems::Problems;
use crate::units::{bare_number, with_unit_of};

/// Heat that flows between two bodies per kelvin between them.
#[derive(Clone, Debug)]
pub struct Conductance {
    watt_per_kelvin: f64,
    /// As typed, for messages.
    typed: String,
}

/// What messages ask for.
const EXPECTED: &str = "a thermal conductance such as \"5 W/K\"";
/// Units and their size, W/K.
const UNITS: [(&str, f64); 3] = [("W/K", 1.0), ("mW/K", 1e-3), ("kW/K", 1e3)];

impl Conductance {
    /// Value, W/K.
    pub fn watt_per_kelvin(&self) -> f64 {
        self.watt_per_kelvin
    }

    /// Reports one that carries no heat.
    pub fn check(&self, key: &str, problems: &mut Problems) {
        problems.require(
            self.watt_per_kelvin > 0.0,
            key,
            self,
            "a conductance must be positive; leave out what carries no heat",
        );
    }
}

impl PartialEq for Conductance {
    /// Equal in W/K, however they were typed.
    fn eq(&self, other: &Self) -> bool {
        self.watt_per_kelvin == other.watt_per_kelvin
    }
}

impl fmt::Display for Conductance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.typed)
    }
}

impl FromStr for Conductance {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let typed = text.trim();
        let (value, size) = with_unit_of(&UNITS, typed)
            .map_err(|reason| format!("{text:?} {reason}; expected {EXPECTED}"))?;
        Ok(Conductance {
            watt_per_kelvin: value * size,
            typed: typed.to_string(),
        })
    }
}

impl<'de> Deserialize<'de> for Conductance {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ConductanceVisitor;

        impl Visitor<'_> for ConductanceVisitor {
            type Value = Conductance;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(EXPECTED)
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Conductance, E> {
                text.parse().map_err(E::custom)
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<Conductance, E> {
                Err(E::custom(bare_number(value, EXPECTED)))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Conductance, E> {
                Err(E::custom(bare_number(value as f64, EXPECTED)))
            }
        }

        deserializer.deserialize_any(ConductanceVisitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: heat would flow more easily than the scene says.
    #[test]
    fn a_conductance_is_read_in_watt_per_kelvin() {
        for (text, value) in [
            ("5 W/K", 5.0),
            ("5W/K", 5.0),
            ("250 mW/K", 0.25),
            ("0.1 kW/K", 100.0),
        ] {
            let read: Conductance = text.parse().unwrap();
            assert_eq!(read.watt_per_kelvin(), value, "{text}");
        }
    }

    /// Wrong: a slip of the unit would be read as another conductance.
    #[test]
    fn what_is_no_conductance_is_said() {
        for (text, said) in [
            (
                "5",
                "\"5\" has no unit, of which \"W/K\", \"mW/K\", \"kW/K\" are known; expected \
                 a thermal conductance such as \"5 W/K\"",
            ),
            ("much W/K", "\"much W/K\" does not begin with a number"),
        ] {
            let message = text.parse::<Conductance>().unwrap_err();
            assert!(message.starts_with(said), "{message}");
        }
        let mut problems = Problems::default();
        let none: Conductance = "0 W/K".parse().unwrap();
        none.check("heat.conductance.inner_ambient", &mut problems);
        let said =
            "heat.conductance.inner_ambient is 0 W/K; a conductance must be positive; leave out what carries";
        assert!(problems.into_texts()[0].starts_with(said));
    }
}
