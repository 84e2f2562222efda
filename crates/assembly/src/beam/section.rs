//! A stretch of a shaft with one outside diameter and one bore.

use std::f64::consts::PI;

/// A hollow cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamSection {
    /// Its end at lower z, m.
    pub from: f64,
    /// Its end at higher z, m.
    pub to: f64,
    /// Outside diameter, m.
    pub outside: f64,
    /// Diameter of the bore, m; 0 is solid.
    pub bore: f64,
}

impl BeamSection {
    /// Area, m^2.
    pub fn area(&self) -> f64 {
        0.25 * PI * (self.outside.powi(2) - self.bore.powi(2))
    }

    /// Second moment of the area about a diameter, m^4; that about the axis is twice as much.
    pub fn second_moment(&self) -> f64 {
        PI / 64.0 * (self.outside.powi(4) - self.bore.powi(4))
    }

    /// Cowper's shear coefficient of a hollow circle, by which the area counts in shear.
    pub fn shear_coefficient(&self, poisson_ratio: f64) -> f64 {
        let (m, nu) = (self.bore / self.outside, poisson_ratio);
        let square = (1.0 + m * m).powi(2);
        6.0 * (1.0 + nu) * square / ((7.0 + 6.0 * nu) * square + (20.0 + 12.0 * nu) * m * m)
    }
}
