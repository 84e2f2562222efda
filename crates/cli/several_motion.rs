//! `raceway run` of a `[dynamic]` scene with a list of bearings on one shaft, and how it goes on.
//!
//! Every bearing has a folder with tables, step files and restart states as a bearing alone; the state of the shaft is
//! stored in each of them. The tables beside the folders are in the frame of the shaft. Rank 0 writes for all; what
//! ranks do together they do bearing by bearing, before it writes.

use std::path::Path;
use std::time::Instant;

use assembly::motion::{AssemblyCache, AssemblyRates};
use assembly::{Assembly, AssemblyMotion, AssemblySolution, AssemblySolver, AssemblyState};
use comm::print;
use dynamics::costs::{EFFECTS, FACTOR};
use results::failure::{Failure, agree};
use results::files::Files;
use results::memory::Forecasts;
use results::motion_fields::{Recorded, RestartState};
use results::seat;
use results::several::{ListState, SeveralFindings, SeveralSummary, SeveralTables};
use results::several_print::print_solution;
use results::shown::Shown;
use results::snapshot::Snapshot;
use results::stop::Stop;
use results::summary::{Findings, READ, TOTAL};
use results::watch::Watch;
use scene::{Dynamic, Scene, SeveralScene, Start};
use timer::{Laps, Stopwatch};

use crate::instants::{self, Due, OverInstants, WrittenSteps};
use crate::motion::LAST_GOOD;
use crate::options::Limits;
use crate::progress::Progress;
use crate::remarks::Remarks;
use crate::several::{self, make_folder, require_same_list, say_types, solving, warnings_at};
use crate::several_files::{close_bearing, create_files, cuts_of_list, resume_all, resume_tables};
use crate::several_instant::rolling_start;
use crate::several_ledger::LedgerWatch;
use crate::several_read::{ReadList, read_list, require_memory_of_all};
use crate::several_ready::{ready, require_space, say_left_out};
use crate::several_state;

/// Runs the motion from its equilibrium.
pub fn run(
    scene: &SeveralScene,
    dynamic: &Dynamic,
    dir: &Path,
    limits: &Limits,
    start: Instant,
) -> Result<(), Failure> {
    require_same_list(scene)?;
    let progress = Progress::new(dynamic.n_steps);
    progress.stage("reading meshes");
    let ReadList {
        mut assembly,
        remarks,
        surveys,
    } = agree(read_list(scene, scene, |assembly| {
        require_memory_of_all(scene, assembly)?;
        require_space(scene, assembly, (dir, 0), limits)
    }))?;
    let mut laps = Laps::default();
    laps.add(READ, start.elapsed().as_secs_f64());
    let (solution, rates) = settle((scene, dynamic), &mut assembly, &progress, &mut laps)?;
    let remarks = remarks.with(warnings_at("", &assembly, &solution));
    assembly.release();
    progress.stage("factoring the effective matrices");
    let motion = laps.time(FACTOR, || ready(scene, dynamic, &assembly))?;
    say_left_out(&motion, &assembly, &progress);
    let state = motion.start_with(&solution, rates.as_ref());
    let placed = scene.bearings.iter().zip(&solution.bearings);
    let placed = placed.map(|(bearing, found)| several::placed(&bearing.scene, found));
    let placed = agree(placed.collect::<Result<Vec<Scene>, Failure>>())?;
    drop(solution);
    let begun = agree(make_folder(scene, dir))?;
    let first = ListState::of_motion(&assembly, &motion, &state);
    let tables = agree(SeveralTables::create(dir, None, &first).map_err(Failure::from))?;
    let files = create_files(begun, &assembly, &placed, snapshots(&motion, &state), surveys)?;
    let mut march = ListMarch {
        watches: new_watches(&assembly),
        scene,
        dynamic,
        assembly: &assembly,
        motion: &motion,
        placed,
        tables,
        files,
        state,
        cache: AssemblyCache::default(),
        newton: 0,
        laps,
        ledgers: LedgerWatch::default(),
        written: WrittenSteps::default(),
        dir,
    };
    instants::record(&mut march, RestartState::Stored)?;
    march.finish_run(progress, limits, remarks, start)
}

