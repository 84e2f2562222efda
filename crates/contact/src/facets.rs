//! Contact on the mesh's own facets, as the paper does it: bounding boxes, interpolated normal, foot point.
//!
//! Global search over boxes that hold a run of facets, local search over the facets of the boxes a ball reaches.
//! The foot point p is where the normal n interpolated from the nodes' normals passes through the ball centre:
//! x_ball + s n(xi) = p(xi). The force goes to the nodes of the facet with its shape functions. Along the groove the
//! facet follows the arc that its node normals imply; in the rolling direction it is a chord, see
//! [`Groove::chord_offset`]. Flat facets across the groove too would be a polygon: with 12 elements 17 um deep, several
//! times a typical approach, steep enough that a preloaded bearing has no stable equilibrium on it (found by trying).
//!
//! Two errors come with facets, and are why they are not the default: the chord error h^2/(8 R) ripples the force, and
//! the local compliance of the mesh is counted on top of Hertz's, which diverges under refinement.

use fem::facet;
use mesh::{Facet, FacetKind, Mesh};

use crate::facet_map::outside;
use crate::raceway::Groove;
use crate::vector::{cross, dot};

/// Reference coordinate beyond which Newton on a facet is given up.
const FAR: f64 = 50.0;
/// How far outside every facet, in reference coordinates, a foot point may lie and still be taken.
const OUTSIDE_LIMIT: f64 = 0.05;

/// Facets per bounding box.
const BOX_SIZE: usize = 16;

/// Raceway facets under bounding boxes.
pub struct FacetSurface {
    /// Facet kind.
    pub kind: FacetKind,
    /// Global nodes, `[n_facets][kind.n_nodes()]`, flat, facets sorted round the axis.
    nodes: Vec<usize>,
    /// Unit normals of all mesh nodes, out of the solid, zero off the raceway.
    normals: Vec<[f64; 3]>,
    boxes: Vec<[[f64; 3]; 2]>,
}

/// The foot point of a ball centre on a raceway.
#[derive(Clone, Debug, PartialEq)]
pub struct FacetContact {
    /// Nodes of the facet.
    pub nodes: Vec<usize>,
    /// Their shape function values at the foot point; sum 1.
    pub weights: Vec<f64>,
    /// Foot point on the deformed facet, m.
    pub foot: [f64; 3],
    /// Interpolated unit normal, from the ball into the ring.
    pub normal: [f64; 3],
    /// Distance from the ball centre to the foot point along the normal, m.
    pub distance: f64,
}

impl FacetSurface {
    /// Surface of the facets `group` of a raceway whose nodes lie on `groove`. Every box holds a fixed number of
    /// facets.
    pub fn new(mesh: &Mesh, group: &[Facet], groove: Groove) -> FacetSurface {
        let kind = mesh.kind.facet_kind();
        let mut facets: Vec<(f64, Facet)> = group.iter().map(|&f| (azimuth_of(mesh, f), f)).collect();
        facets.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let nodes: Vec<usize> = facets.iter().flat_map(|&(_, f)| mesh.facet_nodes(f)).collect();
        let normals = node_normals(mesh, &nodes, &groove);
        let boxes = nodes
            .chunks(BOX_SIZE * kind.n_nodes())
            .map(|run| bounding_box(mesh, run))
            .collect();
        FacetSurface {
            kind,
            nodes,
            normals,
            boxes,
        }
    }

    /// Foot point of the ball centre `centre` (m) within `reach` (m); `position` gives the deformed place of a node, m.
    /// None when no facet
    /// within reach holds it.
    pub fn foot(
        &self,
        centre: [f64; 3],
        reach: f64,
        position: impl Fn(usize) -> [f64; 3],
    ) -> Option<FacetContact> {
        let n = self.kind.n_nodes();
        let mut best: Option<(f64, f64, usize, [f64; 2])> = None;
        for (b, limits) in self.boxes.iter().enumerate() {
            if box_distance(limits, centre) > reach {
                continue;
            }
            let first = b * BOX_SIZE;
            for f in first..(first + BOX_SIZE).min(self.nodes.len() / n) {
                let nodes = &self.nodes[n * f..n * (f + 1)];
                let places: Vec<[f64; 3]> = nodes.iter().map(|&i| position(i)).collect();
                let normals: Vec<[f64; 3]> = nodes.iter().map(|&i| self.normals[i]).collect();
                let Some((distance, xi)) = project(self.kind, &places, &normals, centre) else {
                    continue;
                };
                let outside = outside(self.kind, xi);
                if distance.abs() <= reach && best.is_none_or(|(o, ..)| outside < o) {
                    best = Some((outside, distance, f, xi));
                }
            }
        }
        best.filter(|b| b.0 < OUTSIDE_LIMIT)
            .map(|(_, distance, f, xi)| self.contact(f, xi, distance, position))
    }

