//! `raceway run` of a list of bearings on one shaft at rest: one equilibrium, or those of a sweep.

use std::path::{Path, PathBuf};
use std::time::Instant;

use assembly::points::{AssemblyPoint, AssemblyPointStart, points_per_start};
use assembly::{Assembly, AssemblySolution, AssemblySolver};
use contact::Side;
use dynamics::Pose;
use results::failure::{Failure, agree, of_all};
use results::files::Files;
use results::memory::Forecasts;
use results::motion_fields::RestartState;
use results::seat;
use results::several::{ListState, SeveralFindings, SeveralSummary, SeveralTables};
use results::several_print::{print_solution, print_sweep_head, print_sweep_point};
use results::shown::Shown;
use results::stop::Stop;
use results::summary::{Findings, READ, TOTAL};
use results::survey::Survey;
use scene::{KeptFields, Rings, SeveralScene, assembly_with_rings};
use timer::Laps;

use crate::instants::{self, Due, OverInstants, WrittenSteps};
use crate::options::{Limits, SweepPart};
use crate::points_ahead::{Grouping, PointAnswer, PointsAhead};
use crate::progress::Progress;
use crate::remarks::Remarks;
use crate::several::{
    SeveralPoint, add_laps, at_point, column, make_folder, placed, points, require_same_list, say_types,
    snapshot, solving, stage_text, warnings_at, words_of,
};
use crate::several_files::close_bearing;
use crate::several_read::{ReadList, read_list, require_memory_of_all};
use crate::several_ready::forecast;

/// Runs a scene at rest, or a part of its sweep; its results go into a folder.
pub fn run(
    scene: &SeveralScene,
    part: Option<SweepPart>,
    dir: &Path,
    limits: &Limits,
    start: Instant,
) -> Result<(), Failure> {
    require_same_list(scene)?;
    let all = agree(points(scene))?;
    let chosen = part.map_or(0..all.len(), SweepPart::range);
    let (first, points) = (chosen.start as u64, &all[chosen]);
    let mut progress = Progress::new(points.len() as u64);
    progress.stage("reading meshes");
    let ReadList {
        assembly,
        remarks,
        surveys,
    } = agree(read_list(&points[0].1, scene, |assembly| {
        require_memory_of_all(scene, assembly)?;
        let all = forecast(scene, assembly, 0).times(points.len() as u64);
        all.require_space(dir, limits.ignore_disk_space)
    }))?;
    let read = start.elapsed().as_secs_f64();
    progress.stage("factoring the stiffness of the rings");
    let solver = AssemblySolver::new(&assembly).map_err(solving)?;
    say_types(&solver, &assembly, &progress);
    let rings: Vec<Rings> = assembly.bearings.iter().map(|b| b.model.rings.clone()).collect();
    let solve = |n: u64, from: Option<&AssemblyPointStart>| -> PointAnswer<AssemblyPoint, Assembly> {
        let mut assembly = assembly_with_rings(&points[n as usize].1, rings.clone())?;
        let poses = vec![Pose::default(); rings.len()];
        let found = solver.point(&mut assembly, &poses, from);
        Ok((found.map_err(solving)?, assembly))
    };
    let group = Grouping {
        size: points_per_start(&assembly),
        last: points.len() as u64 - 1,
    };
    let mut stop = agree(Stop::of_points(points.len(), start, limits.wall_time).map_err(Failure::from))?;
    let (cases, ended) = rayon::in_place_scope(|scope| {
        let mut cases = ListCases {
            scene,
            points,
            first,
            ahead: PointsAhead::new(scope, &solve, group, None),
            solved: SolvedLists::of_none(assembly, remarks),
            surveys,
            written: WrittenSteps::default(),
            dir,
        };
        let ended = instants::run(&mut cases, first, stop.as_mut(), &mut progress);
        (cases.solved, ended)
    });
    progress.finish();
    cases.conclude((scene, solver), ended, dir, (read, start))
}

/// Load cases of a list under way: their numbers stand for times.
struct ListCases<'a, 's, 'scope> {
    scene: &'a SeveralScene,
    points: &'a [SeveralPoint],
    /// Number of the first of them in the whole sweep.
    first: u64,
    ahead: PointsAhead<'s, 'scope, AssemblyPoint, Assembly>,
    solved: SolvedLists,
    /// What the files begin with, until there are some.
    surveys: Vec<Survey>,
    written: WrittenSteps,
    dir: &'a Path,
}

/// What has been solved of the load cases.
struct SolvedLists {
    /// At the last load case that was solved.
    assembly: Assembly,
    /// The first solution makes the folder: a scene that has none leaves no files.
    files: Option<SeveralFiles>,
    /// Number of load cases.
    n: u64,
    /// Solution of the last of them.
    last: Option<AssemblySolution>,
    /// Newton iterations so far.
    iterations: usize,
    remarks: Remarks,
    /// Wall time of all points by type of bearing, summed over threads.
    laps: Vec<Laps>,
}

