//! `summary.json`: the key numbers of a run, for scripts. Schema 1; SI units in the names of the keys.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use checkpoint::open_regular;
use comm::{Communicator, print};
use contact::Side;
use dynamics::Model;
use dynamics::balls::BallResult;
use dynamics::costs::{ASSEMBLE, COLUMNS, CONTACT, EFFECTS, FACTOR, SOLVE};
use scene::{Analysis, Scene};
use serde::Serialize;
use timer::Laps;

use super::bodies::BodiesElsewhere;
use super::film::{FilmLaw, FilmSummary};
use super::memory::Forecasts;
use super::mounting::{ClearanceSummary, FitSummary, fits};
use super::probe_places::NodePlace;
use super::seat::{SeatSummaries, SeatSummary};
use super::snapshot::Snapshot;
use super::subsurface::{self, ContactSubsurface};
use super::whole;
use crate::tilt::AcrossShaft;

/// Start of the keys of `timing_s` that are effects.
const EFFECT_TIMING: &str = "effect_";
/// Lap: reading and checking.
pub const READ: &str = "read";
/// Lap: stress recovery.
pub const STRESS: &str = "stress";
/// Lap: near fields of step files, probes and profiles; absent where the scene asks for none.
pub const NEAR_FIELD: &str = "stress/near_field";
/// Lap: putting together on rank 0 the stress that ranks recover; absent with one process.
pub const GATHER: &str = "gather";
/// Lap: extremes and damage found while the run goes on; absent where the scene asks for none.
pub const REDUCTION: &str = "reduction";
/// Lap: writing, as far as the run had to wait for it: tables, handing over steps, closing.
pub const OUTPUT: &str = "output";
/// Lap: waiting for the disk.
pub const DISK_WAIT: &str = "output/disk_wait";
/// Lap: writing of step files and bringing them to the disk, each on a thread beside the computation.
pub const DISK: &str = "disk";
/// Lap: the whole run.
pub const TOTAL: &str = "total";
/// Laps that `timing_s` has of every run.
const ALWAYS: [&str; 11] = [
    READ, ASSEMBLE, FACTOR, COLUMNS, CONTACT, SOLVE, STRESS, OUTPUT, DISK, DISK_WAIT, TOTAL,
];
/// Laps that it has where they were run.
const SOMETIMES: [&str; 3] = [NEAR_FIELD, REDUCTION, GATHER];
/// Name of the file in the result folder.
pub const SUMMARY_FILE: &str = "summary.json";
/// Schema of the file.
pub const SUMMARY_SCHEMA: u32 = 1;

/// The whole file.
#[derive(Debug, Serialize)]
pub struct Summary {
    schema: u32,
    scene: String,
    run: Option<String>,
    title: Option<String>,
    version: &'static str,
    analysis: &'static str,
    status: String,
    contact_mode: &'static str,
    shaft: ShaftSummary,
    balls: Vec<BallSummary>,
    /// Stress below the surfaces of balls and raceways, by Hertz.
    subsurface: BTreeMap<&'static str, ContactSubsurface>,
    effects: Vec<&'static str>,
    dofs: BTreeMap<&'static str, usize>,
    elements: BTreeMap<&'static str, usize>,
    energy_j: BTreeMap<&'static str, f64>,
    /// Radial clearance, mounted and warm; absent without fits, temperatures and seat forms, as the fits.
    #[serde(skip_serializing_if = "Option::is_none")]
    clearance: Option<ClearanceSummary>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    fits: BTreeMap<&'static str, FitSummary>,
    /// Thinnest film of each raceway at the end; absent without lubricant and speed.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    film: BTreeMap<&'static str, FilmSummary>,
    iterations: BTreeMap<&'static str, usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    sweep: Option<SweepSummary>,
    /// Ratings and life; absent where the scene does not ask for them.
    #[serde(skip_serializing_if = "Option::is_none")]
    life: Option<serde_json::Value>,
    /// The seat of the inner ring in an elastic body on the shaft; absent without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    seat_inner: Option<SeatSummary>,
    /// The seat of the outer ring in an elastic body; absent without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    seat: Option<SeatSummary>,
    /// Bodies that the files of another bearing of the list show, with its folder; absent without such.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    bodies_shown_in: BodiesElsewhere,
    warnings: Vec<String>,
    /// What rules of thumb say about its effects.
    advice: Vec<String>,
    /// What the scene leaves open and the program has filled in; absent where it leaves nothing open.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    assumed: Vec<String>,
    /// Nodes that are probed; absent when there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    probes: Vec<NodePlace>,
    timing_s: BTreeMap<String, f64>,
    factor_bytes_forecast: BTreeMap<&'static str, usize>,
    /// Absent in motions of rings that harmonics do not solve, and in searches for modes: their matrices are not
    /// forecast.
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_memory_forecast_bytes: Option<usize>,
    peak_memory_bytes: u64,
}

