//! An axis: what it shows, in which unit, on which scale, and its range.

use crate::ticks::{self, Ticks};

/// How values become places on an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// In proportion.
    Linear,
    /// By their logarithm; values that are not positive have no place.
    Logarithmic,
}

/// An axis.
#[derive(Clone, Debug)]
pub struct Axis {
    name: String,
    unit: String,
    pub(crate) scale: Scale,
    pub(crate) step: Option<f64>,
    pub(crate) includes: Vec<f64>,
    pub(crate) resolution: f64,
    pub(crate) tight: Margin,
}

/// Room between the data and the ends of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Margin {
    /// None.
    None,
    /// A small part of the range.
    Small,
}

/// Part of the range that is left free on both ends.
const MARGIN: f64 = 0.04;

impl Axis {
    /// An axis in proportion. The unit is shown after the name; for pure numbers it is "1".
    pub fn linear(name: impl Into<String>, unit: impl Into<String>) -> Axis {
        Axis {
            name: name.into(),
            unit: unit.into(),
            scale: Scale::Linear,
            step: None,
            includes: Vec::new(),
            resolution: 0.0,
            tight: Margin::Small,
        }
    }

    /// A logarithmic axis.
    pub fn logarithmic(name: impl Into<String>, unit: impl Into<String>) -> Axis {
        Axis {
            scale: Scale::Logarithmic,
            ..Axis::linear(name, unit)
        }
    }

    /// Distance of the ticks of a linear axis, such as 45 for angles.
    pub fn ticks_every(mut self, step: f64) -> Axis {
        self.step = Some(step);
        self
    }

    /// Differences of a linear axis below `resolution` are round-off: a range that is smaller is shown as one value.
    pub fn no_finer_than(mut self, resolution: f64) -> Axis {
        self.resolution = resolution;
        self
    }

    /// Extends the range so that it holds `value`.
    pub fn including(mut self, value: f64) -> Axis {
        self.includes.push(value);
        self
    }

    /// The axis ends where the data end.
    pub fn tight(mut self) -> Axis {
        self.tight = Margin::None;
        self
    }

    /// Name and unit as shown.
    pub(crate) fn text(&self) -> String {
        match self.unit.as_str() {
            "" | "1" => format!("{} (-)", self.name),
            unit => format!("{} ({unit})", self.name),
        }
    }

    /// A value of this axis in words: name, number, unit.
    pub fn value(&self, value: f64) -> String {
        // Neither a long row of zeros nor nothing but zeros.
        let is_plain = value == 0.0 || (1e-3..1e9).contains(&value.abs());
        let (number, power) = match is_plain {
            true => (format!("{value:.4}"), String::new()),
            false => match format!("{value:.4e}").split_once('e') {
                Some((number, power)) => (number.to_string(), format!("e{power}")),
                None => (value.to_string(), String::new()),
            },
        };
        let number = match number.contains('.') {
            true => number.trim_end_matches('0').trim_end_matches('.'),
            false => &number,
        };
        let number = format!("{number}{power}");
        match self.unit.as_str() {
            "" | "1" => format!("{} {number}", self.name),
            unit => format!("{} {number} {unit}", self.name),
        }
    }

    /// Place of a value along the axis, before its mapping to pixels; none if it has no place.
    pub(crate) fn place(&self, value: f64) -> Option<f64> {
        match self.scale {
            Scale::Linear => Some(value).filter(|v| v.is_finite()),
            Scale::Logarithmic => (value > 0.0 && value.is_finite()).then(|| value.log10()),
        }
    }

    /// Lowest and highest place of `values` and what the axis must include, with margins, and the ticks in between.
    pub(crate) fn range(&self, values: impl Iterator<Item = f64>) -> Option<([f64; 2], Ticks)> {
        let places = values.chain(self.includes.iter().copied());
        let [low, high] = places
            .filter_map(|value| self.place(value))
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| {
                [low.min(p), high.max(p)]
            });
        if low > high {
            return None;
        }
        let (low, high) = widen(low, high, self.scale, self.resolution);
        let margin = match self.tight {
            Margin::None => 0.0,
            Margin::Small => MARGIN * (high - low),
        };
        // A range that starts at a value the axis must include, such as zero, starts there.
        let held = |end: f64| {
            self.includes
                .iter()
                .any(|&v| self.place(v).is_some_and(|p| p == end))
        };
        let low = if held(low) { low } else { low - margin };
        let high = if held(high) { high } else { high + margin };
        let ticks = match self.scale {
            Scale::Linear => ticks::linear(low, high, self.step),
            Scale::Logarithmic => ticks::logarithmic(low, high),
        };
        Some(([low, high], ticks))
    }
}

/// A range of one value gets a width.
fn widen(low: f64, high: f64, scale: Scale, resolution: f64) -> (f64, f64) {
    let largest = low.abs().max(high.abs());
    let smallest = match scale {
        Scale::Linear => resolution.max(1e-9 * largest),
        Scale::Logarithmic => 1e-3,
    };
    if high - low > smallest {
        return (low, high);
    }
    let half = match scale {
        Scale::Linear if largest <= resolution => 1.0,
        Scale::Linear => 0.05 * largest,
        Scale::Logarithmic => 0.5,
    };
    (low - half, high + half)
}
