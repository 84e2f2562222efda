//! A step as a table: one row per point, SI units in the column names, numbers as the shortest text that reads back as
//! the same f64.

use std::io::{self, Write};

use checkpoint::{Grid, StepRecord};

use super::vtu::FieldArray;

/// Suffixes of the columns of a field by its number of components.
const VECTOR: [&str; 3] = ["_x", "_y", "_z"];
const TENSOR: [&str; 6] = ["_xx", "_yy", "_zz", "_xy", "_yz", "_xz"];

/// Writes the table of a step.
pub fn write(file: &mut dyn Write, grid: &Grid, record: &StepRecord) -> io::Result<()> {
    write_fields(file, grid, &record.points.arrays())
}

/// Writes the table of a grid with fields over its points.
pub fn write_fields(file: &mut dyn Write, grid: &Grid, arrays: &[FieldArray<'_>]) -> io::Result<()> {
    let mut head = ["point", "body", "x_m", "y_m", "z_m"]
        .map(str::to_string)
        .to_vec();
    for (name, n_components, _) in arrays {
        let suffixes: &[&str] = match n_components {
            3 => &VECTOR,
            6 => &TENSOR,
            _ => &[""],
        };
        head.extend(
            suffixes
                .iter()
                .map(|suffix| format!("{name}{suffix}{}", unit(name))),
        );
    }
    writeln!(file, "{}", head.join(","))?;
    let bodies = body_of_points(grid);
    for (i, place) in grid.points.iter().enumerate() {
        write!(file, "{i},{}", bodies[i])?;
        let fields = arrays
            .iter()
            .flat_map(|(_, n, values)| &values[n * i..n * (i + 1)]);
        for value in place.iter().chain(fields) {
            write!(file, ",{value:?}")?;
        }
        writeln!(file)?;
    }
    Ok(())
}

/// Unit of a field as the end of the names of its columns.
fn unit(name: &str) -> &'static str {
    match name {
        "displacement" => "_m",
        "rotation" => "_rad",
        "velocity" => "_m_per_s",
        "acceleration" => "_m_per_s2",
        "stress" | "von_mises" => "_pa",
        "in_region" => "",
        _ => "_n",
    }
}

/// Body of each point: that of the cells it belongs to.
fn body_of_points(grid: &Grid) -> Vec<u8> {
    let mut bodies = vec![0; grid.points.len()];
    for (cell, &body) in grid.body.iter().enumerate() {
        grid.cell(cell).for_each(|point| bodies[point] = body);
    }
    bodies
}
