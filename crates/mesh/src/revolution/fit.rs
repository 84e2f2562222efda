//! Straight lines and arcs through the points of a closed curve, in their order.
//!
//! From a corner on, the longest line or arc is taken that has all points to a tolerance; the next one begins where it
//! ends. An arc needs four points and turns by at most 40 degrees from one to the next: with less, any corner would be
//! one.

use super::outline::{OutlineCurve, OutlinePiece};
use crate::section::Arc;

/// Least points of an arc.
const ARC_POINTS: usize = 4;
/// Largest turn of an arc from point to point, rad.
const ARC_TURN: f64 = 40.0 * std::f64::consts::PI / 180.0;
/// Longest arc, rad: a torus that is nearly closed has no section of a ring.
const LONGEST_ARC: f64 = 1.9 * std::f64::consts::PI;
/// Rounds in which a corner is put on both of its curves.
const ROUNDS: usize = 60;

/// What points lie on.
#[derive(Clone, Copy, Debug)]
enum FittedCurve {
    /// Through a point in a direction of length 1.
    Line {
        through: [f64; 2],
        along: [f64; 2],
    },
    Circle(Arc),
}

impl FittedCurve {
    fn project(&self, p: [f64; 2]) -> [f64; 2] {
        match self {
            FittedCurve::Line { through, along } => {
                let s = (p[0] - through[0]) * along[0] + (p[1] - through[1]) * along[1];
                [through[0] + s * along[0], through[1] + s * along[1]]
            }
            FittedCurve::Circle(arc) => {
                let d = [p[0] - arc.centre_r, p[1] - arc.centre_z];
                let scale = arc.radius / d[0].hypot(d[1]);
                [arc.centre_r + scale * d[0], arc.centre_z + scale * d[1]]
            }
        }
    }

    fn has(&self, points: &[[f64; 2]], tolerance: f64) -> bool {
        points.iter().all(|&p| {
            let q = self.project(p);
            // A circle of points on a line has no finite radius, and has none of them.
            (p[0] - q[0]).hypot(p[1] - q[1]) <= tolerance
        })
    }
}

/// Lines and arcs through the points of a closed curve, (r, z) in m, in their order, each to `tolerance` in m.
pub(super) fn pieces(points: &[[f64; 2]], tolerance: f64) -> Vec<OutlinePiece> {
    let points = distinct(points, 2.0 * tolerance);
    let n = points.len();
    if n < 3 {
        return Vec::new();
    }
    let twice: Vec<[f64; 2]> = points
        .iter()
        .chain(&points)
        .chain(&points[..1])
        .copied()
        .collect();
    // The first piece may begin anywhere; where it ends there is a corner.
    let corner = longest(&twice[..n + 1], tolerance).0 % n;
    let round = &twice[corner..corner + n + 1];
    let (mut shapes, mut starts) = (Vec::new(), Vec::new());
    let mut start = 0;
    while start < n {
        let (length, shape) = longest(&round[start..], tolerance);
        shapes.push(shape);
        starts.push(start);
        start += length;
    }
    let m = shapes.len();
    let corners: Vec<[f64; 2]> = (0..m)
        .map(|i| corner_of(round[starts[i]], shapes[(i + m - 1) % m], shapes[i]))
        .collect();
    let piece = |i: usize| {
        let (start, end) = (corners[i], corners[(i + 1) % m]);
        let last = if i + 1 < m { starts[i + 1] } else { n };
        let curve = match shapes[i] {
            FittedCurve::Line { .. } => OutlineCurve::Line,
            FittedCurve::Circle(circle) => OutlineCurve::Arc {
                circle,
                sweep: turn(&circle, start, round[starts[i]])
                    + sweep(&circle, &round[starts[i]..=last])
                    + turn(&circle, round[last], end),
            },
        };
        OutlinePiece {
            start,
            end,
            curve,
            groups: Vec::new(),
        }
    };
    (0..m).map(piece).collect()
}

/// Points that are farther than `least` from the one before.
fn distinct(points: &[[f64; 2]], least: f64) -> Vec<[f64; 2]> {
    let far = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) > least;
    let mut kept: Vec<[f64; 2]> = Vec::new();
    for &p in points {
        if kept.last().is_none_or(|&last| far(p, last)) {
            kept.push(p);
        }
    }
    while kept.len() > 1 && !far(kept[0], kept[kept.len() - 1]) {
        kept.pop();
    }
    kept
}

