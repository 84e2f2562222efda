//! A dent: the mark of a hard particle, a round bowl with a raised rim.
//!
//! With r the distance from its middle, measured on the groove, a half its diameter, D its depth, h and b height and
//! width of its rim, what is missing of the smooth groove is
//!
//! ```text
//! D (1 - (r/a)^2)              r <= a          a paraboloid: the cap of a round particle
//! -h sin^2(pi (r - a)/b)       a < r < a + b   highest at a + b/2, level where it ends
//! 0                            beyond
//! ```
//!
//! This is the definition of the shape here. The bowl has the volume pi a^2 D/2, the rim pi h b (a + b/2), so that all
//! that the particle displaced stands in the rim where h = a^2 D/(2 b (a + b/2)).

use std::f64::consts::PI;

use super::track::{Track, turn};

/// A dent; see the formula of this module.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dent {
    /// Azimuth of its middle on the ring, rad.
    pub azimuth: f64,
    /// Groove angle of its middle, rad.
    pub groove_angle: f64,
    /// Diameter of the bowl at the surface, m.
    pub diameter: f64,
    /// Depth of the bowl in its middle, m.
    pub depth: f64,
    /// Height of the rim, m; 0: there is none.
    pub rim_height: f64,
    /// Width of the rim from the bowl's edge outwards, m.
    pub rim_width: f64,
}

/// Pieces of the bowl's radius across the track, between which its height is linear.
const BOWL_PIECES: usize = 24;
/// The same of the rim's width.
const RIM_PIECES: usize = 12;

impl Dent {
    /// Half the diameter of all that differs from the smooth groove, m.
    pub fn reach(&self) -> f64 {
        0.5 * self.diameter
            + if self.rim_height > 0.0 {
                self.rim_width
            } else {
                0.0
            }
    }

    /// What is missing at a distance from the middle, m; negative on the rim.
    pub fn missing_at(&self, distance: f64) -> f64 {
        let radius = 0.5 * self.diameter;
        if distance <= radius {
            self.depth * (1.0 - (distance / radius).powi(2))
        } else if distance < self.reach() {
            -self.rim_height * (PI * (distance - radius) / self.rim_width).sin().powi(2)
        } else {
            0.0
        }
    }

    /// What is missing at an azimuth and a groove angle, rad, in m.
    pub(super) fn missing(&self, track: Track, azimuth: f64, angle: f64) -> f64 {
        let along = turn(azimuth, self.azimuth) * track.radius(angle);
        let across = (angle - self.groove_angle) * track.section_radius();
        self.missing_at(along.hypot(across))
    }

    /// Grid spacing along the track that shows its shape, m.
    pub(super) fn spacing(&self) -> f64 {
        let bowl = 0.5 * self.diameter / BOWL_PIECES as f64;
        if self.rim_height > 0.0 {
            bowl.min(self.rim_width / RIM_PIECES as f64)
        } else {
            bowl
        }
    }

    /// Groove angles of its corners, rad.
    pub(super) fn corners(&self, section_radius: f64) -> impl Iterator<Item = f64> + '_ {
        let radius = 0.5 * self.diameter;
        let part = |from: f64, length: f64, pieces: usize| {
            (0..=pieces).map(move |i| from + length * i as f64 / pieces as f64)
        };
        let bowl = part(0.0, radius, BOWL_PIECES);
        let rim = part(radius, self.reach() - radius, RIM_PIECES);
        let places = bowl.chain(rim).flat_map(|y| [-y, y]);
        places.map(move |y| self.groove_angle + y / section_radius)
    }
}
