//! Points on the facets of a surface of revolution, by azimuth and by z or distance from the axis.

use std::collections::BTreeMap;

use fem::facet;
use mesh::{Facet, FacetKind, Mesh};

/// Rounds of the inversion of a facet's map; it is nearly affine.
const ROUNDS: usize = 25;

/// A point of a facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacetPlace {
    /// The facet.
    pub facet: Facet,
    /// Its reference coordinates there.
    pub xi: [f64; 2],
    /// Position, m.
    pub position: [f64; 3],
    /// Outward unit normal.
    pub normal: [f64; 3],
}

/// Facets of a surface.
pub struct SurfaceFacets<'a> {
    mesh: &'a Mesh,
    facets: Vec<Facet>,
    /// Whether the second coordinate is the distance from the axis, else z.
    pub on_face: bool,
}

/// Whether a facet is square to the axis, more or less.
pub fn is_face(mesh: &Mesh, facet: Facet) -> bool {
    let nodes: Vec<[f64; 3]> = mesh.facet_nodes(facet).map(|n| mesh.nodes[n]).collect();
    let (_, area) = facet::point_and_area(mesh.kind.facet_kind(), &nodes, [0.3, 0.3]);
    area[2].abs() > area[0].hypot(area[1])
}

/// Faces of elements that no other element has and no group holds, such as the floor of what was cut out.
pub fn free_faces(mesh: &Mesh) -> Vec<Facet> {
    let mut seen: BTreeMap<Vec<usize>, Option<Facet>> = BTreeMap::new();
    let nodes = |facet: Facet| {
        let mut nodes: Vec<usize> = mesh.facet_nodes(facet).collect();
        nodes.sort_unstable();
        nodes
    };
    for element in 0..mesh.n_elements() {
        for face in 0..mesh.kind.n_faces() {
            let facet = Facet { element, face };
            seen.entry(nodes(facet))
                .and_modify(|free| *free = None)
                .or_insert(Some(facet));
        }
    }
    for facet in mesh.groups.values().flatten() {
        seen.remove(&nodes(*facet));
    }
    seen.into_values().flatten().collect()
}

impl<'a> SurfaceFacets<'a> {
    /// A surface of these facets.
    pub fn new(mesh: &'a Mesh, facets: Vec<Facet>, on_face: bool) -> SurfaceFacets<'a> {
        SurfaceFacets {
            mesh,
            facets,
            on_face,
        }
    }

    /// Second coordinate of a position: z, or the distance from the axis on a face.
    fn height(&self, [x, y, z]: [f64; 3]) -> f64 {
        if self.on_face { x.hypot(y) } else { z }
    }

    /// The other one of the two.
    pub fn other(&self, [x, y, z]: [f64; 3]) -> f64 {
        if self.on_face { z } else { x.hypot(y) }
    }

    /// Smallest and largest second coordinate, m.
    pub fn range(&self) -> [f64; 2] {
        let nodes = self.facets.iter().flat_map(|&f| self.mesh.facet_nodes(f));
        nodes.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], node| {
            let height = self.height(self.mesh.nodes[node]);
            [low.min(height), high.max(height)]
        })
    }

    /// A second coordinate in words, z from the plane `centre_z`, m.
    pub fn words(&self, height: f64, centre_z: f64) -> String {
        match self.on_face {
            true => format!("r {:.4} mm", 1e3 * height),
            false => format!("z {:.4} mm", 1e3 * (height - centre_z)),
        }
    }

    /// All points at [azimuth, second coordinate], with some play in reference coordinates beyond the facets.
    pub fn all_at(&self, at: [f64; 2], beyond: f64) -> Vec<FacetPlace> {
        let near = |facet: &&Facet| self.may_hold(**facet, at);
        self.facets
            .iter()
            .filter(near)
            .filter_map(|&facet| self.on(facet, at, beyond))
            .collect()
    }

    /// The first point there whose other coordinate is nearest to the one wanted.
    pub fn at(&self, at: [f64; 2], wanted: f64, beyond: f64) -> Option<FacetPlace> {
        let far = |place: &FacetPlace| (self.other(place.position) - wanted).abs();
        self.all_at(at, beyond)
            .into_iter()
            .min_by(|a, b| far(a).total_cmp(&far(b)))
    }

    /// Whether a facet is near enough to be looked at: by its nodes, with its size around them.
    fn may_hold(&self, facet: Facet, [azimuth, height]: [f64; 2]) -> bool {
        let (sin, cos) = azimuth.sin_cos();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let mut ahead = false;
        for node in self.mesh.facet_nodes(facet) {
            let [x, y, _] = self.mesh.nodes[node];
            ahead |= cos * x + sin * y > 0.0;
            let at = [cos * y - sin * x, self.height(self.mesh.nodes[node]) - height];
            for i in 0..2 {
                low[i] = low[i].min(at[i]);
                high[i] = high[i].max(at[i]);
            }
        }
        // A fifth of its size as play: bent facets reach beyond their nodes.
        let play = 0.2 * (high[0] - low[0]).max(high[1] - low[1]);
        ahead && (0..2).all(|i| low[i] <= play && high[i] >= -play)
    }

    /// The point of a facet at [azimuth, second coordinate]; None where it lies beyond.
    fn on(&self, facet: Facet, [azimuth, height]: [f64; 2], beyond: f64) -> Option<FacetPlace> {
        let kind = self.mesh.kind.facet_kind();
        let nodes: Vec<[f64; 3]> = self.mesh.facet_nodes(facet).map(|n| self.mesh.nodes[n]).collect();
        let (sin, cos) = azimuth.sin_cos();
        let mut xi = [0.3, 0.3];
        for _ in 0..ROUNDS {
            let (x, slopes) = position_and_slopes(kind, &nodes, xi);
            let r = x[0].hypot(x[1]);
            // Both in m: arc off the meridian plane, and height.
            let residual = [cos * x[1] - sin * x[0], self.height(x) - height];
            let row = |t: [f64; 3]| {
                let rise = if self.on_face {
                    (x[0] * t[0] + x[1] * t[1]) / r
                } else {
                    t[2]
                };
                [cos * t[1] - sin * t[0], rise]
            };
            let [a, b] = slopes.map(row);
            let det = a[0] * b[1] - a[1] * b[0];
            if det == 0.0 || !det.is_finite() {
                return None;
            }
            let step = [
                (residual[0] * b[1] - residual[1] * b[0]) / det,
                (a[0] * residual[1] - a[1] * residual[0]) / det,
            ];
            xi = [xi[0] - step[0], xi[1] - step[1]];
            if xi.iter().any(|x| x.abs() > 5.0) {
                return None;
            }
            if step[0].abs().max(step[1].abs()) < 1e-14 {
                break;
            }
        }
        if !is_inside(kind, xi, beyond) {
            return None;
        }
        let (position, area) = facet::point_and_area(kind, &nodes, xi);
        let is_ahead = cos * position[0] + sin * position[1] > 0.0;
        let size = area[0].hypot(area[1]).hypot(area[2]);
        is_ahead.then(|| FacetPlace {
            facet,
            xi,
            position,
            normal: area.map(|a| a / size),
        })
    }
}

