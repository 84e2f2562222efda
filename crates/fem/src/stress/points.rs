//! Stress at any points of a mesh, interpolated.
//!
//! Inside its element a point takes the shape functions' mix of the nodal values: for stress the averages that
//! [`StressRecovery::nodal`] gives, so the result is continuous over the mesh. A point may lie a little outside the
//! elements, because a curved surface is met by facets: then the nearest place of the reference cell counts.

use mesh::{ElementKind, Mesh};

use super::NodeRecovery;
use crate::element::{self, MAX_NODES};
use crate::error::FemError;
use crate::geometry::{coordinates, invert};
use crate::material::Material;

/// How far outside an element, in its reference coordinates (a hexahedron measures 2), a point may lie.
const OUTSIDE: f64 = 0.3;
/// Rounds of the inversion of an element's map; it is nearly affine.
const ROUNDS: usize = 25;

/// Where a point lies in a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshPoint {
    /// Its element.
    pub element: usize,
    /// Its reference coordinates there.
    pub xi: [f64; 3],
}

/// Recovery at chosen points. Cost of a recovery: that of the nodes of their elements.
pub struct PointRecovery {
    nodes: NodeRecovery,
    /// By point: nodes of its element as places in the list of `nodes`, and shape functions.
    terms: Vec<Vec<(usize, f64)>>,
}

impl PointRecovery {
    /// Finds points (m, `[n][3]`) in the mesh and prepares recovery there. Cost: every element is looked at once per
    /// point.
    pub fn new(mesh: &Mesh, material: &Material, points: &[[f64; 3]]) -> Result<PointRecovery, FemError> {
        let boxes: Vec<[[f64; 3]; 2]> = (0..mesh.n_elements()).map(|e| bounds(mesh, e)).collect();
        let places: Vec<MeshPoint> = points
            .iter()
            .map(|&x| locate(mesh, &boxes, x).ok_or(FemError::OutsideMesh { point: x }))
            .collect::<Result<_, _>>()?;
        let around = places.iter().flat_map(|p| mesh.element(p.element));
        let mut chosen: Vec<usize> = around.copied().collect();
        chosen.sort_unstable();
        chosen.dedup();
        let term = |place: &MeshPoint| {
            let shape = element::shape(mesh.kind, place.xi);
            let nodes = mesh.element(place.element).iter().zip(shape);
            nodes
                .map(|(&node, value)| {
                    let own = chosen
                        .binary_search(&node)
                        .expect("the nodes of these elements were chosen");
                    (own, value)
                })
                .collect()
        };
        Ok(PointRecovery {
            nodes: NodeRecovery::new(mesh, material, &chosen)?,
            terms: places.iter().map(term).collect(),
        })
    }

    /// Nodes whose displacements a recovery reads, ascending.
    pub fn nodes(&self) -> &[usize] {
        self.nodes.nodes()
    }

    /// Stress at the points, Pa, `[n][6]`, from displacements of all nodes of the mesh, m, `[3 n_nodes]`.
    pub fn stress(&self, u: &[f64]) -> Vec<[f64; 6]> {
        self.mixed(&self.nodes.stress(u))
    }

    /// Values at the points of what is known at all nodes of the mesh, `[n][6]`.
    pub fn interpolate(&self, nodal: &[[f64; 6]]) -> Vec<[f64; 6]> {
        self.mixed(&self.nodes.pick(nodal))
    }

    /// Mixes of values at the chosen nodes.
    fn mixed(&self, nodal: &[[f64; 6]]) -> Vec<[f64; 6]> {
        let mix = |terms: &Vec<(usize, f64)>| {
            let mut sum = [0.0; 6];
            for &(own, value) in terms {
                for c in 0..6 {
                    sum[c] += value * nodal[own][c];
                }
            }
            sum
        };
        self.terms.iter().map(mix).collect()
    }
}

/// The element that holds a point, or the nearest one within the tolerance.
fn locate(mesh: &Mesh, boxes: &[[[f64; 3]; 2]], x: [f64; 3]) -> Option<MeshPoint> {
    let mut best: Option<(f64, MeshPoint)> = None;
    for (e, [low, high]) in boxes.iter().enumerate() {
        if (0..3).any(|i| x[i] < low[i] || x[i] > high[i]) {
            continue;
        }
        let Some(xi) = invert_map(mesh, e, x) else {
            continue;
        };
        let (inside, far) = nearest_inside(mesh.kind, xi);
        if best.as_ref().is_none_or(|(least, _)| far < *least) {
            best = Some((
                far,
                MeshPoint {
                    element: e,
                    xi: inside,
                },
            ));
        }
        if far == 0.0 {
            break;
        }
    }
    best.filter(|(far, _)| *far <= OUTSIDE).map(|(_, place)| place)
}

/// Box round an element, larger by a fifth: curved sides and points a little outside.
fn bounds(mesh: &Mesh, e: usize) -> [[f64; 3]; 2] {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for &node in mesh.element(e) {
        for i in 0..3 {
            low[i] = low[i].min(mesh.nodes[node][i]);
            high[i] = high[i].max(mesh.nodes[node][i]);
        }
    }
    let size = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
    [low.map(|x| x - 0.2 * size), high.map(|x| x + 0.2 * size)]
}

/// Reference coordinates of a point by Newton; None when it runs away from the element.
fn invert_map(mesh: &Mesh, e: usize, x: [f64; 3]) -> Option<[f64; 3]> {
    let nodes = coordinates(mesh, e);
    let mut xi = match mesh.kind {
        ElementKind::Tet10 => [0.25; 3],
        ElementKind::Hex8 | ElementKind::Hex20 => [0.0; 3],
    };
    for _ in 0..ROUNDS {
        let (shape, gradients) = (element::shape(mesh.kind, xi), element::gradients(mesh.kind, xi));
        let (mut residual, mut jacobian) = (x, [[0.0; 3]; 3]);
        for a in 0..MAX_NODES {
            for i in 0..3 {
                residual[i] -= shape[a] * nodes[a][i];
                for j in 0..3 {
                    jacobian[i][j] += gradients[a][i] * nodes[a][j];
                }
            }
        }
        let map = invert(&jacobian);
        if map.det == 0.0 || !map.det.is_finite() {
            return None;
        }
        let step: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| map.inverse[j][i] * residual[j]).sum());
        let size = step.iter().fold(0.0f64, |s, d| s.max(d.abs()));
        for i in 0..3 {
            xi[i] += step[i];
        }
        if size < 1e-13 {
            return Some(xi);
        }
        if xi.iter().any(|x| x.abs() > 5.0) {
            return None;
        }
    }
    Some(xi)
}

/// The nearest place of the reference cell, and how far away it is.
fn nearest_inside(kind: ElementKind, xi: [f64; 3]) -> ([f64; 3], f64) {
    let inside = match kind {
        ElementKind::Hex8 | ElementKind::Hex20 => xi.map(|x| x.clamp(-1.0, 1.0)),
        ElementKind::Tet10 => {
            let positive = xi.map(|x| x.max(0.0));
            let sum: f64 = positive.iter().sum();
            if sum > 1.0 {
                positive.map(|x| x / sum)
            } else {
                positive
            }
        }
    };
    let far = (0..3).map(|i| (xi[i] - inside[i]).abs()).fold(0.0, f64::max);
    // Round-off on a face is not outside.
    if far < 1e-12 { (inside, 0.0) } else { (inside, far) }
}
