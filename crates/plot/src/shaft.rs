//! Displacement and tilt of the shaft, and what free balls do to it, against time or the swept value.

use figure::{Figure, Series};

use super::named::Named;
use super::quantity::{AxisUnit, MICROMETRE, MILLIRADIAN, NEWTON_METRE, RPM, WATT, points};
use super::run::{Results, Steps};

/// The figures of `shaft.csv`; none for a single step.
pub fn figures(results: &Results) -> anyhow::Result<Vec<Named>> {
    let mut figures = Vec::new();
    for chart in &CHARTS {
        figures.extend(figure(results, chart)?.map(|figure| Named::new(chart.name, figure)));
    }
    Ok(figures)
}

/// All figures; torque, power and cage speed come with free balls.
const CHARTS: [Chart; 5] = [
    Chart {
        name: "shaft_displacement",
        title: "Displacement of the shaft",
        axis: "displacement",
        unit: MICROMETRE,
        columns: &[("x_m", "x"), ("y_m", "y"), ("z_m", "z")],
    },
    Chart {
        name: "shaft_tilt",
        title: "Tilt of the shaft",
        axis: "tilt",
        unit: MILLIRADIAN,
        columns: &[("tilt_x_rad", "tilt about x"), ("tilt_y_rad", "tilt about y")],
    },
    Chart {
        name: "friction_torque",
        title: "Friction torque on the rings",
        axis: "torque",
        unit: NEWTON_METRE,
        columns: &[
            ("friction_torque_n_m", "inner ring"),
            ("outer_friction_torque_n_m", "outer ring"),
        ],
    },
    Chart {
        name: "friction_power_sum",
        title: "Friction power of all contacts",
        axis: "power",
        unit: WATT,
        columns: &[("friction_power_w", "friction power")],
    },
    Chart {
        name: "cage_speed",
        title: "Mean speed of the balls round the axis",
        axis: "speed",
        unit: RPM,
        columns: &[
            ("cage_speed_rad_per_s", "balls"),
            ("kinematic_cage_speed_rad_per_s", "pure rolling"),
        ],
    },
];

/// A figure of columns of `shaft.csv`, each with its label.
struct Chart {
    name: &'static str,
    title: &'static str,
    axis: &'static str,
    unit: AxisUnit,
    columns: &'static [(&'static str, &'static str)],
}

/// The columns that are there and not zero throughout; none if no such is.
fn figure(results: &Results, chart: &Chart) -> anyhow::Result<Option<Figure>> {
    let Some(table) = &results.shaft else {
        return Ok(None);
    };
    let Some((x_axis, x)) = results.against(table)? else {
        return Ok(None);
    };
    let mut figure = Figure::new(chart.title, x_axis, chart.unit.axis(chart.axis));
    let mut moves = 0;
    for (column, label) in chart.columns {
        if table.find(column).is_none() {
            continue;
        }
        let values = chart.unit.of(table.column(column)?);
        if values.iter().all(|v| v.abs() < 1e-9) {
            continue;
        }
        moves += 1;
        figure = figure.series(match results.steps {
            Steps::Times => Series::line(*label, points(&x, &values)),
            _ => Series::line_and_marks(*label, points(&x, &values)),
        });
    }
    Ok((moves > 0).then_some(figure))
}
