//! `raceway run` of a `[quasi_static]` scene with a list of bearings on one shaft, and how it goes on: equilibria in
//! time, each started from the one before.
//!
//! Files are those of a motion of a list. A step file holds what the next equilibrium starts from, so that a resumed
//! run has the same bits.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use assembly::{Assembly, AssemblyError, AssemblySolution, AssemblySolver, AssemblyStart};
use comm::print;
use contact::Side;
use dynamics::kinematics::Rolling;
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
use scene::{QuasiStatic, Scene, SeveralScene};
use timer::{Laps, Stopwatch};

use crate::instants::{self, Due, OverInstants, WrittenSteps};
use crate::options::Limits;
use crate::progress::Progress;
use crate::several::{self, make_folder, require_same_list, say_types, solving, warnings_at};
use crate::several_files::{close_bearing, create_files, cuts_of_list, resume_all, resume_tables};
use crate::several_instant::{load_at, poses, rolling_of_all};
use crate::several_quasi_state::{self, ListCounts};
use crate::several_read::{ReadList, read_list, require_memory_of_all};
use crate::several_ready::require_space;
use crate::several_state::StoredList;

/// Runs the equilibria from the first.
pub fn run(
    scene: &SeveralScene,
    settings: &QuasiStatic,
    dir: &Path,
    limits: &Limits,
    start: Instant,
) -> Result<(), Failure> {
    require_same_list(scene)?;
    let mut progress = Progress::new(1 + settings.n_steps);
    progress.stage("reading meshes");
    let ReadList {
        assembly,
        doubts,
        surveys,
    } = agree(read_list(scene, scene, |assembly| {
        require_memory_of_all(scene, assembly)?;
        require_space(scene, assembly, (dir, 0), limits)
    }))?;
    let read = start.elapsed().as_secs_f64();
    progress.stage("factoring the stiffness of the rings");
    let solver = AssemblySolver::new(&assembly).map_err(solving)?;
    say_types(&solver, &assembly, &progress);
    let mut list = TurningList::new((scene, settings.step), assembly, solver);
    progress.stage("first equilibrium");
    let first = list.solve(0, None).map_err(solving)?;
    let placed = scene.bearings.iter().zip(&first.bearings);
    let placed = placed.map(|(bearing, found)| several::placed(&bearing.scene, found));
    let placed = agree(placed.collect::<Result<Vec<Scene>, Failure>>())?;
    // The first solution makes the folder: a scene that has none leaves no files.
    let begun = agree(make_folder(scene, dir))?;
    let tables = SeveralTables::create(dir, None, &ListState::of_equilibrium(&list.assembly, &first));
    let tables = agree(tables.map_err(Failure::from))?;
    let snapshots = (0..placed.len()).map(|i| list.snapshot(&first, i)).collect();
    let files = create_files(begun, &list.assembly, &placed, snapshots, surveys)?;
    let counts = ListCounts {
        of_bearings: vec![[0; 2]; first.bearings.len()],
        ..ListCounts::default()
    };
    let mut course = ListEquilibria {
        settings: *settings,
        list,
        placed,
        tables,
        files,
        step: 0,
        next: first.as_start(),
        last: first,
        counts,
        first_warnings: Vec::new(),
        written: WrittenSteps::default(),
        dir,
    };
    course.count(&progress);
    instants::record(&mut course, RestartState::Stored)?;
    progress.advance();
    course.finish_run(progress, limits, doubts, (read, start))
}

/// Goes on with equilibria whose bearings and step have been read.
pub fn resume(
    stored: StoredList,
    settings: QuasiStatic,
    limits: &Limits,
    start: Instant,
) -> Result<(), Failure> {
    let StoredList {
        dir,
        scene,
        step,
        bearings,
        ..
    } = stored;
    let mut progress = Progress::new(1 + settings.n_steps);
    progress.start_at(1 + step);
    progress.stage("reading meshes");
    let ReadList {
        assembly,
        doubts,
        surveys,
    } = agree(read_list(&scene, &scene, |assembly| {
        require_space(&scene, assembly, (&dir, step), limits)
    }))?;
    let read = start.elapsed().as_secs_f64();
    progress.stage("factoring the stiffness of the rings");
    let solver = AssemblySolver::new(&assembly).map_err(solving)?;
    let restored = several_quasi_state::restore(&bearings, (&assembly, &solver), (&dir, step));
    let restored = agree(restored)?;
    let mut list = TurningList::new((&scene, settings.step), assembly, solver);
    // What the step shows, found once more; the next one starts from what the file holds.
    list.solver.restore_columns(restored.columns.clone());
    let last = list.solve(step, Some(&restored.start)).map_err(solving)?;
    list.solver.restore_columns(restored.columns);
    // Nothing is changed before all is known to fit.
    let shown = ListState::of_equilibrium(&list.assembly, &last);
    let cuts = cuts_of_list(&dir, &shown, &bearings[0])?;
    let model = |i: usize| &list.assembly.bearings[i].model;
    let found = |i: usize| (model(i), list.snapshot(&last, i), &restored.reductions[i]);
    let (files, placed) = resume_all(bearings, surveys, found)?;
    let tables = resume_tables(&cuts, &dir)?;
    let course = ListEquilibria {
        settings,
        list,
        placed,
        tables,
        files,
        step,
        next: restored.start,
        last,
        counts: restored.counts,
        first_warnings: Vec::new(),
        written: WrittenSteps::all_of(step),
        dir: &dir,
    };
    course.finish_run(progress, limits, doubts, (read, start))
}