/// Equilibrium at t = 0, and the velocities with which the motion starts if they are asked for.
fn settle(
    (scene, dynamic): (&SeveralScene, &Dynamic),
    assembly: &mut Assembly,
    progress: &Progress,
    laps: &mut Laps,
) -> Result<(AssemblySolution, Option<AssemblyRates>), Failure> {
    progress.stage("static start");
    let mut solver = AssemblySolver::new(assembly).map_err(solving)?;
    say_types(&solver, assembly, progress);
    let solution = solver.solve(assembly, None).map_err(solving)?;
    let start = match dynamic.start {
        Start::Rolling => rolling_start((scene, assembly), &mut solver, solution).map_err(solving)?,
        Start::Static | Start::Given { .. } => (solution, None),
    };
    laps.merge(&solver.laps());
    Ok(start)
}

/// Goes on with a motion whose bearings and step have been read.
pub fn resume(
    stored: several_state::StoredList,
    dynamic: Dynamic,
    limits: &Limits,
    start: Instant,
) -> Result<(), Failure> {
    let several_state::StoredList {
        dir,
        scene,
        step,
        bearings,
        ..
    } = stored;
    let mut progress = Progress::new(dynamic.n_steps);
    progress.start_at(step);
    progress.stage("reading meshes");
    let ReadList {
        mut assembly,
        remarks,
        surveys,
    } = agree(read_list(&scene, &scene, |assembly| {
        require_space(&scene, assembly, (&dir, step), limits)
    }))?;
    assembly.release();
    let mut laps = Laps::default();
    laps.add(READ, start.elapsed().as_secs_f64());
    progress.stage("factoring the effective matrices");
    let motion = laps.time(FACTOR, || ready(&scene, &dynamic, &assembly))?;
    say_left_out(&motion, &assembly, &progress);
    let restored = several_state::restore(&bearings, &motion, assembly.shaft.n(), (&dir, step));
    let restored = agree(restored)?;
    let first = ListState::of_motion(&assembly, &motion, &restored.state);
    // Nothing is changed before all is known to fit.
    let cuts = cuts_of_list(&dir, &first, &bearings[0])?;
    let model = |i: usize| &assembly.bearings[i].model;
    let snapshot = |i: usize| Snapshot::of_motion(&motion.bearings[i], &restored.state.bearings[i]);
    let found = |i: usize| (model(i), snapshot(i), &restored.reductions[i]);
    let (files, placed) = resume_all(bearings, surveys, found)?;
    let tables = resume_tables(&cuts, &dir)?;
    let march = ListMarch {
        scene: &scene,
        dynamic: &dynamic,
        assembly: &assembly,
        motion: &motion,
        placed,
        tables,
        files,
        state: restored.state,
        cache: AssemblyCache::default(),
        newton: restored.newton,
        laps,
        watches: restored.watches,
        ledgers: LedgerWatch::default(),
        written: WrittenSteps::all_of(step),
        dir: &dir,
    };
    march.finish_run(progress, limits, remarks, start)
}

/// What all bearings show.
fn snapshots(motion: &AssemblyMotion<'_>, state: &AssemblyState) -> Vec<Snapshot> {
    let pairs = motion.bearings.iter().zip(&state.bearings);
    pairs
        .map(|(motion, state)| Snapshot::of_motion(motion, state))
        .collect()
}

fn new_watches(assembly: &Assembly) -> Vec<Watch> {
    let of = |bearing: &assembly::MountedBearing| Watch::new(bearing.model.geometry.n_balls);
    assembly.bearings.iter().map(of).collect()
}

/// A run under way.
struct ListMarch<'a> {
    scene: &'a SeveralScene,
    dynamic: &'a Dynamic,
    assembly: &'a Assembly,
    motion: &'a AssemblyMotion<'a>,
    /// Scenes of the bearings with the shaft where it was at the start.
    placed: Vec<Scene>,
    tables: SeveralTables,
    /// By bearing.
    files: Vec<Files>,
    /// The last good state.
    state: AssemblyState,
    cache: AssemblyCache,
    /// Newton iterations so far.
    newton: u64,
    laps: Laps,
    /// Contacts beyond their limits so far, by bearing.
    watches: Vec<Watch>,
    /// What the ledgers have shown since the start of this process.
    ledgers: LedgerWatch,
    written: WrittenSteps,
    dir: &'a Path,
}

