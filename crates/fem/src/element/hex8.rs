//! The trilinear hexahedron: `N_a = (1 + xi_a xi)(1 + eta_a eta)(1 + zeta_a zeta) / 8`.
//!
//! Hughes, The Finite Element Method, 1987, section 3.5.

use super::hex20;
use super::size::MAX_NODES;

/// Values of the shape functions, first 8 of `[MAX_NODES]`.
pub(super) fn shape(xi: [f64; 3]) -> [f64; MAX_NODES] {
    let mut n = [0.0; MAX_NODES];
    for (a, corner) in hex20::NODES[..8].iter().enumerate() {
        let s = factors(corner, xi);
        n[a] = 0.125 * s[0] * s[1] * s[2];
    }
    n
}

/// Reference gradients of the shape functions, first 8 of `[MAX_NODES][3]`.
pub(super) fn gradients(xi: [f64; 3]) -> [[f64; 3]; MAX_NODES] {
    let mut dn = [[0.0; 3]; MAX_NODES];
    for (a, corner) in hex20::NODES[..8].iter().enumerate() {
        let s = factors(corner, xi);
        dn[a] = [
            0.125 * corner[0] * s[1] * s[2],
            0.125 * s[0] * corner[1] * s[2],
            0.125 * s[0] * s[1] * corner[2],
        ];
    }
    dn
}

/// The three factors `1 + xi_a xi` of a corner's function.
fn factors(corner: &[f64; 3], xi: [f64; 3]) -> [f64; 3] {
    [
        1.0 + corner[0] * xi[0],
        1.0 + corner[1] * xi[1],
        1.0 + corner[2] * xi[2],
    ]
}
