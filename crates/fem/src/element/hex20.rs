//! The serendipity hexahedron.
//!
//! Corner a: `(1 + xi_a xi)(1 + eta_a eta)(1 + zeta_a zeta)(xi_a xi + eta_a eta + zeta_a zeta - 2) / 8`; mid-node of
//! an edge along xi: `(1 - xi^2)(1 + eta_a eta)(1 + zeta_a zeta) / 4`, and likewise along eta and zeta. Zienkiewicz
//! and Taylor, The Finite Element Method, 5th ed., vol. 1, 2000, section 8.11.

use super::size::MAX_NODES;

/// Reference coordinates: corners, mid-nodes of the bottom, the top and the vertical edges.
pub(super) const NODES: [[f64; 3]; 20] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [0.0, -1.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, -1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [-1.0, 0.0, 1.0],
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
];

/// Values of the shape functions, `[MAX_NODES]`.
pub(super) fn shape(xi: [f64; 3]) -> [f64; MAX_NODES] {
    let mut n = [0.0; MAX_NODES];
    for (a, node) in NODES.iter().enumerate() {
        let f = [
            factor(node[0], xi[0]),
            factor(node[1], xi[1]),
            factor(node[2], xi[2]),
        ];
        let product = f[0] * f[1] * f[2];
        n[a] = if a < 8 {
            0.125 * product * (projection(node, xi) - 2.0)
        } else {
            0.25 * product
        };
    }
    n
}

/// Reference gradients of the shape functions, `[MAX_NODES][3]`.
pub(super) fn gradients(xi: [f64; 3]) -> [[f64; 3]; MAX_NODES] {
    let mut dn = [[0.0; 3]; MAX_NODES];
    for (a, node) in NODES.iter().enumerate() {
        let f = [
            factor(node[0], xi[0]),
            factor(node[1], xi[1]),
            factor(node[2], xi[2]),
        ];
        for i in 0..3 {
            let others = f[(i + 1) % 3] * f[(i + 2) % 3];
            let product_slope = factor_slope(node[i], xi[i]) * others;
            dn[a][i] = if a < 8 {
                0.125 * (product_slope * (projection(node, xi) - 2.0) + f[i] * others * node[i])
            } else {
                0.25 * product_slope
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

/// `xi_a xi + eta_a eta + zeta_a zeta`.
fn projection(node: &[f64; 3], xi: [f64; 3]) -> f64 {
    node[0] * xi[0] + node[1] * xi[1] + node[2] * xi[2]
}
