//! What a finished run tells of a bearing's life: its scene, the forces of its balls, and how its rings turned.

use std::f64::consts::TAU;
use std::path::Path;

use anyhow::{Context, anyhow, bail, ensure};
use checkpoint::{all_steps, open_regular, read_any_step};
use comm::print;
use contact::Side;
use dynamics::kinematics::{BothRings, Kinematics, Rolling};
use results::ball_turns::BallTurns;
use results::failure::Failure;
use results::integrity::doubts;
use results::list_folder::not_ended;
use results::summary::{SUMMARY_FILE, other_version, require_known_summary};
use results::table::Table;
use scene::{Analysis, MeshFiles, Scene, geometry, rolling, speeds, time_below};

use crate::assess::{Exposure, Rated, life_of};
use crate::damage::{History, RingMotion, at_rest, bearing_life, even_life};
use crate::equivalent::{BearingLoad, EquivalentLoads};
use crate::error::LifeError;
use crate::spacing::Spacing;

/// Name of the table of the balls.
const BALLS: &str = "balls.csv";
/// Shorter histories may not have met all loads, turns.
const WHOLE_TURN: f64 = 1.0;
/// Difference of lives that is worth a word.
const NOTABLE: f64 = 0.01;

/// A finished run.
pub struct FinishedRun {
    /// Its scene; of a sweep that of each point, in the order of the steps.
    scenes: Vec<Scene>,
    /// Column of the swept value.
    pub column: Option<String>,
    table: Table,
    /// First row of each step, and the end, `[n_steps + 1]`.
    starts: Vec<usize>,
}

/// A point of a sweep, or the one equilibrium of a scene.
pub struct SweepLife {
    /// Swept value, SI; None for one equilibrium, NaN for a word.
    pub value: Option<f64>,
    /// What the bearing went through.
    pub exposure: Exposure,
}

impl FinishedRun {
    /// Reads the run in `dir`, which must have finished and be as it was written. `overrides` change `[life]` only.
    pub fn read(dir: &Path, overrides: &[String]) -> Result<FinishedRun, Failure> {
        require_finished(dir)?;
        if let Some(doubt) = doubts(dir)?.first() {
            return Err(anyhow!("{doubt}; life is counted from whole results only").into());
        }
        if let Some(note) = other_version(dir) {
            print::note(format_args!("warning: {note}"));
        }
        let is_life = |argument: &&String| {
            let key = argument.split('=').next().unwrap_or_default().trim();
            key == "life" || key.starts_with("life.")
        };
        if let Some(other) = overrides.iter().find(|argument| !is_life(argument)) {
            let said =
                format!("--set {other}: a finished run keeps its scene; only life.* may be changed here");
            return Err(anyhow!(said).into());
        }
        let table = balls(dir)?;
        let scene_of = |step: u64| -> Result<Scene, Failure> {
            let text = read_any_step(dir, step)?.scene;
            let path = dir.join("scene");
            Ok(Scene::parse(&text, &path, overrides, MeshFiles::MayBeMissing)?)
        };
        let column = swept_column(&table);
        let scenes = match column {
            Some(_) => {
                let mut steps: Vec<u64> = table.column("step")?.iter().map(|step| *step as u64).collect();
                steps.dedup();
                steps.into_iter().map(scene_of).collect::<Result<Vec<_>, _>>()?
            }
            None => vec![scene_of(newest_step(dir)?)?],
        };
        Ok(FinishedRun::new(scenes, table, dir)?)
    }

    /// The run of a scene whose tables in `dir` are whole, at its end.
    pub fn ending(scene: &Scene, dir: &Path) -> Result<FinishedRun, Failure> {
        let table = balls(dir)?;
        let mut steps: Vec<usize> = table.column("step")?.iter().map(|step| *step as usize).collect();
        steps.dedup();
        let scenes = match &scene.analysis {
            // A run may have solved some points only.
            Analysis::Sweep(_) => {
                let all = scene.sweep_scenes()?;
                steps.iter().filter_map(|step| all.get(*step).cloned()).collect()
            }
            _ => vec![scene.clone()],
        };
        Ok(FinishedRun::new(scenes, table, dir)?)
    }

    /// The life at the end of a run: of a history, or of its last point.
    pub fn last(&self) -> Result<Exposure, Failure> {
        if self.is_history() {
            return self.history();
        }
        let last = self.scenes.len() - 1;
        self.point(&self.scenes[last], last)
    }

