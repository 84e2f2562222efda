//! `[output]`: what is written, and how exactly.

use input::Problems;
use serde::Deserialize;

/// As typed.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [output]")]
pub struct RawOutput {
    stress: Option<StressOutput>,
    precision: Option<Precision>,
    compression: Option<i64>,
    tables_every: Option<i64>,
    inner_ring: Option<RingFrame>,
    outer_ring: Option<RingFrame>,
}

/// Stress fields that are written.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum StressOutput {
    /// Averaged at nodes.
    Nodal,
    /// As computed, at the integration points of the elements.
    IntegrationPoints,
    /// None.
    None,
}

/// Floating-point size of fields that are not needed to resume a run.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Precision {
    /// 32 bits, seven digits.
    F32,
    /// 64 bits.
    F64,
}

/// Frame in which a turning ring is shown.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum RingFrame {
    /// As it stands in space: it turns, and the balls roll on it.
    Space,
    /// In its own frame: it stands still, so that its small displacements can be seen; the contacts run round it.
    OwnFrame,
}

/// What is written, and how exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Output {
    /// Stress fields.
    pub stress: StressOutput,
    /// Size of derived fields; the state itself is always written in 64 bits.
    pub precision: Precision,
    /// Level of deflate, 0 (none) to 9.
    pub compression: u8,
    /// Steps from one row of the tables to the next, at least 1; steps with fields have theirs besides.
    pub tables_every: u64,
    /// Where turning rings are shown, inner first.
    pub rings: [RingFrame; 2],
}

/// No run has more steps.
const MAX_EVERY: i64 = 100_000_000;

impl RawOutput {
    /// Checks ranges and fills in defaults; `has_steps` says whether the scene has steps in time.
    pub fn check(&self, has_steps: bool, problems: &mut Problems) -> Output {
        if self.tables_every.is_some() && !has_steps {
            problems.add(
                "output.tables_every does nothing without steps in time, [dynamic] or [quasi_static]; remove it",
            );
        }
        let tables_every = self.tables_every.unwrap_or(1);
        let level = problems.whole(self.compression.unwrap_or(0), "output.compression", 0, 9);
        Output {
            stress: self.stress.unwrap_or(StressOutput::Nodal),
            precision: self.precision.unwrap_or(Precision::F32),
            compression: level as u8,
            tables_every: problems.whole(tables_every, "output.tables_every", 1, MAX_EVERY) as u64,
            rings: [self.inner_ring, self.outer_ring].map(|frame| frame.unwrap_or(RingFrame::Space)),
        }
    }
}
