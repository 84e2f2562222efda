//! Derived measures of a ring: where its groove is, how large its section is.

use std::f64::consts::TAU;

use super::RingSection;
use crate::error::MeshError;
use crate::section::{Arc, Snap};
use crate::torus::Torus;

/// What follows from the measures of a ring; the groove centres are at z = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingGeometry {
    /// Radius of the circle of groove centres, m.
    pub centre_radius: f64,
    /// Groove radius, m.
    pub groove_radius: f64,
    /// Axial positions of the ends of the groove, m: the first is negative.
    pub groove_z: [f64; 2],
    /// Axial positions of the faces, m: the first is negative.
    pub face_z: [f64; 2],
    /// Angles of the two halves of the groove, seen from its centre, rad.
    pub groove_angles: [f64; 2],
}

impl RingGeometry {
    /// The raceway, for [`crate::check_torus`].
    pub fn torus(&self) -> Torus {
        Torus {
            centre_radius: self.centre_radius,
            groove_radius: self.groove_radius,
            centre_z: 0.0,
        }
    }

    /// The groove circle for the group `raceway`, for [`crate::revolve`].
    pub fn snap(&self) -> Snap {
        let arc = Arc {
            centre_r: self.centre_radius,
            centre_z: 0.0,
            radius: self.groove_radius,
        };
        Snap {
            group: "raceway".to_string(),
            arc,
        }
    }
}

impl RingSection {
    /// Derived measures, after [`RingSection::validate`].
    pub fn geometry(&self) -> Result<RingGeometry, MeshError> {
        self.validate()?;
        Ok(self.geometry_unchecked())
    }

    /// The same; NaN where the measures make no ring.
    pub(crate) fn geometry_unchecked(&self) -> RingGeometry {
        let radius = self.groove_radius;
        let centre_radius = 0.5 * self.raceway_diameter - self.side.sign() * radius;
        let half_width = 0.5 * self.width;
        // Height of each groove end over the circle of groove centres.
        let height = self
            .shoulder_diameters
            .map(|d| self.side.sign() * (0.5 * d - centre_radius));
        let reach = height.map(|h| (radius * radius - h * h).sqrt());
        RingGeometry {
            centre_radius,
            groove_radius: radius,
            groove_z: [-reach[0], reach[1]],
            face_z: [-half_width - self.groove_offset, half_width - self.groove_offset],
            groove_angles: [reach[0].atan2(height[0]), reach[1].atan2(height[1])],
        }
    }

    /// Volume of the ring, m^3, in closed form: 2 pi times the section's first moment about the axis. The groove
    /// halves are circular segments (Pappus; a half of angle t takes R^2/2 (t - sin t cos t) off the section).
    pub fn volume(&self) -> Result<f64, MeshError> {
        let g = self.geometry()?;
        let (sign, seat, radius) = (self.side.sign(), 0.5 * self.seat_diameter, g.groove_radius);
        // Integral of r dr dz between the raceway side and the seat, per length: (seat^2 - r^2)/2.
        let mut moment = 0.0;
        for i in 0..2 {
            let shoulder = 0.5 * self.shoulder_diameters[i];
            let land = g.face_z[i].abs() - g.groove_z[i].abs();
            moment += 0.5 * (seat * seat - shoulder * shoulder) * land;
            // r(z) = c + s sqrt(R^2 - z^2) from 0 to a = R sin t:
            // integral of r^2 = c^2 a + 2 c s R^2/2 (t + sin t cos t) + R^2 a - a^3/3.
            let (t, a, c) = (g.groove_angles[i], g.groove_z[i].abs(), g.centre_radius);
            let squared =
                c * c * a + c * sign * radius * radius * (t + t.sin() * t.cos()) + radius * radius * a
                    - a * a * a / 3.0;
            moment += 0.5 * (seat * seat * a - squared);
        }
        Ok(TAU * sign * moment)
    }
}
