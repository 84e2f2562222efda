//! `[dynamic.start]`: the state at t = 0. Without the table it is static equilibrium under the loads and the speed of
//! t = 0.

use input::{ANGLE, ANGULAR_SPEED, LENGTH, Problems, Quantity, SPEED};
use serde::Deserialize;

use super::shaft::{Shaft, ShaftMotion};

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [dynamic.start]")]
pub struct RawStart {
    rolling: Option<RawRolling>,
    free: Option<RawFree>,
    given: Option<RawGiven>,
}

/// As typed: the table has no keys.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the empty table [dynamic.start.free]")]
struct RawFree {}

/// As typed: the table has no keys.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the empty table [dynamic.start.rolling]")]
struct RawRolling {}

/// As typed; what is not given is zero.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [dynamic.start.given]")]
struct RawGiven {
    x: Option<Quantity<LENGTH>>,
    y: Option<Quantity<LENGTH>>,
    z: Option<Quantity<LENGTH>>,
    tilt_x: Option<Quantity<ANGLE>>,
    tilt_y: Option<Quantity<ANGLE>>,
    velocity_x: Option<Quantity<SPEED>>,
    velocity_y: Option<Quantity<SPEED>>,
    velocity_z: Option<Quantity<SPEED>>,
    velocity_tilt_x: Option<Quantity<ANGULAR_SPEED>>,
    velocity_tilt_y: Option<Quantity<ANGULAR_SPEED>>,
}

/// The state at t = 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Start {
    /// Static equilibrium under the loads and the speed at t = 0.
    #[default]
    Static,
    /// The same, with the velocities at which equilibria follow each other while the bearing rolls, and the inertia of
    /// balls on their orbits.
    Rolling,
    /// Undeformed bodies; the shaft with the inner ring at this displacement and velocity, m, rad, m/s, rad/s; balls
    /// at their just-touching position, at rest.
    Given {
        /// Shaft x, y, z, tilt x, tilt y.
        displacement: [f64; 5],
        /// Their velocities.
        velocity: [f64; 5],
    },
}

impl RawStart {
    /// Whether it is an equilibrium of a bearing that rolls.
    pub fn is_rolling(&self) -> bool {
        self.rolling.is_some()
    }

    /// Checks that at most one way to start is there, and that what is given is free to move.
    pub fn check(&self, shaft: &Shaft, problems: &mut Problems) -> Start {
        let undeformed = Start::Given {
            displacement: [0.0; 5],
            velocity: [0.0; 5],
        };
        let tables = [
            ("rolling", self.rolling.is_some()),
            ("free", self.free.is_some()),
            ("given", self.given.is_some()),
        ];
        let named: Vec<&str> = tables
            .iter()
            .filter(|(_, has)| *has)
            .map(|(name, _)| *name)
            .collect();
        if named.len() > 1 {
            problems.add(format!(
                "[dynamic.start] has {}; expected one of them, or none for static equilibrium",
                named.join(" and ")
            ));
            return Start::Static;
        }
        match (&self.rolling, &self.free, &self.given) {
            (Some(RawRolling {}), ..) => Start::Rolling,
            (_, Some(RawFree {}), _) => undeformed,
            (.., Some(given)) => given.check(shaft, problems),
            (None, None, None) => Start::Static,
        }
    }
}

impl RawGiven {
    fn check(&self, shaft: &Shaft, problems: &mut Problems) -> Start {
        fn si<const KIND: usize>(value: &Option<Quantity<KIND>>) -> Option<f64> {
            value.as_ref().map(Quantity::si)
        }
        let displacement = [
            si(&self.x),
            si(&self.y),
            si(&self.z),
            si(&self.tilt_x),
            si(&self.tilt_y),
        ];
        let velocity = [
            si(&self.velocity_x),
            si(&self.velocity_y),
            si(&self.velocity_z),
            si(&self.velocity_tilt_x),
            si(&self.velocity_tilt_y),
        ];
        let dofs = [
            ("x", shaft.x),
            ("y", shaft.y),
            ("z", shaft.z),
            ("tilt_x", shaft.tilt_x),
            ("tilt_y", shaft.tilt_y),
        ];
        for ((name, motion), (q, v)) in dofs.into_iter().zip(displacement.iter().zip(&velocity)) {
            if motion != ShaftMotion::Free && (q.is_some() || v.is_some()) {
                problems.add(format!(
                    "[dynamic.start.given] moves {name}, which shaft.{name} does not leave free; remove it there or \
                     set shaft.{name} = \"free\""
                ));
            }
        }
        Start::Given {
            displacement: displacement.map(Option::unwrap_or_default),
            velocity: velocity.map(Option::unwrap_or_default),
        }
    }
}
