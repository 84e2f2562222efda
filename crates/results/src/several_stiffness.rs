//! Results of `raceway stiffness` for several bearings on one shaft: those of the shaft in the files of one bearing,
//! and a table for each bearing, `stiffness_NAME.csv` and `ross_NAME.csv`.
//!
//! All matrices are in the frame of the shaft. That of a bearing is over the shaft's motion at its place; that of the
//! shaft over the motion of one of its points, with all bearings and the shaft's own elasticity. Where a body carries
//! several bearings, that of a bearing holds while the shaft stays at the others; what the motion of one place does to
//! another bearing is apart.

use std::collections::BTreeMap;
use std::path::Path;

use comm::print;
use dynamics::bodies::AXES;
use dynamics::kinematics::BothRings;
use dynamics::stiffness::{N_SHAFT, ShaftMatrix};
use serde::Serialize;

use crate::console::digits;
use crate::failure::Failure;
use crate::stiffness::{
    Ripple, SCHEMA, STIFFNESS_FILE, STIFFNESS_TABLE, StiffnessAt, StiffnessResults, TableLine, UNITS,
    print_matrix, print_ripple, table,
};
use crate::summary::print_warnings;
use crate::whole;

/// Start of the names of the bearings' tables.
pub const BEARING_STIFFNESS: &str = "stiffness_";
/// Start of the names of the bearings' tables for ROSS.
const BEARING_ROSS: &str = "ross_";

/// The shaft at one point of a sweep.
#[derive(Clone, Debug, Serialize)]
pub struct ShaftStiffnessAt {
    /// The swept value; absent without a sweep.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Speed of the shaft, rad/s.
    #[serde(rename = "speed_rad_per_s")]
    pub speed: f64,
    /// Force along the axis by which the bearings press on each other, N; None unless there are bearings of both
    /// orientations.
    #[serde(rename = "preload_n", skip_serializing_if = "Option::is_none")]
    pub preload: Option<f64>,
    /// Stiffness.
    pub stiffness: ShaftMatrix,
    /// Damping; null where the scene has no damping law.
    pub damping: Option<ShaftMatrix>,
    /// Displacement there, m and rad.
    pub displacement: [f64; N_SHAFT],
    /// The equilibrium; what bearings and balls carry stands in those of the bearings.
    pub operating_point: ShaftOperatingPoint,
    /// Ball-pass ripple, if it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ripple: Option<Ripple>,
}

/// The equilibrium of the shaft.
#[derive(Clone, Debug, Serialize)]
pub struct ShaftOperatingPoint {
    /// Instant, s.
    pub time_s: f64,
    /// Speeds of the rings in the frame of the shaft, inner first, rad/s.
    pub speed_rad_per_s: BothRings,
    /// Displacement of the point, m and rad.
    pub shaft_displacement: [f64; N_SHAFT],
}

/// A bearing with its matrices at all points.
#[derive(Debug)]
pub struct BearingStiffness {
    /// Its name.
    pub name: String,
    /// Its position along the shaft, m.
    pub position: f64,
    /// Its orientation.
    pub orientation: &'static str,
    /// Its matrices in the frame of the shaft, and its operating points in its own.
    pub results: StiffnessResults,
}

/// Load on a bearing by the motion of the shaft at another that sits in the same body.
#[derive(Clone, Debug, Serialize)]
pub struct CouplingStiffness {
    /// The bearing.
    pub loaded: String,
    /// The one whose place on the shaft moves.
    pub moved: String,
    /// Stiffness at all points.
    pub stiffness: Vec<ShaftMatrix>,
    /// Damping at all points; null where there is none.
    pub damping: Vec<Option<ShaftMatrix>>,
    /// Ball-pass ripple of the stiffness at all points, if it was asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ripple: Vec<Ripple>,
}

/// Everything that is written.
#[derive(Debug)]
pub struct SeveralStiffness {
    /// The scene.
    pub source: String,
    /// Column of the swept values, with its unit.
    pub column: Option<String>,
    /// Bearings in the order of the scene.
    pub bearings: Vec<BearingStiffness>,
    /// Position of the point of the shaft, m.
    pub position: f64,
    /// The shaft at all points.
    pub shaft: Vec<ShaftStiffnessAt>,
    /// What bearings do to each other through a body that carries them.
    pub couplings: Vec<CouplingStiffness>,
    /// What the damping of the shaft is, or why there is none.
    pub damping_note: String,
    /// Warnings a user should read.
    pub warnings: Vec<String>,
}

#[derive(Serialize)]
struct FileOfSeveral<'a> {
    stiffness_schema: u32,
    source: &'a str,
    order: [&'static str; N_SHAFT],
    units: &'static str,
    damping_note: &'a str,
    warnings: &'a [String],
    #[serde(skip_serializing_if = "Option::is_none")]
    column: Option<&'a str>,
    shaft: ShaftOfFile<'a>,
    bearings: BTreeMap<&'a str, BearingOfFile<'a>>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    couplings: &'a [CouplingStiffness],
}

#[derive(Serialize)]
struct ShaftOfFile<'a> {
    position_m: f64,
    points: &'a [ShaftStiffnessAt],
}

#[derive(Serialize)]
struct BearingOfFile<'a> {
    position_m: f64,
    orientation: &'static str,
    damping_note: &'a str,
    points: &'a [StiffnessAt],
}

