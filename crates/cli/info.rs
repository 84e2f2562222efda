//! `raceway info`: what a result folder or one of its files holds.

use std::io::Read;
use std::path::Path;

use anyhow::{Context, anyhow};
use checkpoint::{
    CheckpointError, FileDescription, MESH_FILE, SERIES_FILE, committed_steps, describe, has_state,
    open_regular, read_mesh, read_step, read_step_time, read_table, require_run, run_of, step_file_name,
};
use comm::print;
use life::LIFE_FILE;
use mesh::{Mesh, MeshError};
use results::answer;
use results::bodies::where_bodies_are;
use results::campbell::CAMPBELL_TABLE;
use results::disk::size;
use results::failure::Failure;
use results::integrity::doubts;
use results::load_matrix::MATRIX_FILE;
use results::log::LOG_FILE;
use results::reduction::{REDUCTION, REDUCTION_FILE};
use results::stiffness::STIFFNESS_FILE;
use results::summary::{SUMMARY_FILE, bodies_shown_in};
use study::STUDY_FILE;
use study::prices::PRICES_FILE;

use crate::export::TIMES;
use crate::stored::OverTime;

/// How closely the steps of a folder are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inspection {
    /// What tells a whole file from a torn one: all but the values of the arrays.
    Structure,
    /// Every byte.
    Bytes,
}

/// Prints what is there. Damage found is printed, and then an error.
pub fn info(path: &Path, depth: Inspection) -> Result<(), Failure> {
    if path.is_dir() {
        folder(path, depth)
    } else if is_msh(path) {
        gmsh_file(path)
    } else if path.exists() {
        file(path)
    } else {
        Err(anyhow!(
            "{} is not there; expected a result folder, a step file, mesh.hdf or a mesh of Gmsh",
            path.display()
        )
        .into())
    }
}

/// Whether a file is one of Gmsh, by its first bytes.
fn is_msh(path: &Path) -> bool {
    let mut head = [0; MSH_HEAD.len()];
    let read = open_regular(path).map(|mut file| file.read_exact(&mut head));
    matches!(read, Ok(Ok(()))) && head == *MSH_HEAD
}

/// What a mesh of Gmsh begins with.
const MSH_HEAD: &[u8; 11] = b"$MeshFormat";

/// The mesh of a ring, or else that of a body.
fn read_gmsh(path: &Path) -> Result<Mesh, Failure> {
    let groups = match mesh::read_msh(path, 1.0) {
        Err(MeshError::NoBody { groups, .. }) => groups,
        read => return Ok(read?),
    };
    match mesh::read_body_msh(path, 1.0) {
        Err(MeshError::NoBody { .. }) => Err(anyhow!(
            "{} has no physical Volume \"ring\" or \"body\" with elements, the mesh of a ring or of a [[body]]; \
             physical Volumes are {groups}",
            path.display()
        )
        .into()),
        read => Ok(read?.0),
    }
}

/// The mesh of a ring or a body, in the unit of its file.
fn gmsh_file(path: &Path) -> Result<(), Failure> {
    let mesh = read_gmsh(path)?;
    let bytes = std::fs::metadata(path).map_or(0, |data| data.len());
    line("file", &format!("{}, {}", path.display(), size(bytes)));
    line(
        "mesh",
        &format!(
            "{} {}, {} nodes, {} dofs",
            mesh.n_elements(),
            mesh.kind.name(),
            mesh.n_nodes(),
            mesh.n_dofs()
        ),
    );
    let radii = mesh.nodes.iter().map(|x| x[0].hypot(x[1]));
    let [inside, outside] = range(radii);
    let [low, high] = range(mesh.nodes.iter().map(|x| x[2]));
    let [inside, outside, low, high] =
        [2.0 * inside, 2.0 * outside, low, high].map(|x| (1e6 * x).round() / 1e6 + 0.0);
    line(
        "size",
        &format!("diameters {inside} to {outside}, z from {low} to {high}, in the unit of the file"),
    );
    for (name, facets) in &mesh.groups {
        line("group", &format!("{name}, {} facets", facets.len()));
    }
    if let Some(record) = mesh::read_record(path)? {
        line("made from", &record);
    }
    Ok(())
}

