//! ```toml
#![doc = include_str!("example_stress_probes.toml")]
//! ```
//! Points in ring coordinates. Their stress is that of the finite elements, interpolated from the nodal averages,
//! plus, with `stress.near_field`, the near field at the point itself, which is not interpolated. Components are in
//! the directions of the raceway at the point: g along the groove (growing groove angle), t in the rolling direction
//! (growing azimuth), d into the ring.

use std::f64::consts::FRAC_PI_2;

use input::{ANGLE, LENGTH, Problems, Quantity};
use serde::Deserialize;

use super::ring_name::RingName;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [probes.point.NAME]")]
pub struct RawPointProbe {
    pub(super) ring: RingName,
    azimuth: Quantity<ANGLE>,
    groove_angle: Quantity<ANGLE>,
    depth: Option<Quantity<LENGTH>>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [probes.profile.NAME]")]
pub struct RawProfile {
    pub(super) ring: RingName,
    azimuth: OneOrTwo<ANGLE>,
    groove_angle: OneOrTwo<ANGLE>,
    depth: Option<OneOrTwo<LENGTH>>,
    points: i64,
}

/// A value, or the first and the last of a range.
#[derive(Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "a quantity such as \"15 deg\", or two of them: [first, last]"
)]
enum OneOrTwo<const K: usize> {
    One(Quantity<K>),
    Two([Quantity<K>; 2]),
}

/// Stress along a line of points of a ring, or at one point.
#[derive(Clone, Debug, PartialEq)]
pub struct StressLine {
    /// Name in the scene and in the tables.
    pub name: String,
    /// The ring.
    pub ring: RingName,
    /// First and last [azimuth (rad, on the ring at t = 0), groove angle (rad), depth (m)].
    pub ends: [[f64; 3]; 2],
    /// Number of points, 1 for a point.
    pub n_points: usize,
}

impl StressLine {
    /// [azimuth, groove angle, depth] of every point, rad, rad, m.
    pub fn points(&self) -> Vec<[f64; 3]> {
        let [first, last] = self.ends;
        let share = |i: usize| i as f64 / (self.n_points - 1).max(1) as f64;
        let point = |i: usize| std::array::from_fn(|k| first[k] + share(i) * (last[k] - first[k]));
        (0..self.n_points).map(point).collect()
    }
}

impl RawPointProbe {
    /// Checks the place.
    pub(super) fn check(&self, key: &str, name: &str, problems: &mut Problems) -> StressLine {
        let depth = self.depth.as_ref().map_or(0.0, Quantity::si);
        let place = [self.azimuth.si(), self.groove_angle.si(), depth];
        check_ends(key, [place; 2], problems);
        StressLine {
            name: name.to_string(),
            ring: self.ring,
            ends: [place; 2],
            n_points: 1,
        }
    }
}

impl RawProfile {
    /// Checks the places.
    pub(super) fn check(&self, key: &str, name: &str, problems: &mut Problems) -> StressLine {
        let (azimuth, angle) = (self.azimuth.ends(), self.groove_angle.ends());
        let depth = self.depth.as_ref().map_or([0.0; 2], OneOrTwo::ends);
        let ends = [0, 1].map(|i| [azimuth[i], angle[i], depth[i]]);
        check_ends(key, ends, problems);
        if ends[0] == ends[1] {
            problems.add(format!(
                "{key}: first and last point are the same; give azimuth, groove_angle or depth as [first, last], or \
                 use [probes.point.{name}]"
            ));
        }
        StressLine {
            name: name.to_string(),
            ring: self.ring,
            ends,
            n_points: problems.whole(self.points, &format!("{key}.points"), 2, 10_000),
        }
    }
}

impl<const K: usize> OneOrTwo<K> {
    fn ends(&self) -> [f64; 2] {
        match self {
            OneOrTwo::One(value) => [value.si(); 2],
            OneOrTwo::Two([first, last]) => [first.si(), last.si()],
        }
    }
}

fn check_ends(key: &str, ends: [[f64; 3]; 2], problems: &mut Problems) {
    for [_, angle, depth] in ends {
        if angle.abs() > FRAC_PI_2 {
            problems.add(format!(
                "{key}.groove_angle is {:.3} deg; expected -90 to 90 deg, 0 is the bottom of the groove",
                angle.to_degrees()
            ));
            return;
        }
        if depth < 0.0 {
            problems.add(format!(
                "{key}.depth is {} mm; expected 0, the raceway, or more, into the ring",
                1e3 * depth
            ));
            return;
        }
    }
}
