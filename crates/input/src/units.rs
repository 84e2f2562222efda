//! Physical quantities of a scene: a number with its unit as a string, `"9 mm"`, held in SI.
//!
//! A quantity is a decimal number followed by a unit expression:
//!
//! - symbols `m in ft g t lb s min h rad deg ° rev rpm Hz N kgf lbf Pa bar psi ksi Msi J W`;
//! - prefixes `T G M k d c m u µ n p f` before `m g s rad Hz N Pa bar J W`;
//! - products by a space, `*`, `.` or `·`; quotients by `/`, whose right side is one symbol or a parenthesis
//!   (`kg/m s` is refused as ambiguous);
//! - powers `^1.5`, `^(10/9)`, trailing digits (`m3`, `s-2`) or superscripts (`m³`, `s⁻²`).
//!
//! Powers of ten never round: `"9 mm"` is read as the decimal `9e-3`, so it is the double a reader types for
//! it, bit for bit. Angles count as a dimension of their own, so that `"5 1/s"` is not taken for an angular
//! speed. Cost: microseconds per quantity.

mod error;
mod expression;
mod kind;
mod number;
mod symbol;
#[cfg(test)]
mod tests;
mod unit;

use std::fmt;
use std::str::FromStr;

use serde::de::{Deserialize, Deserializer, Visitor};
use serde::{Serialize, Serializer};

pub use self::error::UnitError;
pub use self::kind::{
    ACCELERATION, ANGLE, ANGULAR_SPEED, DAMPING, DENSITY, DYNAMIC_VISCOSITY, FORCE, HERTZ_STIFFNESS, INERTIA,
    KINDS, Kind, LENGTH, MASS, MOMENT, PRESSURE_COEFFICIENT, RATE, SPEED, STIFFNESS, STRESS, TIME, VISCOSITY,
    kind_of_dimension,
};
use self::number::Decimal;
pub use self::unit::Dimension;

/// A quantity of one kind: `Quantity<LENGTH>` reads `"9 mm"` and refuses `"9 N"`.
#[derive(Clone, Debug)]
pub struct Quantity<const KIND: usize> {
    /// Value, SI unit of the kind.
    si: f64,
    /// As typed, for messages and for writing the scene back.
    typed: String,
}

impl<const KIND: usize> Quantity<KIND> {
    /// Name, dimension and example of this kind.
    pub const KIND: &'static Kind = &kind::KINDS[KIND];

    /// A quantity computed by the program; it displays with a prefix where its unit takes one.
    pub fn from_si(si: f64) -> Self {
        Quantity {
            si,
            typed: Self::KIND.format_si(si),
        }
    }

    /// A quantity computed by the program, for messages: ten digits, without the round-off of its computation.
    pub fn about(si: f64) -> Self {
        Self::from_si(ten_digits(si))
    }

    /// Value, SI unit of the kind.
    pub fn si(&self) -> f64 {
        self.si
    }

    /// Reads a quantity where other words are possible too: `expected` ends the messages.
    pub fn parse_expecting(text: &str, expected: &str) -> Result<Self, UnitError> {
        let any = parse(text, expected, Some(Self::KIND.dimension))?;
        require_dimension(text, any.dimension, Self::KIND, expected.to_string())?;
        Ok(Quantity {
            si: any.si,
            typed: text.to_string(),
        })
    }
}

impl<const KIND: usize> PartialEq for Quantity<KIND> {
    /// Equal in SI, however they were typed.
    fn eq(&self, other: &Self) -> bool {
        self.si == other.si
    }
}

impl<const KIND: usize> FromStr for Quantity<KIND> {
    type Err = UnitError;

    fn from_str(text: &str) -> Result<Self, UnitError> {
        Self::parse_expecting(text, &Self::KIND.expected())
    }
}

impl<const KIND: usize> fmt::Display for Quantity<KIND> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.typed)
    }
}

impl<const KIND: usize> Serialize for Quantity<KIND> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.typed)
    }
}

impl<'de, const KIND: usize> Deserialize<'de> for Quantity<KIND> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct QuantityVisitor<const KIND: usize>;

        impl<const KIND: usize> Visitor<'_> for QuantityVisitor<KIND> {
            type Value = Quantity<KIND>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(&kind::KINDS[KIND].expected())
            }

            fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Self::Value, E> {
                text.parse().map_err(E::custom)
            }

            fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<Self::Value, E> {
                Err(E::custom(bare_number(value, &kind::KINDS[KIND].expected())))
            }

            fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<Self::Value, E> {
                Err(E::custom(bare_number(value, &kind::KINDS[KIND].expected())))
            }
        }

        deserializer.deserialize_any(QuantityVisitor)
    }
}

