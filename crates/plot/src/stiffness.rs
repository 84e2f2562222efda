//! Stiffness over the points of a sweep, from `stiffness.csv`; of bearings pressed together over their preload.

use std::path::Path;

use figure::{Axis, Figure, Series};
use results::several_stiffness::BEARING_STIFFNESS;
use results::stiffness::{PRELOAD, STIFFNESS_TABLE};
use results::table::Table;

use super::quantity::{AxisUnit, NEWTON, points};
use super::run::axis_of;

/// Newtons per micrometre.
const NEWTON_PER_MICROMETRE: AxisUnit = AxisUnit {
    sign: "N/µm",
    factor: 1e-6,
};
/// Newton metres per milliradian.
const MOMENT_PER_MILLIRADIAN: AxisUnit = AxisUnit {
    sign: "N m/mrad",
    factor: 1e-3,
};
/// Columns before the swept values, and what stands there without them.
const FIRST_COLUMNS: usize = 2;
const SPEED: &str = "speed_rad_per_s";

/// Stiffness against displacement and against tilt over the swept value, with the names of their files; none of a
/// single point.
pub fn figures(dir: &Path) -> anyhow::Result<Vec<(&'static str, Figure)>> {
    let Some(table) = Table::read(dir, STIFFNESS_TABLE)? else {
        return Ok(Vec::new());
    };
    let swept = table.names().get(FIRST_COLUMNS).filter(|name| *name != SPEED);
    let Some(column) = swept.filter(|_| table.n_rows() > 1) else {
        return Ok(Vec::new());
    };
    let (axis, x) = match presses(column) && table.names().iter().any(|name| name == PRELOAD) {
        true => (NEWTON.axis("preload"), NEWTON.of(table.column(PRELOAD)?)),
        false => axis_of(&table, column, "point")?,
    };
    let of = |unit: AxisUnit, names: &[&str], title: &str| -> anyhow::Result<Figure> {
        let figure = Figure::new(title, axis.clone(), stiffness_axis(unit));
        names.iter().try_fold(figure, |figure, name| {
            let k = unit.of(table.column(&format!("k_{name}_{name}"))?);
            Ok(figure.series(Series::line_and_marks(name.replace('_', " "), points(&x, &k))))
        })
    };
    Ok(vec![
        (
            "stiffness",
            of(
                NEWTON_PER_MICROMETRE,
                &["x", "y", "z"],
                match is_of_several(dir)? {
                    true => "Stiffness of the shaft on its bearings",
                    false => "Stiffness of the bearing",
                },
            )?,
        ),
        (
            "stiffness_tilt",
            of(
                MOMENT_PER_MILLIRADIAN,
                &["tilt_x", "tilt_y"],
                "Stiffness against tilt",
            )?,
        ),
    ])
}

/// Whether a swept value presses the bearings of a list together: their stiffness is shown over the force that this
/// makes, as in catalogues.
fn presses(column: &str) -> bool {
    column.starts_with("pairing.")
}

/// Whether bearings have tables of their own beside that of the shaft.
fn is_of_several(dir: &Path) -> anyhow::Result<bool> {
    let names = std::fs::read_dir(dir)?.flatten().map(|entry| entry.file_name());
    let is_one = |name: &str| name.starts_with(BEARING_STIFFNESS) && name.ends_with(".csv");
    Ok(names
        .filter_map(|name| name.into_string().ok())
        .any(|name| is_one(&name)))
}

fn stiffness_axis(unit: AxisUnit) -> Axis {
    unit.axis("stiffness").including(0.0)
}