/// Smallest and largest of some numbers.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
        [low.min(x), high.max(x)]
    })
}

/// Prints a line with its name.
pub fn line(name: &str, text: &str) {
    // A long name is followed by a space, too.
    let name = format!("{name} ");
    print::line(format_args!("{name:<11}{text}"));
}

/// What a folder was found to hold.
pub struct Inspected {
    /// Numbers of its sound steps.
    pub steps: Vec<u64>,
    /// What is damaged.
    pub damaged: Vec<String>,
}

/// Files that tell a run, beside its steps.
const OF_RUNS: [&str; 4] = [MESH_FILE, SUMMARY_FILE, LOG_FILE, SERIES_FILE];
/// Files that tell what another command wrote. A folder of prices is one of a study, too.
const OF_OTHERS: [(&str, &str); 8] = [
    (STIFFNESS_FILE, "a stiffness, from raceway stiffness"),
    (
        CAMPBELL_TABLE,
        "natural frequencies over the speed, from raceway campbell",
    ),
    (heat::HEAT_FILE, "temperatures, from raceway heat"),
    (MATRIX_FILE, "forces from strains, from raceway load-matrix"),
    (
        PRICES_FILE,
        "prices of effects, from raceway prices; runs are in points",
    ),
    (STUDY_FILE, "a study, from raceway study; runs are in points"),
    (LIFE_FILE, "a life, from raceway life"),
    (TIMES, EXPORT),
];
/// What `raceway plot` draws besides runs.
const DRAWN: [&str; 2] = [STIFFNESS_FILE, CAMPBELL_TABLE];
const EXPORT: &str = "steps for other programs, from raceway export";

/// What a folder without a run holds; None where there is a run, or nothing that is known.
fn without_run(dir: &Path) -> Result<Option<&'static str>, Failure> {
    let has = |name: &str| dir.join(name).exists();
    if OF_RUNS.into_iter().any(has)
        || !committed_steps(dir)?.is_empty()
        || !checkpoint::packs(dir)?.is_empty()
    {
        return Ok(None);
    }
    if let Some((_, what)) = OF_OTHERS.into_iter().find(|(name, _)| has(name)) {
        return Ok(Some(what));
    }
    let entries = std::fs::read_dir(dir).with_context(|| dir.display().to_string())?;
    let mut names = entries.flatten().map(|entry| entry.file_name());
    if names.any(|name| name.to_string_lossy().starts_with("step_")) {
        return Ok(Some(EXPORT));
    }
    Err(anyhow!(
        "{} holds no run: expected step files, {}",
        dir.display(),
        OF_RUNS.join(", ")
    )
    .into())
}

/// Refuses a folder that another command than `raceway run` wrote, and says which; `is_drawn`: for `raceway plot`.
pub fn require_run_folder(dir: &Path, is_drawn: bool) -> Result<(), Failure> {
    let has = |name: &str| dir.join(name).exists();
    let is_shown = DRAWN.into_iter().any(has);
    if !dir.is_dir() || plot::has_tables(dir) || is_drawn && is_shown {
        return Ok(());
    }
    // What is not known here is refused by the command, which says what it needs.
    let Ok(Some(what)) = without_run(dir) else {
        return Ok(());
    };
    let advice = match is_shown {
        true => "; raceway plot draws what is in this one",
        false => "",
    };
    Err(anyhow!(
        "{} holds {what}; expected the results of raceway run{advice}",
        dir.display()
    )
    .into())
}

