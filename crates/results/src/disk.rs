//! Forecast of the output, and whether the disk has room for it.

use std::path::Path;

use anyhow::anyhow;
use checkpoint::Body;
use comm::print;
use contact::Side;
use dynamics::{Hold, Model, RingModel};
use fem::quadrature::stiffness_rule;
use scene::{Analysis, Dynamic, FieldPrecision, Scene, StressOutput};

use super::answer;
use super::fields;
use super::reduction_sizes::ReductionSizes;
use super::region::Region;
use crate::failure::Failure;

/// Numbers of a displacement.
const VECTOR: u64 = 3;
/// What rounded stress shrinks to at least, as 100 divided by this: measured 2.1 times at 1 kPa, 3.2 at 10 kPa; the
/// forecast counts on 2.
const ROUNDED_GAIN: u64 = 2;
/// Points up to which forces on balls are stored in full; beyond, chunks of so many of which at most two hold balls.
const FORCE_CHUNK: u64 = 128;
/// Bytes of the index of such chunks.
const FORCE_INDEX: u64 = 2_600;
/// Numbers of a stress tensor.
const TENSOR: u64 = 6;
/// Bytes of one ball in the state of a motion: position, velocity, and force, angle and approach of two contacts.
const BALL_BYTES: u64 = 8 * (2 + 2 + 2 * 4);
/// HDF5's own bytes in a step file besides the arrays and the scene: groups, names, links, checksums, seal. (Measured:
/// 28 kB with the format every library reads.)
const FRAME_BYTES: u64 = 28_000;
/// Bytes of a number in a table with its comma; most have all 17 digits, many an exponent.
const CELL_BYTES: u64 = 20;
/// Cells of a step in the tables: 16 per ball, and about 22 of shaft and energy.
const BALL_CELLS: u64 = 16;
const OTHER_CELLS: u64 = 22;
/// Cells of a step in the tables beside the folders of a list: three more per ball; of each bearing; of each place on
/// the shaft; and of its energy.
const LIST_BALL_CELLS: u64 = BALL_CELLS + 3;
const LIST_BEARING_CELLS: u64 = 17;
const PLACE_CELLS: u64 = 8;
const SHAFT_ENERGY_CELLS: u64 = 8;
/// HDF5's own bytes in the file of the mesh besides its arrays. (Measured: 14 kB.)
const MESH_FRAME_BYTES: u64 = 14_000;
/// The summary and the file that shows all steps, and what the latter has of each step. (Measured.)
const END_BYTES: u64 = 26_000;
const SHOWN_STEP_BYTES: u64 = 330;

/// Expected size of the results of a scene, bytes. Fields are counted without compression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Forecast {
    /// One step file with a restart state.
    pub step: u64,
    /// Number of step files.
    pub n_files: u64,
    /// Those of them with a restart state; all of them where nothing is resumed.
    pub n_states: u64,
    /// All files.
    pub total: u64,
    /// What is there once for all load cases: the file of the mesh, of a new run, and what is written at the end.
    once: u64,
    /// Rows of tables that have one per step.
    n_rows: u64,
    /// Balls, each with a row of its own at such a step.
    n_balls: u64,
    /// How to write less, for a message.
    fewer: &'static str,
}

