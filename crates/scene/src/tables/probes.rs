//! ```toml
#![doc = include_str!("example_probes.toml")]
//! ```
//! Single numbers of a run, written to `probes.csv` at every step of a motion or quasi-static run and at every point of
//! a sweep, whatever `output_every` says. Without a table there is no file and no cost.
//!
//! A node probe takes the mesh node nearest to its point: among those of the raceway for a groove angle, among all for
//! `r` and `z`. `summary.json` tells which node it is and where. Its stress is the nodal stress of the step files.
//! Cylindrical axes are radial, tangential (towards growing azimuth) and axial at the node, and turn with the ring, so
//! the displacement is that within the turning ring; Cartesian axes are fixed in space, as in the step files, and the
//! displacement contains the turning.
//!
//! `acceleration = true` writes its acceleration besides, that of the integrator at the end of the step: of the
//! displacement in the frame of the ring, along the same axes. Only motions have it.
//!
//! Points and profiles are in the file `stress_probes`, strain gauges in `gauges`.
//!
//! A contact probe gives the force of the ring on the ball in x, y, z and its size, and its moment about the given
//! point, likewise. Without friction the force acts along a line through the ball's centre. In motion with inertia the
//! force is the mean over the step that ends at the given time; its direction and place are those at that end.

use std::collections::BTreeMap;

use input::{ANGLE, LENGTH, Problems, Quantity};
use serde::Deserialize;

use super::bearing::Bearing;
use super::gauges::{GaugeProbe, RawGauge, RawTachometer, Tachometer};
use super::ring_name::RingName;
use super::stress_probes::{RawPointProbe, RawProfile, StressLine};

/// As typed.
#[derive(Debug, Default, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "tables [probes.node.*], [probes.point.*], [probes.profile.*], [probes.contact.*], \
                 [probes.gauge.*] and [probes.tachometer.*]"
)]
pub struct RawProbes {
    #[serde(default)]
    node: BTreeMap<String, RawNodeProbe>,
    #[serde(default)]
    contact: BTreeMap<String, RawContactProbe>,
    #[serde(default)]
    point: BTreeMap<String, RawPointProbe>,
    #[serde(default)]
    profile: BTreeMap<String, RawProfile>,
    #[serde(default)]
    gauge: BTreeMap<String, RawGauge>,
    #[serde(default)]
    tachometer: BTreeMap<String, RawTachometer>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [probes.node.NAME]")]
struct RawNodeProbe {
    ring: RingName,
    azimuth: Quantity<ANGLE>,
    groove_angle: Option<Quantity<ANGLE>>,
    r: Option<Quantity<LENGTH>>,
    z: Option<Quantity<LENGTH>>,
    axes: Option<Axes>,
    acceleration: Option<bool>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [probes.contact.NAME]")]
struct RawContactProbe {
    ball: i64,
    ring: RingName,
    about: Option<[Quantity<LENGTH>; 3]>,
}

/// Axes of the components of a node probe.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Axes {
    /// Radial, tangential and axial at the node, turning with its ring.
    #[default]
    Cylindrical,
    /// x, y, z, fixed in space.
    Cartesian,
}

/// Where in the section of a ring a probe lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SectionPoint {
    /// On the raceway at a groove angle, rad.
    Groove(f64),
    /// Anywhere.
    Anywhere {
        /// Distance from the axis, m.
        radius: f64,
        /// Distance from the plane of the groove centres, m.
        z: f64,
    },
}

/// Stress and displacement of a node.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeProbe {
    /// Name in the scene and in the columns.
    pub name: String,
    /// The ring.
    pub ring: RingName,
    /// Azimuth on the ring at t = 0, rad.
    pub azimuth: f64,
    /// Place in the section.
    pub point: SectionPoint,
    /// Axes of the components.
    pub axes: Axes,
    /// Whether its acceleration is written besides, in motions only.
    pub has_acceleration: bool,
}

/// Force and moment of a contact.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactProbe {
    /// Name in the scene and in the columns.
    pub name: String,
    /// Ball number, from 0.
    pub ball: usize,
    /// The ring it touches.
    pub ring: RingName,
    /// Point of the moment x, y, z, m; the origin is the axis point in the plane of the outer groove centres.
    pub about: [f64; 3],
}

/// All probes of a scene, by kind in the order of their names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Probes {
    /// Nodes.
    pub nodes: Vec<NodeProbe>,
    /// Contacts.
    pub contacts: Vec<ContactProbe>,
    /// Points of rings.
    pub points: Vec<StressLine>,
    /// Lines of points of rings.
    pub profiles: Vec<StressLine>,
    /// Strain gauges.
    pub gauges: Vec<GaugeProbe>,
    /// Angles of rings.
    pub tachometers: Vec<Tachometer>,
}

impl Probes {
    /// Whether the scene asks for none.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
            && self.contacts.is_empty()
            && self.points.is_empty()
            && self.profiles.is_empty()
            && self.gauges.is_empty()
            && self.tachometers.is_empty()
    }
}

/// What probes are checked against.
#[derive(Clone, Copy, Debug)]
pub struct ProbesContext<'a> {
    /// Macro-geometry, when it is sound.
    pub bearing: Option<&'a Bearing>,
    /// Which rings are rigid, inner first.
    pub rigid: [bool; 2],
    /// Which rings [speed] names, inner first.
    pub has_speed: [bool; 2],
}

