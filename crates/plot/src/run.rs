//! The results of a run as the figures need them.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use figure::Axis;

use super::quantity::{self, MILLISECOND};
use results::table::Table;

/// Forces of balls, a row for each at every step.
const BALLS: &str = "balls.csv";

/// Tables of a run, by the rows of which its figures and others are made.
const TABLES: [&str; 4] = [BALLS, "shaft.csv", "energy.csv", "probes.csv"];
/// Natural modes, a row for each.
const MODES: &str = "modes.csv";

/// Tables of a run and what its steps are.
pub struct Results {
    /// Folder.
    pub dir: PathBuf,
    /// `balls.csv`.
    pub balls: Option<Table>,
    /// `shaft.csv`.
    pub shaft: Option<Table>,
    /// `energy.csv`.
    pub energy: Option<Table>,
    /// `probes.csv`.
    pub probes: Option<Table>,
    /// What the steps are.
    pub steps: Steps,
}

/// What the steps of a run are.
#[derive(Clone, Debug, PartialEq)]
pub enum Steps {
    /// One equilibrium, or none.
    Single,
    /// Equilibria for values of the scene; the column that has them.
    Sweep(String),
    /// Instants.
    Times,
}

impl Results {
    /// Reads the tables in `dir`.
    pub fn read(dir: &Path) -> anyhow::Result<Results> {
        if !dir.is_dir() {
            return Err(anyhow!(
                "{} is no folder; expected the results of a run",
                dir.display()
            ));
        }
        let [balls, shaft, energy, probes] = TABLES.map(|name| Table::read(dir, name));
        let (balls, shaft, energy, probes) = (balls?, shaft?, energy?, probes?);
        // Tables of a run agree on what its steps are: the first that is there tells.
        let tables = [&balls, &shaft, &energy, &probes];
        let first = tables.into_iter().flatten().next();
        Ok(Results {
            dir: dir.to_path_buf(),
            steps: first.map_or(Ok(Steps::Single), steps)?,
            balls,
            shaft,
            energy,
            probes,
        })
    }

    /// Whether step files may show a load: those of natural modes hold shapes.
    pub fn may_show_loads(&self) -> bool {
        self.balls.is_some() || !self.dir.join(MODES).exists()
    }

    /// What the steps are plotted against: the axis, and its value for each row of `table`; none for a single step.
    pub fn against(&self, table: &Table) -> anyhow::Result<Option<(Axis, Vec<f64>)>> {
        match &self.steps {
            Steps::Single => Ok(None),
            Steps::Times => {
                let times = MILLISECOND.of(table.column("time_s")?);
                Ok(Some((MILLISECOND.axis("time").tight(), times)))
            }
            Steps::Sweep(column) => axis_of(table, column, "step").map(Some),
        }
    }

    /// What tells a step from others: the swept value or the time.
    pub fn name_of(&self, step: u64) -> anyhow::Result<String> {
        let Some(table) = self.balls.as_ref().or(self.shaft.as_ref()) else {
            return Ok(format!("step {step}"));
        };
        let row = table.column("step")?.iter().position(|s| *s == step as f64);
        Ok(match self.against(table)? {
            None => "equilibrium".into(),
            Some((axis, values)) => row.map_or_else(|| format!("step {step}"), |row| axis.value(values[row])),
        })
    }
}

/// Whether a folder has tables of a run: they are read without its other files, too.
pub fn has_tables(dir: &Path) -> bool {
    TABLES
        .into_iter()
        .chain([MODES])
        .any(|name| dir.join(name).exists())
}

/// The axis of the swept values in a column of a table, and the places of its rows on it. Words have no place on an
/// axis; then the points have their numbers, from the column `number`.
pub fn axis_of(table: &Table, column: &str, number: &str) -> anyhow::Result<(Axis, Vec<f64>)> {
    let (name, unit) = quantity::split(column);
    let values = unit.of(table.column(column)?);
    if values.iter().all(|v| v.is_nan()) {
        let axis = Axis::linear(format!("point of the sweep of {name}"), "1").ticks_every(1.0);
        return Ok((axis, table.column(number)?.to_vec()));
    }
    Ok((unit.axis(readable(name)), values))
}

/// The key of a scene without what a reader can tell from its other parts.
pub fn readable(key: &str) -> String {
    let key = key.strip_prefix("effects.").unwrap_or(key);
    let key = key.strip_suffix(".value").unwrap_or(key);
    key.replace(['_', '.'], " ")
}

/// The column of the swept value of the results in `dir`, by the head of a table; None where no steps are load cases.
pub fn swept_column(dir: &Path) -> anyhow::Result<Option<String>> {
    let path = dir.join(BALLS);
    if !path.exists() {
        return Ok(None);
    }
    let read = || csv::Reader::from_path(&path)?.headers().cloned();
    let head = read().with_context(|| format!("cannot read {}", path.display()))?;
    Ok(swept(head.get(2).unwrap_or_default()))
}

/// The swept value stands before the first column of a table's own: the ball, the place of the shaft, an energy.
fn swept(third: &str) -> Option<String> {
    let is_own = ["ball", "azimuth_rad", "x_m"].contains(&third) || third.ends_with("_j");
    (!is_own).then(|| third.to_string())
}

fn steps(table: &Table) -> anyhow::Result<Steps> {
    // Of columns of probes, which have names of the user's, one cannot tell whether the first is a swept value.
    let own = ["ball", "azimuth_rad", "x_m", "total_j"];
    if own.iter().any(|name| table.find(name).is_some())
        && let Some(column) = swept(table.names().get(2).map_or("", String::as_str))
    {
        return Ok(Steps::Sweep(column));
    }
    let steps = table.column("step")?;
    Ok(match steps.iter().any(|step| *step != steps[0]) {
        true => Steps::Times,
        false => Steps::Single,
    })
}
