//! A signal: a column of a table of a motion, with equal steps, within a span of time.

use std::path::Path;

use anyhow::{anyhow, ensure};
use plot::{AxisUnit, quantity};
use results::table::Table;

use crate::fourier;

/// Fewest samples of a spectrum.
const LEAST_SAMPLES: usize = 16;
/// Largest deviation of a step from the mean one.
const UNEQUAL: f64 = 1e-6;
/// Tables with signals.
const TABLES: [&str; 2] = ["probes.csv", "shaft.csv"];

/// A signal of equal steps.
#[derive(Clone, Debug)]
pub struct Signal {
    /// What it is, without its unit.
    pub name: String,
    /// Unit as it ends names of columns.
    pub ending: String,
    /// How it is shown.
    pub unit: AxisUnit,
    /// SI.
    pub values: Vec<f64>,
    /// Angle of the tachometer at every sample, rad; None without one.
    pub angles: Option<Vec<f64>>,
    /// Samples a second.
    pub rate: f64,
    /// First and last time that count, s.
    pub span: (f64, f64),
    /// Time of the first sample, s.
    pub start: f64,
}

impl Signal {
    /// A column of the run in `dir`, or the only one of a probe, within a span of time, s; with the angles of a
    /// tachometer if one is named.
    pub fn read(
        dir: &Path,
        probe: &str,
        tachometer: Option<&str>,
        [from, to]: [f64; 2],
    ) -> anyhow::Result<Signal> {
        let (table, column) = find(dir, probe, &TABLES)?;
        let all = table.column("time_s")?;
        let rows: Vec<usize> = (0..table.n_rows())
            .filter(|&row| (from..=to).contains(&all[row]))
            .collect();
        ensure!(
            rows.len() >= LEAST_SAMPLES,
            "there are {} steps from {from} s to {to} s; expected {LEAST_SAMPLES} at least",
            rows.len(),
        );
        let chosen = |column: &[f64]| rows.iter().map(|&row| column[row]).collect::<Vec<f64>>();
        let times = chosen(all);
        let angles = match tachometer {
            None => None,
            Some(name) => {
                let (tacho, column) = find(dir, name, &TABLES[..1])?;
                ensure!(
                    column.ends_with("_angle_rad"),
                    "{column} is no angle; --orders needs a tachometer, from [probes.tachometer.NAME] of a scene"
                );
                let all = tacho.column("time_s")?;
                let angles = tacho.column(&column)?;
                let at = |time: &f64| all.iter().position(|t| t == time).map(|row| angles[row]);
                let found: Option<Vec<f64>> = times.iter().map(at).collect();
                Some(found.ok_or_else(|| anyhow!("{column} lacks some of the steps of {probe}"))?)
            }
        };
        let (name, unit) = quantity::split(&column);
        Ok(Signal {
            name: name.to_string(),
            ending: column[name.len()..].trim_start_matches('_').to_string(),
            unit,
            values: chosen(table.column(&column)?),
            angles,
            rate: equal_rate(&times)?,
            span: (times[0], times[times.len() - 1]),
            start: times[0],
        })
    }

    /// Acceleration of a displacement, by second differences; the first and the last sample go.
    pub fn acceleration(self) -> anyhow::Result<Signal> {
        ensure!(
            self.ending == "m",
            "{}_{} is no displacement, in m; --acceleration needs one",
            self.name,
            self.ending
        );
        let n = self.values.len();
        let step = 1.0 / self.rate;
        Ok(Signal {
            name: format!("{}_acceleration", self.name),
            ending: "m_per_s2".to_string(),
            unit: quantity::split("a_m_per_s2").1,
            values: fourier::acceleration(&self.values, self.rate),
            angles: self.angles.as_ref().map(|angles| angles[1..n - 1].to_vec()),
            start: self.start + step,
            ..self
        })
    }

    /// Name of its column.
    pub fn column(&self) -> String {
        match self.ending.is_empty() {
            true => self.name.clone(),
            false => format!("{}_{}", self.name, self.ending),
        }
    }
}

/// The table that has a column, and its full name; a probe with only one column may go by its own name.
fn find(dir: &Path, wanted: &str, tables: &[&str]) -> anyhow::Result<(Table, String)> {
    let mut known = Vec::new();
    for name in tables {
        let Some(table) = Table::read(dir, name)? else {
            continue;
        };
        let names = table.names().iter();
        let columns: Vec<String> = names
            .filter(|n| !["step", "time_s"].contains(&n.as_str()))
            .cloned()
            .collect();
        if columns.iter().any(|column| column == wanted) {
            return Ok((table, wanted.to_string()));
        }
        let start = format!("{wanted}_");
        let of_probe: Vec<&String> = columns.iter().filter(|n| n.starts_with(&start)).collect();
        if let [column] = of_probe[..] {
            let column = column.clone();
            return Ok((table, column));
        }
        known.extend(if of_probe.is_empty() {
            columns
        } else {
            of_probe.into_iter().cloned().collect()
        });
    }
    Err(anyhow!(
        "{} has no signal {wanted:?}; expected a column of {}: {}",
        dir.display(),
        tables.join(" or "),
        if known.is_empty() {
            "there is none".to_string()
        } else {
            known.join(", ")
        }
    ))
}

/// Samples a second of instants that must be equally far apart.
pub fn equal_rate(times: &[f64]) -> anyhow::Result<f64> {
    let step = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    ensure!(step > 0.0, "the steps of the run have no time; expected a motion");
    let uneven = times
        .windows(2)
        .find(|t| (t[1] - t[0] - step).abs() > UNEQUAL * step);
    match uneven {
        Some(t) => Err(anyhow!(
            "the step from {} s to {} s is not like the others, {step:.6e} s; a spectrum needs equal steps",
            t[0],
            t[1]
        )),
        None => Ok(1.0 / step),
    }
}
