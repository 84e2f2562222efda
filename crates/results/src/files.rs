//! Everything that is written while a run goes on: tables, step files, and the seconds it takes.
//!
//! Step files are written by threads of their own; the run only waits when they have `QUEUE` steps besides those that
//! they work at.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use checkpoint::{
    BackgroundOutput, CheckpointError, Compression, ErrorBound, FolderLock, Made, MeshFile, Output,
    Precision, Stamps, StepRecord, Storage,
};
use comm::{Communicator, print};
use dynamics::Model;
use scene::{Analysis, KeptFields, Scene};
use timer::{Laps, Stopwatch};

use super::about::{about, identity};
use super::answer;
use super::fields;
use super::film::FilmLaw;
use super::folder;
use super::log;
use super::memory::{Forecasts, QUEUE};
use super::motion_fields::RestartState;
use super::probes::PlacedProbes;
use super::reduction::{REDUCTION_FILE, ReducedStress, StressReduction};
use super::region::Region;
use super::ring_stress::{Gathered, RingStress};
use super::shown::Shown;
use super::snapshot::Snapshot;
use super::state_arrays::Arrays;
use super::summary::{Costs, DISK, DISK_WAIT, GATHER, NEAR_FIELD, OUTPUT, READ, REDUCTION, STRESS, TOTAL};
use super::tables::{OwnColumns, Tables};
use crate::failure::Failure;
use crate::survey::Survey;

/// The files of one run. Rank 0 writes for all; on the others there are none, and writing does nothing. The stress of
/// rings in sectors is recovered by all ranks.
pub struct Files {
    open: Option<Open>,
    /// Stress of the rings, shared with the thread that writes.
    ring_stress: Arc<RingStress>,
    /// That of which extremes are found, if the scene asks for them.
    reduced: Option<ReducedStress>,
    /// Laps of this thread since the files were opened.
    laps: Laps,
}

/// The step from which a run goes on.
pub struct ResumedFrom<'a> {
    /// Its number.
    pub step: u64,
    /// What its file tells of the tables; None if it is of a version that kept no checksums of them.
    pub tables: Option<&'a Stamps>,
    /// Warnings of the start of the run.
    pub warnings: &'a [String],
    /// What it holds of `[output.reduction]`.
    pub reduction: &'a Arrays,
}

/// The open files of one run.
struct Open {
    output: BackgroundOutput,
    tables: Tables,
    probes: Option<PlacedProbes>,
    region: Option<Arc<Region>>,
    reduction: Option<StressReduction>,
}

impl Files {
    /// Creates the folder's files, and says where they are; `first` tells the columns, `warnings` are those of the
    /// start. Collective.
    pub fn create(
        scene: &Scene,
        model: &Model,
        dir: &Path,
        first: &Snapshot,
        survey: Survey,
        warnings: &[String],
    ) -> Result<Files, Failure> {
        let files = Files::create_part(scene, model, dir, first, survey, warnings)?;
        if files.are_written_here() {
            say_folder(dir);
        }
        Ok(files)
    }

    /// The same for the folder of a part of a run, of which nothing is said.
    pub fn create_part(
        scene: &Scene,
        model: &Model,
        dir: &Path,
        first: &Snapshot,
        survey: Survey,
        warnings: &[String],
    ) -> Result<Files, Failure> {
        let ring_stress = Arc::new(RingStress::new(model, scene)?);
        let reduced = ReducedStress::new(scene, model, &ring_stress)?;
        if !Communicator::world().is_root() {
            return Ok(Files::new(None, ring_stress, reduced));
        }
        let mut clock = Stopwatch::start();
        let Survey {
            probes, mesh, region, ..
        } = survey;
        let mesh = mesh.map_or_else(|| mesh_file(scene, model), Ok)?;
        let lock = folder::prepare(dir)?;
        note_dead_owner(&lock);
        let mut output = Output::create_in(lock, &mesh, storage(scene))?;
        drop(mesh);
        output.describe(about(scene, dir, warnings)?)?;
        let tables = Tables::create(
            dir,
            swept_column(scene),
            first,
            &own_columns(scene, model, probes.as_ref()),
        )?;
        let open = Open {
            region: region.map(Arc::new),
            reduction: reduced
                .as_ref()
                .map(|reduced| StressReduction::new(scene, model, reduced)),
            ..Open::new(output, tables, probes)?
        };
        let mut files = Files::new(Some(open), ring_stress, reduced);
        files.laps.add(OUTPUT, clock.lap());
        Ok(files)
    }

