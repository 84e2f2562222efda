//! `[static]` or `[sweep]`: equilibria; with `[quasi_static]`, `[dynamic]` and `[modes]`, what is computed.
//!
//! A sweep solves the same scene for a list of values of one key, each from the solution before it. Every
//! point is a scene of its own: the text with the key replaced and `[sweep]` turned into `[static]`.

use std::fmt;

use input::{AnyQuantity, Dimension, Expansion, Problems, Temperature, kind_of_dimension};
use serde::Deserialize;
use serde::de::{Deserializer, Error, Visitor};
use toml_edit::{DocumentMut, Value};

use super::dynamic::Dynamic;
use super::edit;
use super::modes::Modes;
use super::quasi_static::QuasiStatic;

/// As typed: the table has no keys.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the empty table [static]")]
pub struct RawStatic {}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [sweep]")]
pub struct RawSweep {
    key: String,
    values: Option<Vec<RawValue>>,
    from: Option<RawValue>,
    to: Option<RawValue>,
    steps: Option<i64>,
}

/// As typed: a quantity in quotes or a pure number.
#[derive(Clone, Debug)]
struct RawValue {
    /// SI, or the number itself.
    si: f64,
    unit: SweptUnit,
    /// How it is put into the scene of its point.
    toml: Value,
}

/// What a value is counted in.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SweptUnit {
    /// Base units, or none.
    Base(Dimension),
    Kelvin,
    PerKelvin,
}

impl SweptUnit {
    /// A value with its unit as typed.
    fn read(text: &str) -> Result<(f64, SweptUnit), String> {
        let has_kelvin = ["K", "degC", "°C"].iter().any(|unit| text.trim().ends_with(unit));
        match (has_kelvin, text.contains('/')) {
            (true, false) => text
                .parse()
                .map(|temperature: Temperature| (temperature.kelvin(), SweptUnit::Kelvin)),
            (true, true) => text
                .parse()
                .map(|expansion: Expansion| (expansion.per_kelvin(), SweptUnit::PerKelvin)),
            (false, _) => text
                .parse()
                .map(|AnyQuantity { si, dimension }| (si, SweptUnit::Base(dimension)))
                .map_err(|error| error.to_string()),
        }
    }

    /// Ending of the name of a column.
    fn column_suffix(self) -> &'static str {
        match self {
            SweptUnit::Base(dimension) => kind_of_dimension(dimension).map_or("", |kind| kind.column_suffix),
            SweptUnit::Kelvin => "_k",
            SweptUnit::PerKelvin => "_per_k",
        }
    }

    /// A value in SI as a scene has it.
    fn toml(self, si: f64) -> Value {
        match self {
            SweptUnit::Base(dimension) => match kind_of_dimension(dimension) {
                Some(kind) if !kind.si_unit.is_empty() => Value::from(kind.format_si(si)),
                _ => Value::from(si),
            },
            SweptUnit::Kelvin => Value::from(format!("{si} K")),
            SweptUnit::PerKelvin => Value::from(format!("{si:e} /K")),
        }
    }
}

/// What is computed.
#[derive(Clone, Debug, PartialEq)]
pub enum Analysis {
    /// One static equilibrium.
    Static,
    /// Static equilibria along a list of values of one key.
    Sweep(Sweep),
    /// Equilibria in time, while the bearing turns.
    QuasiStatic(QuasiStatic),
    /// Motion in time.
    Dynamic(Dynamic),
    /// Natural frequencies and shapes.
    Modes(Modes),
}

/// Values of one key.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Dotted path of the key in the scene.
    pub key: String,
    /// Name of its column in a table, with the SI unit: `effects.axial_force.value_n`.
    pub column: String,
    /// In the order they are solved.
    pub points: Vec<SweepPoint>,
}

/// One point of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPoint {
    /// The swept value, SI.
    pub value: f64,
    /// The scene of this point, a static one.
    pub text: String,
}

/// Longer sweeps are slips of the keyboard.
const MAX_STEPS: i64 = 10_000;

