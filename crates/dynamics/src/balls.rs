//! What is reported of every ball.

use contact::Side;
use serde::Serialize;

/// One contact of a ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ContactResult {
    /// Normal force, N.
    pub force_n: f64,
    /// Contact angle, rad.
    pub contact_angle_rad: f64,
    /// Hertz approach, m; negative is a gap.
    pub approach_m: f64,
    /// Semi-axes of the Hertz ellipse [along the groove, rolling direction], m.
    pub semi_axes_m: [f64; 2],
    /// Peak Hertz pressure, Pa.
    pub peak_pressure_pa: f64,
}

/// Displacement of a ball from the just-touching position.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BallDisplacement {
    /// Away from the axis, m.
    pub radial: f64,
    /// Along +z, m.
    pub axial: f64,
}

/// One ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BallResult {
    /// Azimuth, rad, from 0 to below 2 pi.
    pub azimuth_rad: f64,
    /// Inner contact.
    pub inner: ContactResult,
    /// Outer contact.
    pub outer: ContactResult,
    /// Displacement.
    pub displacement_m: BallDisplacement,
}

impl BallResult {
    /// The contact with the ring of one side.
    pub fn contact(&self, side: Side) -> &ContactResult {
        match side {
            Side::Inner => &self.inner,
            Side::Outer => &self.outer,
        }
    }
}
