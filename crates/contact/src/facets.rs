//! Contact on the mesh's own facets, as the paper does it: bounding boxes, closest point, interpolated normal.
//!
//! Global search over boxes that hold a run of facets, local search over the facets of the boxes a ball reaches.
//! The normal is interpolated from the nodes' normals, the force goes to the nodes of the facet with its shape
//! functions. Two errors come with it, and are why this is not the default: the chord error h^2/(8 R) of flat facets
//! ripples the force, and the local compliance of the mesh is counted on top of Hertz's.

use fem::facet;
use mesh::{Facet, FacetKind, Mesh};

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

/// The closest point of a raceway to a ball centre.
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
    /// Distance from the ball centre to the foot point, m.
    pub distance: f64,
}

impl FacetSurface {
    /// Surface of the facets `group`. Boxes hold [`BOX_SIZE`] facets each.
    pub fn new(mesh: &Mesh, group: &[Facet]) -> FacetSurface {
        let kind = mesh.kind.facet_kind();
        let mut facets: Vec<(f64, Facet)> = group.iter().map(|&f| (azimuth_of(mesh, f), f)).collect();
        facets.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let nodes: Vec<usize> = facets.iter().flat_map(|&(_, f)| mesh.facet_nodes(f)).collect();
        let normals = node_normals(mesh, &nodes, kind);
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

    /// Closest point to `centre` (m) within `reach` (m); `position` gives the deformed place of a node, m.
    /// None when no box comes within reach.
    pub fn closest(
        &self,
        centre: [f64; 3],
        reach: f64,
        position: impl Fn(usize) -> [f64; 3],
    ) -> Option<FacetContact> {
        let n = self.kind.n_nodes();
        let mut best: Option<(f64, usize, [f64; 2])> = None;
        for (b, limits) in self.boxes.iter().enumerate() {
            if box_distance(limits, centre) > reach {
                continue;
            }
            let first = b * BOX_SIZE;
            for f in first..(first + BOX_SIZE).min(self.nodes.len() / n) {
                let places: Vec<[f64; 3]> = self.nodes[n * f..n * (f + 1)]
                    .iter()
                    .map(|&i| position(i))
                    .collect();
                let (distance, xi) = project(self.kind, &places, centre);
                if best.is_none_or(|(d, ..)| distance < d) {
                    best = Some((distance, f, xi));
                }
            }
        }
        best.map(|(distance, f, xi)| self.contact(f, xi, distance, position))
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

/// Node normals: mean of the facets' normals at the node, out of the solid.
fn node_normals(mesh: &Mesh, nodes: &[usize], kind: FacetKind) -> Vec<[f64; 3]> {
    let n = kind.n_nodes();
    let mut sums = vec![[0.0; 3]; mesh.n_nodes()];
    for facet_nodes in nodes.chunks(n) {
        let places: Vec<[f64; 3]> = facet_nodes.iter().map(|&i| mesh.nodes[i]).collect();
        for (a, &node) in facet_nodes.iter().enumerate() {
            let [t1, t2] = tangents(kind, &places, facet::reference_nodes(kind)[a]);
            let normal = unit(cross(t1, t2));
            for i in 0..3 {
                sums[node][i] += normal[i];
            }
        }
    }
    sums.into_iter()
        .map(|v| if v == [0.0; 3] { v } else { unit(v) })
        .collect()
}

fn tangents(kind: FacetKind, places: &[[f64; 3]], xi: [f64; 2]) -> [[f64; 3]; 2] {
    let gradients = facet::gradients(kind, xi);
    let mut t = [[0.0; 3]; 2];
    for (a, x) in places.iter().enumerate() {
        for i in 0..3 {
            t[0][i] += gradients[a][0] * x[i];
            t[1][i] += gradients[a][1] * x[i];
        }
    }
    t
}

/// Distance and reference coordinates of the closest point of one facet: projected Gauss-Newton.
fn project(kind: FacetKind, places: &[[f64; 3]], centre: [f64; 3]) -> (f64, [f64; 2]) {
    let mut xi = if kind == FacetKind::Tri6 {
        [1.0 / 3.0; 2]
    } else {
        [0.0; 2]
    };
    // Facets are nearly flat, so Gauss-Newton contracts fast; points that slide along an edge need a few more.
    for _ in 0..40 {
        let gap = gap(kind, places, xi, centre);
        let [t1, t2] = tangents(kind, places, xi);
        let (a, b, c) = (dot(t1, t1), dot(t1, t2), dot(t2, t2));
        let (r1, r2) = (dot(t1, gap), dot(t2, gap));
        let det = a * c - b * b;
        let step = [(r1 * c - r2 * b) / det, (r2 * a - r1 * b) / det];
        let next = clamp(kind, [xi[0] + step[0], xi[1] + step[1]], [a, b, c]);
        let change = (next[0] - xi[0]).abs().max((next[1] - xi[1]).abs());
        xi = next;
        if change < 1e-14 {
            break;
        }
    }
    let rest = gap(kind, places, xi, centre);
    (dot(rest, rest).sqrt(), xi)
}

fn gap(kind: FacetKind, places: &[[f64; 3]], xi: [f64; 2], centre: [f64; 3]) -> [f64; 3] {
    let shape = facet::shape(kind, xi);
    let mut gap = centre;
    for (a, x) in places.iter().enumerate() {
        for i in 0..3 {
            gap[i] -= shape[a] * x[i];
        }
    }
    gap
}

/// Closest point of the reference facet in the metric [a, b; b, c] of its tangents.
fn clamp(kind: FacetKind, xi: [f64; 2], metric: [f64; 3]) -> [f64; 2] {
    let edges: &[[[f64; 2]; 2]] = match kind {
        FacetKind::Tri6 => &[
            [[0.0, 0.0], [1.0, 0.0]],
            [[1.0, 0.0], [0.0, 1.0]],
            [[0.0, 1.0], [0.0, 0.0]],
        ],
        _ => &[
            [[-1.0, -1.0], [1.0, -1.0]],
            [[1.0, -1.0], [1.0, 1.0]],
            [[1.0, 1.0], [-1.0, 1.0]],
            [[-1.0, 1.0], [-1.0, -1.0]],
        ],
    };
    let inside = match kind {
        FacetKind::Tri6 => xi[0] >= 0.0 && xi[1] >= 0.0 && xi[0] + xi[1] <= 1.0,
        _ => xi[0].abs() <= 1.0 && xi[1].abs() <= 1.0,
    };
    if inside {
        return xi;
    }
    let inner = |u: [f64; 2], v: [f64; 2]| {
        metric[0] * u[0] * v[0] + metric[1] * (u[0] * v[1] + u[1] * v[0]) + metric[2] * u[1] * v[1]
    };
    let on_edge = |[p, q]: [[f64; 2]; 2]| {
        let (along, from) = ([q[0] - p[0], q[1] - p[1]], [xi[0] - p[0], xi[1] - p[1]]);
        let share = (inner(along, from) / inner(along, along)).clamp(0.0, 1.0);
        let point = [p[0] + share * along[0], p[1] + share * along[1]];
        let rest = [xi[0] - point[0], xi[1] - point[1]];
        (inner(rest, rest), point)
    };
    let mut best = on_edge(edges[0]);
    for &edge in &edges[1..] {
        let candidate = on_edge(edge);
        if candidate.0 < best.0 {
            best = candidate;
        }
    }
    best.1
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = dot(v, v).sqrt();
    [v[0] / length, v[1] / length, v[2] / length]
}