/// Bearings ready to turn without inertia.
struct TurningList<'a> {
    scene: &'a SeveralScene,
    /// Time from one instant to the next, s.
    dt: f64,
    assembly: Assembly,
    solver: AssemblySolver,
    /// How the parts of every bearing roll, in its own frame; None: nothing turns.
    rolling: Vec<Option<Rolling>>,
}

impl<'a> TurningList<'a> {
    fn new(
        (scene, dt): (&'a SeveralScene, f64),
        assembly: Assembly,
        solver: AssemblySolver,
    ) -> TurningList<'a> {
        TurningList {
            rolling: rolling_of_all(scene),
            scene,
            dt,
            assembly,
            solver,
        }
    }

    /// Time of an instant, s.
    fn time(&self, n: u64) -> f64 {
        n as f64 * self.dt
    }

    /// Equilibrium of an instant.
    fn solve(&mut self, n: u64, from: Option<&AssemblyStart>) -> Result<AssemblySolution, AssemblyError> {
        let time = self.time(n);
        load_at(self.scene, &mut self.assembly, time)?;
        let poses = poses(&self.rolling, &self.assembly, time);
        self.solver.solve_at(&mut self.assembly, &poses, from)
    }

    /// What tables show of a bearing.
    fn snapshot(&self, solution: &AssemblySolution, bearing: usize) -> Snapshot {
        Snapshot::of_equilibrium(&solution.bearings[bearing], self.rolling[bearing].as_ref())
    }

    fn shown<'s>(&'s self, solution: &'s AssemblySolution, bearing: usize) -> Shown<'s> {
        let model = &self.assembly.bearings[bearing].model;
        Shown::at_rest(model, &model.geometry, &solution.bearings[bearing])
    }
}

/// A run under way.
struct ListEquilibria<'a> {
    settings: QuasiStatic,
    list: TurningList<'a>,
    /// Scenes of the bearings with the shaft where it was at the start.
    placed: Vec<Scene>,
    tables: SeveralTables,
    /// By bearing.
    files: Vec<Files>,
    /// Number of the last equilibrium.
    step: u64,
    /// The last equilibrium.
    last: AssemblySolution,
    /// What the next one starts from.
    next: AssemblyStart,
    counts: ListCounts,
    /// Warnings of the first instant of this process that had any.
    first_warnings: Vec<String>,
    written: WrittenSteps,
    dir: &'a Path,
}

impl ListEquilibria<'_> {
    /// Takes note of what the last equilibrium took. A long run warns at thousands of instants: the first stands for
    /// all.
    fn count(&mut self, progress: &Progress) {
        self.counts.iterations += self.last.shaft.iterations as u64;
        for (sum, found) in self.counts.of_bearings.iter_mut().zip(&self.last.bearings) {
            sum[0] += found.rounds as u64;
            sum[1] += found.newton_iterations as u64;
        }
        let at = format!("t = {:.6e} s: ", self.list.time(self.step));
        let warnings = warnings_at(&at, &self.list.assembly, &self.last);
        if warnings.is_empty() {
            return;
        }
        self.counts.warned += 1;
        if self.first_warnings.is_empty() {
            warnings.iter().for_each(|warning| progress.warn(warning));
            self.first_warnings = warnings;
        }
    }

    /// Steps to the end of the run, closes the files and sums up, also when the run ends early. The list was read until
    /// `read`, s, after `start`.
    fn finish_run(
        mut self,
        mut progress: Progress,
        limits: &Limits,
        mut warnings: Vec<String>,
        (read, start): (f64, Instant),
    ) -> Result<(), Failure> {
        let (mut clock, first) = (Stopwatch::start(), self.step);
        let mut stop = agree(Stop::listen(start, limits.wall_time).map_err(Failure::from))?;
        let ended = instants::run(&mut self, first + 1, Some(&mut stop), &mut progress);
        progress.finish();
        let seconds = clock.lap();
        let failed = ended.as_ref().err();
        let status = failed.map_or("finished".to_string(), Failure::status);
        warnings.append(&mut self.first_warnings);
        if self.counts.warned > 1 {
            warnings.push(format!(
                "{} instants have warnings; those of the first are given",
                self.counts.warned
            ));
        }
        // A run that failed says why, not what its failure did to the files; one that stopped must have its step.
        let of_seats = match (self.close_bearings(&status, start), &ended) {
            (Err(_), Err(Failure::User(_) | Failure::Numerical(_))) => return ended,
            (of_seats, _) => of_seats?,
        };
        warnings.extend(of_seats);
        let mut laps = Laps::default();
        laps.add(READ, read);
        laps.merge(&self.list.solver.laps());
        laps.add(TOTAL, start.elapsed().as_secs_f64());
        let assembly = &self.list.assembly;
        let last = ListState::of_equilibrium(assembly, &self.last);
        let findings = SeveralFindings {
            status,
            iterations: self.counts.iterations as usize,
            residual: self.last.shaft.error,
            warnings,
            laps,
        };
        let summary = SeveralSummary::new(self.list.scene, assembly, &last, findings);
        agree(summary.write(self.dir).map_err(Failure::from))?;
        ended?;
        print_solution(assembly, &last);
        let steps = self.step - first;
        print::line(format_args!(
            "{steps} steps of {} s, {:.1} ms per step",
            self.settings.step,
            1e3 * seconds / steps.max(1) as f64
        ));
        summary.print_costs();
        Ok(())
    }

    /// Closes the files of the bearings and writes their summaries; warns of their seats. Collective.
    fn close_bearings(&mut self, status: &str, start: Instant) -> Result<Vec<String>, Failure> {
        let mut warnings = Vec::new();
        for (i, files) in std::mem::take(&mut self.files).into_iter().enumerate() {
            let (mounted, factors) = (&self.list.assembly.bearings[i], self.list.solver.of_bearing(i));
            let forecast = Side::BOTH.map(|side| factors.ring(side).map(|r| r.solver.memory));
            let forecast = Forecasts::at_rest(forecast, &mounted.model);
            let found = &self.last.bearings[i];
            let [rounds, newton] = self.counts.of_bearings[i].map(|count| count as usize);
            let steps = self.step as usize;
            let findings = Findings {
                status: status.to_string(),
                last: self.list.snapshot(&self.last, i),
                points: Vec::new(),
                iterations: BTreeMap::from([("steps", steps), ("rounds", rounds), ("newton", newton)]),
                warnings: found.warnings.clone(),
                advice: Vec::new(),
            };
            warnings.extend(close_bearing(
                files,
                (&self.placed[i], &self.list.assembly.bearings, i),
                &self.dir.join(&mounted.name),
                (findings, forecast, factors.laps()),
                |own| seat::of_run(&mounted.model, found, own),
                start,
            )?);
        }
        Ok(warnings)
    }
}

