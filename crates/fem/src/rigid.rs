//! The body as a whole: volume, mass, centre, inertia, rigid motions.
//!
//! Integrated with [`crate::quadrature::mass_rule`]: exact for the meshed shape, so the only error is that of the
//! shape.

use mesh::Mesh;

use crate::chunks::for_each_element;
use crate::error::FemError;
use crate::geometry::{check_connectivity, checked_map, coordinates, position};
use crate::material::Material;
use crate::quadrature;
use crate::table::ShapeTable;

/// Mass properties of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass, m, `[3]`.
    pub centre: [f64; 3],
    /// Inertia tensor about the centre of mass, kg m^2, `[3][3]`: `integral of rho (|r|^2 I - r r^T)`.
    pub tensor: [[f64; 3]; 3],
}

/// Volume of the mesh, m^3.
pub fn volume(mesh: &Mesh) -> Result<f64, FemError> {
    Ok(moments(mesh)?[0])
}

/// Mass, centre and inertia tensor of the mesh.
pub fn inertia(mesh: &Mesh, material: &Material) -> Result<MassProperties, FemError> {
    material.validate()?;
    let [volume, x, y, z, xx, yy, zz, xy, yz, xz] = moments(mesh)?;
    let mass = material.density * volume;
    let c = [x / volume, y / volume, z / volume];
    let origin = mesh.nodes[mesh.connectivity[0]];
    let second = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let mut tensor = [[0.0; 3]; 3];
    let central = |i: usize, j: usize| second[i][j] - volume * c[i] * c[j];
    let trace = central(0, 0) + central(1, 1) + central(2, 2);
    for i in 0..3 {
        for j in 0..3 {
            let diagonal = if i == j { trace } else { 0.0 };
            tensor[i][j] = material.density * (diagonal - central(i, j));
        }
    }
    let centre = [origin[0] + c[0], origin[1] + c[1], origin[2] + c[2]];
    Ok(MassProperties { mass, centre, tensor })
}

/// The six rigid motions as displacements, `[6][3 n_nodes]`: unit translations along x, y, z (m), then unit small
/// rotations about the axes through `about` (m per rad), `e_k x (x - about)`.
pub fn rigid_modes(mesh: &Mesh, about: [f64; 3]) -> [Vec<f64>; 6] {
    let mut modes = [const { Vec::new() }; 6];
    for mode in &mut modes {
        mode.reserve_exact(mesh.n_dofs());
    }
    for node in &mesh.nodes {
        let r = [node[0] - about[0], node[1] - about[1], node[2] - about[2]];
        modes[0].extend([1.0, 0.0, 0.0]);
        modes[1].extend([0.0, 1.0, 0.0]);
        modes[2].extend([0.0, 0.0, 1.0]);
        modes[3].extend([0.0, -r[2], r[1]]);
        modes[4].extend([r[2], 0.0, -r[0]]);
        modes[5].extend([-r[1], r[0], 0.0]);
    }
    modes
}

/// Integrals of `1, x, y, z, xx, yy, zz, xy, yz, xz` about the first element's first node, m^3 to m^5.
fn moments(mesh: &Mesh) -> Result<[f64; 10], FemError> {
    check_connectivity(mesh)?;
    let origin = mesh.nodes[mesh.connectivity[0]];
    let table = ShapeTable::new(mesh.kind, &quadrature::mass_rule(mesh.kind));
    let compute = |e: usize, values: &mut [f64]| {
        let nodes = coordinates(mesh, e);
        values.fill(0.0);
        for q in 0..table.n_points() {
            let weight = table.weights[q] * checked_map(&table, q, &nodes, e)?.det;
            let p = position(&table, q, &nodes);
            let [x, y, z] = [p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]];
            let terms = [1.0, x, y, z, x * x, y * y, z * z, x * y, y * z, x * z];
            for (value, term) in values.iter_mut().zip(terms) {
                *value += weight * term;
            }
        }
        Ok(())
    };
    let mut total = [0.0; 10];
    for_each_element(mesh.n_elements(), 10, compute, |_, values| {
        for (sum, value) in total.iter_mut().zip(values) {
            *sum += value;
        }
    })?;
    Ok(total)
}
