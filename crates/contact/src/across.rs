//! What a contact of a ball yields under the force of the other one, over the difference of their contact angles.
//!
//! The series of [`crate::sphere`] depends on the angle pi - delta between the contacts, delta the inner contact angle
//! less the outer one. It is regular but where both contacts meet, y = 1 - cos delta = 2. A polynomial in y through
//! the series at Chebyshev's points of 0 to 60 deg has its values there to 2e-10 of that at opposite contacts, and that
//! one exactly. Beyond, where no loaded ball comes, it stays smooth.

use crate::law::STIFFEST;

/// Coefficients of the polynomial: an error of 14^-10.
const N_POWERS: usize = 10;
/// y up to which the series is met, at 60 deg.
const FITTED: f64 = 0.5;
/// Steps of y over 0..1, 0 to 90 deg, at which its largest value is sought.
const STEPS: u32 = 16;

/// Compliance x of a contact under the force of the other one, m/N, as a polynomial in y.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AcrossCompliance {
    powers: [f64; N_POWERS],
    stiffest: f64,
}

/// x, m/N, and its first two derivatives with respect to delta.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AcrossGrowth {
    /// x, m/N.
    pub value: f64,
    /// First derivative, m/N.
    pub slope: f64,
    /// Second derivative, m/N.
    pub bend: f64,
}

impl AcrossCompliance {
    /// Of a compliance over the angle between the contacts, rad.
    pub fn new(at_angle: impl Fn(f64) -> f64) -> AcrossCompliance {
        let pi = std::f64::consts::PI;
        let place = |j: usize| 0.5 * FITTED * (1.0 - (pi * (j as f64 + 0.5) / N_POWERS as f64).cos());
        let places: [f64; N_POWERS] = std::array::from_fn(place);
        // Newton's divided differences, then Horner's scheme for the powers.
        let mut differences = places.map(|y| at_angle((y - 1.0).acos()));
        for order in 1..N_POWERS {
            for j in (order..N_POWERS).rev() {
                differences[j] = (differences[j] - differences[j - 1]) / (places[j] - places[j - order]);
            }
        }
        let mut powers = [0.0; N_POWERS];
        for j in (0..N_POWERS).rev() {
            for k in (1..N_POWERS).rev() {
                powers[k] = powers[k - 1] - places[j] * powers[k];
            }
            powers[0] = differences[j] - places[j] * powers[0];
        }
        powers[0] = at_angle(pi);
        let values = (0..=STEPS).map(|i| polynomial(&powers, f64::from(i) / f64::from(STEPS))[0].abs());
        AcrossCompliance {
            powers,
            stiffest: STIFFEST / values.fold(0.0, f64::max),
        }
    }

    /// At opposite contacts, m/N.
    pub fn opposite(&self) -> f64 {
        self.powers[0]
    }

    /// Whether contacts know nothing of each other.
    pub fn is_none(&self) -> bool {
        self.powers == [0.0; N_POWERS]
    }

    /// Tangent of a contact from which its law is a straight line, N/m; see [`crate::BallLaws`].
    pub fn stiffest(&self) -> f64 {
        self.stiffest
    }

    /// At a difference of the contact angles, rad.
    pub fn at(&self, difference: f64) -> AcrossGrowth {
        let (sin, cos) = difference.sin_cos();
        let [value, first, second] = polynomial(&self.powers, height(difference));
        AcrossGrowth {
            value,
            slope: first * sin,
            bend: second * sin * sin + first * cos,
        }
    }

