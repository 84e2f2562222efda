//! A list of bearings at its steps, all in the frame of the shaft: blocks of the rings, balls and bodies of each
//! bearing, and the line of the shaft.
//!
//! The inner groove centres of a bearing stand at its position along z; one of orientation "-z" is turned by 180 deg
//! about x, places, vectors and tensors ([`assembly::place`]). Shapes of modes have the largest displacement of 1 mm,
//! the shaft too.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use assembly::{Orientation, Seating};
use checkpoint::{Grid, StepRecord};
use contact::Side;
use scene::{MeshFiles, Scene, geometry};
use serde::Deserialize;

pub use super::blocks::ShownGrid;
use super::blocks::{BodyPart, parts, shaft_line};
use crate::modes::AMPLITUDE;
use crate::several::{BEARING, BEARINGS_TABLE, SCENE_TEXT, SHAFT_TABLE};
use crate::several_modes::SHAFT_TABLE as MODES_TABLE;
use crate::table::Table;

/// What the text of the scene says of the list.
#[derive(Deserialize)]
struct ListText {
    bearing: Vec<BearingText>,
    #[serde(default)]
    body: Vec<BodyText>,
}

#[derive(Deserialize)]
struct BearingText {
    name: String,
    orientation: String,
}

#[derive(Deserialize)]
struct BodyText {
    name: String,
    #[serde(default)]
    seat: Vec<SeatText>,
}

#[derive(Deserialize)]
struct SeatText {
    ring: String,
    bearing: String,
}

/// The results of a list in a folder.
pub struct ShownList {
    dir: PathBuf,
    /// Names of the bearings and which way they are turned, in their order.
    bearings: Vec<(String, Orientation)>,
    bodies: Vec<BodyText>,
    /// `bearings.csv`.
    places: Table,
    /// `shaft.csv`, or of modes `mode_shaft.csv`.
    shaft: ShaftTable,
}

/// Where the shaft stands: x, y, z, m, and tilts, rad, over the columns of a table.
struct ShaftTable {
    table: Table,
    /// Column of the number of a step.
    step: &'static str,
    /// Columns of x, y, z and tilts.
    columns: [&'static str; 5],
    /// Factor on them.
    scale: f64,
}

/// A body of a bearing at a step.
pub struct ShownPart {
    /// Where it belongs.
    pub owner: Owner,
    /// Name of its block.
    pub name: String,
    /// It in the frame of the shaft.
    pub shown: ShownGrid,
}

/// What a block is part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// The bearing whose step holds it.
    Bearing,
    /// A body in which rings of several bearings may sit.
    Body,
}

/// The bodies of a bearing, in its own frame.
pub struct BearingBodies {
    /// Its number in the list.
    number: usize,
    /// Where its inner groove centres are along its own z, m.
    origin: f64,
    parts: Vec<BodyPart>,
}

impl ShownList {
    /// Reads what a folder says of all bearings.
    pub fn read(dir: &Path) -> anyhow::Result<ShownList> {
        let path = dir.join(SCENE_TEXT);
        let text =
            std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let list: ListText = scene::read_tables(&text, &path)?;
        let oriented = |bearing: BearingText| {
            let found = Orientation::named(&bearing.orientation).ok_or_else(|| {
                let (name, found) = (&bearing.name, &bearing.orientation);
                anyhow!(
                    "{}: bearing {name:?} has orientation {found:?}; expected +z or -z",
                    path.display()
                )
            })?;
            Ok((bearing.name, found))
        };
        let places = required(dir, BEARINGS_TABLE)?;
        if places.names().iter().any(|name| name.ends_with(".orientation")) {
            return Err(anyhow!(
                "{} sweeps over the orientation of a bearing; expected bearings that are turned alike in all steps, \
                 export the folder of one of them",
                dir.display()
            ));
        }
        Ok(ShownList {
            dir: dir.to_path_buf(),
            bearings: list
                .bearing
                .into_iter()
                .map(oriented)
                .collect::<anyhow::Result<_>>()?,
            bodies: list.body,
            places,
            shaft: ShaftTable::read(dir)?,
        })
    }

