//! How what carries a ring moves its groove at a ball.

use contact::{Meridian, Side};

use super::raceway_contact::Site;
use crate::model::Model;
use crate::system::{CarriedCircle, Circle};

impl Site {
    /// Motion of the groove centre per unit of each dof of what carries the ring (tilts in rad).
    pub fn carrier_rows(&self) -> [Meridian; 5] {
        let (sin, cos) = self.azimuth.sin_cos();
        [
            [cos, 0.0],
            [sin, 0.0],
            [0.0, 1.0],
            [0.0, self.lever * sin],
            [0.0, -self.lever * cos],
        ]
        .map(Meridian::from)
    }

    /// Growth of the same with the azimuth, 1/rad.
    pub fn carrier_growth(&self) -> [Meridian; 5] {
        let (sin, cos) = self.azimuth.sin_cos();
        [
            [-sin, 0.0],
            [cos, 0.0],
            [0.0, 0.0],
            [0.0, self.lever * cos],
            [0.0, self.lever * sin],
        ]
        .map(Meridian::from)
    }

    /// The circle of groove centres.
    pub fn circle(&self) -> Circle {
        circle(self.azimuth, self.lever, self.is_projected)
    }
}

fn circle(azimuth: f64, radius: f64, is_projected: bool) -> Circle {
    let (sin, cos) = azimuth.sin_cos();
    Circle {
        azimuth: [cos, sin],
        radius,
        is_projected,
    }
}

/// Force of the inner ring on a ball along e_psi, N, where the ball presses it with `on_ring`, N, in the meridian
/// plane, on a shaft at these displacements, m and rad; None where grooves are projected.
pub fn across_on_ball(model: &Model, azimuth: f64, shaft: &[f64; 5], on_ring: Meridian) -> Option<f64> {
    let radius = model.geometry.centre_radius(Side::Inner);
    let across = || circle(azimuth, radius, false).across(CarriedCircle::of(shaft), on_ring.to_array());
    (!model.contact.projects_grooves).then(across)
}
