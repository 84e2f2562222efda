//! A step in time of a bearing of 2 x 57 k dof, part by part, with stress and step file, each beside its floor.
//!
//! The bearing rolls at 1800 rpm under 2 kN and 1 kN with two threads. Steps with and without `frame_rotation` take
//! turns, so that other work on the machine meets both. Floors: the pass that ends a step (`update`) reads the factor
//! of each ring once from memory, a group of harmonics after the other, reads predictor and state and writes both
//! anew; stress reads displacements and writes six components per node; a step file is written and synced. Bandwidth
//! of memory and disk are measured in the same run. Run with `cargo bench -p raceway --bench motion`.
//!
//!     cargo bench -p raceway --bench motion -- [57k] [159k] [410k] [1M] [paper]
//!
//! The names are dofs per ring; without names 57k. With more than one the growth of the cost of a step from the first
//! to the last is printed as an exponent. `paper` rolls 2 x 410 k dofs for a hundredth of a ball's revolution, 77
//! steps of 1e-5 s, each with the stress of all nodes and a step file, and says what the whole would take. Results:
//! docs/dev/performance.md.

#[path = "../crates/dynamics/tests/support/mod.rs"]
mod support;

#[path = "../crates/dynamics/benches/support/clock.rs"]
mod clock;

#[path = "support/rolling.rs"]
mod rolling;

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;

use checkpoint::{Body, CellFields, Output, PointFields, StateArray, StepRecord, Storage};
use clock::{Runs, least_wall};
use contact::Side;
use dynamics::effects::FrameRotation;
use dynamics::kinematics::Speed;
use dynamics::motion::MotionState;
use dynamics::{Backend, ContactMode, Hold, Model, NodalStress};
use fem::stress::von_mises;
use rayon::prelude::*;
use rolling::{DT, Rolling, SPEED};
use support::Case;
use support::rings::Level;
use timer::Stopwatch;

/// Steps of each kind, and step files.
const REPEATS: usize = 12;
/// Rings of hex8 by their dofs: 56 700, 158 760, 410 400 and 1 010 880.
const SIZES: [(&str, Level); 4] = [
    ("57k", Level::hex8(180, 14, 3, 4)),
    ("159k", Level::hex8(360, 14, 3, 6)),
    ("410k", Level::hex8(720, 12, 3, 9)),
    ("1M", Level::hex8(1080, 17, 4, 11)),
];
/// Vectors that a pass reads or writes at least: the predictor and three of the state, before and after.
const UPDATED: usize = 8;
/// Steps of a hundredth of a ball's revolution of 77 ms.
const HUNDREDTH: usize = 77;
fn bearing(level: Level, frame_rotation: bool) -> Model {
    let case = Case {
        radial: 1000.0,
        ..Case::axial(2000.0)
    };
    let mut model = case.flexible(ContactMode::Patch, level, Hold::Clamped);
    // As scenes have it on linear elements.
    model.contact.least_patch.rolling = 0.0;
    if frame_rotation {
        model
            .effects
            .push(Box::new(FrameRotation::new(Speed::constant(SPEED))));
    }
    model
}

/// Stress of both rings at their nodes, Pa, and the file of the step.
struct Writer {
    recoveries: Vec<NodalStress>,
    output: Output,
    centres: Vec<[f64; 3]>,
}

impl Writer {
    fn new(model: &Model, dir: &Path) -> Writer {
        let rings = || model.rings.iter().flatten();
        let mut bodies: Vec<Body> = rings()
            .zip(0..)
            .map(|(ring, id)| {
                Body::from_mesh(
                    ["inner ring", "outer ring"][id as usize],
                    id,
                    &ring.mesh,
                    [0.0; 3],
                )
            })
            .collect();
        let place = model.geometry.ball_centre();
        let centre = |ball: usize| {
            let (sin, cos) = model.geometry.azimuth(ball).sin_cos();
            [place.radial * cos, place.radial * sin, place.axial]
        };
        let centres: Vec<[f64; 3]> = (0..model.geometry.n_balls).map(centre).collect();
        bodies.push(Body::balls(
            "balls",
            2,
            &centres,
            0.5 * model.geometry.ball_diameter,
        ));
        Writer {
            recoveries: rings()
                .map(|ring| NodalStress::new(ring, "ring", Backend::Auto).expect("the mesh is sound"))
                .collect(),
            output: Output::create(dir, &bodies, Storage::default()).expect("an empty folder"),
            centres,
        }
    }