impl RawSweep {
    /// Checks the list and writes the scenes of its points; `document` is the scene as typed.
    pub fn check(&self, document: &DocumentMut, problems: &mut Problems) -> Option<Sweep> {
        let values = self.list(problems)?;
        let first = values.first()?;
        if let Some(i) = values.iter().position(|v| v.unit != first.unit) {
            problems.add(format!(
                "sweep.values[{i}] is {} while sweep.values[0] is {}; all must be of the same kind",
                values[i].toml.to_string().trim(),
                first.toml.to_string().trim()
            ));
            return None;
        }
        let root = self.key.split('.').next().unwrap_or("");
        if matches!(
            root,
            "sweep"
                | "static"
                | "quasi_static"
                | "dynamic"
                | "modes"
                | "title"
                | "output"
                | "stress"
                | "probes"
                | "life"
                | ""
        ) || !self.key.contains('.')
        {
            problems.add(format!(
                "sweep.key is {:?}; expected the path of a number in the scene such as \"effects.axial_force.value\"",
                self.key
            ));
            return None;
        }
        let suffix = first.unit.column_suffix();
        let mut points = Vec::with_capacity(values.len());
        for value in &values {
            match edit::point_text(document, &self.key, value.toml.clone()) {
                Ok(text) => points.push(SweepPoint {
                    value: value.si,
                    text,
                }),
                Err(reason) => {
                    problems.add(format!("sweep.key is {:?}; {reason}", self.key));
                    return None;
                }
            }
        }
        Some(Sweep {
            key: self.key.clone(),
            column: format!("{}{suffix}", self.key),
            points,
        })
    }

    /// Either the typed values or equal steps from the first to the last.
    fn list(&self, problems: &mut Problems) -> Option<Vec<RawValue>> {
        match (&self.values, &self.from, &self.to, self.steps) {
            (Some(values), None, None, None) => {
                if values.is_empty() {
                    problems.add("sweep.values is empty; expected at least one value");
                }
                Some(values.clone())
            }
            (None, Some(from), Some(to), Some(steps)) => {
                let before = problems.len();
                let n = problems.whole(steps, "sweep.steps", 1, MAX_STEPS);
                if from.unit != to.unit {
                    problems.add(
                        "sweep.from and sweep.to are of different kinds; expected the same such as \"0 kN\" \
 and \"3 kN\"",
                    );
                }
                (problems.len() == before).then(|| equal_steps(from, to, n))
            }
            _ => {
                problems.add(
                    "sweep needs either values, a list, or all three of from, to and steps (the number of intervals)",
                );
                None
            }
        }
    }
}

/// n intervals, so n + 1 values; the ends are kept as typed.
fn equal_steps(from: &RawValue, to: &RawValue, n: usize) -> Vec<RawValue> {
    let between = |i: usize| {
        let si = from.si + (to.si - from.si) * (i as f64 / n as f64);
        RawValue {
            si,
            unit: from.unit,
            toml: from.unit.toml(si),
        }
    };
    let mut values = vec![from.clone()];
    values.extend((1..n).map(between));
    values.push(to.clone());
    values
}

impl<'de> Deserialize<'de> for RawValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ValueVisitor;

        impl Visitor<'_> for ValueVisitor {
            type Value = RawValue;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a quantity such as \"2 kN\" or a number")
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<RawValue, E> {
                let (si, unit) = SweptUnit::read(text).map_err(E::custom)?;
                Ok(RawValue {
                    si,
                    unit,
                    toml: Value::from(text),
                })
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<RawValue, E> {
                Ok(RawValue {
                    si: value,
                    unit: SweptUnit::Base([0.0; 4]),
                    toml: Value::from(value),
                })
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<RawValue, E> {
                Ok(RawValue {
                    si: value as f64,
                    unit: SweptUnit::Base([0.0; 4]),
                    toml: Value::from(value),
                })
            }
        }

        deserializer.deserialize_any(ValueVisitor)
    }
}
