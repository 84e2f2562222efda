//! Results of `raceway stiffness`: `stiffness.json`, `stiffness.csv`, `ross.csv`, and a table on the screen.
//!
//! Matrices are over x, y, z, tilt_x, tilt_y of the shaft; entry (i, j) is the load i that a displacement j asks for.
//! `ross.csv` has what the rotor dynamics program ROSS asks of a bearing: speed in rad/s and the entries of x and y.

use std::path::Path;

use anyhow::anyhow;
use comm::print;
use dynamics::StaticSolution;
use dynamics::bodies::AXES;
use dynamics::kinematics::BothRings;
use dynamics::stiffness::{N_SHAFT, ShaftMatrix};
use dynamics::system::Interval;
use serde::Serialize;

use crate::console::digits;
use crate::failure::Failure;
use crate::summary::print_warnings;
use crate::whole;

/// The matrices and where they hold.
pub const STIFFNESS_FILE: &str = "stiffness.json";
/// The table of all entries.
pub const STIFFNESS_TABLE: &str = "stiffness.csv";
/// The table for ROSS.
pub const ROSS_TABLE: &str = "ross.csv";
/// Why there is no table for ROSS.
pub const NOT_OVER_SPEED: &str = "the speeds of the points do not grow from one to the next; sweep a speed";
/// Version of the keys.
pub(crate) const SCHEMA: u32 = 1;
pub(crate) const UNITS: &str =
    "stiffness N/m, N/rad, N m/m, N m/rad; damping the same times s; displacements m, rad; loads N, N m";
/// Most positions of a ripple: far more than one can be resolved with.
pub const MOST_POSITIONS: usize = 1000;
/// What stands in the table before the swept value, and after it before the entries.
const FIRST_COLUMNS: [&str; 2] = ["point", "time_s"];
const SPEED: &str = "speed_rad_per_s";
/// Column of the force by which the bearings of a list press on each other.
pub const PRELOAD: &str = "preload_n";

/// Force of a ball on its raceways.
#[derive(Clone, Debug, Serialize)]
struct ForcesOfBall {
    azimuth_rad: f64,
    inner_force_n: f64,
    outer_force_n: f64,
    inner_contact_angle_rad: f64,
    outer_contact_angle_rad: f64,
}

/// The equilibrium about which a bearing is linearised.
#[derive(Clone, Debug, Serialize)]
pub struct OperatingPoint {
    /// Instant of loads and prescribed displacements, s.
    pub time_s: f64,
    /// Speeds of the rings, inner first, rad/s.
    pub speed_rad_per_s: BothRings,
    /// Angle by which the cage has carried the balls, rad.
    pub cage_angle_rad: f64,
    /// x, y, z in m, tilts in rad.
    shaft_displacement: [f64; N_SHAFT],
    /// Loads on the shaft, N and N m.
    loads: [f64; N_SHAFT],
    /// What holds its locked dofs, N and N m.
    reactions: [f64; N_SHAFT],
    balls: Vec<ForcesOfBall>,
}

impl OperatingPoint {
    /// That of a solution at these speeds of the rings, rad/s.
    pub fn new(solution: &StaticSolution, speed_rad_per_s: BothRings) -> OperatingPoint {
        let (shaft, q) = (&solution.parts.shaft, solution.displacements.shaft);
        let mut loads = shaft.dofs.map(|dof| dof.load);
        let tilted = shaft.loads_by_tilt(Interval::Rest, &q);
        loads
            .iter_mut()
            .zip(tilted)
            .for_each(|(load, more)| *load += more);
        let of_ball = |ball: &dynamics::balls::BallResult| ForcesOfBall {
            azimuth_rad: ball.azimuth_rad,
            inner_force_n: ball.inner.force_n,
            outer_force_n: ball.outer.force_n,
            inner_contact_angle_rad: ball.inner.contact_angle_rad,
            outer_contact_angle_rad: ball.outer.contact_angle_rad,
        };
        OperatingPoint {
            time_s: solution.pose.now.time,
            speed_rad_per_s,
            cage_angle_rad: solution.pose.now.cage_angle,
            shaft_displacement: q,
            loads,
            reactions: solution.shaft_reaction,
            balls: solution.balls.iter().map(of_ball).collect(),
        }
    }

    /// Largest force on the inner raceway, N.
    fn largest_force(&self) -> f64 {
        self.balls
            .iter()
            .fold(0.0, |most, ball| ball.inner_force_n.max(most))
    }
}

/// How the entries change while the balls pass through one pitch.
#[derive(Clone, Debug, Serialize)]
pub struct Ripple {
    /// Positions of the balls, evenly from 0 to below one pitch.
    pub positions: usize,
    /// Smallest of every entry.
    pub minimum: ShaftMatrix,
    /// Mean of every entry.
    pub mean: ShaftMatrix,
    /// Largest of every entry.
    pub maximum: ShaftMatrix,
}

