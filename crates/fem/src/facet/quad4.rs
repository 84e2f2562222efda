//! The bilinear quadrilateral: `N_a = (1 + xi_a xi)(1 + eta_a eta) / 4`.

use super::quad8;
use super::size::MAX_FACET_NODES;

/// Values of the shape functions, first 4 of `[MAX_FACET_NODES]`.
#[inline]
pub(super) fn shape(xi: [f64; 2]) -> [f64; MAX_FACET_NODES] {
    let mut n = [0.0; MAX_FACET_NODES];
    for (a, corner) in quad8::NODES[..4].iter().enumerate() {
        n[a] = 0.25 * (1.0 + corner[0] * xi[0]) * (1.0 + corner[1] * xi[1]);
    }
    n
}

/// Reference gradients of the shape functions, first 4 of `[MAX_FACET_NODES][2]`.
#[inline]
pub(super) fn gradients(xi: [f64; 2]) -> [[f64; 2]; MAX_FACET_NODES] {
    let mut dn = [[0.0; 2]; MAX_FACET_NODES];
    for (a, corner) in quad8::NODES[..4].iter().enumerate() {
        dn[a] = [
            0.25 * corner[0] * (1.0 + corner[1] * xi[1]),
            0.25 * (1.0 + corner[0] * xi[0]) * corner[1],
        ];
    }
    dn
}
