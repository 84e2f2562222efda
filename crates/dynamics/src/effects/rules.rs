//! Rules of thumb: what an effect brings, over what is there without it.
//!
//! Every rule is a ratio from a closed form of rigid rings, stated in the file of its effect. An effect that is off
//! is pointed out from a ratio of 1 % on, one that is on below 0.1 %. Estimates are good to a factor of about two:
//! they say where to look, and `raceway prices` measures.
//!
//! ```text
//! load of a ball         Q = F_a / (Z sin a) + 4.37 F_r / (Z cos a)     Stribeck's number for ball bearings
//! Hertz approach         d = (Q / K)^(2/3)
//! ```
//!
//! a is the free contact angle, which is lower than the one under load: Q is rather too large, angles too small.
//! References: Harris, Rolling Bearing Analysis, 4th ed., chapters 5, 7 and 13.

use contact::Side;
use fem::Material;

use crate::kinematics::{BothRings, Kinematics, RingSpeeds, SlipRatios};
use crate::model::Model;

/// Ratio from which an effect that is off is pointed out.
pub const MATTERS: f64 = 1e-2;
/// Ratio below which an effect that is on is pointed out.
pub const NEGLIGIBLE: f64 = 1e-3;
/// Stribeck's number: the most loaded ball of a bearing under a radial load carries 4.37 F_r / Z (Harris, chapter 7).
const STRIBECK: f64 = 4.37;

/// Largest forces on the shaft, N.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PeakLoad {
    /// Along the axis.
    pub axial: f64,
    /// Across it.
    pub radial: f64,
    /// Along the axis, by a spring on the outer ring: balls carry the larger of both, not the sum.
    pub spring: f64,
}

/// What a scene is judged by.
pub struct Case<'a> {
    /// The bearing.
    pub model: &'a Model,
    /// Loads on the shaft at their peaks.
    pub load: PeakLoad,
    /// Speeds of the rings.
    pub speeds: &'a RingSpeeds,
    /// Slip ratios at the inner and outer raceway.
    pub slip: SlipRatios,
    /// What rings are made of.
    pub ring_steel: Material,
    /// Bore of the inner ring, m.
    pub bore_diameter: f64,
    /// Outside of the outer ring, m.
    pub outside_diameter: f64,
    /// Width of the rings, m.
    pub width: f64,
    /// Whether it is a motion with inertia.
    pub has_inertia: bool,
    /// Whether an effect damps it.
    pub is_damped: bool,
    /// Whether loads or speed change in time.
    pub changes_in_time: bool,
    /// Whether no other bearing carries its shaft: else what acts on the shaft is not judged beside it.
    pub has_own_shaft: bool,
}

impl Case<'_> {
    /// Load of a ball, N; 0 when no load is given: modes and imposed displacements alone have none to compare with.
    pub fn ball_load(&self) -> f64 {
        let (sin, cos) = self.contact_angle().sin_cos();
        let PeakLoad { axial, radial, .. } = self.load;
        let z = self.n_balls();
        axial / (z * sin.max(f64::MIN_POSITIVE)) + STRIBECK * radial / (z * cos)
    }

    /// Mean Hertz approach of inner and outer contact under the load of a ball, m.
    pub fn approach(&self) -> f64 {
        let stiffness = |side: Side| self.model.hertz[side.index()].stiffness;
        let approach = |side| (self.ball_load() / stiffness(side)).powf(2.0 / 3.0);
        let [inner, outer] = Side::BOTH.map(approach);
        0.5 * (inner + outer)
    }

    /// Free contact angle, rad.
    pub fn contact_angle(&self) -> f64 {
        self.model.geometry.free_contact_angle()
    }

    /// Number of balls.
    pub fn n_balls(&self) -> f64 {
        self.model.geometry.n_balls as f64
    }

    /// Turning of cage and balls.
    pub fn kinematics(&self) -> Kinematics {
        Kinematics::new(&self.model.geometry, self.slip)
    }

    /// Largest speed of a ring, rad/s.
    pub fn speed(&self, side: Side) -> f64 {
        let size = |speeds: BothRings| speeds[side.index()].abs();
        size(self.speeds.at_largest(size))
    }

    /// Largest spin of a ball about its own axis times the speed of the cage, rad^2/s^2.
    pub fn gyroscopic_rate(&self) -> f64 {
        let turning = self.kinematics();
        let size =
            |speeds: BothRings| (turning.ball * (speeds[0] - speeds[1]) * turning.of_cage(speeds)).abs();
        size(self.speeds.at_largest(size))
    }

    /// Largest centrifugal force of a ball, N.
    pub fn centrifugal_force(&self) -> f64 {
        let turning = self.kinematics();
        let size = |speeds: BothRings| turning.of_cage(speeds).abs();
        let cage = size(self.speeds.at_largest(size));
        self.model.ball_mass() * self.model.geometry.ball_centre().radial * cage * cage
    }

    /// Radii of the bottom of a ring's groove and of its seat, m.
    pub fn radii(&self, side: Side) -> (f64, f64) {
        let geometry = &self.model.geometry;
        side.choose(
            (0.5 * geometry.inner_raceway_diameter, 0.5 * self.bore_diameter),
            (0.5 * geometry.outer_raceway_diameter, 0.5 * self.outside_diameter),
        )
    }

    /// Mass of the inner ring, about, kg.
    pub fn inner_ring_mass(&self) -> f64 {
        let (radius, bore) = self.radii(Side::Inner);
        let area = std::f64::consts::PI * (radius * radius - bore * bore);
        self.ring_steel.density * area * self.width
    }
}