impl SeveralStiffness {
    /// Names of the files, those of bearings too.
    pub fn names(bearings: &[String]) -> Vec<String> {
        let own = bearings.iter().flat_map(|b| {
            [
                format!("{BEARING_STIFFNESS}{b}.csv"),
                format!("{BEARING_ROSS}{b}.csv"),
            ]
        });
        [STIFFNESS_FILE, STIFFNESS_TABLE]
            .map(str::to_string)
            .into_iter()
            .chain(own)
            .collect()
    }

    /// Whether the points are those of bearings over the speed of the shaft, or one point.
    pub fn suits_ross(&self) -> bool {
        self.bearings.iter().all(|bearing| bearing.results.suits_ross())
    }

    /// Writes the files into a folder, each whole or not at all, and returns their names.
    pub fn write(&self, dir: &Path) -> Result<Vec<String>, Failure> {
        let mut names = vec![STIFFNESS_FILE.to_string(), STIFFNESS_TABLE.to_string()];
        let mut text = serde_json::to_vec_pretty(&self.file())?;
        text.push(b'\n');
        whole::write_new(&dir.join(STIFFNESS_FILE), |file| file.write_all(&text))?;
        let line = |point: &ShaftStiffnessAt| TableLine {
            time: point.operating_point.time_s,
            value: point.value,
            speed: point.speed,
            preload: point.preload,
            stiffness: point.stiffness,
            damping: point.damping,
        };
        let lines: Vec<TableLine> = self.shaft.iter().map(line).collect();
        let own = table(self.column.as_deref(), &lines)?;
        whole::write_new(&dir.join(STIFFNESS_TABLE), |file| file.write_all(&own))?;
        for bearing in &self.bearings {
            let name = format!("{BEARING_STIFFNESS}{}.csv", bearing.name);
            let own = bearing.results.table()?;
            whole::write_new(&dir.join(&name), |file| file.write_all(&own))?;
            names.push(name);
            if self.suits_ross() {
                let name = format!("{BEARING_ROSS}{}.csv", bearing.name);
                let own = bearing.results.ross()?;
                whole::write_new(&dir.join(&name), |file| file.write_all(&own))?;
                names.push(name);
            }
        }
        Ok(names)
    }

    fn file(&self) -> FileOfSeveral<'_> {
        let bearing = |b| {
            let BearingStiffness { name, results, .. }: &BearingStiffness = b;
            let file = BearingOfFile {
                position_m: b.position,
                orientation: b.orientation,
                damping_note: &results.damping_note,
                points: &results.points,
            };
            (name.as_str(), file)
        };
        FileOfSeveral {
            stiffness_schema: SCHEMA,
            source: &self.source,
            order: AXES,
            units: UNITS,
            damping_note: &self.damping_note,
            warnings: &self.warnings,
            column: self.column.as_deref(),
            shaft: ShaftOfFile {
                position_m: self.position,
                points: &self.shaft,
            },
            bearings: self.bearings.iter().map(bearing).collect(),
            couplings: &self.couplings,
        }
    }

    /// Prints the diagonals at every point, and the whole matrix of the shaft at a single one.
    pub fn print(&self) {
        let name = self.column.as_deref().unwrap_or("point");
        let width = name.len().max(12);
        print::line(format_args!(
            "{name:>width$}  of             k_x N/um   k_y N/um   k_z N/um  k_tilt_x, k_tilt_y N m/mrad"
        ));
        for (i, shaft) in self.shaft.iter().enumerate() {
            let value = digits(shaft.value.unwrap_or(i as f64));
            let own = self
                .bearings
                .iter()
                .map(|b| (b.name.as_str(), &b.results.points[i].stiffness));
            for (name, stiffness) in own.chain([("shaft", &shaft.stiffness)]) {
                let k = |i: usize| stiffness[i][i] * if i < 3 { 1e-6 } else { 1e-3 };
                print::line(format_args!(
                    "{value:>width$}  {name:<12} {:10.3} {:10.3} {:10.3} {:12.4} {:12.4}",
                    k(0),
                    k(1),
                    k(2),
                    k(3),
                    k(4)
                ));
            }
        }
        self.print_preload();
        if let [shaft] = self.shaft.as_slice() {
            let title = format!(
                "shaft at {:.3} mm, N/m, N/rad, N m/m, N m/rad",
                1e3 * self.position
            );
            print_matrix(&title, &shaft.stiffness);
            let damping = shaft.damping.iter();
            damping.for_each(|damping| print_matrix("damping there, N s/m and so on", damping));
        }
        self.print_ripple();
        print::line(format_args!("damping: {}", self.damping_note));
        print_warnings(&self.warnings);
    }

    fn print_preload(&self) {
        for (i, shaft) in self.shaft.iter().enumerate() {
            if let Some(preload) = shaft.preload {
                print::line(format_args!(
                    "point {i}: the bearings press on each other with {preload:.2} N along the axis"
                ));
            }
        }
    }

    fn print_ripple(&self) {
        for (i, shaft) in self.shaft.iter().enumerate() {
            let of_bearing = |b| {
                let BearingStiffness { name, results, .. }: &BearingStiffness = b;
                let ripple = results.points[i].ripple.as_ref();
                ripple.map(|ripple| (name.as_str(), ripple))
            };
            let own = self.bearings.iter().filter_map(of_bearing);
            for (name, ripple) in own.chain(shaft.ripple.as_ref().map(|ripple| ("shaft", ripple))) {
                print_ripple(&format!("point {i}, {name}"), ripple);
            }
        }
    }
}
