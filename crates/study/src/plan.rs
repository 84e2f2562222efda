//! A checked study: its axes, its grid of points and its quantities.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use scene::{MeshFiles, Scene};

use super::format::{Cell, CostKind, Meshes, Take};

/// Most points of a study: more is a slip.
const MAX_POINTS: usize = 10_000;

/// A checked study.
#[derive(Debug)]
pub struct Plan {
    /// The study file.
    pub path: PathBuf,
    /// Free text for people.
    pub title: String,
    /// The scene that all points start from.
    pub scene: PathBuf,
    /// Its text.
    pub scene_text: String,
    /// How often every point is run, for the spread of its cost.
    pub repeats: usize,
    /// Threads of every run.
    pub threads: usize,
    /// Where meshes come from.
    pub meshes: Meshes,
    /// What counts as the price.
    pub cost: CostKind,
    /// What is varied.
    pub axes: Vec<StudyAxis>,
    /// The grid without the excluded combinations, the last axis running fastest.
    pub points: Vec<Point>,
    /// What is looked at.
    pub quantities: Vec<StudyQuantity>,
    /// What is kept of every run as a labelled set.
    pub signals: Option<Signals>,
}

/// What a study keeps of every run.
#[derive(Clone, Debug, PartialEq)]
pub struct Signals {
    /// Table of the runs.
    pub table: String,
    /// Its columns.
    pub columns: Vec<String>,
}

/// One choice that is varied.
#[derive(Clone, Debug)]
pub struct StudyAxis {
    /// Its name in the file.
    pub name: String,
    /// Its name for people.
    pub label: String,
    /// Its values.
    pub values: Vec<AxisValue>,
}

/// One value of an axis.
#[derive(Clone, Debug)]
pub struct AxisValue {
    /// Its name.
    pub name: String,
    /// Size of what is refined, in any unit: element size, step, tolerance. `None` where nothing is refined.
    pub size: Option<f64>,
    /// `--set` arguments, with placeholders.
    pub set: Vec<String>,
}

/// One combination of values.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Its number, from 0.
    pub index: usize,
    /// Index of its value on every axis, `[n_axes]`.
    pub at: Vec<usize>,
    /// `--set` arguments; `{out}` still stands for the folder of the study.
    pub set: Vec<String>,
}

/// A number that every run gives.
#[derive(Clone, Debug)]
pub struct StudyQuantity {
    /// Its name.
    pub name: String,
    /// Unit of the number, for people.
    pub unit: String,
    /// Where it stands.
    pub source: Source,
    /// What errors are divided by; the size of the reference when `None`.
    pub scale: Option<f64>,
    /// What errors are measured against; none are when `None`.
    pub reference: Option<Reference>,
    /// Whether points may be without it.
    pub is_optional: bool,
}

/// Where a number stands in the results of a run.
#[derive(Clone, Debug)]
pub enum Source {
    /// In `summary.json`, at a JSON pointer.
    Summary(String),
    /// In a table.
    Table {
        /// File name.
        file: String,
        /// Column.
        column: String,
        /// What other columns of a row have to be.
        rows: BTreeMap<String, Cell>,
        /// How the rows become one number.
        take: Take,
    },
}

/// What errors are measured against. Axes that a point does not fix follow the point that is judged.
#[derive(Clone, Debug)]
pub enum Reference {
    /// A number known otherwise.
    Value {
        /// The number, unit of the quantity.
        value: f64,
        /// Where it comes from.
        source: String,
        /// What it may be wrong by, unit of the quantity.
        uncertainty: f64,
    },
    /// Another point of the study.
    Point {
        /// Axes that are fixed: axis and value.
        fixed: Vec<(usize, usize)>,
        /// What it may be wrong by, unit of the quantity.
        uncertainty: f64,
    },
    /// What the points would give at size zero of an axis.
    Richardson {
        /// The axis.
        axis: usize,
        /// Other axes that are fixed.
        fixed: Vec<(usize, usize)>,
    },
}

impl Plan {
    /// Checks the scene of every point, before any is run.
    pub fn check_scenes(&self, out: &Path) -> anyhow::Result<()> {
        let files = match self.meshes {
            Meshes::Given => MeshFiles::MustExist,
            Meshes::Build => MeshFiles::MayBeMissing,
        };
        for point in &self.points {
            Scene::parse(&self.scene_text, &self.scene, &arguments(&point.set, out), files).with_context(
                || {
                    format!(
                        "point {} of {} ({}) is no valid scene; correct its values{}",
                        point.index,
                        self.path.display(),
                        self.name(point),
                        // Prices have a scene, and no file of a study.
                        match self.path == self.scene {
                            true => "",
                            false => " or name the combination in exclude",
                        }
                    )
                },
            )?;
        }
        Ok(())
    }

    /// The text of the scene with what it includes, where `set` may name other files to include.
    pub fn whole_scene(&self, set: &[String]) -> anyhow::Result<String> {
        Ok(scene::whole_text(&self.scene_text, &self.scene, set)?)
    }

    /// A point in words: `mesh = 90, element = hex8`.
    pub fn name(&self, point: &Point) -> String {
        let parts: Vec<String> = self
            .axes
            .iter()
            .zip(&point.at)
            .map(|(axis, &i)| format!("{} = {}", axis.name, axis.values[i].name))
            .collect();
        parts.join(", ")
    }

    /// The point at these values.
    pub fn point_at(&self, at: &[usize]) -> Option<&Point> {
        self.points.iter().find(|p| p.at == at)
    }

    /// The point with this number.
    pub fn point(&self, index: usize) -> anyhow::Result<&Point> {
        match self.points.get(index) {
            Some(point) => Ok(point),
            None => bail!(
                "{} has no point {index}; its points are 0 to {}",
                self.path.display(),
                self.points.len() - 1
            ),
        }
    }
}

/// `--set` arguments of a point in a study whose results are in `out`.
pub fn arguments(set: &[String], out: &Path) -> Vec<String> {
    let out = out.display().to_string();
    set.iter().map(|s| s.replace("{out}", &out)).collect()
}

/// All combinations of values, without those that are excluded.
pub fn grid(
    common: &[String],
    axes: &[StudyAxis],
    excluded: impl Fn(&[usize]) -> bool,
) -> anyhow::Result<Vec<Point>> {
    let n = axes
        .iter()
        .try_fold(1usize, |n, axis| n.checked_mul(axis.values.len()));
    let n = match n {
        Some(n) if n <= MAX_POINTS => n,
        _ => bail!("the axes make more than {MAX_POINTS} combinations; take fewer values or split the study"),
    };
    let mut points = Vec::new();
    for combination in 0..n {
        let mut rest = combination;
        let mut at = vec![0; axes.len()];
        for (i, axis) in axes.iter().enumerate().rev() {
            at[i] = rest % axis.values.len();
            rest /= axis.values.len();
        }
        if excluded(&at) {
            continue;
        }
        let own = axes.iter().zip(&at).flat_map(|(axis, &i)| &axis.values[i].set);
        let set = common.iter().chain(own).map(|s| fill(s, axes, &at)).collect();
        points.push(Point {
            index: points.len(),
            at,
            set,
        });
    }
    Ok(points)
}

/// Puts the names of the values for `{axis}`.
fn fill(text: &str, axes: &[StudyAxis], at: &[usize]) -> String {
    axes.iter().zip(at).fold(text.to_string(), |text, (axis, &i)| {
        text.replace(&format!("{{{}}}", axis.name), &axis.values[i].name)
    })
}
