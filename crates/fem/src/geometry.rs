//! The map from reference to physical coordinates: `J_ij = dx_j / dxi_i`, its determinant and inverse.

use mesh::Mesh;

use crate::element::MAX_NODES;
use crate::error::FemError;
use crate::material::Material;
use crate::quadrature;
use crate::table::ShapeTable;

/// Coordinates of one element's nodes, m, `[MAX_NODES][3]`, zero beyond its nodes.
pub(crate) type ElementCoordinates = [[f64; 3]; MAX_NODES];

/// Inverse and determinant of a Jacobian.
pub(crate) struct InverseMap {
    /// `inverse[j][i] = dxi_i / dx_j`, 1/m.
    pub inverse: [[f64; 3]; 3],
    /// Determinant of the Jacobian, m^3.
    pub det: f64,
}

/// Refuses a mesh of [`check_connectivity`] and a material that are not sound, before displacements `u`, m,
/// `[3 n_nodes]`, are taken of them.
///
/// # Panics
/// If `u` has another length.
pub(crate) fn check_displaced(mesh: &Mesh, material: &Material, u: &[f64]) -> Result<(), FemError> {
    assert_eq!(
        u.len(),
        mesh.n_dofs(),
        "a displacement of every degree of freedom"
    );
    check_connectivity(mesh)?;
    material.validate()
}

/// Refuses a mesh without elements, with a broken connectivity, or with unknown nodes.
pub(crate) fn check_connectivity(mesh: &Mesh) -> Result<(), FemError> {
    let kind = mesh.kind.name();
    let nodes_per_element = mesh.kind.n_nodes();
    if mesh.connectivity.is_empty() {
        return Err(FemError::EmptyMesh { kind });
    }
    let length = mesh.connectivity.len();
    if !length.is_multiple_of(nodes_per_element) {
        return Err(FemError::PartialElement {
            length,
            nodes_per_element,
            kind,
        });
    }
    let n_nodes = mesh.n_nodes();
    match mesh.connectivity.iter().position(|&node| node >= n_nodes) {
        None => Ok(()),
        Some(place) => Err(FemError::UnknownNode {
            element: place / nodes_per_element,
            node: mesh.connectivity[place],
            n_nodes,
        }),
    }
}

/// Refuses a mesh with a broken connectivity or with an element that is inverted at a point of the mass rule.
pub fn check_elements(mesh: &Mesh) -> Result<(), FemError> {
    check_connectivity(mesh)?;
    let table = ShapeTable::new(mesh.kind, &quadrature::mass_rule(mesh.kind));
    let measure = |e: usize, _: &mut [f64]| {
        let x = coordinates(mesh, e);
        (0..table.n_points()).try_for_each(|q| checked_map(&table, q, &x, e).map(|_| ()))
    };
    crate::chunks::for_each_element(mesh.n_elements(), 1, measure, |_, _| ())
}

/// Coordinates of the nodes of element `e`.
pub(crate) fn coordinates(mesh: &Mesh, e: usize) -> ElementCoordinates {
    let mut x = [[0.0; 3]; MAX_NODES];
    for (a, &node) in mesh.element(e).iter().enumerate() {
        x[a] = mesh.nodes[node];
    }
    x
}

/// `J_ij = sum_a dN_a/dxi_i x_aj` from reference gradients by component.
#[inline]
pub(crate) fn jacobian(n_nodes: usize, dn: &[[f64; MAX_NODES]; 3], x: &ElementCoordinates) -> [[f64; 3]; 3] {
    let mut j = [[0.0; 3]; 3];
    for a in 0..n_nodes {
        for i in 0..3 {
            for c in 0..3 {
                j[i][c] += dn[i][a] * x[a][c];
            }
        }
    }
    j
}

/// Inverse and determinant of a Jacobian, by cofactors.
#[inline]
pub(crate) fn invert(j: &[[f64; 3]; 3]) -> InverseMap {
    let cofactor = |r: usize, c: usize| {
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        j[r1][c1] * j[r2][c2] - j[r1][c2] * j[r2][c1]
    };
    let first = [cofactor(0, 0), cofactor(0, 1), cofactor(0, 2)];
    let det = j[0][0] * first[0] + j[0][1] * first[1] + j[0][2] * first[2];
    let scale = 1.0 / det;
    let mut inverse = [[0.0; 3]; 3];
    for c in 0..3 {
        inverse[c] = [first[c] * scale, cofactor(1, c) * scale, cofactor(2, c) * scale];
    }
    InverseMap { inverse, det }
}

/// The inverse map of element `e` at point `q` of a table, refused unless its determinant is positive.
#[inline]
pub(crate) fn checked_map(
    table: &ShapeTable,
    q: usize,
    x: &ElementCoordinates,
    e: usize,
) -> Result<InverseMap, FemError> {
    let map = invert(&jacobian(table.kind.n_nodes(), &table.gradients[q], x));
    if map.det > 0.0 {
        return Ok(map);
    }
    let position = position(table, q, x);
    Err(FemError::NonPositiveJacobian {
        element: e,
        kind: table.kind.name(),
        position,
        det: map.det,
    })
}

/// Physical position of point `q` of a table, m.
pub(crate) fn position(table: &ShapeTable, q: usize, x: &ElementCoordinates) -> [f64; 3] {
    let mut point = [0.0; 3];
    for a in 0..table.kind.n_nodes() {
        for i in 0..3 {
            point[i] += table.values[q][a] * x[a][i];
        }
    }
    point
}

/// Physical gradient `dN_a/dx_j = sum_i dxi_i/dx_j dN_a/dxi_i`.
pub(crate) fn physical(inverse: &[[f64; 3]; 3], dn: [f64; 3]) -> [f64; 3] {
    let row = |j: usize| inverse[j][0] * dn[0] + inverse[j][1] * dn[1] + inverse[j][2] * dn[2];
    [row(0), row(1), row(2)]
}
