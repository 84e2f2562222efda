//! `[output.every]`: fields that only some of the step files hold.

use input::Problems;
use serde::Deserialize;

use super::context::{MAX_EVERY, OutputContext};

/// As typed.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [output.every]")]
pub struct RawEvery {
    stress: Option<i64>,
    displacement: Option<i64>,
}

/// Step files from one with a field to the next, at least 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Every {
    /// With stress, at nodes or integration points.
    pub stress: u64,
    /// With displacement.
    pub displacement: u64,
}

/// The fields of a step file that the scene may leave out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeptFields {
    /// Whether it holds stress, if the scene asks for any.
    pub stress: bool,
    /// Whether it holds displacement.
    pub displacement: bool,
}

impl KeptFields {
    /// All fields.
    pub const ALL: KeptFields = KeptFields {
        stress: true,
        displacement: true,
    };
}

impl Default for Every {
    fn default() -> Every {
        Every {
            stress: 1,
            displacement: 1,
        }
    }
}

impl Every {
    /// What the file of a step holds: every n-th, counted from step 0, and that of the `last` step all. Files are
    /// `apart` steps from each other; one between them, of a run that was told to stop, leaves out what may be left.
    pub fn kept(self, step: u64, apart: u64, last: u64) -> KeptFields {
        let is_due =
            |every: u64| step == last || every == 1 || step.is_multiple_of(apart.saturating_mul(every));
        KeptFields {
            stress: is_due(self.stress),
            displacement: is_due(self.displacement),
        }
    }
}

impl RawEvery {
    /// Checks ranges and fills in defaults.
    pub fn check(&self, context: OutputContext, problems: &mut Problems) -> Every {
        context.require_series("output.every", problems);
        if self.stress.is_some() && !context.has_stress {
            problems.add("output.every.stress does nothing with output.stress = \"none\"; remove it");
        }
        let mut every =
            |value: Option<i64>, key: &str| problems.whole(value.unwrap_or(1), key, 1, MAX_EVERY) as u64;
        Every {
            stress: every(self.stress, "output.every.stress"),
            displacement: every(self.displacement, "output.every.displacement"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: other steps than every n-th file would hold a field, or the end of a run would lack it.
    #[test]
    fn every_nth_file_and_the_last_hold_a_field() {
        let every = Every {
            stress: 3,
            displacement: 1,
        };
        let with_stress: Vec<u64> = (0..=10)
            .map(|n| 5 * n)
            .filter(|&n| every.kept(n, 5, 50).stress)
            .collect();
        assert_eq!(with_stress, [0, 15, 30, 45, 50]);
        assert!((0..=50).all(|n| every.kept(n, 5, 50).displacement));
        assert!(!every.kept(7, 5, 50).stress);
    }
}
