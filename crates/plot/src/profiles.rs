//! Profiles of stress along a line: all stresses at one step, and of a sweep von Mises stress at all its points.

use std::collections::BTreeMap;

use anyhow::anyhow;
use figure::{Axis, Figure, Series};
use results::table::{Rows, read_rows};

use super::choice::Choice;
use super::named::Named;
use super::quantity::{self, AxisUnit, DEGREE, MEGAPASCAL, MICROMETRE, points};
use super::run::{Results, Steps};
use super::shades::{self, Shades};

/// Table of all profiles.
const FILE: &str = "profiles.csv";
/// What a line may run along: column, name of the axis and unit.
const COORDINATES: [(&str, &str, AxisUnit); 3] = [
    ("groove_angle_rad", "groove angle", DEGREE),
    ("depth_m", "depth below the raceway", MICROMETRE),
    ("azimuth_rad", "azimuth on the ring", DEGREE),
];
/// Figures of a profile: ending of the name, the axis, and the starts of the columns.
const FIGURES: [(&str, &str, &[&str]); 2] = [
    ("stress", "stress", &["stress_", "von_mises"]),
    (
        "principal_stress",
        "principal stress",
        &["principal_", "maximum_shear", "hydrostatic"],
    ),
];

/// Rows of one profile at one step, by the names of the columns.
type ProfileColumns = BTreeMap<String, Vec<f64>>;

/// The figures of `profiles.csv` at the chosen step, else at the last, and then of a sweep over all points.
pub fn figures(results: &Results, choice: &Choice) -> anyhow::Result<Vec<Named>> {
    let path = results.dir.join(FILE);
    let Some(Rows { names, rows }) = read_rows(&path)? else {
        return Ok(Vec::new());
    };
    let place = |name: &str| {
        let found = names.iter().position(|n| n == name);
        found.ok_or_else(|| {
            anyhow!(
                "{} has no column {name:?}; it has {}",
                path.display(),
                names.join(", ")
            )
        })
    };
    let (step, profile) = (place("step")?, place("profile")?);
    let mut profiles: BTreeMap<String, BTreeMap<u64, ProfileColumns>> = BTreeMap::new();
    for row in &rows {
        let Ok(number) = row[step].parse() else { continue };
        let steps = profiles.entry(row[profile].to_string()).or_default();
        let columns = steps.entry(number).or_default();
        for (name, cell) in names.iter().zip(row) {
            let values = columns.entry(name.clone()).or_default();
            values.push(cell.parse().unwrap_or(f64::NAN));
        }
    }
    let mut figures = Vec::new();
    for (name, steps) in &profiles {
        let chosen = choice.step.filter(|s| steps.contains_key(s));
        let Some((shown, columns)) =
            chosen.map_or_else(|| steps.last_key_value(), |s| steps.get_key_value(&s))
        else {
            continue;
        };
        figures.extend(of_profile(name, columns, &names, *shown));
        if let (Steps::Sweep(_), None) = (&results.steps, choice.step) {
            figures.push(over_sweep(results, name, steps)?);
        }
    }
    Ok(figures)
}

/// Von Mises stress along a profile, a curve per point of a sweep.
fn over_sweep(
    results: &Results,
    profile: &str,
    steps: &BTreeMap<u64, ProfileColumns>,
) -> anyhow::Result<Named> {
    let (axis, _) = along(steps.values().next().expect("a profile has rows"));
    let stress = MEGAPASCAL.axis("von Mises stress").including(0.0);
    let mut figure = Figure::new(format!("Profile {profile}: von Mises stress"), axis, stress);
    let numbers: Vec<u64> = steps.keys().copied().collect();
    let shades = Shades::of(results, &numbers)?;
    figure = shades::bar(figure, shades.as_ref());
    for (i, (&step, columns)) in steps.iter().enumerate() {
        let values = points(&along(columns).1, &MEGAPASCAL.of(&columns["von_mises_pa"]));
        let series = Series::line(results.name_of(step)?, values);
        figure = figure.series(shades::shaded(series, shades.as_ref(), i, steps.len()));
    }
    Ok(Named::new(format!("profile_{profile}_von_mises"), figure))
}

/// Both figures of a profile, columns in the order of the table.
fn of_profile(profile: &str, columns: &ProfileColumns, names: &[String], step: u64) -> Vec<Named> {
    let (axis, x) = along(columns);
    let figure = |(ending, what, starts): &(&str, &str, &[&str])| {
        let title = format!("Profile {profile}, step {step}: {what}");
        let mut figure = Figure::new(title, axis.clone(), MEGAPASCAL.axis(*what));
        for name in names.iter().filter(|n| starts.iter().any(|s| n.starts_with(s))) {
            let (label, unit) = quantity::split(name);
            let values = points(&x, &unit.of(&columns[name]));
            figure = figure.series(Series::line(label.replace('_', " "), values));
        }
        Named::new(format!("profile_{profile}_{ending}"), figure)
    };
    FIGURES.iter().map(figure).collect()
}

/// The coordinate that the line runs along: the first that is not the same at all its points.
fn along(columns: &ProfileColumns) -> (Axis, Vec<f64>) {
    let varies = |x: &[f64]| x.iter().any(|v| *v != x[0]);
    let chosen = COORDINATES
        .iter()
        .find(|(column, _, _)| varies(&columns[*column]));
    let (column, name, unit) = chosen.unwrap_or(&COORDINATES[1]);
    (unit.axis(*name).tight(), unit.of(&columns[*column]))
}
