//! Natural frequencies of a `[modes]` scene.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::Context;
use csv::StringRecord;
use figure::{Axis, DataPoint, Figure, Series};
use results::table::{Rows, read_rows};
use serde::Deserialize;

use super::named::Named;

/// A row of `modes.csv`, as far as it is shown.
#[derive(Deserialize)]
struct ModeRow {
    body: String,
    mode: f64,
    frequency_hz: f64,
    bound_hz: f64,
}

/// Frequencies against the number of the mode, a series per body, with the largest possible error.
pub fn figures(dir: &Path) -> anyhow::Result<Vec<Named>> {
    let path = dir.join("modes.csv");
    let Some(Rows { names, rows }) = read_rows(&path)? else {
        return Ok(Vec::new());
    };
    let header = StringRecord::from(names);
    let mut bodies: BTreeMap<String, Vec<ModeRow>> = BTreeMap::new();
    for row in &rows {
        let row: ModeRow = row
            .deserialize(Some(&header))
            .with_context(|| format!("{} is damaged", path.display()))?;
        bodies.entry(row.body.clone()).or_default().push(row);
    }
    let axes = (
        Axis::linear("number of the mode", "1"),
        Axis::linear("frequency", "kHz").including(0.0),
    );
    let mut figure = Figure::new("Natural frequencies", axes.0, axes.1);
    for (body, rows) in bodies {
        let place = |row: &ModeRow| DataPoint::new(row.mode, 1e-3 * row.frequency_hz);
        let error = |row: &ModeRow| {
            [row.frequency_hz - row.bound_hz, row.frequency_hz + row.bound_hz].map(|f| 1e-3 * f)
        };
        let series = Series::marks(body, rows.iter().map(place).collect());
        figure = figure.series(series.errors(rows.iter().map(error).collect()));
    }
    Ok(vec![Named::new("frequencies", figure)])
}