    /// Opens the files of a locked folder, of a run or of a part of it, to go on after a step; whoever knows which says
    /// where they are. Collective.
    pub fn resume(
        scene: &Scene,
        model: &Model,
        lock: Option<FolderLock>,
        first: &Snapshot,
        survey: Survey,
        resumed: &ResumedFrom<'_>,
    ) -> Result<Files, Failure> {
        let ring_stress = Arc::new(RingStress::new(model, scene)?);
        let reduced = ReducedStress::new(scene, model, &ring_stress)?;
        let Some(lock) = lock else {
            return Ok(Files::new(None, ring_stress, reduced));
        };
        let mut clock = Stopwatch::start();
        let dir = lock.dir().to_path_buf();
        let last = resumed.step;
        let texts = about(scene, &dir, resumed.warnings)?;
        // The tables tell whether the step can be resumed from; nothing is changed before all is known to fit.
        let Survey {
            probes, mesh, region, ..
        } = survey;
        let mut reduction = reduced
            .as_ref()
            .map(|reduced| StressReduction::new(scene, model, reduced));
        if let Some(reduction) = &mut reduction {
            reduction.load(resumed.reduction, last)?;
        }
        let columns = own_columns(scene, model, probes.as_ref());
        let cuts = Tables::cuts(&dir, first, &columns, (last, resumed.tables))?;
        let mesh = mesh.map_or_else(|| mesh_file(scene, model), Ok)?;
        let opened = Output::resume_of(lock, &mesh, storage(scene), last)?;
        drop(mesh);
        let (mut output, damaged, mut superseded) = (opened.output, opened.damaged, opened.superseded);
        output.describe(texts)?;
        folder::note_restored(opened.mesh_restored, &dir);
        let mut aside = || match &superseded {
            Some(folder) => Ok(folder.clone()),
            None => Ok(superseded
                .insert(checkpoint::new_superseded_folder(&dir)?)
                .clone()),
        };
        let tables = Tables::resume(&cuts, first, &columns, &mut aside)?;
        folder::note_superseded(superseded.as_deref(), last);
        warn_of_damage(&damaged);
        folder::remove_outdated(&dir)?;
        if let Some(table) = reduction.as_ref().and_then(StressReduction::table) {
            output.write_table(REDUCTION_FILE, &table)?;
        }
        let open = Open {
            region: region.map(Arc::new),
            reduction,
            ..Open::new(output, tables, probes)?
        };
        let mut files = Files::new(Some(open), ring_stress, reduced);
        files.laps.add(OUTPUT, clock.lap());
        Ok(files)
    }

    fn new(open: Option<Open>, ring_stress: Arc<RingStress>, reduced: Option<ReducedStress>) -> Files {
        Files {
            open,
            ring_stress,
            reduced,
            laps: Laps::default(),
        }
    }

    /// Whether this process writes.
    pub fn are_written_here(&self) -> bool {
        self.open.is_some()
    }

    /// Stress of an instant of the rings that several ranks share, for its fields. Collective, and never a failure of
    /// one rank: to be called before anything of the instant is written.
    pub fn gather_stress(&mut self, shown: &Shown<'_>, kept: KeptFields) -> Gathered {
        let (gathered, laps) = self.ring_stress.gather(shown, kept);
        self.laps.merge(&laps);
        gathered
    }

    /// Appends a line to the table of the probes.
    pub fn write_probes(
        &mut self,
        step: u64,
        time: f64,
        value: Option<f64>,
        shown: &Shown<'_>,
    ) -> Result<(), Failure> {
        let Some(open) = &mut self.open else { return Ok(()) };
        let Some(probes) = &open.probes else {
            return Ok(());
        };
        let values = self.laps.time(STRESS, || probes.values(shown))?;
        let append = || open.tables.append_probes(step, time, value, &values);
        self.laps.time(OUTPUT, append)?;
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
        let Some(open) = &mut self.open else { return Ok(()) };
        let append = || open.tables.append(step, time, value, snapshot);
        self.laps.time(OUTPUT, append)?;
        Ok(())
    }

