//! `raceway run` of a `[quasi_static]` scene with a list of bearings on one shaft, and how it goes on: equilibria in
//! time, several of them solved at the same time ([`crate::points_ahead`]).
//!
//! Files are those of a motion of a list. A step file holds what the next equilibria start from, so that a resumed run
//! has the same bits.

use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use assembly::points::{AssemblyPoint, AssemblyPointStart, points_per_start};
use assembly::{Assembly, AssemblySolution, AssemblySolver};
use dynamics::kinematics::Rolling;
use results::failure::{Failure, agree};
use results::files::Files;
use results::motion_fields::{Recorded, RestartState};
use results::several::{ListState, SeveralTables};
use results::snapshot::Snapshot;
use results::stop::Stop;
use scene::{QuasiStatic, Rings, Scene, SeveralScene, assembly_with_rings};
use timer::Stopwatch;

use crate::instants::{self, Due, OverInstants, WrittenSteps};
use crate::options::Limits;
use crate::points_ahead::{Grouping, PointAnswer, PointsAhead};
use crate::progress::Progress;
use crate::several::{self, add_laps, make_folder, require_same_list, say_types, solving, warnings_at};
use crate::several_files::{create_files, cuts_of_list, resume_all, resume_tables};
use crate::several_instant::{load_at, poses, rolling_of_all};
use crate::several_quasi_end::{EndedList, FoundList};
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
    let ReadList {
        assembly,
        remarks,
        surveys,
    } = read_all(scene, (dir, 0), limits, &progress)?;
    let read = start.elapsed().as_secs_f64();
    let solver = factored(&assembly, &progress)?;
    let (list, group) = TurningList::new((scene, settings), assembly, solver);
    let solve = |n: u64, from: Option<&AssemblyPointStart>| list.point(n, from);
    progress.stage("first equilibrium");
    let ended = rayon::in_place_scope(|scope| {
        let mut ahead = PointsAhead::new(scope, &solve, group, None);
        let (AssemblyPoint { solution, laps, .. }, assembly) = ahead.take()?;
        let placed = scene.bearings.iter().zip(&solution.bearings);
        let placed = placed.map(|(bearing, found)| several::placed(&bearing.scene, found));
        let placed = agree(placed.collect::<Result<Vec<Scene>, Failure>>())?;
        // The first solution makes the folder: a scene that has none leaves no files.
        let begun = agree(make_folder(scene, dir))?;
        let tables = SeveralTables::create(dir, None, &ListState::of_equilibrium(&assembly, &solution));
        let tables = agree(tables.map_err(Failure::from))?;
        let snapshots = (0..placed.len()).map(|i| list.snapshot(&solution, i)).collect();
        let counts = ListCounts {
            of_bearings: vec![[0; 2]; solution.bearings.len()],
            ..ListCounts::default()
        };
        let mut course = ListEquilibria {
            settings: *settings,
            list: &list,
            ahead,
            files: create_files(begun, &assembly, &placed, snapshots, surveys)?,
            found: FoundList {
                placed,
                tables,
                step: 0,
                assembly,
                last: solution,
                counts,
                first_warnings: Vec::new(),
                laps,
            },
            written: WrittenSteps::default(),
            dir,
        };
        course.count(&progress);
        instants::record(&mut course, RestartState::Stored)?;
        progress.advance();
        course.run(progress, limits, start)
    })?;
    ended.conclude((scene, list.solver, &list.rolling), dir, remarks, (read, start))
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
    let ReadList {
        assembly,
        remarks,
        surveys,
    } = read_all(&scene, (&dir, step), limits, &progress)?;
    let read = start.elapsed().as_secs_f64();
    let solver = factored(&assembly, &progress)?;
    let restored = several_quasi_state::restore(&bearings, (&assembly, &solver), (&dir, step));
    let restored = agree(restored)?;
    let (list, group) = TurningList::new((&scene, &settings), assembly, solver);
    // What the step shows, found once more.
    let (AssemblyPoint { solution, .. }, assembly) = list.point(step, restored.taken.from.as_ref())?;
    // Nothing is changed before all is known to fit.
    let shown = ListState::of_equilibrium(&assembly, &solution);
    let cuts = cuts_of_list(&dir, &shown, &bearings[0])?;
    let model = |i: usize| &assembly.bearings[i].model;
    let found = |i: usize| (model(i), list.snapshot(&solution, i), &restored.reductions[i]);
    let (files, placed) = resume_all(bearings, surveys, found)?;
    let tables = resume_tables(&cuts, &dir)?;
    let solve = |n: u64, from: Option<&AssemblyPointStart>| list.point(n, from);
    let ended = rayon::in_place_scope(|scope| {
        let course = ListEquilibria {
            settings,
            list: &list,
            ahead: PointsAhead::new(scope, &solve, group, Some(restored.taken)),
            files,
            found: FoundList {
                placed,
                tables,
                step,
                assembly,
                last: solution,
                counts: restored.counts,
                first_warnings: Vec::new(),
                laps: Vec::new(),
            },
            written: WrittenSteps::all_of(step),
            dir: &dir,
        };
        course.run(progress, limits, start)
    })?;
    ended.conclude((&scene, list.solver, &list.rolling), &dir, remarks, (read, start))
}

