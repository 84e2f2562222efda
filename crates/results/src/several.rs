//! Results of several bearings on one shaft: `balls.csv`, `bearings.csv`, `shaft.csv`, `summary.json`, and what the
//! screen shows.
//!
//! Every bearing has a folder of its own beside them, in its own frame, as if it had been run alone. These tables are
//! in the frame of the shaft, with a column `bearing` where rows are of bearings.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use assembly::{Assembly, AssemblyMotion, AssemblySolution, AssemblyState};
use checkpoint::GrowingFile;
use comm::Communicator;
use dynamics::balls::BallResult;
use dynamics::stiffness::N_SHAFT;
use scene::{Analysis, SeveralScene};
use serde::Serialize;
use timer::Laps;

use crate::cut::TableCut;
use crate::modes::FrequenciesSummary;
use crate::seat::{beside_shaft_at_rest, beside_shaft_in_motion};
use crate::summary::{SUMMARY_SCHEMA, peak_memory, print_peak, print_seconds, print_warnings, write_summary};
use crate::tables::{append, ball_cells, ball_columns, create, head, number, place_of};
use crate::tilt::AcrossShaft;

/// Balls of all bearings.
pub const BALLS_TABLE: &str = "balls.csv";
/// A row per bearing and step.
pub const BEARINGS_TABLE: &str = "bearings.csv";
/// The line of the shaft.
pub const SHAFT_TABLE: &str = "shaft.csv";
/// Energies of a shaft in motion.
pub const ENERGY_TABLE: &str = "energy.csv";
/// The scene with all that it includes but for the types of its bearings, and the overrides.
pub const SCENE_TEXT: &str = "scene.toml";
/// Column with the names of bearings.
pub const BEARING: &str = "bearing";

const SHAFT_COLUMNS: [&str; 6] = ["position_m", "x_m", "y_m", "z_m", "tilt_x_rad", "tilt_y_rad"];
const FORCE_COLUMNS: [&str; 5] = [
    "force_x_n",
    "force_y_n",
    "force_z_n",
    "moment_x_n_m",
    "moment_y_n_m",
];
const LOAD_COLUMNS: [&str; 3] = ["largest_ball_force_n", "loaded_balls", "outer_seat_z_m"];

/// The tables of a run, open for appending. Rank 0 writes for all; on the others there are none, and writing does
/// nothing.
pub struct SeveralTables {
    open: Option<OpenTables>,
}

struct OpenTables {
    balls: csv::Writer<GrowingFile>,
    bearings: csv::Writer<GrowingFile>,
    shaft: csv::Writer<GrowingFile>,
    /// Only of a motion.
    energy: Option<csv::Writer<GrowingFile>>,
}

