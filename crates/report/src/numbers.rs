//! Key numbers of a run from its tables: smallest, mean and largest over all rows of a table, and of a motion the
//! root mean square of what oscillates.

use plot::{AxisUnit, Results, Steps, quantity};
use results::table::Table;

/// A row of the table of key numbers, in the unit shown.
pub struct PageNumber {
    /// What it is.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// Smallest value.
    pub smallest: f64,
    /// Mean.
    pub mean: f64,
    /// Largest value.
    pub largest: f64,
    /// Root mean square of the difference from the mean over time; only of single quantities in a motion.
    pub rms: Option<f64>,
}

const BALLS: [(&str, &str, AxisUnit); 6] = [
    ("inner contact force", "inner_force_n", quantity::NEWTON),
    ("outer contact force", "outer_force_n", quantity::NEWTON),
    (
        "inner contact angle of loaded balls",
        "inner_contact_angle_rad",
        quantity::DEGREE,
    ),
    (
        "outer contact angle of loaded balls",
        "outer_contact_angle_rad",
        quantity::DEGREE,
    ),
    (
        "inner peak Hertz pressure",
        "inner_peak_pressure_pa",
        quantity::GIGAPASCAL,
    ),
    (
        "outer peak Hertz pressure",
        "outer_peak_pressure_pa",
        quantity::GIGAPASCAL,
    ),
];

const SHAFT: [(&str, &str, AxisUnit); 5] = [
    ("shaft displacement x", "x_m", quantity::MICROMETRE),
    ("shaft displacement y", "y_m", quantity::MICROMETRE),
    ("shaft displacement z", "z_m", quantity::MICROMETRE),
    ("shaft tilt about x", "tilt_x_rad", quantity::MILLIRADIAN),
    ("shaft tilt about y", "tilt_y_rad", quantity::MILLIRADIAN),
];

/// The key numbers, balls first.
pub fn numbers(results: &Results) -> anyhow::Result<Vec<PageNumber>> {
    let mut numbers = Vec::new();
    if let Some(table) = &results.balls {
        for (name, column, unit) in BALLS {
            numbers.extend(of_balls(table, name, column, unit)?);
        }
    }
    if let Some(table) = &results.shaft {
        for (name, column, unit) in SHAFT {
            let mut number = statistics(name, unit, table.column(column)?.iter().copied());
            if results.steps != Steps::Times {
                number.iter_mut().for_each(|n| n.rms = None);
            }
            numbers.extend(number);
        }
    }
    Ok(numbers)
}

/// Over all balls and steps; angles only where there is a force.
fn of_balls(table: &Table, name: &str, column: &str, unit: AxisUnit) -> anyhow::Result<Option<PageNumber>> {
    let side = column.split('_').next().unwrap_or(column);
    let force = table.column(&format!("{side}_force_n"))?;
    let values = table.column(column)?.iter().zip(force);
    let loaded = values.filter(|(_, f)| !column.contains("angle") || **f > 0.0);
    let number = statistics(name, unit, loaded.map(|(value, _)| *value));
    Ok(number.map(|number| PageNumber { rms: None, ..number }))
}

/// None without a value.
fn statistics(name: &str, unit: AxisUnit, values: impl Iterator<Item = f64> + Clone) -> Option<PageNumber> {
    let values = values.map(|v| v * unit.factor);
    let n = values.clone().count();
    if n == 0 {
        return None;
    }
    let mean = values.clone().sum::<f64>() / n as f64;
    let square = values.clone().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n as f64;
    Some(PageNumber {
        name: name.into(),
        unit: unit.sign,
        smallest: values.clone().fold(f64::INFINITY, f64::min),
        mean,
        largest: values.fold(f64::NEG_INFINITY, f64::max),
        rms: Some(square.sqrt()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: the page would tell other numbers than the run.
    #[test]
    fn statistics_are_those_of_the_values() {
        let n = statistics("x", quantity::MICROMETRE, [1e-6, 2e-6, 6e-6].into_iter()).unwrap();
        assert!(
            (n.mean - 3.0).abs() < 1e-12
                && (n.smallest - 1.0).abs() < 1e-12
                && (n.largest - 6.0).abs() < 1e-12
        );
        // The mean square of -2, -1, 3 is 14/3.
        assert!((n.rms.unwrap() - (14.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        assert!(statistics("x", quantity::NEWTON, std::iter::empty()).is_none());
    }
}
