//! `raceway run` of a list of bearings on one shaft at rest: one equilibrium, or those of a sweep.

use std::path::{Path, PathBuf};
use std::time::Instant;

use assembly::{Assembly, AssemblySolution, AssemblySolver};
use contact::Side;
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
use scene::{KeptFields, SeveralScene, assembly_with_rings};

use crate::instants::{self, Due, OverInstants, WrittenSteps};
use crate::options::Limits;
use crate::progress::Progress;
use crate::several::{
    SeveralPoint, at_point, column, make_folder, placed, points, require_same_list, say_types, snapshot,
    solving, stage_text, warnings_at, words_of,
};
use crate::several_files::close_bearing;
use crate::several_read::{ReadList, read_list, require_memory_of_all};

/// Runs a scene at rest; its results go into a folder.
pub fn run(scene: &SeveralScene, dir: &Path, limits: &Limits, start: Instant) -> Result<(), Failure> {
    require_same_list(scene)?;
    let points = agree(points(scene))?;
    let mut progress = Progress::new(points.len() as u64);
    progress.stage("reading meshes");
    let ReadList {
        assembly,
        doubts,
        surveys,
    } = agree(read_list(&points[0].1, scene, |assembly| {
        require_memory_of_all(scene, assembly)
    }))?;
    let read = start.elapsed().as_secs_f64();
    progress.stage("factoring the stiffness of the rings");
    let solver = AssemblySolver::new(&assembly).map_err(solving)?;
    say_types(&solver, &assembly, &progress);
    let mut cases = ListCases {
        scene,
        points: &points,
        assembly,
        solver,
        surveys,
        files: None,
        solved: 0,
        last: None,
        iterations: 0,
        warnings: doubts,
        written: WrittenSteps::default(),
        dir,
    };
    let mut stop = agree(Stop::of_points(points.len(), start, limits.wall_time).map_err(Failure::from))?;
    let ended = instants::run(&mut cases, 0, stop.as_mut(), &mut progress);
    progress.finish();
    cases.conclude(ended, (read, start))
}

/// Load cases of a list under way: their numbers stand for times.
struct ListCases<'a> {
    scene: &'a SeveralScene,
    points: &'a [SeveralPoint],
    /// At the last load case that was solved.
    assembly: Assembly,
    solver: AssemblySolver,
    /// What the files begin with, until there are some.
    surveys: Vec<Survey>,
    /// The first solution makes the folder: a scene that has none leaves no files.
    files: Option<SeveralFiles>,
    /// Number of load cases that were solved.
    solved: u64,
    /// Solution of the last of them.
    last: Option<AssemblySolution>,
    /// Newton iterations so far.
    iterations: usize,
    warnings: Vec<String>,
    written: WrittenSteps,
    dir: &'a Path,
}

impl ListCases<'_> {
    /// What has been solved last, with its files and its load case.
    fn last(&mut self) -> (&mut SeveralFiles, SolvedList<'_>) {
        let (value, point) = &self.points[self.solved as usize - 1];
        let solved = SolvedList {
            step: self.solved - 1,
            value: *value,
            point,
            assembly: &self.assembly,
            solution: self.last.as_ref().expect("a load case has been solved"),
        };
        let files = self.files.as_mut();
        (files.expect("a solution has made the files"), solved)
    }

    /// Closes the files, writes the summary of the load cases that were solved, and prints the results of a run without
    /// a failure; it was read until `read`, s, after `start`.
    fn conclude(mut self, ended: Result<(), Failure>, (read, start): (f64, Instant)) -> Result<(), Failure> {
        let (Some(files), Some(last)) = (self.files.take(), self.last.take()) else {
            return ended;
        };
        let (scene, assembly) = (self.scene, &self.assembly);
        let mut laps = self.solver.laps();
        laps.add(READ, read);
        laps.add(TOTAL, start.elapsed().as_secs_f64());
        let seats = files.finish(scene, (assembly, &last), &self.solver, start);
        // A run that failed says why, not what its failure did to the files.
        let seats = match (seats, &ended) {
            (Err(_), Err(_)) => return ended,
            (seats, _) => seats?,
        };
        self.warnings.extend(seats);
        let status = ended.as_ref().err();
        let findings = SeveralFindings {
            status: status.map_or("finished".to_string(), Failure::status),
            iterations: self.iterations,
            residual: last.shaft.error,
            warnings: self.warnings,
            laps,
        };
        let shown = ListState::of_equilibrium(assembly, &last);
        let summary = SeveralSummary::new(scene, assembly, &shown, findings);
        agree(summary.write(self.dir).map_err(Failure::from))?;
        ended?;
        if column(scene).is_none() {
            print_solution(assembly, &shown);
        }
        summary.print_costs();
        Ok(())
    }
}

impl OverInstants for ListCases<'_> {
    fn due(&self) -> Due {
        Due {
            last: self.points.len() as u64 - 1,
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
        self.solved - 1
    }

    fn time(&self, n: u64) -> f64 {
        n as f64
    }

    fn stage(&self, n: u64, _first: u64) -> Option<String> {
        Some(stage_text(column(self.scene), self.points[n as usize].0))
    }

    fn stop(&mut self, reason: &str) -> Failure {
        let next = words_of(column(self.scene), self.points[self.solved as usize].0);
        let others =
            format!("{next}the first of the others, which a sweep of their values has in another folder");
        instants::stopped_sweep(reason, (0, self.solved, self.due().last), self.dir, &others)
    }

    fn advance(&mut self, n: u64, _progress: &mut Progress) -> Result<(), Failure> {
        let ((value, point), column) = (&self.points[n as usize], column(self.scene));
        let rings = self.assembly.bearings.iter().map(|b| b.model.rings.clone());
        let mut assembly = assembly_with_rings(point, rings.collect())?;
        let found = self.solver.solve(&mut assembly, self.last.as_ref());
        let found = found.map_err(|error| of_all(at_point(solving(error), column, *value)))?;
        if self.files.is_none() {
            let surveys = std::mem::take(&mut self.surveys);
            self.files = Some(SeveralFiles::create(
                (self.scene, surveys),
                &assembly,
                &found,
                self.dir,
            )?);
        }
        let at = words_of(column, *value);
        self.warnings.extend(warnings_at(&at, &assembly, &found));
        self.iterations += found.shaft.iterations;
        (self.assembly, self.last, self.solved) = (assembly, Some(found), n + 1);
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
        agree(make_folder(scene, dir))?;
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

    /// Closes the files of the bearings; warns of their seats. Collective.
    fn finish(
        self,
        scene: &SeveralScene,
        (assembly, solution): (&Assembly, &AssemblySolution),
        solver: &AssemblySolver,
        start: Instant,
    ) -> Result<Vec<String>, Failure> {
        let mut warnings = Vec::new();
        for (i, (dir, files)) in self.bearings.into_iter().enumerate() {
            let factors = solver.of_bearing(i);
            let forecast = Side::BOTH.map(|side| factors.ring(side).map(|r| r.solver.memory));
            let mounted = &assembly.bearings[i];
            let forecast = Forecasts::at_rest(forecast, &mounted.model);
            let found = &solution.bearings[i];
            let findings = Findings {
                status: "finished".to_string(),
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
