//! Results of a `[modes]` scene with a list of bearings: `modes.csv` of all of it and `mode_shaft.csv`; each bearing
//! has the files of one ([`crate::modes`]) in a folder of its own.

use std::path::Path;

use assembly::Assembly;
use dynamics::modes::{ModeOfSeveral, ModesOfSeveral};
use dynamics::stiffness::N_SHAFT;
use dynamics::{Mode, ModeSet};

use crate::modes::{TABLE, cells, columns, tied_sides};
use crate::seat::ON_SHAFT;
use crate::several::line;
use crate::shaft_sections::ShaftBodyLine;
use crate::tables::{append, create};

/// What vibrates, as `modes.csv` has it.
const SEVERAL: &str = "bearings";
/// The shaft in the modes.
pub(crate) const SHAFT_TABLE: &str = "mode_shaft.csv";
/// Columns of `mode_shaft.csv`: displacements over the largest one of the mode, tilts per m.
const SHAFT_COLUMNS: [&str; 7] = [
    "mode",
    "position_m",
    "x",
    "y",
    "z",
    "tilt_x_per_m",
    "tilt_y_per_m",
];

/// The tables of the modes of several bearings: `modes.csv` of all of it, and `mode_shaft.csv`.
pub fn write_tables_of_several(
    dir: &Path,
    assembly: &Assembly,
    found: &ModesOfSeveral,
    free: &[usize],
) -> anyhow::Result<()> {
    let mut tied = [false; 2];
    for bearing in &assembly.bearings {
        let own = tied_sides(&bearing.model);
        (0..2).for_each(|i| tied[i] |= own[i]);
    }
    let mut table = create(dir, TABLE, &columns(tied))?;
    let names: Vec<String> = SHAFT_COLUMNS.map(str::to_string).to_vec();
    let mut shaft = create(dir, SHAFT_TABLE, &names)?;
    let bodies = bodies_on_shaft(assembly);
    for (number, mode) in (1..).zip(&found.modes) {
        let row = cells((number as u64, number), SEVERAL, &mode.whole, tied);
        append(&mut table, TABLE, [row])?;
        let rows = line_of_mode(assembly, &bodies, mode, free)
            .into_iter()
            .map(|(z, q)| {
                let numbers = std::iter::once(z).chain(q).map(|x| format!("{x:?}"));
                std::iter::once(number.to_string()).chain(numbers).collect()
            });
        append(&mut shaft, SHAFT_TABLE, rows.collect::<Vec<Vec<String>>>())?;
    }
    Ok(())
}

/// The elastic bodies that are the shaft; none of a beam, which is the line itself.
fn bodies_on_shaft(assembly: &Assembly) -> Vec<ShaftBodyLine> {
    if assembly.shaft.is_beam() {
        return Vec::new();
    }
    let numbers = 0..assembly.bearings.len();
    let of = |number| ShaftBodyLine::of(&assembly.bearings, number);
    numbers.filter_map(of).collect()
}

/// Places of the shaft in a mode and their displacements: nodes of a beam, bearings of a rigid shaft, sections of
/// elastic bodies on it and the bearings that sit on none.
fn line_of_mode(
    assembly: &Assembly,
    bodies: &[ShaftBodyLine],
    mode: &ModeOfSeveral,
    free: &[usize],
) -> Vec<(f64, [f64; N_SHAFT])> {
    let mut q = vec![0.0; assembly.shaft.n()];
    free.iter().zip(&mode.shaft).for_each(|(&dof, x)| q[dof] = *x);
    if bodies.is_empty() {
        return line(assembly, |z| assembly.shaft.moved_at(z, &q));
    }
    let of_body = |body: &ShaftBodyLine| {
        let shape = mode.bearings[body.bearing].shape.bodies[ON_SHAFT.index()].as_ref();
        shape.map_or_else(Vec::new, |shape| body.at(&assembly.bearings, shape))
    };
    let mut places: Vec<(f64, [f64; N_SHAFT])> = bodies.iter().flat_map(of_body).collect();
    for bearing in &assembly.bearings {
        if bearing.model.tied(ON_SHAFT).is_none() {
            let z = bearing.place.position;
            places.push((z, assembly.shaft.moved_at(z, &q)));
        }
    }
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    places
}

/// The modes of several bearings as a set: of all of it, or what one bearing has of them.
pub fn set_of_several(found: &ModesOfSeveral, of: impl Fn(&ModeOfSeveral) -> &Mode) -> ModeSet {
    ModeSet {
        modes: found.modes.iter().map(|mode| of(mode).clone()).collect(),
        loose_balls: found.loose_balls,
        n_unknowns: found.n_unknowns,
        steps: found.steps,
        laps: found.laps.clone(),
    }
}
