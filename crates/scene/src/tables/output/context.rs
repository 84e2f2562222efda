//! What the tables of `[output]` ask of the rest of the scene.

use input::Problems;

/// What a scene computes, as far as output depends on it.
#[derive(Clone, Copy, Debug)]
pub struct OutputContext {
    /// Whether it has steps in time.
    pub has_steps: bool,
    /// Whether it is a motion, whose step files hold a state to go on from.
    pub is_motion: bool,
    /// Whether it is a sweep.
    pub is_sweep: bool,
    /// Whether it is one equilibrium.
    pub is_static: bool,
    /// Flexible rings, inner first.
    pub flexible: [bool; 2],
    /// Whether it writes stress; to be left to `RawOutput::check`.
    pub has_stress: bool,
}

impl OutputContext {
    /// Refuses a table of `[output]` that needs a series of steps where there is none.
    pub fn require_series(&self, table: &str, problems: &mut Problems) {
        if !self.has_steps && !self.is_sweep {
            problems.add(format!(
                "[{table}] does nothing without a series of steps, [dynamic], [quasi_static] or [sweep]; remove it"
            ));
        }
    }
}

/// No run has more steps.
pub const MAX_EVERY: i64 = 100_000_000;
