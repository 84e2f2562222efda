//! `raceway campbell`: modes of the shaft on its bearing over the speed.
//!
//! At every speed the equilibrium is found anew, with what the scene makes of the speed, such as the centrifugal force
//! of the balls. A scene without such effects keeps its stiffness; only the gyroscopic moment of the shaft grows.

use std::f64::consts::PI;
use std::ops::Range;
use std::path::PathBuf;

use anyhow::anyhow;
use assembly::whirl::TurningAssembly;
use clap::Args;
use contact::Side;
use dynamics::kinematics::Speed;
use dynamics::whirl::{TurningShaft, WhirlMode, turning_inertia};
use dynamics::{Linearisation, Model, ShaftDof, StaticSolution, StaticSolver};
use results::campbell::{CAMPBELL_LINES, CAMPBELL_TABLE, ModesAtSpeed};
use results::console::digits;
use results::failure::Failure;
use results::survey::say_doubts;
use results::whole::require_free;
use scene::{AnyScene, Scene, build_model, doubts, model_with_rings};

use crate::campbell_files::{
    self, Diagram, MODES_OF_BEAM, ball_forces, cage_speed, growing, keep_modes_of_shaft, require_forward,
    require_one_point, without_stress,
};
use crate::damping::{damping_note, laws};
use crate::progress::Progress;
use crate::several::solving;
use crate::several_campbell;
use crate::stiffness::{instant, pose_at, require_load, steady};

/// Most speeds of a diagram.
const MOST_SPEEDS: usize = 1000;
/// Largest speed, rpm: that of scenes.
const LARGEST_SPEED: f64 = 9.5e5;

/// What the command line asks for.
#[derive(Debug, Args)]
pub struct CampbellCommand {
    /// Scene file of one operating point.
    scene: PathBuf,
    /// Speeds of the shaft, rpm: first..last:step.
    #[arg(long, value_name = "FIRST..LAST:STEP", value_parser = parse_speeds)]
    speeds: SpeedRange,
    /// Folder of campbell.csv, campbell_lines.csv and the figure; nothing in it is replaced.
    #[arg(long)]
    out: PathBuf,
    /// Number of modes, from the lowest; default: as many as the shaft has free dofs, 10 of a beam or with
    /// elastic bodies.
    #[arg(long)]
    number: Option<usize>,
    /// Changes a value of the scene: path=value, such as shaft.mass="2 kg".
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
}

/// Speeds, rpm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedRange {
    first: f64,
    last: f64,
    step: f64,
}

impl SpeedRange {
    /// The speeds, rpm; the last is among them if steps lead to it.
    fn values(self) -> Vec<f64> {
        let SpeedRange { first, last, .. } = self;
        let n = ((last - first) / self.step * (1.0 + 4.0 * f64::EPSILON)).floor() as usize;
        (0..=n).map(|i| first + i as f64 * self.step).collect()
    }
}

/// Reads speeds such as 0..40000:2000.
fn parse_speeds(text: &str) -> Result<SpeedRange, String> {
    let expected =
        || format!("{text:?} names no speeds; expected first..last:step in rpm, such as 0..40000:2000");
    let number = |part: &str| part.trim().parse::<f64>().ok().filter(|x| x.is_finite());
    let (range, step) = text.split_once(':').ok_or_else(expected)?;
    let (first, last) = range.split_once("..").ok_or_else(expected)?;
    let [Some(first), Some(last), Some(step)] = [first, last, step].map(number) else {
        return Err(expected());
    };
    let Range { start, end } = 0.0..LARGEST_SPEED;
    if first < start || last < first || last > end {
        return Err(format!(
            "the speeds go from {first} to {last}; expected 0 <= first <= last <= {end} rpm"
        ));
    }
    if step <= 0.0 || (last - first) / step >= MOST_SPEEDS as f64 {
        return Err(format!(
            "the step is {step} rpm; expected more than 0 and at most {MOST_SPEEDS} speeds"
        ));
    }
    Ok(SpeedRange { first, last, step })
}

/// Computes the modes and writes them.
pub fn campbell(command: &CampbellCommand) -> Result<(), Failure> {
    let scene = match steady(AnyScene::load(&command.scene, &command.overrides)?) {
        AnyScene::One(scene) => *scene,
        AnyScene::Several(list) => {
            let speeds = command.speeds.values();
            return several_campbell::campbell(*list, &speeds, command.number, &command.out);
        }
    };
    require_one_point(&scene.analysis, &scene.path)?;
    let time = instant((&scene.analysis, &scene.path), None)?;
    require_forward(scene.speed.as_ref(), time)?;
    require_free(&command.out, &[CAMPBELL_TABLE, CAMPBELL_LINES])?;
    let (modes, model, warnings) = diagram(scene.clone().moving_by_modes(), time, command)?;
    let diagram = Diagram {
        modes,
        warnings,
        note: None,
        damping_note: damping_note(laws(&scene.effects), [&model]),
    };
    campbell_files::write(&diagram, &command.out, &model.geometry, scene.effects.slip())
}

/// How many modes are wanted: at least one.
fn number_of_modes(command: &CampbellCommand, model: &Model, has_bodies: bool) -> Result<usize, Failure> {
    let n_free = model.shaft.iter().filter(|dof| **dof == ShaftDof::Free).count();
    if command.number == Some(0) {
        return Err(Failure::User(anyhow!("--number is 0; expected at least 1")));
    }
    if n_free == 0 && !has_bodies {
        return Err(Failure::User(anyhow!(
            "no dof of the shaft is free, so it has no modes; free some in [shaft]"
        )));
    }
    Ok(command
        .number
        .unwrap_or(if has_bodies { MODES_OF_BEAM } else { n_free }))
}

