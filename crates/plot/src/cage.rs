//! A free cage: its orbit, its speed, and the forces on it.

use figure::{Figure, Series};
use results::table::Table;

use super::named::Named;
use super::quantity::{MICROMETRE, NEWTON, RPM, points};
use super::run::Results;

/// The figures of `cage.csv`; none without the table.
pub fn figures(results: &Results) -> anyhow::Result<Vec<Named>> {
    let Some(table) = Table::read(&results.dir, "cage.csv")? else {
        return Ok(Vec::new());
    };
    let Some((time, at)) = results.against(&table)? else {
        return Ok(Vec::new());
    };
    let [x, y] = ["x_m", "y_m"].map(|name| table.column(name).map(|x| MICROMETRE.of(x)));
    let orbit = Figure::new("Orbit of the cage", MICROMETRE.axis("x"), MICROMETRE.axis("y"))
        .series(Series::line("centre of the cage", points(&x?, &y?)))
        .equal_scales();
    let [speed, kinematic] =
        ["speed_rad_per_s", "kinematic_speed_rad_per_s"].map(|name| table.column(name).map(|v| RPM.of(v)));
    let speed = Figure::new("Speed of the cage", time.clone(), RPM.axis("speed"))
        .series(Series::line("cage", points(&at, &speed?)))
        .series(Series::line("pure rolling", points(&at, &kinematic?)));
    let land = |end: &str| -> anyhow::Result<Vec<f64>> {
        let [x, y] = ["x", "y"].map(|axis| table.column(&format!("{end}_land_{axis}_n")));
        Ok(x?.iter().zip(y?).map(|(x, y)| x.hypot(*y)).collect())
    };
    let mut forces = Figure::new("Forces on the cage", time, NEWTON.axis("force")).series(Series::line(
        "largest of the pockets",
        points(&at, table.column("largest_pocket_force_n")?),
    ));
    for end in ["lower", "upper"] {
        let force = land(end)?;
        if force.iter().any(|f| *f > 0.0) {
            forces = forces.series(Series::line(format!("land, {end} end"), points(&at, &force)));
        }
    }
    Ok(vec![
        Named::new("cage_orbit", orbit),
        Named::new("cage_turning", speed),
        Named::new("cage_forces", forces),
    ])
}
