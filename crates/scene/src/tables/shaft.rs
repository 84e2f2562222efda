//! `[shaft]`: which motions of the inner ring's shaft are free, locked or prescribed, and where forces act.
//!
//! Motions are of the axis point in the plane of the inner groove centres, from the state where all balls
//! just touch both raceways. Axis z is axial, + is the direction of preload; tilts are rotations about x and
//! y.
//!
//! A prescribed motion may have a schedule, as loads have: an imposed displacement that changes in time,
//!
//! ```toml
//! [shaft.z]
//! value = "20 um"
//! schedule.ramp = { start = "1 ms", duration = "2 ms" }
//! ```
//!
//! In motion the displacement follows the schedule exactly. Its velocity and acceleration are those of the
//! integrator: with average acceleration they alternate about the right ones from step to step after a corner (ramp,
//! step, impact), with an integrator that has damping they settle.
//!
//! In motion the shaft carries `mass` and, about the axis point, `transverse_inertia` and `polar_inertia`, which makes
//! the gyroscopic moment of a turning shaft. They are those of a rigid inner ring too. A free motion without any of
//! its own (rigid inner ring, 0) is quasi-static: it follows from equilibrium at every instant.

use std::fmt;

use dynamics::model::{MAX_TILT, ShaftInertia};
use input::{
    ANGLE, Clock, INERTIA, LENGTH, MASS, Problems, Quantity, RawSchedule, Schedule, bare_number,
    check_schedule,
};
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Visitor};

use super::bearing::Bearing;
use super::ring::Ring;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [shaft]")]
pub struct RawShaft {
    x: RawMotion<LENGTH>,
    y: RawMotion<LENGTH>,
    z: RawMotion<LENGTH>,
    tilt_x: RawMotion<ANGLE>,
    tilt_y: RawMotion<ANGLE>,
    load_point: Quantity<LENGTH>,
    mass: Option<Quantity<MASS>>,
    transverse_inertia: Option<Quantity<INERTIA>>,
    polar_inertia: Option<Quantity<INERTIA>>,
}

/// As typed: `"free"`, `"locked"`, a value, or a table with a value and its schedule.
#[derive(Debug)]
pub enum RawMotion<const KIND: usize> {
    Free,
    Locked,
    Prescribed(RawPrescribed<KIND>),
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with the value of a shaft motion")]
pub struct RawPrescribed<const KIND: usize> {
    value: Quantity<KIND>,
    schedule: Option<Box<RawSchedule>>,
}

/// One degree of freedom of the shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShaftMotion {
    /// It follows from equilibrium.
    Free,
    /// It is zero.
    Locked,
    /// It has this value, m or rad, times its schedule.
    Prescribed(f64),
}

/// The rigid shaft that carries the inner ring.
#[derive(Clone, Debug, PartialEq)]
pub struct Shaft {
    /// Displacement along x.
    pub x: ShaftMotion,
    /// Displacement along y.
    pub y: ShaftMotion,
    /// Displacement along z, + = the direction of preload.
    pub z: ShaftMotion,
    /// Rotation about x.
    pub tilt_x: ShaftMotion,
    /// Rotation about y.
    pub tilt_y: ShaftMotion,
    /// Factors over time of x, y, z, tilt x, tilt y where they are prescribed.
    pub schedules: [Schedule; 5],
    /// Axial distance from the plane of the inner groove centres to the point where forces act, m, + along z.
    pub load_point: f64,
    /// Mass carried by the shaft besides a flexible inner ring, kg; its weight acts at the load point.
    pub mass: f64,
    /// Moments of inertia of the same.
    pub inertia: ShaftInertia,
}

impl Shaft {
    /// Mass of all that turns with the shaft, kg; None where the scene leaves it open, or meshes have a part of it: a
    /// flexible inner ring, and a body that carries it.
    pub fn turning_mass(&self, inner: &Ring) -> Option<f64> {
        let is_known = inner.body.is_none() && self.mass > 0.0;
        is_known.then(|| self.mass + inner.inertia.map_or(0.0, |ring| ring.mass))
    }
}

/// Load points farther away than this many outside diameters are slips of the unit.
const MAX_LOAD_POINT: f64 = 100.0;
/// A shaft beyond this is a slip of the unit, kg.
const MAX_MASS: f64 = 1e6;
/// The same of moments of inertia, kg m^2.
const MAX_INERTIA: f64 = 1e6;