fn folder(dir: &Path, depth: Inspection) -> Result<(), Failure> {
    if let Some(what) = without_run(dir)? {
        line("folder", &dir.display().to_string());
        line("holds", what);
        answer::add("holds", what);
        return Ok(());
    }
    let Inspected { steps, damaged } = inspect(dir, depth)?;
    answer::add_results(dir);
    answer::add("steps", steps);
    answer::add("damaged", &damaged);
    match damaged.len() {
        0 => Ok(()),
        n => Err(damaged_files(n, dir)),
    }
}

/// That so many files of a folder are damaged.
pub fn damaged_files(n: usize, dir: &Path) -> Failure {
    let are = if n == 1 { "is" } else { "are" };
    anyhow!("{} of {} {are} damaged", print::counted(n, "file"), dir.display()).into()
}

/// Prints what the folder of a bearing holds, damage too.
pub fn inspect(dir: &Path, depth: Inspection) -> Result<Inspected, Failure> {
    let steps = committed_steps(dir)?;
    line("folder", &dir.display().to_string());
    let (mut damaged, mut sound, mut states, mut bytes) = (Vec::new(), Vec::new(), Vec::new(), 0);
    let run = run_of(dir)?;
    for &step in &steps {
        let path = dir.join(step_file_name(step));
        bytes += std::fs::metadata(&path).map_or(0, |data| data.len());
        let time = || match depth {
            Inspection::Structure => read_step_time(&path),
            Inspection::Bytes => read_step(&path).map(|record| record.time),
        };
        match require_run(&path, run.as_deref()).and_then(|()| time()) {
            Ok(time) => {
                sound.push((step, time));
                states.extend(has_state(&path)?.then_some(step));
            }
            Err(error) => damaged.push(error.to_string()),
        }
    }
    let mut over_time = true;
    if let Some((newest, _)) = sound.last() {
        let found = describe(&dir.join(step_file_name(*newest)))?;
        over_time = has_times(&found);
        about(&found);
    }
    line_of_steps(&sound, steps.len(), bytes, over_time);
    let reduction = dir.join(REDUCTION_FILE);
    if reduction.exists() {
        match read_table(&reduction, run.as_deref()) {
            Ok(table) => line(
                REDUCTION,
                &format!("{REDUCTION_FILE}: {}", table.about[REDUCTION]),
            ),
            Err(error) => damaged.push(error.to_string()),
        }
    }
    if states.len() < sound.len() {
        line("restart", &restart_text(&states));
    }
    if let Err(error) = line_of_mesh(dir) {
        damaged.push(error.to_string());
    }
    lines_of_packs(dir)?;
    damaged.extend(doubts(dir)?);
    folder_state(dir)?;
    for text in &damaged {
        line("damaged", text);
    }
    Ok(Inspected {
        steps: sound.iter().map(|(step, _)| *step).collect(),
        damaged,
    })
}

/// Whether the time of a step is one: the points of a sweep and the shapes of modes have their number there.
fn has_times(found: &FileDescription) -> bool {
    let of_scene = |text: &String| scene::read_tables::<serde_json::Value>(text, Path::new("scene"));
    match found.scene.as_ref().map(of_scene) {
        Some(Ok(tables)) => OverTime::TABLES.iter().any(|name| tables.get(name).is_some()),
        _ => true,
    }
}

/// How many steps there are, and of which times, where they have one; `sound` are numbers and times, s.
fn line_of_steps(sound: &[(u64, f64)], n_steps: usize, bytes: u64, over_time: bool) {
    match (sound, n_steps) {
        ([], 0) => line("steps", "none committed yet"),
        ([], n) => line("steps", &format!("{n}, all damaged")),
        ([first, ..], n) => {
            let last = sound[sound.len() - 1];
            let times = match over_time {
                true => format!(
                    ", t = {:?} s to {:?} s",
                    without_round_off(first.1),
                    without_round_off(last.1)
                ),
                false => String::new(),
            };
            line(
                "steps",
                &format!(
                    "{n} from {} to {}{times}, {} in all",
                    first.0,
                    last.0,
                    size(bytes)
                ),
            );
        }
    }
}

