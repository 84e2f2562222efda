//! The circle along which ball and raceway touch, on the raceway or on the ball, and angles on it.
//!
//! Both are met at contact angles. On a ball that rolls about an axis square to the contact angle a_0 (see
//! [`super::ball`]) the circle that is touched at the contact angle a has the radius r cos(a - a_0).

use std::f64::consts::{PI, TAU};

use crate::geometry::{BearingGeometry, Side};

/// The sizes on which an envelope depends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Track {
    side: Side,
    centre_radius: f64,
    groove_radius: f64,
    ball_radius: f64,
    /// The contact angle whose circle is the equator of the ball, rad; None: it is the track on the raceway.
    equator: Option<f64>,
}

impl Track {
    /// The track of one side of a bearing.
    pub fn new(geometry: &BearingGeometry, side: Side) -> Track {
        Track {
            side,
            centre_radius: geometry.centre_radius(side),
            groove_radius: geometry.groove_radius(side),
            ball_radius: 0.5 * geometry.ball_diameter,
            equator: None,
        }
    }

    /// The circles on a ball that the raceway of one side meets, on the equator at the contact angle `equator`, rad.
    pub fn on_ball(geometry: &BearingGeometry, side: Side, equator: f64) -> Track {
        Track {
            equator: Some(equator),
            ..Track::new(geometry, side)
        }
    }

    /// Distance from the axis at a contact angle, rad, in m: from that of the bearing, on a ball from that of the ball.
    pub fn radius(&self, angle: f64) -> f64 {
        match self.equator {
            Some(equator) => self.ball_radius * (angle - equator).cos(),
            None => self.raceway_radius(angle),
        }
    }

    fn raceway_radius(&self, angle: f64) -> f64 {
        self.centre_radius + self.side.sign() * self.groove_radius * angle.cos()
    }

    /// Length of the longest circle, m.
    pub fn longest(&self) -> f64 {
        match self.equator {
            Some(_) => TAU * self.ball_radius,
            None => TAU * self.radius(0.0).max(self.radius(0.5 * PI)),
        }
    }

    /// Radius of the surface across the track, m: of the groove, or of the ball.
    pub fn section_radius(&self) -> f64 {
        match self.equator {
            Some(_) => self.ball_radius,
            None => self.groove_radius,
        }
    }

    /// Curvature k_t of the ball relative to the track, 1/m.
    pub fn curvature(&self, angle: f64) -> f64 {
        1.0 / self.ball_radius - self.side.sign() * angle.cos() / self.raceway_radius(angle)
    }
}

/// Angle from one azimuth to another the shorter way, rad.
pub fn turn(azimuth: f64, from: f64) -> f64 {
    (azimuth - from + PI).rem_euclid(TAU) - PI
}