/// Displacement of the shaft from the just-touching state, at the axis point in the plane of the inner groove
/// centres.
#[derive(Clone, Debug, Serialize)]
pub struct ShaftSummary {
    displacement_m: [f64; 3],
    rotation_rad: [f64; 3],
    /// Reaction of prescribed dofs: force, N, and moment, N m; 0 where free; absent in motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    reaction_force_n: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reaction_moment_n_m: Option<AcrossShaft>,
    /// Displacement of the outer ring's seat along z, m; absent where it does not slide.
    #[serde(skip_serializing_if = "Option::is_none")]
    outer_seat_z_m: Option<f64>,
}

/// One ball.
#[derive(Debug, Serialize)]
struct BallSummary {
    #[serde(flatten)]
    ball: BallResult,
    /// Rotation about its own axis relative to the cage, rad/s; absent where nothing turns.
    #[serde(skip_serializing_if = "Option::is_none")]
    spin_rad_per_s: Option<f64>,
}

/// Every point of a sweep.
#[derive(Debug, Serialize)]
pub struct SweepSummary {
    key: String,
    column: String,
    points: Vec<SweepRow>,
}

#[derive(Debug, Serialize)]
struct SweepRow {
    value: f64,
    shaft: ShaftSummary,
    balls: Vec<BallSummary>,
}

/// Costs of a run that only its driver knows, and its identity.
#[derive(Default)]
pub struct Costs {
    /// Identity of the run, which all its files carry; None on ranks that write none.
    pub run: Option<String>,
    /// Wall time by part: of the solver, see [`dynamics::costs`], and of what is named here.
    pub laps: Laps,
    /// Memory forecast.
    pub forecast: Forecasts,
    /// Nodes that were probed.
    pub probes: Vec<NodePlace>,
}

impl ShaftSummary {
    /// The shaft of a snapshot.
    pub fn new(snapshot: &Snapshot) -> ShaftSummary {
        let [x, y, z, tilt_x, tilt_y] = snapshot.shaft;
        ShaftSummary {
            displacement_m: [x, y, z],
            rotation_rad: [tilt_x, tilt_y, 0.0],
            reaction_force_n: snapshot.reaction.map(|r| [r[0], r[1], r[2]]),
            reaction_moment_n_m: snapshot.reaction.map(|r| AcrossShaft { x: r[3], y: r[4] }),
            outer_seat_z_m: snapshot.seat,
        }
    }
}

/// What a run found, besides its costs.
pub struct Findings {
    /// `finished`, or what ended the run before its end.
    pub status: String,
    /// The state at its end.
    pub last: Snapshot,
    /// Points of a sweep: swept value and state; empty otherwise.
    pub points: Vec<(f64, Snapshot)>,
    /// Counts of iterations, by name.
    pub iterations: BTreeMap<&'static str, usize>,
    /// What a user should know.
    pub warnings: Vec<String>,
    /// What rules of thumb say about effects that are missing or idle.
    pub advice: Vec<String>,
}

