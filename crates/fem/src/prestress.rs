//! Stiffness by a stress that a body has before it is deformed (initial stress, or geometric, stiffness).
//!
//! ```text
//! K_ab = integral of dN_a/dx_i s_ij dN_b/dx_j,   times the identity of the three components
//! ```
//!
//! w K w is the integral of s : (grad w^T grad w), twice the work of the stress s on the squares of the displacement
//! gradients (e.g. Bathe, Finite Element Procedures, 2nd ed., sec. 6.2.3). It is symmetric, and zero for translations.
//! For a small rotation it is not: there it is the load of the turned stress, K (R x) = R f with the load f that the
//! stress balances. On the meshes of this crate that holds to round-off, since the same points and functions make both.
//!
//! The stress is that of displacements u, as Hooke's law has it at the points of the stiffness rule, with the
//! incompatible modes of hex8. The gradients are those of the nodal functions. Linear in u: with u by a load at unit
//! speed squared the matrix is that of unit speed squared.

use mesh::{Mesh, Periodicity};
use sprs::CsMat;

use crate::element::MAX_NODES;
use crate::error::FemError;
use crate::geometry::{check_displaced, checked_map, coordinates, physical};
use crate::mass::node_scalars;
use crate::material::{Material, hooke};
use crate::pattern::Pattern;
use crate::quadrature;
use crate::sector::{SectorCoupling, add_elements, couplings, scalar_blocks};
use crate::stress::kernel::{MAX_POINTS, node_state, strains};
use crate::table::ShapeTable;

/// Stiffness of one sector by a stress.
#[derive(Clone, Debug, PartialEq)]
pub struct SectorPrestress {
    /// Couplings in both directions, those of [`crate::assemble_sector`].
    pub couplings: Vec<SectorCoupling>,
    /// Stiffness of each, N/m, in the layout of [`crate::SectorMatrices::stiffness`].
    pub blocks: Vec<[f64; 9]>,
}

/// The stiffness between nodes by the stress of the displacements `u`, m, `[3 n_nodes]`: N/m, `[n_nodes][n_nodes]`,
/// CSR, exactly symmetric. The matrix of all degrees of freedom is that times the 3 x 3 identity.
///
/// # Panics
/// If the pattern is not the mesh's or `u` has another length.
pub fn assemble_node_prestress(
    pattern: &Pattern,
    mesh: &Mesh,
    material: &Material,
    u: &[f64],
) -> Result<CsMat<f64>, FemError> {
    let kernel = NodePrestress::new(mesh, material, u)?;
    let scalars = node_scalars(pattern, mesh, |e, matrix| kernel.compute(e, matrix))?;
    Ok(pattern.node_matrix(scalars))
}

/// The same of one sector of the mesh that `periodicity` describes, under displacements `u`, m, `[3 n_nodes]`, of the
/// whole mesh that are the same in all sectors.
///
/// # Panics
/// If the periodicity is another mesh's or `u` has another length.
pub fn assemble_sector_prestress(
    mesh: &Mesh,
    periodicity: &Periodicity,
    material: &Material,
    u: &[f64],
) -> Result<SectorPrestress, FemError> {
    assert_eq!(
        periodicity.sites().len(),
        mesh.n_nodes(),
        "the periodicity belongs to another mesh"
    );
    let kernel = NodePrestress::new(mesh, material, u)?;
    let couplings = couplings(mesh, periodicity);
    let compute = scalar_blocks(mesh, |e, scalars| kernel.compute(e, scalars));
    let blocks = add_elements(mesh, periodicity, &couplings, &compute)?;
    Ok(SectorPrestress { couplings, blocks })
}

/// What all elements share.
struct NodePrestress<'a> {
    mesh: &'a Mesh,
    table: ShapeTable,
    lame: [f64; 2],
    u: &'a [f64],
}

impl<'a> NodePrestress<'a> {
    fn new(mesh: &'a Mesh, material: &Material, u: &'a [f64]) -> Result<NodePrestress<'a>, FemError> {
        check_displaced(mesh, material, u)?;
        Ok(NodePrestress {
            table: ShapeTable::new(mesh.kind, &quadrature::stiffness_rule(mesh.kind)),
            lame: [material.lame_lambda(), material.shear_modulus()],
            mesh,
            u,
        })
    }

    /// Overwrites `matrix` with the stiffness between the nodes of element `e`, N/m, `[n][n]`.
    fn compute(&self, e: usize, matrix: &mut [f64]) -> Result<(), FemError> {
        let (table, n) = (&self.table, self.mesh.kind.n_nodes());
        let x = coordinates(self.mesh, e);
        let state = node_state(&self.mesh.nodes, self.mesh.element(e), self.u);
        let mut values = [[0.0; 6]; MAX_POINTS];
        strains(table, &state, self.lame, &mut values);
        matrix.fill(0.0);
        for q in 0..table.n_points() {
            let map = checked_map(table, q, &x, e)?;
            let weight = table.weights[q] * map.det;
            let [xx, yy, zz, xy, yz, xz] = hooke(self.lame[0], self.lame[1], values[q]).map(|s| weight * s);
            let reference = &table.gradients[q];
            let gradients: [[f64; 3]; MAX_NODES] =
                std::array::from_fn(|a| physical(&map.inverse, [0, 1, 2].map(|i| reference[i][a])));
            for a in 0..n {
                let [x, y, z] = gradients[a];
                let pull = [
                    xx * x + xy * y + xz * z,
                    xy * x + yy * y + yz * z,
                    xz * x + yz * y + zz * z,
                ];
                for b in a..n {
                    let along = gradients[b];
                    matrix[a * n + b] += pull[0] * along[0] + pull[1] * along[1] + pull[2] * along[2];
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
}