impl Forecast {
    /// Forecast for the steps after `done` (0 for a new run, whose start has a file too).
    pub fn new(scene: &Scene, model: &Model, done: u64) -> Forecast {
        let bodies = fields::bodies(model);
        let n_points = rows(&bodies, |body| body.points.len());
        let once = END_BYTES + if done == 0 { mesh_bytes(&bodies) } else { 0 };
        let reduced = ReductionSizes::new(scene, model);
        let has_state = matches!(scene.analysis, Analysis::Dynamic(_) | Analysis::QuasiStatic(_));
        let reduced_state = reduced
            .as_ref()
            .filter(|_| has_state)
            .map_or(0, ReductionSizes::state);
        let state = state_bytes(scene, model) + reduced_state as u64;
        // A region without a node is refused elsewhere.
        let region = Region::new(scene, model).unwrap_or_default();
        let displacement = displacement_bytes(scene, n_points, region.as_ref());
        let stress = stress_bytes(scene, model, region.as_ref());
        let others = force_bytes(n_points) + FRAME_BYTES + SHOWN_STEP_BYTES + scene.text.len() as u64;
        let step = displacement + stress + state + others;
        let (n_files, n_rows) = match &scene.analysis {
            Analysis::Static => (1, 1),
            Analysis::Sweep(sweep) => (sweep.points.len() as u64, sweep.points.len() as u64),
            Analysis::Dynamic(dynamic) => files_and_rows(dynamic.output_every, dynamic.n_steps, done),
            Analysis::Modes(wanted) => ((wanted.number * wanted.bodies.len()) as u64, 0),
            Analysis::QuasiStatic(quasi) => files_and_rows(quasi.output_every, quasi.n_steps, done),
        };
        // Every step with fields has a row besides.
        let n_rows = match scene.output.tables_every {
            1 => n_rows,
            every => n_rows.min(n_rows / every + n_files),
        };
        let n_of = |every: u64| match &scene.analysis {
            Analysis::Dynamic(dynamic) => n_states(dynamic, every, done),
            Analysis::QuasiStatic(quasi) => {
                files_and_rows(quasi.output_every.saturating_mul(every), quasi.n_steps, done).0
            }
            Analysis::Sweep(_) => n_files.div_ceil(every),
            Analysis::Static | Analysis::Modes(_) => n_files,
        };
        let n_states = match &scene.analysis {
            Analysis::Dynamic(_) => n_of(scene.output.restart_every),
            _ => n_files,
        };
        let every = scene.output.every;
        let fields = n_of(every.stress) * stress + n_of(every.displacement) * displacement;
        let reduction = reduced.map_or(0, |sizes| {
            sizes.file_numbers() as u64 * bytes_of(scene.output.precision)
        });
        let n_balls = model.geometry.n_balls as u64;
        let tables = n_rows * (BALL_CELLS * n_balls + OTHER_CELLS) * CELL_BYTES;
        Forecast {
            step,
            n_files,
            n_states,
            total: once + n_files * others + fields + n_states * state + reduction + tables,
            once,
            n_rows,
            n_balls,
            fewer: fewer(&scene.analysis),
        }
    }

    /// Of bearings that write side by side, with the tables beside their folders, which have so many places of the
    /// shaft: `step` is the mean of their step files.
    pub fn of_all(bearings: &[Forecast], n_places: u64) -> Forecast {
        let sum = |of: fn(&Forecast) -> u64| bearings.iter().map(of).sum::<u64>();
        let (n, n_balls) = (bearings.len() as u64, sum(|own| own.n_balls));
        let n_rows = bearings.iter().map(|own| own.n_rows).max().unwrap_or(0);
        let cells = LIST_BALL_CELLS * n_balls + LIST_BEARING_CELLS * n + PLACE_CELLS * n_places;
        let tables = n_rows * (cells + SHAFT_ENERGY_CELLS) * CELL_BYTES;
        Forecast {
            step: sum(|own| own.step) / n.max(1),
            n_files: sum(|own| own.n_files),
            n_states: sum(|own| own.n_states),
            total: sum(|own| own.total) + tables,
            once: sum(|own| own.once),
            n_rows,
            n_balls,
            fewer: bearings.first().map_or("", |own| own.fewer),
        }
    }

    /// Of so many load cases, each as large as this.
    pub fn times(self, n: u64) -> Forecast {
        Forecast {
            step: self.step,
            n_files: n * self.n_files,
            n_states: n * self.n_states,
            total: n * (self.total - self.once) + self.once,
            n_rows: n * self.n_rows,
            ..self
        }
    }

