//! Work-precision plots of a study: error against price, a curve per choice, the front ringed.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use figure::{Axis, DataPoint, Figure, Series};
use results::whole::{make_folder, write_picture};

use super::format::CostKind;
use super::report::{PointReport, QuantityReport, StudyReport};

/// Folder of the plots in that of the study.
const FOLDER: &str = "plots";

/// Draws a plot for every quantity that has errors and returns the paths, without endings.
pub fn write(report: &StudyReport, out: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let dir = out.join(FOLDER);
    let mut paths = Vec::new();
    for quantity in &report.quantities {
        let Some(figure) = work_precision(report, quantity) else {
            continue;
        };
        make_folder(&dir)?;
        let path = dir.join(file_name(&quantity.name));
        let images = figure.images()?;
        write_picture(&path, &images.svg, &images.png)?;
        paths.push(path);
    }
    Ok(paths)
}

/// One plot; none when no point has an error above zero.
fn work_precision(report: &StudyReport, quantity: &QuantityReport) -> Option<Figure> {
    let joined = joined_axis(report);
    let mut curves: BTreeMap<Vec<usize>, Vec<(DataPoint, String)>> = BTreeMap::new();
    let mut front = Vec::new();
    let mut uncertainty = 0.0f64;
    for point in &report.points {
        let Some(result) = point.results.get(&quantity.name) else {
            continue;
        };
        let (Some(cost), Some(error)) = (&point.cost, result.error.filter(|e| *e > 0.0)) else {
            continue;
        };
        let at = DataPoint::new(scaled(cost.of(report.cost), report.cost), error);
        let label = joined.map_or(String::new(), |a| point.values[&report.axes[a].name].clone());
        curves
            .entry(curve_of(report, point, joined))
            .or_default()
            .push((at, label));
        if result.pareto {
            front.push(at);
        }
        uncertainty = uncertainty.max(result.uncertainty.unwrap_or(0.0));
    }
    if curves.is_empty() {
        return None;
    }
    let (name, unit) = axis_text(report.cost);
    let title = format!("{}: {}", report.title, quantity.name);
    let mut figure = Figure::new(
        title,
        Axis::logarithmic(name, unit),
        Axis::logarithmic(format!("relative error of {}", quantity.name), "1"),
    );
    let ends = curves
        .values()
        .flatten()
        .fold([f64::INFINITY, 0.0f64], |[l, h], (p, _)| [l.min(p.x), h.max(p.x)]);
    for (at, points) in &curves {
        let places = points.iter().map(|(p, _)| *p).collect();
        figure = figure.series(Series::line_and_marks(curve_name(report, at, joined), places));
        for (place, label) in points.iter().filter(|(_, label)| !label.is_empty()) {
            figure = figure.label(*place, label.clone());
        }
    }
    figure = figure.series(Series::rings("no other is cheaper and better", front));
    if uncertainty > 0.0 {
        let line = ends.map(|x| DataPoint::new(x, uncertainty)).to_vec();
        figure = figure.series(Series::reference("uncertainty of the reference", line));
    }
    Some(figure)
}

/// The axis whose values a curve joins: the last that is refined; `None` where nothing is.
fn joined_axis(report: &StudyReport) -> Option<usize> {
    report.axes.iter().rposition(|a| !a.sizes.is_empty())
}

/// Indices of the values of all axes but the joined one.
fn curve_of(report: &StudyReport, point: &PointReport, joined: Option<usize>) -> Vec<usize> {
    let index = |(i, axis): (usize, &super::report::AxisReport)| {
        let value = &point.values[&axis.name];
        (Some(i) != joined).then(|| axis.values.iter().position(|v| v == value).unwrap_or(0))
    };
    report.axes.iter().enumerate().filter_map(index).collect()
}

fn curve_name(report: &StudyReport, at: &[usize], joined: Option<usize>) -> String {
    let axes = report.axes.iter().enumerate().filter(|(i, _)| Some(*i) != joined);
    let names: Vec<&str> = axes
        .zip(at)
        .map(|((_, axis), &v)| axis.values[v].as_str())
        .collect();
    match (names.is_empty(), joined) {
        (true, Some(a)) => report.axes[a].label.clone(),
        (true, None) => "runs".to_string(),
        _ => names.join(", "),
    }
}

fn axis_text(kind: CostKind) -> (&'static str, &'static str) {
    match kind {
        CostKind::Wall => ("wall time", "s"),
        CostKind::Cpu => ("processor time", "s"),
        CostKind::Memory => ("peak memory", "MB"),
        CostKind::Bytes => ("results written", "MB"),
    }
}

fn scaled(cost: f64, kind: CostKind) -> f64 {
    match kind {
        CostKind::Wall | CostKind::Cpu => cost,
        CostKind::Memory | CostKind::Bytes => 1e-6 * cost,
    }
}

/// Letters and digits of a name, words joined by underscores.
fn file_name(name: &str) -> String {
    let words: Vec<String> = name
        .to_lowercase()
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|w| !w.is_empty())
        .map(str::to_string)
        .collect();
    words.join("_")
}
