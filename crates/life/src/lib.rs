//! `raceway life`: ratings of a bearing, and its life under the forces that a run computed.
//!
//! - [`rating`], [`equivalent`]: ISO 281 and ISO 76 from the dimensions, as in a catalogue.
//! - [`damage`]: ISO 16281 from the forces of the balls, in equilibria and, by counting passes, in any history.
//! - [`spacing`]: whether the rows of a history lie close enough.
//! - [`lubrication`]: reliability, viscosity and dirt.
//! - Load spectra: conditions with their shares of time.
//! - [`risk`]: life from the stress below the contacts, as a ratio. Research.
//!
//! It reads tables and scene of a finished run, and nothing of the solver; a life from stress alone solves two
//! equilibria. Cost: that of reading the tables.

pub mod assess;
pub mod damage;
pub mod equivalent;
mod error;
mod figures;
pub mod lubrication;
pub mod rating;
pub mod risk;
mod run;
pub mod spacing;
mod spectrum;
mod stress_life;
mod table;

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::Args;
use comm::{Communicator, print};
use plot::{Named, Results};
use results::failure::Failure;
use results::folder::say_later;
use results::whole::{self, holds, require_own_picture, write_picture};
use scene::{MeshFiles, Scene, ShaftMotion};
use serde::Serialize;

use crate::assess::{Assessment, CatalogueLife, Rated, assess, catalogue_life};
use crate::equivalent::{BearingLoad, EquivalentLoads};
use crate::run::{FinishedRun, SweepLife};
use crate::spectrum::ConditionLife;

pub use error::LifeError;

/// Name of the file of a life.
pub const LIFE_FILE: &str = "life.json";
/// Version of its keys.
const SCHEMA: u32 = 1;

/// What the command line asks for.
#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("what").required(true).args(["dir", "rating", "spectrum", "stress"]))]
pub struct LifeCommand {
    /// Folder of the results of a finished run.
    pub dir: Option<PathBuf>,
    /// Ratings and catalogue life of a scene, without a run.
    #[arg(long, value_name = "SCENE")]
    rating: Option<PathBuf>,
    /// Load spectrum: result folders with their shares of time.
    #[arg(long, value_name = "FILE")]
    spectrum: Option<PathBuf>,
    /// Research: life of a scene at rest from the stress below its contacts, over that of the same bearing without
    /// fits, temperatures, seat forms and speed. Solves both.
    #[arg(long, value_name = "SCENE")]
    stress: Option<PathBuf>,
    /// Changes a value: of a finished run only life.*, such as life.reliability=95.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// Folder of life.json and of the figures; default: the result folder. Without results nothing is written.
    #[arg(long)]
    out: Option<PathBuf>,
}

/// The file `life.json`.
#[derive(Serialize)]
struct LifeFile<'a, T: Serialize> {
    life_schema: u32,
    /// `rating`, `static`, `sweep`, `history`, `spectrum` or `stress`.
    kind: &'static str,
    /// The scene, result folder or spectrum.
    source: String,
    #[serde(flatten)]
    life: &'a T,
    #[serde(skip_serializing_if = "Option::is_none")]
    sweep: Option<SweepFile>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    conditions: &'a [ConditionLife],
}

/// All points of a sweep.
#[derive(Serialize)]
struct SweepFile {
    column: String,
    points: Vec<PointFile>,
}

#[derive(Serialize)]
struct PointFile {
    value: Option<f64>,
    #[serde(flatten)]
    life: Assessment,
}

/// Prints ratings and life, and writes them.
pub fn life(command: &LifeCommand) -> Result<(), Failure> {
    match (&command.dir, &command.rating, &command.spectrum, &command.stress) {
        (Some(dir), ..) => life_of_run(dir, command),
        (_, Some(scene), ..) => rating_of_scene(scene, command),
        (_, _, Some(file), _) => life_of_spectrum(file, command),
        (.., Some(scene)) => life_from_stress(scene, command),
        _ => {
            Err(anyhow!("expected a result folder, --rating SCENE, --spectrum FILE or --stress SCENE").into())
        }
    }
}

/// Life for the summary of a run that has written its tables; none where its scene has no `[life]`. Rank 0 writes, so
/// that it alone has tables.
pub fn of_run(scene: &Scene, dir: &Path) -> Option<serde_json::Value> {
    if scene.life.is_none() || !Communicator::world().is_root() {
        return None;
    }
    let found = FinishedRun::ending(scene, dir).and_then(|run| Ok(assess(&run.last()?)));
    let value = found.and_then(|found| Ok(serde_json::to_value(found.without_positions())?));
    // A run is worth its results without a life.
    Some(value.unwrap_or_else(|failure| {
        let note = format!("no life: {}", failure.text());
        serde_json::json!({ "notes": [note] })
    }))
}

fn life_of_run(dir: &Path, command: &LifeCommand) -> Result<(), Failure> {
    plot::require_one_bearing(dir)?;
    let run = FinishedRun::read(dir, &command.overrides)?;
    say_later(dir);
    let out = Some(command.out.as_deref().unwrap_or(dir));
    if run.is_history() {
        let found = assess(&run.history()?);
        table::print_assessment(&found);
        return write(out, &file("history", dir, &found), &[figures::round(&found)]);
    }
    let points = run.points()?.into_iter();
    let points: Vec<(SweepLife, Assessment)> = points
        .map(|point| {
            let found = assess(&point.exposure);
            (point, found)
        })
        .collect();
    let Some((_, last)) = points.last() else {
        return Err(anyhow!("{} has no equilibrium", dir.display()).into());
    };
    let Some(column) = &run.column else {
        table::print_assessment(last);
        return write(out, &file("static", dir, last), &[figures::round(last)]);
    };
    table::print_sweep(column, &points);
    let without = last.clone().without_positions();
    let mut content = file("sweep", dir, &without);
    content.sweep = Some(SweepFile {
        column: column.clone(),
        points: points
            .iter()
            .map(|(point, found)| PointFile {
                value: point.value,
                life: found.clone().without_positions(),
            })
            .collect(),
    });
    write(out, &content, &sweep_figures(dir, &points)?)
}

