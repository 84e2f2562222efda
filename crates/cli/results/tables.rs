//! Long tables of a run: `balls.csv`, `shaft.csv`, `energy.csv`, `probes.csv`. SI units in the column names.

use std::path::Path;

use anyhow::Context;
use dynamics::balls::{BallResult, ContactResult};

use super::snapshot::Snapshot;

/// The tables of one run, open for appending.
pub struct Tables {
    balls: csv::Writer<std::fs::File>,
    shaft: csv::Writer<std::fs::File>,
    energy: csv::Writer<std::fs::File>,
    /// Whether balls have a spin.
    with_spin: bool,
}

const REACTION_COLUMNS: [&str; 5] = [
    "reaction_x_n",
    "reaction_y_n",
    "reaction_z_n",
    "reaction_tilt_x_n_m",
    "reaction_tilt_y_n_m",
];

const CONTACT_COLUMNS: [&str; 6] = [
    "force_n",
    "contact_angle_rad",
    "approach_m",
    "semi_axis_groove_m",
    "semi_axis_rolling_m",
    "peak_pressure_pa",
];

impl Tables {
    /// Creates the files with the header lines of a first snapshot; `swept` is the column of a swept value. Balls have a
    /// spin if the first snapshot has one.
    pub fn create(dir: &Path, swept: Option<&str>, first: &Snapshot) -> anyhow::Result<Tables> {
        let head = |rest: &[String]| head(swept, rest);
        let names = |list: &[&str]| list.iter().map(|s| s.to_string()).collect::<Vec<_>>();
        let mut ball_columns = names(&[
            "ball",
            "azimuth_rad",
            "inner_force_n",
            "outer_force_n",
            "inner_contact_angle_rad",
            "outer_contact_angle_rad",
        ]);
        for side in ["inner", "outer"] {
            ball_columns.extend(CONTACT_COLUMNS[2..].iter().map(|c| format!("{side}_{c}")));
        }
        ball_columns.extend(names(&["displacement_radial_m", "displacement_axial_m"]));
        if first.spin.is_some() {
            ball_columns.push("spin_rad_per_s".to_string());
        }
        let mut shaft_columns = names(&["x_m", "y_m", "z_m", "tilt_x_rad", "tilt_y_rad"]);
        if first.reaction.is_some() {
            shaft_columns.extend(names(&REACTION_COLUMNS));
        }
        let energy_columns: Vec<String> = first
            .energies
            .iter()
            .map(|(term, _)| format!("{term}_j"))
            .collect();
        Ok(Tables {
            balls: open(dir, "balls.csv", &head(&ball_columns))?,
            shaft: open(dir, "shaft.csv", &head(&shaft_columns))?,
            energy: open(dir, "energy.csv", &head(&energy_columns))?,
            with_spin: first.spin.is_some(),
        })
    }

    /// Appends one step; `swept` is the swept value in SI.
    pub fn append(
        &mut self,
        step: u64,
        time: f64,
        swept: Option<f64>,
        snapshot: &Snapshot,
    ) -> anyhow::Result<()> {
        let head = place_of(step, time, swept);
        let row = |cells: Vec<String>| [head.clone(), cells].concat();
        let spin = snapshot.spin.filter(|_| self.with_spin).map(number);
        for (i, ball) in snapshot.balls.iter().enumerate() {
            let mut cells = ball_cells(i, ball);
            cells.extend(spin.clone());
            self.balls.write_record(row(cells))?;
        }
        let shaft = snapshot.shaft.iter().chain(snapshot.reaction.iter().flatten());
        self.shaft
            .write_record(row(shaft.map(|x| number(*x)).collect()))?;
        self.energy
            .write_record(row(snapshot.energies.iter().map(|(_, x)| number(*x)).collect()))?;
        for writer in [&mut self.balls, &mut self.shaft, &mut self.energy] {
            writer.flush().context("cannot write a table")?;
        }
        Ok(())
    }
}

/// The table of the probes, open for appending.
pub struct ProbeTable(csv::Writer<std::fs::File>);

impl ProbeTable {
    /// Creates the file with its header line; `swept` is the column of a swept value.
    pub fn create(dir: &Path, swept: Option<&str>, columns: &[String]) -> anyhow::Result<ProbeTable> {
        Ok(ProbeTable(open(dir, "probes.csv", &head(swept, columns))?))
    }

    /// Appends one step.
    pub fn append(&mut self, step: u64, time: f64, swept: Option<f64>, values: &[f64]) -> anyhow::Result<()> {
        let cells = values.iter().map(|x| number(*x)).collect();
        self.0
            .write_record([place_of(step, time, swept), cells].concat())?;
        self.0.flush().context("cannot write probes.csv")
    }
}

/// Header line: step, time, a swept value, and the rest.
fn head(swept: Option<&str>, rest: &[String]) -> Vec<String> {
    let mut columns = vec!["step".to_string(), "time_s".to_string()];
    columns.extend(swept.map(str::to_string));
    columns.extend(rest.iter().cloned());
    columns
}

/// The first cells of a row.
fn place_of(step: u64, time: f64, swept: Option<f64>) -> Vec<String> {
    let mut cells = vec![step.to_string(), number(time)];
    cells.extend(swept.map(number));
    cells
}

fn ball_cells(index: usize, ball: &BallResult) -> Vec<String> {
    let mut cells = vec![index.to_string(), number(ball.azimuth_rad)];
    cells.extend([ball.inner.force_n, ball.outer.force_n].map(number));
    cells.extend([ball.inner.contact_angle_rad, ball.outer.contact_angle_rad].map(number));
    for contact in [&ball.inner, &ball.outer] {
        cells.extend(rest_of(contact).map(number));
    }
    cells.extend([ball.displacement_m.radial, ball.displacement_m.axial].map(number));
    cells
}

fn rest_of(contact: &ContactResult) -> [f64; 4] {
    [
        contact.approach_m,
        contact.semi_axes_m[0],
        contact.semi_axes_m[1],
        contact.peak_pressure_pa,
    ]
}

/// Shortest text that reads back as the same number.
fn number(x: f64) -> String {
    format!("{x:?}")
}

fn open(dir: &Path, name: &str, columns: &[String]) -> anyhow::Result<csv::Writer<std::fs::File>> {
    let path = dir.join(name);
    let mut writer =
        csv::Writer::from_path(&path).with_context(|| format!("cannot create {}", path.display()))?;
    writer.write_record(columns)?;
    Ok(writer)
}