impl Summary {
    /// Summary of a run.
    pub fn new(scene: &Scene, model: &Model, findings: Findings, costs: &Costs) -> Summary {
        let last = &findings.last;
        let (analysis, sweep) = analysis_of(scene, &findings);
        let film = thinnest(scene, model, last);
        let mut warnings = findings.warnings;
        warnings.extend(film.iter().filter_map(|(side, film)| film.warning(side)));
        warnings.dedup();
        Summary {
            schema: SUMMARY_SCHEMA,
            scene: scene.path.display().to_string(),
            run: costs.run.clone(),
            title: scene.title.clone(),
            version: env!("CARGO_PKG_VERSION"),
            analysis,
            status: findings.status,
            contact_mode: mode_name(model),
            shaft: ShaftSummary::new(last),
            balls: balls(last),
            subsurface: Side::BOTH
                .map(Side::name)
                .into_iter()
                .zip(subsurface::contacts(model, &scene.materials, &last.balls))
                .collect(),
            effects: scene.effects.names(),
            dofs: sides(|i| model.rings[i].as_ref().map_or(0, |r| r.mesh.n_dofs())),
            elements: sides(|i| model.rings[i].as_ref().map_or(0, |r| r.n_elements())),
            energy_j: last.energies.iter().copied().collect(),
            clearance: model.mounting.report.as_ref().map(ClearanceSummary::new),
            fits: fits(model.mounting.report.as_ref()),
            film,
            iterations: findings.iterations,
            sweep,
            life: None,
            seat_inner: None,
            seat: None,
            bodies_shown_in: BodiesElsewhere::new(),
            warnings,
            advice: findings.advice,
            assumed: scene.assumed.clone(),
            probes: costs.probes.clone(),
            timing_s: timing(&costs.laps),
            factor_bytes_forecast: sides(|i| costs.forecast.rings[i].map_or(0, |ring| ring.factorisation)),
            peak_memory_forecast_bytes: costs.forecast.peak,
            peak_memory_bytes: peak_memory(),
        }
    }

    /// The same with ratings and life, and what warns of them.
    pub fn with_life(mut self, life: Option<serde_json::Value>) -> Summary {
        let notes = life.as_ref().and_then(|life| life["notes"].as_array());
        let texts = notes.into_iter().flatten().filter_map(|note| note.as_str());
        let warnings = texts.filter_map(|text| text.strip_prefix("warning: "));
        self.warnings.extend(warnings.map(|text| format!("life: {text}")));
        Summary { life, ..self }
    }

    /// The same with the seats of rings in bodies.
    pub fn with_seats(mut self, seats: SeatSummaries) -> Summary {
        self.warnings
            .extend(seats.iter().flatten().filter_map(SeatSummary::warning));
        let [seat_inner, seat] = seats;
        Summary {
            seat_inner,
            seat,
            ..self
        }
    }

    /// The same with the bodies that the files of another bearing show.
    pub fn with_bodies_shown_in(self, bodies_shown_in: BodiesElsewhere) -> Summary {
        Summary {
            bodies_shown_in,
            ..self
        }
    }

    /// Prints warnings, then where the time went.
    pub fn print_costs(&self) {
        print_warnings(&self.warnings);
        print::line(format_args!("{}", self.effects_line()));
        let parts = self.timing_s.iter().map(|(part, s)| (part.as_str(), *s));
        print_seconds(parts.filter(|(part, _)| !part.starts_with(EFFECT_TIMING)));
        print_peak(self.peak_memory_bytes, self.peak_memory_forecast_bytes);
    }

