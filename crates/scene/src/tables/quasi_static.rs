//! ```toml
#![doc = include_str!("example_quasi_static.toml")]
//! ```
//! Equilibria in time, without inertia: the balls move round with the cage, the inner ring turns, loads follow their
//! time, and every instant is in equilibrium. Times are 0, step, 2 step, ... duration; fields are written every
//! `output_every`-th (default 1) and at the end.

use input::{Problems, Quantity, TIME};
use serde::Deserialize;

use super::steps::{output_every, whole_steps};

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [quasi_static]")]
pub struct RawQuasiStatic {
    duration: Quantity<TIME>,
    step: Quantity<TIME>,
    output_every: Option<i64>,
}

/// Equilibria in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuasiStatic {
    /// Run time from t = 0, s.
    pub duration: f64,
    /// From one equilibrium to the next, s.
    pub step: f64,
    /// Number of steps: duration / step.
    pub n_steps: u64,
    /// Steps from one field file to the next, at least 1.
    pub output_every: u64,
}

impl RawQuasiStatic {
    /// Checks that the step fits the duration; `None` when there are problems.
    pub fn check(&self, problems: &mut Problems) -> Option<QuasiStatic> {
        let before = problems.len();
        let n_steps = whole_steps("quasi_static", &self.duration, &self.step, problems);
        let output_every = output_every("quasi_static", self.output_every, problems);
        let quasi_static = QuasiStatic {
            duration: self.duration.si(),
            step: self.step.si(),
            n_steps: n_steps?,
            output_every,
        };
        (problems.len() == before).then_some(quasi_static)
    }
}
