//! The stress of a step at the integration points as a table: one row per point of each cell, with its place in the
//! mesh, SI units in the column names, numbers as the shortest text that reads back as the same f64.

use std::io::{self, Write};

use checkpoint::{Grid, IntegrationPointStress};
use fem::quadrature::stiffness_rule;
use fem::{element, von_mises};
use mesh::ElementKind;

const HEAD: &str = "cell,body,point,x_m,y_m,z_m,stress_xx_pa,stress_yy_pa,stress_zz_pa,stress_xy_pa,stress_yz_pa,\
                    stress_xz_pa,von_mises_pa";

/// The field over cells that has this stress.
pub const FIELD: &str = "stress_integration_points";

/// Writes the table of a step; cells without integration points, balls, have no row.
pub fn write(file: &mut dyn Write, grid: &Grid, stress: &IntegrationPointStress) -> io::Result<()> {
    write_rows(file, grid, (stress.n_components(), &stress.values))
}

/// The same of a grid with so many components for each cell.
pub fn write_rows(
    file: &mut dyn Write,
    grid: &Grid,
    (n_components, values): (usize, &[f64]),
) -> io::Result<()> {
    writeln!(file, "{HEAD}")?;
    let kinds = [ElementKind::Hex8, ElementKind::Hex20, ElementKind::Tet10];
    let rules = kinds.map(|kind| (kind, stiffness_rule(kind).points));
    for (cell, row) in values.chunks_exact(n_components).enumerate() {
        let kind = rules.iter().find(|(kind, _)| kind.vtk_type() == grid.types[cell]);
        let Some((kind, points)) = kind else { continue };
        let tensors = row.as_chunks::<6>().0;
        for (point, (&xi, &tensor)) in points.iter().zip(tensors).enumerate() {
            write!(file, "{cell},{},{point}", grid.body[cell])?;
            let place = place(grid, cell, &element::shape(*kind, xi));
            for value in place.iter().chain(&tensor).chain(&[von_mises(tensor)]) {
                write!(file, ",{value:?}")?;
            }
            writeln!(file)?;
        }
    }
    Ok(())
}

/// Place of a point of a cell in the mesh, m, from the values of the shape functions.
fn place(grid: &Grid, cell: usize, shape: &[f64]) -> [f64; 3] {
    let mut place = [0.0; 3];
    for (node, value) in grid.cell(cell).zip(shape) {
        for i in 0..3 {
            place[i] += value * grid.points[node][i];
        }
    }
    place
}
