//! Coefficients of traction over slip.
//!
//! `curve` is Gupta's law mu(s) = (A + B s) exp(-C s) + D (Advanced Dynamics of Rolling Elements, 1984), given by the
//! coefficient at no slip, the largest with its slip, and that at large slip:
//!
//! ```text
//! D = mu_inf,  A = mu_0 - mu_inf,  s_m = 1/C - A/B,  mu_m = (B/C) exp(-1 + C A/B) + D
//! ```
//!
//! With k = C s_m and p = A/(mu_m - D), the last two say p = (1 - k) exp(k) and B = (mu_m - D) C exp(k). p falls from 1
//! at k = 0 through 0 at k = 1 without bound, so k is the one root of a monotone function. A falling branch is no
//! gradient of a convex potential.

use contact::film::FilmContact;

use super::limiting_shear::LimitingShear;

/// Coefficient of traction over slip.
#[derive(Clone, Debug, PartialEq)]
pub enum TractionLaw {
    /// The same at any slip.
    Coulomb(f64),
    /// Gupta's four parameters.
    Curve(Curve),
    /// A table, cubic and monotone between its places.
    Table(SlipTable),
    /// A film that shears.
    LimitingShear(LimitingShear),
}

/// Gupta's law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    a: f64,
    b: f64,
    c: f64,
    d: f64,
}

/// What a curve goes through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoints {
    /// Coefficient without slip.
    pub at_rest: f64,
    /// Largest coefficient.
    pub most: f64,
    /// Its slip, m/s.
    pub slip_of_most: f64,
    /// Coefficient at large slip.
    pub at_large: f64,
}

/// A table of coefficients over slip.
#[derive(Clone, Debug, PartialEq)]
pub struct SlipTable {
    /// Slip, m/s, growing from 0, `[n]`.
    slips: Vec<f64>,
    /// Coefficients, `[n]`.
    coefficients: Vec<f64>,
    /// Their slopes at the places, s/m, `[n]`.
    slopes: Vec<f64>,
}

impl TractionLaw {
    /// Coefficient at a slip of at least 0 m/s, and its slope, s/m; of a film that shears its limit.
    pub fn at(&self, slip: f64) -> [f64; 2] {
        match self {
            TractionLaw::Coulomb(mu) => [*mu, 0.0],
            TractionLaw::Curve(curve) => curve.at(slip),
            TractionLaw::Table(table) => table.at(slip),
            TractionLaw::LimitingShear(film) => [film.limit, 0.0],
        }
    }

    /// The same under a pressure, Pa, in a film, m, for the slip and its regularised size g = sqrt(s^2 + s_v^2), at
    /// which a film shears.
    #[inline]
    pub fn at_place(&self, [slip, g]: [f64; 2], pressure: f64, thickness: f64) -> [f64; 2] {
        let TractionLaw::LimitingShear(film) = self else {
            return self.at(slip);
        };
        let (mu, slope) = film.at(g, pressure, thickness);
        [mu, slope * slip / g]
    }

    /// Film of a contact whose surfaces roll at a speed, m/s, under a force, N; 0 where the law knows none.
    pub fn film(&self, contact: impl FnOnce() -> FilmContact, speed: f64, force: f64) -> f64 {
        match self {
            TractionLaw::LimitingShear(film) => film.film(&contact(), speed, force),
            _ => 0.0,
        }
    }
}

impl Curve {
    /// The curve through these points; needs at_rest and at_large below most, and a positive slip.
    pub fn new(points: CurvePoints) -> Curve {
        let CurvePoints {
            at_rest,
            most,
            slip_of_most,
            at_large,
        } = points;
        let (a, rise) = (at_rest - at_large, most - at_large);
        let share = a / rise;
        let over = |k: f64| (1.0 - k) * k.exp() - share;
        let (mut low, mut high) = (0.0, 1.0);
        while over(high) > 0.0 {
            (low, high) = (high, 2.0 * high);
        }
        // Halvings to the last bit of k.
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if over(middle) > 0.0 {
                low = middle
            } else {
                high = middle
            }
        }
        let k = 0.5 * (low + high);
        let c = k / slip_of_most;
        Curve {
            a,
            b: rise * c * k.exp(),
            c,
            d: at_large,
        }
    }

    fn at(&self, slip: f64) -> [f64; 2] {
        let Curve { a, b, c, d } = *self;
        let (sum, fall) = (a + b * slip, (-c * slip).exp());
        [sum * fall + d, (b - c * sum) * fall]
    }
}