    /// The run of these scenes, one of each point of a sweep, with its table.
    fn new(scenes: Vec<Scene>, table: Table, dir: &Path) -> anyhow::Result<FinishedRun> {
        let is_modes = scenes
            .iter()
            .any(|scene| matches!(scene.analysis, Analysis::Modes(_)));
        ensure!(
            !is_modes,
            "{} holds natural modes, which have no contact forces; expected equilibria or a motion",
            dir.display()
        );
        let steps = table.column("step")?;
        let is_first = |&row: &usize| row == 0 || steps[row] != steps[row - 1];
        let mut starts: Vec<usize> = (0..steps.len()).filter(is_first).collect();
        starts.push(steps.len());
        let (found, expected) = (starts[1], scenes[0].bearing.balls);
        ensure!(
            found == expected,
            "{}: {BALLS} has {found} balls, the scene {expected}",
            dir.display()
        );
        Ok(FinishedRun {
            scenes,
            column: swept_column(&table),
            table,
            starts,
        })
    }

    /// Whether steps are instants of one history.
    pub fn is_history(&self) -> bool {
        matches!(
            self.scenes[0].analysis,
            Analysis::QuasiStatic(_) | Analysis::Dynamic(_)
        )
    }

    /// What the bearing went through in a history.
    pub fn history(&self) -> Result<Exposure, Failure> {
        let scene = &self.scenes[0];
        let rated = Rated::of_scene(scene)?;
        let rolling = rolling(scene).ok_or(LifeError::NoTurning)?;
        let history = self.passes(&rolling)?;
        let turning = Kinematics::new(&geometry(scene), BothRings::default());
        let n_balls = scene.bearing.balls as f64;
        let per_turn = [n_balls * (1.0 - turning.cage), n_balls * turning.cage];
        let damage = |side: Side| {
            let i = side.index();
            history.damage(side, rated.raceways[i], per_turn[i])
        };
        let [inner, outer] = Side::BOTH.map(damage);
        let damage = [inner?, outer?];
        let loads = self.loads()?;
        let times = self.table.column("time_s")?;
        let duration = times[times.len() - 1] - times[0];
        let mut exposure = Exposure {
            equivalent: EquivalentLoads {
                dynamic: cubic_mean(&history, &loads, &rated),
                at_rest: most(loads.iter().map(|load| load.at_rest(&rated.bearing))),
            },
            peak_pressure: self.peak_pressure(0..self.table.n_rows())?,
            speed: Some(history.turns() * TAU / duration),
            damage,
            rated,
            notes: Vec::new(),
        };
        exposure.notes = history_notes(&history, &exposure);
        exposure.notes.extend(self.wide_rows(&history, duration));
        Ok(exposure)
    }

    /// Azimuths, angles and forces of a history.
    fn passes(&self, rolling: &Rolling) -> anyhow::Result<History> {
        let (times, azimuths) = (self.table.column("time_s")?, self.table.column("azimuth_rad")?);
        let turns = BallTurns::new(&self.table, &self.scenes[0])?;
        let forces = Side::BOTH.map(|side| self.table.column(&format!("{}_force_n", side.name())));
        let [inner, outer] = forces;
        let (inner, outer) = (inner?, outer?);
        let mut history = History::default();
        for rows in self.starts.windows(2).map(|w| w[0]..w[1]) {
            let pose = rolling.pose(times[rows.start]);
            history.ring_angles.push(pose.ring_angles);
            let next = match history.azimuths.last() {
                Some(before) => before
                    .iter()
                    .zip(rows.clone())
                    .map(|(before, row)| before + turns.between(row - rows.len(), row))
                    .collect(),
                None => azimuths[rows.clone()].to_vec(),
            };
            history.azimuths.push(next);
            history
                .forces
                .push(rows.map(|row| [inner[row], outer[row]]).collect());
        }
        Ok(history)
    }