impl Ripple {
    /// Of the matrices at all positions; at least one.
    pub fn of(matrices: &[ShaftMatrix]) -> Ripple {
        let each = |f: &dyn Fn(&mut dyn Iterator<Item = f64>) -> f64| -> ShaftMatrix {
            std::array::from_fn(|i| std::array::from_fn(|j| f(&mut matrices.iter().map(|m| m[i][j]))))
        };
        Ripple {
            positions: matrices.len(),
            minimum: each(&|x| x.fold(f64::INFINITY, f64::min)),
            mean: each(&|x| x.sum::<f64>() / matrices.len() as f64),
            maximum: each(&|x| x.fold(f64::NEG_INFINITY, f64::max)),
        }
    }
}

/// Stiffness and damping at one operating point.
#[derive(Clone, Debug, Serialize)]
pub struct StiffnessAt {
    /// The swept value; absent without a sweep.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Speed of the shaft in the frame of the matrix, rad/s.
    #[serde(skip)]
    pub speed: f64,
    /// The stiffness of the bearing.
    pub stiffness: ShaftMatrix,
    /// Its damping; null where the scene has no damping law.
    pub damping: Option<ShaftMatrix>,
    /// What loads on the shaft add to the stiffness, because their moments change as it tilts.
    pub load_stiffness: ShaftMatrix,
    /// The equilibrium.
    pub operating_point: OperatingPoint,
    /// Ball-pass ripple, if it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ripple: Option<Ripple>,
}

/// Everything that is written.
#[derive(Debug)]
pub struct StiffnessResults {
    /// The scene.
    pub source: String,
    /// Column of the swept values, with its unit.
    pub column: Option<String>,
    /// Operating points; one without a sweep.
    pub points: Vec<StiffnessAt>,
    /// What the damping is, or why there is none.
    pub damping_note: String,
    /// Warnings a user should read.
    pub warnings: Vec<String>,
}

/// The file.
#[derive(Serialize)]
struct StiffnessFile<'a> {
    stiffness_schema: u32,
    source: &'a str,
    order: [&'static str; N_SHAFT],
    units: &'static str,
    damping_note: &'a str,
    warnings: &'a [String],
    #[serde(flatten)]
    single: Option<&'a StiffnessAt>,
    #[serde(skip_serializing_if = "Option::is_none")]
    sweep: Option<SweptStiffness<'a>>,
}

/// All points of a sweep.
#[derive(Serialize)]
struct SweptStiffness<'a> {
    column: &'a str,
    points: &'a [StiffnessAt],
}

/// Refuses numbers of places of the balls that are no ripple, or far more than one.
pub fn require_positions(ripple: Option<usize>) -> Result<(), Failure> {
    match ripple {
        Some(n) if !(2..=MOST_POSITIONS).contains(&n) => Err(Failure::User(anyhow!(
            "--ripple is {n}; expected 2 to {MOST_POSITIONS} places of the balls in a pitch"
        ))),
        _ => Ok(()),
    }
}

impl StiffnessResults {
    /// Writes the files into a folder, each whole or not at all, and returns their names.
    pub fn write(&self, dir: &Path) -> Result<Vec<&'static str>, Failure> {
        let mut names = vec![STIFFNESS_FILE, STIFFNESS_TABLE];
        let mut text = serde_json::to_vec_pretty(&self.file())?;
        text.push(b'\n');
        whole::write_new(&dir.join(STIFFNESS_FILE), |file| file.write_all(&text))?;
        let table = self.table()?;
        whole::write_new(&dir.join(STIFFNESS_TABLE), |file| file.write_all(&table))?;
        if self.suits_ross() {
            let table = self.ross()?;
            whole::write_new(&dir.join(ROSS_TABLE), |file| file.write_all(&table))?;
            names.push(ROSS_TABLE);
        }
        Ok(names)
    }

    fn file(&self) -> StiffnessFile<'_> {
        let sweep = self.column.as_deref().map(|column| SweptStiffness {
            column,
            points: &self.points,
        });
        StiffnessFile {
            stiffness_schema: SCHEMA,
            source: &self.source,
            order: AXES,
            units: UNITS,
            damping_note: &self.damping_note,
            warnings: &self.warnings,
            single: self.points.first().filter(|_| sweep.is_none()),
            sweep,
        }
    }

    /// Whether the points are those of one bearing over its speed, or one point.
    pub fn suits_ross(&self) -> bool {
        self.points.windows(2).all(|pair| pair[0].speed < pair[1].speed)
    }

    /// All entries, a line per point.
    pub fn table(&self) -> anyhow::Result<Vec<u8>> {
        let line = |point: &StiffnessAt| TableLine {
            time: point.operating_point.time_s,
            value: point.value,
            speed: point.speed,
            preload: None,
            stiffness: point.stiffness,
            damping: point.damping,
        };
        let lines: Vec<TableLine> = self.points.iter().map(line).collect();
        table(self.column.as_deref(), &lines)
    }

    /// The entries of x and y over the speed.
    pub fn ross(&self) -> anyhow::Result<Vec<u8>> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let has_damping = self.points.iter().all(|point| point.damping.is_some());
        let names = ["speed", "kxx", "kxy", "kyx", "kyy", "cxx", "cxy", "cyx", "cyy"];
        writer.write_record(&names[..if has_damping { 9 } else { 5 }])?;
        for point in &self.points {
            let of = |m: &ShaftMatrix| [m[0][0], m[0][1], m[1][0], m[1][1]];
            let damping = point.damping.iter().flat_map(of);
            let cells = std::iter::once(point.speed).chain(of(&point.stiffness));
            writer.write_record(cells.chain(damping).map(|x| format!("{x:?}")))?;
        }
        Ok(writer.into_inner()?)
    }

    /// Prints the diagonal at every point, and the whole matrix of a single one.
    pub fn print(&self) {
        let name = self.column.as_deref().unwrap_or("point");
        let width = name.len().max(12);
        print::line(format_args!(
            "{name:>width$}   k_x N/um   k_y N/um   k_z N/um  k_tilt_x, k_tilt_y N m/mrad   largest ball force N"
        ));
        for (i, point) in self.points.iter().enumerate() {
            let k = |i: usize| point.stiffness[i][i] * if i < 3 { 1e-6 } else { 1e-3 };
            let force = point.operating_point.largest_force();
            let value = digits(point.value.unwrap_or(i as f64));
            print::line(format_args!(
                "{value:>width$} {:10.3} {:10.3} {:10.3} {:12.4} {:12.4} {force:21.2}",
                k(0),
                k(1),
                k(2),
                k(3),
                k(4)
            ));
        }
        if let [point] = self.points.as_slice() {
            print_matrix("stiffness, N/m, N/rad, N m/m, N m/rad", &point.stiffness);
            let damping = point.damping.iter();
            damping.for_each(|damping| print_matrix("damping, N s/m and so on", damping));
        }
        for (i, point) in self.points.iter().enumerate() {
            if let Some(ripple) = &point.ripple {
                print_ripple(&format!("point {i}"), ripple);
            }
        }
        print::line(format_args!("damping: {}", self.damping_note));
        print_warnings(&self.warnings);
    }
}

