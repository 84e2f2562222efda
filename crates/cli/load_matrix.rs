//! `raceway load-matrix`: what the strain gauges of a scene read under a unit load of each ball. `raceway ball-loads`:
//! ball loads from what the gauges of a run have read, as a sensor bearing computes them.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::Args;
use comm::print::{self, counted};
use contact::Side;
use dynamics::StaticSolver;
use dynamics::effects::rules::share_of;
use results::failure::Failure;
use results::gauges::Gauges;
use results::integrity::warn_of_doubts;
use results::load_matrix::{LoadMatrix, MATRIX_FILE, MATRIX_TABLE};
use results::probe_places::side_of;
use results::shown::Shown;
use results::survey::say_doubts;
use results::table::Table;
use results::whole::{make_asked_folder, output_folder, require_free, write};
use scene::{Analysis, Scene, build_model, doubts};
use spectrum::scene_of;

use crate::stiffness::{instant, pose_at};

/// Table of ball loads.
const LOADS: &str = "ball_loads.csv";

/// What the command line asks for.
#[derive(Debug, Args)]
pub struct LoadMatrixCommand {
    /// Scene file with [probes.gauge.*].
    scene: PathBuf,
    /// Changes a value of the scene: path=value.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// Folder of load_matrix.json and load_matrix.csv; nothing in it is replaced.
    #[arg(long)]
    out: PathBuf,
    /// The ring whose gauges count; default: the one that has gauges.
    #[arg(long, value_parser = ["inner", "outer"])]
    ring: Option<String>,
    /// Instant of a scene that runs in time, s; default: its start.
    #[arg(long, value_name = "SECONDS")]
    time: Option<f64>,
}

