//! Results of `raceway campbell`: `campbell.csv`, `campbell_lines.csv`, and a table on the screen.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use comm::print;
use contact::BearingGeometry;
use dynamics::kinematics::{BothRings, Kinematics, SlipRatios};
use dynamics::whirl::WhirlMode;

use crate::failure::Failure;
use crate::whole;

/// Modes over the speed.
pub const CAMPBELL_TABLE: &str = "campbell.csv";
/// What excites a bearing over the speed.
pub const CAMPBELL_LINES: &str = "campbell_lines.csv";
const COLUMNS: [&str; 7] = [
    "speed_rpm",
    "mode",
    "frequency_hz",
    "whirl",
    "damping_ratio",
    "roundness",
    "shaft_share",
];
/// Lines of what excites a bearing, and their columns.
pub const EXCITATIONS: [(&str, &str); 4] = [
    ("once per turn", "shaft_hz"),
    ("cage", "cage_hz"),
    ("ball pass, outer ring", "ball_pass_outer_hz"),
    ("ball pass, inner ring", "ball_pass_inner_hz"),
];

/// Modes at one speed.
#[derive(Clone, Debug)]
pub struct ModesAtSpeed {
    /// Speeds of the rings, inner first, rad/s; the inner one is that of the shaft.
    pub speeds: BothRings,
    /// Modes, from the lowest frequency.
    pub modes: Vec<WhirlMode>,
}

impl ModesAtSpeed {
    /// Speed of the shaft, rpm.
    pub fn rpm(&self) -> f64 {
        without_round_off(self.speeds[0] * 30.0 / PI)
    }
}

/// Speeds, rpm, are told to this part of one; a diagram asks for them in rpm, and rad/s and back costs the last digit.
const OF_RPM: f64 = 1e9;

/// A speed, rpm, without the round-off of its way through rad/s; the digits stay where that would cost some.
fn without_round_off(rpm: f64) -> f64 {
    let rounded = (rpm * OF_RPM).round() / OF_RPM;
    match (rounded - rpm).abs() <= 4.0 * f64::EPSILON * rpm.abs() {
        true => rounded,
        false => rpm,
    }
}

/// Writes both tables into a folder, each whole or not at all.
pub fn write_campbell(
    dir: &Path,
    found: &[ModesAtSpeed],
    geometry: &BearingGeometry,
    slip: SlipRatios,
) -> Result<(), Failure> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(COLUMNS)?;
    for at in found {
        for (i, mode) in at.modes.iter().enumerate() {
            let numbers = [mode.damping_ratio, mode.roundness, mode.shaft_share];
            let first = [
                format!("{:?}", at.rpm()),
                (i + 1).to_string(),
                format!("{:?}", mode.frequency),
                mode.whirl.name().to_string(),
            ];
            table.write_record(first.into_iter().chain(numbers.map(|x| format!("{x:?}"))))?;
        }
    }
    write_table(dir, CAMPBELL_TABLE, table)?;
    let rolling = Kinematics::new(geometry, slip);
    let mut lines = csv::Writer::from_writer(Vec::new());
    lines.write_record(std::iter::once(COLUMNS[0]).chain(EXCITATIONS.map(|(_, column)| column)))?;
    for at in found {
        let [inner, outer] = at.speeds;
        let (cage, n) = (rolling.of_cage(at.speeds), geometry.n_balls as f64);
        let rates = [inner, cage, n * (cage - outer), n * (inner - cage)].map(|w| w.abs() / TAU);
        let cells = std::iter::once(at.rpm()).chain(rates);
        lines.write_record(cells.map(|x| format!("{x:?}")))?;
    }
    write_table(dir, CAMPBELL_LINES, lines)
}

fn write_table(dir: &Path, name: &str, table: csv::Writer<Vec<u8>>) -> Result<(), Failure> {
    let content = table.into_inner().map_err(|error| anyhow::anyhow!("{error}"))?;
    Ok(whole::write_new(&dir.join(name), |file| {
        file.write_all(&content)
    })?)
}

/// Prints the modes at every speed.
pub fn print_campbell(found: &[ModesAtSpeed]) {
    print::line(format_args!(
        "speed rpm  mode  frequency Hz  whirl     damping ratio  share of the shaft"
    ));
    for at in found {
        for (i, mode) in at.modes.iter().enumerate() {
            print::line(format_args!(
                "{:9.1} {:5} {:13.4}  {:8} {:14.6} {:19.3}",
                at.rpm(),
                i + 1,
                mode.frequency,
                mode.whirl.name(),
                // Without the sign of round-off.
                (1e6 * mode.damping_ratio).round() / 1e6 + 0.0,
                mode.shaft_share
            ));
        }
    }
}