    /// Stress and file of one state; bytes of the file.
    fn write(&mut self, bearing: &Rolling<'_>, step: u64, laps: &mut Runs) -> u64 {
        let state = &bearing.state;
        let fields = Side::BOTH.map(|side| bearing.motion.ring_displacement(state, side).expect("a ring").0);
        let rings: Vec<Vec<[f64; 6]>> = laps.time("stress, both rings", || {
            let jobs = self.recoveries.par_iter().zip(fields.par_iter());
            jobs.map(|(recovery, u)| recovery.nodal(u)).collect()
        });
        let record = self.record(state, &fields, rings, step);
        let path = laps
            .time("step file", || self.output.write_step(&record))
            .expect("the disk has room");
        laps.end_run();
        fs::metadata(path).expect("it was written").len()
    }

    fn record(
        &self,
        state: &MotionState,
        fields: &[Vec<f64>; 2],
        rings: Vec<Vec<[f64; 6]>>,
        step: u64,
    ) -> StepRecord {
        let mut displacement: Vec<[f64; 3]> = fields
            .iter()
            .flat_map(|u| u.chunks_exact(3).map(|u| [u[0], u[1], u[2]]))
            .collect();
        displacement.extend(&self.centres);
        let mut stress = rings.concat();
        stress.resize(displacement.len(), [0.0; 6]);
        let forces = vec![[0.0; 3]; displacement.len()];
        let kinds = ["w", "v", "a"];
        let arrays = state.rings.iter().flatten().zip(["inner", "outer"]);
        let named = arrays.flat_map(|(ring, name)| {
            let vectors = [ring.displacement(), ring.velocity(), ring.acceleration()];
            let values = vectors.map(|x| StateArray::Real(x.to_vec()));
            kinds.map(|kind| format!("{name}_{kind}")).into_iter().zip(values)
        });
        StepRecord {
            step,
            time: step as f64 * DT,
            points: PointFields {
                displacement,
                von_mises: Some(stress.iter().map(|&s| von_mises(s)).collect()),
                stress: Some(stress),
                force_inner: Some(forces.clone()),
                force_outer: Some(forces),
                ..PointFields::default()
            },
            cells: CellFields::default(),
            scene: String::new(),
            tables: None,
            state: named.collect(),
        }
    }
}

/// Bytes per second at which all threads together read an array of `bytes` bytes.
fn read_bandwidth(bytes: usize) -> f64 {
    let array = vec![1.0_f64; bytes / 8];
    let part = array.len().div_ceil(rayon::current_num_threads());
    let seconds = least_wall(10, || {
        array.par_chunks(part).for_each(|part| {
            let mut sums = [0.0; 32];
            for chunk in part.chunks_exact(32) {
                sums.iter_mut().zip(chunk).for_each(|(sum, value)| *sum += value);
            }
            std::hint::black_box(sums);
        });
    });
    bytes as f64 / seconds
}

/// Bytes per second of writing and syncing a file of `bytes` bytes in a folder.
fn disk_bandwidth(dir: &Path, bytes: usize) -> f64 {
    let data = vec![7_u8; bytes];
    let path = dir.join("bandwidth.bin");
    let seconds = least_wall(REPEATS, || {
        let mut file = File::create(&path).expect("the folder can be written");
        file.write_all(&data).expect("the disk has room");
        file.sync_all().expect("the disk can be synced");
    });
    fs::remove_file(&path).expect("it was written");
    bytes as f64 / seconds
}

fn print_floor(name: &str, seconds: f64, bytes: f64, bandwidth: f64) {
    let floor = bytes / bandwidth;
    println!(
        "{name:22} {:8.2} ms, {:6.1} MB at {:5.2} GB/s: floor {:6.2} ms, {:5.1} x",
        1e3 * seconds,
        1e-6 * bytes,
        1e-9 * bandwidth,
        1e3 * floor,
        seconds / floor
    );
}

