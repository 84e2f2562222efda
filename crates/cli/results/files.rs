//! Everything that is written while a run goes on: tables, step files, and the seconds it takes.

use std::path::Path;
use std::time::Instant;

use checkpoint::{Compression, Output, Precision, StepRecord, Storage};
use dynamics::{Model, RingMemory, Timing};
use fem::StressRecovery;

use super::fields;
use super::snapshot::Snapshot;
use super::summary::Costs;
use super::tables::Tables;
use crate::failure::Failure;
use crate::scene::{self, Analysis, Scene};

/// The open files of one run.
pub struct Files {
    output: Output,
    tables: Tables,
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
        let swept = match &scene.analysis {
            Analysis::Sweep(sweep) => Some(sweep.column.as_str()),
            Analysis::Static | Analysis::Dynamic(_) | Analysis::Modes(_) => None,
        };
        let tables = Tables::create(dir, swept, first)?;
        let output_seconds = clock.elapsed().as_secs_f64();
        let recoveries = fields::recoveries(model, scene.output.stress)?;
        Ok(Files {
            output,
            tables,
            recoveries,
            stress_seconds: 0.0,
            output_seconds,
        })
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
        })
    }
}

/// How fields are stored.
pub fn storage(scene: &Scene) -> Storage {
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
