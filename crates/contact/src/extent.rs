//! How far a contact of strips reaches, what is missing under it, and how its load lies across the track.
//!
//! The load across the track is told in parts of the *envelope*: the smooth contact with the same parabola on the
//! highest of what is touched, of half-width A = sqrt(2 R' (d - least w)). No strip has more overlap than there, so
//! strips leave a share of 0 to 1 of each part of it. On a smooth groove the envelope is Hertz's ellipse.

use crate::strips::{GAUSS, StripLaw, StripLine};

/// What a contact of strips touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripExtent {
    /// Where it begins and ends across the track, y of [`crate::strips`], m.
    pub ends: [f64; 2],
    /// Whether the groove ends under it.
    pub is_cut: bool,
    /// Least and most that is missing between its ends, m.
    pub missing: [f64; 2],
    /// Largest overlap, m.
    pub overlap: f64,
}

/// The load of a contact across the track.
#[derive(Clone, Debug, PartialEq)]
pub struct StripLoads {
    /// Half-width A of the envelope, m.
    pub half_width: f64,
    /// What strips leave of each part of it.
    pub parts: Vec<LoadPart>,
}

/// What strips leave of a part of the envelope.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoadPart {
    /// Share of its load.
    pub left: f64,
    /// The middle of the load that is left, from that of the whole part, m.
    pub shift: f64,
    /// Mean overlap under the load that is left, over that of the whole part.
    pub overlap: f64,
    /// Where what is left begins and ends, m.
    pub ends: [f64; 2],
}

/// Integrals of the overlap o, o y and o^2 over y: m^2, m^3, m^3.
type OverlapSums = [f64; 3];