/// Steps of a bearing part by part, its stress and its step file; processor time of a step, s, and dofs of a ring.
fn measure(name: &str, level: Level) -> (f64, f64) {
    let models = [bearing(level, false), bearing(level, true)];
    let [mut plain, mut turning] = [Rolling::new(&models[0]), Rolling::new(&models[1])];
    for _ in 0..REPEATS {
        plain.step();
        turning.step();
    }
    let n = Side::BOTH.map(|side| plain.motion.n_coordinates(side));
    println!(
        "\n== {name}: {} and {} coordinates, {} threads, factors and tables {:.1} MB",
        n[0],
        n[1],
        rayon::current_num_threads(),
        1e-6 * plain.motion.factor_bytes() as f64
    );
    plain.print("without effects but two forces");
    turning.print("with frame_rotation");
    let dir = tempfile::tempdir().expect("a folder for temporary files");
    let mut writer = Writer::new(&models[0], dir.path());
    let (mut laps, mut file) = (Runs::default(), 0);
    for step in 0..REPEATS {
        file = writer.write(&plain, step as u64, &mut laps);
    }
    println!("\nresults of a step");
    laps.print();
    let nodes: Vec<usize> = models[0]
        .rings
        .iter()
        .flatten()
        .map(|r| r.mesh.n_nodes())
        .collect();
    print_floors(
        &plain,
        &writer,
        &laps,
        (nodes.iter().sum(), file as usize),
        dir.path(),
    );
    let share = |part: [f64; 2]| part[0] / plain.laps.least("step")[0];
    println!(
        "processor time over that of the step without effects: frame_rotation {:.2}, stress {:.2}, file {:.2}",
        share(turning.laps.least("step")),
        share(laps.least("stress, both rings")),
        share(laps.least("step file"))
    );
    (plain.laps.least("step")[0], 3.0 * nodes[0] as f64)
}

/// Pass, stress and file beside the bytes that they cannot do without.
fn print_floors(
    rolling: &Rolling<'_>,
    writer: &Writer,
    laps: &Runs,
    (nodes, file): (usize, usize),
    dir: &Path,
) {
    println!("\nleast times against floors");
    let factor = rolling.motion.factor_bytes();
    let memory = read_bandwidth(factor);
    let update = rolling.laps.least("step/update")[1];
    let coordinates: usize = Side::BOTH
        .map(|side| rolling.motion.n_coordinates(side))
        .iter()
        .sum();
    let vectors = 8 * UPDATED * coordinates;
    print_floor("update", update, (factor + vectors) as f64, memory);
    let weights: usize = writer
        .recoveries
        .iter()
        .filter_map(NodalStress::operator_bytes)
        .sum();
    let stress = laps.least("stress, both rings")[1];
    let bytes = (8 * (3 + 6) * nodes + weights) as f64;
    print_floor("stress, both rings", stress, bytes, memory);
    let disk = disk_bandwidth(dir, file);
    print_floor("step file", laps.least("step file")[1], file as f64, disk);
}

/// A hundredth of a ball's revolution with stress and file of every step.
fn paper() {
    let (name, level) = SIZES[2];
    let model = bearing(level, true);
    let mut rolling = Rolling::new(&model);
    let dir = tempfile::tempdir().expect("a folder for temporary files");
    let mut writer = Writer::new(&model, dir.path());
    let (mut laps, mut file, mut clock) = (Runs::default(), 0, Stopwatch::start());
    for step in 0..HUNDREDTH {
        rolling.step();
        file = writer.write(&rolling, step as u64, &mut laps);
        fs::remove_file(dir.path().join(format!("step_{step:06}.hdf"))).expect("it was written");
    }
    let seconds = clock.lap();
    println!(
        "\n== paper: 2 x {name} dofs, {HUNDREDTH} steps with stress and file of each: {seconds:.1} s, {:.1} ms per \
         step; the revolution of {} steps: {:.0} min, {:.0} GB",
        1e3 * seconds / HUNDREDTH as f64,
        100 * HUNDREDTH,
        100.0 * seconds / 60.0,
        1e-9 * (100 * HUNDREDTH) as f64 * file as f64
    );
    rolling.print("with frame_rotation");
    laps.print();
}

fn main() {
    let wanted: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with("--"))
        .collect();
    let is_wanted = |name: &str| wanted.iter().any(|w| w == name) || (wanted.is_empty() && name == "57k");
    let sizes = SIZES.iter().filter(|(name, _)| is_wanted(name));
    let costs: Vec<(f64, f64)> = sizes.map(|(name, level)| measure(name, *level)).collect();
    if let [first, .., last] = costs.as_slice() {
        println!(
            "\ncost of a step grows with the dofs to the power {:.2}",
            (last.0 / first.0).ln() / (last.1 / first.1).ln()
        );
    }
    if is_wanted("paper") {
        paper();
    }
}