/// What the command line asks for.
#[derive(Debug, Args)]
pub struct BallLoadsCommand {
    /// Folder of the results of a run with the gauges of the matrix.
    pub dir: PathBuf,
    /// The load_matrix.json of raceway load-matrix.
    #[arg(long)]
    matrix: PathBuf,
    /// Folder of ball_loads.csv; default: the folder of the results. Nothing in it is replaced.
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Solves the equilibrium and writes its matrix.
pub fn load_matrix(command: &LoadMatrixCommand) -> Result<(), Failure> {
    let scene = Scene::load(&command.scene, &command.overrides)?;
    if matches!(scene.analysis, Analysis::Sweep(_) | Analysis::Modes(_)) {
        return Err(Failure::User(anyhow!(
            "{}: a load matrix is of one equilibrium; expected [static], [quasi_static] or [dynamic]",
            scene.path.display()
        )));
    }
    let side = ring_of(&scene, command.ring.as_deref())?;
    let time = instant((&scene.analysis, &scene.path), command.time)?;
    require_free(&command.out, &[MATRIX_FILE, MATRIX_TABLE])?;
    let (model, _) = build_model(&scene)?;
    say_doubts(&doubts(&scene, &model));
    let gauges = Gauges::new(&scene.probes.gauges, &model)?;
    let mut solver = StaticSolver::new(&model).map_err(Failure::solving)?;
    let solution = solver
        .solve_at(&model, &pose_at(&scene, time), None)
        .map_err(Failure::solving)?;
    let read = gauges.values(&Shown::at_rest(&model, &model.geometry, &solution));
    let matrix = LoadMatrix::new(&model, &solver, &solution, &gauges, &read, side)?;
    make_asked_folder(&command.out)?;
    matrix.write(&command.out)?;
    print::line(format_args!(
        "{} on the {} ring, {} balls: {}",
        counted(matrix.gauges.len(), "gauge"),
        matrix.ring,
        matrix.ball_azimuths_rad.len(),
        match matrix.condition {
            Some(condition) => format!("condition {condition:.3}"),
            None => "fewer gauges than balls, so that it cannot be inverted".to_string(),
        }
    ));
    print::line(format_args!(
        "{MATRIX_FILE}, {MATRIX_TABLE} in {}",
        command.out.display()
    ));
    Ok(())
}

/// The ring whose gauges count.
fn ring_of(scene: &Scene, asked: Option<&str>) -> Result<Side, Failure> {
    let has = |side: &Side| {
        scene
            .probes
            .gauges
            .iter()
            .any(|gauge| side_of(gauge.ring) == *side)
    };
    let known: Vec<Side> = Side::BOTH.into_iter().filter(has).collect();
    let problem = match asked {
        Some(name) => match known.iter().find(|side| side.name() == name) {
            Some(side) => return Ok(*side),
            None => format!(
                "the {name} ring has no strain gauges; expected [probes.gauge.NAME] with ring = \"{name}\""
            ),
        },
        None => match known[..] {
            [side] => return Ok(side),
            [] => "there are no strain gauges; expected [probes.gauge.NAME]".to_string(),
            _ => "both rings have strain gauges; expected --ring inner or --ring outer".to_string(),
        },
    };
    Err(Failure::User(anyhow!("{}: {problem}", scene.path.display())))
}

/// Ball loads of the steps of a run.
struct BallLoads {
    /// Lines of the table.
    table: String,
    /// Steps whose balls stand where the matrix has none.
    left_out: usize,
    /// Largest distance from the forces of the run, N.
    worst: f64,
    /// Largest force of the run, N.
    largest: f64,
}

impl BallLoads {
    /// Adds a step, its number and time, s: places of its balls in the matrix with the loads of all places, N, and the
    /// forces that the run has, N; None: it is left out.
    fn add(&mut self, (step, time): (f64, f64), found: Option<(Vec<usize>, Vec<f64>)>, known: &[f64]) {
        let Some((places, loads)) = found else {
            self.left_out += 1;
            return;
        };
        for (ball, (&place, &known)) in places.iter().zip(known).enumerate() {
            let load = loads[place];
            self.worst = self.worst.max((load - known).abs());
            self.largest = self.largest.max(known.abs());
            self.table += &format!("{:?},{time:?},{ball},{load:?},{known:?}\n", step as u64);
        }
    }
}

fn table_of(dir: &Path, name: &str, expected: &str) -> anyhow::Result<Table> {
    Table::read(dir, name)?.with_context(|| format!("{} has no {name}; expected {expected}", dir.display()))
}

/// Fails where no step has its balls at the places of the matrix.
fn require_steps(
    found: &BallLoads,
    probes: &Table,
    matrix: &LoadMatrix,
    command: &BallLoadsCommand,
) -> Result<(), Failure> {
    if found.left_out == probes.n_rows() {
        return Err(Failure::User(anyhow!(
            "no step of {} has its {} balls at the places of {}; expected equal numbers, and steps at which a ball \
             stands where the matrix has one",
            command.dir.display(),
            matrix.ball_azimuths_rad.len(),
            command.matrix.display()
        )));
    }
    Ok(())
}

/// Writes the ball loads of a run.
pub fn ball_loads(command: &BallLoadsCommand) -> Result<(), Failure> {
    let dir = &command.dir;
    plot::require_one_bearing(dir)?;
    let matrix = LoadMatrix::read(&command.matrix)?;
    let inverse = matrix.inverse()?;
    let probes = table_of(dir, "probes.csv", "the results of a scene with gauges")?;
    let balls = table_of(dir, "balls.csv", "the results of a run")?;
    warn_of_doubts(dir)?;
    let columns = matrix
        .gauges
        .iter()
        .map(|name| probes.column(&format!("{name}_strain")));
    let columns = columns.collect::<anyhow::Result<Vec<_>>>()?;
    let side = Side::BOTH.into_iter().find(|side| side.name() == matrix.ring);
    let side = side.ok_or_else(|| anyhow!("{} is of no ring of a bearing", command.matrix.display()))?;
    let speeds = scene_of(dir)?.speed;
    let (steps, times) = (probes.column("step")?, probes.column("time_s")?);
    let (ball_steps, azimuths) = (balls.column("step")?, balls.column("azimuth_rad")?);
    let true_forces = balls.column(&format!("{}_force_n", side.name()))?;
    let head = format!("step,time_s,ball,load_n,{}_force_n\n", side.name());
    let mut found = BallLoads {
        table: head.clone(),
        left_out: 0,
        worst: 0.0,
        largest: 0.0,
    };
    for row in 0..probes.n_rows() {
        let step = (steps[row], times[row]);
        let own: Vec<usize> = (0..balls.n_rows())
            .filter(|&i| ball_steps[i] == steps[row])
            .collect();
        let turned = speeds
            .as_ref()
            .map_or(0.0, |speeds| speeds.of(side).angle(times[row]));
        let stand: Vec<f64> = own.iter().map(|&i| azimuths[i] - turned).collect();
        let known: Vec<f64> = own.iter().map(|&i| true_forces[i]).collect();
        let strains: Vec<f64> = columns.iter().map(|column| column[row]).collect();
        let places = matrix.places(&stand);
        found.add(
            step,
            places.map(|places| (places, inverse.loads(&strains))),
            &known,
        );
    }
    require_steps(&found, &probes, &matrix, command)?;
    let out = output_folder(command.out.as_deref(), dir, &[LOADS])?;
    write(&out.join(LOADS), found.table.as_bytes(), |old| {
        old.starts_with(head.as_bytes())
    })?;
    print::line(format_args!(
        "{}, {} left out with balls elsewhere; loads differ from those of the run by {} at most; {LOADS} in {}",
        counted(probes.n_rows() - found.left_out, "step"),
        found.left_out,
        deviation(found.worst / found.largest.max(f64::MIN_POSITIVE)),
        out.display()
    ));
    Ok(())
}

/// A largest deviation over the largest load.
fn deviation(ratio: f64) -> String {
    match ratio < 10.0 {
        true => format!("{:.3} % of the largest", 100.0 * ratio),
        false => share_of(ratio, "the largest"),
    }
}