/// The equations of a bearing with elastic bodies at a speed, rad/s.
fn in_bodies(
    bodies: &TurningAssembly,
    (model, linear): (&Model, &Linearisation),
    stands: (&StaticSolver, &StaticSolution),
    speed: f64,
) -> Result<TurningShaft, Failure> {
    let found = bodies.equations_of_one(model, stands, linear, speed);
    found.map_err(solving)
}

fn modes_of(shaft: TurningShaft) -> Result<Vec<WhirlMode>, Failure> {
    shaft.modes().map_err(Failure::solving)
}

/// What a user should know that modes over the speed leave out.
fn left_out(scene: &Scene, model: &Model) -> impl Iterator<Item = String> {
    without_stress([model])
        .into_iter()
        .chain(without_sliding_mass(scene))
}

/// The same where the outer ring slides with a mass of its own.
fn without_sliding_mass(scene: &Scene) -> Option<String> {
    let spring = scene.effects.spring_preload.as_ref();
    spring.filter(|spring| spring.mass() > 0.0).map(|_| {
        "effects.spring_preload.mass is left out: in modes over the speed the outer ring slides without inertia; a \
         [modes] scene has it"
            .to_string()
    })
}

/// Modes at all speeds.
fn diagram(
    mut scene: Scene,
    time: f64,
    command: &CampbellCommand,
) -> Result<(Vec<ModesAtSpeed>, Model, Vec<String>), Failure> {
    let speeds = command.speeds.values();
    let mut progress = Progress::new(speeds.len() as u64);
    progress.stage("reading meshes");
    let (mut model, _) = build_model(&scene)?;
    let mut warnings = doubts(&scene, &model);
    say_doubts(&warnings);
    warnings.extend(left_out(&scene, &model));
    let bodies = TurningAssembly::of_one("bearing", &model).map_err(solving)?;
    let number = number_of_modes(command, &model, bodies.is_some())?;
    let inertia = turning_inertia(&model).map_err(Failure::solving)?;
    if inertia.polar == 0.0 && model.shaft[3..].contains(&ShaftDof::Free) {
        warnings.push("shaft.polar_inertia is 0, so the speed splits no modes".to_string());
    }
    progress.stage("factoring the stiffness of the rings");
    let mut solver = StaticSolver::new(&model).map_err(Failure::solving)?;
    let (mut found, mut before, mut is_warned) = (Vec::new(), None, false);
    for rpm in speeds {
        let at = |failure: Failure| failure.context(format!("{} rpm", digits(rpm)));
        progress.stage(&format!("{} rpm", digits(rpm)));
        let mut rings = scene.speed.clone().unwrap_or_default();
        rings.inner = Speed::constant(rpm * PI / 30.0);
        let speeds = Side::BOTH.map(|side| rings.of(side).at(time));
        scene.speed = Some(rings);
        model = model_with_rings(&scene, model.rings)?;
        let solution = solver.solve_at(&model, &pose_at(&scene, time), before.as_ref());
        let solution = solution.map_err(Failure::solving).map_err(at)?;
        require_load(&solution).map_err(at)?;
        let linear = Linearisation::new(&model, &solver, &solution, laws(&scene.effects));
        let linear = linear.map_err(Failure::solving).map_err(at)?;
        let cage = cage_speed(&scene, time);
        let linear = linear.passing(cage).going_round(model.ball_mass(), cage);
        let modes = match &bodies {
            None => TurningShaft::new(&model, &linear, inertia, speeds[0]).map_err(Failure::solving),
            Some(bodies) => in_bodies(bodies, (&model, &linear), (&solver, &solution), speeds[0]),
        };
        let mut modes = modes.and_then(modes_of).map_err(at)?;
        keep_modes_of_shaft(&mut modes, number);
        warnings.extend(growing(rpm, &modes, &ball_forces([&solution])));
        // What is wrong at a speed is more so at the next.
        if !is_warned {
            warnings.extend(
                solution
                    .warnings
                    .iter()
                    .map(|w| format!("from {} rpm on: {w}", digits(rpm))),
            );
            is_warned = !solution.warnings.is_empty();
        }
        found.push(ModesAtSpeed { speeds, modes });
        before = Some(solution);
        progress.advance();
    }
    progress.finish();
    Ok((found, model, warnings))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: the last speed would be missing, or speeds be taken that nobody asked for.
    #[test]
    fn speeds_go_from_the_first_to_the_last() {
        assert_eq!(parse_speeds("0..6:2").unwrap().values(), [0.0, 2.0, 4.0, 6.0]);
        assert_eq!(
            parse_speeds("1000 .. 1500 : 400").unwrap().values(),
            [1000.0, 1400.0]
        );
        assert_eq!(parse_speeds("5..5:1").unwrap().values(), [5.0]);
        assert_eq!(parse_speeds("0..0.3:0.1").unwrap().values().len(), 4);
        for bad in ["", "0..5", "0-5:1", "a..5:1", "0..5:", "0..nan:1"] {
            let text = parse_speeds(bad).unwrap_err();
            assert!(
                text.contains("names no speeds; expected first..last:step in rpm"),
                "{text}"
            );
        }
        for (bad, expected) in [
            (
                "-5..5:1",
                "the speeds go from -5 to 5; expected 0 <= first <= last <= 950000 rpm",
            ),
            ("6..5:1", "the speeds go from 6 to 5"),
            (
                "0..5:0",
                "the step is 0 rpm; expected more than 0 and at most 1000 speeds",
            ),
            ("0..5e5:1", "the step is 1 rpm"),
        ] {
            let text = parse_speeds(bad).unwrap_err();
            assert!(text.starts_with(expected), "{text}");
        }
    }
}
