//! ```toml
#![doc = include_str!("example_stress.toml")]
//! ```
//! How stress is computed, wherever it is written: step files, probes, profiles. [`contact::near_field`] says what
//! the near field is. Without it there is no cost, and stress within about two patches of a contact is that of a
//! force spread over elements.

use input::Problems;
use serde::Deserialize;

use dynamics::ContactMode;

/// As typed.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [stress]")]
pub struct RawStress {
    near_field: Option<bool>,
    near_field_reach: Option<f64>,
}

/// How stress is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stress {
    /// Reach of the near field in larger semi-axes of a patch; None without near field.
    pub near_field_reach: Option<f64>,
}

/// At four patches the two fields differ by less than 1 % of the patch's own stress; the weight has fallen to 0 there.
const DEFAULT_REACH: f64 = 4.0;

/// What the table is checked against.
#[derive(Clone, Copy, Debug)]
pub struct StressContext {
    /// Contact of balls and raceways.
    pub contact: ContactMode,
    /// The scene asks for natural modes.
    pub is_modes: bool,
}

impl RawStress {
    /// Checks ranges and fills in defaults.
    pub fn check(&self, context: StressContext, problems: &mut Problems) -> Stress {
        let reach = self.near_field_reach.unwrap_or(DEFAULT_REACH);
        problems.require(
            (1.0..=20.0).contains(&reach),
            "stress.near_field_reach",
            reach,
            "expected 1 to 20 semi-axes of the contact patch",
        );
        if !self.near_field.unwrap_or(false) {
            if self.near_field_reach.is_some() {
                problems.add(
                    "stress.near_field_reach is given without near_field = true; add it or remove the reach",
                );
            }
            return Stress::default();
        }
        if context.contact != ContactMode::Patch {
            problems.add(
                "stress.near_field replaces the stress of a contact patch, which only contact.mode = \"patch\" has; \
                 use that mode or remove near_field",
            );
        }
        if context.is_modes {
            problems.add("stress.near_field needs contact forces, and [modes] has none; remove near_field");
        }
        Stress {
            near_field_reach: Some(reach),
        }
    }
}
