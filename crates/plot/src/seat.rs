//! The seats of rings in bodies, unrolled: pressure over azimuth and width, and the motion of the seat.

use std::path::Path;

use contact::Side;
use figure::{Axis, DataPoint, Figure, Series, Surface};
use results::seat::SEAT_TABLES;
use results::table::Table;

use super::quantity::{DEGREE, MEGAPASCAL, MICROMETRE, MILLIMETRE, azimuth_axis};

/// Pressure of the seats, and how far they yield in their middle; none of rings that are in no body.
pub fn figures(dir: &Path) -> anyhow::Result<Vec<(String, Figure)>> {
    let mut figures = Vec::new();
    for side in Side::BOTH {
        if let Some(table) = Table::read(dir, SEAT_TABLES[side.index()])? {
            figures.extend(of_ring(&table, side)?);
        }
    }
    Ok(figures)
}

fn of_ring(table: &Table, side: Side) -> anyhow::Result<Vec<(String, Figure)>> {
    let (ring, seat, suffix) = [("inner", "bore", "_inner"), ("outer", "seat", "")][side.index()];
    let azimuth = DEGREE.of(table.column("azimuth_rad")?);
    let z = MILLIMETRE.of(table.column("z_m")?);
    // Rows of one azimuth follow each other.
    let n_across = azimuth.iter().take_while(|a| **a == azimuth[0]).count();
    let n_round = azimuth.len() / n_across;
    let pressure = MEGAPASCAL.of(table.column("pressure_pa")?);
    // Cells round the points of the table; the last column closes the circle.
    let step = 360.0 / n_round as f64;
    let x_edges = (0..=n_round).map(|i| step * i as f64).collect();
    let mut y_edges = vec![z[0]];
    y_edges.extend(z[..n_across].windows(2).map(|pair| 0.5 * (pair[0] + pair[1])));
    y_edges.push(z[n_across - 1]);
    let mut values = Vec::with_capacity(pressure.len());
    for j in 0..n_across {
        for i in 0..n_round {
            // In the middle of two points.
            let next = (i + 1) % n_round;
            values.push(0.5 * (pressure[n_across * i + j] + pressure[n_across * next + j]));
        }
    }
    let y_axis = Axis::linear(format!("z in the {ring} ring"), "mm").tight();
    let unrolled = Figure::new(
        format!("Pressure of the seat on the {ring} ring"),
        azimuth_axis(),
        y_axis,
    )
    .surface(
        Surface::new(
            MEGAPASCAL.axis("pressure").including(0.0),
            x_edges,
            y_edges,
            values,
        )?
        .parted_at_zero(),
    )
    .size(900, 400);
    let mut motion = Figure::new(
        format!("Motion of the middle of the {seat}"),
        azimuth_axis(),
        MICROMETRE.axis("displacement"),
    );
    for name in ["radial", "tangential", "axial"] {
        let column = MICROMETRE.of(table.column(&format!("{name}_m"))?);
        let middle = (0..=n_round).map(|i| {
            let row = n_across * (i % n_round) + n_across / 2;
            DataPoint::new(step * i as f64, column[row])
        });
        motion = motion.series(Series::line(name, middle.collect()));
    }
    Ok(vec![
        (format!("seat_pressure{suffix}"), unrolled),
        (format!("seat_motion{suffix}"), motion),
    ])
}
