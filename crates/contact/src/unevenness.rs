//! How far a faceted raceway lies off its torus, along the groove at one azimuth.
//!
//! Sampled at equal groove angles and interpolated by cubic Hermite polynomials with difference slopes, so that Newton
//! sees a continuous derivative.

/// Inward offset of the faceted surface as a function of the groove angle.
#[derive(Clone, Debug, PartialEq)]
pub struct Unevenness {
    low: f64,
    step: f64,
    /// Offsets towards the groove centre, m.
    offsets: Vec<f64>,
}

impl Unevenness {
    /// Offsets (m) at equal steps from groove angle `low` to `high`, rad; at least two.
    pub fn new([low, high]: [f64; 2], offsets: Vec<f64>) -> Unevenness {
        assert!(offsets.len() >= 2, "an unevenness needs two samples");
        Unevenness {
            low,
            step: (high - low) / (offsets.len() - 1) as f64,
            offsets,
        }
    }

    /// Offset, m, and its derivative, m/rad, at a groove angle; constant beyond the ends.
    pub fn at(&self, angle: f64) -> (f64, f64) {
        let last = self.offsets.len() - 1;
        let place = (angle - self.low) / self.step;
        if place <= 0.0 {
            return (self.offsets[0], 0.0);
        }
        if place >= last as f64 {
            return (self.offsets[last], 0.0);
        }
        let i = (place.floor() as usize).min(last - 1);
        let t = place - i as f64;
        let slope = |i: usize| match i {
            0 => self.offsets[1] - self.offsets[0],
            i if i == last => self.offsets[last] - self.offsets[last - 1],
            i => 0.5 * (self.offsets[i + 1] - self.offsets[i - 1]),
        };
        let (a, b, da, db) = (self.offsets[i], self.offsets[i + 1], slope(i), slope(i + 1));
        let c2 = 3.0 * (b - a) - 2.0 * da - db;
        let c3 = da + db - 2.0 * (b - a);
        (
            a + t * (da + t * (c2 + t * c3)),
            (da + t * (2.0 * c2 + 3.0 * t * c3)) / self.step,
        )
    }

    /// The same with all offsets multiplied.
    pub fn scaled(&self, share: f64) -> Unevenness {
        Unevenness {
            offsets: self.offsets.iter().map(|x| share * x).collect(),
            ..*self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: Newton on a faceted groove would use a slope that is not that of its offset.
    #[test]
    fn the_slope_is_the_derivative_and_parabolas_are_exact() {
        let offsets = (0..=20).map(|i| (0.1 * i as f64 - 1.0).powi(2)).collect();
        let groove = Unevenness::new([-1.0, 1.0], offsets);
        for i in 1..100 {
            let angle = -0.9 + 0.018 * i as f64;
            let (value, slope) = groove.at(angle);
            assert!((value - angle * angle).abs() < 1e-14, "{angle}: {value}");
            let numeric = (groove.at(angle + 1e-6).0 - groove.at(angle - 1e-6).0) / 2e-6;
            assert!((slope - numeric).abs() < 1e-9, "{angle}: {slope} {numeric}");
        }
    }
}