    /// [x(end) - x(start)]/(end - start) of two differences of the contact angles, rad, and its derivative with
    /// respect to `end`, m/N. Divided differences by Horner's scheme lose no digits.
    pub fn between(&self, start: f64, end: f64) -> [f64; 2] {
        let [y0, y1] = [start, end].map(height);
        let middle = (0.5 * (start + end)).sin_cos();
        let [sinc, sinc_slope] = sinc(0.5 * (end - start));
        let rise = middle.0 * sinc;
        let rise_slope = 0.5 * (middle.1 * sinc + middle.0 * sinc_slope);
        let [mut value, mut slope, mut divided, mut divided_slope] = [0.0; 4];
        for power in self.powers.iter().rev() {
            divided_slope = divided_slope * y0 + slope;
            divided = divided * y0 + value;
            slope = slope * y1 + value;
            value = value * y1 + power;
        }
        [
            divided * rise,
            divided_slope * end.sin() * rise + divided * rise_slope,
        ]
    }
}

/// The polynomial and its first two derivatives.
fn polynomial(powers: &[f64; N_POWERS], y: f64) -> [f64; 3] {
    powers.iter().rev().fold([0.0; 3], |[p, first, second], power| {
        [p * y + power, first * y + p, second * y + 2.0 * first]
    })
}

/// y = 1 - cos delta, without the loss of digits of that difference.
fn height(difference: f64) -> f64 {
    2.0 * (0.5 * difference).sin().powi(2)
}

/// sin(x)/x and its derivative.
pub fn sinc(x: f64) -> [f64; 2] {
    if x.abs() < 1e-4 {
        return [1.0 - x * x / 6.0, -x / 3.0];
    }
    [x.sin() / x, (x.cos() - x.sin() / x) / x]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One that is regular but at y = 2, as the series of a ball is.
    fn law() -> AcrossCompliance {
        AcrossCompliance::new(|angle| 3e-10 * (0.5 / (0.5 * angle).sin() - 0.2))
    }

    fn exact(difference: f64) -> f64 {
        3e-10 * (0.5 / (0.5 * difference).cos() - 0.2)
    }

    /// Wrong: the fit, its range, or a constant that is not that of opposite contacts.
    #[test]
    fn the_polynomial_meets_what_it_is_made_of() {
        let law = law();
        assert_eq!(
            law.opposite(),
            3e-10 * (0.5 / (0.5 * std::f64::consts::PI).sin() - 0.2)
        );
        assert_eq!(law.at(0.0).value, law.opposite());
        for i in -60..=60 {
            let angle = f64::from(i).to_radians();
            let error = law.at(angle).value / exact(angle) - 1.0;
            assert!(error.abs() < 1e-9, "{i} deg: {error}");
        }
        assert!(AcrossCompliance::default().is_none() && !law.is_none());
    }

    /// Wrong: a derivative, or a mean that is not the divided difference, so that motion would make energy.
    #[test]
    fn slopes_and_means_are_those_of_the_values() {
        let law = law();
        let value = |angle: f64| law.at(angle).value;
        for angle in [-1.2, -0.3, 0.0, 1e-3, 0.5, 1.5, 2.0] {
            let (h, at) = (1e-4, law.at(angle));
            let first = (value(angle + h) - value(angle - h)) / (2.0 * h);
            let second = (value(angle + h) - 2.0 * at.value + value(angle - h)) / (h * h);
            assert!((first - at.slope).abs() < 1e-17, "{angle}: {first} {at:?}");
            assert!((second - at.bend).abs() < 1e-16, "{angle}: {second} {at:?}");
            for change in [0.0, 1e-9, 1e-3, 0.3, -0.6] {
                let [mean, mean_slope] = law.between(angle, angle + change);
                let difference = value(angle + change) - at.value;
                assert!((mean * change - difference).abs() < 1e-24, "{angle} {change}");
                if change.abs() < 1e-8 {
                    assert!((mean - at.slope).abs() < 1e-17, "{angle} {change}");
                }
                let low = law.between(angle, angle + change - h)[0];
                let growth = (law.between(angle, angle + change + h)[0] - low) / (2.0 * h);
                assert!(
                    (mean_slope - growth).abs() < 1e-16,
                    "{angle} {change}: {growth} {mean_slope}"
                );
            }
        }
    }
}