/// The longest line or arc from the first point on: steps to its last point, and what it is.
fn longest(points: &[[f64; 2]], tolerance: f64) -> (usize, FittedCurve) {
    let line = farthest(points.len(), 2, |n| line_of(&points[..n], tolerance));
    let (n_line, line) = line.expect("two points are a line");
    match farthest(points.len(), ARC_POINTS, |n| arc_of(&points[..n], tolerance)) {
        Some((n_arc, arc)) if n_arc > n_line => (n_arc - 1, arc),
        _ => (n_line - 1, line),
    }
}

/// The largest number of points, from `least` on, that have a shape; numbers double until they have none.
fn farthest(
    most: usize,
    least: usize,
    shape: impl Fn(usize) -> Option<FittedCurve>,
) -> Option<(usize, FittedCurve)> {
    if most < least {
        return None;
    }
    let mut good = (least, shape(least)?);
    let mut bad = most + 1;
    let mut step = 1;
    while good.0 + 1 < bad {
        let next = (good.0 + step)
            .min(good.0 + (bad - good.0).div_ceil(2))
            .min(bad - 1);
        match shape(next) {
            Some(found) => {
                good = (next, found);
                step *= 2;
            }
            None => {
                bad = next;
                step = 1;
            }
        }
    }
    Some(good)
}

/// The line through points by least squares, if it has them.
fn line_of(points: &[[f64; 2]], tolerance: f64) -> Option<FittedCurve> {
    let (mean, [xx, xy, yy]) = second_moments(points);
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    let (sin, cos) = angle.sin_cos();
    let line = FittedCurve::Line {
        through: mean,
        along: [cos, sin],
    };
    line.has(points, tolerance).then_some(line)
}

/// The circle through points by least squares of |p - c|^2 - R^2 (I. Kasa, IEEE Transactions on Instrumentation and
/// Measurement 25, 1976, 8-14), if it has them and they follow each other closely.
fn arc_of(points: &[[f64; 2]], tolerance: f64) -> Option<FittedCurve> {
    let (mean, [xx, xy, yy]) = second_moments(points);
    let mut rhs = [0.0; 2];
    for p in points {
        let d = [p[0] - mean[0], p[1] - mean[1]];
        let square = d[0] * d[0] + d[1] * d[1];
        (0..2).for_each(|i| rhs[i] += 0.5 * d[i] * square);
    }
    let determinant = xx * yy - xy * xy;
    let centre = [
        (yy * rhs[0] - xy * rhs[1]) / determinant,
        (xx * rhs[1] - xy * rhs[0]) / determinant,
    ];
    let mean_square = (xx + yy) / points.len() as f64;
    let circle = Arc {
        centre_r: mean[0] + centre[0],
        centre_z: mean[1] + centre[1],
        radius: (centre[0] * centre[0] + centre[1] * centre[1] + mean_square).sqrt(),
    };
    let turns: Vec<f64> = points
        .windows(2)
        .map(|pair| turn(&circle, pair[0], pair[1]))
        .collect();
    let goes_one_way = turns
        .iter()
        .all(|t| t.signum() == turns[0].signum() && t.abs() <= ARC_TURN);
    let shape = FittedCurve::Circle(circle);
    let is_arc = goes_one_way && turns.iter().sum::<f64>().abs() <= LONGEST_ARC;
    (is_arc && shape.has(points, tolerance)).then_some(shape)
}

/// Mean of points and the sums of squares and products of what they are off it.
fn second_moments(points: &[[f64; 2]]) -> ([f64; 2], [f64; 3]) {
    let n = points.len() as f64;
    let mean = [0, 1].map(|c| points.iter().map(|p| p[c]).sum::<f64>() / n);
    let mut sums = [0.0; 3];
    for p in points {
        let d = [p[0] - mean[0], p[1] - mean[1]];
        sums[0] += d[0] * d[0];
        sums[1] += d[0] * d[1];
        sums[2] += d[1] * d[1];
    }
    (mean, sums)
}

/// Angle from one point to another seen from the centre of a circle, rad, in (-pi, pi].
fn turn(circle: &Arc, a: [f64; 2], b: [f64; 2]) -> f64 {
    let [u, v] = [a, b].map(|p| [p[0] - circle.centre_r, p[1] - circle.centre_z]);
    (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1])
}

fn sweep(circle: &Arc, points: &[[f64; 2]]) -> f64 {
    points.windows(2).map(|pair| turn(circle, pair[0], pair[1])).sum()
}

/// A corner near `point` on both of its curves; where they touch each other, as near to both as they are.
fn corner_of(point: [f64; 2], before: FittedCurve, after: FittedCurve) -> [f64; 2] {
    (0..ROUNDS).fold(point, |p, _| before.project(after.project(p)))
}