impl OverInstants for ListEquilibria<'_> {
    fn due(&self) -> Due {
        Due {
            last: self.settings.n_steps,
            tables_every: self.placed[0].output.tables_every,
            files_every: self.settings.output_every,
        }
    }

    fn written(&mut self) -> &mut WrittenSteps {
        &mut self.written
    }

    fn dir(&self) -> &Path {
        self.dir
    }

    fn now(&self) -> u64 {
        self.step
    }

    fn time(&self, n: u64) -> f64 {
        self.list.time(n)
    }

    fn advance(&mut self, n: u64, progress: &mut Progress) -> Result<(), Failure> {
        let columns = self.list.solver.columns().to_vec();
        self.last = match self.list.solve(n, Some(&self.next)) {
            Ok(found) => found,
            Err(error) => {
                // The next one starts from the last, with its tangents.
                self.list.solver.restore_columns(columns);
                return Err(instants::failed(self, "the last equilibrium", solving(error)));
            }
        };
        self.next = self.last.as_start();
        self.step = n;
        self.count(progress);
        Ok(())
    }

    /// Rank 0 goes on with the other bearings where it fails.
    fn reduce(&mut self) -> Result<(), Failure> {
        let (step, time) = (self.step, self.list.time(self.step));
        let mut reduced = Ok(());
        for (i, files) in self.files.iter_mut().enumerate() {
            let shown = self.list.shown(&self.last, i);
            reduced = reduced.and(files.reduce(step, time, &shown, &self.placed[i]));
        }
        reduced
    }

    fn append_rows(&mut self) -> Result<(), Failure> {
        let (step, time) = (self.step, self.list.time(self.step));
        let assembly = &self.list.assembly;
        let now = ListState::of_equilibrium(assembly, &self.last);
        self.tables.append((step, time), None, assembly, &now)?;
        for (i, files) in self.files.iter_mut().enumerate() {
            files.write_tables(step, time, None, &self.list.snapshot(&self.last, i))?;
        }
        Ok(())
    }

    fn append_files(&mut self, restart: RestartState) -> Result<(), Failure> {
        let at = (self.step, self.list.time(self.step));
        let every = self.placed[0].output.every;
        let kept = every.kept(at.0, self.settings.output_every, self.settings.n_steps);
        let mut gathered = Vec::new();
        for (i, files) in self.files.iter_mut().enumerate() {
            gathered.push(files.gather_stress(&self.list.shown(&self.last, i), kept));
        }
        for (i, (files, gathered)) in self.files.iter_mut().zip(gathered).enumerate() {
            if !files.are_written_here() {
                continue;
            }
            let columns = &self.list.solver.columns()[i];
            let state = several_quasi_state::arrays(&self.next, columns, &self.counts, i);
            let (shown, placed) = (self.list.shown(&self.last, i), (&self.placed[i], kept));
            let shown = Recorded::of_equilibrium(&shown, at, gathered, placed, state)?;
            files.write_fields_later(restart, move |stress| shown.record(stress))?;
        }
        Ok(())
    }
}