/// A time of steps that were added up, for people: 0.3 for 0.30000000000000004.
fn without_round_off(time: f64) -> f64 {
    format!("{time:.12e}").parse().unwrap_or(time)
}

fn lines_of_packs(dir: &Path) -> Result<(), CheckpointError> {
    for (path, steps) in checkpoint::packs(dir)? {
        let bytes = std::fs::metadata(&path).map_or(0, |data| data.len());
        line(
            "pack",
            &format!(
                "{}, {}, {}",
                path.display(),
                print::counted(steps.len(), "step"),
                size(bytes)
            ),
        );
    }
    Ok(())
}

fn line_of_mesh(dir: &Path) -> Result<(), CheckpointError> {
    let grid = read_mesh(dir)?;
    line(
        "mesh",
        &format!(
            "{} points, {} cells of {} bodies",
            grid.points.len(),
            grid.types.len(),
            grid.body.iter().collect::<std::collections::BTreeSet<_>>().len()
        ),
    );
    Ok(())
}

/// Steps that a run can go on from, where others cannot.
fn restart_text(states: &[u64]) -> String {
    const MOST: usize = 8;
    let names = |steps: &[u64]| steps.iter().map(u64::to_string).collect::<Vec<_>>().join(", ");
    match states.split_last_chunk::<2>() {
        _ if states.is_empty() => "no step holds a state; nothing can be resumed".to_string(),
        Some((_, last)) if states.len() > MOST => {
            let (first, n) = (names(&states[..MOST - 2]), states.len());
            format!("steps {first}, ... {} ({n} in all) hold a state", names(last))
        }
        _ => format!("steps {} hold a state", names(states)),
    }
}

/// How the run ended, who writes, what was moved aside.
fn folder_state(dir: &Path) -> Result<(), Failure> {
    if let Ok(text) = std::fs::read_to_string(dir.join(SUMMARY_FILE)) {
        let summary: serde_json::Value = serde_json::from_str(&text).context("summary.json is no JSON")?;
        line("status", summary["status"].as_str().unwrap_or("unknown"));
        where_bodies_are(&bodies_shown_in(&summary))
            .iter()
            .for_each(|text| line("body", text));
    }
    if let Some(writer) = checkpoint::lock::writer(dir)? {
        line("writer", &writer);
    }
    for n in 1.. {
        let aside = dir.join(format!("superseded_{n}"));
        if !aside.is_dir() {
            break;
        }
        line(
            "superseded",
            &format!(
                "{} in {}",
                print::counted(committed_steps(&aside)?.len(), "step"),
                aside.display()
            ),
        );
    }
    Ok(())
}

fn file(path: &Path) -> Result<(), Failure> {
    let found = describe(path)?;
    line("file", &format!("{}, {}", path.display(), size(found.bytes)));
    if let Some((step, time)) = found.step {
        let time = match has_times(&found) {
            true => format!(", t = {time:?} s"),
            false => String::new(),
        };
        line("step", &format!("{step}{time}"));
        if !has_state(path)? {
            line("restart", "no state; a run goes on from an earlier step");
        }
    }
    about(&found);
    for array in &found.arrays {
        let shape: Vec<String> = array.shape.iter().map(usize::to_string).collect();
        line(
            "array",
            &format!(
                "{} {} [{}], {}",
                array.path,
                array.kind,
                shape.join(", "),
                size(array.bytes)
            ),
        );
    }
    match found.damage {
        None => Ok(()),
        Some(damage) => Err(damage.into()),
    }
}

/// Texts about the run, and the title of its scene.
fn about(found: &FileDescription) {
    let title = found.scene.as_deref().and_then(scene::title);
    if let Some(title) = title {
        line("title", &title);
    }
    for (name, text) in found.about.iter().filter(|(_, text)| !text.is_empty()) {
        line(name, &text.replace('\n', "; "));
    }
}
