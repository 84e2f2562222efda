//! `raceway export`: steps as files for other tools, VTU for those that read VTK's XML formats, CSV for all others.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use anyhow::anyhow;
use checkpoint::{Grid, StepRecord, all_steps, read_any_step, read_mesh};
use clap::{Args, ValueEnum};
use comm::print;
use results::bodies::where_bodies_are;
use results::export::{csv, integration_points, vtu};
use results::failure::Failure;
use results::summary::{bodies_shown_in, read_summary, require_known_summary};
use results::whole::{make_output_folder, require_free, write_new};

/// File of the times of all steps.
pub const TIMES: &str = "run.pvd";

/// What the command line asks for.
#[derive(Debug, Args)]
pub struct Export {
    /// Folder of the results.
    pub dir: PathBuf,
    /// Steps: one such as 20, or a range such as 20..40 with both ends; default: all.
    #[arg(long, value_parser = parse_steps)]
    steps: Option<RangeInclusive<u64>>,
    /// Form of the files.
    #[arg(long)]
    pub to: ExportForm,
    /// Folder of the files; default: export in the folder of the results.
    #[arg(long)]
    pub out: Option<PathBuf>,
}

/// Form of the files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ExportForm {
    /// One table per step, a row per point: place, body, fields; another of stress at the integration points. Of a list
    /// of bearings a folder per step, with tables of all its parts in the frame of the shaft.
    Csv,
    /// One VTK XML file per step, and run.pvd with their times; of a list of bearings blocks in the frame of the shaft.
    Vtu,
}

impl ExportForm {
    /// Ending of the files.
    pub fn extension(self) -> &'static str {
        match self {
            ExportForm::Csv => "csv",
            ExportForm::Vtu => "vtu",
        }
    }
}

impl Export {
    /// Whether all bearings of a list are wanted together.
    pub fn is_of_list(&self) -> Result<bool, Failure> {
        Ok(!plot::bearings(&self.dir)?.is_empty())
    }

    /// Folder of the files.
    pub fn folder(&self) -> PathBuf {
        self.out.clone().unwrap_or_else(|| self.dir.join("export"))
    }

    /// Says how many steps were written.
    pub fn say_written(&self, n_steps: usize) {
        print::line(format_args!(
            "{} as {} in {}",
            print::counted(n_steps, "step"),
            self.to.extension(),
            self.folder().display()
        ));
        let summary = read_summary(&self.dir).unwrap_or_default();
        for line in where_bodies_are(&bodies_shown_in(&summary)) {
            print::line(format_args!("body {line}"));
        }
    }

    /// The committed steps that were asked for.
    pub fn chosen(&self, committed: &[u64]) -> Result<Vec<u64>, Failure> {
        require_known_summary(&self.dir)?;
        let (Some(first), Some(last)) = (committed.first(), committed.last()) else {
            return Err(checkpoint::CheckpointError::NoSteps {
                path: self.dir.clone(),
            }
            .into());
        };
        let range = |first: &u64, last: &u64| match first == last {
            true => first.to_string(),
            false => format!("from {first} to {last}"),
        };
        let wanted = self.steps.clone().unwrap_or(*first..=*last);
        let steps: Vec<u64> = committed
            .iter()
            .copied()
            .filter(|step| wanted.contains(step))
            .collect();
        if steps.is_empty() {
            return Err(anyhow!(
                "{} has no step {}; it has {}",
                self.dir.display(),
                range(wanted.start(), wanted.end()),
                match committed {
                    [only] => format!("step {only} alone"),
                    all => format!("{} steps {}", all.len(), range(first, last)),
                }
            )
            .into());
        }
        Ok(steps)
    }
}

