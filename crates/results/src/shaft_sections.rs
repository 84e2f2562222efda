//! The line of a shaft that is an elastic body: the motion of each of its sections.
//!
//! A section is the nodes of the body at one place along the axis, or in a slice where the mesh has no such planes. Its
//! motion is the rigid one nearest to that of its nodes by least squares, [`ring::support::mean_motion`]. So a rigid
//! motion of the body is exact, and a deformation of the section itself is left out.

use assembly::MountedBearing;
use dynamics::stiffness::N_SHAFT;
use mesh::Mesh;
use ring::sparse::{SparseLoad, sparse_dot};
use ring::support::mean_motion;

use crate::bodies::{ShownBody, bodies_of};
use crate::seat::ON_SHAFT;

/// Most planes of nodes that are each a section.
const MOST_PLANES: usize = 100;
/// Slices of a body whose nodes lie in no planes, or in more.
const SLICES: usize = 40;
/// Distance of planes over the length of the body below which they are one.
const SAME_PLANE: f64 = 1e-6;
/// Least width of a section over its size: the nodes of a narrower one do not say how it turns.
const WIDTH: f64 = 1e-3;

/// A section of a body on the shaft.
pub struct ShaftSection {
    /// Place along the shaft, m.
    pub position: f64,
    /// Motion x, y, z, tilt x, tilt y by dofs of the body, in the frame of its bearing.
    motion: [SparseLoad; N_SHAFT],
}

/// The body on the shaft that a bearing shows.
pub struct ShaftBodyLine {
    /// Number of the bearing.
    pub bearing: usize,
    /// Its sections, ascending in the frame of the body.
    pub sections: Vec<ShaftSection>,
}

impl ShaftBodyLine {
    /// The body on the shaft that a bearing shows, if it shows one.
    pub fn of(bearings: &[MountedBearing], number: usize) -> Option<ShaftBodyLine> {
        let mounted = &bearings[number];
        let bodies = bodies_of(&mounted.model);
        let body = bodies.into_iter().find(|body| body.side == ON_SHAFT)?;
        let section = |nodes: Vec<usize>| section(mounted, &body, nodes);
        Some(ShaftBodyLine {
            bearing: number,
            sections: slices(body.mesh).into_iter().filter_map(section).collect(),
        })
    }

    /// Places of the sections and their displacements in the frame of the shaft under a displacement of the body,
    /// `[n_nodes][3]` flat.
    pub fn at(&self, bearings: &[MountedBearing], body: &[f64]) -> Vec<(f64, [f64; N_SHAFT])> {
        let orientation = bearings[self.bearing].place.orientation;
        let at = |section: &ShaftSection| {
            let motion = section.motion.each_ref().map(|row| sparse_dot(row, body));
            (section.position, orientation.turned(motion))
        };
        self.sections.iter().map(at).collect()
    }
}

/// A section of these nodes; None where they do not make one.
fn section(mounted: &MountedBearing, body: &ShownBody<'_>, nodes: Vec<usize>) -> Option<ShaftSection> {
    let (z, motion) = motion_of(body.mesh, nodes)?;
    let origin = mounted.model.geometry.groove_centre(ON_SHAFT).axial;
    let from_bearing = [0.0, 0.0, z + body.shift[2] - origin];
    let place = &mounted.place;
    Some(ShaftSection {
        position: place.position + place.orientation.turned_vector(from_bearing)[2],
        motion,
    })
}

/// Mean place of some nodes along z, m, and the motion of the axis there by dofs; None where they do not say how they
/// turn.
fn motion_of(mesh: &Mesh, nodes: Vec<usize>) -> Option<(f64, [SparseLoad; N_SHAFT])> {
    if !is_wide(mesh, &nodes) {
        return None;
    }
    let z = nodes.iter().map(|&i| mesh.nodes[i][2]).sum::<f64>() / nodes.len() as f64;
    let weights = nodes.into_iter().map(|i| (i, 1.0)).collect();
    let [x, y, along, tilt_x, tilt_y, _] = mean_motion(mesh, weights, z);
    Some((z, [x, y, along, tilt_x, tilt_y]))
}

/// Whether some nodes spread in all directions across the axis.
fn is_wide(mesh: &Mesh, nodes: &[usize]) -> bool {
    let places = nodes.iter().map(|&i| mesh.nodes[i]);
    let n = nodes.len() as f64;
    let [x, y] = [0, 1].map(|c| places.clone().map(|p| p[c]).sum::<f64>() / n);
    let moment = |a: usize, b: usize| {
        let arm = |p: &[f64; 3]| [p[0] - x, p[1] - y];
        places.clone().map(|p| arm(&p)[a] * arm(&p)[b]).sum::<f64>()
    };
    let (xx, yy, xy) = (moment(0, 0), moment(1, 1), moment(0, 1));
    let (middle, half) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
    middle - half > WIDTH * WIDTH * (middle + half)
}

