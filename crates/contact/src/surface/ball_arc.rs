//! A ball as a raceway meets it whatever its orientation: the arc of the ball in the meridian plane of the contact.
//!
//! A place of longitude lambda and latitude nu stands at p = (cos nu cos lambda, cos nu sin lambda, -sin nu) in the
//! frame of the ball, (u, -e_psi, a) at the start ([`super::ball`]). The raceway meets at the contact angle mu the
//! place
//!
//! ```text
//! p(mu) = +-[cos(mu) p_r + sin(mu) p_z]      + outer, - inner; p_r, p_z: e_r, e_z in the frame of the ball
//! ```
//!
//! With k the third axis of the ball's frame, sin nu = -p . k = +-rho sin(mu - mu_e), where mu_e is the contact angle
//! that meets the equator and rho <= 1 the length of k's part in the plane. So corners of the grid, which are
//! latitudes, have their contact angles in closed form. Between them w is linear, as it is on the grid; where the
//! longitude changes along the arc, because the axis leans out of the plane, it is taken at points 1 deg apart besides.
//!
//! Validity: envelopes are those along the parallels ([`super::ball`]). Where the track crosses them at an angle chi a
//! mark is as long as along its parallel, and its sag off by a factor of up to 1/cos(chi)^2: 3 % at 10 deg.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::ball::{BallArc, BallSurface};

/// The meridian plane of a contact in the frame of its ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenMeridian {
    /// Direction e_r away from the axis of the ring.
    pub out: [f64; 3],
    /// Direction e_z along it.
    pub axial: [f64; 3],
    /// Contact angle about which the arc is wanted, rad.
    pub angle: f64,
}

/// Distance of the points that are taken besides the corners, rad: 1 deg.
const SPACING: f64 = TAU / 360.0;
/// Points on both sides of the contact angle: farther than any ellipse reaches.
const HALF_POINTS: i32 = 30;
/// Least distance of corners, rad.
const LEAST: f64 = 1e-12;

impl BallSurface {
    /// What is missing along the arc of the ball in a contact's meridian plane.
    pub fn arc(&self, seen: &SeenMeridian) -> BallArc {
        let sign = self.sign();
        let at = |mu: f64| {
            let (sin, cos) = mu.sin_cos();
            [0, 1, 2].map(|i| sign * (cos * seen.out[i] + sin * seen.axial[i]))
        };
        let longitude = |mu: f64| {
            let p = at(mu);
            p[1].atan2(p[0])
        };
        let mut corners: Vec<(f64, f64)> = Vec::new();
        let middle = (seen.angle / SPACING).round();
        for i in -HALF_POINTS..=HALF_POINTS {
            let mu = SPACING * (middle + f64::from(i));
            let latitude = -at(mu)[2].clamp(-1.0, 1.0).asin();
            corners.push((mu, self.missing_of(longitude(mu), latitude)));
        }
        let [of_out, of_axial] = [seen.out[2], seen.axial[2]];
        let length = of_out.hypot(of_axial);
        let (equator, way) = equator_near(of_axial.atan2(of_out), seen.angle);
        for (column, latitude) in self.latitudes().enumerate() {
            let sine = sign * way * latitude.sin() / length;
            if sine.abs() < 1.0 {
                let mu = equator + sine.asin();
                corners.push((mu, self.missing_on(longitude(mu), column)));
            }
        }
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        corners.dedup_by(|b, a| b.0 - a.0 <= LEAST);
        let (angles, missing) = corners.into_iter().unzip();
        BallArc { angles, missing }
    }
}

/// The contact angle next to `angle` that meets the equator, where the ball's axis has the direction `axis` in the
/// plane, rad; and whether latitudes grow (1) or fall (-1) with the contact angle there, outside.
fn equator_near(axis: f64, angle: f64) -> (f64, f64) {
    let from = |way: f64| {
        let off = axis + way * FRAC_PI_2 - angle;
        off - TAU * (off / TAU).round()
    };
    let (rising, falling) = (from(1.0), from(-1.0));
    if rising.abs() <= falling.abs() {
        (angle + rising, 1.0)
    } else {
        (angle + falling, -1.0)
    }
}

#[cfg(test)]
mod tests;
