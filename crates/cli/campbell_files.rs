//! What `raceway campbell` of one bearing and of a list have in common: what they refuse, and what they write.

use std::path::Path;

use anyhow::anyhow;
use comm::print;
use contact::BearingGeometry;
use dynamics::kinematics::SlipRatios;
use results::campbell::{CAMPBELL_LINES, CAMPBELL_TABLE, ModesAtSpeed, print_campbell, write_campbell};
use results::failure::Failure;
use results::summary::print_warnings;
use results::whole::make_asked_folder;
use scene::Analysis;

use crate::linear_figures::draw;

/// Damping ratio below which a mode counts as one that grows: far beyond round-off.
pub const GROWS: f64 = -1e-8;

/// A diagram, and what a reader should know of it.
pub struct Diagram {
    /// Modes at all speeds.
    pub modes: Vec<ModesAtSpeed>,
    /// Warnings.
    pub warnings: Vec<String>,
    /// A remark on the lines of cage and balls.
    pub note: Option<String>,
}

/// Refuses a sweep.
pub fn require_one_point(analysis: &Analysis, scene: &Path) -> Result<(), Failure> {
    let Analysis::Sweep(sweep) = analysis else {
        return Ok(());
    };
    Err(Failure::User(anyhow!(
        "{} has a [sweep] of {}; expected one operating point, so replace [sweep] by [static]",
        scene.display(),
        sweep.key
    )))
}

/// Writes tables and figures into a folder, and prints the diagram; cage and balls are those of `geometry`.
pub fn write(
    diagram: &Diagram,
    out: &Path,
    geometry: &BearingGeometry,
    slip: SlipRatios,
) -> Result<(), Failure> {
    make_asked_folder(out)?;
    write_campbell(out, &diagram.modes, geometry, slip)?;
    print_campbell(&diagram.modes);
    print_warnings(&diagram.warnings);
    if let Some(note) = &diagram.note {
        print::line(format_args!("{note}"));
    }
    let figures = draw(out)?;
    print::line(format_args!(
        "{CAMPBELL_TABLE}, {CAMPBELL_LINES}, {} in {}",
        figures.join(", "),
        out.display()
    ));
    Ok(())
}