/// A list whose run has done so many steps in a folder, if there is room for it.
fn read_all(
    scene: &SeveralScene,
    done: (&Path, u64),
    limits: &Limits,
    progress: &Progress,
) -> Result<ReadList, Failure> {
    progress.stage("reading meshes");
    agree(read_list(scene, scene, |assembly| {
        require_memory_of_all(scene, assembly)?;
        require_space(scene, assembly, done, limits)
    }))
}

/// The rings of a list, factored.
fn factored(assembly: &Assembly, progress: &Progress) -> Result<AssemblySolver, Failure> {
    progress.stage("factoring the stiffness of the rings");
    let solver = AssemblySolver::new(assembly).map_err(solving)?;
    say_types(&solver, assembly, progress);
    Ok(solver)
}

/// Bearings ready to turn without inertia.
struct TurningList<'a> {
    scene: &'a SeveralScene,
    /// Time from one instant to the next, s.
    dt: f64,
    solver: AssemblySolver,
    /// How the parts of every bearing roll, in its own frame; None: nothing turns.
    rolling: Vec<Option<Rolling>>,
    /// What the lists at all instants share.
    rings: Vec<Rings>,
    /// Lists that no instant holds any more.
    spare: Mutex<Vec<Assembly>>,
}

impl<'a> TurningList<'a> {
    /// A list with its factors, and which of its instants start from the same one.
    fn new(
        (scene, settings): (&'a SeveralScene, &QuasiStatic),
        assembly: Assembly,
        solver: AssemblySolver,
    ) -> (TurningList<'a>, Grouping) {
        let group = Grouping {
            size: points_per_start(&assembly),
            last: settings.n_steps,
        };
        let bearings = assembly.bearings.iter();
        let list = TurningList {
            scene,
            dt: settings.step,
            solver,
            rolling: rolling_of_all(scene),
            rings: bearings.map(|bearing| bearing.model.rings.clone()).collect(),
            spare: Mutex::new(vec![assembly]),
        };
        (list, group)
    }

    /// Time of an instant, s.
    fn time(&self, n: u64) -> f64 {
        n as f64 * self.dt
    }

    /// Equilibrium of an instant, with the list that has its loads.
    fn point(&self, n: u64, from: Option<&AssemblyPointStart>) -> PointAnswer<AssemblyPoint, Assembly> {
        let spare = self.spare.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut assembly = match spare {
            Some(assembly) => assembly,
            None => agree(assembly_with_rings(self.scene, self.rings.clone()).map_err(Failure::from))?,
        };
        let time = self.time(n);
        load_at(self.scene, &mut assembly, time).map_err(solving)?;
        let poses = poses(&self.rolling, &assembly, time);
        let found = self.solver.point(&mut assembly, &poses, from);
        Ok((found.map_err(solving)?, assembly))
    }

    /// Takes back the list of an instant.
    fn give_back(&self, assembly: Assembly) {
        let mut spare = self.spare.lock().unwrap_or_else(PoisonError::into_inner);
        spare.push(assembly);
    }

    /// What tables show of a bearing.
    fn snapshot(&self, solution: &AssemblySolution, bearing: usize) -> Snapshot {
        Snapshot::of_equilibrium(&solution.bearings[bearing], self.rolling[bearing].as_ref())
    }
}

/// A run under way.
struct ListEquilibria<'a, 's, 'scope> {
    settings: QuasiStatic,
    list: &'a TurningList<'a>,
    ahead: PointsAhead<'s, 'scope, AssemblyPoint, Assembly>,
    found: FoundList,
    /// By bearing.
    files: Vec<Files>,
    written: WrittenSteps,
    dir: &'a Path,
}

