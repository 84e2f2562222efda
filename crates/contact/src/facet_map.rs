//! Reference coordinates of points of a facet in the plane of azimuth and groove angle.
//!
//! Facets whose edges are lines of constant azimuth and of constant groove angle, as those of revolved rings are,
//! with mid-nodes in the middle, have an affine map, which is inverted once and for all. Others take Newton's
//! iteration.

use fem::facet;
use mesh::FacetKind;

use crate::unwrap::unwrap_near;

/// Distance of the nodes of an affine facet from where the affine map has them, reference coordinates: what round-off
/// of positions makes of a thousandth of a turn, with a margin.
const AFFINE: f64 = 1e-11;

/// Newton's step, in reference coordinates, after which a point is found: the error left is about its square.
/// Azimuths are rounded to 1e-14 of a facet, so that smaller steps may never come.
const CONVERGED: f64 = 1e-9;

/// The inverse of an affine map from reference coordinates to (azimuth, groove angle), rad.
pub(crate) struct Affine {
    origin: [f64; 2],
    inverse: [[f64; 2]; 2],
}

impl Affine {
    /// Of the facet with nodes at `coordinates` (azimuth, groove angle), rad; None when its map is not affine.
    pub fn new(kind: FacetKind, coordinates: &[[f64; 2]]) -> Option<Affine> {
        let (origin, j) = linear(kind, coordinates, [0.0; 2]);
        let det = determinant(j)?;
        let affine = Affine {
            origin,
            inverse: [[j[1][1] / det, -j[0][1] / det], [-j[1][0] / det, j[0][0] / det]],
        };
        let fits = |(at, node): (&[f64; 2], &[f64; 2])| {
            let xi = affine.reference(*at);
            (0..2).all(|i| (xi[i] - node[i]).abs() <= AFFINE)
        };
        let mut nodes = coordinates.iter().zip(facet::reference_nodes(kind));
        nodes.all(fits).then_some(affine)
    }

    /// Reference coordinates of a point (azimuth, groove angle), rad, whatever the turn of its azimuth.
    #[inline(always)]
    pub fn reference(&self, [azimuth, angle]: [f64; 2]) -> [f64; 2] {
        let azimuth = unwrap_near(azimuth, self.origin[0]);
        let from = [azimuth - self.origin[0], angle - self.origin[1]];
        [0, 1].map(|i| self.inverse[i][0] * from[0] + self.inverse[i][1] * from[1])
    }

    /// Growth of the reference coordinates with the azimuth, per rad.
    pub fn azimuth_slope(&self) -> [f64; 2] {
        [self.inverse[0][0], self.inverse[1][0]]
    }
}

/// Growth of the reference coordinates with the azimuth, per rad, at a point of a facet; 0 where its map is singular.
pub(crate) fn azimuth_slope(kind: FacetKind, coordinates: &[[f64; 2]], xi: [f64; 2]) -> [f64; 2] {
    let (_, j) = linear(kind, coordinates, xi);
    determinant(j).map_or([0.0; 2], |det| [j[1][1] / det, -j[1][0] / det])
}

/// Reference coordinates of a target (azimuth, groove angle) by Newton; None when it does not converge.
pub(crate) fn invert(kind: FacetKind, coordinates: &[[f64; 2]], target: [f64; 2]) -> Option<[f64; 2]> {
    let mut xi = if kind == FacetKind::Tri6 {
        [1.0 / 3.0; 2]
    } else {
        [0.0; 2]
    };
    // A facet's map is nearly affine; 20 rounds are far beyond what a usable facet needs.
    for _ in 0..20 {
        let (at, j) = linear(kind, coordinates, xi);
        let residual = [target[0] - at[0], target[1] - at[1]];
        let det = determinant(j)?;
        let step = [
            (residual[0] * j[1][1] - residual[1] * j[0][1]) / det,
            (residual[1] * j[0][0] - residual[0] * j[1][0]) / det,
        ];
        xi = [xi[0] + step[0], xi[1] + step[1]];
        if step[0].abs().max(step[1].abs()) < CONVERGED {
            return Some(xi);
        }
        if xi[0].abs().max(xi[1].abs()) > 10.0 {
            return None;
        }
    }
    Some(xi)
}

/// Largest distance outside the reference facet, negative or zero inside.
#[inline]
pub(crate) fn outside(kind: FacetKind, xi: [f64; 2]) -> f64 {
    match kind {
        FacetKind::Tri6 => (-xi[0]).max(-xi[1]).max(xi[0] + xi[1] - 1.0),
        _ => xi[0].abs().max(xi[1].abs()) - 1.0,
    }
}

/// Image of a reference point and derivatives of the map there.
fn linear(kind: FacetKind, coordinates: &[[f64; 2]], xi: [f64; 2]) -> ([f64; 2], [[f64; 2]; 2]) {
    let (shape, gradients) = (facet::shape(kind, xi), facet::gradients(kind, xi));
    let (mut at, mut j) = ([0.0; 2], [[0.0; 2]; 2]);
    for (a, c) in coordinates.iter().enumerate() {
        for i in 0..2 {
            at[i] += shape[a] * c[i];
            j[i][0] += gradients[a][0] * c[i];
            j[i][1] += gradients[a][1] * c[i];
        }
    }
    (at, j)
}

/// None of a map that cannot be inverted.
fn determinant(j: [[f64; 2]; 2]) -> Option<f64> {
    let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
    (det != 0.0 && det.is_finite()).then_some(det)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: points of a skewed parallelogram would be found elsewhere than by Newton, or a facet with a mid-node
    /// out of the middle, or a trapezium, would be taken for affine.
    #[test]
    fn parallelograms_are_inverted_as_newton_does() {
        for kind in [FacetKind::Quad4, FacetKind::Quad8, FacetKind::Tri6] {
            let image = |xi: &[f64; 2]| {
                [
                    3.0 + 0.02 * xi[0] + 0.003 * xi[1],
                    0.2 - 0.001 * xi[0] + 0.05 * xi[1],
                ]
            };
            let mut nodes: Vec<[f64; 2]> = facet::reference_nodes(kind).iter().map(image).collect();
            let affine = Affine::new(kind, &nodes).expect("the image of the nodes is affine");
            for xi in [[0.3, 0.2], [0.0, 0.9], [0.7, 0.1]] {
                let (found, newton) = (
                    affine.reference(image(&xi)),
                    invert(kind, &nodes, image(&xi)).unwrap(),
                );
                for i in 0..2 {
                    assert!(
                        (found[i] - newton[i]).abs() < 1e-13,
                        "{kind:?}: {found:?} {newton:?}"
                    );
                    assert!((found[i] - xi[i]).abs() < 1e-13, "{kind:?}: {found:?} {xi:?}");
                }
            }
            let last = nodes.len() - 1;
            nodes[last][0] += 1e-9;
            assert!(Affine::new(kind, &nodes).is_none(), "{kind:?}");
        }
    }
}