    /// The effects that were on, with their seconds.
    fn effects_line(&self) -> String {
        let cost = |name: &&str| match self.timing_s.get(&format!("{EFFECT_TIMING}{name}")) {
            Some(s) => format!("{name} {s:.4} s"),
            // Cage slip: one factor of the kinematics has another value.
            None => format!("{name} 0 s (another constant, no more work)"),
        };
        match self.effects.as_slice() {
            [] => "effects: none".to_string(),
            names => format!(
                "effects: {}",
                names.iter().map(cost).collect::<Vec<_>>().join(", ")
            ),
        }
    }

    /// Writes the file: complete or not at all.
    pub fn write(&self, dir: &Path) -> anyhow::Result<()> {
        write_summary(dir, self)
    }
}

/// Prints warnings, a line each.
pub fn print_warnings(warnings: &[String]) {
    for warning in warnings {
        print::line(format_args!("warning: {warning}"));
    }
}

/// Prints where the wall time went.
pub fn print_seconds<'a>(parts: impl Iterator<Item = (&'a str, f64)>) {
    let parts: Vec<String> = parts.map(|(part, s)| format!("{part} {s:.3}")).collect();
    print::line(format_args!("seconds: {}", parts.join(", ")));
}

/// Prints the largest memory, bytes, beside its forecast if there is one.
pub fn print_peak(bytes: u64, forecast: Option<usize>) {
    let forecast = forecast.map_or(String::new(), |bytes| {
        format!(", forecast {:.0} MB", bytes as f64 / 1e6)
    });
    print::line(format_args!(
        "peak memory: {:.0} MB{forecast}",
        bytes as f64 / 1e6
    ));
}

/// Writes `summary.json`: complete or not at all. Rank 0 writes for all.
pub fn write_summary(dir: &Path, summary: &impl Serialize) -> anyhow::Result<()> {
    if !Communicator::world().is_root() {
        return Ok(());
    }
    let path = dir.join(SUMMARY_FILE);
    let text = serde_json::to_string_pretty(summary).context("cannot format summary.json")? + "\n";
    whole::write(&path, text.as_bytes(), |old| whole::holds(old, "\"schema\""))
}

/// The scene file of a run in `dir` by the name that it was given in full, as the summary has it; else `path`.
pub fn scene_as_named(dir: &Path, path: PathBuf) -> PathBuf {
    let named = || {
        let named = PathBuf::from(read_summary(dir)?["scene"].as_str()?);
        let is_it = named.is_absolute() && named.canonicalize().ok()? == path.canonicalize().ok()?;
        is_it.then_some(named)
    };
    named().unwrap_or(path)
}

/// What the summary of a bearing says of bodies that the files of another one show.
pub fn bodies_shown_in(summary: &serde_json::Value) -> BodiesElsewhere {
    let found = summary.get("bodies_shown_in").cloned().unwrap_or_default();
    serde_json::from_value(found).unwrap_or_default()
}

/// The summary in `dir`; None if there is none that can be read.
pub fn read_summary(dir: &Path) -> Option<serde_json::Value> {
    let file = open_regular(&dir.join(SUMMARY_FILE)).ok()?;
    serde_json::from_reader(std::io::BufReader::new(file)).ok()
}

/// Fails if the summary in `dir` is none that this program knows: of another schema, or of another program. One that
/// is not there, or damaged, is the business of who needs it.
pub fn require_known_summary(dir: &Path) -> anyhow::Result<()> {
    let Some(summary) = read_summary(dir) else {
        return Ok(());
    };
    let found = &summary["schema"];
    if *found == SUMMARY_SCHEMA {
        return Ok(());
    }
    let schema = match found {
        serde_json::Value::Null => "no schema".to_string(),
        found => format!("schema {found}"),
    };
    let by = summary["version"].as_str().map_or(String::new(), |version| {
        format!(", of version {version:?} of its program")
    });
    bail!(
        "{} has {schema}{by}; this program, version {}, reads schema {SUMMARY_SCHEMA}: read it with the program that \
         wrote it, or run the scene again",
        dir.join(SUMMARY_FILE).display(),
        env!("CARGO_PKG_VERSION")
    )
}

