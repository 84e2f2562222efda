//! The serendipity quadrilateral, the face of the 20-node hexahedron.
//!
//! Corner: `(1 + xi_a xi)(1 + eta_a eta)(xi_a xi + eta_a eta - 1) / 4`; mid-node of an edge along xi:
//! `(1 - xi^2)(1 + eta_a eta) / 2`, and likewise along eta. Zienkiewicz and Taylor, The Finite Element Method, 5th ed.,
//! vol. 1, 2000, section 8.6.

use super::size::MAX_FACET_NODES;

/// Reference coordinates: corners, then mid-nodes of the edges 01 12 23 30.
pub(super) const NODES: [[f64; 2]; 8] = [
    [-1.0, -1.0],
    [1.0, -1.0],
    [1.0, 1.0],
    [-1.0, 1.0],
    [0.0, -1.0],
    [1.0, 0.0],
    [0.0, 1.0],
    [-1.0, 0.0],
];

/// Values of the shape functions, `[MAX_FACET_NODES]`.
pub(super) fn shape(xi: [f64; 2]) -> [f64; MAX_FACET_NODES] {
    let mut n = [0.0; MAX_FACET_NODES];
    for (a, node) in NODES.iter().enumerate() {
        let product = factor(node[0], xi[0]) * factor(node[1], xi[1]);
        n[a] = if a < 4 {
            0.25 * product * (projection(node, xi) - 1.0)
        } else {
            0.5 * product
        };
    }
    n
}

/// Reference gradients of the shape functions, `[MAX_FACET_NODES][2]`.
pub(super) fn gradients(xi: [f64; 2]) -> [[f64; 2]; MAX_FACET_NODES] {
    let mut dn = [[0.0; 2]; MAX_FACET_NODES];
    for (a, node) in NODES.iter().enumerate() {
        for i in 0..2 {
            let other = factor(node[1 - i], xi[1 - i]);
            let slope = factor_slope(node[i], xi[i]) * other;
            dn[a][i] = if a < 4 {
                0.25 * (slope * (projection(node, xi) - 1.0) + factor(node[i], xi[i]) * other * node[i])
            } else {
                0.5 * slope
            };
        }
    }
    dn
}

/// `1 + xi_a xi`, or `1 - xi^2` along the edge of a mid-node.
fn factor(node: f64, xi: f64) -> f64 {
    if node == 0.0 {
        1.0 - xi * xi
    } else {
        1.0 + node * xi
    }
}

/// Derivative of [`factor`].
fn factor_slope(node: f64, xi: f64) -> f64 {
    if node == 0.0 { -2.0 * xi } else { node }
}

/// `xi_a xi + eta_a eta`.
fn projection(node: &[f64; 2], xi: [f64; 2]) -> f64 {
    node[0] * xi[0] + node[1] * xi[1]
}
