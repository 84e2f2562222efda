//! Contact of a ball and a raceway by strips across the track: truncated at the shoulders, over spalls and waves.
//!
//! The Hertz ellipse is cut into strips along the track. A strip at y across the track carries a load per length in
//! proportion to its own overlap:
//!
//! ```text
//! o(y) = max(0, d - y^2 / (2 R') - w(y)),   Q = int c o dy,   U = int c o^2 / 2 dy
//! R' = a^2 / (2 d),   c = 3 Q_H / (4 a d)        # of Hertz's ellipse, both independent of the load
//! ```
//!
//! d is the Hertz approach, w >= 0 what is missing of the smooth groove, m. On a smooth groove Q = (4/3) c sqrt(2 R')
//! d^1.5, which is Hertz's K d^1.5 exactly, and the load per length 3 Q / (4 a) (1 - (y/a)^2) is that of Hertz's
//! pressure. Of a groove that ends at y = tau a, 1/2 + 3/4 tau - tau^3/4 of the force is left.
//!
//! Strips belong to the groove: y = R_g (beta - alpha), beta the groove angle of a strip and alpha the contact angle.
//! So U depends on alpha too; dU/dalpha over |l| is a force across the contact normal. w is linear in beta between
//! *corners*, so that all integrals are exact: force and tangents are the derivatives of the energy to round-off.
//!
//! A ball that is no sphere misses w_b at an angle mu of its own, the contact angle at which that place is touched: the
//! strip at y meets it at mu = alpha + y / r, r the radius of the ball. Strips still belong to the groove, so that mu
//! moves by 1 - R_g / r per unit of alpha, and dU/dalpha has a part of w_b's slope.
//!
//! What the patch of a finite-element ring and the ball yield besides, c_s + c_b, is taken out as in [`crate::law`]:
//! g = d - (c_s + c_b) Q, V = U - (c_s + c_b) Q^2 / 2, so that dV/dg = Q and dV/dalpha = dU/dalpha. From the load on at
//! which a smooth groove's law reaches [`MIN_SLOPE`], what is taken out stays the same: such a state is not valid.
//!
//! Validity: strips do not feel each other, so that the stress concentration at an edge is not in it.
//! Cost: a few dozen operations per piece between corners, times the two to five iterations of Newton where a
//! compliance is taken out.

use crate::hertz::HertzContact;
use crate::law::MIN_SLOPE;
use crate::worn_line::WornLine;

/// Gauss points on -1..1 and weights: exact for o^2, of degree four.
pub(crate) const GAUSS: [(f64, f64); 3] = [
    (-0.774_596_669_241_483_4, 5.0 / 9.0),
    (0.0, 8.0 / 9.0),
    (0.774_596_669_241_483_4, 5.0 / 9.0),
];
/// Iterations for the approach on a smooth groove, from which that over strips starts.
const GUESSES: usize = 3;
/// Iterations for the approach after which it stays as it is.
const MOST_ITERATIONS: usize = 80;

/// Strips of Hertz's ellipse on a groove.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripLaw {
    /// Two-body Hertz stiffness K, N/m^1.5.
    pub stiffness: f64,
    /// Load per length and overlap c, N/m^2.
    pub density: f64,
    /// Radius of the overlap's parabola across the track R', m.
    pub parabola_radius: f64,
    /// Groove radius R_g, m.
    pub groove_radius: f64,
}

impl StripLaw {
    /// Strips with the ellipse and the stiffness of a Hertz contact.
    pub fn new(hertz: &HertzContact, groove_radius: f64) -> StripLaw {
        let axis = hertz.semi_axes(1.0).groove;
        let power = hertz.stiffness.powf(2.0 / 3.0);
        StripLaw {
            stiffness: hertz.stiffness,
            density: 0.75 * power / axis,
            parabola_radius: 0.5 * axis * axis * power,
            groove_radius,
        }
    }
}

/// What is missing of a groove along one line across the track: linear between corners, no groove beyond them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripLine<'l> {
    /// Groove angles of the corners, rad, rising, at least two.
    pub angles: &'l [f64],
    /// Missing material w at them, m; negative is a bump.
    pub missing: &'l [f64],
    /// What is missing of the ball; None: it is a sphere.
    pub worn: Option<WornLine<'l>>,
}