impl ListMarch<'_> {
    /// Steps to the end of the run, closes the files and sums up, also when the run ends early.
    fn finish_run(
        mut self,
        mut progress: Progress,
        limits: &Limits,
        mut remarks: Remarks,
        start: Instant,
    ) -> Result<(), Failure> {
        let mut clock = Stopwatch::start();
        let first = self.state.step;
        let mut stop = agree(Stop::listen(start, limits.wall_time).map_err(Failure::from))?;
        let ended = instants::run(&mut self, first + 1, Some(&mut stop), &mut progress);
        progress.finish();
        let seconds = clock.lap();
        for motion in &self.motion.bearings {
            self.laps.merge_into(EFFECTS, &motion.costs.laps());
        }
        let failed = ended.as_ref().err();
        let status = failed.map_or("finished".to_string(), Failure::status);
        for (i, watch) in self.watches.iter().enumerate() {
            let (name, motion) = (&self.scene.bearings[i].name, &self.motion.bearings[i]);
            let own = watch.warnings(motion.surfaces(), |step| motion.time(step));
            remarks
                .warnings
                .extend(own.into_iter().map(|text| format!("bearing {name:?}: {text}")));
        }
        // A run that failed says why, not what its failure did to the files; one that stopped must have its step.
        let of_seats = match (self.close_bearings(&status, start), &ended) {
            (Err(_), Err(Failure::User(_) | Failure::Numerical(_))) => return ended,
            (of_seats, _) => of_seats?,
        };
        let remarks = remarks.with(of_seats);
        self.laps.add(TOTAL, start.elapsed().as_secs_f64());
        let last = ListState::of_motion(self.assembly, self.motion, &self.state);
        let findings = SeveralFindings {
            status,
            iterations: self.newton as usize,
            residual: self.ledgers.worst,
            warnings: remarks.warnings,
            advice: remarks.advice,
            laps: self.laps,
        };
        let summary = SeveralSummary::new(self.scene, self.assembly, &last, findings);
        agree(summary.write(self.dir).map_err(Failure::from))?;
        ended?;
        print_solution(self.assembly, &last);
        print::line(format_args!(
            "{}; {}",
            instants::pace(self.state.step - first, self.dynamic.step, seconds),
            match self.ledgers.worst {
                0.0 => "energy defects are round-off".to_string(),
                defect => format!("largest energy defect {defect:.1e} of the largest energy"),
            }
        ));
        summary.print_costs();
        Ok(())
    }

    /// Closes the files of the bearings and writes their summaries; warns of their seats. Collective.
    fn close_bearings(&mut self, status: &str, start: Instant) -> Result<Vec<String>, Failure> {
        let mut warnings = Vec::new();
        for (i, files) in std::mem::take(&mut self.files).into_iter().enumerate() {
            let (motion, state) = (&self.motion.bearings[i], &self.state.bearings[i]);
            let forecast = Forecasts::of_motion([None, None], motion, (&self.placed[i], self.dynamic));
            let findings = Findings {
                status: status.to_string(),
                last: Snapshot::of_motion(motion, state),
                points: Vec::new(),
                iterations: std::collections::BTreeMap::from([("steps", state.step as usize)]),
                warnings: self.watches[i].warnings(motion.surfaces(), |step| motion.time(step)),
                advice: Vec::new(),
            };
            let own = self.dir.join(&self.assembly.bearings[i].name);
            warnings.extend(close_bearing(
                files,
                (&self.placed[i], &self.assembly.bearings, i),
                &own,
                (findings, forecast, motion.costs.laps()),
                |own| seat::of_motion(motion, state, own),
                start,
            )?);
        }
        Ok(warnings)
    }

    /// Takes a state whose ledgers close.
    fn accept(&mut self, next: AssemblyState, progress: &Progress) -> Result<(), Failure> {
        let checked = self
            .ledgers
            .check((self.scene, self.dynamic), self.motion, &next, self.dir);
        if let Err(failure) = checked {
            return Err(instants::failed(self, LAST_GOOD, failure));
        }
        self.state = next;
        let step = self.state.step;
        for (i, watch) in self.watches.iter_mut().enumerate() {
            let found = self.motion.bearings[i].exceeded(&self.state.bearings[i]);
            for text in watch.note(step, self.motion.time(step), &found) {
                progress.warn(&format!("bearing {:?}: {text}", self.scene.bearings[i].name));
            }
        }
        Ok(())
    }
}

