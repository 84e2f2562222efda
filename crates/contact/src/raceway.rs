//! The raceway of a mesh in its own two coordinates: azimuth and groove angle.
//!
//! Every raceway node lies on the torus, so a facet is known by the (azimuth, groove angle) of its nodes. A point is
//! found by inverting the facet's shape functions in that plane; facets that share an edge share its nodes, so
//! the raceway is covered without gaps and interpolation is continuous. Search is over a uniform grid of
//! bins: constant time per point. The groove angle is 0 at the groove bottom and positive as contact angles are.

use std::ops::RangeInclusive;

use fem::facet;
use mesh::{Facet, FacetKind, Mesh};

use crate::bins::{Bins, grown_box};
use crate::error::ContactError;
use crate::facet_map::{Affine, azimuth_slope, invert, outside};
use crate::geometry::Side;
use crate::neighbours::Neighbours;
use crate::unwrap::unwrap_near;

/// Edges crossed on the way to a point before it is searched in the bins.
const MOST_EDGES: usize = 6;

/// How far outside a facet, in reference coordinates, a point may lie and still be taken (curved edges).
const OUTSIDE_TOLERANCE: f64 = 0.02;

/// The torus a raceway lies on, in the coordinates of the mesh, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Groove {
    /// Which raceway.
    pub side: Side,
    /// Radius of the circle of groove centres.
    pub centre_radius: f64,
    /// Groove radius.
    pub groove_radius: f64,
    /// Axial position of the groove centres in the mesh.
    pub centre_z: f64,
}

impl Groove {
    /// Radial and axial distance from the groove centre of a unit step at groove angle `angle`.
    pub fn direction(&self, angle: f64) -> [f64; 2] {
        [self.side.sign() * angle.cos(), self.side.sign() * angle.sin()]
    }

    /// Azimuth and groove angle of a point, rad.
    pub fn coordinates(&self, x: [f64; 3]) -> [f64; 2] {
        let radial = self.side.sign() * (x[0].hypot(x[1]) - self.centre_radius);
        let axial = self.side.sign() * (x[2] - self.centre_z);
        [x[1].atan2(x[0]), axial.atan2(radial)]
    }

    /// Distance from the bearing axis at groove angle `angle`, m.
    pub fn radius(&self, angle: f64) -> f64 {
        self.centre_radius + self.side.sign() * self.groove_radius * angle.cos()
    }

    /// How far a facet lies towards the groove centre because it is a chord in the rolling direction, m, at groove
    /// angle `angle`: half the radius times the shape-function-weighted variance of its nodes' azimuths. The
    /// interpolation error of a circle, h^2/(8 r) in the middle of a flat facet and none on a quadratic one.
    pub fn chord_offset(&self, angle: f64, nodes: impl Iterator<Item = ([f64; 3], f64)> + Clone) -> f64 {
        let azimuths = nodes.map(|(x, weight)| (self.coordinates(x)[0], weight));
        let Some((first, _)) = azimuths.clone().next() else {
            return 0.0;
        };
        let near = azimuths.map(|(azimuth, weight)| (unwrap_near(azimuth, first), weight));
        let mean: f64 = near.clone().map(|(azimuth, weight)| weight * azimuth).sum();
        let variance: f64 = near
            .map(|(azimuth, weight)| weight * (azimuth - mean) * (azimuth - mean))
            .sum();
        0.5 * self.side.sign() * self.radius(angle) * angle.cos() * variance
    }

    /// Groove centre at an azimuth, mesh coordinates, m.
    pub fn centre(&self, azimuth: f64) -> [f64; 3] {
        [
            self.centre_radius * azimuth.cos(),
            self.centre_radius * azimuth.sin(),
            self.centre_z,
        ]
    }
}

/// Where a raceway point lies in the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Location {
    /// Facet number within the raceway group.
    pub facet: usize,
    /// Reference coordinates in that facet.
    pub xi: [f64; 2],
}

