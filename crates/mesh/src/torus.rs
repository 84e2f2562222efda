//! The surface of a groove.

/// A raceway groove about the axis z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    /// Radius of the circle of groove centres, m.
    pub centre_radius: f64,
    /// Radius of the groove, m.
    pub groove_radius: f64,
    /// Axial position of the plane of groove centres, m.
    pub centre_z: f64,
}

impl Torus {
    /// Signed distance of `x` (m) from the groove surface, m: positive farther from the groove centre.
    pub fn distance(&self, x: [f64; 3]) -> f64 {
        (x[0].hypot(x[1]) - self.centre_radius).hypot(x[2] - self.centre_z) - self.groove_radius
    }
}
