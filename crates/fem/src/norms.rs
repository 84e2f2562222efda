//! Norms of the difference between a finite-element displacement and a known solution, for convergence studies.
//!
//! Integrated with [`crate::quadrature::mass_rule`], not with the stiffness points, where the strain is better than
//! elsewhere.

use mesh::Mesh;

use crate::chunks::for_each_element;
use crate::error::FemError;
use crate::geometry::{check_connectivity, checked_map, coordinates, position};
use crate::material::Material;
use crate::quadrature;
use crate::stress::kernel::strains_at;
use crate::table::ShapeTable;

/// `sqrt(integral of |u_h - u|^2 dV)`, m^(5/2), from displacements, m, `[3 n_nodes]`, and the exact displacement, m.
///
/// Of hex8 only the nodal displacement counts, not the incompatible modes.
pub fn l2_error<F>(mesh: &Mesh, u: &[f64], exact: F) -> Result<f64, FemError>
where
    F: Fn([f64; 3]) -> [f64; 3] + Sync,
{
    let table = ShapeTable::new(mesh.kind, &quadrature::mass_rule(mesh.kind));
    integrate(mesh, &table, |e| {
        let x = coordinates(mesh, e);
        let squared = |q: usize| {
            let mut difference = exact(position(&table, q, &x)).map(|value| -value);
            for (a, &node) in mesh.element(e).iter().enumerate() {
                for i in 0..3 {
                    difference[i] += table.values[q][a] * u[3 * node + i];
                }
            }
            difference.iter().map(|d| d * d).sum()
        };
        (0..table.n_points()).map(squared).collect()
    })
}

/// `sqrt(integral of (e_h - e) : D (e_h - e) dV)`, J^(1/2), from displacements, m, `[3 n_nodes]`, and the exact
/// strain with engineering shear.
///
/// The strain of hex8 includes its incompatible modes, as its stress does.
pub fn energy_error<F>(mesh: &Mesh, material: &Material, u: &[f64], exact: F) -> Result<f64, FemError>
where
    F: Fn([f64; 3]) -> [f64; 6] + Sync,
{
    material.validate()?;
    let lame = [material.lame_lambda(), material.shear_modulus()];
    let stiffness = ShapeTable::new(mesh.kind, &quadrature::stiffness_rule(mesh.kind));
    let table = ShapeTable::new(mesh.kind, &quadrature::mass_rule(mesh.kind));
    integrate(mesh, &table, |e| {
        let x = coordinates(mesh, e);
        let strains = strains_at(mesh, e, u, lame, &stiffness, &table);
        let energy = |(q, strain): (usize, [f64; 6])| {
            let mut difference = exact(position(&table, q, &x));
            for c in 0..6 {
                difference[c] -= strain[c];
            }
            material
                .stress(difference)
                .iter()
                .zip(difference)
                .map(|(s, e)| s * e)
                .sum()
        };
        strains.into_iter().enumerate().map(energy).collect()
    })
}

/// Square root of the integral of a quantity given at every point of every element.
fn integrate<F>(mesh: &Mesh, table: &ShapeTable, squared: F) -> Result<f64, FemError>
where
    F: Fn(usize) -> Vec<f64> + Sync,
{
    check_connectivity(mesh)?;
    let compute = |e: usize, value: &mut [f64]| {
        let x = coordinates(mesh, e);
        value[0] = 0.0;
        for (q, squared) in squared(e).into_iter().enumerate() {
            value[0] += table.weights[q] * checked_map(table, q, &x, e)?.det * squared;
        }
        Ok(())
    };
    let mut total = 0.0;
    for_each_element(mesh.n_elements(), 1, compute, |_, value| total += value[0])?;
    Ok(total.sqrt())
}