impl RawShaft {
    /// Checks prescribed values, against the size of the bearing when that is sound.
    pub fn check(&self, bearing: Option<&Bearing>, clock: Clock, problems: &mut Problems) -> Shaft {
        let schedules = [
            self.x.schedule("shaft.x", clock, problems),
            self.y.schedule("shaft.y", clock, problems),
            self.z.schedule("shaft.z", clock, problems),
            self.tilt_x.schedule("shaft.tilt_x", clock, problems),
            self.tilt_y.schedule("shaft.tilt_y", clock, problems),
        ];
        let lengths = [("shaft.x", &self.x), ("shaft.y", &self.y), ("shaft.z", &self.z)];
        for ((key, motion), schedule) in lengths.into_iter().zip(&schedules) {
            if let Some(ball_diameter) = bearing.map(|b| b.ball_diameter) {
                let rule = "a prescribed displacement must be less than a ball radius";
                motion.require_small(0.5 * ball_diameter, key, schedule, rule, problems);
            }
        }
        let tilts = [("shaft.tilt_x", &self.tilt_x), ("shaft.tilt_y", &self.tilt_y)];
        for ((key, motion), schedule) in tilts.into_iter().zip(&schedules[3..]) {
            let rule = "a prescribed tilt must be small, at most 55 mrad";
            motion.require_small(MAX_TILT, key, schedule, rule, problems);
        }
        problems.require(
            bearing.is_none_or(|b| self.load_point.si().abs() <= MAX_LOAD_POINT * b.outside_diameter),
            "shaft.load_point",
            &self.load_point,
            "that is more than 100 outside diameters from the bearing, check its unit",
        );
        if let Some(mass) = &self.mass {
            let rule = "expected 0 to 1e6 kg, what turns with the inner ring beside the ring itself";
            problems.require((0.0..=MAX_MASS).contains(&mass.si()), "shaft.mass", mass, rule);
        }
        Shaft {
            x: self.x.motion(),
            y: self.y.motion(),
            z: self.z.motion(),
            tilt_x: self.tilt_x.motion(),
            tilt_y: self.tilt_y.motion(),
            schedules,
            load_point: self.load_point.si(),
            mass: self.mass.as_ref().map_or(0.0, Quantity::si),
            inertia: self.inertia(problems),
        }
    }

    /// Moments of inertia of a body: none is negative, and the polar one is at most twice the other.
    fn inertia(&self, problems: &mut Problems) -> ShaftInertia {
        let [transverse, polar] = [&self.transverse_inertia, &self.polar_inertia];
        let keys = ["shaft.transverse_inertia", "shaft.polar_inertia"];
        for (key, value) in keys.into_iter().zip([transverse, polar]) {
            if let Some(value) = value {
                let rule =
                    "expected 0 to 1e6 kg m2, about the axis point in the plane of the inner groove centres";
                problems.require((0.0..=MAX_INERTIA).contains(&value.si()), key, value, rule);
            }
        }
        let inertia = ShaftInertia {
            transverse: transverse.as_ref().map_or(0.0, Quantity::si),
            polar: polar.as_ref().map_or(0.0, Quantity::si),
        };
        if inertia.transverse >= 0.0 && inertia.polar > 2.0 * inertia.transverse {
            problems.add(format!(
                "shaft.polar_inertia is {} kg m2 and shaft.transverse_inertia {} kg m2; no body has more than twice as \
                 much about its axis as across it",
                inertia.polar, inertia.transverse
            ));
        }
        inertia
    }
}

impl<const KIND: usize> RawMotion<KIND> {
    /// What it says of the motion.
    pub fn motion(&self) -> ShaftMotion {
        match self {
            RawMotion::Free => ShaftMotion::Free,
            RawMotion::Locked => ShaftMotion::Locked,
            RawMotion::Prescribed(prescribed) => ShaftMotion::Prescribed(prescribed.value.si()),
        }
    }

    /// Its factor over time.
    pub fn schedule(&self, key: &str, clock: Clock, problems: &mut Problems) -> Schedule {
        match self {
            RawMotion::Prescribed(p) => check_schedule(p.schedule.as_deref(), key, clock, problems),
            _ => Schedule::Constant,
        }
    }

    /// Whether it changes over time.
    pub fn has_schedule(&self) -> bool {
        matches!(self, RawMotion::Prescribed(prescribed) if prescribed.schedule.is_some())
    }

    /// Reports a prescribed motion that exceeds `limit` at the peak of its schedule.
    pub fn require_small(
        &self,
        limit: f64,
        key: &str,
        schedule: &Schedule,
        rule: &str,
        problems: &mut Problems,
    ) {
        let RawMotion::Prescribed(RawPrescribed { value, .. }) = self else {
            return;
        };
        let at_peak = match schedule {
            Schedule::Constant => "",
            _ => ", at the peak of its schedule too",
        };
        let small = value.si().abs() * schedule.peak() <= limit;
        problems.require(small, key, value, format!("{rule}{at_peak}"));
    }

    fn expected() -> String {
        format!("\"free\", \"locked\" or {}", Quantity::<KIND>::KIND.expected())
    }
}

impl<'de, const KIND: usize> Deserialize<'de> for RawMotion<KIND> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct MotionVisitor<const KIND: usize>;

        impl<'de, const KIND: usize> Visitor<'de> for MotionVisitor<KIND> {
            type Value = RawMotion<KIND>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(&RawMotion::<KIND>::expected())
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Self::Value, E> {
                let expected = RawMotion::<KIND>::expected();
                let starts_as_word = text.chars().next().is_none_or(char::is_alphabetic);
                match text {
                    "free" => Ok(RawMotion::Free),
                    "locked" => Ok(RawMotion::Locked),
                    _ if starts_as_word => Err(E::custom(format!(
                        "{text:?} is no state of a shaft motion; expected {expected}"
                    ))),
                    _ => Quantity::parse_expecting(text, &expected)
                        .map(|value| {
                            RawMotion::Prescribed(RawPrescribed {
                                value,
                                schedule: None,
                            })
                        })
                        .map_err(E::custom),
                }
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
                Err(E::custom(bare_number(value, &RawMotion::<KIND>::expected())))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
                Err(E::custom(bare_number(value, &RawMotion::<KIND>::expected())))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                RawPrescribed::deserialize(MapAccessDeserializer::new(map)).map(RawMotion::Prescribed)
            }
        }

        deserializer.deserialize_any(MotionVisitor)
    }
}