/// Names and heads of the tables of a run; `swept` is the column of a swept value.
fn heads(swept: Option<&str>, energies: &[(&'static str, f64)]) -> Vec<(&'static str, Vec<String>)> {
    let names =
        |lists: &[&[&str]]| -> Vec<String> { lists.concat().iter().map(|name| name.to_string()).collect() };
    let balls = [vec![BEARING.to_string()], ball_columns()].concat();
    let bearings = names(&[&[BEARING], &SHAFT_COLUMNS, &FORCE_COLUMNS, &LOAD_COLUMNS]);
    let mut all = vec![
        (BALLS_TABLE, head(swept, &balls)),
        (BEARINGS_TABLE, head(swept, &bearings)),
        (SHAFT_TABLE, head(swept, &names(&[&SHAFT_COLUMNS]))),
    ];
    if !energies.is_empty() {
        let columns: Vec<String> = energies.iter().map(|(name, _)| format!("{name}_j")).collect();
        all.push((ENERGY_TABLE, head(swept, &columns)));
    }
    all
}

impl SeveralTables {
    /// Creates the files in a folder; `swept` is the column of a swept value.
    pub fn create(dir: &Path, swept: Option<&str>, first: &ListState) -> anyhow::Result<SeveralTables> {
        if !Communicator::world().is_root() {
            return Ok(SeveralTables { open: None });
        }
        let made = heads(swept, &first.energies).into_iter();
        let made = made.map(|(name, columns)| create(dir, name, &columns));
        Ok(SeveralTables::of(made.collect::<anyhow::Result<_>>()?))
    }

    /// Looks where the files of an earlier run are to be cut, which must have rows of the step `last` and none of later
    /// ones that count; on rank 0.
    pub fn cuts(dir: &Path, first: &ListState, last: u64) -> anyhow::Result<Vec<TableCut>> {
        if !Communicator::world().is_root() {
            return Ok(Vec::new());
        }
        let cuts = heads(None, &first.energies).into_iter();
        cuts.map(|(name, columns)| TableCut::find(dir, name, &columns.join(","), last))
            .collect()
    }

    /// Opens the files of an earlier run at [`SeveralTables::cuts`]. Rows after the cuts are moved into the folder that
    /// `aside` makes.
    pub fn resume(
        cuts: &[TableCut],
        aside: &mut dyn FnMut() -> anyhow::Result<PathBuf>,
    ) -> anyhow::Result<SeveralTables> {
        if !Communicator::world().is_root() {
            return Ok(SeveralTables { open: None });
        }
        let mut files = Vec::new();
        for cut in cuts {
            files.push(csv::Writer::from_writer(cut.make(aside)?));
        }
        Ok(SeveralTables::of(files))
    }

    fn of(files: Vec<csv::Writer<GrowingFile>>) -> SeveralTables {
        let mut files = files.into_iter();
        let mut next = || files.next().expect("a list has its tables");
        SeveralTables {
            open: Some(OpenTables {
                balls: next(),
                bearings: next(),
                shaft: next(),
                energy: files.next(),
            }),
        }
    }

    /// Appends one step; `swept` is the swept value in SI.
    pub fn append(
        &mut self,
        (step, time): (u64, f64),
        swept: Option<f64>,
        assembly: &Assembly,
        state: &ListState,
    ) -> anyhow::Result<()> {
        let Some(tables) = &mut self.open else {
            return Ok(());
        };
        let place = place_of(step, time, swept);
        let row = |cells: Vec<String>| [place.clone(), cells].concat();
        let mut balls = Vec::new();
        let mut bearings = Vec::new();
        for (mounted, of_bearing) in assembly.bearings.iter().zip(&state.bearings) {
            for (i, ball) in of_bearing.balls.iter().enumerate() {
                let mut turned = *ball;
                turned.azimuth_rad = in_one_turn(mounted.place.orientation.turned_angle(ball.azimuth_rad));
                balls.push(row([vec![mounted.name.clone()], ball_cells(i, &turned)].concat()));
            }
            let numbers = std::iter::once(mounted.place.position)
                .chain(of_bearing.displacement)
                .chain(of_bearing.force)
                .chain([
                    of_bearing.largest_ball_force,
                    of_bearing.loaded_balls as f64,
                    of_bearing.seat,
                ]);
            bearings.push(row([mounted.name.clone()]
                .into_iter()
                .chain(numbers.map(number))
                .collect()));
        }
        append(&mut tables.balls, BALLS_TABLE, balls)?;
        append(&mut tables.bearings, BEARINGS_TABLE, bearings)?;
        let line = state.line(assembly).into_iter();
        let line = line.map(|(z, q)| row(std::iter::once(z).chain(q).map(number).collect()));
        append(&mut tables.shaft, SHAFT_TABLE, line)?;
        let Some(energy) = &mut tables.energy else {
            return Ok(());
        };
        let cells = state.energies.iter().map(|(_, x)| number(*x)).collect();
        append(energy, ENERGY_TABLE, [row(cells)])
    }
}

/// An angle from 0 to a whole turn.
fn in_one_turn(angle: f64) -> f64 {
    angle.rem_euclid(std::f64::consts::TAU)
}

/// Places of the shaft and their displacements: nodes of a beam; of a rigid shaft its bearings.
pub(crate) fn line(
    assembly: &Assembly,
    displacement: impl Fn(f64) -> [f64; N_SHAFT],
) -> Vec<(f64, [f64; N_SHAFT])> {
    let shaft = &assembly.shaft;
    let mut places = match shaft.is_beam() {
        true => shaft.nodes.clone(),
        false => assembly
            .bearings
            .iter()
            .map(|b| b.place.position)
            .chain([0.0])
            .collect(),
    };
    places.sort_by(f64::total_cmp);
    places.dedup();
    places.into_iter().map(|z| (z, displacement(z))).collect()
}

/// Turns a motion out of the frame of a bearing into that of the shaft.
fn turned(assembly: &Assembly, number: usize) -> impl Fn([f64; N_SHAFT]) -> [f64; N_SHAFT] {
    let orientation = assembly.bearings[number].place.orientation;
    move |motion| orientation.turned(motion)
}

/// Shaft and bearings at one instant.
#[derive(Clone)]
pub struct ListState {
    /// The bearings.
    pub bearings: Vec<StateOnShaft>,
    /// Displacement of the shaft's dofs, m and rad.
    pub shaft: Vec<f64>,
    /// Energies of the shaft in motion by name, J; none at rest.
    pub energies: Vec<(&'static str, f64)>,
}

impl ListState {
    /// The line of the shaft: places and their displacements. On an elastic body these are the seats of its bearings.
    pub fn line(&self, assembly: &Assembly) -> Vec<(f64, [f64; N_SHAFT])> {
        if assembly.shaft.is_beam() || !self.bearings.iter().any(|bearing| bearing.is_on_body) {
            return line(assembly, |z| assembly.shaft.displacement_at(z, &self.shaft));
        }
        let places = assembly.bearings.iter().map(|bearing| bearing.place.position);
        let displacements = self.bearings.iter().map(|bearing| bearing.displacement);
        let mut seats: Vec<(f64, [f64; N_SHAFT])> = places.zip(displacements).collect();
        seats.sort_by(|a, b| a.0.total_cmp(&b.0));
        seats
    }

    /// An equilibrium.
    pub fn of_equilibrium(assembly: &Assembly, solution: &AssemblySolution) -> ListState {
        let shaft = solution.shaft.displacements.clone();
        let bearing = |(number, found): (usize, &dynamics::StaticSolution)| {
            let force = assembly.force_on_shaft(number, solution);
            let balls = found.balls.clone();
            StateOnShaft::new(
                (assembly, number),
                &shaft,
                force,
                (balls, found.displacements.seat),
            )
            .beside(
                beside_shaft_at_rest(&assembly.bearings[number].model, found).map(turned(assembly, number)),
            )
        };
        ListState {
            bearings: solution.bearings.iter().enumerate().map(bearing).collect(),
            energies: Vec::new(),
            shaft,
        }
    }

    /// An instant of a motion; forces are means over the last part of a step.
    pub fn of_motion(assembly: &Assembly, motion: &AssemblyMotion<'_>, state: &AssemblyState) -> ListState {
        let bearing = |number: usize| {
            let own = &state.bearings[number];
            let orientation = assembly.bearings[number].place.orientation;
            let force = orientation.turned(state.loads[number]).map(|f| 0.0 - f);
            let seat = own.seat.map_or(0.0, |seat| seat[0]);
            let balls = motion.bearings[number].balls(own);
            let beside = beside_shaft_in_motion(&motion.bearings[number], own).map(turned(assembly, number));
            StateOnShaft::new((assembly, number), &state.shaft, force, (balls, seat)).beside(beside)
        };
        let ledger = &state.ledger;
        ListState {
            bearings: (0..state.bearings.len()).map(bearing).collect(),
            shaft: state.shaft.clone(),
            energies: vec![
                ("kinetic", ledger.kinetic),
                ("strain", ledger.strain),
                ("load_work", ledger.load_work),
                ("spin_work", ledger.spin_work),
                ("bearing_work", ledger.bearing_work),
                ("defect", ledger.defect()),
            ],
        }
    }
}

/// A bearing in the frame of the shaft.
#[derive(Clone)]
pub struct StateOnShaft {
    /// Its balls, in its own frame.
    pub balls: Vec<BallResult>,
    /// Displacement of the shaft at its place, m and rad; on an elastic body the mean motion of its seat.
    pub displacement: [f64; N_SHAFT],
    /// The shaft is an elastic body here.
    is_on_body: bool,
    /// Force, N, and moment, N m, by which it pushes the shaft at its place.
    pub force: [f64; N_SHAFT],
    /// Displacement of the outer ring's seat along the shaft's z, m.
    pub seat: f64,
    /// Largest force on the inner raceway, N.
    pub largest_ball_force: f64,
    /// Balls that carry.
    pub loaded_balls: usize,
}

impl StateOnShaft {
    /// Of a bearing, by its number, on a shaft that is displaced so.
    fn new(
        (assembly, number): (&Assembly, usize),
        shaft: &[f64],
        force: [f64; N_SHAFT],
        (balls, seat): (Vec<BallResult>, f64),
    ) -> StateOnShaft {
        let place = &assembly.bearings[number].place;
        let station = assembly.shaft.station(place.position);
        let along_shaft = |own: f64| place.orientation.turned_vector([0.0, 0.0, own])[2] + 0.0;
        let largest = balls.iter().fold(0.0f64, |m, b| m.max(b.inner.force_n));
        StateOnShaft {
            displacement: station.displacement(shaft),
            is_on_body: false,
            force: force.map(|f| f + 0.0),
            seat: along_shaft(seat),
            largest_ball_force: largest,
            loaded_balls: balls
                .iter()
                .filter(|b| b.inner.force_n > 1e-9 * largest.max(1.0))
                .count(),
            balls,
        }
    }

    /// The same where the seat moves so beside the rigid shaft.
    fn beside(mut self, motion: Option<[f64; N_SHAFT]>) -> StateOnShaft {
        for (q, more) in self.displacement.iter_mut().zip(motion.into_iter().flatten()) {
            *q += more;
        }
        self.is_on_body = motion.is_some();
        self
    }
}

/// The whole file.
#[derive(Debug, Serialize)]
pub struct SeveralSummary {
    schema: u32,
    scene: String,
    title: Option<String>,
    version: &'static str,
    analysis: &'static str,
    status: String,
    shaft: ShaftOfSeveral,
    bearings: BTreeMap<String, BearingSummary>,
    effects: Vec<&'static str>,
    iterations: usize,
    /// Of the shaft over the largest force; of a motion the largest energy defect over the largest energy.
    residual: f64,
    /// Natural frequencies, where they were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    modes: Option<FrequenciesSummary>,
    warnings: Vec<String>,
    advice: Vec<String>,
    timing_s: BTreeMap<String, f64>,
    peak_memory_bytes: u64,
}

#[derive(Debug, Serialize)]
struct ShaftOfSeveral {
    model: &'static str,
    nodes: usize,
    /// Ends of the line, by position.
    position_m: Vec<f64>,
    displacement_m: Vec<[f64; 3]>,
    rotation_rad: Vec<AcrossShaft>,
}

#[derive(Debug, Serialize)]
struct BearingSummary {
    /// Folder of its own results.
    folder: String,
    r#type: String,
    orientation: &'static str,
    position_m: f64,
    displacement_m: [f64; 3],
    rotation_rad: AcrossShaft,
    force_on_shaft_n: [f64; 3],
    moment_on_shaft_n_m: AcrossShaft,
    largest_ball_force_n: f64,
    loaded_balls: usize,
    balls: usize,
}

/// What a run of several bearings found, besides its last solution.
pub struct SeveralFindings {
    /// `finished`, or what ended the run before its end.
    pub status: String,
    /// Iterations of the shaft, of all points; of a motion those of Newton.
    pub iterations: usize,
    /// Largest residual of the shaft over the largest force; of a motion the largest energy defect.
    pub residual: f64,
    /// What a user should know.
    pub warnings: Vec<String>,
    /// What rules of thumb say about effects.
    pub advice: Vec<String>,
    /// Wall time.
    pub laps: Laps,
}

/// Displacement and rotation, or force and moment, of a point of the shaft.
fn split([x, y, z, about_x, about_y]: [f64; N_SHAFT]) -> ([f64; 3], AcrossShaft) {
    let across = AcrossShaft {
        x: about_x,
        y: about_y,
    };
    ([x, y, z], across)
}

impl SeveralSummary {
    /// Of the last solution of a run.
    pub fn new(
        scene: &SeveralScene,
        assembly: &Assembly,
        last: &ListState,
        findings: SeveralFindings,
    ) -> SeveralSummary {
        let bearing = |(number, mounted): (usize, &scene::BearingOnShaft)| {
            let state = &last.bearings[number];
            let (displacement_m, rotation_rad) = split(state.displacement);
            let (force_on_shaft_n, moment_on_shaft_n_m) = split(state.force);
            let summary = BearingSummary {
                folder: mounted.name.clone(),
                r#type: mounted.type_file.clone(),
                orientation: mounted.orientation.name(),
                position_m: mounted.position,
                displacement_m,
                rotation_rad,
                force_on_shaft_n,
                moment_on_shaft_n_m,
                largest_ball_force_n: state.largest_ball_force,
                loaded_balls: state.loaded_balls,
                balls: assembly.bearings[number].model.geometry.n_balls,
            };
            (mounted.name.clone(), summary)
        };
        let line = last.line(assembly);
        let laps = findings.laps.iter();
        let parts = laps.map(|lap| (lap.name.to_string(), lap.seconds));
        SeveralSummary {
            schema: SUMMARY_SCHEMA,
            scene: scene.path.display().to_string(),
            title: scene.title.clone(),
            version: env!("CARGO_PKG_VERSION"),
            analysis: match scene.analysis {
                Analysis::Sweep(_) => "sweep",
                Analysis::QuasiStatic(_) => "quasi_static",
                Analysis::Dynamic(_) => "dynamic",
                Analysis::Modes(_) => "modes",
                _ => "static",
            },
            status: findings.status,
            shaft: ShaftOfSeveral {
                model: if assembly.shaft.is_beam() { "beam" } else { "rigid" },
                nodes: assembly.shaft.nodes.len(),
                position_m: line.iter().map(|(z, _)| *z).collect(),
                displacement_m: line.iter().map(|(_, q)| split(*q).0).collect(),
                rotation_rad: line.iter().map(|(_, q)| split(*q).1).collect(),
            },
            bearings: scene.bearings.iter().enumerate().map(bearing).collect(),
            effects: scene.effects.names(),
            iterations: findings.iterations,
            residual: findings.residual,
            modes: None,
            warnings: findings.warnings,
            advice: findings.advice,
            timing_s: parts.collect(),
            peak_memory_bytes: peak_memory(),
        }
    }

    /// The same with natural frequencies.
    pub fn with_modes(self, modes: FrequenciesSummary) -> SeveralSummary {
        SeveralSummary {
            modes: Some(modes),
            ..self
        }
    }

    /// Writes the file: complete or not at all.
    pub fn write(&self, dir: &Path) -> anyhow::Result<()> {
        write_summary(dir, self)
    }

    /// Prints warnings, then where the time went.
    pub fn print_costs(&self) {
        print_warnings(&self.warnings);
        print_seconds(self.timing_s.iter().map(|(part, s)| (part.as_str(), *s)));
        print_peak(self.peak_memory_bytes, None);
    }
}
