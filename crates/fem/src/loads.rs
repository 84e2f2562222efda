//! Loads on volumes, as consistent nodal forces: `f_a = integral of N_a b dV`.
//!
//! Integrated with [`crate::quadrature::mass_rule`]: exact for a body force that varies as the displacements do.

use mesh::Mesh;

use crate::chunks::for_each_element;
use crate::error::FemError;
use crate::geometry::{check_connectivity, checked_map, coordinates, position};
use crate::quadrature;
use crate::table::ShapeTable;

/// Nodal forces of a force per volume, N, `[3 n_nodes]`; the force, N/m^3, is a function of the position, m.
pub fn body_load<F>(mesh: &Mesh, force: F) -> Result<Vec<f64>, FemError>
where
    F: Fn([f64; 3]) -> [f64; 3] + Sync,
{
    check_connectivity(mesh)?;
    let table = ShapeTable::new(mesh.kind, &quadrature::mass_rule(mesh.kind));
    let n = mesh.kind.n_nodes();
    let compute = |e: usize, values: &mut [f64]| {
        let x = coordinates(mesh, e);
        values.fill(0.0);
        for q in 0..table.n_points() {
            let weight = table.weights[q] * checked_map(&table, q, &x, e)?.det;
            let b = force(position(&table, q, &x));
            for a in 0..n {
                for i in 0..3 {
                    values[3 * a + i] += weight * table.values[q][a] * b[i];
                }
            }
        }
        Ok(())
    };
    let mut load = vec![0.0; mesh.n_dofs()];
    for_each_element(mesh.n_elements(), 3 * n, compute, |e, values| {
        for (&node, force) in mesh.element(e).iter().zip(values.chunks_exact(3)) {
            for i in 0..3 {
                load[3 * node + i] += force[i];
            }
        }
    })?;
    Ok(load)
}

/// Nodal forces of steady rotation about the z axis, N, `[3 n_nodes]`: `rho omega^2 (x, y, 0)`, outward.
///
/// Density in kg/m^3, angular speed in rad/s. Equals the consistent mass times `omega^2 (x, y, 0)`.
pub fn centrifugal_load(mesh: &Mesh, density: f64, omega: f64) -> Result<Vec<f64>, FemError> {
    let factor = density * omega * omega;
    body_load(mesh, |x| [factor * x[0], factor * x[1], 0.0])
}
