//! `[effects.contact_damping]` and `[effects.rayleigh_damping]`: losses of energy in motion.

use input::{DAMPING, LENGTH, Problems, Quantity, RATE, TIME};
use serde::Deserialize;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [effects.contact_damping]")]
pub struct RawContactDamping {
    coefficient: Quantity<DAMPING>,
    full_approach: Quantity<LENGTH>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [effects.rayleigh_damping]")]
pub struct RawRayleighDamping {
    mass: Quantity<RATE>,
    stiffness: Quantity<TIME>,
}

/// Damping of a contact along its normal; it grows with the approach up to `coefficient`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactDamping {
    /// Largest coefficient, N s/m.
    pub coefficient: f64,
    /// Approach at which it is reached, m.
    pub full_approach: f64,
}

/// Damping matrix of the rings C = mass M + stiffness K.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayleighDamping {
    /// Factor of the mass matrix, 1/s.
    pub mass: f64,
    /// Factor of the stiffness matrix, s.
    pub stiffness: f64,
}

/// Contacts approach by micrometres: more is a slip of the unit, m.
const MAX_FULL_APPROACH: f64 = 1e-3;

impl RawContactDamping {
    /// Checks signs and sizes.
    pub fn check(&self, problems: &mut Problems) -> ContactDamping {
        problems.require_positive(
            &self.coefficient,
            "effects.contact_damping.coefficient",
            "a damping",
        );
        let approach = self.full_approach.si();
        problems.require(
            approach > 0.0 && approach <= MAX_FULL_APPROACH,
            "effects.contact_damping.full_approach",
            &self.full_approach,
            "expected more than 0 and at most 1 mm, 1 um is usual",
        );
        ContactDamping {
            coefficient: self.coefficient.si(),
            full_approach: approach,
        }
    }
}

impl RawRayleighDamping {
    /// Checks signs.
    pub fn check(&self, problems: &mut Problems) -> RayleighDamping {
        let rule = "damping must not be negative, it would feed energy into the rings";
        problems.require(
            self.mass.si() >= 0.0,
            "effects.rayleigh_damping.mass",
            &self.mass,
            rule,
        );
        problems.require(
            self.stiffness.si() >= 0.0,
            "effects.rayleigh_damping.stiffness",
            &self.stiffness,
            rule,
        );
        RayleighDamping {
            mass: self.mass.si(),
            stiffness: self.stiffness.si(),
        }
    }
}