/// Writes the steps of one bearing that were asked for; existing files are not touched.
pub fn export(request: &Export) -> Result<(), Failure> {
    let dir = &request.dir;
    plot::require_one_bearing(dir)?;
    let steps = request.chosen(&all_steps(dir)?)?;
    let grid = read_mesh(dir)?;
    let out = request.folder();
    make_output_folder(request.out.as_deref(), &out)?;
    require_free_steps(&out, &steps, request.to, files_of_step)?;
    let mut names = Vec::new();
    for step in steps {
        let record = read_any_step(dir, step)?;
        require_same_mesh(&grid, &record)?;
        let name = fields_file(step, request.to);
        let write = match request.to {
            ExportForm::Csv => csv::write,
            ExportForm::Vtu => vtu::write,
        };
        write_new(&out.join(&name), |file| write(file, &grid, &record))?;
        if let (ExportForm::Csv, Some(stress)) = (request.to, &record.cells.stress_integration_points) {
            let path = out.join(stress_file(step));
            write_new(&path, |file| integration_points::write(file, &grid, stress))?;
        }
        names.push((name, record.time));
    }
    if request.to == ExportForm::Vtu {
        write_new(&out.join(TIMES), |file| vtu::write_collection(file, &names))?;
    }
    request.say_written(names.len());
    Ok(())
}

fn fields_file(step: u64, form: ExportForm) -> String {
    format!("step_{step:06}.{}", form.extension())
}

/// As tables stress at integration points has one of its own.
fn stress_file(step: u64) -> String {
    format!("step_{step:06}_integration_points.csv")
}

fn files_of_step(step: u64, form: ExportForm) -> Vec<String> {
    match form {
        ExportForm::Csv => vec![fields_file(step, form), stress_file(step)],
        ExportForm::Vtu => vec![fields_file(step, form)],
    }
}

/// Fails if anything would be written over, before the first file is: what `of_step` names of each step, and the times.
pub fn require_free_steps(
    out: &Path,
    steps: &[u64],
    form: ExportForm,
    of_step: impl Fn(u64, ExportForm) -> Vec<String>,
) -> Result<(), Failure> {
    let mut names: Vec<String> = steps.iter().flat_map(|&step| of_step(step, form)).collect();
    if form == ExportForm::Vtu {
        names.push(TIMES.to_string());
    }
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    Ok(require_free(out, &names)?)
}

/// Fails unless the fields of a step are over the points and cells of a mesh.
pub fn require_same_mesh(grid: &Grid, record: &StepRecord) -> Result<(), Failure> {
    let rows = |arrays: Vec<(&str, usize, &[f64])>, kind, expected| {
        let found = arrays
            .iter()
            .map(|(_, n, values)| values.len() / n)
            .find(|&n| n != expected);
        found.map_or(Ok(()), |found| {
            Err(anyhow!(
                "step {} has {found} {kind}, mesh.hdf has {expected}",
                record.step
            ))
        })
    };
    rows(record.points.arrays(), "points", grid.points.len())?;
    rows(record.cells.arrays(), "cells", grid.types.len())?;
    Ok(())
}

fn parse_steps(text: &str) -> Result<RangeInclusive<u64>, String> {
    let number = |part: &str| {
        part.parse::<u64>().map_err(|_| {
            format!("{text:?} is no range of steps; expected one step such as 20 or both ends as in 20..40")
        })
    };
    let (first, last) = text.split_once("..").unwrap_or((text, text));
    let (first, last) = (number(first)?, number(last)?);
    if first > last {
        return Err(format!("the range {text} ends before it starts"));
    }
    Ok(first..=last)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: other steps than those asked for would be written.
    #[test]
    fn a_range_has_both_ends() {
        assert_eq!(parse_steps("20"), Ok(20..=20));
        assert_eq!(parse_steps("0..40"), Ok(0..=40));
        assert!(parse_steps("4..3").unwrap_err().contains("ends before it starts"));
        for bad in ["", "..", "3..", "a", "1-3", "-1"] {
            assert!(
                parse_steps(bad).unwrap_err().contains("is no range of steps"),
                "{bad}"
            );
        }
    }
}
