//! The circles of a ring across the axis, in the plane of its groove centres: bore or outside, and raceway.
//!
//! A ring may have turned. With x the places of the nodes of its circles in the mesh, across the axis, and u their
//! displacements, the mean turn is that for which the sum of |x + u - R x|^2 is least,
//!
//! ```text
//! angle = atan2(sum of x cross (x + u), sum of x dot (x + u)),
//! ```
//!
//! in which a translation falls out, because places on full circles have the sum zero. A node is shown at
//! R x + M (x + u - R x), with the magnification M. Free meshes have no circles of nodes.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use checkpoint::{Grid, StepRecord};
use contact::Groove;
use figure::DataPoint;

use super::quantity::MILLIMETRE;
use super::raceways::on_torus;

/// How far a node may lie off its circle, in radii: meshes are exact to rounding in their files.
const ON_CIRCLE: f64 = 1e-5;
/// Largest gap between nodes of a circle, rad: a twelfth of a turn, which a coarse ring keeps.
const LARGEST_GAP: f64 = TAU / 12.0 + 1e-6;

/// A ring across the axis: by circle, each node where it is without strain and how far it is from there, m.
pub struct RingOutline {
    /// Its circles.
    pub circles: Vec<Vec<DisplacedPoint>>,
}

/// A point across the axis.
#[derive(Clone, Copy, Debug)]
pub struct DisplacedPoint {
    /// Where it is, turned but not deformed, m.
    pub from: [f64; 2],
    /// Its displacement from there, m.
    pub by: [f64; 2],
}

impl DisplacedPoint {
    /// Where it is shown with a magnification, mm.
    pub fn shown(&self, magnification: f64) -> [f64; 2] {
        [0, 1].map(|i| MILLIMETRE.factor * (self.from[i] + magnification * self.by[i]))
    }

    /// How far it has moved, m.
    pub fn size(&self) -> f64 {
        self.by[0].hypot(self.by[1])
    }
}

/// The points of a circle, the first at the end again.
pub fn closed(circle: &[DisplacedPoint], magnification: f64) -> Vec<DataPoint> {
    circle
        .iter()
        .chain(circle.first())
        .map(|moved| moved.shown(magnification).into())
        .collect()
}

/// The circles of a ring: its raceway, and its bore or outside; None of a rigid ring, or without circles of nodes.
pub fn outline(grid: &Grid, record: &StepRecord, groove: &Groove) -> Option<RingOutline> {
    let cells = (0..grid.types.len()).filter(|&i| grid.body[i] == groove.side as u8);
    let nodes: BTreeSet<usize> = cells.flat_map(|i| grid.cell(i)).collect();
    let radius = |node: usize| grid.points[node][0].hypot(grid.points[node][1]);
    let away = |node: usize| groove.side.sign() * radius(node);
    let border = nodes
        .iter()
        .map(|&node| away(node))
        .fold(f64::NEG_INFINITY, f64::max);
    let on_border = |node: &usize| (away(*node) - border).abs() < ON_CIRCLE * border.abs();
    let on_raceway = |node: &usize| on_torus(grid.points[*node], groove);
    let chosen = [
        nodes.iter().copied().filter(on_border).collect::<Vec<_>>(),
        nodes.iter().copied().filter(on_raceway).collect(),
    ];
    let circles = chosen
        .into_iter()
        .filter_map(|nodes| circle(grid, &nodes, groove.centre_z));
    let circles: Vec<Vec<[[f64; 2]; 2]>> = circles
        .map(|nodes| nodes.iter().map(|&node| places(grid, record, node)).collect())
        .collect();
    let is_known =
        |circle: &Vec<[[f64; 2]; 2]>| circle.iter().all(|[_, q]| q[0].is_finite() && q[1].is_finite());
    let circles: Vec<_> = circles.into_iter().filter(is_known).collect();
    (!circles.is_empty()).then(|| turned_back(&circles))
}

/// Where a node is in the mesh and where it has moved to, across the axis, m.
pub fn places(grid: &Grid, record: &StepRecord, node: usize) -> [[f64; 2]; 2] {
    let (p, u) = (grid.points[node], record.points.displacement[node]);
    [[p[0], p[1]], [p[0] + u[0], p[1] + u[1]]]
}

