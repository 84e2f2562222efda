//! The surface of a ball as both raceways meet it, and how a ball with kinematic motion turns.
//!
//! **Angles.** A ball that rolls about an axis of its own has an equator about this axis. The axis is square to the
//! normal of contacts at the angle a_0 at which the ball rolls, so that these contacts run on the equator. With e_r,
//! e_psi and e_z at the ball, an inner ring that turns by + about z rolls it by the angle phi about
//!
//! ```text
//! a = sin(a_0) e_r - cos(a_0) e_z                           axis; it leaves the ball at the latitude -90 deg
//! u = cos(a_0) e_r + sin(a_0) e_z                           where the outer raceway touches
//! p(lambda, nu) = cos(nu) [cos(lambda + phi) u - sin(lambda + phi) e_psi] - sin(nu) a
//! ```
//!
//! A point of longitude lambda and latitude nu stands at p. So the outer contact, at the contact angle a_o, meets the
//! longitude -phi and the latitude a_o - a_0; the inner one the longitude pi - phi and the latitude a_0 - a_i.
//! Longitude 0 faces the outer raceway at the start, the latitude 90 deg faces inwards and along +z.
//!
//! **Envelope.** Along its parallels a ball is filtered by the raceway as a raceway is by the ball ([`super`]), with
//! the same curvature k_t: the gap of both bodies is their difference, and that does not ask which of them a mark is
//! on.
//!
//! Validity: where a mark of the ball meets one of the raceway, what is missing adds up after both envelopes.

use std::f64::consts::PI;

use super::grid::SurfaceGrid;
use super::track::Track;
use super::{Dent, Heights, Profiles, Spall};
use crate::geometry::{BearingGeometry, Side};
use crate::worn_line::WornLine;

/// Largest latitude that a contact may meet, rad: 80 deg. Beyond it heights are those there.
pub const MOST_LATITUDE: f64 = 80.0 * PI / 180.0;

/// What a ball lacks of a sphere, as the raceway of one side meets it.
#[derive(Clone, Debug, PartialEq)]
pub struct BallSurface {
    /// Longitude that the raceway meets at the start, rad.
    longitude: f64,
    radius: f64,
    /// Sign of the raceway's side.
    sign: f64,
    /// Contact angle that meets the equator at the start, rad.
    equator: f64,
    grid: SurfaceGrid,
}

/// What a ball lacks along an arc.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BallArc {
    /// Contact angles of its corners, rad, rising.
    pub angles: Vec<f64>,
    /// Missing material at them, m.
    pub missing: Vec<f64>,
}

impl BallSurface {
    /// Memory of what the ball lacks, bytes.
    pub fn bytes(&self) -> usize {
        self.grid.bytes()
    }

    /// A ball with these profiles, whose azimuths are longitudes and whose groove angles are latitudes. It rolls at the
    /// contact angle `equator`, rad. None where the grid would need more than [`super::MOST_NUMBERS`] numbers.
    pub fn new(
        (geometry, side): (&BearingGeometry, Side),
        equator: f64,
        profiles: &Profiles,
    ) -> Option<BallSurface> {
        let track = Track::on_ball(geometry, side, equator);
        let seen = profiles.seen_from(side, equator);
        let range = equator - MOST_LATITUDE..=equator + MOST_LATITUDE;
        Some(BallSurface {
            longitude: 0.5 * PI * (1.0 - side.sign()),
            radius: 0.5 * geometry.ball_diameter,
            sign: side.sign(),
            equator,
            grid: seen.grid(track, &range)?,
        })
    }

    /// Missing material at the corners, m, as the raceway meets it after the ball has rolled by an angle, rad.
    pub fn missing_at(&self, rolled: f64) -> Vec<f64> {
        self.grid.missing_at(self.longitude - rolled)
    }

    /// Radius of the ball, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Contact angle that meets the equator at the start, rad.
    pub fn equator(&self) -> f64 {
        self.equator
    }

    /// Sign of the raceway's side.
    pub(super) fn sign(&self) -> f64 {
        self.sign
    }

    /// Latitudes of the corners, rad: rising outside, falling inside.
    pub(super) fn latitudes(&self) -> impl Iterator<Item = f64> {
        let angles = self.grid.angles().iter();
        angles.map(|angle| self.sign * (angle - self.equator))
    }

    /// Missing material at a longitude, rad, on the latitude of a corner, m.
    pub(super) fn missing_on(&self, longitude: f64, corner: usize) -> f64 {
        self.grid.missing_on(longitude, corner)
    }

    /// Missing material at a longitude and a latitude, rad, in m.
    pub(super) fn missing_of(&self, longitude: f64, latitude: f64) -> f64 {
        let (angle, angles) = (self.equator + self.sign * latitude, self.grid.angles());
        let next = angles.partition_point(|corner| *corner <= angle);
        if next == 0 || next == angles.len() {
            return self.missing_on(longitude, next.min(angles.len() - 1));
        }
        let share = (angle - angles[next - 1]) / (angles[next] - angles[next - 1]);
        let [low, high] = [next - 1, next].map(|corner| self.missing_on(longitude, corner));
        low + share * (high - low)
    }

    /// The ball along an arc.
    pub fn line_along<'l>(&self, arc: &'l BallArc) -> WornLine<'l> {
        WornLine {
            radius: self.radius,
            angles: &arc.angles,
            missing: &arc.missing,
        }
    }

    /// A line across the track.
    pub fn line<'l>(&'l self, missing: &'l [f64]) -> WornLine<'l> {
        WornLine {
            radius: self.radius,
            angles: self.grid.angles(),
            missing,
        }
    }
}

impl Profiles {
    /// Profiles of a ball with its latitudes as contact angles at which a raceway meets them.
    fn seen_from(&self, side: Side, equator: f64) -> Profiles {
        let angle = |latitude: f64| equator + side.sign() * latitude;
        let spall = |spall: &Spall| Spall {
            groove_angle: angle(spall.groove_angle),
            ..*spall
        };
        let dent = |dent: &Dent| Dent {
            groove_angle: angle(dent.groove_angle),
            ..*dent
        };
        let table = |table: &Heights| {
            let mut seen = table.clone();
            seen.angles.iter_mut().for_each(|a| *a = angle(*a));
            // Contact angles must rise.
            if seen.angles.first() > seen.angles.last() {
                let n = seen.angles.len();
                seen.angles.reverse();
                seen.heights.chunks_mut(n).for_each(|row| row.reverse());
            }
            seen
        };
        Profiles {
            spalls: self.spalls.iter().map(spall).collect(),
            dents: self.dents.iter().map(dent).collect(),
            waves: self.waves.clone(),
            tables: self.tables.iter().map(table).collect(),
        }
    }
}
