//! How what carries a ring moves its groove at a ball.

use contact::Meridian;

use super::raceway_contact::Site;
use crate::system::Circle;

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
        let (sin, cos) = self.azimuth.sin_cos();
        Circle {
            azimuth: [cos, sin],
            radius: self.lever,
            is_projected: self.is_projected,
        }
    }
}