impl StripLaw {
    /// The load of a contact at the Hertz approach `d`, m, and a contact angle, rad, in parts of its envelope between
    /// `cuts`, from -1 to 1. Where strips overlap by less than `least`, m, the ball is taken to be so much nearer.
    pub fn loads(&self, line: &StripLine, (d, least): (f64, f64), angle: f64, cuts: &[f64]) -> StripLoads {
        let corners = self.corners(line, angle);
        let d = d.max(self.first_of(&corners) + least);
        let touched = corners.windows(2).filter_map(|piece| self.touched(piece, d));
        let ends = touched.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], ([low, high], _)| {
            [a.min(low), b.max(high)]
        });
        let deepest = d - missing_between(&corners, ends)[0];
        let half_width = (2.0 * self.parabola_radius * deepest).sqrt();
        let level = [-half_width, half_width].map(|y| [y, d - deepest]);
        let part = |cut: &[f64]| {
            let within = [cut[0] * half_width, cut[1] * half_width];
            let (whole, _) = self.overlap_sums(&level, d, within);
            let (found, ends) = self.overlap_sums(&corners, d, within);
            if found[0] <= 0.0 {
                return LoadPart::default();
            }
            LoadPart {
                left: found[0] / whole[0],
                shift: found[1] / found[0] - whole[1] / whole[0],
                overlap: found[2] / found[0] * whole[0] / whole[2],
                ends,
            }
        };
        StripLoads {
            half_width,
            parts: cuts.windows(2).map(part).collect(),
        }
    }

    /// Hertz approach at which the first strip touches at a contact angle, rad, in m: 0 on a smooth groove, more over
    /// missing material.
    pub fn first_touch(&self, line: &StripLine, angle: f64) -> f64 {
        self.first_of(&self.corners(line, angle))
    }

    fn first_of(&self, corners: &[[f64; 2]]) -> f64 {
        let pieces = corners.windows(2).filter(|piece| piece[0][0] < piece[1][0]);
        let gaps = pieces.map(|piece| -self.deepest(piece, 0.0));
        gaps.fold(f64::INFINITY, f64::min)
    }

    /// Integrals over the strips that touch between two places y, and where these begin and end, m.
    fn overlap_sums(&self, corners: &[[f64; 2]], d: f64, within: [f64; 2]) -> (OverlapSums, [f64; 2]) {
        let (mut sums, mut ends) = ([0.0; 3], [f64::INFINITY, f64::NEG_INFINITY]);
        for piece in corners.windows(2) {
            let Some(([low, high], _)) = self.touched(piece, d) else {
                continue;
            };
            let [low, high] = [low.max(within[0]), high.min(within[1])];
            if low >= high {
                continue;
            }
            ends = [ends[0].min(low), ends[1].max(high)];
            let (half, middle) = (0.5 * (high - low), 0.5 * (high + low));
            for (x, weight) in GAUSS {
                let y = middle + half * x;
                let overlap = (d - at(piece, y) - 0.5 * y * y / self.parabola_radius).max(0.0);
                let share = weight * half * overlap;
                sums = [sums[0] + share, sums[1] + share * y, sums[2] + share * overlap];
            }
        }
        (sums, ends)
    }

    /// The contact at the Hertz approach `d`, m, and a contact angle, rad; None where nothing touches.
    pub fn extent(&self, line: &StripLine, d: f64, angle: f64) -> Option<StripExtent> {
        let corners = self.corners(line, angle);
        let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
        let mut overlap: f64 = 0.0;
        for piece in corners.windows(2) {
            if let Some(([low, high], most)) = self.touched(piece, d) {
                ends = [ends[0].min(low), ends[1].max(high)];
                overlap = overlap.max(most);
            }
        }
        if ends[0] >= ends[1] {
            return None;
        }
        let [first, last] = [corners[0][0], corners[corners.len() - 1][0]];
        Some(StripExtent {
            ends,
            is_cut: ends[0] <= first || ends[1] >= last,
            missing: missing_between(&corners, ends),
            overlap,
        })
    }

    /// Least and most that is missing of a line between two places y, m.
    pub fn missing_within(&self, line: &StripLine, angle: f64, ends: [f64; 2]) -> [f64; 2] {
        missing_between(&self.corners(line, angle), ends)
    }

    /// Places y of the corners of both bodies on the groove and what is missing there, m.
    fn corners(&self, line: &StripLine, angle: f64) -> Vec<[f64; 2]> {
        let y = |beta: &f64| self.groove_radius * (beta - angle);
        let groove: Vec<[f64; 2]> = line
            .angles
            .iter()
            .zip(line.missing)
            .map(|(beta, w)| [y(beta), *w])
            .collect();
        let Some(worn) = &line.worn else { return groove };
        let of_ball = |y: f64| {
            let mu = angle + y / worn.radius;
            let piece = worn.angles.partition_point(|corner| *corner <= mu);
            worn.piece(piece, mu).1
        };
        let [low, high] = [groove[0][0], groove[groove.len() - 1][0]];
        let of_corner = worn.angles.iter().map(|mu| worn.radius * (mu - angle));
        let mut places: Vec<f64> = groove.iter().map(|corner| corner[0]).collect();
        places.extend(of_corner.filter(|y| low < *y && *y < high));
        places.sort_by(f64::total_cmp);
        places
            .into_iter()
            .map(|y| [y, at(&groove, y) + of_ball(y)])
            .collect()
    }

    /// Where the strips of a piece between two corners touch, and their largest overlap, m.
    fn touched(&self, piece: &[[f64; 2]], d: f64) -> Option<([f64; 2], f64)> {
        let ([[from, w], [to, next]], radius) = ([piece[0], piece[1]], self.parabola_radius);
        if to <= from {
            return None;
        }
        let ramp = (next - w) / (to - from);
        // Overlap at y: level - ramp y - y^2 / (2 R').
        let level = d - w + ramp * from;
        let root = (ramp * ramp + 2.0 * level / radius).max(0.0).sqrt();
        let low = from.max(-radius * (ramp + root));
        let high = to.min(-radius * (ramp - root));
        let most = self.deepest(piece, d);
        (low < high && most > 0.0).then_some(([low, high], most))
    }

    /// Largest overlap over a piece between two corners, m; below 0 it is a gap.
    fn deepest(&self, piece: &[[f64; 2]], d: f64) -> f64 {
        let ([[from, w], [to, next]], radius) = ([piece[0], piece[1]], self.parabola_radius);
        let ramp = (next - w) / (to - from);
        let top = (-radius * ramp).clamp(from, to);
        d - w + ramp * from - ramp * top - 0.5 * top * top / radius
    }
}

