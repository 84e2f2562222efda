//! `raceway stiffness`: the stiffness and damping of the shaft on its bearing, at the operating point of a scene or at
//! every point of its sweep.
//!
//! A scene that runs in time is linearised about the equilibrium of one instant: loads, prescribed displacements and
//! places of the balls of that time, without inertia.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use anyhow::anyhow;
use clap::Args;
use comm::print;
use contact::Side;
use dynamics::bodies::AXES;
use dynamics::stiffness::{ShaftMatrix, softest};
use dynamics::{Linearisation, Model, Pose, StaticSolution, StaticSolver};
use results::console::at_value;
use results::failure::Failure;
use results::stiffness::{
    NOT_OVER_SPEED, OperatingPoint, ROSS_TABLE, Ripple, STIFFNESS_FILE, STIFFNESS_TABLE, StiffnessAt,
    StiffnessResults, require_positions,
};
use results::survey::say_doubts;
use results::whole::{make_asked_folder, require_free};
use scene::{Analysis, AnyScene, Scene, build_model, doubts, model_with_rings, rolling};

use crate::campbell_files::cage_speed;
use crate::damping::{damping_note, laws};
use crate::linear_figures::draw;
use crate::progress::Progress;
use crate::run::{SweptScene, points, stage_text};
use crate::several_stiffness;

/// Lowest eigenvalue over the largest at which a matrix counts as not positive: far above its round-off.
const NOT_POSITIVE: f64 = 1e-9;

/// What the command line asks for.
#[derive(Debug, Args)]
pub struct StiffnessCommand {
    /// Scene file; of a sweep every point is linearised.
    scene: PathBuf,
    /// Changes a value of the scene: path=value, such as effects.axial_force.value="3 kN".
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// Folder of stiffness.json, stiffness.csv, ross.csv and figures; nothing in it is replaced.
    #[arg(long)]
    out: PathBuf,
    /// Ball-pass ripple: balls at so many places of a pitch; smallest, mean and largest of every entry.
    #[arg(long, value_name = "N")]
    ripple: Option<usize>,
    /// Instant of a scene that runs in time, s; default: its start.
    #[arg(long, value_name = "SECONDS")]
    time: Option<f64>,
}

/// Linearises and writes.
pub fn stiffness(command: &StiffnessCommand) -> Result<(), Failure> {
    let scene = AnyScene::load(&command.scene, &command.overrides)?;
    let scene = match of_run(scene) {
        AnyScene::One(scene) => *scene,
        AnyScene::Several(list) => {
            let time = instant((&list.analysis, &list.path), command.time)?;
            return several_stiffness::stiffness(&list, (time, command.ripple), &command.out);
        }
    };
    let time = instant((&scene.analysis, &scene.path), command.time)?;
    require_positions(command.ripple)?;
    require_free(&command.out, &[STIFFNESS_FILE, STIFFNESS_TABLE, ROSS_TABLE])?;
    let results = linearise(&scene, time, command.ripple)?;
    make_asked_folder(&command.out)?;
    let names = results.write(&command.out)?;
    results.print();
    let mut names: Vec<String> = names.into_iter().map(str::to_string).collect();
    names.extend(draw(&command.out)?);
    if !results.suits_ross() {
        print::line(format_args!("no {ROSS_TABLE}: {NOT_OVER_SPEED}"));
    }
    print::line(format_args!("{} in {}", names.join(", "), command.out.display()));
    Ok(())
}

/// A scene without what turns with the shaft: an unbalance pulls every way in a turn, so it excites motions about the
/// mean place of the shaft and is no part of it.
pub fn steady(scene: AnyScene) -> AnyScene {
    let (scene, had_unbalance) = scene.without_unbalance();
    if had_unbalance {
        print::note(format_args!(
            "note: [effects.unbalance] turns with the shaft and is left out of the equilibrium"
        ));
    }
    scene
}

/// The same but for equilibria over time, which have an unbalance where it stands at their instant.
fn of_run(scene: AnyScene) -> AnyScene {
    let analysis = match &scene {
        AnyScene::One(scene) => &scene.analysis,
        AnyScene::Several(list) => &list.analysis,
    };
    match analysis {
        Analysis::QuasiStatic(_) => scene,
        _ => steady(scene),
    }
}

/// The instant at which a scene of this analysis and file is linearised, s.
pub fn instant((analysis, path): (&Analysis, &Path), asked: Option<f64>) -> Result<f64, Failure> {
    let duration = match analysis {
        Analysis::Dynamic(dynamic) => dynamic.n_steps as f64 * dynamic.step,
        Analysis::QuasiStatic(settings) => settings.n_steps as f64 * settings.step,
        Analysis::Static | Analysis::Sweep(_) | Analysis::Modes(_) => {
            return match asked {
                None => Ok(0.0),
                Some(_) => Err(Failure::User(anyhow!(
                    "--time is for scenes that run in time, and {} does not; leave it out",
                    path.display()
                ))),
            };
        }
    };
    let time = asked.unwrap_or(0.0);
    if !(0.0..=duration).contains(&time) {
        return Err(Failure::User(anyhow!(
            "--time is {time}; expected 0 to {duration} s, the time that {} runs",
            path.display()
        )));
    }
    print::note(format_args!(
        "note: {} runs in time; it is linearised about the equilibrium at {time} s, without inertia",
        path.display()
    ));
    Ok(time)
}