    /// Says how much a run would write, for people and in the answer of the command.
    pub fn say(&self) {
        answer::add("output_bytes", self.total);
        answer::add("step_files", self.n_files);
        let free = free_bytes(Path::new(".")).map_or(String::new(), |free| {
            format!("; the disk of this folder has {} free", size(free))
        });
        let states = match self.n_states < self.n_files {
            true => format!(" ({} with a restart state)", self.n_states),
            false => String::new(),
        };
        print::line(format_args!(
            "output   about {} per step file, {}{states}, {} in all{free}",
            size(self.step),
            print::counted(self.n_files, "step file"),
            size(self.total)
        ));
    }

    /// Fails when the disk of `dir` has no room for the results, unless told to go on, which leaves a note.
    pub fn require_space(&self, dir: &Path, ignore: bool) -> Result<(), Failure> {
        // A system that does not tell is no reason to stop.
        let Some(free) = free_bytes(dir) else {
            return Ok(());
        };
        if self.total <= free {
            return Ok(());
        }
        let what = format!(
            "the results need about {} ({} of {}), the disk of {} has {} free",
            size(self.total),
            print::counted(self.n_files, "step file"),
            size(self.step),
            dir.display(),
            size(free)
        );
        if ignore {
            print::note(format_args!(
                "warning: {what}; going on because of --ignore-disk-space"
            ));
            return Ok(());
        }
        Err(Failure::User(anyhow!(
            "{what}; {}choose another --out, or pass --ignore-disk-space",
            self.fewer
        )))
    }
}

/// How an analysis would write less.
fn fewer(analysis: &Analysis) -> &'static str {
    match analysis {
        Analysis::Dynamic(_) => "write fewer steps with dynamic.output_every, ",
        Analysis::QuasiStatic(_) => "write fewer steps with quasi_static.output_every, ",
        Analysis::Sweep(_) => "solve some of the points with --points, ",
        Analysis::Static | Analysis::Modes(_) => "",
    }
}

/// Step files and table rows of `n` steps after the first `done`, the start included when nothing is done.
fn files_and_rows(every: u64, n: u64, done: u64) -> (u64, u64) {
    let (start, left) = (u64::from(done == 0), n.saturating_sub(done));
    let files = n / every - done.min(n) / every + u64::from(left > 0 && !n.is_multiple_of(every));
    (start + files, start + left)
}

/// Step files with a restart state after the first `done` steps.
fn n_states(dynamic: &Dynamic, restart_every: u64, done: u64) -> u64 {
    let every = dynamic.output_every.saturating_mul(restart_every);
    files_and_rows(every, dynamic.n_steps, done).0
}

/// Bytes of the file of the mesh: points, cells with their kinds, bodies and radii.
fn mesh_bytes(bodies: &[Body]) -> u64 {
    let points = 8 * VECTOR * rows(bodies, |body| body.points.len());
    let corners = 8 * rows(bodies, |body| body.connectivity.len());
    MESH_FRAME_BYTES + points + corners + (8 + 8 + 1 + 1) * rows(bodies, Body::n_cells)
}

/// Bytes of the forces of both rings on the balls.
fn force_bytes(n_points: u64) -> u64 {
    let (rows, index) = match n_points <= FORCE_CHUNK {
        true => (n_points, 0),
        false => (2 * FORCE_CHUNK, FORCE_INDEX),
    };
    2 * (rows * VECTOR * 8 + index)
}

/// Bytes of a number.
fn bytes_of(precision: FieldPrecision) -> u64 {
    match precision {
        FieldPrecision::F32 => 4,
        FieldPrecision::F64 => 8,
    }
}

/// Sum over bodies.
fn rows(bodies: &[Body], count: impl Fn(&Body) -> usize) -> u64 {
    bodies.iter().map(|body| count(body) as u64).sum()
}

