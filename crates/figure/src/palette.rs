//! Colours that readers with colour-blindness can tell apart.

use plotters::style::RGBColor;

/// Okabe and Ito, *Color Universal Design* (2008), without yellow, which is too light for lines on white.
const SERIES: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(0, 0, 0),
];

/// Colour of reference lines.
pub const REFERENCE: RGBColor = RGBColor(110, 110, 110);

/// Colour of the series with this number.
pub fn of_series(index: usize) -> RGBColor {
    SERIES[index % SERIES.len()]
}

/// Viridis (Smith and van der Walt, matplotlib 1.5, CC0) at nine equal distances.
const VIRIDIS: [[f64; 3]; 9] = [
    [68.0, 1.0, 84.0],
    [72.0, 40.0, 120.0],
    [62.0, 74.0, 137.0],
    [49.0, 104.0, 142.0],
    [38.0, 130.0, 142.0],
    [31.0, 158.0, 137.0],
    [53.0, 183.0, 121.0],
    [110.0, 206.0, 88.0],
    [253.0, 231.0, 37.0],
];

/// RdBu of ColorBrewer (Brewer, Harrower, Penn State, Apache-2.0), nine classes from blue to red.
const BLUE_TO_RED: [[f64; 3]; 9] = [
    [33.0, 102.0, 172.0],
    [67.0, 147.0, 195.0],
    [146.0, 197.0, 222.0],
    [209.0, 229.0, 240.0],
    [247.0, 247.0, 247.0],
    [253.0, 219.0, 199.0],
    [244.0, 165.0, 130.0],
    [214.0, 96.0, 77.0],
    [178.0, 24.0, 43.0],
];

/// Part of the map that curves reach: the lightest colours would vanish on white.
pub const BRIGHTEST: f64 = 0.9;

/// A row of colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Map {
    /// From dark to light: of values that grow from one end.
    Sequential,
    /// From blue to red, nearly white in the middle: of values to both sides of zero.
    Diverging,
}

/// Colour of the part `t` from 0 to 1 of a range.
pub fn of_part(t: f64) -> RGBColor {
    on_map(Map::Sequential, t)
}

/// Colour of the part `t` from 0 to 1 of a range, on a map.
pub fn on_map(map: Map, t: f64) -> RGBColor {
    let colours = match map {
        Map::Sequential => &VIRIDIS,
        Map::Diverging => &BLUE_TO_RED,
    };
    let last = colours.len() - 1;
    let place = t.clamp(0.0, 1.0) * last as f64;
    let i = (place.floor() as usize).min(last - 1);
    let between = |c: usize| {
        let (a, b) = (colours[i][c], colours[i + 1][c]);
        (a + (b - a) * (place - i as f64)).round() as u8
    };
    RGBColor(between(0), between(1), between(2))
}
