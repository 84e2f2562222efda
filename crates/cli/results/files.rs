//! Everything that is written while a run goes on: tables, step files, and the seconds it takes.

use std::path::Path;
use std::time::Instant;

use checkpoint::{Compression, Output, Precision, StepRecord, Storage};
use dynamics::{Model, RingMemory, Timing};
use fem::StressRecovery;

use super::fields;
use super::probes::Probes;
use super::shown::Shown;
use super::snapshot::Snapshot;
use super::summary::Costs;
use super::tables::{ProbeTable, Tables};
use crate::failure::Failure;
use crate::scene::{self, Analysis, Scene};

/// The open files of one run.
pub struct Files {
    output: Output,
    tables: Tables,
    /// Probes and their table.
    probes: Option<(Probes, ProbeTable)>,
    /// Stress recovery of the flexible rings.
    pub recoveries: [Option<StressRecovery>; 2],
    stress_seconds: f64,
    output_seconds: f64,
}

impl Files {
    /// Creates the folder's files; `first` tells the columns.
    pub fn create(scene: &Scene, model: &Model, dir: &Path, first: &Snapshot) -> Result<Files, Failure> {
        let clock = Instant::now();
        let output = Output::create(dir, &fields::bodies(model), storage(scene))?;
        let tables = Tables::create(dir, swept_column(scene), first)?;
        let output_seconds = clock.elapsed().as_secs_f64();
        let recoveries = fields::recoveries(model, scene.output.stress)?;
        Ok(Files {
            output,
            tables,
            probes: None,
            recoveries,
            stress_seconds: 0.0,
            output_seconds,
        })
    }

    /// Creates the table of the probes, if the scene has any.
    pub fn add_probes(&mut self, scene: &Scene, dir: &Path, probes: Option<Probes>) -> Result<(), Failure> {
        if let Some(probes) = probes {
            let table = ProbeTable::create(dir, swept_column(scene), &probes.columns())?;
            self.probes = Some((probes, table));
        }
        Ok(())
    }

    /// Appends a line to the table of the probes.
    pub fn write_probes(
        &mut self,
        step: u64,
        time: f64,
        value: Option<f64>,
        shown: &Shown<'_>,
    ) -> Result<(), Failure> {
        let Some((probes, table)) = &mut self.probes else {
            return Ok(());
        };
        let clock = Instant::now();
        let values = probes.values(shown);
        self.stress_seconds += clock.elapsed().as_secs_f64();
        let clock = Instant::now();
        table.append(step, time, value, &values)?;
        self.output_seconds += clock.elapsed().as_secs_f64();
        Ok(())
    }

    /// Appends a line per table.
    pub fn write_tables(
        &mut self,
        step: u64,
        time: f64,
        value: Option<f64>,
        snapshot: &Snapshot,
    ) -> Result<(), Failure> {
        let clock = Instant::now();
        self.tables.append(step, time, value, snapshot)?;
        self.output_seconds += clock.elapsed().as_secs_f64();
        Ok(())
    }

    /// Makes a record of the fields and writes it as a step file.
    pub fn write_fields(
        &mut self,
        record: impl FnOnce(&[Option<StressRecovery>; 2]) -> StepRecord,
    ) -> Result<(), Failure> {
        let clock = Instant::now();
        let record = record(&self.recoveries);
        self.stress_seconds += clock.elapsed().as_secs_f64();
        let clock = Instant::now();
        self.output.write_step(&record)?;
        self.output_seconds += clock.elapsed().as_secs_f64();
        Ok(())
    }

    /// Closes the files and says what the run cost.
    pub fn finish(
        self,
        read: f64,
        forecast: [Option<RingMemory>; 2],
        solver: Timing,
        start: Instant,
    ) -> Result<Costs, Failure> {
        let clock = Instant::now();
        self.output.finish()?;
        Ok(Costs {
            read,
            stress: self.stress_seconds,
            output: self.output_seconds + clock.elapsed().as_secs_f64(),
            total: start.elapsed().as_secs_f64(),
            forecast,
            solver,
            probes: self
                .probes
                .map_or(Vec::new(), |(p, _)| p.places().cloned().collect()),
        })
    }
}

/// Name of the column of a swept value.
fn swept_column(scene: &Scene) -> Option<&str> {
    match &scene.analysis {
        Analysis::Sweep(sweep) => Some(sweep.column.as_str()),
        Analysis::Static | Analysis::QuasiStatic(_) | Analysis::Dynamic(_) => None,
    }
}

fn storage(scene: &Scene) -> Storage {
    Storage {
        stress: match scene.output.precision {
            scene::Precision::F32 => Precision::F32,
            scene::Precision::F64 => Precision::F64,
        },
        compression: match scene.output.compression {
            0 => Compression::None,
            level => Compression::Deflate(level),
        },
    }
}
