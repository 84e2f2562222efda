//! Results of a `[modes]` scene: `modes.csv`, a step file per mode, `summary.json`, and tables on the screen.
//!
//! A step file holds one shape as the field `displacement`, scaled so that the largest displacement is 1 mm, and the
//! stress that goes with it. Steps count from 1 through all bodies; the time of a step is its number, because viewers
//! need times that grow and double modes share a frequency: `modes.csv` and the group `/restart` of the file give it.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use checkpoint::{CellFields, GrowingFile, Output, PointFields, Stamps, StateArray, StepRecord};
use comm::print;
use contact::{Meridian, Side};
use dynamics::balls::BallResult;
use dynamics::costs::{FACTOR, SEARCH};
use dynamics::{Mode, ModeSet, Model};
use scene::{ModeBody, Scene};
use serde::Serialize;
use timer::Laps;

use super::bodies::{BodiesElsewhere, BodyField, bodies_of};
use super::fields;
use super::files::{mesh_file, say_folder, storage};
use super::folder;
use super::mounting::{ClearanceSummary, FitSummary, fits};
use super::ring_stress::{RingStress, ShownRing, StressBasis};
use super::shown::Turn;
use super::snapshot::Snapshot;
use super::summary::{
    SUMMARY_SCHEMA, ShaftSummary, TOTAL, mode_name, peak_memory, print_peak, print_seconds, print_warnings,
    sides, write_summary,
};
use super::tables;
use crate::failure::Failure;

/// Largest displacement of a shape in a step file, m.
pub(crate) const AMPLITUDE: f64 = 1e-3;

/// Name of the table.
pub(crate) const TABLE: &str = "modes.csv";

const COLUMNS: [&str; 12] = [
    "step",
    "body",
    "mode",
    "frequency_hz",
    "bound_hz",
    "residual",
    "rigid",
    "modal_mass_kg",
    "kinetic_inner",
    "kinetic_outer",
    "kinetic_balls",
    "kinetic_shaft",
];

/// One more column where a ring is in an elastic body, inner first: its share, part of that of the ring.
const OF_BODIES: [&str; 2] = ["kinetic_shaft_body", "kinetic_body"];

/// The open files of a run.
pub struct ModeFiles {
    output: Output,
    table: csv::Writer<GrowingFile>,
    stress: RingStress,
    step: u64,
}

impl ModeFiles {
    /// Creates the folder's files, and says where they are.
    pub fn create(scene: &Scene, model: &Model, dir: &Path) -> Result<ModeFiles, Failure> {
        let files = ModeFiles::create_part(scene, model, dir)?;
        say_folder(dir);
        Ok(files)
    }

    /// The same for the folder of a part of a run, of which nothing is said.
    pub fn create_part(scene: &Scene, model: &Model, dir: &Path) -> Result<ModeFiles, Failure> {
        let output = Output::create_in(folder::prepare(dir)?, &mesh_file(scene, model)?, storage(scene))?;
        Ok(ModeFiles {
            output,
            table: tables::create(dir, TABLE, &columns(tied_sides(model)))?,
            stress: RingStress::new(model, scene)?,
            step: 0,
        })
    }

    /// Writes the modes of one body.
    pub fn write(
        &mut self,
        scene: &Scene,
        model: &Model,
        body: ModeBody,
        set: &ModeSet,
    ) -> Result<(), Failure> {
        for (i, mode) in set.modes.iter().enumerate() {
            self.step += 1;
            let (points, cell_fields) = self.fields(model, mode);
            // The table first: a step vouches for it.
            let row = cells((self.step, i + 1), body.typed(), mode, tied_sides(model));
            tables::append(&mut self.table, TABLE, [row])?;
            self.table.get_ref().handle()?.sync_data()?;
            let record = StepRecord {
                step: self.step,
                time: self.step as f64,
                points,
                cells: cell_fields,
                scene: scene.text.clone(),
                state: BTreeMap::from([
                    ("frequency_hz".to_string(), StateArray::Real(vec![mode.frequency])),
                    ("mode".to_string(), StateArray::Integer(vec![i as i64 + 1])),
                    ("modes_body".to_string(), StateArray::Integer(vec![body as i64])),
                ]),
                tables: Some(Stamps::from([(TABLE.to_string(), self.table.get_ref().stamp())])),
            };
            self.output.write_step(&record)?;
        }
        Ok(())
    }

    /// Closes the files and returns the identity of the run.
    pub fn finish(self) -> Result<Option<String>, Failure> {
        let run = self.output.run().map(str::to_string);
        self.output.finish()?;
        Ok(run)
    }