impl ListCases<'_, '_, '_> {
    fn point(&self, n: u64) -> &SeveralPoint {
        &self.points[(n - self.first) as usize]
    }

    /// What has been solved last, with its files and its load case.
    fn last(&mut self) -> (&mut SeveralFiles, SolvedList<'_>) {
        let (value, point) = &self.points[self.solved.n as usize - 1];
        let solved = SolvedList {
            step: self.first + self.solved.n - 1,
            value: *value,
            point,
            assembly: &self.solved.assembly,
            solution: self.solved.last.as_ref().expect("a load case has been solved"),
        };
        let files = self.solved.files.as_mut();
        (files.expect("a solution has made the files"), solved)
    }
}

impl SolvedLists {
    fn of_none(assembly: Assembly, remarks: Remarks) -> SolvedLists {
        SolvedLists {
            assembly,
            files: None,
            n: 0,
            last: None,
            iterations: 0,
            remarks,
            laps: Vec::new(),
        }
    }

    /// Takes note of a load case whose words in messages are `at`.
    fn take(&mut self, (point, assembly): (AssemblyPoint, Assembly), at: &str) {
        let AssemblyPoint { solution, laps, .. } = point;
        self.remarks
            .warnings
            .extend(warnings_at(at, &assembly, &solution));
        self.iterations += solution.shaft.iterations;
        add_laps(&mut self.laps, &laps);
        (self.assembly, self.last) = (assembly, Some(solution));
        self.n += 1;
    }

    /// Closes the files, writes the summary of the load cases that were solved, and prints the results of a run without
    /// a failure; it was read until `read`, s, after `start`.
    fn conclude(
        mut self,
        (scene, mut solver): (&SeveralScene, AssemblySolver),
        ended: Result<(), Failure>,
        dir: &Path,
        (read, start): (f64, Instant),
    ) -> Result<(), Failure> {
        let (Some(files), Some(last)) = (self.files.take(), self.last.take()) else {
            return ended;
        };
        solver.add_laps(&self.laps);
        let mut laps = solver.laps();
        laps.add(READ, read);
        laps.add(TOTAL, start.elapsed().as_secs_f64());
        let status = ended.as_ref().err();
        let status = status.map_or("finished".to_string(), Failure::status);
        let found = (&self.assembly, &last, &*status);
        let seats = files.finish(scene, found, &solver, start);
        // A run that failed says why, not what its failure did to the files.
        let seats = match (seats, &ended) {
            (Err(_), Err(_)) => return ended,
            (seats, _) => seats?,
        };
        self.remarks.warnings.extend(seats);
        let findings = SeveralFindings {
            status,
            iterations: self.iterations,
            residual: last.shaft.error,
            warnings: self.remarks.warnings,
            advice: self.remarks.advice,
            laps,
        };
        let shown = ListState::of_equilibrium(&self.assembly, &last);
        let summary = SeveralSummary::new(scene, &self.assembly, &shown, findings);
        agree(summary.write(dir).map_err(Failure::from))?;
        ended?;
        if column(scene).is_none() {
            print_solution(&self.assembly, &shown);
        }
        summary.print_costs();
        Ok(())
    }
}

impl OverInstants for ListCases<'_, '_, '_> {
    fn due(&self) -> Due {
        Due {
            last: self.first + self.points.len() as u64 - 1,
            tables_every: 1,
            files_every: 1,
        }
    }

    fn written(&mut self) -> &mut WrittenSteps {
        &mut self.written
    }

    fn dir(&self) -> &Path {
        self.dir
    }

    fn now(&self) -> u64 {
        self.first + self.solved.n - 1
    }

    fn time(&self, n: u64) -> f64 {
        n as f64
    }

    fn stage(&self, n: u64, _first: u64) -> Option<String> {
        Some(stage_text(column(self.scene), self.point(n).0))
    }

    fn stop(&mut self, reason: &str) -> Failure {
        let counted = (self.first, self.solved.n, self.due().last);
        instants::stopped_sweep(reason, counted, self.dir)
    }

    fn advance(&mut self, n: u64, _progress: &mut Progress) -> Result<(), Failure> {
        let (value, column) = (self.point(n).0, column(self.scene));
        let found = self.ahead.take();
        let (point, assembly) = found.map_err(|failure| of_all(at_point(failure, column, value)))?;
        if self.solved.files.is_none() {
            let surveys = std::mem::take(&mut self.surveys);
            let first = (self.scene, surveys);
            let files = SeveralFiles::create(first, &assembly, &point.solution, self.dir)?;
            self.solved.files = Some(files);
        }
        self.solved.take((point, assembly), &words_of(column, value));
        Ok(())
    }

    fn reduce(&mut self) -> Result<(), Failure> {
        Ok(())
    }

    fn append_rows(&mut self) -> Result<(), Failure> {
        let (files, solved) = self.last();
        files.write_tables(&solved)
    }

    fn append_files(&mut self, _restart: RestartState) -> Result<(), Failure> {
        let (files, solved) = self.last();
        files.write_fields(&solved)
    }
}