/// Bytes of stress in a step file: a tensor and its von Mises stress per point, or the tensors of the integration
/// points of a cell and the largest of their von Mises stresses.
fn stress_bytes(scene: &Scene, model: &Model, region: Option<&Region>) -> u64 {
    let bodies = fields::bodies(model);
    let kinds = Side::BOTH.into_iter().filter_map(|side| model.ring(side));
    let points = kinds.map(|ring| stiffness_rule(ring.mesh.kind).points.len() as u64);
    let Some(points_per_cell) = points.max() else {
        return 0;
    };
    let numbers = match scene.output.stress {
        StressOutput::None => 0,
        StressOutput::Nodal => rows(&bodies, |body| body.points.len()) * (TENSOR + 1),
        StressOutput::IntegrationPoints => rows(&bodies, Body::n_cells) * (points_per_cell * TENSOR + 1),
    };
    let [of_points, of_cells] = region
        .filter(|region| region.fields().stress)
        .map_or([1.0; 2], Region::shares);
    let share = match scene.output.stress {
        StressOutput::IntegrationPoints => of_cells,
        StressOutput::Nodal | StressOutput::None => of_points,
    };
    let bytes = ((bytes_of(scene.output.precision) * numbers) as f64 * share) as u64;
    match scene.output.stress_error {
        Some(_) => bytes / ROUNDED_GAIN,
        None => bytes,
    }
}

/// Bytes of the displacement in a step file.
fn displacement_bytes(scene: &Scene, n_points: u64, region: Option<&Region>) -> u64 {
    let share = region
        .filter(|region| region.fields().displacement)
        .map_or(1.0, |region| region.shares()[0]);
    ((n_points * VECTOR * bytes_of(scene.output.displacement)) as f64 * share) as u64
}

/// Bytes of the stored state.
fn state_bytes(scene: &Scene, model: &Model) -> u64 {
    match &scene.analysis {
        Analysis::Dynamic(_) => {
            let rings = Side::BOTH.into_iter().filter_map(|side| model.ring(side));
            rings.map(ring_bytes).sum::<u64>() + BALL_BYTES * model.geometry.n_balls as u64
        }
        Analysis::Modes(_) => 3 * 8,
        Analysis::Static | Analysis::Sweep(_) => 8 * (5 + 2 * model.geometry.n_balls as u64),
        Analysis::QuasiStatic(_) => {
            let balls = 2 * model.geometry.n_balls as u64;
            let rings = model.rings.iter().flatten().count() as u64;
            // Displacements and tangents of the contacts, of the step and of that from which the next ones start.
            2 * 8 * (6 + balls + rings * (balls + balls * balls))
        }
    }
}

/// Displacement, velocity and acceleration of the dofs of a ring that can move by themselves.
fn ring_bytes(ring: &RingModel) -> u64 {
    let held = match ring.hold {
        Hold::Clamped => 3 * ring.mesh.group_nodes(ring.held_group).len(),
        Hold::MeanMotion | Hold::Free => 0,
    };
    3 * 8 * (ring.mesh.n_dofs() - held) as u64
}

/// Bytes that a user may still write to the disk of `dir`, or of the folder in which it will be made.
pub fn free_bytes(dir: &Path) -> Option<u64> {
    let dir = std::path::absolute(dir).ok()?;
    let above = dir.ancestors().find(|path| path.exists())?;
    let disk = rustix::fs::statvfs(above).ok()?;
    Some(disk.f_bavail.saturating_mul(disk.f_frsize))
}

/// A number of bytes for people.
pub fn size(bytes: u64) -> String {
    const UNITS: [(f64, &str); 4] = [(1e12, "TB"), (1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
    let bytes = bytes as f64;
    let unit = UNITS.iter().find(|(unit, _)| bytes >= *unit);
    unit.map_or_else(
        || format!("{bytes} bytes"),
        |(unit, name)| format!("{:.2} {name}", bytes / unit),
    )
}
