//! How far a contact of strips reaches, and what is missing under it: whether its ellipse is Hertz's.

use crate::strips::{StripLaw, StripLine};

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

impl StripLaw {
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
        let top = (-radius * ramp).clamp(from, to);
        let most = level - ramp * top - 0.5 * top * top / radius;
        (low < high && most > 0.0).then_some(([low, high], most))
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