/// The nodes of a surface that form the circle nearest to a plane across the axis, in the order of their azimuths.
fn circle(grid: &Grid, nodes: &[usize], z: f64) -> Option<Vec<usize>> {
    let off = |node: usize| (grid.points[node][2] - z).abs();
    let nearest = nodes.iter().copied().min_by(|&a, &b| off(a).total_cmp(&off(b)))?;
    let [x, y, at] = grid.points[nearest];
    let radius = x.hypot(y);
    let is_on = |node: &usize| {
        let [x, y, z] = grid.points[*node];
        (z - at).abs().max((x.hypot(y) - radius).abs()) < ON_CIRCLE * radius
    };
    let azimuth = |node: usize| grid.points[node][1].atan2(grid.points[node][0]);
    let mut found: Vec<usize> = nodes.iter().copied().filter(is_on).collect();
    found.sort_by(|&a, &b| azimuth(a).total_cmp(&azimuth(b)));
    let following = found.iter().cycle().skip(1);
    let gap = |(&a, &b): (&usize, &usize)| (azimuth(b) - azimuth(a)).rem_euclid(TAU);
    let is_full = found.len() > 2 && found.iter().zip(following).map(gap).all(|gap| gap < LARGEST_GAP);
    is_full.then_some(found)
}

/// The circles without the mean turn of their nodes; of each node its place in the mesh and where it has moved to.
fn turned_back(circles: &[Vec<[[f64; 2]; 2]>]) -> RingOutline {
    let (mut cross, mut dot) = (0.0, 0.0);
    for [p, q] in circles.iter().flatten() {
        cross += p[0] * q[1] - p[1] * q[0];
        dot += p[0] * q[0] + p[1] * q[1];
    }
    let (sin, cos) = cross.atan2(dot).sin_cos();
    let moved = |[p, q]: &[[f64; 2]; 2]| {
        let from = [cos * p[0] - sin * p[1], sin * p[0] + cos * p[1]];
        DisplacedPoint {
            from,
            by: [q[0] - from[0], q[1] - from[1]],
        }
    };
    RingOutline {
        circles: circles
            .iter()
            .map(|circle| circle.iter().map(moved).collect())
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: the turn of a ring would be shown as displacement, or what is left of it not be what strained the ring:
    /// it is turned by 0.7 rad, moved by 3 um, and oval by 2 um.
    #[test]
    fn the_turn_is_taken_out_and_the_rest_is_left() {
        let (turn, move_x, oval) = (0.7f64, 3e-6, 2e-6);
        let point = |i: usize| {
            let azimuth = TAU * i as f64 / 24.0;
            let p = [0.03 * azimuth.cos(), 0.03 * azimuth.sin()];
            let now = azimuth + turn;
            let radius = 0.03 + oval * (2.0 * now).cos();
            [p, [radius * now.cos() + move_x, radius * now.sin()]]
        };
        let circle: Vec<[[f64; 2]; 2]> = (0..24).map(point).collect();
        let found = turned_back(std::slice::from_ref(&circle));
        for (i, moved) in found.circles[0].iter().enumerate() {
            let now = TAU * i as f64 / 24.0 + turn;
            let from = [0.03 * now.cos(), 0.03 * now.sin()];
            let radial = oval * (2.0 * now).cos();
            let by = [radial * now.cos() + move_x, radial * now.sin()];
            // Sums over full circles leave round-off alone.
            (0..2).for_each(|k| {
                assert!(
                    (moved.from[k] - from[k]).abs() < 1e-15,
                    "{:?} {from:?}",
                    moved.from
                );
                assert!((moved.by[k] - by[k]).abs() < 1e-15, "{:?} {by:?}", moved.by);
            });
        }
    }

    /// Wrong: a mesh without circles of nodes would be drawn as a zigzag, or nodes of another circle join in.
    #[test]
    fn a_circle_is_full_and_in_one_plane() {
        let ring = |z: f64, n: usize| {
            (0..n).map(move |i| {
                let (sin, cos) = (TAU * i as f64 / 24.0).sin_cos();
                [0.03 * cos, 0.03 * sin, z]
            })
        };
        let points: Vec<[f64; 3]> = ring(1e-3, 24)
            .chain(ring(-2e-3, 24))
            .chain(ring(0.0, 9))
            .collect();
        let grid = Grid {
            points,
            connectivity: Vec::new(),
            offsets: vec![0],
            types: Vec::new(),
            body: Vec::new(),
            radius: Vec::new(),
        };
        let two: Vec<usize> = (0..48).collect();
        let found = circle(&grid, &two, 0.0).unwrap();
        assert!(
            found.len() == 24 && found.iter().all(|&node| node < 24),
            "{found:?}"
        );
        let all: Vec<usize> = (0..57).collect();
        assert_eq!(circle(&grid, &all, 0.0), None, "nine of 24 nodes are no circle");
    }
}
