//! The end of equilibria over time of a list of bearings: what has been found of them, and how that is summed up.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use assembly::{Assembly, AssemblySolution, AssemblySolver};
use comm::print;
use contact::Side;
use dynamics::kinematics::Rolling;
use results::failure::{Failure, agree};
use results::files::Files;
use results::memory::Forecasts;
use results::seat;
use results::several::{ListState, SeveralFindings, SeveralSummary, SeveralTables};
use results::several_print::print_solution;
use results::shown::Shown;
use results::snapshot::Snapshot;
use results::summary::{Findings, READ, TOTAL};
use scene::{QuasiStatic, Scene, SeveralScene};
use timer::Laps;

use crate::instants;
use crate::remarks::Remarks;
use crate::several_files::close_bearing;
use crate::several_quasi_state::ListCounts;

/// What has been found and written of a run.
pub struct FoundList {
    /// Scenes of the bearings with the shaft where it was at the start.
    pub placed: Vec<Scene>,
    /// Tables of the list.
    pub tables: SeveralTables,
    /// Number of the last equilibrium.
    pub step: u64,
    /// The list with the loads of the last equilibrium.
    pub assembly: Assembly,
    /// The last equilibrium.
    pub last: AssemblySolution,
    /// What has been counted.
    pub counts: ListCounts,
    /// Warnings of the first instant of this process that had any.
    pub first_warnings: Vec<String>,
    /// Wall time of all points by type of bearing, summed over threads.
    pub laps: Vec<Laps>,
}

impl FoundList {
    /// What is shown of a bearing.
    pub fn shown(&self, bearing: usize) -> Shown<'_> {
        let model = &self.assembly.bearings[bearing].model;
        Shown::at_rest(model, &model.geometry, &self.last.bearings[bearing])
    }

    /// Closes the files of the bearings and writes their summaries; warns of their seats. Collective.
    fn close(
        &self,
        files: Vec<Files>,
        (solver, rolling): (&AssemblySolver, &[Option<Rolling>]),
        (dir, status): (&Path, &str),
        start: Instant,
    ) -> Result<Vec<String>, Failure> {
        let mut warnings = Vec::new();
        for (i, files) in files.into_iter().enumerate() {
            let (mounted, factors) = (&self.assembly.bearings[i], solver.of_bearing(i));
            let forecast = Side::BOTH.map(|side| factors.ring(side).map(|r| r.solver.memory));
            let forecast = Forecasts::at_rest(forecast, (&self.placed[i], &mounted.model));
            let found = &self.last.bearings[i];
            let [rounds, newton] = self.counts.of_bearings[i].map(|count| count as usize);
            let steps = self.step as usize;
            let findings = Findings {
                status: status.to_string(),
                last: Snapshot::of_equilibrium(found, rolling[i].as_ref()),
                points: Vec::new(),
                iterations: BTreeMap::from([("steps", steps), ("rounds", rounds), ("newton", newton)]),
                warnings: found.warnings.clone(),
                advice: Vec::new(),
            };
            warnings.extend(close_bearing(
                files,
                (&self.placed[i], &self.assembly.bearings, i),
                &dir.join(&mounted.name),
                (findings, forecast, factors.laps()),
                |own| seat::of_run(&mounted.model, found, own),
                start,
            )?);
        }
        Ok(warnings)
    }
}

/// A run that has come to its end, or ended early.
pub struct EndedList {
    /// Of the scene.
    pub settings: QuasiStatic,
    /// What it has found.
    pub found: FoundList,
    /// Its files, by bearing.
    pub files: Vec<Files>,
    /// How it ended.
    pub ended: Result<(), Failure>,
    /// Number of equilibria of this process but the first.
    pub steps: u64,
    /// The time they took, s.
    pub seconds: f64,
}

impl EndedList {
    /// Closes the files and sums up, also when the run has ended early. The list was read until `read`, s, after
    /// `start`.
    pub fn conclude(
        self,
        (scene, mut solver, rolling): (&SeveralScene, AssemblySolver, &[Option<Rolling>]),
        dir: &Path,
        remarks: Remarks,
        (read, start): (f64, Instant),
    ) -> Result<(), Failure> {
        let EndedList {
            settings,
            mut found,
            files,
            ended,
            steps,
            seconds,
        } = self;
        solver.add_laps(&found.laps);
        let failed = ended.as_ref().err();
        let status = failed.map_or("finished".to_string(), Failure::status);
        let remarks = remarks
            .with(std::mem::take(&mut found.first_warnings))
            .with(instants::more_warn(found.counts.warned));
        // A run that failed says why, not what its failure did to the files; one that stopped must have its step.
        let of_seats = match (
            found.close(files, (&solver, rolling), (dir, &status), start),
            &ended,
        ) {
            (Err(_), Err(Failure::User(_) | Failure::Numerical(_))) => return ended,
            (of_seats, _) => of_seats?,
        };
        let remarks = remarks.with(of_seats);
        let mut laps = Laps::default();
        laps.add(READ, read);
        laps.merge(&solver.laps());
        laps.add(TOTAL, start.elapsed().as_secs_f64());
        let last = ListState::of_equilibrium(&found.assembly, &found.last);
        let findings = SeveralFindings {
            status,
            iterations: found.counts.iterations as usize,
            residual: found.last.shaft.error,
            warnings: remarks.warnings,
            advice: remarks.advice,
            laps,
        };
        let summary = SeveralSummary::new(scene, &found.assembly, &last, findings);
        agree(summary.write(dir).map_err(Failure::from))?;
        ended?;
        print_solution(&found.assembly, &last);
        print::line(format_args!("{}", instants::pace(steps, settings.step, seconds)));
        summary.print_costs();
        Ok(())
    }
}