impl ListEquilibria<'_, '_, '_> {
    /// Takes note of what the last equilibrium took. A long run warns at thousands of instants: the first stands for
    /// all.
    fn count(&mut self, progress: &Progress) {
        let at = format!("t = {:.6e} s: ", self.list.time(self.found.step));
        let found = &mut self.found;
        found.counts.iterations += found.last.shaft.iterations as u64;
        for (sum, found) in found.counts.of_bearings.iter_mut().zip(&found.last.bearings) {
            sum[0] += found.rounds as u64;
            sum[1] += found.newton_iterations as u64;
        }
        let warnings = warnings_at(&at, &found.assembly, &found.last);
        if warnings.is_empty() {
            return;
        }
        found.counts.warned += 1;
        if found.first_warnings.is_empty() {
            warnings.iter().for_each(|warning| progress.warn(warning));
            found.first_warnings = warnings;
        }
    }

    /// Steps to the end of the run.
    fn run(mut self, mut progress: Progress, limits: &Limits, start: Instant) -> Result<EndedList, Failure> {
        let (mut clock, first) = (Stopwatch::start(), self.found.step);
        let mut stop = agree(Stop::listen(start, limits.wall_time).map_err(Failure::from))?;
        let ended = instants::run(&mut self, first + 1, Some(&mut stop), &mut progress);
        self.ahead.end();
        progress.finish();
        Ok(EndedList {
            settings: self.settings,
            steps: self.found.step - first,
            found: self.found,
            files: self.files,
            ended,
            seconds: clock.lap(),
        })
    }
}

impl OverInstants for ListEquilibria<'_, '_, '_> {
    fn due(&self) -> Due {
        Due {
            last: self.settings.n_steps,
            tables_every: self.found.placed[0].output.tables_every,
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
        self.found.step
    }

    fn time(&self, n: u64) -> f64 {
        self.list.time(n)
    }

    fn advance(&mut self, n: u64, progress: &mut Progress) -> Result<(), Failure> {
        let next = self.ahead.take();
        let (AssemblyPoint { solution, laps, .. }, assembly) =
            next.map_err(|failure| instants::failed(self, "the last equilibrium", failure))?;
        let before = std::mem::replace(&mut self.found.assembly, assembly);
        self.list.give_back(before);
        add_laps(&mut self.found.laps, &laps);
        self.found.last = solution;
        self.found.step = n;
        self.count(progress);
        Ok(())
    }

    /// Rank 0 goes on with the other bearings where it fails.
    fn reduce(&mut self) -> Result<(), Failure> {
        let found = &self.found;
        let (step, time) = (found.step, self.list.time(found.step));
        let mut reduced = Ok(());
        for (i, files) in self.files.iter_mut().enumerate() {
            reduced = reduced.and(files.reduce(step, time, &found.shown(i), &found.placed[i]));
        }
        reduced
    }

    fn append_rows(&mut self) -> Result<(), Failure> {
        let found = &mut self.found;
        let (step, time) = (found.step, self.list.time(found.step));
        let now = ListState::of_equilibrium(&found.assembly, &found.last);
        found.tables.append((step, time), None, &found.assembly, &now)?;
        for (i, files) in self.files.iter_mut().enumerate() {
            files.write_tables(step, time, None, &self.list.snapshot(&found.last, i))?;
        }
        Ok(())
    }

    fn append_files(&mut self, restart: RestartState) -> Result<(), Failure> {
        let found = &self.found;
        let at = (found.step, self.list.time(found.step));
        let every = found.placed[0].output.every;
        let kept = every.kept(at.0, self.settings.output_every, self.settings.n_steps);
        let mut gathered = Vec::new();
        for (i, files) in self.files.iter_mut().enumerate() {
            gathered.push(files.gather_stress(&found.shown(i), kept));
        }
        let taken = self.ahead.taken().expect("the last equilibrium has been taken");
        for (i, (files, gathered)) in self.files.iter_mut().zip(gathered).enumerate() {
            if !files.are_written_here() {
                continue;
            }
            let state = several_quasi_state::arrays(taken, &found.counts, i);
            let (shown, placed) = (found.shown(i), (&found.placed[i], kept));
            let shown = Recorded::of_equilibrium(&shown, at, gathered, placed, state)?;
            files.write_fields_later(restart, move |stress| shown.record(stress))?;
        }
        Ok(())
    }
}