/// The facets of one raceway, ready for point search.
pub struct RacewaySurface {
    /// The torus.
    pub groove: Groove,
    /// Facet kind.
    pub kind: FacetKind,
    /// Global nodes of the facets, `[n_facets][kind.n_nodes()]`, flat.
    nodes: Vec<usize>,
    /// (azimuth, groove angle) of these nodes, unwrapped within each facet, same layout.
    coordinates: Vec<[f64; 2]>,
    /// Node spacing [along the groove, rolling direction] at these nodes, m, same layout.
    spacing: Vec<[f64; 2]>,
    /// Lowest and highest (azimuth, groove angle) of each facet, grown, as its nodes are unwrapped.
    boxes: Vec<[[f64; 2]; 2]>,
    /// Inverse of the map of each facet, where it is affine.
    maps: Vec<Option<Affine>>,
    neighbours: Neighbours,
    /// Lowest and highest groove angle, rad.
    pub angle_range: RangeInclusive<f64>,
    bins: Bins,
}

impl RacewaySurface {
    /// Surface of the facets `group` of `mesh` on the torus `groove`. Cost: linear in the facets.
    pub fn new(mesh: &Mesh, group: &[Facet], groove: Groove) -> RacewaySurface {
        let kind = mesh.kind.facet_kind();
        let n = kind.n_nodes();
        let (mut nodes, mut coordinates) = (Vec::new(), Vec::new());
        for &f in group {
            let first = coordinates.len();
            for node in mesh.facet_nodes(f) {
                let mut at = groove.coordinates(mesh.nodes[node]);
                if coordinates.len() > first {
                    at[0] = unwrap_near(at[0], coordinates_first(&coordinates, first));
                }
                nodes.push(node);
                coordinates.push(at);
            }
        }
        let angles = coordinates.iter().map(|c: &[f64; 2]| c[1]);
        let [low, high] = angles.fold([f64::INFINITY, f64::NEG_INFINITY], |r, a| {
            [r[0].min(a), r[1].max(a)]
        });
        let spacing = node_spacing(&nodes, &coordinates, kind, &groove, mesh.n_nodes());
        let boxes: Vec<_> = coordinates.chunks(n).map(grown_box).collect();
        let bins = Bins::new(&boxes, [low, high]);
        let maps = coordinates.chunks(n).map(|c| Affine::new(kind, c)).collect();
        let neighbours = Neighbours::new(kind, &nodes);
        RacewaySurface {
            groove,
            kind,
            nodes,
            coordinates,
            spacing,
            boxes,
            maps,
            neighbours,
            angle_range: low..=high,
            bins,
        }
    }

    /// Distance along the groove from groove angle `angle` to the nearer rim, m; negative beyond it.
    pub fn rim_distance(&self, angle: f64) -> f64 {
        let to_rims = (angle - self.angle_range.start()).min(self.angle_range.end() - angle);
        self.groove.groove_radius * to_rims
    }

    /// Number of facets.
    pub fn n_facets(&self) -> usize {
        self.nodes.len() / self.kind.n_nodes()
    }

    /// Global nodes of a facet.
    pub fn facet_nodes(&self, facet: usize) -> &[usize] {
        let n = self.kind.n_nodes();
        &self.nodes[n * facet..n * (facet + 1)]
    }

    /// Facet and reference coordinates at an azimuth and groove angle, rad.
    pub fn locate(&self, azimuth: f64, angle: f64) -> Result<Location, ContactError> {
        let mut best: Option<(f64, Location)> = None;
        for &facet in self.bins.candidates(azimuth, angle) {
            let Some(xi) = self.reference(facet, azimuth, angle) else {
                continue;
            };
            let outside = outside(self.kind, xi);
            if best.as_ref().is_none_or(|(o, _)| outside < *o) {
                best = Some((outside, Location { facet, xi }));
            }
            if outside <= 0.0 {
                break;
            }
        }
        match best {
            Some((outside, location)) if outside < OUTSIDE_TOLERANCE => Ok(location),
            _ => Err(ContactError::Hole {
                side: self.groove.side.name(),
                azimuth_deg: azimuth.to_degrees(),
                angle_deg: angle.to_degrees(),
            }),
        }
    }

    /// The same, looked for from the facet `near` on across the edges of facets.
    #[inline]
    pub fn locate_near(&self, near: usize, azimuth: f64, angle: f64) -> Result<Location, ContactError> {
        let mut facet = near;
        for _ in 0..MOST_EDGES {
            let Some(xi) = self.reference(facet, azimuth, angle) else {
                break;
            };
            if outside(self.kind, xi) <= 0.0 {
                return Ok(Location { facet, xi });
            }
            match self.neighbours.across(facet, xi) {
                Some(next) => facet = next,
                None => break,
            }
        }
        self.locate(azimuth, angle)
    }

