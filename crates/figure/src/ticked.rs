//! An axis as the drawing library wants it: places to units, and the ticks that were laid out.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

use crate::layout::Span;

/// A laid-out axis.
pub struct Ticked(pub Span);

impl Ranged for Ticked {
    type ValueType = f64;
    type FormatOption = NoDefaultFormatting;

    fn map(&self, value: &f64, (first, last): (i32, i32)) -> i32 {
        let [low, high] = self.0.range;
        let part = (value - low) / (high - low);
        (f64::from(first) + part * f64::from(last - first)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        let ticks = &self.0.ticks;
        match hint.weight().allow_light_points() {
            true => ticks.minor.clone(),
            false => ticks.labelled.iter().map(|(place, _)| *place).collect(),
        }
    }

    fn range(&self) -> Range<f64> {
        self.0.range[0]..self.0.range[1]
    }
}

impl ValueFormatter<f64> for Ticked {
    fn format(place: &f64) -> String {
        place.to_string()
    }

    fn format_ext(&self, place: &f64) -> String {
        let tick = self.0.ticks.labelled.iter().find(|(p, _)| p == place);
        tick.map_or_else(String::new, |(_, text)| text.clone())
    }
}
