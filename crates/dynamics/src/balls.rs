//! What is reported of every ball.

use contact::Side;
use serde::Serialize;

use crate::bearing::Bearing;
use crate::displacements::Displacements;
use crate::model::Model;

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

/// Results of all balls at given displacements.
pub fn ball_results(model: &Model, parts: &Bearing, u: &Displacements) -> Vec<BallResult> {
    let (sites, states) = (&parts.contacts.sites, parts.states_at(u));
    let contact = |i: usize| {
        let (site, state) = (&sites[i], &states[i]);
        let hertz = &model.hertz[site.side.index()];
        ContactResult {
            force_n: state.force.force,
            contact_angle_rad: state.angle,
            approach_m: state.force.approach,
            semi_axes_m: hertz.semi_axes(state.force.force),
            peak_pressure_pa: hertz.peak_pressure(state.force.force),
        }
    };
    (0..model.geometry.n_balls)
        .map(|ball| BallResult {
            azimuth_rad: sites[2 * ball].azimuth.rem_euclid(2.0 * std::f64::consts::PI),
            inner: contact(2 * ball + Side::Inner.index()),
            outer: contact(2 * ball + Side::Outer.index()),
            displacement_m: BallDisplacement {
                radial: u.balls[ball][0],
                axial: u.balls[ball][1],
            },
        })
        .collect()
}