impl SlipTable {
    /// Through these places: at least two, slips growing from 0. Slopes are those of Fritsch and Carlson (SIAM J.
    /// Numer. Anal. 17 (1980) 238), in the form of the harmonic mean: nothing overshoots.
    pub fn new(slips: Vec<f64>, coefficients: Vec<f64>) -> SlipTable {
        let n = slips.len();
        let chord = |i: usize| (coefficients[i + 1] - coefficients[i]) / (slips[i + 1] - slips[i]);
        let slope = |i: usize| {
            if i == 0 {
                return chord(0);
            }
            if i == n - 1 {
                return 0.0;
            }
            let (left, right) = (chord(i - 1), chord(i));
            if left * right <= 0.0 {
                return 0.0;
            }
            let (h0, h1) = (slips[i] - slips[i - 1], slips[i + 1] - slips[i]);
            let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
            (w0 + w1) / (w0 / left + w1 / right)
        };
        SlipTable {
            slopes: (0..n).map(slope).collect(),
            slips,
            coefficients,
        }
    }

    /// Constant beyond the last place.
    fn at(&self, slip: f64) -> [f64; 2] {
        let n = self.slips.len();
        let i = self.slips.partition_point(|s| *s <= slip);
        if i == n {
            return [self.coefficients[n - 1], 0.0];
        }
        let i = i.max(1) - 1;
        let h = self.slips[i + 1] - self.slips[i];
        let x = (slip - self.slips[i]) / h;
        let ([y0, y1], [m0, m1]) = (
            [self.coefficients[i], self.coefficients[i + 1]],
            [h * self.slopes[i], h * self.slopes[i + 1]],
        );
        let (square, cube) = (3.0 * (y1 - y0) - 2.0 * m0 - m1, 2.0 * (y0 - y1) + m0 + m1);
        [
            y0 + x * (m0 + x * (square + x * cube)),
            (m0 + x * (2.0 * square + 3.0 * x * cube)) / h,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: the four numbers that a user gives would not be those of the curve.
    #[test]
    fn a_curve_goes_through_its_points() {
        for (at_rest, at_large) in [(0.0, 0.05), (0.05, 0.03), (0.03, 0.03), (0.07, 0.0)] {
            let (most, slip_of_most) = (0.08, 0.4);
            let law = TractionLaw::Curve(Curve::new(CurvePoints {
                at_rest,
                most,
                slip_of_most,
                at_large,
            }));
            assert!((law.at(0.0)[0] - at_rest).abs() < 1e-14);
            let [mu, slope] = law.at(slip_of_most);
            assert!((mu - most).abs() < 1e-13 && slope.abs() < 1e-12, "{mu} {slope}");
            // What is left of the peak at fifty times its slip is e^-k times that, k above 0.3 here.
            assert!((law.at(200.0 * slip_of_most)[0] - at_large).abs() < 1e-9);
        }
    }

    /// Wrong: a table would overshoot, or Newton would use a wrong slope.
    #[test]
    fn a_table_is_met_at_its_places_and_monotone_between() {
        let (slips, values) = (vec![0.0, 0.1, 0.5, 2.0], vec![0.0, 0.08, 0.07, 0.02]);
        let law = TractionLaw::Table(SlipTable::new(slips.clone(), values.clone()));
        for (s, mu) in slips.iter().zip(&values) {
            assert!((law.at(*s)[0] - mu).abs() < 1e-15);
        }
        for i in 1..2000 {
            let s = 1e-3 * i as f64 + 3e-4;
            let h = 1e-6;
            let numeric = (law.at(s + h)[0] - law.at(s - h)[0]) / (2.0 * h);
            assert!((numeric - law.at(s)[1]).abs() < 1e-6, "{s}");
            let is_rising = s < 0.1;
            assert!(is_rising == (law.at(s)[1] > 0.0), "{s}");
        }
        assert_eq!(law.at(3.0), [0.02, 0.0]);
    }
}