/// A contact by strips at a geometric approach and a contact angle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StripForce {
    /// Normal force Q = dV/dg, N.
    pub force: f64,
    /// Moment across dV/dalpha, N m/rad; over |l| it is the force across the normal.
    pub moment: f64,
    /// Second derivatives of V over (g, alpha): N/m, N/rad, N m/rad^2.
    pub tangent: [[f64; 2]; 2],
    /// Energy V, J.
    pub energy: f64,
    /// Hertz approach d, m; over missing material it is larger than any overlap.
    pub approach: f64,
    /// The patch is smaller than the load needs.
    pub beyond_limit: bool,
}

/// Integrals over the strips at an approach d and a contact angle.
#[derive(Clone, Copy, Debug, Default)]
struct Integrals {
    energy: f64,
    force: f64,
    moment: f64,
    /// d2U over (d, d), (d, alpha), (alpha, alpha).
    growth: [f64; 3],
}

impl StripLaw {
    /// The contact at the geometric approach `g`, m, and the contact angle `angle`, rad, where bodies yield besides
    /// by `compliance`, m/N.
    pub fn evaluate(&self, line: StripLine, compliance: f64, g: f64, angle: f64) -> StripForce {
        let most = self.most_force(compliance);
        let (d, at) = self.approach(line, (compliance, most), g, angle);
        if at.force <= 0.0 {
            return StripForce {
                approach: d,
                ..StripForce::default()
            };
        }
        let (taken, slope) = if at.force < most {
            (at.force, 1.0 - compliance * at.growth[0])
        } else {
            (most, 1.0)
        };
        let yields = if at.force < most { compliance } else { 0.0 };
        let slope_used = slope.max(MIN_SLOPE);
        let [dd, da, aa] = at.growth;
        StripForce {
            force: at.force,
            moment: at.moment,
            tangent: [
                [dd / slope_used, da / slope_used],
                [da / slope_used, aa + yields * da * da / slope_used],
            ],
            energy: at.energy
                - if compliance > 0.0 {
                    0.5 * compliance * taken * taken
                } else {
                    0.0
                },
            approach: d,
            beyond_limit: at.force >= most || slope < MIN_SLOPE,
        }
    }

    /// Geometric approach, m, at which a smooth groove has the force `force`, N.
    pub fn smooth_approach(&self, compliance: f64, force: f64) -> f64 {
        (force / self.stiffness).powf(2.0 / 3.0) - compliance * force
    }

    /// Half-width across the track of a smooth contact with the force `force`, N, in m.
    pub fn half_width(&self, force: f64) -> f64 {
        (2.0 * self.parabola_radius).sqrt() * (force / self.stiffness).cbrt()
    }

    /// Force from which on what is taken out stays the same, N.
    fn most_force(&self, compliance: f64) -> f64 {
        if compliance > 0.0 {
            let root = (1.0 - MIN_SLOPE) / (1.5 * compliance * self.stiffness);
            self.stiffness * root.powi(3)
        } else {
            f64::INFINITY
        }
    }

    /// Approach d of d - compliance min(Q, most) = g, and the strips there: Newton, kept between bounds.
    fn approach(
        &self,
        line: StripLine,
        (compliance, most): (f64, f64),
        g: f64,
        angle: f64,
    ) -> (f64, Integrals) {
        let mut at = self.integrals(line, g, angle);
        if compliance == 0.0 || at.force == 0.0 {
            return (g, at);
        }
        let (mut low, mut high) = (g, g + compliance * most);
        let mut d = self.smooth_guess(compliance, g).clamp(low, high);
        at = self.integrals(line, d, angle);
        for _ in 0..MOST_ITERATIONS {
            let (taken, slope) = if at.force < most {
                (at.force, 1.0 - compliance * at.growth[0])
            } else {
                (most, 1.0)
            };
            let residual = d - compliance * taken - g;
            if residual < 0.0 {
                low = d;
            } else {
                high = d;
            }
            let newton = d - residual / slope;
            let next = if slope > 0.0 && low <= newton && newton <= high {
                newton
            } else {
                0.5 * (low + high)
            };
            let is_still = (next - d).abs() <= 2.0 * f64::EPSILON * d.abs();
            d = next;
            at = self.integrals(line, d, angle);
            if is_still {
                break;
            }
        }
        (d, at)
    }

    /// About the approach d of d - compliance K d^1.5 = g on a smooth groove: strips that lack little are near it.
    fn smooth_guess(&self, compliance: f64, g: f64) -> f64 {
        // Where only a bump touches there is nothing to go on from.
        if g <= 0.0 {
            return g;
        }
        let mut d = g;
        for _ in 0..GUESSES {
            let grows = compliance * self.stiffness * d.sqrt();
            d -= (d - grows * d - g) / (1.0 - 1.5 * grows).max(MIN_SLOPE);
        }
        d
    }

