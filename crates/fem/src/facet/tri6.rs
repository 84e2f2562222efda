//! The quadratic triangle, in barycentric coordinates `L_0 = 1 - xi - eta`, `L_1 = xi`, `L_2 = eta`.
//!
//! Corner: `L (2 L - 1)`; mid-node of the edge ab: `4 L_a L_b`.

use super::size::MAX_FACET_NODES;

/// Reference coordinates: corners, then mid-nodes of the edges 01 12 20.
pub(super) const NODES: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [1.0, 0.0],
    [0.0, 1.0],
    [0.5, 0.0],
    [0.5, 0.5],
    [0.0, 0.5],
];

/// Gradients of the barycentric coordinates.
const SLOPES: [[f64; 2]; 3] = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];

/// Values of the shape functions, first 6 of `[MAX_FACET_NODES]`.
pub(super) fn shape(xi: [f64; 2]) -> [f64; MAX_FACET_NODES] {
    let l = barycentric(xi);
    let mut n = [0.0; MAX_FACET_NODES];
    for a in 0..3 {
        n[a] = l[a] * (2.0 * l[a] - 1.0);
        n[3 + a] = 4.0 * l[a] * l[(a + 1) % 3];
    }
    n
}

/// Reference gradients of the shape functions, first 6 of `[MAX_FACET_NODES][2]`.
pub(super) fn gradients(xi: [f64; 2]) -> [[f64; 2]; MAX_FACET_NODES] {
    let l = barycentric(xi);
    let mut dn = [[0.0; 2]; MAX_FACET_NODES];
    for a in 0..3 {
        let b = (a + 1) % 3;
        for i in 0..2 {
            dn[a][i] = (4.0 * l[a] - 1.0) * SLOPES[a][i];
            dn[3 + a][i] = 4.0 * (SLOPES[a][i] * l[b] + l[a] * SLOPES[b][i]);
        }
    }
    dn
}

/// Barycentric coordinates.
fn barycentric(xi: [f64; 2]) -> [f64; 3] {
    [1.0 - xi[0] - xi[1], xi[0], xi[1]]
}