    /// Appends the profiles of a step whose fields are written too.
    pub fn write_profiles(
        &mut self,
        step: u64,
        time: f64,
        value: Option<f64>,
        shown: &Shown<'_>,
    ) -> Result<(), Failure> {
        let Some(open) = &mut self.open else { return Ok(()) };
        let Some(probes) = &open.probes else {
            return Ok(());
        };
        let rows = self.laps.time(STRESS, || probes.profile_rows(shown))?;
        let append = || open.tables.append_profiles(step, time, value, rows);
        self.laps.time(OUTPUT, append)?;
        Ok(())
    }

    /// Makes a record of the fields and hands it over to be written as a step file. The tables must have the step
    /// already: a step file vouches for the tables up to its step.
    pub fn write_fields(
        &mut self,
        record: impl FnOnce(&RingStress) -> Result<StepRecord, Failure>,
    ) -> Result<(), Failure> {
        let Some(open) = &mut self.open else { return Ok(()) };
        let mut record = self.laps.time(STRESS, || record(&self.ring_stress))?;
        record.tables = Some(open.tables.stamps());
        if let Some(region) = &open.region {
            region.apply(&mut record);
        }
        self.laps.time(OUTPUT, || open.output.write_step(record))?;
        Ok(())
    }

    /// As [`Files::write_fields`] for a record that needs nothing but itself: the thread that writes makes it. A step
    /// with a state has what is known of the whole run besides, which is also written as a file.
    pub fn write_fields_later(
        &mut self,
        restart: RestartState,
        record: impl FnOnce(&RingStress) -> StepRecord + Send + 'static,
    ) -> Result<(), Failure> {
        let Some(open) = &mut self.open else { return Ok(()) };
        let ring_stress = self.ring_stress.clone();
        let tables = Some(open.tables.stamps());
        let region = open.region.clone();
        let reduction = open.reduction.as_ref();
        let reduction = reduction.filter(|_| restart == RestartState::Stored).cloned();
        let make = move || {
            let mut record = StepRecord {
                tables,
                ..record(&ring_stress)
            };
            let arrays = reduction.as_ref().map(StressReduction::arrays);
            record.state.extend(arrays.into_iter().flatten());
            if let Some(region) = &region {
                region.apply(&mut record);
            }
            Made {
                record,
                table: reduction
                    .and_then(|known| known.table())
                    .map(|table| (REDUCTION_FILE, table)),
            }
        };
        let hand_over = || open.output.write_step_made_by(make);
        self.laps.time(OUTPUT, hand_over)?;
        Ok(())
    }

    /// Whether a step counts in what is found of the whole run.
    pub fn reduces(&self, step: u64, time: f64) -> bool {
        let reduced = self.reduced.as_ref();
        reduced.is_some_and(|reduced| reduced.counts(step, time))
    }

    /// Takes a step into account in what is found of the whole run, if the scene asks for that and the step counts.
    /// Collective; rank 0 alone may fail.
    pub fn reduce(&mut self, step: u64, time: f64, shown: &Shown<'_>, scene: &Scene) -> Result<(), Failure> {
        let Some(reduced) = self.reduced.as_ref().filter(|reduced| reduced.counts(step, time)) else {
            return Ok(());
        };
        let (gathered, laps) = reduced.gather(shown);
        self.laps.merge(&laps);
        let reduction = self.open.as_mut().and_then(|open| open.reduction.as_mut());
        let add = |reduction: &mut StressReduction| reduction.add(step, shown, gathered, scene);
        reduction.map_or(Ok(()), |reduction| self.laps.time(REDUCTION, || add(reduction)))
    }

    /// Time spent waiting for the disk so far.
    pub fn waited(&self) -> Duration {
        self.open
            .as_ref()
            .map_or(Duration::ZERO, |open| open.output.waited())
    }