impl<'a> ProbesContext<'a> {
    /// A bearing with rigid rings and rings with a speed.
    pub fn new(bearing: Option<&'a Bearing>, rigid: [bool; 2], has_speed: [bool; 2]) -> ProbesContext<'a> {
        ProbesContext {
            bearing,
            rigid,
            has_speed,
        }
    }
}

/// Groove angles beyond this are in no groove, rad.
const MAX_GROOVE_ANGLE: f64 = std::f64::consts::FRAC_PI_2;
/// Points farther away than this many outside diameters are slips of the unit.
const MAX_DISTANCE: f64 = 100.0;

impl RawProbes {
    /// Checks names, numbers and places.
    pub fn check(&self, context: ProbesContext<'_>, problems: &mut Problems) -> Probes {
        let node = |(name, raw): (&String, &RawNodeProbe)| {
            let key = format!("probes.node.{name}");
            check_name(&key, name, problems);
            raw.check(&key, name, context, problems)
        };
        let nodes = self.node.iter().filter_map(node).collect();
        let contact = |(name, raw): (&String, &RawContactProbe)| {
            let key = format!("probes.contact.{name}");
            check_name(&key, name, problems);
            raw.check(&key, name, context, problems)
        };
        let contacts = self.contact.iter().map(contact).collect();
        let mut points = Vec::new();
        for (name, raw) in &self.point {
            let key = format!("probes.point.{name}");
            check_name(&key, name, problems);
            require_flexible(&key, raw.ring, context, problems);
            points.push(raw.check(&key, name, problems));
        }
        // The columns of both in probes.csv begin with the name and end with the same stresses.
        for name in self.node.keys().filter(|name| self.point.contains_key(*name)) {
            problems.add(format!(
                "[probes.node.{name}] and [probes.point.{name}] have one name, with which their columns in probes.csv \
                 begin; expected another name for one of them"
            ));
        }
        let mut profiles = Vec::new();
        for (name, raw) in &self.profile {
            let key = format!("probes.profile.{name}");
            check_name(&key, name, problems);
            require_flexible(&key, raw.ring, context, problems);
            profiles.push(raw.check(&key, name, problems));
        }
        let gauge = |(name, raw): (&String, &RawGauge)| {
            let key = format!("probes.gauge.{name}");
            check_name(&key, name, problems);
            require_flexible(&key, raw.ring, context, problems);
            raw.check(&key, name, problems)
        };
        let gauges = self.gauge.iter().map(gauge).collect();
        let tachometer = |(name, raw): (&String, &RawTachometer)| {
            let key = format!("probes.tachometer.{name}");
            check_name(&key, name, problems);
            raw.check(&key, name, context.has_speed, problems)
        };
        let tachometers = self.tachometer.iter().map(tachometer).collect();
        Probes {
            tachometers,
            nodes,
            contacts,
            points,
            profiles,
            gauges,
        }
    }
}

/// Only a flexible ring has stress.
fn require_flexible(key: &str, ring: RingName, context: ProbesContext<'_>, problems: &mut Problems) {
    if context.rigid[ring as usize] {
        problems.add(format!(
            "{key}.ring is {:?}, but that ring is rigid and has no nodes; make it flexible or remove the probe",
            ring.key()
        ));
    }
}

/// A name becomes part of the names of columns.
fn check_name(key: &str, name: &str, problems: &mut Problems) {
    let plain = name
        .chars()
        .all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if name.is_empty() || !plain {
        problems.add(format!(
            "[{key}]: {name:?} is no name for a column; expected letters, digits, \"_\" and \"-\" only"
        ));
    }
}

impl RawNodeProbe {
    fn check(
        &self,
        key: &str,
        name: &str,
        context: ProbesContext<'_>,
        problems: &mut Problems,
    ) -> Option<NodeProbe> {
        require_flexible(key, self.ring, context, problems);
        Some(NodeProbe {
            name: name.to_string(),
            ring: self.ring,
            azimuth: self.azimuth.si(),
            point: self.point(key, problems)?,
            axes: self.axes.unwrap_or_default(),
            has_acceleration: self.acceleration.unwrap_or(false),
        })
    }

    fn point(&self, key: &str, problems: &mut Problems) -> Option<SectionPoint> {
        match (&self.groove_angle, &self.r, &self.z) {
            (Some(angle), None, None) => {
                let rule = "expected -90 to 90 deg, 0 is the bottom of the groove";
                let holds = angle.si().abs() <= MAX_GROOVE_ANGLE;
                problems.require(holds, &format!("{key}.groove_angle"), angle, rule);
                Some(SectionPoint::Groove(angle.si()))
            }
            (None, Some(r), Some(z)) => {
                problems.require_positive(r, &format!("{key}.r"), "a distance from the axis");
                Some(SectionPoint::Anywhere {
                    radius: r.si(),
                    z: z.si(),
                })
            }
            _ => {
                problems.add(format!(
                    "{key} needs its place in the section: either groove_angle such as \"15 deg\" for a point of the \
                     raceway, or both r and z"
                ));
                None
            }
        }
    }
}

impl RawContactProbe {
    fn check(
        &self,
        key: &str,
        name: &str,
        context: ProbesContext<'_>,
        problems: &mut Problems,
    ) -> ContactProbe {
        let last = context.bearing.map_or(i64::MAX, |b| b.balls as i64 - 1);
        let about = self.about.as_ref();
        if let (Some(bearing), Some(point)) = (context.bearing, about) {
            for (x, axis) in point.iter().zip(["x", "y", "z"]) {
                problems.require(
                    x.si().abs() <= MAX_DISTANCE * bearing.outside_diameter,
                    &format!("{key}.about, {axis}"),
                    x,
                    "that is more than a hundred bearings away, check its unit",
                );
            }
        }
        ContactProbe {
            name: name.to_string(),
            ball: problems.whole(self.ball, &format!("{key}.ball"), 0, last),
            ring: self.ring,
            about: about.map_or([0.0; 3], |point| point.each_ref().map(Quantity::si)),
        }
    }
}
