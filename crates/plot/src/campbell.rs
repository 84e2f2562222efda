//! Campbell diagram, from `campbell.csv` and `campbell_lines.csv`.

use std::path::Path;

use anyhow::Context;
use csv::StringRecord;
use figure::{Axis, DataPoint, Figure, Series};
use results::campbell::{CAMPBELL_LINES, CAMPBELL_TABLE, EXCITATIONS};
use results::table::{Rows, Table, read_rows};
use serde::Deserialize;

use super::quantity::points;

/// Share of the shaft in the kinetic energy below which a mode is one of the rolling elements, and not shown.
const LEAST_SHARE: f64 = 0.05;
/// How far above the modes lines of excitation are shown.
const ROOM: f64 = 1.1;
/// Series of modes and the words of their whirl.
const WHIRLS: [&str; 4] = ["forward", "backward", "planar", "axial"];
/// A row of `campbell.csv`, as far as it is shown.
#[derive(Deserialize)]
struct CampbellRow {
    speed_rpm: f64,
    frequency_hz: f64,
    whirl: String,
    shaft_share: f64,
}

/// Frequencies of the shaft's modes over its speed, with the lines of what excites them, and their file's name.
pub fn figures(dir: &Path) -> anyhow::Result<Vec<(&'static str, Figure)>> {
    let path = dir.join(CAMPBELL_TABLE);
    let Some(Rows { names, rows }) = read_rows(&path)? else {
        return Ok(Vec::new());
    };
    let header = StringRecord::from(names);
    let read = |row: &StringRecord| -> anyhow::Result<CampbellRow> {
        row.deserialize(Some(&header))
            .with_context(|| format!("{} is damaged", path.display()))
    };
    let rows = rows.iter().map(read).collect::<anyhow::Result<Vec<_>>>()?;
    let shown: Vec<&CampbellRow> = rows.iter().filter(|row| row.shaft_share >= LEAST_SHARE).collect();
    let most = shown.iter().fold(0.0f64, |most, row| most.max(row.frequency_hz));
    let mut figure = Figure::new(
        "Campbell diagram",
        Axis::linear("speed of the shaft", "rpm").tight(),
        Axis::linear("frequency", "Hz").including(0.0),
    );
    for whirl in WHIRLS {
        let of = shown.iter().filter(|row| row.whirl == whirl);
        let place = |row: &&CampbellRow| DataPoint::new(row.speed_rpm, row.frequency_hz);
        let places: Vec<DataPoint> = of.map(place).collect();
        if !places.is_empty() {
            figure = figure.series(Series::marks(whirl, places));
        }
    }
    if let Some(lines) = Table::read(dir, CAMPBELL_LINES)? {
        let speeds = lines.column("speed_rpm")?;
        for (name, column) in EXCITATIONS {
            let line = below(&points(speeds, lines.column(column)?), ROOM * most);
            figure = figure.series(Series::line(name, line));
        }
    }
    Ok(vec![("campbell", figure)])
}

/// A line up to a value, where it is cut between its points.
fn below(line: &[DataPoint], most: f64) -> Vec<DataPoint> {
    let mut kept = Vec::new();
    for (i, point) in line.iter().enumerate() {
        if point.y <= most {
            kept.push(*point);
            continue;
        }
        if let Some(DataPoint { x, y }) = i.checked_sub(1).map(|before| line[before]) {
            let x = x + (point.x - x) * (most - y) / (point.y - y);
            kept.push(DataPoint::new(x, most));
        }
        break;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a line of excitation would be drawn past the modes, or end before them.
    #[test]
    fn lines_end_at_the_modes() {
        let line = [[0.0, 0.0], [1.0, 10.0], [2.0, 20.0]].map(DataPoint::from);
        let cut = [[0.0, 0.0], [1.0, 10.0], [1.5, 15.0]].map(DataPoint::from);
        assert_eq!(below(&line, 15.0), cut);
        assert_eq!(below(&line, 30.0), line);
        assert!(below(&line[1..], 5.0).is_empty());
    }
}