/// Nodes of a mesh by planes across the axis, or by slices, ascending.
fn slices(mesh: &Mesh) -> Vec<Vec<usize>> {
    let z = |i: usize| mesh.nodes[i][2];
    let mut order: Vec<usize> = (0..mesh.nodes.len()).collect();
    order.sort_by(|&a, &b| z(a).total_cmp(&z(b)).then(a.cmp(&b)));
    let (Some(&first), Some(&last)) = (order.first(), order.last()) else {
        return Vec::new();
    };
    let (low, length) = (z(first), z(last) - z(first));
    let in_plane = |a: &usize, b: &usize| z(*b) - z(*a) <= SAME_PLANE * length;
    let planes: Vec<Vec<usize>> = order.chunk_by(in_plane).map(<[usize]>::to_vec).collect();
    if planes.len() <= MOST_PLANES && planes.iter().all(|plane| is_wide(mesh, plane)) {
        return planes;
    }
    let number = |i: usize| ((SLICES as f64 * (z(i) - low) / length) as usize).min(SLICES - 1);
    let in_slice = |a: &usize, b: &usize| number(*a) == number(*b);
    order.chunk_by(in_slice).map(<[usize]>::to_vec).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use mesh::ElementKind;

    use super::*;

    const LENGTH: f64 = 0.2;

    /// Nodes of a tube at some heights, `lean` of them moved along z so that they lie in no plane.
    fn tube(heights: usize, lean: f64) -> Mesh {
        let mut nodes = Vec::new();
        for k in 0..heights {
            for i in 0..12 {
                for r in [0.02, 0.025] {
                    let azimuth = std::f64::consts::TAU * i as f64 / 12.0;
                    let z =
                        LENGTH * k as f64 / (heights - 1) as f64 + lean * (3.0 * azimuth + k as f64).sin();
                    nodes.push([r * azimuth.cos(), r * azimuth.sin(), z]);
                }
            }
        }
        Mesh {
            kind: ElementKind::Hex8,
            nodes: nodes.into(),
            connectivity: Vec::new(),
            groups: BTreeMap::new(),
        }
    }

    /// Places and motions of all sections under a displacement of the nodes.
    fn found(mesh: &Mesh, displacement: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<(f64, [f64; N_SHAFT])> {
        let field: Vec<f64> = mesh.nodes.iter().flat_map(|&x| displacement(x)).collect();
        let sections = slices(mesh)
            .into_iter()
            .filter_map(|nodes| motion_of(mesh, nodes));
        let at = |(z, rows): (f64, [SparseLoad; N_SHAFT])| (z, rows.map(|row| sparse_dot(&row, &field)));
        sections.map(at).collect()
    }

    #[track_caller]
    fn assert_near(found: &[f64], expected: &[f64], tolerance: f64) {
        let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < tolerance, "{found:?} {expected:?}");
    }

    /// Wrong: a shaft that moves as a rigid piece would be drawn bent, wherever its nodes lie.
    #[test]
    fn a_rigid_motion_is_a_straight_line() {
        let [ux, uy, uz, rx, ry, rz] = [0.3, -0.2, 0.1, 0.5, 0.7, -0.4];
        let rigid = |[x, y, z]: [f64; 3]| [ux + ry * z - rz * y, uy + rz * x - rx * z, uz + rx * y - ry * x];
        for (heights, lean) in [(11, 0.0), (300, 1e-3)] {
            let line = found(&tube(heights, lean), rigid);
            assert_eq!(line.len(), if lean == 0.0 { 11 } else { SLICES });
            for (z, motion) in line {
                assert_near(&motion, &[ux + ry * z, uy - rx * z, uz, rx, ry], 1e-12);
            }
        }
    }

    /// Wrong: a bent shaft would be drawn with another line or other tilts. Pure bending in two planes in closed form,
    /// plane sections: exact in planes of nodes; in slices the curve within a slice is averaged, of (0.2 m / 40)^2.
    #[test]
    fn pure_bending_is_a_parabola() {
        let [k, m] = [2.0, -0.6];
        let bent = |[x, y, z]: [f64; 3]| [0.5 * k * z * z, 0.5 * m * z * z, -(k * x + m * y) * z];
        for (heights, lean, tolerance) in [(11, 0.0, 1e-12), (300, 1e-3, 3e-5)] {
            for (z, motion) in found(&tube(heights, lean), bent) {
                let expected = [0.5 * k * z * z, 0.5 * m * z * z, 0.0, -m * z, k * z];
                assert_near(&motion[..2], &expected[..2], tolerance);
                assert_near(&motion[2..], &expected[2..], 100.0 * tolerance);
            }
        }
    }

    /// Wrong: a row of nodes along the axis would be taken for a section, and its turn be a division by zero.
    #[test]
    fn nodes_in_a_row_are_no_section() {
        let mesh = Mesh {
            nodes: vec![[0.02, 0.0, 0.0], [0.03, 0.0, 0.0], [0.04, 1e-9, 0.0]].into(),
            ..tube(2, 0.0)
        };
        assert!(motion_of(&mesh, vec![0, 1, 2]).is_none() && motion_of(&mesh, vec![0]).is_none());
        assert!(motion_of(&tube(2, 0.0), (0..24).collect()).is_some());
    }
}