/// Figures of a sweep, over the axis that `raceway plot` has for it.
fn sweep_figures(dir: &Path, points: &[(SweepLife, Assessment)]) -> Result<Vec<Named>, Failure> {
    let results = Results::read(dir)?;
    let Some(shaft) = &results.shaft else {
        return Err(anyhow!(
            "{} has no shaft.csv; expected the results of a run",
            dir.display()
        )
        .into());
    };
    let Some((axis, x)) = results.against(shaft)? else {
        return Ok(Vec::new());
    };
    let names: Vec<String> = x.iter().map(|x| axis.value(*x)).collect();
    Ok(vec![
        figures::over_sweep(axis, &x, points),
        figures::round_each(&names, points),
    ])
}

fn rating_of_scene(path: &Path, command: &LifeCommand) -> Result<(), Failure> {
    let scene = Scene::load_with(path, &command.overrides, MeshFiles::MayBeMissing)?;
    let rated = Rated::of_scene(&scene)?;
    let (loads, note) = loads_of_scene(&scene, &rated);
    let speed = scene.speed.as_ref().map(|speeds| {
        let [inner, outer] = speeds.at_largest(|[inner, outer]| (inner - outer).abs());
        inner - outer
    });
    let mut found: CatalogueLife = catalogue_life(&rated, loads, speed.filter(|speed| *speed != 0.0));
    found.notes.push(note);
    table::print_catalogue(&found);
    table::print_notes(&found.notes);
    write(command.out.as_deref(), &file("rating", path, &found), &[])
}

/// Equivalent loads P and P_0, N, of the forces that a scene names, and what they are.
fn loads_of_scene(scene: &Scene, rated: &Rated) -> (Option<EquivalentLoads>, String) {
    let effects = &scene.effects;
    let load = BearingLoad {
        axial: effects
            .axial_force
            .as_ref()
            .map_or(0.0, |force| force.value.si().abs()),
        radial: effects
            .radial_force
            .as_ref()
            .map_or(0.0, |force| force.value.si().abs()),
    };
    let of_forces = "P is that of [effects.axial_force] and [effects.radial_force] alone, without schedules; other \
                     loads count in the life of a run";
    let given = |motion: &ShaftMotion| matches!(motion, ShaftMotion::Prescribed(_));
    let shaft = &scene.shaft;
    if load == BearingLoad::default() {
        return (
            None,
            "no P: the scene has no axial and no radial force".to_string(),
        );
    }
    if [shaft.x, shaft.y, shaft.z].iter().any(given) {
        return (
            None,
            "no P: the scene prescribes where the shaft is, not its load".to_string(),
        );
    }
    (Some(load.equivalent(&rated.bearing)), of_forces.to_string())
}

fn life_of_spectrum(path: &Path, command: &LifeCommand) -> Result<(), Failure> {
    let spectrum = spectrum::read(path, &command.overrides)?;
    table::print_spectrum(&spectrum);
    let mut content = file("spectrum", path, &spectrum.whole);
    content.conditions = &spectrum.conditions;
    let round = figures::round(&spectrum.whole);
    write(command.out.as_deref(), &content, &[round])
}

fn life_from_stress(path: &Path, command: &LifeCommand) -> Result<(), Failure> {
    let found = stress_life::from_stress(path, &command.overrides)?;
    table::print_stress_life(&found);
    write(command.out.as_deref(), &file("stress", path, &found), &[])
}

fn file<'a, T: Serialize>(kind: &'static str, source: &Path, life: &'a T) -> LifeFile<'a, T> {
    LifeFile {
        life_schema: SCHEMA,
        kind,
        source: source.display().to_string(),
        life,
        sweep: None,
        conditions: &[],
    }
}

/// Writes `life.json` and figures below it. All is drawn, and all places looked at, before the first is written.
fn write(out: Option<&Path>, content: &impl Serialize, figures: &[Named]) -> Result<(), Failure> {
    let Some(out) = out else { return Ok(()) };
    let (path, pictures) = (out.join(LIFE_FILE), out.join("figures"));
    let text = serde_json::to_string_pretty(content).context("cannot format life.json")? + "\n";
    let is_own = |old: &[u8]| holds(old, "\"life_schema\"");
    whole::require_own(&path, is_own)?;
    let drawn = |named: &Named| Ok((pictures.join(&named.name), named.figure.images()?));
    let images = figures.iter().map(drawn).collect::<Result<Vec<_>, Failure>>()?;
    images
        .iter()
        .try_for_each(|(path, _)| require_own_picture(path))?;
    let folder = if figures.is_empty() { out } else { &pictures };
    whole::make_asked_folder(folder)?;
    whole::write(&path, text.as_bytes(), is_own)?;
    for (path, images) in &images {
        write_picture(path, &images.svg, &images.png)?;
    }
    print::line(format_args!("life: {}", path.display()));
    Ok(())
}