/// The value at y of a line through corners, whose ends go on.
fn at(corners: &[[f64; 2]], y: f64) -> f64 {
    let next = corners.partition_point(|corner| corner[0] <= y);
    if next == 0 || next == corners.len() {
        return corners[next.min(corners.len() - 1)][1];
    }
    let [[a, low], [b, high]] = [corners[next - 1], corners[next]];
    low + (high - low) * (y - a) / (b - a)
}

fn missing_between(corners: &[[f64; 2]], [low, high]: [f64; 2]) -> [f64; 2] {
    let inside = corners
        .iter()
        .filter(|corner| low < corner[0] && corner[0] < high);
    let values = inside.map(|corner| corner[1]);
    let values = values.chain([at(corners, low), at(corners, high)]);
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], w| {
        [a.min(w), b.max(w)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::worn_line::WornLine;

    fn law() -> StripLaw {
        StripLaw {
            stiffness: 1e10,
            density: 5e10,
            parabola_radius: 0.06,
            groove_radius: 4.75e-3,
        }
    }

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-12
    }

    /// Wrong: an ellipse would be taken for another one than Hertz's, or a cut one for whole. On a smooth groove it is
    /// a = sqrt(2 R' d) wide; a shoulder 0.4 a away ends it there.
    #[test]
    fn a_smooth_contact_is_as_wide_as_hertz_and_ends_at_a_shoulder() {
        let (law, d) = (law(), 8e-6);
        let a = (2.0 * law.parabola_radius * d).sqrt();
        let line = |angles: &'static [f64]| StripLine {
            angles,
            missing: &[0.0, 0.0],
            worn: None,
        };
        let whole = law.extent(&line(&[-1.0, 1.0]), d, 0.3).unwrap();
        assert!(near(whole.ends[0], -a) && near(whole.ends[1], a) && !whole.is_cut);
        assert!(near(whole.overlap, d) && whole.missing == [0.0; 2]);
        let angle = 1.0 - 0.4 * a / law.groove_radius;
        let cut = law.extent(&line(&[-1.0, 1.0]), d, angle).unwrap();
        assert!(
            cut.is_cut && near(cut.ends[0], -a) && near(cut.ends[1], 0.4 * a),
            "{cut:?}"
        );
        assert_eq!(law.extent(&line(&[-1.0, 1.0]), -1e-9, 0.3), None);
    }

    fn cuts(parts: usize) -> Vec<f64> {
        (0..=parts)
            .map(|k| -1.0 + 2.0 * k as f64 / parts as f64)
            .collect()
    }

    /// Share of the envelope's load, 3/4 (1 - Y^2), between two places of it.
    fn hertz_load(low: f64, high: f64) -> f64 {
        let integral = |y: f64| 0.75 * y - 0.25 * y.powi(3);
        integral(high) - integral(low)
    }

    /// Wrong: traction over strips would not be that over Hertz's ellipse where a groove is smooth, or level under it.
    /// Every part keeps all of its load, where it is; to round-off of the integrals.
    #[test]
    fn a_smooth_groove_leaves_every_part_of_the_load() {
        let (law, d) = (law(), 8e-6);
        for level in [0.0, 3e-6, -1e-6] {
            let missing = [level; 5];
            let line = StripLine {
                angles: &[-1.0, 0.25, 0.3, 0.35, 1.0],
                missing: &missing,
                worn: None,
            };
            let found = law.loads(&line, (d, 0.0), 0.3, &cuts(15));
            let expected = (2.0 * law.parabola_radius * (d - level)).sqrt();
            assert!((found.half_width / expected - 1.0).abs() < 1e-13);
            for part in &found.parts {
                assert!(
                    (part.left - 1.0).abs() < 1e-11 && (part.overlap - 1.0).abs() < 1e-11,
                    "{part:?}"
                );
                assert!(part.shift.abs() < 1e-11 * expected, "{part:?}");
            }
        }
    }

    /// Wrong: a shoulder or a spall would leave another load of a part than the integral of 3/4 (1 - Y^2) over what
    /// stands: groove up to Y = 0.37, and a sharp spall over |Y| < 1/2. A part beyond the edge leaves nothing.
    #[test]
    fn an_edge_leaves_the_load_on_its_side() {
        let (law, d) = (law(), 8e-6);
        let a = (2.0 * law.parabola_radius * d).sqrt();
        let beta = |share: f64| 0.3 + share * a / law.groove_radius;
        let shoulder = [-1.0, beta(0.37)];
        let edges = [-0.5 - 1e-9, -0.5, 0.5, 0.5 + 1e-9].map(beta);
        let spall = [-1.0, edges[0], edges[1], edges[2], edges[3], 1.0];
        let cases: [(&[f64], &[f64], [f64; 2]); 2] = [
            (&shoulder, &[0.0, 0.0], [0.37, 2.0]),
            (&spall, &[0.0, 0.0, 1e-3, 1e-3, 0.0, 0.0], [-0.5, 0.5]),
        ];
        for (angles, missing, gone) in cases {
            let line = StripLine {
                angles,
                missing,
                worn: None,
            };
            let cuts = cuts(15);
            let found = law.loads(&line, (d, 0.0), 0.3, &cuts);
            for (part, cut) in found.parts.iter().zip(cuts.windows(2)) {
                let whole = hertz_load(cut[0], cut[1]);
                let [low, high] = gone.map(|y| y.clamp(cut[0], cut[1]));
                let expected = 1.0 - hertz_load(low, high) / whole;
                assert!((part.left - expected).abs() < 1e-7, "{part:?} {expected}");
                let is_inside = part
                    .ends
                    .iter()
                    .all(|y| *y / a <= gone[0] + 1e-7 || *y / a >= gone[1] - 1e-7);
                assert!(part.left == 0.0 || is_inside, "{part:?}");
            }
        }
    }

    /// Wrong: a ball that comes down on the rims of a spall would have traction in the middle of it, or none. Nothing
    /// touches yet; as near as a given overlap the ball stands on both edges.
    #[test]
    fn a_ball_that_does_not_touch_yet_has_the_loads_where_it_will() {
        let law = law();
        let half = 0.4e-3 / law.groove_radius;
        let line = StripLine {
            angles: &[
                -1.0,
                0.3 - half,
                0.3 - half + 1e-9,
                0.3 + half - 1e-9,
                0.3 + half,
                1.0,
            ],
            missing: &[0.0, 0.0, 1e-3, 1e-3, 0.0, 0.0],
            worn: None,
        };
        let found = law.loads(&line, (-1e-6, 1e-9), 0.3, &cuts(15));
        let loaded: Vec<_> = found.parts.iter().filter(|part| part.left > 0.0).collect();
        assert_eq!(loaded.len(), 2);
        for part in loaded {
            assert!(
                part.ends.iter().all(|y| (y.abs() - 0.4e-3).abs() < 1e-6),
                "{part:?}"
            );
        }
    }

    /// Wrong: a scratch in the middle of an ellipse, a mark of the ball, or a floor on which the whole ellipse stands
    /// would be told apart wrongly. A scratch is missing under the ellipse; a wide floor is missing all over.
    #[test]
    fn what_is_missing_is_that_between_the_ends_of_the_contact() {
        let (law, d) = (law(), 8e-6);
        let scratch = StripLine {
            angles: &[-1.0, 0.29, 0.2901, 0.3099, 0.31, 1.0],
            missing: &[0.0, 0.0, 5e-5, 5e-5, 0.0, 0.0],
            worn: None,
        };
        assert_eq!(law.extent(&scratch, d, 0.3).unwrap().missing, [0.0, 5e-5]);
        let floor = StripLine {
            angles: &[-1.0, -0.5, -0.4999, 0.8, 0.8001, 1.0],
            missing: &[0.0, 0.0, 5e-6, 5e-6, 0.0, 0.0],
            worn: None,
        };
        let found = law.extent(&floor, d, 0.3).unwrap();
        assert_eq!(found.missing, [5e-6; 2]);
        assert!(near(found.overlap, 3e-6));
        let worn = StripLine {
            worn: Some(WornLine {
                radius: 4.5e-3,
                angles: &[0.25, 0.29, 0.31, 0.35],
                missing: &[0.0, 4e-6, 4e-6, 0.0],
            }),
            angles: &[-1.0, 1.0],
            missing: &[0.0, 0.0],
        };
        let found = law.extent(&worn, d, 0.3).unwrap().missing;
        assert!(near(found[0], 0.0) && near(found[1], 4e-6), "{found:?}");
    }
}
