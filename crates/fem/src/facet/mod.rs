//! Shape functions of the boundary facets, and points and normals on them, one file per facet.
//!
//! Reference cells: quadrilaterals `[-1, 1]^2`; triangle `xi, eta >= 0`, `xi + eta <= 1`. Node order is that of
//! [`mesh::FacetKind`]; the normal is outward by the right-hand rule. A facet's functions are the traces of its
//! element's.

mod quad4;
mod quad8;
mod size;
mod tri6;

use mesh::FacetKind;

pub use size::MAX_FACET_NODES;

/// Values of the shape functions at a reference point, `[MAX_FACET_NODES]`.
#[inline]
pub fn shape(kind: FacetKind, xi: [f64; 2]) -> [f64; MAX_FACET_NODES] {
    match kind {
        FacetKind::Quad4 => quad4::shape(xi),
        FacetKind::Quad8 => quad8::shape(xi),
        FacetKind::Tri6 => tri6::shape(xi),
    }
}

/// Derivatives of the shape functions with respect to the reference coordinates, `[MAX_FACET_NODES][2]`.
#[inline]
pub fn gradients(kind: FacetKind, xi: [f64; 2]) -> [[f64; 2]; MAX_FACET_NODES] {
    match kind {
        FacetKind::Quad4 => quad4::gradients(xi),
        FacetKind::Quad8 => quad8::gradients(xi),
        FacetKind::Tri6 => tri6::gradients(xi),
    }
}

/// Reference coordinates of the nodes, `[kind.n_nodes()][2]`.
pub fn reference_nodes(kind: FacetKind) -> &'static [[f64; 2]] {
    match kind {
        FacetKind::Quad4 => &quad8::NODES[..4],
        FacetKind::Quad8 => &quad8::NODES,
        FacetKind::Tri6 => &tri6::NODES,
    }
}

/// Position and area vector at a reference point, from node coordinates in m, `[kind.n_nodes()][3]`.
///
/// The area vector `a = dx/dxi x dx/deta` points outward; `|a| dxi deta` is the area element, m^2.
pub fn point_and_area(kind: FacetKind, nodes: &[[f64; 3]], xi: [f64; 2]) -> ([f64; 3], [f64; 3]) {
    let n = shape(kind, xi);
    let dn = gradients(kind, xi);
    let mut x = [0.0; 3];
    let mut t = [[0.0; 3]; 2];
    for (a, node) in nodes.iter().enumerate() {
        for i in 0..3 {
            x[i] += n[a] * node[i];
            t[0][i] += dn[a][0] * node[i];
            t[1][i] += dn[a][1] * node[i];
        }
    }
    (x, cross(t[0], t[1]))
}

/// Cross product.
fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
