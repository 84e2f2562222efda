//! Collects everything that is wrong with an input, so that one run of the program reports it all.

use std::fmt::Display;

use crate::units::Quantity;

/// The problems found so far, in the order of the checks.
#[derive(Debug, Default)]
pub struct Problems(Vec<String>);

impl Problems {
    /// Number of problems so far.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether nothing is wrong so far.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The texts, in order of discovery.
    pub fn into_texts(self) -> Vec<String> {
        self.0
    }

    /// Adds a problem as a whole sentence.
    pub fn add(&mut self, text: impl Into<String>) {
        self.0.push(text.into());
    }

    /// Adds `key is value; rule` unless `holds`. A comparison with NaN does not hold, so NaN is reported.
    pub fn require(&mut self, holds: bool, key: &str, value: impl Display, rule: impl Display) {
        if !holds {
            self.add(format!("{key} is {}; {rule}", short(&value.to_string())));
        }
    }

    /// Requires `0 < quantity`, in the words `a diameter must be positive`.
    pub fn require_positive<const K: usize>(&mut self, quantity: &Quantity<K>, key: &str, noun: &str) {
        self.require(
            quantity.si() > 0.0,
            key,
            quantity,
            format!("{noun} must be positive"),
        );
    }

    /// Requires a whole number in `min..=max` and returns it; the value is clamped when it is reported.
    pub fn whole(&mut self, value: i64, key: &str, min: i64, max: i64) -> usize {
        self.require(
            (min..=max).contains(&value),
            key,
            value,
            format!("expected a whole number from {min} to {max}"),
        );
        usize::try_from(value.clamp(min, max)).unwrap_or(0)
    }
}

/// A number of hundreds of digits with its power of ten.
fn short(text: &str) -> String {
    const LONG: usize = 24;
    match text.parse::<f64>() {
        Ok(number) if text.len() > LONG => format!("{number:e}"),
        _ => text.to_string(),
    }
}