/// Where the parts of a scene stand at an instant.
pub fn pose_at(scene: &Scene, time: f64) -> Pose {
    let at_rest = || {
        let mut pose = Pose::default();
        pose.now.time = time;
        pose
    };
    rolling(scene).map_or_else(at_rest, |rolling| rolling.pose(time))
}

fn linearise(scene: &Scene, time: f64, ripple: Option<usize>) -> Result<StiffnessResults, Failure> {
    let points = points(scene)?;
    let mut progress = Progress::new(points.len() as u64);
    progress.stage("reading meshes");
    let (mut model, _) = build_model(&points[0].1)?;
    let doubts = doubts(scene, &model);
    say_doubts(&doubts);
    progress.stage("factoring the stiffness of the rings");
    let mut solver = StaticSolver::new(&model).map_err(Failure::solving)?;
    let mut results = StiffnessResults {
        source: scene.path.display().to_string(),
        column: match &scene.analysis {
            Analysis::Sweep(sweep) => Some(sweep.column.clone()),
            _ => None,
        },
        points: Vec::new(),
        damping_note: String::new(),
        warnings: doubts,
    };
    let mut before = None;
    for point in &points {
        progress.stage(&stage_text(scene, point.0));
        model = model_with_rings(&point.1, model.rings)?;
        let found = PointOfScene { point, time, ripple }.linearise(&model, &mut solver, before.as_ref());
        let at = results.column.as_ref().zip(point.0);
        let at = at.map(|(column, value)| at_value(column, value));
        let (found, solution, warnings) = found.map_err(|failure| match &at {
            Some(at) => failure.context(at.clone()),
            None => failure,
        })?;
        let at = at.map_or(String::new(), |at| format!("{at}: "));
        results
            .warnings
            .extend(warnings.iter().map(|w| format!("{at}{w}")));
        results.points.push(found);
        before = Some(solution);
        progress.advance();
    }
    progress.finish();
    results.damping_note = damping_note(laws(&scene.effects), [&model]);
    Ok(results)
}

/// A point of a scene and what is asked of it.
struct PointOfScene<'a> {
    point: &'a SweptScene,
    time: f64,
    ripple: Option<usize>,
}

impl PointOfScene<'_> {
    fn linearise(
        &self,
        model: &Model,
        solver: &mut StaticSolver,
        before: Option<&StaticSolution>,
    ) -> Result<(StiffnessAt, StaticSolution, Vec<String>), Failure> {
        let (value, scene) = self.point;
        let pose = pose_at(scene, self.time);
        let solution = solver.solve_at(model, &pose, before).map_err(Failure::solving)?;
        require_load(&solution)?;
        let found =
            Linearisation::new(model, solver, &solution, laws(&scene.effects)).map_err(Failure::solving)?;
        let found = found.passing(cage_speed(scene, self.time));
        let (stiffness, damping) = found.of_shaft().map_err(Failure::solving)?;
        let mut warnings = solution.warnings.clone();
        warnings.extend(not_positive(&stiffness, model)?);
        let speeds = scene.speed.clone().unwrap_or_default();
        let speeds = Side::BOTH.map(|side| speeds.of(side).at(self.time));
        let at = StiffnessAt {
            value: *value,
            speed: speeds[0],
            stiffness,
            damping,
            load_stiffness: found.load_stiffness,
            operating_point: OperatingPoint::new(&solution, speeds),
            ripple: self.ripple(model, solver, &solution)?,
        };
        Ok((at, solution, warnings))
    }

    /// The matrices with the balls at places of one pitch; the rings stay where they are.
    fn ripple(
        &self,
        model: &Model,
        solver: &mut StaticSolver,
        first: &StaticSolution,
    ) -> Result<Option<Ripple>, Failure> {
        let Some(n) = self.ripple else { return Ok(None) };
        let pitch = TAU / model.geometry.n_balls as f64;
        let cage = cage_speed(&self.point.1, self.time);
        let mut matrices: Vec<ShaftMatrix> = Vec::with_capacity(n);
        for i in 0..n {
            let mut pose = first.pose;
            pose.now.cage_angle += pitch * i as f64 / n as f64;
            let solution = solver
                .solve_at(model, &pose, Some(first))
                .map_err(Failure::solving)?;
            let found = Linearisation::new(model, solver, &solution, laws(&self.point.1.effects));
            let found = found.map_err(Failure::solving)?.passing(cage);
            matrices.push(found.stiffness().map_err(Failure::solving)?);
        }
        Ok(Some(Ripple::of(&matrices)))
    }
}

/// Refuses an equilibrium in which no ball carries anything.
pub fn require_load(solution: &StaticSolution) -> Result<(), Failure> {
    if solution.balls.iter().any(|ball| ball.inner.force_n > 0.0) {
        return Ok(());
    }
    Err(Failure::User(anyhow!(
        "no ball is in contact with the inner ring, so the shaft has no stiffness there; expected a preload, such as \
         [effects.axial_force] or a prescribed shaft.z"
    )))
}

/// Says where a matrix is not positive definite.
fn not_positive(stiffness: &ShaftMatrix, model: &Model) -> Result<Option<String>, Failure> {
    let arm = model.geometry.centre_radius(Side::Inner);
    let found = softest(stiffness, arm).map_err(Failure::solving)?;
    let lowest = found.lowest;
    Ok((lowest <= NOT_POSITIVE * found.largest).then(|| {
        format!(
            "the stiffness is not positive definite: its lowest eigenvalue is {lowest:.3e} N/m (tilts times {:.2} mm), \
             in which {} moves most; a shaft that is free to do so would leave this place",
            1e3 * arm,
            AXES[found.dof]
        )
    }))
}