    /// Names of the bearings, in their order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.bearings.iter().map(|(name, _)| name.as_str())
    }

    /// The bodies in the grid of a bearing, by its number; the grid was made for `first`, the first of its steps.
    pub fn parts_of(&self, number: usize, grid: &Grid, first: &StepRecord) -> anyhow::Result<BearingBodies> {
        let path = Path::new("scene of the step");
        let scene = Scene::parse(&first.scene, path, &[], MeshFiles::MayBeMissing)?;
        let geometry = geometry(&scene);
        let [origin, _] = Side::BOTH.map(|side| geometry.groove_centre(side).axial);
        Ok(BearingBodies {
            number,
            origin,
            parts: parts(grid),
        })
    }

    /// The bodies of a bearing at a step.
    pub fn shown(&self, bearing: &BearingBodies, record: &StepRecord) -> anyhow::Result<Vec<ShownPart>> {
        let mut seating = self.seating(bearing.number, record.step)?;
        // Its frame has its origin elsewhere.
        seating.position -= seating.orientation.turned_vector([0.0, 0.0, bearing.origin])[2];
        let shown = |part: &BodyPart| {
            let (owner, name) = self.block(bearing.number, part.body);
            let shown = part.on_shaft(record, &seating);
            ShownPart { owner, name, shown }
        };
        Ok(bearing.parts.iter().map(shown).collect())
    }

    /// The line of the shaft at a step.
    pub fn shaft(&self, step: u64) -> anyhow::Result<ShownGrid> {
        let line = self.shaft.line(step)?;
        if line.is_empty() {
            return Err(anyhow!(
                "no table of {} has the shaft at step {step}",
                self.dir.display()
            ));
        }
        Ok(shaft_line(&line))
    }

    /// Where a bearing sits at a step: as in its row of `bearings.csv`, of modes in that of the equilibrium.
    fn seating(&self, number: usize, step: u64) -> anyhow::Result<Seating> {
        let (name, orientation) = &self.bearings[number];
        let (steps, positions) = (self.places.column("step")?, self.places.column("position_m")?);
        let names = self.places.texts(BEARING).unwrap_or_default();
        let wanted = if self.shaft.is_of_modes() {
            0.0
        } else {
            step as f64
        };
        let row = (0..names.len()).find(|&i| steps[i] == wanted && names[i] == *name);
        let row = row.ok_or_else(|| {
            let path = self.dir.join(BEARINGS_TABLE);
            anyhow!(
                "{} has no row of the bearing {name:?} at step {step}",
                path.display()
            )
        })?;
        Ok(Seating {
            position: positions[row],
            orientation: *orientation,
            shift: 0.0,
        })
    }

    /// What a body of a bearing belongs to, and the name of its block. A body round rings has its name in the scene.
    fn block(&self, number: usize, body: u8) -> (Owner, String) {
        let name = &self.bearings[number].0;
        let ring = match body {
            0 => return (Owner::Bearing, "inner ring".to_string()),
            1 => return (Owner::Bearing, "outer ring".to_string()),
            2 => return (Owner::Bearing, "balls".to_string()),
            4 => "inner",
            _ => "outer",
        };
        let carries = |body: &&BodyText| {
            body.seat
                .iter()
                .any(|seat| seat.ring == ring && seat.bearing == *name)
        };
        let found = self.bodies.iter().find(carries);
        let own = || format!("body of the {ring} ring of {name}");
        (Owner::Body, found.map_or_else(own, |body| body.name.clone()))
    }
}

impl ShaftTable {
    fn read(dir: &Path) -> anyhow::Result<ShaftTable> {
        if let Some(table) = Table::read(dir, MODES_TABLE)? {
            return Ok(ShaftTable {
                table,
                step: "mode",
                columns: ["x", "y", "z", "tilt_x_per_m", "tilt_y_per_m"],
                scale: AMPLITUDE,
            });
        }
        Ok(ShaftTable {
            table: required(dir, SHAFT_TABLE)?,
            step: "step",
            columns: ["x_m", "y_m", "z_m", "tilt_x_rad", "tilt_y_rad"],
            scale: 1.0,
        })
    }

    fn is_of_modes(&self) -> bool {
        self.step == "mode"
    }

    /// Positions and displacements at a step.
    fn line(&self, step: u64) -> anyhow::Result<Vec<(f64, [f64; 5])>> {
        let (steps, positions) = (self.table.column(self.step)?, self.table.column("position_m")?);
        let mut columns = Vec::new();
        for name in self.columns {
            columns.push(self.table.column(name)?);
        }
        let rows = (0..steps.len()).filter(|&i| steps[i] == step as f64);
        let at = |i: usize| (positions[i], std::array::from_fn(|k| self.scale * columns[k][i]));
        Ok(rows.map(at).collect())
    }
}

/// A table that must be there.
fn required(dir: &Path, name: &str) -> anyhow::Result<Table> {
    let table = Table::read(dir, name)?;
    table.ok_or_else(|| {
        anyhow!(
            "{} has no rows; expected those of a list of bearings",
            dir.join(name).display()
        )
    })
}
