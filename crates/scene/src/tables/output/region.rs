//! `[output.region]`: where fields are kept; elsewhere step files hold NaN, which takes no place.
//!
//! A place is that of a node in the mesh: a ring that turns takes its region along.

use std::f64::consts::TAU;

use input::{ANGLE, LENGTH, Problems, Quantity};
use serde::Deserialize;

use super::context::OutputContext;
use super::every::KeptFields;
use crate::tables::ring_name::RingName;

/// As typed.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [output.region]")]
pub struct RawRegion {
    fields: Option<Vec<RegionField>>,
    rings: Option<Vec<RingName>>,
    raceway_distance: Option<Quantity<LENGTH>>,
    azimuth: Option<[Quantity<ANGLE>; 2]>,
    x: Option<[Quantity<LENGTH>; 2]>,
    y: Option<[Quantity<LENGTH>; 2]>,
    z: Option<[Quantity<LENGTH>; 2]>,
}

/// A field that may be kept in a region only.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum RegionField {
    /// At nodes or integration points, with von Mises stress.
    Stress,
    /// Of the rings; that of balls is always whole.
    Displacement,
}

/// Where fields are kept: a node is inside if all conditions hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutputRegion {
    /// The fields that are kept in the region only; others are whole.
    pub fields: KeptFields,
    /// Rings, inner first, of which anything is kept.
    pub rings: [bool; 2],
    /// Largest distance from the groove of the ring, m.
    pub raceway_distance: Option<f64>,
    /// Azimuths of the ends of a sector, rad, which goes from the first to the second towards +y from +x.
    pub azimuth: Option<[f64; 2]>,
    /// Least and largest coordinates, m: x, y, z.
    pub coordinates: [Option<[f64; 2]>; 3],
}

/// Ends of a sector that are closer than this, rad, are one azimuth.
const SAME_AZIMUTH: f64 = 1e-9;

impl RawRegion {
    /// Checks what can be checked without meshes.
    pub fn check(&self, context: OutputContext, problems: &mut Problems) -> OutputRegion {
        let region = OutputRegion {
            fields: self.check_fields(context, problems),
            rings: self.check_rings(context, problems),
            raceway_distance: self.raceway_distance.as_ref().map(Quantity::si),
            azimuth: self
                .azimuth
                .as_ref()
                .map(|ends| ends.each_ref().map(Quantity::si)),
            coordinates: [&self.x, &self.y, &self.z]
                .map(|ends| ends.as_ref().map(|ends| ends.each_ref().map(Quantity::si))),
        };
        if let Some(distance) = &self.raceway_distance {
            problems.require_positive(distance, "output.region.raceway_distance", "the distance");
        }
        if let (Some([from, to]), Some(typed)) = (region.azimuth, &self.azimuth) {
            let apart = (to - from).rem_euclid(TAU);
            if apart.min(TAU - apart) < SAME_AZIMUTH {
                problems.add(format!(
                    "output.region.azimuth goes from {} to {}, the same azimuth; expected both ends of a sector, or no \
                     such key for the whole ring",
                    typed[0], typed[1]
                ));
            }
        }
        for (typed, name) in [&self.x, &self.y, &self.z].into_iter().zip(["x", "y", "z"]) {
            if let Some([least, most]) = typed
                && least.si() >= most.si()
            {
                problems.add(format!(
                    "output.region.{name} goes from {least} to {most}; expected the smaller value first"
                ));
            }
        }
        let has_none = region.raceway_distance.is_none()
            && region.azimuth.is_none()
            && region.coordinates.iter().all(Option::is_none)
            && region.rings == [true; 2];
        if has_none {
            problems.add(
                "[output.region] says no place; expected raceway_distance, azimuth, x, y, z or rings, or no such table",
            );
        }
        if !context.has_steps && !context.is_sweep && !context.is_static {
            problems
                .add("[output.region] is not known to [modes], whose shapes are written whole; remove it");
        }
        region
    }

    fn check_fields(&self, context: OutputContext, problems: &mut Problems) -> KeptFields {
        let fields = self.fields.clone().unwrap_or(vec![RegionField::Stress]);
        if fields.is_empty() {
            problems.add("output.region.fields is empty; expected \"stress\", \"displacement\" or both");
        }
        if !context.has_stress && !fields.contains(&RegionField::Displacement) {
            problems.add(
                "[output.region] does nothing with output.stress = \"none\"; remove it, or add \
                 fields = [\"displacement\"]",
            );
        }
        KeptFields {
            stress: fields.contains(&RegionField::Stress),
            displacement: fields.contains(&RegionField::Displacement),
        }
    }

    fn check_rings(&self, context: OutputContext, problems: &mut Problems) -> [bool; 2] {
        let Some(rings) = &self.rings else {
            return [true; 2];
        };
        if rings.is_empty() {
            problems.add("output.region.rings is empty; expected \"inner\", \"outer\" or both");
        }
        for ring in rings {
            if !context.flexible[*ring as usize] {
                problems.add(format!(
                    "output.region.rings has \"{}\", a rigid ring, which has no fields; expected a flexible ring",
                    ring.key()
                ));
            }
        }
        [RingName::Inner, RingName::Outer].map(|ring| rings.contains(&ring))
    }
}

impl OutputRegion {
    /// Whether an azimuth is in the sector, rad; always without one.
    pub fn has_azimuth(&self, azimuth: f64) -> bool {
        self.azimuth.is_none_or(|[from, to]| {
            (azimuth - from).rem_euclid(TAU) <= (to - from).rem_euclid(TAU) + SAME_AZIMUTH
        })
    }

    /// Whether a place is between the least and the largest coordinates, m.
    pub fn has_coordinates(&self, place: [f64; 3]) -> bool {
        let ends = self.coordinates.iter().zip(place);
        ends.into_iter()
            .all(|(ends, x)| ends.is_none_or(|[least, most]| (least..=most).contains(&x)))
    }
}
