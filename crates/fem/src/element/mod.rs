//! Shape functions of the volume elements, one file per element.
//!
//! Reference cells: hexahedra `[-1, 1]^3`; tetrahedron `xi, eta, zeta >= 0`, `xi + eta + zeta <= 1`. Node order is
//! that of [`mesh::ElementKind`].

mod hex20;
mod hex8;
mod size;
mod tet10;

use mesh::ElementKind;

pub use size::MAX_NODES;

/// Values of the shape functions at a reference point, `[MAX_NODES]`.
pub fn shape(kind: ElementKind, xi: [f64; 3]) -> [f64; MAX_NODES] {
    match kind {
        ElementKind::Hex8 => hex8::shape(xi),
        ElementKind::Hex20 => hex20::shape(xi),
        ElementKind::Tet10 => tet10::shape(xi),
    }
}

/// Derivatives of the shape functions with respect to the reference coordinates, `[MAX_NODES][3]`.
pub fn gradients(kind: ElementKind, xi: [f64; 3]) -> [[f64; 3]; MAX_NODES] {
    match kind {
        ElementKind::Hex8 => hex8::gradients(xi),
        ElementKind::Hex20 => hex20::gradients(xi),
        ElementKind::Tet10 => tet10::gradients(xi),
    }
}

/// Reference coordinates of the nodes, `[kind.n_nodes()][3]`.
pub fn reference_nodes(kind: ElementKind) -> &'static [[f64; 3]] {
    match kind {
        ElementKind::Hex8 => &hex20::NODES[..8],
        ElementKind::Hex20 => &hex20::NODES,
        ElementKind::Tet10 => &tet10::NODES,
    }
}

/// Values of the shape functions of the corners alone (trilinear or linear), `[MAX_NODES]`.
pub fn corner_shape(kind: ElementKind, xi: [f64; 3]) -> [f64; MAX_NODES] {
    match kind {
        ElementKind::Hex8 | ElementKind::Hex20 => hex8::shape(xi),
        ElementKind::Tet10 => tet10::corner_shape(xi),
    }
}
