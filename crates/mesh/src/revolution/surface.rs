//! The surface of a mesh in cylindrical coordinates: its boundary facets, and what half planes cut of them.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::mesh::{Facet, Mesh};

/// A point in cylindrical coordinates: radius, m; axial position, m; azimuth, rad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Cylindrical {
    pub r: f64,
    pub z: f64,
    pub azimuth: f64,
}

impl Cylindrical {
    pub fn of([x, y, z]: [f64; 3]) -> Cylindrical {
        Cylindrical {
            r: x.hypot(y),
            z,
            azimuth: y.atan2(x),
        }
    }

    /// Its place in the half plane (r, z), m.
    pub fn place(&self) -> [f64; 2] {
        [self.r, self.z]
    }

    /// Its azimuth from another one, in [-pi, pi).
    pub fn azimuth_from(&self, azimuth: f64) -> f64 {
        (self.azimuth - azimuth + PI).rem_euclid(TAU) - PI
    }
}

/// Boundary facets and the nodes on them.
pub(super) struct MeshSurface {
    /// Facets that belong to one element, by element and face.
    pub facets: Vec<Facet>,
    /// Corners of the facets, `[n_facets][n_corners]`, flat.
    pub corners: Vec<u32>,
    /// Corners of one facet.
    pub n_corners: usize,
    /// Nodes of the mesh in cylindrical coordinates, `[n_nodes]`.
    pub points: Vec<Cylindrical>,
    /// Corners of the facets, ascending, each once.
    pub nodes: Vec<usize>,
    /// Mid-side nodes of the facets with the two corners beside them, ascending.
    pub middles: Vec<[usize; 3]>,
}

impl MeshSurface {
    pub fn new(mesh: &Mesh) -> MeshSurface {
        let n_corners = mesh.kind.facet_kind().n_corners();
        let facets = boundary(mesh, n_corners);
        let corners: Vec<u32> = facets
            .iter()
            .flat_map(|&facet| mesh.facet_nodes(facet).take(n_corners))
            .map(|node| node as u32)
            .collect();
        let mut is_on = vec![false; mesh.n_nodes()];
        corners.iter().for_each(|&node| is_on[node as usize] = true);
        let mut middles: Vec<[usize; 3]> = Vec::new();
        for &facet in &facets {
            let nodes: Vec<usize> = mesh.facet_nodes(facet).collect();
            let beside = |i: usize| [nodes[n_corners + i], nodes[i], nodes[(i + 1) % n_corners]];
            middles.extend((0..nodes.len() - n_corners).map(beside));
        }
        middles.sort_unstable();
        middles.dedup_by_key(|middle| middle[0]);
        MeshSurface {
            facets,
            corners,
            n_corners,
            points: mesh.nodes.iter().map(|&x| Cylindrical::of(x)).collect(),
            nodes: (0..is_on.len()).filter(|&node| is_on[node]).collect(),
            middles,
        }
    }

    /// Corners of the facets one by one.
    pub fn corners_of_facets(&self) -> std::slice::ChunksExact<'_, u32> {
        self.corners.chunks_exact(self.n_corners)
    }

    /// Closed curves in which the half plane at an azimuth meets the surface: points (r, z), m. Between the nodes of
    /// a facet r and z are linear in the azimuth, so that cylinders, cones and planes are met exactly. None where
    /// facets do not close.
    pub fn cut(&self, azimuth: f64) -> Option<Vec<Vec<[f64; 2]>>> {
        // Each crossing of an edge, with the number of the segment that it ends.
        let mut ends: Vec<([u32; 2], usize, [f64; 2])> = Vec::new();
        for corners in self.corners_of_facets() {
            let from: Vec<f64> = corners
                .iter()
                .map(|&node| self.points[node as usize].azimuth_from(azimuth))
                .collect();
            if from.iter().any(|a| a.abs() > FRAC_PI_2) || from.iter().all(|&a| (a < 0.0) == (from[0] < 0.0))
            {
                continue;
            }
            let first = ends.len();
            for i in 0..corners.len() {
                let j = (i + 1) % corners.len();
                if (from[i] < 0.0) != (from[j] < 0.0) {
                    let [a, b] = [corners[i], corners[j]].map(|node| self.points[node as usize].place());
                    let t = from[i] / (from[i] - from[j]);
                    let place = [0, 1].map(|c| a[c] + t * (b[c] - a[c]));
                    let key = [corners[i].min(corners[j]), corners[i].max(corners[j])];
                    ends.push((key, ends.len() / 2, place));
                }
            }
            debug_assert!((ends.len() - first).is_multiple_of(2));
        }
        closed_curves(&ends)
    }
}

/// Joins segments, whose ends `2 s` and `2 s + 1` are given with the edges on which they lie, to closed curves.
fn closed_curves(ends: &[([u32; 2], usize, [f64; 2])]) -> Option<Vec<Vec<[f64; 2]>>> {
    let mut order: Vec<usize> = (0..ends.len()).collect();
    order.sort_unstable_by_key(|&e| (ends[e].0, e));
    let mut partner = vec![usize::MAX; ends.len()];
    for pair in order.chunks(2) {
        let &[a, b] = pair else { return None };
        if ends[a].0 != ends[b].0 {
            return None;
        }
        (partner[a], partner[b]) = (b, a);
    }
    let mut is_used = vec![false; ends.len()];
    let mut curves = Vec::new();
    for start in 0..ends.len() {
        let (mut curve, mut end) = (Vec::new(), start);
        while !is_used[end] {
            let other = end ^ 1;
            (is_used[end], is_used[other]) = (true, true);
            curve.push(ends[other].2);
            end = partner[other];
        }
        if !curve.is_empty() {
            curves.push(curve);
        }
    }
    Some(curves)
}

/// Facets of one element only, by element and face.
pub(super) fn boundary(mesh: &Mesh, n_corners: usize) -> Vec<Facet> {
    let n_faces = mesh.kind.n_faces();
    let mut faces: Vec<([u32; 4], u32)> = Vec::with_capacity(n_faces * mesh.n_elements());
    for element in 0..mesh.n_elements() {
        let nodes = mesh.element(element);
        for face in 0..n_faces {
            let mut key = [u32::MAX; 4];
            let corners = &mesh.kind.face_nodes(face)[..n_corners];
            key.iter_mut()
                .zip(corners)
                .for_each(|(slot, &corner)| *slot = nodes[corner] as u32);
            key.sort_unstable();
            faces.push((key, (n_faces * element + face) as u32));
        }
    }
    faces.sort_unstable();
    let mut single: Vec<u32> = faces
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|same| same.len() == 1)
        .map(|same| same[0].1)
        .collect();
    single.sort_unstable();
    let facet = |number: u32| Facet {
        element: number as usize / n_faces,
        face: number as usize % n_faces,
    };
    single.into_iter().map(facet).collect()
}
