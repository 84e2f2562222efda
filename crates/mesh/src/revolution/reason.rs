//! Why a ring is no body of revolution about the axis z.

use std::f64::consts::TAU;
use std::fmt;

use super::axis::OwnAxis;
use super::surface::{Cylindrical, MeshSurface};

/// What is off the outline that most of a ring's surface lies on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffOutline {
    /// Index of the node that is farthest off.
    pub node: usize,
    /// Its distance from the outline, m.
    pub distance: f64,
    /// Its azimuth, rad, in [0, 2 pi).
    pub azimuth: f64,
    /// Its place, (r, z), m.
    pub place: [f64; 2],
    /// Nodes that are off, and nodes of the surface.
    pub n_off: usize,
    /// Nodes of the surface.
    pub n_nodes: usize,
    /// Azimuths between which all that is off lies, rad, the second may exceed 2 pi.
    pub between: [f64; 2],
    /// Distance that is allowed, m.
    pub tolerance: f64,
}

/// Why a mesh is no body of revolution about the axis z. Nodes are indices of the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NotRevolved {
    /// A node of the surface lies on the axis: the body is no ring.
    OnAxis {
        /// The node.
        node: usize,
    },
    /// Half planes do not meet its surface in one closed curve.
    Curves {
        /// Azimuth of one such half plane, rad.
        azimuth: f64,
        /// Closed curves there.
        n_curves: usize,
    },
    /// Nodes are off the outline that most of the surface lies on.
    Off(OffOutline),
    /// It is a body of revolution about another axis.
    OtherAxis(OwnAxis),
}

impl OffOutline {
    /// From the distances and nodes that are off, of `n_nodes` that were compared.
    pub(super) fn new(
        surface: &MeshSurface,
        off: &[(f64, usize)],
        n_nodes: usize,
        tolerance: f64,
    ) -> OffOutline {
        let &(distance, node) = off
            .iter()
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .expect("something is off");
        let point = surface.points[node];
        OffOutline {
            node,
            distance,
            azimuth: whole_turn(&point),
            place: point.place(),
            n_off: off.len(),
            n_nodes,
            between: span(
                off.iter()
                    .map(|&(_, node)| whole_turn(&surface.points[node]))
                    .collect(),
            ),
            tolerance,
        }
    }
}

fn whole_turn(point: &Cylindrical) -> f64 {
    point.azimuth.rem_euclid(TAU)
}

/// The shortest arc that has all azimuths in [0, 2 pi).
fn span(mut azimuths: Vec<f64>) -> [f64; 2] {
    azimuths.sort_unstable_by(f64::total_cmp);
    let n = azimuths.len();
    let gap = |i: usize| match i + 1 < n {
        true => azimuths[i + 1] - azimuths[i],
        false => azimuths[0] + TAU - azimuths[i],
    };
    let before = (0..n).max_by(|&a, &b| gap(a).total_cmp(&gap(b))).unwrap_or(0);
    let first = azimuths[(before + 1) % n];
    [first, first + TAU - gap(before)]
}

impl fmt::Display for NotRevolved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NotRevolved::OnAxis { .. } => {
                write!(f, "it reaches the axis z; expected a ring about that axis")
            }
            NotRevolved::Curves { azimuth, n_curves } => write!(
                f,
                "the half plane at azimuth {:.1} deg meets its surface in {n_curves} closed curves, expected one: the \
                 ring has a slit there or a cavity inside",
                azimuth.to_degrees()
            ),
            NotRevolved::Off(off) => write!(
                f,
                "{} of {} nodes of its surface are off the section that the others have, by up to {:.4} mm at azimuth \
                 {:.2} deg, r = {:.4} mm, z = {:.4} mm; they lie between azimuths {:.1} and {:.1} deg; expected at \
                 most {:.2e} mm",
                off.n_off,
                off.n_nodes,
                1e3 * off.distance,
                off.azimuth.to_degrees(),
                1e3 * off.place[0],
                1e3 * off.place[1],
                off.between[0].to_degrees(),
                off.between[1].to_degrees(),
                1e3 * off.tolerance
            ),
            NotRevolved::OtherAxis(axis) => write!(
                f,
                "it is a body of revolution about another axis: that one passes x = {:.6} mm, y = {:.6} mm, \
                 z = {:.6} mm and is tilted by {:.6} deg towards azimuth {:.2} deg; turn and move the mesh so that its \
                 axis is z",
                // Without a minus before zero.
                1e3 * axis.point[0] + 0.0,
                1e3 * axis.point[1] + 0.0,
                1e3 * axis.point[2] + 0.0,
                axis.tilt.to_degrees(),
                axis.azimuth.to_degrees()
            ),
        }
    }
}
