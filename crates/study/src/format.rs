//! The text of a study: its tables as typed.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// The whole file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the tables of a study")]
pub struct RawStudy {
    pub title: Option<String>,
    pub scene: String,
    #[serde(default)]
    pub set: Vec<String>,
    pub repeats: Option<i64>,
    pub threads: Option<i64>,
    #[serde(default)]
    pub meshes: Meshes,
    #[serde(default)]
    pub cost: CostKind,
    pub axes: Vec<RawAxis>,
    #[serde(default)]
    pub exclude: Vec<BTreeMap<String, OneOrMany>>,
    pub quantities: Vec<RawQuantity>,
    pub signals: Option<RawSignals>,
}

/// Columns that are kept of every run.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [signals]")]
pub struct RawSignals {
    pub table: Option<String>,
    pub columns: Vec<String>,
}

/// Where the meshes of the points come from.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Meshes {
    /// They are there already.
    #[default]
    Given,
    /// Those that are missing are built from the sections of the scene.
    Build,
}

/// What is paid for a point, where one number has to say it.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum CostKind {
    /// Seconds from start to end.
    #[default]
    Wall,
    /// Seconds of all processors: less sensitive to other programs.
    Cpu,
    /// Largest resident memory, bytes.
    Memory,
    /// Bytes of all files of the run.
    Bytes,
}

/// One choice that a study varies.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [[axes]]")]
pub struct RawAxis {
    pub name: String,
    pub label: Option<String>,
    pub values: Vec<RawAxisValue>,
}

/// One value of an axis.
#[derive(Debug, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a value such as { name = \"fine\", set = [\"...\"] }"
)]
pub struct RawAxisValue {
    pub name: String,
    pub size: Option<f64>,
    #[serde(default)]
    pub set: Vec<String>,
}

/// A name or a list of names.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "a name of a value in quotes, or a list of them")]
pub enum OneOrMany {
    One(String),
    Many(Vec<String>),
}

impl OneOrMany {
    /// All names.
    pub fn names(&self) -> &[String] {
        match self {
            OneOrMany::One(name) => std::slice::from_ref(name),
            OneOrMany::Many(names) => names,
        }
    }
}

/// A number that every run gives.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [[quantities]]")]
pub struct RawQuantity {
    pub name: String,
    pub unit: String,
    pub summary: Option<String>,
    pub table: Option<String>,
    pub column: Option<String>,
    #[serde(default)]
    pub r#where: BTreeMap<String, Cell>,
    pub take: Option<Take>,
    pub scale: Option<f64>,
    pub reference: Option<RawReference>,
    pub optional: Option<bool>,
}

/// What a cell of a table has to be.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "a number or a text")]
pub enum Cell {
    /// A number.
    Number(f64),
    /// A word.
    Text(String),
}

/// How the rows of a column become one number.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Take {
    /// The last row.
    Final,
    /// The arithmetic mean.
    Mean,
    /// The largest.
    Max,
    /// The smallest.
    Min,
    /// Root of the mean square.
    Rms,
    /// Root of the mean square about the mean.
    Deviation,
    /// Largest less smallest.
    Range,
    /// Largest less smallest, over the mean.
    Ripple,
    /// All rows against those of the reference at the same times: the error is the RMS of the difference over the RMS
    /// of the reference, the number itself the RMS.
    History,
}

/// What the errors of a quantity are measured against; exactly one of `value`, `point` and `richardson`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a reference")]
pub struct RawReference {
    pub value: Option<f64>,
    pub source: Option<String>,
    pub point: Option<BTreeMap<String, String>>,
    pub richardson: Option<String>,
    #[serde(default)]
    pub at: BTreeMap<String, String>,
    pub uncertainty: Option<f64>,
}
