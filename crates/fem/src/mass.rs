//! The consistent mass matrix `M_ab = integral of rho N_a N_b`, times the identity of the three components.
//!
//! The rule integrates it exactly on every element, curved ones included ([`crate::quadrature::mass_rule`]).

use mesh::{ElementKind, Mesh};
use sprs::CsMat;

use crate::chunks::for_each_element;
use crate::error::FemError;
use crate::geometry::{checked_map, coordinates, physical, position};
use crate::material::Material;
use crate::pattern::Pattern;
use crate::quadrature;
use crate::table::ShapeTable;

/// The mass matrix of all degrees of freedom, kg, `[3 n_nodes][3 n_nodes]`, CSR, exactly symmetric.
///
/// It has the stiffness's pattern, with explicit zeros between components; [`assemble_node_mass`] is nine times
/// smaller.
pub fn assemble_mass(mesh: &Mesh, material: &Material) -> Result<CsMat<f64>, FemError> {
    let pattern = Pattern::new(mesh)?;
    let mut values = vec![0.0; pattern.n_values()];
    assemble_mass_into(&pattern, mesh, material, &mut values)?;
    Ok(pattern.matrix(values))
}

/// Overwrites `values` with the mass, kg, `[pattern.n_values()]`, in the layout of [`Pattern::matrix`].
///
/// # Panics
/// If the pattern is not the mesh's or `values` has another length.
pub fn assemble_mass_into(
    pattern: &Pattern,
    mesh: &Mesh,
    material: &Material,
    values: &mut [f64],
) -> Result<(), FemError> {
    assert_eq!(
        pattern.n_values(),
        values.len(),
        "values must have the pattern's length"
    );
    let scalars = node_mass(pattern, mesh, material)?;
    pattern.spread(&scalars, values);
    Ok(())
}

/// The mass between nodes, m_ab, kg, `[n_nodes][n_nodes]`, CSR: the mass matrix is m_ab times the 3 x 3 identity.
pub fn assemble_node_mass(
    pattern: &Pattern,
    mesh: &Mesh,
    material: &Material,
) -> Result<CsMat<f64>, FemError> {
    Ok(pattern.node_matrix(node_mass(pattern, mesh, material)?))
}

/// The mass between displacements and the growth of others with the azimuth about z, kg, `[3 n_nodes][3 n_nodes]`, CSR:
///
/// ```text
/// S_ab = integral of rho N_a (x dN_b/dy - y dN_b/dx),   times the identity of the Cartesian components
/// ```
///
/// What of a body of revolution moves through a place while it turns with W about z has the acceleration
/// u'' + 2 W du'/dtheta + ... there, so 2 W S is its gyroscopic matrix in space. Skew-symmetric: what a surface that is
/// not one of revolution adds to that is left out.
pub fn assemble_azimuthal_mass(mesh: &Mesh, material: &Material) -> Result<CsMat<f64>, FemError> {
    let pattern = Pattern::new(mesh)?;
    material.validate()?;
    let kernel = NodeMass::new(mesh.kind, material);
    let scalars = node_scalars(&pattern, mesh, |e, matrix| kernel.azimuthal(mesh, e, matrix))?;
    let mut values = vec![0.0; pattern.n_values()];
    pattern.spread(&scalars, &mut values);
    Ok(pattern.matrix(values))
}

/// Values of the mass between nodes, kg, one per pair of neighbours.
fn node_mass(pattern: &Pattern, mesh: &Mesh, material: &Material) -> Result<Vec<f64>, FemError> {
    material.validate()?;
    let kernel = NodeMass::new(mesh.kind, material);
    node_scalars(pattern, mesh, |e, matrix| kernel.compute(mesh, e, matrix))
}

/// The sum over elements of what `compute` writes between their nodes, `[n][n]`, one value per pair of neighbours.
pub(crate) fn node_scalars(
    pattern: &Pattern,
    mesh: &Mesh,
    compute: impl Fn(usize, &mut [f64]) -> Result<(), FemError> + Sync,
) -> Result<Vec<f64>, FemError> {
    assert_eq!(
        pattern.n_nodes(),
        mesh.n_nodes(),
        "the pattern belongs to another mesh"
    );
    let n = mesh.kind.n_nodes();
    let mut scalars = vec![0.0; pattern.n_pairs()];
    for_each_element(mesh.n_elements(), n * n, compute, |e, matrix| {
        pattern.add_scalars(e, mesh.element(e), matrix, &mut scalars);
    })?;
    Ok(scalars)
}

/// What the masses of all elements of a kind and material share.
pub(crate) struct NodeMass {
    table: ShapeTable,
    density: f64,
}

impl NodeMass {
    /// Tabulates the functions of a kind for a valid material.
    pub fn new(kind: ElementKind, material: &Material) -> NodeMass {
        NodeMass {
            table: ShapeTable::new(kind, &quadrature::mass_rule(kind)),
            density: material.density,
        }
    }

    /// Overwrites `matrix` with the mass between the nodes of element `e`, kg, `[n][n]`.
    pub fn compute(&self, mesh: &Mesh, e: usize, matrix: &mut [f64]) -> Result<(), FemError> {
        let n = mesh.kind.n_nodes();
        let x = coordinates(mesh, e);
        matrix.fill(0.0);
        for q in 0..self.table.n_points() {
            let weight = self.density * self.table.weights[q] * checked_map(&self.table, q, &x, e)?.det;
            let values = &self.table.values[q][..n];
            for a in 0..n {
                for b in a..n {
                    matrix[a * n + b] += weight * (values[a] * values[b]);
                }
            }
        }
        for a in 0..n {
            for b in 0..a {
                matrix[a * n + b] = matrix[b * n + a];
            }
        }
        Ok(())
    }

    /// Overwrites `matrix` with the skew part of the mass of element `e` between its functions and their growth with
    /// the azimuth, kg, `[n][n]`.
    fn azimuthal(&self, mesh: &Mesh, e: usize, matrix: &mut [f64]) -> Result<(), FemError> {
        let n = mesh.kind.n_nodes();
        let nodes = coordinates(mesh, e);
        matrix.fill(0.0);
        for q in 0..self.table.n_points() {
            let map = checked_map(&self.table, q, &nodes, e)?;
            let [x, y, _] = position(&self.table, q, &nodes);
            let weight = 0.5 * self.density * self.table.weights[q] * map.det;
            let (values, reference) = (&self.table.values[q], &self.table.gradients[q]);
            let growth = |b: usize| {
                let [along_x, along_y, _] = physical(&map.inverse, [0, 1, 2].map(|i| reference[i][b]));
                x * along_y - y * along_x
            };
            let growths: Vec<f64> = (0..n).map(growth).collect();
            for a in 0..n {
                for b in 0..a {
                    let entry = weight * (values[a] * growths[b] - values[b] * growths[a]);
                    matrix[a * n + b] += entry;
                    matrix[b * n + a] -= entry;
                }
            }
        }
        Ok(())
    }
}
