//! Displacement and tilt of the shaft, and what free balls do to it, against time or the swept value.

use figure::{Figure, Series};

use super::quantity::{MICROMETRE, MILLIRADIAN, NEWTON_METRE, RPM, Unit, WATT, points};
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
    let of_shaft = [("shaft_displacement", displacement), ("shaft_tilt", tilt)];
    let named = |(name, figure): (&str, Option<Figure>)| Some(Named::new(name, figure?));
    let mut figures: Vec<Named> = of_shaft.into_iter().filter_map(named).collect();
    figures.extend(of_free_balls(results)?.into_iter().filter_map(named));
    Ok(figures)
}

/// Torque, power and cage speed, which only free balls have.
fn of_free_balls(results: &Results) -> anyhow::Result<Vec<(&'static str, Option<Figure>)>> {
    let table = results.shaft.as_ref();
    if table.is_none_or(|table| table.find("friction_torque_n_m").is_none()) {
        return Ok(Vec::new());
    }
    let one = |title: &str, axis: &str, unit: Unit, name: &str, ending: &str| {
        figure(results, title, axis, unit, &[name], ending)
    };
    Ok(vec![
        (
            "friction_torque",
            one(
                "Friction torque on the inner ring",
                "torque",
                NEWTON_METRE,
                "friction_torque",
                "n_m",
            )?,
        ),
        (
            "friction_power_sum",
            one(
                "Friction power of all contacts",
                "power",
                WATT,
                "friction_power",
                "w",
            )?,
        ),
        (
            "cage_speed",
            one(
                "Mean speed of the balls round the axis",
                "speed",
                RPM,
                "cage_speed",
                "rad_per_s",
            )?,
        ),
    ])
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
        let label = name.replace("tilt_", "tilt about ").replace('_', " ");
        figure = figure.series(match results.steps {
            Steps::Times => Series::line(label, points(&x, &values)),
            _ => Series::line_and_marks(label, points(&x, &values)),
        });
    }
    Ok((moves > 0).then_some(figure))
}
