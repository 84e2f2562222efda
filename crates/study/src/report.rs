//! `study.json`: the table of a study, as written and as `raceway advise` reads it.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::Context;
use serde::{Deserialize, Serialize};

use super::format::CostKind;

/// Version of the file.
pub const SCHEMA: u32 = 1;

/// The whole file.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct StudyReport {
    /// Version of the file.
    pub schema: u32,
    /// Free text for people.
    pub title: String,
    /// The scene of all points, as the study has it.
    pub scene: String,
    /// The same from the folder of this file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scene_file: Option<String>,
    /// Day of the table, UTC.
    pub date: String,
    /// The machine that made the table.
    pub machine: String,
    /// Programs that ran the points; more than one makes times hard to compare.
    pub programs: Vec<String>,
    /// Threads of every run.
    pub threads: usize,
    /// Runs of every point.
    pub repeats: usize,
    /// What counts as the price in fronts.
    pub cost: CostKind,
    /// What was varied.
    pub axes: Vec<AxisReport>,
    /// What was looked at.
    pub quantities: Vec<QuantityReport>,
    /// Every point.
    pub points: Vec<PointReport>,
    /// Measured orders of convergence.
    pub orders: Vec<Order>,
}

/// One choice.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct AxisReport {
    /// Its name.
    pub name: String,
    /// Its name for people.
    pub label: String,
    /// Names of its values.
    pub values: Vec<String>,
    /// Sizes of its values; empty where nothing is refined.
    pub sizes: Vec<f64>,
}

/// One quantity.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct QuantityReport {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// What its errors are measured against, in words.
    pub reference: Option<String>,
}

/// One point.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct PointReport {
    /// Its number.
    pub index: usize,
    /// Names of its values by axis.
    pub values: BTreeMap<String, String>,
    /// Its `--set` arguments; `{out}` stands for the folder of the study.
    pub set: Vec<String>,
    /// `finished`, `failed` or `not run`.
    pub status: String,
    /// Why it failed.
    pub reason: Option<String>,
    /// What it cost; absent unless it finished.
    pub cost: Option<CostReport>,
    /// Steps in time, of a motion.
    pub steps: Option<f64>,
    /// What it gave, by quantity; those that could not be read are missing, with a reason.
    pub results: BTreeMap<String, ResultReport>,
    /// Quantities that could not be read, and why.
    pub unread: BTreeMap<String, String>,
}

/// What a point cost, over its repeats.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct CostReport {
    /// Seconds from start to end.
    pub wall_s: Spread,
    /// Seconds of all processors.
    pub cpu_s: Spread,
    /// Largest resident memory.
    pub peak_memory_bytes: f64,
    /// Size of all files.
    pub bytes_written: f64,
    /// Why times are not its own, a text per disturbed repeat.
    pub disturbed: Vec<String>,
}

/// Median and extremes.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct Spread {
    /// Median.
    pub median: f64,
    /// Smallest.
    pub min: f64,
    /// Largest.
    pub max: f64,
}

/// What a point gave for one quantity.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct ResultReport {
    /// The number, unit of the quantity.
    pub value: f64,
    /// The reference, unit of the quantity.
    pub reference: Option<f64>,
    /// |value - reference| over the scale.
    pub error: Option<f64>,
    /// What the error may be wrong by, over the same scale.
    pub uncertainty: Option<f64>,
    /// Whether this point is the reference.
    pub is_reference: bool,
    /// Whether no other point has both a smaller error and a lower cost.
    pub pareto: bool,
}

/// Order of convergence along an axis.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Order {
    /// The axis whose sizes are refined.
    pub axis: String,
    /// Values of the other axes.
    pub at: BTreeMap<String, String>,
    /// The quantity.
    pub quantity: String,
    /// Slope of log error over log size by least squares, over all points that count.
    pub order: f64,
    /// Slopes from point to point, from the largest size on.
    pub steps: Vec<f64>,
    /// Number of points: those whose error is above the uncertainty of the reference.
    pub n_points: usize,
}

impl CostReport {
    /// The price in one kind.
    pub fn of(&self, kind: CostKind) -> f64 {
        match kind {
            CostKind::Wall => self.wall_s.median,
            CostKind::Cpu => self.cpu_s.median,
            CostKind::Memory => self.peak_memory_bytes,
            CostKind::Bytes => self.bytes_written,
        }
    }
}

impl CostKind {
    /// Itself if it is a time, else wall time.
    pub fn seconds(self) -> CostKind {
        match self {
            CostKind::Cpu => CostKind::Cpu,
            _ => CostKind::Wall,
        }
    }

    /// In words, with its unit.
    pub fn label(self) -> &'static str {
        match self {
            CostKind::Wall => "wall time, s",
            CostKind::Cpu => "processor time, s",
            CostKind::Memory => "peak memory, bytes",
            CostKind::Bytes => "bytes written",
        }
    }
}

impl StudyReport {
    /// Reads a file that a study wrote.
    pub fn load(path: &Path) -> anyhow::Result<StudyReport> {
        let text =
            std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
        let report: StudyReport = serde_json::from_str(&text).with_context(|| {
            format!(
                "{} is no table of a study; expected the study.json of raceway study",
                path.display()
            )
        })?;
        anyhow::ensure!(
            report.schema == SCHEMA,
            "{} has schema {}; this program reads {SCHEMA}",
            path.display(),
            report.schema
        );
        Ok(report)
    }
}
