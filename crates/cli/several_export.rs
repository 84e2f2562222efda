//! `raceway export` of the folder of a list of bearings: each step as parts in the frame of the shaft.
//!
//! The files of the parts are in `step_NNNNNN/`: VTU, with `step_NNNNNN.vtm` that names them as blocks and `run.pvd`
//! with the times, or tables, another for stress at integration points.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use checkpoint::{CheckpointError, StepRecord, all_steps, read_any_step, read_mesh};
use results::export::list::{BearingBodies, Owner, ShownGrid, ShownList};
use results::export::multiblock::{self, DataBlock};
use results::export::{csv, integration_points, vtu};
use results::failure::Failure;
use results::whole::{make_folder, make_output_folder, write_new};

use crate::export::{Export, ExportForm, TIMES, require_free_steps, require_same_mesh};

/// Writes the steps asked for; existing files are not touched.
pub fn export(request: &Export) -> Result<(), Failure> {
    let list = ShownList::read(&request.dir)?;
    let folders: Vec<(String, PathBuf)> = list
        .names()
        .map(|name| (name.to_string(), request.dir.join(name)))
        .collect();
    let steps = common_steps(&folders, request)?;
    let (mut grids, mut bearings) = (Vec::new(), Vec::new());
    for (number, (_, folder)) in folders.iter().enumerate() {
        let grid = read_mesh(folder)?;
        // All bearings have steps, as was looked at.
        let first = read_any_step(folder, all_steps(folder)?[0])?;
        bearings.push(list.parts_of(number, &grid, &first)?);
        grids.push(grid);
    }
    let out = request.folder();
    make_output_folder(request.out.as_deref(), &out)?;
    require_free_steps(&out, &steps, request.to, files_of_step)?;
    let mut names = Vec::new();
    for step in steps {
        let mut records = Vec::new();
        for ((_, folder), grid) in folders.iter().zip(&grids) {
            let record = read_any_step(folder, step)?;
            require_same_mesh(grid, &record)?;
            records.push(record);
        }
        let time = common_time(&folders, &records)?;
        let files = StepFiles::new(&out, (step, time), request.to);
        write_step((&list, &bearings), &records, &files)?;
        names.push((format!("step_{step:06}.vtm"), time));
    }
    if request.to == ExportForm::Vtu {
        write_new(&out.join(TIMES), |file| vtu::write_collection(file, &names))?;
    }
    request.say_written(names.len());
    Ok(())
}

/// The steps asked for, which all bearings must have.
fn common_steps(folders: &[(String, PathBuf)], request: &Export) -> Result<Vec<u64>, Failure> {
    let mut of_bearings = Vec::new();
    for (name, folder) in folders {
        if !folder.is_dir() {
            return Err(anyhow!(
                "the folder {} of the bearing {name:?} is not there; expected the results of all bearings of {}",
                folder.display(),
                request.dir.display()
            )
            .into());
        }
        let steps = all_steps(folder)?;
        if steps.is_empty() {
            return Err(CheckpointError::NoSteps { path: folder.clone() }.into());
        }
        of_bearings.push(steps);
    }
    let mut all = of_bearings.concat();
    all.sort_unstable();
    all.dedup();
    let chosen = request.chosen(&all)?;
    let in_all = |step: &u64| of_bearings.iter().all(|steps| steps.contains(step));
    let Some(step) = chosen.iter().find(|step| !in_all(step)) else {
        return Ok(chosen);
    };
    let bearing_with = |has: bool| {
        let found = of_bearings.iter().position(|steps| steps.contains(step) == has);
        found.map_or("", |i| folders[i].0.as_str())
    };
    let common: Vec<u64> = all.iter().copied().filter(in_all).collect();
    let expected = match common[..] {
        [] => "there is no step that all bearings have".to_string(),
        [first, ..] => format!(
            "expected steps of all bearings, which have {} from {first} to {}; choose some with --steps",
            common.len(),
            common[common.len() - 1]
        ),
    };
    Err(anyhow!(
        "step {step} of {} is there for the bearing {:?} and not for {:?}; {expected}",
        request.dir.display(),
        bearing_with(true),
        bearing_with(false)
    )
    .into())
}

