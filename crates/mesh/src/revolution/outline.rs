//! The outline of a section: straight lines and arcs of circles, end to end.

use std::f64::consts::PI;

use crate::section::Arc;

/// What a piece of an outline follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OutlineCurve {
    /// The straight line between its ends.
    Line,
    /// An arc that turns by `sweep` rad from its start, counter-clockwise if positive, r to the right, z upwards.
    Arc {
        /// The circle.
        circle: Arc,
        /// Angle from start to end, rad.
        sweep: f64,
    },
}

/// One piece of an outline.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlinePiece {
    /// Where it starts, (r, z), m.
    pub start: [f64; 2],
    /// Where it ends and the next one starts, (r, z), m.
    pub end: [f64; 2],
    /// What it follows.
    pub curve: OutlineCurve,
    /// Facet groups that have it, ascending.
    pub groups: Vec<String>,
}

impl OutlinePiece {
    /// Length, m.
    pub fn length(&self) -> f64 {
        match self.curve {
            OutlineCurve::Line => (self.end[0] - self.start[0]).hypot(self.end[1] - self.start[1]),
            OutlineCurve::Arc { circle, sweep } => circle.radius * sweep.abs(),
        }
    }

    /// The point at a share of its length, (r, z), m.
    pub fn at(&self, share: f64) -> [f64; 2] {
        match self.curve {
            OutlineCurve::Line => [0, 1].map(|c| self.start[c] + share * (self.end[c] - self.start[c])),
            OutlineCurve::Arc { circle, sweep } => {
                let angle = angle_about(&circle, self.start) + share * sweep;
                let (sin, cos) = angle.sin_cos();
                [
                    circle.centre_r + circle.radius * cos,
                    circle.centre_z + circle.radius * sin,
                ]
            }
        }
    }

    /// The share of its length that is nearest to a point (r, z), m, and the distance from there, m.
    pub fn nearest(&self, point: [f64; 2]) -> (f64, f64) {
        let share = match self.curve {
            OutlineCurve::Line => {
                let [d, p] = [self.end, point].map(|q| [q[0] - self.start[0], q[1] - self.start[1]]);
                (p[0] * d[0] + p[1] * d[1]) / (d[0] * d[0] + d[1] * d[1])
            }
            OutlineCurve::Arc { circle, sweep } => {
                let from = angle_about(&circle, point) - angle_about(&circle, self.start);
                // Counted from the middle of the arc, so that what is beyond an end is nearest to that end.
                let from_middle = (from - 0.5 * sweep + PI).rem_euclid(2.0 * PI) - PI;
                0.5 + from_middle / sweep
            }
        };
        let share = share.clamp(0.0, 1.0);
        let [r, z] = match share {
            0.0 => self.start,
            1.0 => self.end,
            _ => self.at(share),
        };
        (share, (point[0] - r).hypot(point[1] - z))
    }

    /// The piece from one share of its length to a larger one.
    pub fn part(&self, from: f64, to: f64) -> OutlinePiece {
        let end = |share: f64| match share {
            0.0 => self.start,
            1.0 => self.end,
            _ => self.at(share),
        };
        let curve = match self.curve {
            OutlineCurve::Line => OutlineCurve::Line,
            OutlineCurve::Arc { circle, sweep } => OutlineCurve::Arc {
                circle,
                sweep: (to - from) * sweep,
            },
        };
        OutlinePiece {
            start: end(from),
            end: end(to),
            curve,
            groups: self.groups.clone(),
        }
    }

    /// Integral of r dz and of r^2/2 dz along it, m2 and m3.
    fn moments(&self) -> [f64; 2] {
        // Gauss' rule of five points is exact for lines; arcs are cut until it is to round-off.
        const POINTS: [(f64, f64); 5] = [
            (0.0, 128.0 / 225.0),
            (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
            (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
            (0.906_179_845_938_664, 0.236_926_885_056_189_08),
            (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
        ];
        let n = match self.curve {
            OutlineCurve::Line => 1,
            OutlineCurve::Arc { sweep, .. } => (8.0 * sweep.abs()).ceil() as usize,
        };
        let mut sums = [0.0; 2];
        for i in 0..n {
            for (x, weight) in POINTS {
                let share = (i as f64 + 0.5 * (1.0 + x)) / n as f64;
                let [r, z] = self.at(share);
                let slope = match self.curve {
                    OutlineCurve::Line => self.end[1] - self.start[1],
                    OutlineCurve::Arc { circle, sweep } => (r - circle.centre_r) * sweep,
                };
                let weight = 0.5 * weight / n as f64 * slope;
                debug_assert!(z.is_finite());
                sums[0] += weight * r;
                sums[1] += weight * 0.5 * r * r;
            }
        }
        sums
    }
}

/// Area, m2, positive if the outline turns counter-clockwise, and the volume of its body of revolution, m3 (Pappus).
pub(super) fn area_and_volume(outline: &[OutlinePiece]) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for piece in outline {
        let moments = piece.moments();
        (0..2).for_each(|i| sums[i] += moments[i]);
    }
    [sums[0], 2.0 * PI * sums[1]]
}

/// The nearest piece of an outline: its number, the share of its length, and the distance from it, m.
pub(super) fn nearest(outline: &[OutlinePiece], point: [f64; 2]) -> (usize, f64, f64) {
    let mut best = (0, 0.0, f64::INFINITY);
    for (i, piece) in outline.iter().enumerate() {
        let (share, distance) = piece.nearest(point);
        if distance < best.2 {
            best = (i, share, distance);
        }
    }
    best
}

/// Angle of a point seen from the centre of a circle, rad.
fn angle_about(circle: &Arc, point: [f64; 2]) -> f64 {
    (point[1] - circle.centre_z).atan2(point[0] - circle.centre_r)
}
