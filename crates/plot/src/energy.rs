//! The ledger of energy of a motion, and what it leaves unexplained.

use figure::{Axis, DataPoint, Figure, Series};

use super::named::Named;
use super::quantity::{MILLIJOULE, MILLISECOND, points};
use super::run::{Results, Steps};
use results::table::Table;

/// Sums of columns that are shown as one line.
const LINES: [(&str, &[&str]); 6] = [
    (
        "kinetic",
        &[
            "kinetic_inner",
            "kinetic_outer",
            "kinetic_balls",
            "kinetic_shaft",
            "kinetic_cage",
        ],
    ),
    ("strain of the rings", &["strain_inner", "strain_outer"]),
    ("strain of the cage", &["strain_cage"]),
    ("Hertz contacts", &["hertz"]),
    (
        "work of loads, drives, frame, patches",
        &[
            "load_work",
            "imposed_work",
            "frame_work",
            "patch_work",
            "profile_work",
            "temperature_work",
            "drive_work",
            "cage_drive_work",
        ],
    ),
    (
        "losses",
        &[
            "contact_loss",
            "rayleigh_loss",
            "numerical_loss",
            "friction_loss",
            "drag_loss",
            "cage_impact_loss",
            "cage_friction_loss",
            "cage_drag_loss",
        ],
    ),
];

/// The figures of `energy.csv` of a motion.
pub fn figures(results: &Results) -> anyhow::Result<Vec<Named>> {
    let (Some(table), Steps::Times) = (&results.energy, &results.steps) else {
        return Ok(Vec::new());
    };
    if table.find("load_work_j").is_none() {
        return Ok(Vec::new());
    }
    Ok(vec![changes(table)?, defect(table)?])
}

/// Changes since the start: the energies themselves differ by orders of magnitude.
fn changes(table: &Table) -> anyhow::Result<Named> {
    let times = MILLISECOND.of(table.column("time_s")?);
    let axes = (
        MILLISECOND.axis("time").tight(),
        MILLIJOULE.axis("change since the start"),
    );
    let mut figure = Figure::new("Energy ledger", axes.0, axes.1);
    for (name, columns) in LINES {
        let terms: Vec<&[f64]> = columns
            .iter()
            .filter_map(|c| table.find(&format!("{c}_j")))
            .collect();
        let sum = |row: usize| terms.iter().map(|term| term[row]).sum::<f64>();
        let change = |row: usize| (sum(row) - sum(0)) * MILLIJOULE.factor;
        let values: Vec<f64> = (0..table.n_rows()).map(change).collect();
        if !terms.is_empty() && values.iter().any(|v| *v != 0.0) {
            figure = figure.series(Series::line(name, points(&times, &values)));
        }
    }
    Ok(Named::new(
        "energy_ledger",
        figure.series(Series::reference("", vec![DataPoint::new(times[0], 0.0)])),
    ))
}

/// What the ledger does not explain over the largest energy so far.
fn defect(table: &Table) -> anyhow::Result<Named> {
    let times = MILLISECOND.of(table.column("time_s")?);
    let (total, defect) = (table.column("total_j")?, table.column("defect_j")?);
    let mut largest = 0.0_f64;
    let part = |row: usize| {
        largest = largest.max(total[row].abs());
        // A defect of zero has no logarithm: it is shown as rounding.
        (defect[row].abs() / largest).max(f64::EPSILON)
    };
    let values: Vec<f64> = (0..table.n_rows()).map(part).collect();
    let axes = (
        MILLISECOND.axis("time").tight(),
        Axis::logarithmic("defect over largest energy", "1"),
    );
    let figure = Figure::new("Defect of the energy ledger", axes.0, axes.1);
    Ok(Named::new(
        "energy_defect",
        figure.series(Series::line("", points(&times, &values))),
    ))
}
