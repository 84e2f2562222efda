//! The quadratic tetrahedron, in barycentric coordinates `L_0 = 1 - xi - eta - zeta`, `L_1 = xi`, `L_2 = eta`,
//! `L_3 = zeta`.
//!
//! Corner: `L (2 L - 1)`; mid-node of the edge ab: `4 L_a L_b`. Zienkiewicz and Taylor, The Finite Element Method,
//! 5th ed., vol. 1, 2000, section 8.12.

use super::size::MAX_NODES;

/// Reference coordinates: corners, then mid-nodes of the edges 01 12 02 03 13 23.
pub(super) const NODES: [[f64; 3]; 10] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
    [0.0, 0.0, 0.5],
    [0.5, 0.0, 0.5],
    [0.0, 0.5, 0.5],
];

/// Corners of the edges that carry the mid-nodes.
const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]];

/// Gradients of the barycentric coordinates.
const SLOPES: [[f64; 3]; 4] = [
    [-1.0, -1.0, -1.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
];

/// Values of the shape functions, first 10 of `[MAX_NODES]`.
pub(super) fn shape(xi: [f64; 3]) -> [f64; MAX_NODES] {
    let l = barycentric(xi);
    let mut n = [0.0; MAX_NODES];
    for a in 0..4 {
        n[a] = l[a] * (2.0 * l[a] - 1.0);
    }
    for (m, [a, b]) in EDGES.into_iter().enumerate() {
        n[4 + m] = 4.0 * l[a] * l[b];
    }
    n
}

/// Reference gradients of the shape functions, first 10 of `[MAX_NODES][3]`.
pub(super) fn gradients(xi: [f64; 3]) -> [[f64; 3]; MAX_NODES] {
    let l = barycentric(xi);
    let mut dn = [[0.0; 3]; MAX_NODES];
    for i in 0..3 {
        for a in 0..4 {
            dn[a][i] = (4.0 * l[a] - 1.0) * SLOPES[a][i];
        }
        for (m, [a, b]) in EDGES.into_iter().enumerate() {
            dn[4 + m][i] = 4.0 * (SLOPES[a][i] * l[b] + l[a] * SLOPES[b][i]);
        }
    }
    dn
}

/// Values of the linear shape functions of the corners, first 4 of `[MAX_NODES]`.
pub(super) fn corner_shape(xi: [f64; 3]) -> [f64; MAX_NODES] {
    let mut n = [0.0; MAX_NODES];
    n[..4].copy_from_slice(&barycentric(xi));
    n
}

/// Barycentric coordinates.
fn barycentric(xi: [f64; 3]) -> [f64; 4] {
    [1.0 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]]
}