/// What is written of a step: a folder of its parts, and in VTK's formats the file that names them.
fn files_of_step(step: u64, form: ExportForm) -> Vec<String> {
    let folder = format!("step_{step:06}");
    match form {
        ExportForm::Csv => vec![folder],
        ExportForm::Vtu => vec![folder.clone(), format!("{folder}.vtm")],
    }
}

/// The files of a step.
struct StepFiles<'a> {
    out: &'a Path,
    /// Name of its folder there.
    stem: String,
    time: f64,
    form: ExportForm,
}

impl<'a> StepFiles<'a> {
    fn new(out: &'a Path, (step, time): (u64, f64), form: ExportForm) -> StepFiles<'a> {
        StepFiles {
            out,
            stem: format!("step_{step:06}"),
            time,
            form,
        }
    }

    /// Writes a part, and returns the path of its file.
    fn write(&self, name: &str, shown: &ShownGrid) -> anyhow::Result<String> {
        let path = format!("{}/{name}.{}", self.stem, self.form.extension());
        let [points, cells] = shown.fields();
        match self.form {
            ExportForm::Vtu => write_new(&self.out.join(&path), |file| {
                vtu::write_fields(file, self.time, &shown.grid, [&points, &cells])
            })?,
            ExportForm::Csv => {
                write_new(&self.out.join(&path), |file| {
                    csv::write_fields(file, &shown.grid, &points)
                })?;
                let stress = cells.iter().find(|(name, ..)| *name == integration_points::FIELD);
                if let Some((_, n, values)) = stress {
                    let path = format!("{}/{name}_integration_points.csv", self.stem);
                    write_new(&self.out.join(path), |file| {
                        integration_points::write_rows(file, &shown.grid, (*n, values))
                    })?;
                }
            }
        }
        Ok(path)
    }
}

/// The time of a step, which is the same for all bearings, s.
fn common_time(folders: &[(String, PathBuf)], records: &[StepRecord]) -> Result<f64, Failure> {
    let first = &records[0];
    let other = records
        .iter()
        .zip(folders)
        .find(|(record, _)| record.time.to_bits() != first.time.to_bits());
    match other {
        None => Ok(first.time),
        Some((record, (_, folder))) => Err(anyhow!(
            "step {} of {} is at {:?} s, that of {} at {:?} s: they are of two runs",
            first.step,
            folders[0].1.display(),
            first.time,
            folder.display(),
            record.time
        )
        .into()),
    }
}

/// Writes the parts of a step, and then what names them as blocks.
fn write_step(
    (list, bearings): (&ShownList, &[BearingBodies]),
    records: &[StepRecord],
    files: &StepFiles<'_>,
) -> Result<(), Failure> {
    make_folder(&files.out.join(&files.stem))?;
    let (mut of_bearings, mut bodies) = (Vec::new(), Vec::new());
    for ((bearing, record), name) in bearings.iter().zip(records).zip(list.names()) {
        let mut own = Vec::new();
        for part in list.shown(bearing, record)? {
            match part.owner {
                Owner::Bearing => {
                    let path =
                        files.write(&format!("{name}_{}", part.name.replace(' ', "_")), &part.shown)?;
                    own.push(DataBlock::Leaf(part.name, path));
                }
                Owner::Body => {
                    let path = files.write(&format!("body_{}", bodies.len()), &part.shown)?;
                    bodies.push(DataBlock::Leaf(part.name, path));
                }
            }
        }
        of_bearings.push(DataBlock::Group(name.to_string(), own));
    }
    let shaft = DataBlock::Leaf(
        "shaft".to_string(),
        files.write("shaft", &list.shaft(records[0].step)?)?,
    );
    let mut blocks = vec![DataBlock::Group("bearings".to_string(), of_bearings)];
    if !bodies.is_empty() {
        blocks.push(DataBlock::Group("bodies".to_string(), bodies));
    }
    blocks.push(shaft);
    if files.form == ExportForm::Csv {
        return Ok(());
    }
    Ok(write_new(
        &files.out.join(format!("{}.vtm", files.stem)),
        |file| multiblock::write(file, &blocks),
    )?)
}
