//! A temperature on a scale with a zero: `"70 degC"` or `"343.15 K"`, held in kelvin.
//!
//! Celsius has an offset, so a temperature is no [`Quantity`](crate::Quantity): it takes no prefix and no power.

use std::fmt;
use std::str::FromStr;

use serde::de::{Deserialize, Deserializer, Error, Visitor};

use crate::units::bare_number;

/// A temperature above absolute zero.
#[derive(Clone, Debug)]
pub struct Temperature {
    kelvin: f64,
    /// As typed, for messages.
    typed: String,
}

/// 0 degC in kelvin (BIPM, The International System of Units, 9th ed., 2.3.1).
const CELSIUS_ZERO: f64 = 273.15;
/// What messages ask for.
const EXPECTED: &str = "a temperature such as \"70 degC\" or \"343 K\"";

impl Temperature {
    /// Value, K.
    pub fn kelvin(&self) -> f64 {
        self.kelvin
    }

    /// Value, degC.
    pub fn celsius(&self) -> f64 {
        self.kelvin - CELSIUS_ZERO
    }
}

impl PartialEq for Temperature {
    /// Equal in kelvin, however they were typed.
    fn eq(&self, other: &Self) -> bool {
        self.kelvin == other.kelvin
    }
}

impl fmt::Display for Temperature {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.typed)
    }
}

impl FromStr for Temperature {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let typed = text.trim();
        let split = typed.find(|c: char| c.is_alphabetic() && !matches!(c, 'e' | 'E') || c == '°');
        let (number, unit) = typed.split_at(split.unwrap_or(typed.len()));
        let wrong = |reason: &str| format!("{text:?} {reason}; expected {EXPECTED}");
        let number: f64 = match number.trim().parse() {
            Ok(number) => number,
            Err(_) => return Err(wrong("does not begin with a number")),
        };
        let offset = match unit {
            "" => return Err(wrong("has no unit")),
            "degC" | "°C" => CELSIUS_ZERO,
            "K" => 0.0,
            _ => return Err(wrong(&format!("has the unknown unit {unit:?}"))),
        };
        let kelvin = number + offset;
        if !kelvin.is_finite() || kelvin <= 0.0 {
            return Err(wrong("is no temperature above absolute zero"));
        }
        Ok(Temperature {
            kelvin,
            typed: typed.to_string(),
        })
    }
}

impl<'de> Deserialize<'de> for Temperature {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct TemperatureVisitor;

        impl Visitor<'_> for TemperatureVisitor {
            type Value = Temperature;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(EXPECTED)
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Temperature, E> {
                text.parse().map_err(E::custom)
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<Temperature, E> {
                Err(E::custom(bare_number(value, EXPECTED)))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Temperature, E> {
                Err(E::custom(bare_number(value, EXPECTED)))
            }
        }

        deserializer.deserialize_any(TemperatureVisitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: an oil would have the viscosity of another temperature.
    #[test]
    fn both_scales_read_as_kelvin() {
        for (text, kelvin) in [
            ("70 degC", 343.15),
            ("-20degC", 253.15),
            ("0 °C", 273.15),
            ("343.15 K", 343.15),
            ("1e2 degC", 373.15),
        ] {
            let read: Temperature = text.parse().unwrap();
            assert!(
                (read.kelvin() - kelvin).abs() < 1e-12,
                "{text}: {}",
                read.kelvin()
            );
        }
        let warm: Temperature = "40 degC".parse().unwrap();
        assert!((warm.celsius() - 40.0).abs() < 1e-12);
    }

    /// Wrong: a slip in a temperature would be read as another one.
    #[test]
    fn what_is_no_temperature_is_said() {
        for (text, said) in [
            (
                "70",
                "\"70\" has no unit; expected a temperature such as \"70 degC\"",
            ),
            ("70 F", "\"70 F\" has the unknown unit \"F\""),
            ("70 mm", "\"70 mm\" has the unknown unit \"mm\""),
            ("degC", "\"degC\" does not begin with a number"),
            ("-300 degC", "\"-300 degC\" is no temperature above absolute zero"),
        ] {
            let message = text.parse::<Temperature>().unwrap_err();
            assert!(message.starts_with(said), "{message}");
        }
    }
}
