//! The stiffness matrix `K_ab = integral of B_a^T D B_b`.
//!
//! For isotropic material the 3 x 3 block of a node pair needs no B matrix: with
//! `T_ij = integral of dN_a/dx_i dN_b/dx_j`, `K_ij = lambda T_ij + mu T_ji + mu tr(T) I_ij`: put Hooke's law
//! `D_ikjl = lambda d_ik d_jl + mu (d_ij d_kl + d_il d_kj)` between the two gradients.
//!
//! Hexahedra with 8 nodes carry the incompatible modes of Taylor, Beresford and Wilson (file `modes.rs`), condensed
//! inside the element: bending is right without reduced integration. Cost on one core of a 2.3 GHz machine: see the
//! example `measure`.

pub(crate) mod kernel;
pub(crate) mod modes;

use mesh::{ElementKind, Mesh};
use sprs::CsMat;

use crate::chunks::for_each_element;
use crate::element::MAX_NODES;
use crate::error::FemError;
use crate::geometry::check_displaced;
use crate::material::Material;
use crate::pattern::Pattern;
use crate::quadrature;
use crate::table::ShapeTable;

/// The stiffness matrix of all degrees of freedom, N/m, `[3 n_nodes][3 n_nodes]`, CSR, exactly symmetric.
pub fn assemble_stiffness(mesh: &Mesh, material: &Material) -> Result<CsMat<f64>, FemError> {
    let pattern = Pattern::new(mesh)?;
    let mut values = vec![0.0; pattern.n_values()];
    assemble_stiffness_into(&pattern, mesh, material, &mut values)?;
    Ok(pattern.matrix(values))
}

/// Overwrites `values` with the stiffness, N/m, `[pattern.n_values()]`, in the layout of [`Pattern::matrix`].
///
/// # Panics
/// If the pattern is not the mesh's or `values` has another length.
pub fn assemble_stiffness_into(
    pattern: &Pattern,
    mesh: &Mesh,
    material: &Material,
    values: &mut [f64],
) -> Result<(), FemError> {
    assert_eq!(
        pattern.n_nodes(),
        mesh.n_nodes(),
        "the pattern belongs to another mesh"
    );
    assert_eq!(
        pattern.n_values(),
        values.len(),
        "values must have the pattern's length"
    );
    material.validate()?;
    let kernel = ElementStiffness::new(mesh.kind, material);
    values.fill(0.0);
    let n = 3 * mesh.kind.n_nodes();
    let compute = |e: usize, matrix: &mut [f64]| kernel.compute(mesh, e, matrix);
    for_each_element(mesh.n_elements(), n * n, compute, |e, matrix| {
        pattern.add_blocks(e, mesh.element(e), matrix, values);
    })
}

/// Nodal forces that hold the displacements `u`, m, `[3 n_nodes]`: K u, N, in the same layout, without the matrix.
///
/// Cost: the stiffness of every element once, and memory for the forces alone.
///
/// # Panics
/// If `u` has another length.
pub fn stiffness_product(mesh: &Mesh, material: &Material, u: &[f64]) -> Result<Vec<f64>, FemError> {
    check_displaced(mesh, material, u)?;
    let kernel = ElementStiffness::new(mesh.kind, material);
    let n = 3 * mesh.kind.n_nodes();
    let compute = |e: usize, forces: &mut [f64]| {
        let mut matrix = [0.0; 9 * MAX_NODES * MAX_NODES];
        kernel.compute(mesh, e, &mut matrix[..n * n])?;
        let nodes = mesh.element(e);
        for (force, row) in forces.iter_mut().zip(matrix.chunks_exact(n)) {
            let terms = row
                .iter()
                .enumerate()
                .map(|(j, k)| k * u[3 * nodes[j / 3] + j % 3]);
            *force = terms.sum();
        }
        Ok(())
    };
    let mut product = vec![0.0; mesh.n_dofs()];
    for_each_element(mesh.n_elements(), n, compute, |e, forces| {
        for (&node, force) in mesh.element(e).iter().zip(forces.chunks_exact(3)) {
            (0..3).for_each(|i| product[3 * node + i] += force[i]);
        }
    })?;
    Ok(product)
}

/// What all elements of a kind and material share.
pub(crate) struct ElementStiffness {
    table: ShapeTable,
    lambda: f64,
    mu: f64,
}

impl ElementStiffness {
    /// Tabulates the functions of a kind for a valid material.
    pub fn new(kind: ElementKind, material: &Material) -> ElementStiffness {
        ElementStiffness {
            table: ShapeTable::new(kind, &quadrature::stiffness_rule(kind)),
            lambda: material.lame_lambda(),
            mu: material.shear_modulus(),
        }
    }

    /// Overwrites `matrix` with the stiffness of element `e`, N/m, `[3 n][3 n]`.
    pub fn compute(&self, mesh: &Mesh, e: usize, matrix: &mut [f64]) -> Result<(), FemError> {
        let ElementStiffness { table, lambda, mu } = self;
        match mesh.kind {
            ElementKind::Hex8 => kernel::with_modes(table, mesh, e, *lambda, *mu, matrix),
            ElementKind::Hex20 => kernel::compatible::<20>(table, mesh, e, *lambda, *mu, matrix),
            ElementKind::Tet10 => kernel::compatible::<10>(table, mesh, e, *lambda, *mu, matrix),
        }
    }
}