    /// Fields of a shape over the points and cells of all bodies; those that do not take part are at rest.
    fn fields(&self, model: &Model, mode: &Mode) -> (PointFields, CellFields) {
        let (mut displacement, mut rings) = (Vec::new(), [None, None]);
        for side in Side::BOTH {
            let (Some(ring), i) = (model.ring(side), side.index()) else {
                continue;
            };
            let field: Vec<f64> = match &mode.shape.rings[i] {
                Some(shape) => shape.iter().map(|u| AMPLITUDE * u).collect(),
                None => vec![0.0; ring.mesh.n_dofs()],
            };
            displacement.extend(field.chunks_exact(3).map(|u| [u[0], u[1], u[2]]));
            rings[i] = Some(ShownRing {
                own_stress: None,
                basis: StressBasis::Displacement(field),
                turn: Turn::new(0.0),
                patches: Vec::new(),
            });
        }
        for ball in 0..model.geometry.n_balls {
            let Meridian { radial, axial } = mode.shape.balls.get(ball).copied().unwrap_or_default();
            let (sin, cos) = model.geometry.azimuth(ball).sin_cos();
            displacement.push([radial * cos, radial * sin, axial].map(|u| AMPLITUDE * u));
        }
        let bodies = bodies_of(model).into_iter().map(|body| {
            BodyField::standing(match &mode.shape.bodies[body.side.index()] {
                Some(shape) => shape.iter().map(|u| AMPLITUDE * u).collect(),
                None => vec![0.0; body.mesh.n_dofs()],
            })
        });
        let bodies: Vec<BodyField> = bodies.collect();
        let moved = bodies
            .iter()
            .flat_map(|body| body.displacement.as_chunks::<3>().0);
        displacement.extend(moved);
        fields::with_stress(displacement, self.stress.fields(&rings, &bodies))
    }
}

/// Whether the rings are in elastic bodies, inner first.
pub(crate) fn tied_sides(model: &Model) -> [bool; 2] {
    Side::BOTH.map(|side| model.tied(side).is_some())
}

/// Columns of the table.
pub(crate) fn columns(tied: [bool; 2]) -> Vec<String> {
    let of_bodies = (0..2).filter(|&i| tied[i]).map(|i| OF_BODIES[i]);
    COLUMNS.into_iter().chain(of_bodies).map(str::to_string).collect()
}

/// Cells of a row.
pub(crate) fn cells((step, number): (u64, usize), body: &str, mode: &Mode, tied: [bool; 2]) -> Vec<String> {
    let mut cells = vec![step.to_string(), body.to_string(), number.to_string()];
    cells.extend([mode.frequency, mode.bound, mode.residual].map(|x| format!("{x:?}")));
    cells.push(u8::from(mode.is_rigid).to_string());
    cells.push(format!("{:?}", mode.modal_mass));
    cells.extend(mode.kinetic.map(|x| format!("{x:?}")));
    let of_bodies = (0..2).filter(|&i| tied[i]);
    cells.extend(of_bodies.map(|i| format!("{:?}", mode.kinetic_bodies[i])));
    cells
}

/// Prints the modes of one body.
pub fn print_modes(name: &str, set: &ModeSet) {
    let has_body = |i: usize| set.modes.iter().any(|mode| mode.kinetic_bodies[i] > 0.0);
    let bodies: Vec<usize> = [1, 0].into_iter().filter(|&i| has_body(i)).collect();
    let heads = bodies
        .iter()
        .map(|&i| format!("  of {} in the body", Side::BOTH[i].name()));
    print::line(format_args!(
        "{name}: {} unknowns, {} blocks, {:.2} s",
        set.n_unknowns,
        set.steps,
        set.laps.total()
    ));
    print::line(format_args!(
        "mode  frequency Hz    bound Hz  modal kg   kinetic energy: inner  outer  balls  shaft{}",
        heads.collect::<String>()
    ));
    for (i, mode) in set.modes.iter().enumerate() {
        let [inner, outer, balls, shaft] = mode.kinetic;
        let of_bodies = bodies.iter().map(|&i| format!(" {:6.3}", mode.kinetic_bodies[i]));
        print::line(format_args!(
            "{:4} {:13.4} {:11.1e} {:9.3e} {:22.3} {outer:6.3} {balls:6.3} {shaft:6.3}{}{}",
            i + 1,
            mode.frequency,
            mode.bound,
            mode.modal_mass,
            inner,
            of_bodies.collect::<String>(),
            if mode.is_rigid { "  without stiffness" } else { "" }
        ));
    }
}