    /// Where the rows of a history of a duration, s, lie too far apart for its forces: that, and what to do.
    fn wide_rows(&self, history: &History, duration: f64) -> Option<String> {
        let spacing = Some(Spacing::of(history)).filter(Spacing::is_too_wide)?;
        let (table, step) = match &self.scenes[0].analysis {
            Analysis::Dynamic(dynamic) => ("dynamic", dynamic.step),
            Analysis::QuasiStatic(quasi) => ("quasi_static", quasi.step),
            Analysis::Static | Analysis::Sweep(_) | Analysis::Modes(_) => return None,
        };
        let apart = duration / (self.starts.len() - 2) as f64;
        // Whole numbers come with round-off.
        let steps = (1.0 + 1e-9) * spacing.needed() * apart / step;
        let expected = match (steps >= 1.0, self.scenes[0].output.tables_every) {
            (true, _) => format!("output.tables_every of {} or less", steps.floor()),
            (false, 1) => format!("{table}.step of {} or less", time_below(steps * step)),
            (false, _) => format!(
                "output.tables_every of 1 and {table}.step of {} or less",
                time_below(steps * step)
            ),
        };
        Some(format!(
            "warning: rows of {BALLS} lie {:.2} ball pitches apart, and forces change much from one to the next: \
             lives of the rings may be off by {}; expected {expected}",
            spacing.pitches,
            spacing.error()
        ))
    }

    /// Every point of a sweep, or the one of a static scene.
    pub fn points(&self) -> Result<Vec<SweepLife>, Failure> {
        let values = self
            .column
            .as_ref()
            .map(|column| self.table.column(column))
            .transpose()?;
        let point = |(step, scene): (usize, &Scene)| {
            Ok(SweepLife {
                value: values.map(|values| values[self.starts[step]]),
                exposure: self.point(scene, step)?,
            })
        };
        self.scenes.iter().enumerate().map(point).collect()
    }

    /// What the bearing goes through in the equilibrium of a step.
    fn point(&self, scene: &Scene, step: usize) -> Result<Exposure, Failure> {
        let rated = Rated::of_scene(scene)?;
        let rows = self.starts[step]..self.starts[step + 1];
        let load = &self.loads()?[step];
        let motion = ring_motion(scene);
        let first = self.table.column("azimuth_rad")?[rows.start];
        let damage = |side: Side| -> anyhow::Result<_> {
            let forces = &self.table.column(&format!("{}_force_n", side.name()))?[rows.clone()];
            let i = side.index();
            Ok(at_rest(forces, rated.raceways[i], first, motion[i]))
        };
        let [inner, outer] = Side::BOTH.map(damage);
        let speed = scene.speed.as_ref().map(|speeds| speeds.relative(0.0).abs());
        let mut notes = Vec::new();
        if speed.is_none() {
            notes.push(
                "nothing turns in this run: the inner ring is taken to turn, the outer one to stand"
                    .to_string(),
            );
        }
        Ok(Exposure {
            equivalent: load.equivalent(&rated.bearing),
            peak_pressure: self.peak_pressure(rows)?,
            speed: speed.filter(|speed| *speed > 0.0),
            damage: [inner?, outer?],
            rated,
            notes,
        })
    }

    /// Force of the balls on the inner ring at every step.
    fn loads(&self) -> anyhow::Result<Vec<BearingLoad>> {
        let [force, angle, azimuth] =
            ["inner_force_n", "inner_contact_angle_rad", "azimuth_rad"].map(|name| self.table.column(name));
        let (force, angle, azimuth) = (force?, angle?, azimuth?);
        let of_step = |rows: std::ops::Range<usize>| {
            let mut sum = [0.0; 3];
            for row in rows {
                let radial = force[row] * angle[row].cos();
                sum[0] += radial * azimuth[row].cos();
                sum[1] += radial * azimuth[row].sin();
                sum[2] += force[row] * angle[row].sin();
            }
            let [x, y, z] = sum;
            let (radial, axial) = (x.hypot(y), z.abs());
            // Forces of balls that balance leave round-off.
            let without_noise = |part: f64| if part < 1e-9 * (radial + axial) { 0.0 } else { part };
            BearingLoad {
                radial: without_noise(radial),
                axial: without_noise(axial),
            }
        };
        Ok(self.starts.windows(2).map(|w| of_step(w[0]..w[1])).collect())
    }

    fn peak_pressure(&self, rows: std::ops::Range<usize>) -> anyhow::Result<f64> {
        let sides = Side::BOTH.map(|side| self.table.column(&format!("{}_peak_pressure_pa", side.name())));
        let [inner, outer] = sides;
        let (inner, outer) = (inner?, outer?);
        Ok(most(rows.map(|row| inner[row].max(outer[row]))))
    }
}