/// That the summary in `dir` is of another version of the program, if so.
pub fn other_version(dir: &Path) -> Option<String> {
    let (summary, now) = (read_summary(dir)?, env!("CARGO_PKG_VERSION"));
    let then = summary["version"].as_str().filter(|then| *then != now)?;
    Some(format!(
        "{} was written by version {then} of the program, this is {now}: what has changed stands in CHANGELOG.md",
        dir.join(SUMMARY_FILE).display()
    ))
}

/// A value per side, by name.
pub fn sides<T>(value: impl Fn(usize) -> T) -> BTreeMap<&'static str, T> {
    BTreeMap::from([("inner", value(0)), ("outer", value(1))])
}

/// Contact mode as a scene has it.
pub fn mode_name(model: &Model) -> &'static str {
    match model.contact.mode {
        dynamics::ContactMode::Patch => "patch",
        dynamics::ContactMode::Facet => "facet",
        dynamics::ContactMode::Rigid => "rigid",
    }
}

/// Thinnest film of each raceway at an instant.
fn thinnest(scene: &Scene, model: &Model, snapshot: &Snapshot) -> BTreeMap<&'static str, FilmSummary> {
    let Some(law) = FilmLaw::new(scene, model) else {
        return BTreeMap::new();
    };
    let spin = snapshot.spin.unwrap_or_default();
    let film = |side: Side| Some((side.name(), law.thinnest(side, &snapshot.balls, spin)?));
    Side::BOTH.into_iter().filter_map(film).collect()
}

/// All balls of an instant.
fn balls(snapshot: &Snapshot) -> Vec<BallSummary> {
    let ball = |ball: &BallResult| BallSummary {
        ball: *ball,
        spin_rad_per_s: snapshot.spin,
    };
    snapshot.balls.iter().map(ball).collect()
}

/// Seconds by the last name of a lap; those of effects by theirs.
fn timing(laps: &Laps) -> BTreeMap<String, f64> {
    let key = |path: &str| path.rsplit('/').next().unwrap_or(path).to_string();
    let always = ALWAYS.map(|path| (key(path), laps.seconds(path)));
    let sometimes = SOMETIMES
        .into_iter()
        .filter_map(|path| Some((key(path), laps.get(path)?.seconds)));
    let effects = laps.get(EFFECTS).into_iter().flat_map(|lap| lap.parts.iter());
    let own = effects.map(|lap| (format!("{EFFECT_TIMING}{}", lap.name), lap.seconds));
    always.into_iter().chain(sometimes).chain(own).collect()
}

/// Largest resident memory of this process, bytes; 0 where the system does not tell.
pub fn peak_memory() -> u64 {
    let Ok(status) = std::fs::read_to_string("/proc/self/status") else {
        return 0;
    };
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    let kilobytes = line
        .and_then(|l| l.split_whitespace().next())
        .and_then(|n| n.parse::<u64>().ok());
    kilobytes.unwrap_or(0) * 1024
}

/// Name of the analysis, and the points of a sweep.
fn analysis_of(scene: &Scene, findings: &Findings) -> (&'static str, Option<SweepSummary>) {
    match &scene.analysis {
        Analysis::Static => ("static", None),
        Analysis::QuasiStatic(_) => ("quasi_static", None),
        Analysis::Dynamic(_) => ("dynamic", None),
        Analysis::Modes(_) => ("modes", None),
        Analysis::Sweep(sweep) => {
            let rows = findings.points.iter().map(|(value, s)| SweepRow {
                value: *value,
                shaft: ShaftSummary::new(s),
                balls: balls(s),
            });
            let summary = SweepSummary {
                key: sweep.key.clone(),
                column: sweep.column.clone(),
                points: rows.collect(),
            };
            ("sweep", Some(summary))
        }
    }
}
