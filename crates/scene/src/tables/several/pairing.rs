//! `[pairing]`: what presses the bearings of a set together.
//!
//! With `offset` the faces are ground so that clamping moves the rings of the "+z" bearings against those of the "-z"
//! bearings by so much: hard preload; a negative offset is play. It is the same for inner rings pressed together (back
//! to back) and for outer rings (face to face). With `spring` the outer ring of the bearing `sliding` slides in the
//! housing, and a constant force presses it against its balls.

use assembly::Orientation;
use input::{FORCE, LENGTH, Problems, Quantity};
use serde::Deserialize;

use super::mounted::RawMounted;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the table [pairing] with offset and bearings, or with spring and sliding"
)]
pub struct RawPairing {
    offset: Option<Quantity<LENGTH>>,
    bearings: Option<Vec<String>>,
    spring: Option<Quantity<FORCE>>,
    sliding: Option<String>,
}

/// What presses the bearings together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pairing {
    /// Axial distance by which "+z" bearings are pressed against "-z" bearings, m.
    pub offset: f64,
    /// Numbers of the bearings of a list that it presses together; None: all.
    pub members: Option<Vec<usize>>,
    /// A spring behind one outer ring.
    pub spring: Option<SpringPairing>,
}

impl Pairing {
    /// The distance by which the faces move the inner ring of a bearing along its own z, m.
    pub fn shift(&self, bearing: usize) -> f64 {
        match &self.members {
            Some(members) if !members.contains(&bearing) => 0.0,
            _ => 0.5 * self.offset,
        }
    }
}

/// A constant force on the outer ring of a bearing.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringPairing {
    /// N.
    pub force: f64,
    /// Number of the bearing in the list.
    pub bearing: usize,
}

/// A larger force is a slip of the unit, N.
const MAX_FORCE: f64 = 1e9;
/// A larger offset is a slip of the unit, m.
const MAX_OFFSET: f64 = 1e-3;

impl RawPairing {
    /// Checks that there is something to press.
    pub fn check(&self, bearings: &[RawMounted], problems: &mut Problems) -> Pairing {
        if let Some(offset) = &self.offset {
            problems.require(
                offset.si().abs() <= MAX_OFFSET,
                "pairing.offset",
                offset,
                "expected -1 to 1 mm, such as \"8 um\": the distance by which the faces press the bearings together",
            );
            let is_member =
                |b: &&RawMounted| self.bearings.as_ref().is_none_or(|names| names.contains(&b.name));
            let members = || bearings.iter().filter(is_member);
            let has = |wanted| members().any(|b| b.orientation() == Some(wanted));
            let is_known = members().all(|b| b.orientation().is_some());
            if is_known && !(has(Orientation::PlusZ) && has(Orientation::MinusZ)) {
                problems.add(format!(
                    "pairing.offset is {offset}, but all bearings have the same orientation; it presses \"+z\" against \
                     \"-z\" bearings, so turn one of them or remove it"
                ));
            }
        } else if self.bearings.is_some() {
            problems.add(
                "pairing.bearings needs offset, the distance by which these bearings press on each other",
            );
        }
        if self.offset.is_some() && self.spring.is_some() {
            problems
                .add("pairing has both offset and spring; keep the one that presses the bearings together");
        }
        if self.offset.is_none() && self.spring.is_none() {
            problems.add(
                "pairing is empty; expected offset = \"8 um\", or spring = \"500 N\" and sliding = \"rear\"",
            );
        }
        Pairing {
            offset: self.offset.as_ref().map_or(0.0, Quantity::si),
            members: self.members(bearings, problems),
            spring: self.spring(bearings, problems),
        }
    }

    fn members(&self, bearings: &[RawMounted], problems: &mut Problems) -> Option<Vec<usize>> {
        let wanted = self.bearings.as_ref()?;
        let names: Vec<&str> = bearings.iter().map(|b| b.name.as_str()).collect();
        for name in wanted.iter().filter(|name| !names.contains(&name.as_str())) {
            problems.add(format!(
                "pairing.bearings has {name:?}; expected names of bearings: {}",
                names.join(", ")
            ));
        }
        let is_member = |number: &usize| wanted.iter().any(|name| name == names[*number]);
        Some((0..names.len()).filter(is_member).collect())
    }

    fn spring(&self, bearings: &[RawMounted], problems: &mut Problems) -> Option<SpringPairing> {
        let Some(force) = &self.spring else {
            if self.sliding.is_some() {
                problems.add("pairing.sliding needs spring, the force on the outer ring that slides");
            }
            return None;
        };
        let presses = force.si() > 0.0 && force.si() <= MAX_FORCE;
        problems.require(
            presses,
            "pairing.spring",
            force,
            "expected more than 0 and at most 1e9 N, the force that presses the outer ring against its balls",
        );
        let names: Vec<&str> = bearings.iter().map(|b| b.name.as_str()).collect();
        let Some(sliding) = &self.sliding else {
            problems.add(format!(
                "pairing.spring needs sliding, the bearing whose outer ring slides: one of {}",
                names.join(", ")
            ));
            return None;
        };
        let found = names.iter().position(|name| name == sliding);
        if found.is_none() {
            problems.add(format!(
                "pairing.sliding is {sliding:?}; expected the name of a bearing: {}",
                names.join(", ")
            ));
        }
        // The bearing would say the same of a key that the scene does not have.
        found.filter(|_| presses).map(|bearing| SpringPairing {
            force: force.si(),
            bearing,
        })
    }
}
