//! A coefficient of thermal expansion: `"11.5e-6 /K"`, held in 1/K.
//!
//! Temperatures are no dimension of a [`Quantity`](crate::Quantity), so their inverse is none either.

use std::fmt;
use std::str::FromStr;

use serde::de::{Deserialize, Deserializer, Error, Visitor};

use crate::problems::Problems;
use crate::units::{bare_number, with_unit_of};

/// A coefficient of linear thermal expansion.
#[derive(Clone, Debug)]
pub struct Expansion {
    per_kelvin: f64,
    /// As typed, for messages.
    typed: String,
}

/// What messages ask for.
const EXPECTED: &str = "a thermal expansion such as \"11.5e-6 /K\"";
/// Units and their size, 1/K.
const UNITS: [(&str, f64); 4] = [("/K", 1.0), ("1/K", 1.0), ("/degC", 1.0), ("1/degC", 1.0)];
/// Larger than that of any solid a machine is made of, 1/K.
const MOST: f64 = 1e-3;

impl Expansion {
    /// Value, 1/K.
    pub fn per_kelvin(&self) -> f64 {
        self.per_kelvin
    }

    /// Reports one that no solid has.
    pub fn check(&self, key: &str, problems: &mut Problems) {
        problems.require(
            self.per_kelvin.abs() <= MOST,
            key,
            self,
            "expected at most 1e-3 /K, bearing steel has 11.5e-6 /K to 12.5e-6 /K",
        );
    }
}

impl PartialEq for Expansion {
    /// Equal in 1/K, however they were typed.
    fn eq(&self, other: &Self) -> bool {
        self.per_kelvin == other.per_kelvin
    }
}

impl fmt::Display for Expansion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.typed)
    }
}

impl FromStr for Expansion {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let typed = text.trim();
        let (value, size) = with_unit_of(&UNITS, typed)
            .map_err(|reason| format!("{text:?} {reason}; expected {EXPECTED}"))?;
        Ok(Expansion {
            per_kelvin: value * size,
            typed: typed.to_string(),
        })
    }
}

impl<'de> Deserialize<'de> for Expansion {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ExpansionVisitor;

        impl Visitor<'_> for ExpansionVisitor {
            type Value = Expansion;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(EXPECTED)
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Expansion, E> {
                text.parse().map_err(E::custom)
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<Expansion, E> {
                Err(E::custom(bare_number(value, EXPECTED)))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Expansion, E> {
                Err(E::custom(bare_number(value as f64, EXPECTED)))
            }
        }

        deserializer.deserialize_any(ExpansionVisitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a ring would grow with another coefficient than the scene says.
    #[test]
    fn an_expansion_is_read_per_kelvin() {
        for text in ["11.5e-6 /K", "11.5e-6/K", "11.5e-6 1/K", "11.5e-6 /degC"] {
            let read: Expansion = text.parse().unwrap();
            assert_eq!(read.per_kelvin(), 11.5e-6, "{text}");
        }
    }

    /// Wrong: a slip of the unit would be read as another expansion.
    #[test]
    fn what_is_no_expansion_is_said() {
        for (text, said) in [
            (
                "11.5e-6",
                "\"11.5e-6\" has no unit, of which \"/K\", \"1/K\", \"/degC\", \"1/degC\" are known; expected a \
                 thermal expansion such as \"11.5e-6 /K\"",
            ),
            (
                "23 um/m/K",
                "\"23 um/m/K\" has the unknown unit \"um/m/K\", known are \"/K\", \"1/K\", \"/degC\", \"1/degC\"; \
                 expected a thermal expansion such as \"11.5e-6 /K\"",
            ),
            ("warm /K", "\"warm /K\" does not begin with a number"),
            ("inf /K", "\"inf /K\" does not begin with a number"),
            ("1e400 /K", "\"1e400 /K\" is not a finite number"),
        ] {
            let message = text.parse::<Expansion>().unwrap_err();
            assert!(message.starts_with(said), "{message}");
        }
        let mut problems = Problems::default();
        let large: Expansion = "11.5 /K".parse().unwrap();
        large.check("materials.rings.expansion", &mut problems);
        let said =
            "materials.rings.expansion is 11.5 /K; expected at most 1e-3 /K, bearing steel has 11.5e-6 /K";
        assert!(problems.into_texts()[0].starts_with(said));
    }
}
