//! Displacement and tilt of the shaft against time or the swept value.

use figure::{Figure, Series};

use super::quantity::{MICROMETRE, MILLIRADIAN, Unit, points};
use super::run::Steps;
use super::{Named, Results};

/// The figures of `shaft.csv`; none for a single step.
pub fn figures(results: &Results) -> anyhow::Result<Vec<Named>> {
    let displacement = figure(
        results,
        "Displacement of the shaft",
        "displacement",
        MICROMETRE,
        &["x", "y", "z"],
        "m",
    )?;
    let tilt = figure(
        results,
        "Tilt of the shaft",
        "tilt",
        MILLIRADIAN,
        &["tilt_x", "tilt_y"],
        "rad",
    )?;
    Ok([("shaft_displacement", displacement), ("shaft_tilt", tilt)]
        .into_iter()
        .filter_map(|(name, figure)| Some(Named::new(name, figure?)))
        .collect())
}

/// The columns that are not zero throughout; none if all are.
fn figure(
    results: &Results,
    title: &str,
    axis: &str,
    unit: Unit,
    columns: &[&str],
    ending: &str,
) -> anyhow::Result<Option<Figure>> {
    let Some(table) = &results.shaft else {
        return Ok(None);
    };
    let Some((x_axis, x)) = results.against(table)? else {
        return Ok(None);
    };
    let mut figure = Figure::new(title, x_axis, unit.axis(axis));
    let mut moves = 0;
    for name in columns {
        let values = unit.of(table.column(&format!("{name}_{ending}"))?);
        if values.iter().all(|v| v.abs() < 1e-9) {
            continue;
        }
        moves += 1;
        let label = name.replace('_', " about ");
        figure = figure.series(match results.steps {
            Steps::Times => Series::line(label, points(&x, &values)),
            _ => Series::line_and_marks(label, points(&x, &values)),
        });
    }
    Ok((moves > 0).then_some(figure))
}