/// `summary.json` of a `[modes]` scene; `schema`, `scene`, `run`, `title`, `version`, `status`,
/// `contact_mode`, `effects`, `dofs`, `warnings`, `advice` and `peak_memory_bytes` as in all runs.
#[derive(Debug, Serialize)]
pub struct ModesSummary {
    schema: u32,
    scene: String,
    run: Option<String>,
    title: Option<String>,
    version: &'static str,
    analysis: &'static str,
    status: &'static str,
    contact_mode: &'static str,
    effects: Vec<&'static str>,
    dofs: BTreeMap<&'static str, usize>,
    modes: BTreeMap<&'static str, FrequenciesSummary>,
    /// The equilibrium about which the bearing vibrates; absent for rings alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    shaft: Option<ShaftSummary>,
    #[serde(skip_serializing_if = "Option::is_none")]
    balls: Option<Vec<BallResult>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    clearance: Option<ClearanceSummary>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    fits: BTreeMap<&'static str, FitSummary>,
    /// Bodies that the files of another bearing of the list show, with its folder; absent without such.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    bodies_shown_in: BodiesElsewhere,
    warnings: Vec<String>,
    advice: Vec<String>,
    timing_s: BTreeMap<&'static str, f64>,
    peak_memory_bytes: u64,
}

/// Natural frequencies in a summary.
#[derive(Debug, Serialize)]
pub struct FrequenciesSummary {
    unknowns: usize,
    blocks: usize,
    frequency_hz: Vec<f64>,
    bound_hz: Vec<f64>,
}

impl FrequenciesSummary {
    /// Those of a set.
    pub fn new(set: &ModeSet) -> FrequenciesSummary {
        FrequenciesSummary {
            unknowns: set.n_unknowns,
            blocks: set.steps,
            frequency_hz: set.modes.iter().map(|m| m.frequency).collect(),
            bound_hz: set.modes.iter().map(|m| m.bound).collect(),
        }
    }
}

impl ModesSummary {
    /// Summary of a finished run that began at `start`.
    pub fn new(
        scene: &Scene,
        model: &Model,
        sets: &[(ModeBody, ModeSet)],
        equilibrium: Option<&Snapshot>,
        run: Option<String>,
        [warnings, advice]: [Vec<String>; 2],
        start: Instant,
    ) -> ModesSummary {
        let mut laps = Laps::default();
        sets.iter().for_each(|(_, set)| laps.merge(&set.laps));
        laps.add(TOTAL, start.elapsed().as_secs_f64());
        ModesSummary {
            schema: SUMMARY_SCHEMA,
            scene: scene.path.display().to_string(),
            run,
            title: scene.title.clone(),
            version: env!("CARGO_PKG_VERSION"),
            analysis: "modes",
            status: "finished",
            contact_mode: mode_name(model),
            effects: model.effects.iter().map(|e| e.name()).collect(),
            dofs: sides(|i| model.rings[i].as_ref().map_or(0, |r| r.mesh.n_dofs())),
            modes: sets
                .iter()
                .map(|(b, set)| (b.typed(), FrequenciesSummary::new(set)))
                .collect(),
            shaft: equilibrium.map(ShaftSummary::new),
            balls: equilibrium.map(|e| e.balls.clone()),
            clearance: model.mounting.report.as_ref().map(ClearanceSummary::new),
            fits: fits(model.mounting.report.as_ref()),
            bodies_shown_in: BodiesElsewhere::new(),
            warnings,
            advice,
            timing_s: [FACTOR, SEARCH, TOTAL].map(|lap| (lap, laps.seconds(lap))).into(),
            peak_memory_bytes: peak_memory(),
        }
    }

    /// The same with the bodies that the files of another bearing show.
    pub fn with_bodies_shown_in(self, bodies_shown_in: BodiesElsewhere) -> ModesSummary {
        ModesSummary {
            bodies_shown_in,
            ..self
        }
    }

    /// Prints warnings, then where the time went.
    pub fn print_costs(&self) {
        print_warnings(&self.warnings);
        print_seconds(self.timing_s.iter().map(|(part, s)| (*part, *s)));
        print_peak(self.peak_memory_bytes, None);
    }

    /// Writes the file: complete or not at all.
    pub fn write(&self, dir: &Path) -> anyhow::Result<()> {
        write_summary(dir, self)
    }
}