impl OverInstants for ListMarch<'_> {
    fn due(&self) -> Due {
        Due {
            last: self.dynamic.n_steps,
            tables_every: self.placed[0].output.tables_every,
            files_every: self.dynamic.output_every,
        }
    }

    fn written(&mut self) -> &mut WrittenSteps {
        &mut self.written
    }

    fn dir(&self) -> &Path {
        self.dir
    }

    fn now(&self) -> u64 {
        self.state.step
    }

    fn time(&self, n: u64) -> f64 {
        self.motion.time(n)
    }

    fn advance(&mut self, _n: u64, progress: &mut Progress) -> Result<(), Failure> {
        let found = self.motion.step(&self.state, &mut self.cache);
        let (next, report) = found.map_err(|error| instants::failed(self, LAST_GOOD, solving(error)))?;
        self.newton += report.newton_iterations as u64;
        self.laps.merge(&report.laps);
        self.accept(next, progress)
    }

    fn restart_at(&self, n: u64) -> RestartState {
        RestartState::at(n, self.dynamic, &self.placed[0].output)
    }

    fn append_files(&mut self, restart: RestartState) -> Result<(), Failure> {
        let of_shaft = several_state::arrays_of_shaft(&self.state, self.newton);
        let every = self.placed[0].output.every;
        let kept = every.kept(self.state.step, self.dynamic.output_every, self.dynamic.n_steps);
        let bearings = self.motion.bearings.iter().zip(&self.state.bearings);
        let states: Vec<_> = bearings.map(|(motion, state)| motion.gathered(state)).collect();
        let mut gathered = Vec::new();
        for (i, files) in self.files.iter_mut().enumerate() {
            let (motion, state) = (&self.motion.bearings[i], &*states[i]);
            let model = &self.assembly.bearings[i].model;
            gathered.push(files.gather_stress(&Shown::Motion { model, motion, state }, kept));
        }
        for (i, (files, gathered)) in self.files.iter_mut().zip(gathered).enumerate() {
            if !files.are_written_here() {
                continue;
            }
            let (motion, state) = (&self.motion.bearings[i], &*states[i]);
            let model = &self.assembly.bearings[i].model;
            let shown = Recorded::new(model, motion, state, gathered, (&self.placed[i], kept), restart)?;
            let (of_shaft, watch) = (of_shaft.clone(), self.watches[i].clone());
            files.write_fields_later(restart, move |stress| {
                let mut record = shown.record(stress);
                if restart == RestartState::Stored {
                    record.state.extend(of_shaft);
                    watch.put(&mut record.state);
                }
                record
            })?;
        }
        Ok(())
    }

    /// Rank 0 goes on with the other bearings where it fails.
    fn reduce(&mut self) -> Result<(), Failure> {
        let mut reduced = Ok(());
        for (i, files) in self.files.iter_mut().enumerate() {
            let (motion, state) = (&self.motion.bearings[i], &self.state.bearings[i]);
            if !files.reduces(state.step, motion.time(state.step)) {
                continue;
            }
            let state = &*motion.gathered(state);
            let model = &self.assembly.bearings[i].model;
            let shown = Shown::Motion { model, motion, state };
            let own = files.reduce(state.step, motion.time(state.step), &shown, &self.placed[i]);
            reduced = reduced.and(own);
        }
        reduced
    }

    fn append_rows(&mut self) -> Result<(), Failure> {
        let (step, time) = (self.state.step, self.motion.time(self.state.step));
        let now = ListState::of_motion(self.assembly, self.motion, &self.state);
        self.tables.append((step, time), None, self.assembly, &now)?;
        for (i, files) in self.files.iter_mut().enumerate() {
            let snapshot = Snapshot::of_motion(&self.motion.bearings[i], &self.state.bearings[i]);
            files.write_tables(step, time, None, &snapshot)?;
        }
        Ok(())
    }
}
