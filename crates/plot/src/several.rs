//! The shaft of several bearings: its deflection line with the bearings at their places, and their forces.

use std::path::Path;

use figure::{Axis, Figure, Series};
use results::several::{BEARINGS_TABLE, SHAFT_TABLE};
use results::table::Table;

use super::quantity::{AxisUnit, MICROMETRE, points};
use super::run::axis_of;

const MILLIMETRE: AxisUnit = AxisUnit {
    sign: "mm",
    factor: 1e3,
};
const NEWTON: AxisUnit = AxisUnit {
    sign: "N",
    factor: 1.0,
};
/// Displacement below which a direction is not drawn, um.
const NOTHING: f64 = 1e-6;
/// Column before that of a swept value.
const TIME: usize = 1;

/// Whether a folder has the results of several bearings.
pub fn is_of_several(dir: &Path) -> bool {
    dir.join(BEARINGS_TABLE).is_file()
}

/// The figures of such a folder.
pub fn figures(dir: &Path) -> anyhow::Result<Vec<(String, Figure)>> {
    let mut found = Vec::new();
    let (Some(shaft), Some(bearings)) = (Table::read(dir, SHAFT_TABLE)?, Table::read(dir, BEARINGS_TABLE)?)
    else {
        return Ok(found);
    };
    found.push(("shaft_line".to_string(), line(&shaft, &bearings)?));
    found.extend(loads(dir, &bearings)?.map(|figure| ("bearing_loads".to_string(), figure)));
    Ok(found)
}

/// Rows of the last step.
fn last_rows(table: &Table) -> anyhow::Result<Vec<usize>> {
    let steps = table.column("step")?;
    let last = steps.iter().copied().fold(0.0, f64::max);
    Ok((0..steps.len()).filter(|&i| steps[i] == last).collect())
}

/// The line of the shaft at the last step.
fn line(shaft: &Table, bearings: &Table) -> anyhow::Result<Figure> {
    let pick = |table: &Table, rows: &[usize], column: &str, unit: AxisUnit| -> anyhow::Result<Vec<f64>> {
        let values = unit.of(table.column(column)?);
        Ok(rows.iter().map(|&i| values[i]).collect())
    };
    let (rows, places) = (last_rows(shaft)?, last_rows(bearings)?);
    let z = pick(shaft, &rows, "position_m", MILLIMETRE)?;
    let at = pick(bearings, &places, "position_m", MILLIMETRE)?;
    let axis = MILLIMETRE.axis("position along the shaft");
    let mut figure = Figure::new(
        "Deflection line of the shaft",
        axis,
        MICROMETRE.axis("displacement"),
    );
    for name in ["x", "y", "z"] {
        let column = format!("{name}_m");
        let line = pick(shaft, &rows, &column, MICROMETRE)?;
        if line.iter().all(|u| u.abs() < NOTHING) {
            continue;
        }
        figure = figure.series(Series::line(name, points(&z, &line)));
        let own = pick(bearings, &places, &column, MICROMETRE)?;
        figure = figure.series(Series::marks(
            format!("{name} at the bearings"),
            points(&at, &own),
        ));
    }
    Ok(figure)
}

/// The largest ball force of each bearing over the points of a sweep; none of one point.
fn loads(dir: &Path, bearings: &Table) -> anyhow::Result<Option<Figure>> {
    let swept = bearings.names().get(TIME + 1).filter(|name| *name != "bearing");
    let Some(column) = swept else { return Ok(None) };
    let (axis, x): (Axis, Vec<f64>) = axis_of(bearings, column, "step")?;
    let force = NEWTON.of(bearings.column("largest_ball_force_n")?);
    let n = last_rows(bearings)?.len();
    let names = names(dir, n)?;
    let mut figure = Figure::new(
        "Largest ball force of each bearing",
        axis,
        NEWTON.axis("force").including(0.0),
    );
    for (i, name) in names.into_iter().enumerate() {
        let of = |values: &[f64]| values.iter().skip(i).step_by(n).copied().collect::<Vec<_>>();
        figure = figure.series(Series::line_and_marks(name, points(&of(&x), &of(&force))));
    }
    Ok(Some(figure))
}

/// Names of all bearings, in the order of their rows.
pub fn all_names(dir: &Path) -> anyhow::Result<Vec<String>> {
    let bearings = Table::read(dir, BEARINGS_TABLE)?;
    let n = bearings
        .as_ref()
        .map_or(Ok(0), |table| Ok::<_, anyhow::Error>(last_rows(table)?.len()))?;
    names(dir, n)
}

/// Names of the first bearings, in the order of their rows.
pub fn names(dir: &Path, n: usize) -> anyhow::Result<Vec<String>> {
    let text = std::fs::read_to_string(dir.join(BEARINGS_TABLE))?;
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let column = head.iter().position(|name| *name == "bearing").unwrap_or(0);
    let name = |line: &str| line.split(',').nth(column).unwrap_or_default().to_string();
    Ok(lines.take(n).map(name).collect())
}