/// Rounded to ten digits, for messages and to hide round-off.
pub fn ten_digits(value: f64) -> f64 {
    format!("{value:.9e}").parse().unwrap_or(value)
}

/// The message for a number that has no unit because it is not even a string.
pub fn bare_number(value: impl fmt::Display, expected: &str) -> String {
    format!("{value} is a number without a unit; expected {expected}, in quotes")
}

/// A quantity of any kind, for lists whose kind is known only by the key they are for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnyQuantity {
    /// Value, SI.
    pub si: f64,
    /// Exponents of the base units.
    pub dimension: Dimension,
}

impl FromStr for AnyQuantity {
    type Err = UnitError;

    fn from_str(text: &str) -> Result<Self, UnitError> {
        parse(text, "a quantity such as \"2 kN\"", None)
    }
}

/// Size of the named unit in SI: 1e-3 for `mm` and [`LENGTH`].
pub fn parse_unit(text: &str, kind: &Kind) -> Result<f64, UnitError> {
    let expected = format!("a unit of {} such as \"{}\"", kind.noun(), kind.example_unit());
    let unit = text.trim();
    let wanted = (unit, Some(kind.dimension));
    let unit = expression::parse(unit).map_err(|e| e.into_error(text, &expected, wanted))?;
    require_dimension(text, unit.dimension, kind, expected)?;
    Ok(unit.apply(&Decimal::ONE))
}

/// Reads number and unit; `expected` ends the messages, and the dimension is that of what they suggest.
fn parse(text: &str, expected: &str, wanted: Option<Dimension>) -> Result<AnyQuantity, UnitError> {
    let owned = || (text.to_string(), expected.to_string());
    let trimmed = text.trim();
    let Some((decimal, rest)) = Decimal::split(trimmed) else {
        let (text, expected) = owned();
        return Err(match number::is_named_non_finite(trimmed) {
            true => UnitError::NotFinite { text, expected },
            false => UnitError::NoNumber { text, expected },
        });
    };
    if rest.trim().is_empty() {
        let (text, expected) = owned();
        return Err(UnitError::NoUnit { text, expected });
    }
    if let Some(reason) = number::way_of_writing(trimmed, rest) {
        let (text, expected) = owned();
        return Err(UnitError::Malformed {
            text,
            reason,
            expected,
        });
    }
    let unit = rest.trim();
    let unit = expression::parse(unit).map_err(|e| e.into_error(text, expected, (unit, wanted)))?;
    let si = unit.apply(&decimal);
    if !si.is_finite() {
        let (text, expected) = owned();
        return Err(UnitError::NotFinite { text, expected });
    }
    Ok(AnyQuantity {
        si,
        dimension: unit.dimension,
    })
}

fn require_dimension(text: &str, found: Dimension, kind: &Kind, expected: String) -> Result<(), UnitError> {
    if kind::same_dimension(found, kind.dimension) {
        return Ok(());
    }
    Err(UnitError::WrongDimension {
        text: text.to_string(),
        found: kind::describe_instead_of(found, kind),
        expected,
    })
}

/// Number and size of the unit of a text, for quantities per kelvin, which have a few whole units of their own (symbol,
/// size); else what is wrong with it, behind the text itself.
pub(crate) fn with_unit_of(units: &[(&str, f64)], text: &str) -> Result<(f64, f64), String> {
    let Some((number, rest)) = number::Decimal::split(text) else {
        return Err("does not begin with a number".to_string());
    };
    let unit = rest.trim();
    let Some((_, size)) = units.iter().find(|(symbol, _)| *symbol == unit) else {
        let known = units.iter().map(|(symbol, _)| format!("{symbol:?}"));
        let known = known.collect::<Vec<_>>().join(", ");
        return Err(match unit {
            "" => format!("has no unit, of which {known} are known"),
            _ => format!("has the unknown unit {unit:?}, known are {known}"),
        });
    };
    let value = number.times_power_of_ten(0);
    match value.is_finite() {
        true => Ok((value, *size)),
        false => Err("is not a finite number".to_string()),
    }
}