impl FacetPlace {
    /// Unit tangents: the hoop direction, towards growing azimuth, and the one square to it towards growing z, on a
    /// face growing distance from the axis.
    pub fn tangents(&self) -> [[f64; 3]; 2] {
        let [x, y, _] = self.position;
        let r = x.hypot(y);
        let around = [-y / r, x / r, 0.0];
        let n = self.normal;
        let off: f64 = (0..3).map(|i| around[i] * n[i]).sum();
        let mut hoop = [0, 1, 2].map(|i| around[i] - off * n[i]);
        let size = hoop[0].hypot(hoop[1]).hypot(hoop[2]);
        hoop = hoop.map(|h| h / size);
        let second = [
            n[1] * hoop[2] - n[2] * hoop[1],
            n[2] * hoop[0] - n[0] * hoop[2],
            n[0] * hoop[1] - n[1] * hoop[0],
        ];
        let outwards = if n[2].abs() > n[0].hypot(n[1]) {
            (x * second[0] + y * second[1]) / r
        } else {
            second[2]
        };
        [
            hoop,
            if outwards < 0.0 {
                second.map(|s| -s)
            } else {
                second
            },
        ]
    }
}

fn position_and_slopes(kind: FacetKind, nodes: &[[f64; 3]], xi: [f64; 2]) -> ([f64; 3], [[f64; 3]; 2]) {
    let (shape, gradients) = (facet::shape(kind, xi), facet::gradients(kind, xi));
    let (mut x, mut slopes) = ([0.0; 3], [[0.0; 3]; 2]);
    for (a, node) in nodes.iter().enumerate() {
        for i in 0..3 {
            x[i] += shape[a] * node[i];
            slopes[0][i] += gradients[a][0] * node[i];
            slopes[1][i] += gradients[a][1] * node[i];
        }
    }
    (x, slopes)
}

fn is_inside(kind: FacetKind, [xi, eta]: [f64; 2], beyond: f64) -> bool {
    match kind {
        FacetKind::Quad4 | FacetKind::Quad8 => xi.abs() <= 1.0 + beyond && eta.abs() <= 1.0 + beyond,
        FacetKind::Tri6 => xi >= -beyond && eta >= -beyond && xi + eta <= 1.0 + beyond,
    }
}