/// What a rule of thumb says.
#[derive(Clone, Debug, PartialEq)]
pub struct Remark {
    /// A sentence with estimate and formula.
    pub text: String,
    /// What it judges; None: it only tells.
    pub verdict: Option<Verdict>,
}

/// That an effect is off and matters, or on and does not.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// Table or key of the scene.
    pub key: String,
    /// Whether it is on.
    pub is_on: bool,
    /// What it brings, over what is there without it.
    pub ratio: f64,
}

impl From<String> for Remark {
    fn from(text: String) -> Remark {
        Remark { text, verdict: None }
    }
}

/// Says that an effect is off and matters, or on and does not.
pub fn judge(name: &str, is_on: bool, ratio: f64, estimate: &str) -> Vec<Remark> {
    judge_key(&format!("[effects.{name}]"), is_on, ratio, estimate)
}

/// The same of what a key of a scene turns on.
pub fn judge_key(key: &str, is_on: bool, ratio: f64, estimate: &str) -> Vec<Remark> {
    let text = match is_on {
        false if ratio >= MATTERS => format!("{key} is off, but {estimate}"),
        true if ratio < NEGLIGIBLE => format!("{key} is on, but {estimate}: it could be left off"),
        _ => return Vec::new(),
    };
    let key = key.to_string();
    let verdict = Some(Verdict { key, is_on, ratio });
    vec![Remark { text, verdict }]
}

/// Ratio from which a share is said as so many times the whole.
const TIMES: f64 = 10.0;
/// Ratio beyond which the number says no more: the whole is next to nothing.
const MOST_TIMES: f64 = 1000.0;

/// A ratio as a share of something, such as "12.5 % of the load", or "20 times the load".
pub fn share_of(ratio: f64, whole: &str) -> String {
    if ratio > MOST_TIMES {
        return format!("more than {MOST_TIMES} times {whole}");
    }
    if ratio >= TIMES {
        return format!("{ratio:.0} times {whole}");
    }
    let p = 100.0 * ratio;
    match p >= 0.1 {
        true => format!("{p:.1} % of {whole}"),
        false => format!("{p:.1e} % of {whole}"),
    }
}

/// A load for people, such as "330 N"; a small one keeps two digits.
pub fn newtons(load: f64) -> String {
    match load >= 1.0 {
        true => format!("{load:.0} N"),
        false => format!("{load:.1e} N"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: next to a load of almost nothing a share would be a row of digits that nobody can read.
    #[test]
    fn shares_are_readable_at_every_size() {
        let cases = [
            (5e-5, "5.0e-3 % of the load"),
            (0.125, "12.5 % of the load"),
            (9.99, "999.0 % of the load"),
            (20.2, "20 times the load"),
            (8.6e11, "more than 1000 times the load"),
            (f64::INFINITY, "more than 1000 times the load"),
        ];
        for (ratio, expected) in cases {
            assert_eq!(share_of(ratio, "the load"), expected);
        }
        assert_eq!([newtons(331.7), newtons(2.04e-9)], ["332 N", "2.0e-9 N"]);
    }
}