/// A load case with its solution.
struct SolvedList<'a> {
    step: u64,
    /// The swept value.
    value: Option<f64>,
    point: &'a SeveralScene,
    assembly: &'a Assembly,
    solution: &'a AssemblySolution,
}

impl SolvedList<'_> {
    fn time(&self) -> f64 {
        self.step as f64
    }

    /// What is shown of a bearing.
    fn shown(&self, bearing: usize) -> Shown<'_> {
        let model = &self.assembly.bearings[bearing].model;
        Shown::at_rest(model, &model.geometry, &self.solution.bearings[bearing])
    }
}

/// The files of a run: tables of all bearings, and a folder for each.
struct SeveralFiles {
    tables: SeveralTables,
    bearings: Vec<(PathBuf, Files)>,
}

impl SeveralFiles {
    fn create(
        (scene, surveys): (&SeveralScene, Vec<Survey>),
        assembly: &Assembly,
        solution: &AssemblySolution,
        dir: &Path,
    ) -> Result<SeveralFiles, Failure> {
        let begun = agree(make_folder(scene, dir))?;
        let column = column(scene);
        let first = ListState::of_equilibrium(assembly, solution);
        let tables = SeveralTables::create(dir, column, &first);
        let tables = agree(tables.map_err(Failure::from))?;
        let mut bearings = Vec::new();
        for (((bearing, mounted), found), survey) in scene
            .bearings
            .iter()
            .zip(&assembly.bearings)
            .zip(&solution.bearings)
            .zip(surveys)
        {
            let own = dir.join(&bearing.name);
            let placed = agree(placed(&bearing.scene, found))?;
            let snapshot = snapshot(found);
            let files = Files::create_part(&placed, &mounted.model, &own, &snapshot, survey, &[]);
            bearings.push((own, agree(files)?));
        }
        agree(begun.end())?;
        if let Some(column) = column {
            print_sweep_head(column, assembly);
        }
        Ok(SeveralFiles { tables, bearings })
    }

    /// Appends a line per table, and prints that of a sweep. Rank 0 alone may fail.
    fn write_tables(&mut self, solved: &SolvedList<'_>) -> Result<(), Failure> {
        let (step, time) = (solved.step, solved.time());
        let found = ListState::of_equilibrium(solved.assembly, solved.solution);
        self.tables
            .append((step, time), solved.value, solved.assembly, &found)?;
        if let Some(value) = solved.value {
            print_sweep_point(value, &found);
        }
        for ((_, files), found) in self.bearings.iter_mut().zip(&solved.solution.bearings) {
            files.write_tables(step, time, None, &snapshot(found))?;
        }
        Ok(())
    }

    /// Writes step files. All ranks recover the stress of all bearings; then rank 0 writes, and may fail alone.
    fn write_fields(&mut self, solved: &SolvedList<'_>) -> Result<(), Failure> {
        let mut gathered = Vec::new();
        for (i, (_, files)) in self.bearings.iter_mut().enumerate() {
            gathered.push(files.gather_stress(&solved.shown(i), KeptFields::ALL));
        }
        for (i, ((_, files), gathered)) in self.bearings.iter_mut().zip(gathered).enumerate() {
            let found = &solved.solution.bearings[i];
            let placed = placed(&solved.point.bearings[i].scene, found)?;
            files.write_fields(|stress| {
                let (shown, at) = (solved.shown(i), (solved.step, solved.time()));
                results::fields::record(&shown, found, (stress, gathered), at, (&placed, KeptFields::ALL))
            })?;
        }
        Ok(())
    }

    /// Closes the files of the bearings, which have the status of the run; warns of their seats. Collective.
    fn finish(
        self,
        scene: &SeveralScene,
        (assembly, solution, status): (&Assembly, &AssemblySolution, &str),
        solver: &AssemblySolver,
        start: Instant,
    ) -> Result<Vec<String>, Failure> {
        let mut warnings = Vec::new();
        for (i, (dir, files)) in self.bearings.into_iter().enumerate() {
            let factors = solver.of_bearing(i);
            let forecast = Side::BOTH.map(|side| factors.ring(side).map(|r| r.solver.memory));
            let mounted = &assembly.bearings[i];
            let forecast = Forecasts::at_rest(forecast, (&scene.bearings[i].scene, &mounted.model));
            let found = &solution.bearings[i];
            let findings = Findings {
                status: status.to_string(),
                last: snapshot(found),
                points: Vec::new(),
                iterations: std::collections::BTreeMap::from([
                    ("rounds", found.rounds),
                    ("newton", found.newton_iterations),
                ]),
                warnings: found.warnings.clone(),
                advice: Vec::new(),
            };
            warnings.extend(close_bearing(
                files,
                (&scene.bearings[i].scene, &assembly.bearings, i),
                &dir,
                (findings, forecast, factors.laps()),
                |own| seat::of_run(&mounted.model, found, own),
                start,
            )?);
        }
        Ok(warnings)
    }
}