    /// Reference coordinates in a facet; None far from it.
    #[inline(always)]
    fn reference(&self, facet: usize, azimuth: f64, angle: f64) -> Option<[f64; 2]> {
        match &self.maps[facet] {
            Some(map) => Some(map.reference([azimuth, angle])),
            None => self.reference_by_newton(facet, azimuth, angle),
        }
    }

    /// The same of a facet whose map is not affine.
    #[inline(never)]
    fn reference_by_newton(&self, facet: usize, azimuth: f64, angle: f64) -> Option<[f64; 2]> {
        let n = self.kind.n_nodes();
        let coordinates = &self.coordinates[n * facet..n * (facet + 1)];
        let target = [unwrap_near(azimuth, coordinates[0][0]), angle];
        let [low, high] = self.boxes[facet];
        if (0..2).any(|i| target[i] < low[i] || target[i] > high[i]) {
            return None;
        }
        invert(self.kind, coordinates, target)
    }

    /// Growth of the reference coordinates with the azimuth at a point, per rad.
    pub fn azimuth_slope(&self, location: Location) -> [f64; 2] {
        match &self.maps[location.facet] {
            Some(map) => map.azimuth_slope(),
            None => {
                let n = self.kind.n_nodes();
                let coordinates = &self.coordinates[n * location.facet..n * (location.facet + 1)];
                azimuth_slope(self.kind, coordinates, location.xi)
            }
        }
    }

    /// Node spacing [along the groove, rolling direction] at a point, m: continuous over the raceway.
    pub fn spacing(&self, location: Location) -> [f64; 2] {
        let n = self.kind.n_corners();
        let spacing = &self.spacing[self.kind.n_nodes() * location.facet..];
        // Corner values only, so that the interpolation stays between them.
        let shape = facet::shape(corner_kind(self.kind), location.xi);
        match self.kind {
            FacetKind::Tri6 => {
                let barycentric = [
                    1.0 - location.xi[0] - location.xi[1],
                    location.xi[0],
                    location.xi[1],
                ];
                weighted(&barycentric, spacing, n)
            }
            _ => weighted(&shape, spacing, n),
        }
    }
}

fn weighted(weights: &[f64], values: &[[f64; 2]], n: usize) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for i in 0..n {
        sum[0] += weights[i] * values[i][0];
        sum[1] += weights[i] * values[i][1];
    }
    sum
}

fn corner_kind(kind: FacetKind) -> FacetKind {
    match kind {
        FacetKind::Quad4 | FacetKind::Quad8 => FacetKind::Quad4,
        FacetKind::Tri6 => FacetKind::Tri6,
    }
}

fn coordinates_first(coordinates: &[[f64; 2]], first: usize) -> f64 {
    coordinates[first][0]
}

/// Node spacings in the side of a facet. Irregular triangles carry a pressure less well than their three nodes per edge
/// suggest: their whole size counts.
pub fn spacings_in_side(kind: FacetKind) -> f64 {
    match kind {
        FacetKind::Quad4 | FacetKind::Tri6 => 1.0,
        FacetKind::Quad8 => 2.0,
    }
}

/// Spacing of the nodes of every facet, averaged over the facets that share a node.
fn node_spacing(
    nodes: &[usize],
    coordinates: &[[f64; 2]],
    kind: FacetKind,
    groove: &Groove,
    n_nodes: usize,
) -> Vec<[f64; 2]> {
    let n = kind.n_nodes();
    let order = spacings_in_side(kind);
    let mut sums = vec![[0.0; 3]; n_nodes];
    for (facet_nodes, c) in nodes.chunks(n).zip(coordinates.chunks(n)) {
        let range = |i: usize| {
            let values = c.iter().map(|x| x[i]);
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
                (l.min(x), h.max(x))
            });
            (high - low, 0.5 * (high + low))
        };
        let ((along, angle), (around, _)) = (range(1), range(0));
        for &node in facet_nodes {
            sums[node][0] += along * groove.groove_radius / order;
            sums[node][1] += around * groove.radius(angle) / order;
            sums[node][2] += 1.0;
        }
    }
    nodes
        .iter()
        .map(|&i| [sums[i][0] / sums[i][2], sums[i][1] / sums[i][2]])
        .collect()
}