    /// Waits for the disk, closes the files and says what the run cost that began at `start`; `laps` are those of
    /// the solver.
    pub fn finish(
        self,
        read: f64,
        forecast: Forecasts,
        mut laps: Laps,
        start: Instant,
    ) -> Result<Costs, Failure> {
        laps.add(READ, read);
        let Some(open) = self.open else {
            laps.add(TOTAL, start.elapsed().as_secs_f64());
            return Ok(Costs {
                run: None,
                laps,
                forecast,
                probes: Vec::new(),
            });
        };
        let mut clock = Stopwatch::start();
        let written = open.output.finish()?;
        let of_probes = open.probes.as_ref().and_then(PlacedProbes::near_field_seconds);
        let near_fields = [self.ring_stress.near_field_seconds(), of_probes];
        let run = written.output.run().map(str::to_string);
        if let Some(reduction) = &open.reduction {
            match reduction.table() {
                Some(table) => written.output.write_table(REDUCTION_FILE, &table)?,
                None => print::note(format_args!(
                    "warning: no step counts by [output.reduction], there is no {REDUCTION_FILE}"
                )),
            }
        }
        if let Some(views) = written.output.finish()? {
            warn_of_damage(&views.damaged);
        }
        laps.merge(&self.laps);
        laps.add(STRESS, written.making.as_secs_f64());
        for seconds in near_fields.into_iter().flatten() {
            laps.add_part(NEAR_FIELD, seconds);
        }
        if Communicator::world().size() > 1 {
            laps.add(GATHER, 0.0);
        }
        laps.add(OUTPUT, clock.lap());
        laps.add_part(DISK_WAIT, written.waited.as_secs_f64());
        laps.add(DISK, written.writing.as_secs_f64());
        laps.add(TOTAL, start.elapsed().as_secs_f64());
        Ok(Costs {
            run,
            laps,
            forecast,
            probes: open.probes.map_or(Vec::new(), |p| p.places().cloned().collect()),
        })
    }
}

impl Open {
    fn new(output: Output, tables: Tables, probes: Option<PlacedProbes>) -> Result<Open, Failure> {
        let companions = tables.companions()?;
        Ok(Open {
            output: BackgroundOutput::start(output, QUEUE, companions)?,
            tables,
            probes,
            region: None,
            reduction: None,
        })
    }
}

/// Columns of the tables that probes and films need.
fn own_columns(scene: &Scene, model: &Model, probes: Option<&PlacedProbes>) -> OwnColumns {
    OwnColumns {
        film: FilmLaw::new(scene, model),
        probes: probes.and_then(PlacedProbes::columns),
        profiles: probes.and_then(PlacedProbes::profile_columns),
    }
}

/// Puts the log into the folder of a run, and names the folder in the answer of the command.
pub fn say_folder(dir: &Path) {
    log::begin(dir);
    answer::add_results(dir);
}

/// Says that the last writer of a folder did not end well.
pub fn note_dead_owner(lock: &FolderLock) {
    if let Some(owner) = lock.dead_owner() {
        print::note(format_args!(
            "note: {owner} was writing to {} and ended without giving it back; its lock is taken over",
            lock.dir().display()
        ));
    }
}

fn warn_of_damage(damaged: &[CheckpointError]) {
    for error in damaged {
        print::note(format_args!(
            "warning: {error}; it is left out of run.hdf.series and run.vtkhdf"
        ));
    }
}

/// Name of the column of a swept value.
fn swept_column(scene: &Scene) -> Option<&str> {
    match &scene.analysis {
        Analysis::Sweep(sweep) => Some(sweep.column.as_str()),
        Analysis::Static | Analysis::QuasiStatic(_) | Analysis::Dynamic(_) | Analysis::Modes(_) => None,
    }
}

/// The content of `mesh.hdf`.
pub fn mesh_file(scene: &Scene, model: &Model) -> anyhow::Result<MeshFile> {
    Ok(MeshFile::new(&fields::bodies(model))?.of_run(identity(scene)?))
}

/// How fields are stored.
pub fn storage(scene: &Scene) -> Storage {
    let precision = |asked| match asked {
        scene::FieldPrecision::F32 => Precision::F32,
        scene::FieldPrecision::F64 => Precision::F64,
    };
    Storage {
        stress: precision(scene.output.precision),
        stress_error: scene.output.stress_error.and_then(ErrorBound::new),
        displacement: precision(scene.output.displacement),
        compression: match scene.output.compression {
            0 => Compression::None,
            level => Compression::Deflate(level),
        },
    }
}