/// A line of `stiffness.csv`.
pub struct TableLine {
    /// Instant, s.
    pub time: f64,
    /// The swept value.
    pub value: Option<f64>,
    /// Speed of the shaft, rad/s.
    pub speed: f64,
    /// Force by which bearings press on each other, N, of the shaft of a list that has bearings of both orientations.
    pub preload: Option<f64>,
    /// Stiffness.
    pub stiffness: ShaftMatrix,
    /// Damping, if there is any.
    pub damping: Option<ShaftMatrix>,
}

/// The table of points, with the column of a swept value.
pub fn table(column: Option<&str>, lines: &[TableLine]) -> anyhow::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let has_damping = lines.iter().all(|line| line.damping.is_some());
    let has_preload = lines.iter().all(|line| line.preload.is_some());
    let mut names: Vec<String> = FIRST_COLUMNS.map(str::to_string).to_vec();
    names.extend(column.map(str::to_string));
    names.push(SPEED.to_string());
    names.extend(entry_names("k"));
    names.extend(has_damping.then(|| entry_names("c")).into_iter().flatten());
    names.extend(has_preload.then(|| PRELOAD.to_string()));
    writer.write_record(&names)?;
    for (i, line) in lines.iter().enumerate() {
        let mut cells = vec![i.to_string()];
        let numbers = std::iter::once(line.time);
        let numbers = numbers.chain(column.and(line.value));
        let numbers = numbers.chain([line.speed]);
        let numbers = numbers.chain(line.stiffness.as_flattened().iter().copied());
        let damping = line.damping.iter().flat_map(|c| c.as_flattened().to_vec());
        let preload = line.preload.filter(|_| has_preload);
        cells.extend(numbers.chain(damping).chain(preload).map(|x| format!("{x:?}")));
        writer.write_record(&cells)?;
    }
    Ok(writer.into_inner()?)
}

/// Names of the entries of a matrix, by rows.
fn entry_names(of: &str) -> Vec<String> {
    let row = |i: &str| AXES.map(|j| format!("{of}_{i}_{j}"));
    AXES.iter().flat_map(|i| row(i)).collect()
}

/// Prints the ripple of the diagonal; that of a bearing without load has no mean, and is 0.
pub(crate) fn print_ripple(of: &str, ripple: &Ripple) {
    let share = |i: usize| match ripple.mean[i][i] {
        0.0 => 0.0,
        mean => 50.0 * (ripple.maximum[i][i] - ripple.minimum[i][i]) / mean,
    };
    let cells = (0..N_SHAFT).map(|i| format!("{} {:.4}", AXES[i], share(i)));
    print::line(format_args!(
        "{of}: ball-pass ripple, +- % of the mean over {} positions: {}",
        ripple.positions,
        cells.collect::<Vec<_>>().join(", ")
    ));
}

pub(crate) fn print_matrix(title: &str, matrix: &ShaftMatrix) {
    print::line(format_args!("{title}"));
    for (axis, row) in AXES.iter().zip(matrix) {
        let cells: Vec<String> = row.iter().map(|x| format!("{x:13.5e}")).collect();
        print::line(format_args!("{axis:>8} {}", cells.concat()));
    }
}
