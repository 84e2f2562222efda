//! The track of a ball on a raceway, and angles on it.

use std::f64::consts::{PI, TAU};

use crate::geometry::{BearingGeometry, Side};

/// The sizes on which an envelope depends.
#[derive(Clone, Copy, Debug)]
pub struct Track {
    side: Side,
    centre_radius: f64,
    /// Radius of the groove, m.
    pub groove_radius: f64,
    ball_radius: f64,
}

impl Track {
    /// The track of one side of a bearing.
    pub fn new(geometry: &BearingGeometry, side: Side) -> Track {
        Track {
            side,
            centre_radius: geometry.centre_radius(side),
            groove_radius: geometry.groove_radius(side),
            ball_radius: 0.5 * geometry.ball_diameter,
        }
    }

    /// Distance from the axis at a groove angle, rad, in m.
    pub fn radius(&self, angle: f64) -> f64 {
        self.centre_radius + self.side.sign() * self.groove_radius * angle.cos()
    }

    /// Curvature k_t of the ball relative to the track, 1/m.
    pub fn curvature(&self, angle: f64) -> f64 {
        1.0 / self.ball_radius - self.side.sign() * angle.cos() / self.radius(angle)
    }
}

/// Angle from one azimuth to another the shorter way, rad.
pub fn turn(azimuth: f64, from: f64) -> f64 {
    (azimuth - from + PI).rem_euclid(TAU) - PI
}
