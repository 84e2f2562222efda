//! Plots of the page: curves over time.

use std::path::Path;

use figure::{Axis, DataPoint, Figure, Series};

/// A curve.
pub struct Curve {
    pub name: String,
    pub points: Vec<[f64; 2]>,
}

/// Curves in one pair of axes, each "name, unit".
pub struct Plot {
    pub x: &'static str,
    pub y: &'static str,
    pub curves: Vec<Curve>,
}

/// Writes the plot as an SVG file.
pub fn write(path: &Path, title: &str, plot: &Plot) {
    let axis = |text: &str| {
        let (name, unit) = text.rsplit_once(", ").unwrap_or((text, "1"));
        Axis::linear(name, unit)
    };
    let mut figure = Figure::new(title.replace('_', " "), axis(plot.x), axis(plot.y)).size(600, 320);
    for curve in &plot.curves {
        let points = curve.points.iter().copied().map(DataPoint::from).collect();
        figure = figure.series(Series::line(curve.name.clone(), points));
    }
    std::fs::write(path, figure.svg().unwrap()).unwrap();
}
