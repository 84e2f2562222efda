//! ```toml
#![doc = include_str!("example_gauges.toml")]
//! ```
//! A virtual strain gauge: the strain along its direction in the surface of a ring, averaged over its grid, in
//! `probes.csv` as `NAME_strain`. It is the strain that makes stress: free thermal expansion does not count, as for a
//! gauge that is matched to the ring's steel. Lengthening is positive.
//!
//! A tachometer gives the angle that a ring has turned, in `probes.csv` as `NAME_angle_rad`; turns add up.

use std::f64::consts::FRAC_PI_2;

use input::{ANGLE, LENGTH, Problems, Quantity};
use serde::Deserialize;

use super::ring_name::RingName;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [probes.gauge.NAME]")]
pub struct RawGauge {
    pub(super) ring: RingName,
    surface: String,
    azimuth: Quantity<ANGLE>,
    z: Option<Quantity<LENGTH>>,
    r: Option<Quantity<LENGTH>>,
    length: Quantity<LENGTH>,
    width: Quantity<LENGTH>,
    direction: RawDirection,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "a direction: \"hoop\", \"axial\", \"radial\", or an angle from hoop such as \"45 deg\""
)]
enum RawDirection {
    Named(NamedDirection),
    Angle(Quantity<ANGLE>),
}

/// Directions with names.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
enum NamedDirection {
    Hoop,
    Axial,
    Radial,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [probes.tachometer.NAME]")]
pub struct RawTachometer {
    ring: RingName,
}

/// Angle that a ring has turned.
#[derive(Clone, Debug, PartialEq)]
pub struct Tachometer {
    /// Name in the scene and in its column.
    pub name: String,
    /// The ring.
    pub ring: RingName,
}

impl RawTachometer {
    /// Checks that the ring has a speed.
    pub(super) fn check(
        &self,
        key: &str,
        name: &str,
        has_speed: [bool; 2],
        problems: &mut Problems,
    ) -> Tachometer {
        if !has_speed[self.ring as usize] {
            problems.add(format!(
                "{key}.ring is {:?}, but [speed] gives that ring no speed; expected a ring that turns",
                self.ring.key()
            ));
        }
        Tachometer {
            name: name.to_string(),
            ring: self.ring,
        }
    }
}

/// What the second direction of a surface must be, besides hoop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Across {
    /// Any: the scene gave an angle, or hoop.
    Any,
    /// The surface runs along the axis.
    Axial,
    /// The surface is a face.
    Radial,
}

/// A strain gauge on a ring.
#[derive(Clone, Debug, PartialEq)]
pub struct GaugeProbe {
    /// Name in the scene and in its column.
    pub name: String,
    /// The ring.
    pub ring: RingName,
    /// Facet group of the mesh, or `free`.
    pub surface: String,
    /// Azimuth of its middle on the ring at t = 0, rad.
    pub azimuth: f64,
    /// Axial distance of its middle from the plane of the groove centres, m.
    pub z: Option<f64>,
    /// Distance of its middle from the axis, m.
    pub r: Option<f64>,
    /// Length of the grid along its direction and width across, m.
    pub size: [f64; 2],
    /// From the hoop direction towards the axial one, on a face the radial one, rad.
    pub angle: f64,
    /// What surface the direction needs.
    pub across: Across,
}

impl RawGauge {
    /// Checks place and size.
    pub(super) fn check(&self, key: &str, name: &str, problems: &mut Problems) -> GaugeProbe {
        if self.z.is_none() && self.r.is_none() {
            problems.add(format!(
                "{key} needs its place in the section: z such as \"2 mm\", from the plane of the groove centres, or on \
                 a face r, from the axis"
            ));
        }
        if let Some(r) = &self.r {
            problems.require_positive(r, &format!("{key}.r"), "a distance from the axis");
        }
        for (value, what) in [(&self.length, "length"), (&self.width, "width")] {
            let rule = "expected 0 mm, a point or a line, or more";
            problems.require(value.si() >= 0.0, &format!("{key}.{what}"), value, rule);
        }
        let (angle, across) = match &self.direction {
            RawDirection::Named(NamedDirection::Hoop) => (0.0, Across::Any),
            RawDirection::Named(NamedDirection::Axial) => (FRAC_PI_2, Across::Axial),
            RawDirection::Named(NamedDirection::Radial) => (FRAC_PI_2, Across::Radial),
            RawDirection::Angle(angle) => (angle.si(), Across::Any),
        };
        GaugeProbe {
            name: name.to_string(),
            ring: self.ring,
            surface: self.surface.clone(),
            azimuth: self.azimuth.si(),
            z: self.z.as_ref().map(Quantity::si),
            r: self.r.as_ref().map(Quantity::si),
            size: [self.length.si(), self.width.si()],
            angle,
            across,
        }
    }
}