    fn integrals(&self, line: StripLine, d: f64, angle: f64) -> Integrals {
        let mut sum = match line.worn {
            Some(worn) => self.sums_under(line, &worn, d, angle),
            None => self.sums(line, d, angle),
        };
        sum.energy *= self.density;
        sum.force *= self.density;
        sum.moment *= self.density;
        sum.growth = sum.growth.map(|x| x * self.density);
        sum
    }

    fn sums(&self, line: StripLine, d: f64, angle: f64) -> Integrals {
        let mut sum = Integrals::default();
        let mut first = 0;
        while first + 1 < line.angles.len() {
            let mut last = first + 1;
            // Level pieces are one piece.
            let level = line.missing[first];
            while last + 1 < line.angles.len() && [last, last + 1].iter().all(|&k| line.missing[k] == level) {
                last += 1;
            }
            let ends = [first, last];
            first = last;
            let missing = ends.map(|corner| line.missing[corner]);
            if d > missing[0].min(missing[1]) {
                let y = ends.map(|corner| self.groove_radius * (line.angles[corner] - angle));
                self.add_piece((y, missing), d, 0.0, &mut sum);
            }
        }
        sum
    }

    /// The same under a ball that is no sphere: pieces end at the corners of both.
    fn sums_under(&self, line: StripLine, worn: &WornLine, d: f64, angle: f64) -> Integrals {
        let mut sum = Integrals::default();
        // How far mu stays behind the strip, per unit of alpha.
        let behind = self.groove_radius / worn.radius - 1.0;
        let corner = |k: usize| worn.radius * (worn.angles[k] - angle);
        for k in 1..line.angles.len() {
            let [low, high] = [k - 1, k].map(|k| self.groove_radius * (line.angles[k] - angle));
            let ramp = (line.missing[k] - line.missing[k - 1]) / (high - low);
            let of_groove = |y: f64| line.missing[k - 1] + ramp * (y - low);
            let mut piece = worn
                .angles
                .partition_point(|mu| worn.radius * (mu - angle) <= low);
            let mut from = low;
            loop {
                let is_last = piece == worn.angles.len() || corner(piece) >= high;
                let to = if is_last { high } else { corner(piece) };
                let slope = worn.piece(piece, angle).0;
                let at = |y: f64| of_groove(y) + worn.piece(piece, angle + y / worn.radius).1;
                let missing = [at(from), at(to)];
                if to > from && d > missing[0].min(missing[1]) {
                    self.add_piece(([from, to], missing), d, behind * slope, &mut sum);
                }
                if is_last {
                    break;
                }
                // The slope of w_b jumps at its corners, and these move along the groove.
                let overlap = (d - missing[1] - 0.5 * to * to / self.parabola_radius).max(0.0);
                let jump = worn.piece(piece + 1, angle).0 - slope;
                sum.growth[2] -= behind * behind * worn.radius * jump * overlap;
                (from, piece) = (to, piece + 1);
            }
        }
        sum
    }

    /// Adds the strips between two places y with what is missing there, where they overlap; with the contact angle the
    /// overlap grows by `more` besides what the groove does, m/rad.
    fn add_piece(&self, (y, missing): ([f64; 2], [f64; 2]), d: f64, more: f64, sum: &mut Integrals) {
        let radius = self.parabola_radius;
        let ramp = (missing[1] - missing[0]) / (y[1] - y[0]);
        // Overlap at y: level - ramp y - y^2 / (2 R').
        let level = d - missing[0] + ramp * y[0];
        let discriminant = ramp * ramp + 2.0 * level / radius;
        if discriminant <= 0.0 {
            return;
        }
        let root = discriminant.sqrt();
        let low = y[0].max(-radius * (ramp + root));
        let high = y[1].min(-radius * (ramp - root));
        if low >= high {
            return;
        }
        let (half, middle) = (0.5 * (high - low), 0.5 * (high + low));
        let lever = self.groove_radius / radius;
        for (x, weight) in GAUSS {
            let y = middle + half * x;
            let overlap = (level - ramp * y - 0.5 * y * y / radius).max(0.0);
            let share = weight * half;
            let turn = lever * y + more;
            sum.energy += share * 0.5 * overlap * overlap;
            sum.force += share * overlap;
            sum.moment += share * overlap * turn;
            sum.growth[0] += share;
            sum.growth[1] += share * turn;
            sum.growth[2] += share * (turn * turn - overlap * lever * self.groove_radius);
        }
    }
}