fn most(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, f64::max)
}

/// Which rings turn in an equilibrium; without a speed the inner one.
pub fn ring_motion(scene: &Scene) -> [RingMotion; 2] {
    let speeds = speeds(scene);
    if speeds.is_zero() {
        return [RingMotion::Turns, RingMotion::Stands];
    }
    Side::BOTH.map(|side| match speeds.of(side).is_zero() {
        true => RingMotion::Stands,
        false => RingMotion::Turns,
    })
}

/// P of a history: cubic mean over the turns of the rings against each other.
fn cubic_mean(history: &History, loads: &[BearingLoad], rated: &Rated) -> f64 {
    let relative = |[inner, outer]: BothRings| inner - outer;
    let cubes: Vec<f64> = loads
        .iter()
        .map(|load| load.dynamic(&rated.bearing).powi(3))
        .collect();
    let (mut sum, mut way) = (0.0, 0.0);
    for row in 1..cubes.len() {
        let step = (relative(history.ring_angles[row]) - relative(history.ring_angles[row - 1])).abs();
        sum += 0.5 * (cubes[row - 1] + cubes[row]) * step;
        way += step;
    }
    (sum / way).cbrt()
}

/// How much longer a life is, by its ratio to the other.
fn longer(ratio: f64) -> String {
    match ratio < 10.0 {
        true => format!("{:.1} % longer", 100.0 * (ratio - 1.0)),
        false if ratio < 1000.0 => format!("{ratio:.0} times as long"),
        false => "more than 1000 times as long".to_string(),
    }
}

/// What a reader must know of a history.
fn history_notes(history: &History, exposure: &Exposure) -> Vec<String> {
    let turns = history.turns();
    let even = Side::BOTH.map(|side| even_life(&exposure.damage[side.index()]));
    let even = bearing_life(even);
    let life = life_of(&exposure.damage);
    let mut notes = vec![format!(
        "the history of {turns:.4} turns of one ring against the other is taken to go on for ever"
    )];
    if turns < WHOLE_TURN && even > (1.0 + NOTABLE) * life {
        notes.push(format!(
            "warning: in less than one turn the positions of a ring that turns may not have met all loads; with even \
             damage L_10r would be {}, compute a longer history",
            longer(even / life)
        ));
    }
    notes
}

/// Fails unless the run in `dir` has come to its end.
fn require_finished(dir: &Path) -> anyhow::Result<()> {
    ensure!(
        dir.is_dir(),
        "{} is no folder; expected the results of a run",
        dir.display()
    );
    let path = dir.join(SUMMARY_FILE);
    if !path.exists() {
        bail!(not_ended(dir).text());
    }
    let text = std::io::read_to_string(open_regular(&path)?)
        .with_context(|| format!("cannot read {}", path.display()))?;
    let summary: serde_json::Value =
        serde_json::from_str(&text).with_context(|| format!("{} is damaged", path.display()))?;
    require_known_summary(dir)?;
    let status = summary["status"].as_str().unwrap_or("unknown");
    ensure!(
        status == "finished" || summary["analysis"] != "sweep",
        "{} holds a sweep that has stopped ({status}); the points left are computed by the same command with --points \
         and another --out, or run it again",
        dir.display()
    );
    ensure!(
        status == "finished",
        "{} holds a run that has not finished ({status}); resume it, or run it again",
        dir.display()
    );
    Ok(())
}

/// The table of the balls.
fn balls(dir: &Path) -> anyhow::Result<Table> {
    let missing = || {
        format!(
            "{} has no {BALLS}; expected the forces of the balls of a run",
            dir.display()
        )
    };
    Table::read(dir, BALLS)?.with_context(missing)
}

/// The third column of a sweep is the swept value.
fn swept_column(table: &Table) -> Option<String> {
    let third = table.names().get(2)?;
    (third != "ball").then(|| third.clone())
}

/// The newest step file, which holds the scene of the run.
fn newest_step(dir: &Path) -> anyhow::Result<u64> {
    let step = all_steps(dir)?.last().copied();
    step.with_context(|| {
        format!(
            "{} has no step file, which would hold the scene of the run",
            dir.display()
        )
    })
}
