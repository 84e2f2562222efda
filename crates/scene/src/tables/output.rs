//! ```toml
#![doc = include_str!("example_output.toml")]
//! ```
//! `[output]`: what is written, and how exactly.

mod context;
mod every;
mod reduction;
mod region;

use input::{Problems, Quantity, STRESS};
use serde::Deserialize;

pub use self::context::OutputContext;
pub use self::every::{Every, KeptFields};
pub use self::reduction::{CycleDamage, DamageNodes, DamageStress, OutputReduction};
pub use self::region::OutputRegion;

use self::context::MAX_EVERY;
use self::every::RawEvery;
use self::reduction::RawReduction;
use self::region::RawRegion;

/// As typed.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [output]")]
pub struct RawOutput {
    stress: Option<StressOutput>,
    precision: Option<FieldPrecision>,
    stress_error: Option<Quantity<STRESS>>,
    displacement: Option<FieldPrecision>,
    restart_every: Option<i64>,
    compression: Option<i64>,
    tables_every: Option<i64>,
    inner_ring: Option<RingFrame>,
    outer_ring: Option<RingFrame>,
    every: Option<RawEvery>,
    region: Option<RawRegion>,
    reduction: Option<RawReduction>,
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
pub enum FieldPrecision {
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutputSettings {
    /// Stress fields.
    pub stress: StressOutput,
    /// Size of stress; the state itself is always written in 64 bits.
    pub precision: FieldPrecision,
    /// Largest error with which stress may be written, Pa; None writes it as its precision has it.
    pub stress_error: Option<f64>,
    /// Size of displacements.
    pub displacement: FieldPrecision,
    /// Step files from one with a restart state to the next, at least 1; the first and the last one have it besides.
    pub restart_every: u64,
    /// Level of deflate, 0 (none) to 9.
    pub compression: u8,
    /// Steps from one row of the tables to the next, at least 1; steps with fields have theirs besides.
    pub tables_every: u64,
    /// Where turning rings are shown, inner first.
    pub rings: [RingFrame; 2],
    /// Fields that only some step files hold.
    pub every: Every,
    /// Where fields are kept; None keeps them everywhere.
    pub region: Option<OutputRegion>,
    /// What is found of stress while the run goes on.
    pub reduction: Option<OutputReduction>,
}

/// Least error of stress, Pa, by precision: with f32, stress up to 17 GPa is rounded by this alone.
const LEAST_ERROR: [(FieldPrecision, f64, &str); 2] = [
    (
        FieldPrecision::F32,
        1e3,
        "expected at least 1 kPa; precision = \"f64\" allows 1 Pa",
    ),
    (FieldPrecision::F64, 1.0, "expected at least 1 Pa"),
];

impl RawOutput {
    /// Checks ranges and fills in defaults.
    pub fn check(&self, context: OutputContext, problems: &mut Problems) -> OutputSettings {
        self.require_use(context, problems);
        let context = OutputContext {
            has_stress: self.stress != Some(StressOutput::None),
            ..context
        };
        let every = self.every.as_ref();
        let tables_every = self.tables_every.unwrap_or(1);
        let level = problems.whole(self.compression.unwrap_or(0), "output.compression", 0, 9);
        let restart_every = self.restart_every.unwrap_or(1);
        let precision = self.precision.unwrap_or(FieldPrecision::F32);
        OutputSettings {
            stress: self.stress.unwrap_or(StressOutput::Nodal),
            precision,
            stress_error: self.check_stress_error(precision, problems),
            displacement: self.displacement.unwrap_or(FieldPrecision::F64),
            restart_every: problems.whole(restart_every, "output.restart_every", 1, MAX_EVERY) as u64,
            compression: level as u8,
            tables_every: problems.whole(tables_every, "output.tables_every", 1, MAX_EVERY) as u64,
            rings: [self.inner_ring, self.outer_ring].map(|frame| frame.unwrap_or(RingFrame::Space)),
            every: every.map_or(Every::default(), |every| every.check(context, problems)),
            region: self.region.as_ref().map(|region| region.check(context, problems)),
            reduction: self
                .reduction
                .as_ref()
                .map(|asked| asked.check(context, problems)),
        }
    }

    /// Refuses keys that would do nothing, or lose what nothing else keeps.
    fn require_use(&self, context: OutputContext, problems: &mut Problems) {
        if self.tables_every.is_some() && !context.has_steps {
            problems.add(
                "output.tables_every does nothing without steps in time, [dynamic] or [quasi_static]; remove it",
            );
        }
        if self.restart_every.is_some() && !context.is_motion {
            problems.add(
                "output.restart_every does nothing without a motion, [dynamic]: equilibria over time have a restart \
                 state in every step file; remove it",
            );
        }
        if self.displacement == Some(FieldPrecision::F32) && !context.is_motion {
            problems.add(
                "output.displacement is \"f32\"; expected \"f64\" without a motion, [dynamic], whose state holds it \
                 exactly",
            );
        }
    }

    fn check_stress_error(&self, precision: FieldPrecision, problems: &mut Problems) -> Option<f64> {
        const KEY: &str = "output.stress_error";
        let error = self.stress_error.as_ref()?;
        if self.stress == Some(StressOutput::None) {
            problems.add("output.stress_error does nothing with output.stress = \"none\"; remove it");
        }
        let least = LEAST_ERROR.iter().find(|(known, ..)| *known == precision);
        let &(_, least, rule) = least.expect("every precision has its least error");
        problems.require(error.si() >= least, KEY, error, rule);
        problems.require(error.si() <= MOST_ERROR, KEY, error, "expected at most 100 MPa");
        Some(error.si())
    }
}

/// A larger error of stress, Pa, leaves nothing to look at.
const MOST_ERROR: f64 = 1e8;