    fn contact(
        &self,
        f: usize,
        xi: [f64; 2],
        distance: f64,
        position: impl Fn(usize) -> [f64; 3],
    ) -> FacetContact {
        let n = self.kind.n_nodes();
        let nodes = self.nodes[n * f..n * (f + 1)].to_vec();
        let weights = facet::shape(self.kind, xi)[..n].to_vec();
        let (mut foot, mut normal) = ([0.0; 3], [0.0; 3]);
        for (&node, w) in nodes.iter().zip(&weights) {
            let place = position(node);
            for i in 0..3 {
                foot[i] += w * place[i];
                normal[i] -= w * self.normals[node][i];
            }
        }
        FacetContact {
            nodes,
            weights,
            foot,
            normal: unit(normal),
            distance,
        }
    }
}

fn azimuth_of(mesh: &Mesh, f: Facet) -> f64 {
    let corners = mesh.kind.facet_kind().n_corners();
    let sum = mesh.facet_nodes(f).take(corners).fold([0.0; 2], |s, i| {
        [s[0] + mesh.nodes[i][0], s[1] + mesh.nodes[i][1]]
    });
    sum[1].atan2(sum[0])
}

fn bounding_box(mesh: &Mesh, nodes: &[usize]) -> [[f64; 3]; 2] {
    let mut limits = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for &node in nodes {
        for i in 0..3 {
            limits[0][i] = limits[0][i].min(mesh.nodes[node][i]);
            limits[1][i] = limits[1][i].max(mesh.nodes[node][i]);
        }
    }
    limits
}

fn box_distance(limits: &[[f64; 3]; 2], x: [f64; 3]) -> f64 {
    let mut square = 0.0;
    for i in 0..3 {
        let d = (limits[0][i] - x[i]).max(x[i] - limits[1][i]).max(0.0);
        square += d * d;
    }
    square.sqrt()
}

/// Unit normals out of the solid of the raceway's nodes: those of the torus they lie on.
fn node_normals(mesh: &Mesh, nodes: &[usize], groove: &Groove) -> Vec<[f64; 3]> {
    let mut normals = vec![[0.0; 3]; mesh.n_nodes()];
    for &node in nodes {
        let [azimuth, angle] = groove.coordinates(mesh.nodes[node]);
        let [radial, axial] = groove.direction(angle);
        normals[node] = [-radial * azimuth.cos(), -radial * azimuth.sin(), -axial];
    }
    normals
}

/// Distance from the ball centre and reference coordinates of the foot point on the (extended) facet, by Newton on
/// x_ball + s n(xi) - p(xi) = 0; None when it does not converge.
fn project(
    kind: FacetKind,
    places: &[[f64; 3]],
    normals: &[[f64; 3]],
    centre: [f64; 3],
) -> Option<(f64, [f64; 2])> {
    let mut xi = if kind == FacetKind::Tri6 {
        [1.0 / 3.0; 2]
    } else {
        [0.0; 2]
    };
    let mut s = 0.0;
    // The groove is only a little wider than the ball, so Newton from the middle of a far facet takes some rounds.
    for round in 0..30 {
        let (shape, gradients) = (facet::shape(kind, xi), facet::gradients(kind, xi));
        let (mut gap, mut normal) = (centre, [0.0; 3]);
        let (mut t, mut dn) = ([[0.0; 3]; 2], [[0.0; 3]; 2]);
        for (a, (x, n)) in places.iter().zip(normals).enumerate() {
            for i in 0..3 {
                gap[i] -= shape[a] * x[i];
                normal[i] -= shape[a] * n[i];
                for d in 0..2 {
                    t[d][i] += gradients[a][d] * x[i];
                    dn[d][i] -= gradients[a][d] * n[i];
                }
            }
        }
        if round == 0 {
            s = -dot(gap, normal) / dot(normal, normal);
        }
        let residual = [0, 1, 2].map(|i| gap[i] + s * normal[i]);
        let column = |d: usize| [0, 1, 2].map(|i| s * dn[d][i] - t[d][i]);
        let (c0, c1) = (column(0), column(1));
        let det = dot(c0, cross(c1, normal));
        let step = [
            -dot(residual, cross(c1, normal)) / det,
            -dot(c0, cross(residual, normal)) / det,
            -dot(c0, cross(c1, residual)) / det,
        ];
        if !step.iter().all(|x| x.is_finite()) || xi[0].abs().max(xi[1].abs()) > FAR {
            return None;
        }
        xi = [xi[0] + step[0], xi[1] + step[1]];
        s += step[2];
        // Round-off: positions over the small distance of ball and groove centres give about 1e-12.
        if step[0].abs().max(step[1].abs()) < 1e-10 {
            return Some((s * dot(normal, normal).sqrt(), xi));
        }
    }
    None
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = dot(v, v).sqrt();
    [v[0] / length, v[1] / length, v[2] / length]
}
