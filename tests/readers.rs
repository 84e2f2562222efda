//! VTK and ParaView read the results, and the scripts of `scripts/paraview` make their pictures.
//!
//! Both are optional: where they are not installed, these tests say so and pass. `RACEWAY_TEST_PYTHON` names a Python
//! that has the package `vtk` (9.3 or later), default python3; ParaView's pvpython and xvfb-run must be on the path.

use std::io::Write;
use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;

use checkpoint::{
    Body, CellFields, IntegrationPointStress, Output, PointFields, Precision, StepRecord, Storage,
    committed_steps, read_any_step, read_mesh, read_step, step_file_name,
};
use fem::{Material, StressRecovery, von_mises};
use mesh::{Mesh, RingSide};
use serde_json::Value;

use crate::util::lockstep::small_motion;
use crate::util::rings::{TINY, ring};
use crate::util::{Dir, Files};

/// A folder with ten steps of the small motion, every second written.
fn moved() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = small_motion();
        let short = [
            "--set",
            "dynamic.duration=0.2 ms",
            "--set",
            "dynamic.output_every=2",
        ];
        dir.run("out", &short);
        dir.snapshot()
    }))
}

fn runs(program: &str, arguments: &[&str]) -> bool {
    Command::new(program)
        .args(arguments)
        .output()
        .is_ok_and(|output| output.status.success())
}

/// Says so even though the test passes: what is printed in other ways is hidden then.
fn skipped(why: &str) {
    let text = format!("SKIPPED, readers are not tested: {why}\n");
    std::io::stderr().write_all(text.as_bytes()).unwrap();
}

fn python() -> Option<String> {
    let python = std::env::var("RACEWAY_TEST_PYTHON").unwrap_or("python3".to_string());
    if runs(
        &python,
        &["-c", "import vtk; assert hasattr(vtk, 'vtkHDFReader')"],
    ) {
        return Some(python);
    }
    skipped(&format!("{python} has no package vtk"));
    None
}

/// A screen of its own for ParaView, which else needs one.
const SCREEN: [&str; 5] = [
    "-a",
    "-s",
    "-screen 0 1600x1200x24 -noreset",
    "pvpython",
    "--force-offscreen-rendering",
];

fn has_paraview() -> bool {
    let found = runs("pvpython", &["--version"]) && runs("xvfb-run", &["--help"]);
    if !found {
        skipped("no pvpython or no xvfb-run");
    }
    found
}

/// The node whose stress is compared: the one with the largest von Mises stress of the last step.
fn loaded_node(folder: &Path) -> usize {
    let last = *committed_steps(folder).unwrap().last().unwrap();
    let stress = read_step(&folder.join(step_file_name(last)))
        .unwrap()
        .points
        .von_mises
        .unwrap();
    (0..stress.len())
        .max_by(|a, b| stress[*a].total_cmp(&stress[*b]))
        .unwrap()
}

/// Compares what a reader saw with the step files; `steps` are those it should have seen.
#[track_caller]
fn compare(text: &str, folder: &Path, steps: &[u64], node: usize) {
    let line = text.lines().find_map(|line| line.strip_prefix("seen "));
    let seen: Vec<Value> =
        serde_json::from_str(line.unwrap_or_else(|| panic!("nothing seen: {text}"))).unwrap();
    assert_eq!(seen.len(), steps.len(), "{text}");
    let grid = read_mesh(folder).unwrap();
    for (seen, &step) in seen.iter().zip(steps) {
        let record = read_any_step(folder, step).unwrap();
        if !seen["time"].is_null() {
            assert_eq!(seen["time"], record.time);
        }
        assert_eq!(seen["points"], grid.points.len());
        assert_eq!(seen["cells"], grid.types.len());
        assert_eq!(seen["bodies"], serde_json::json!([0, 1, 2]));
        let stress = record.points.stress.unwrap()[node];
        assert!(
            stress.iter().any(|s| s.abs() > 1e6),
            "the node is loaded: {stress:?}"
        );
        let read: Vec<f64> = seen["stress"]
            .as_array()
            .unwrap()
            .iter()
            .map(|s| s.as_f64().unwrap())
            .collect();
        assert_eq!(read, stress, "step {step}");
    }
}

fn output_of(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let (stdout, stderr) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    assert!(output.status.success(), "{command:?}: {stdout}{stderr}");
    stdout.into_owned()
}

fn reader() -> String {
    format!("{}/tests/readers/read_steps.py", env!("CARGO_MANIFEST_DIR"))
}

/// Wrong: VTK would read other times, points, cells or stresses than were written.
#[test]
fn vtk_reads_every_step() {
    let Some(python) = python() else { return };
    let dir = moved();
    let folder = dir.path("out");
    let node = loaded_node(&folder);
    let read = |file: &Path| {
        output_of(Command::new(&python).args([&reader(), "vtk", file.to_str().unwrap(), &node.to_string()]))
    };
    let steps = committed_steps(&folder).unwrap();
    compare(&read(&folder.join("run.vtkhdf")), &folder, &steps, node);
    compare(&read(&folder.join("step_000004.hdf")), &folder, &[4], node);
    let outcome = dir.raceway(&["pack", "out", "--keep", "2", "--per-file", "3"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    compare(&read(&folder.join("run.vtkhdf")), &folder, &steps, node);
    assert_eq!(dir.raceway(&["pack", "out", "--undo"]).code, Some(0));
    let outcome = dir.raceway(&["export", "out", "--to", "vtu", "--steps", "4"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    compare(&read(&folder.join("export/step_000004.vtu")), &folder, &[4], node);
}

/// Displacement gradient of the known state: strain xx 1e-3, yy -2e-4, zz 3e-4, engineering shear xy 4e-4, yz -1e-4,
/// xz 2e-4, and rotations besides, which must not matter.
const KNOWN_GRADIENT: [[f64; 3]; 3] = [[1e-3, 3e-4, 5e-5], [1e-4, -2e-4, -2e-4], [1.5e-4, 1e-4, 3e-4]];
/// Its stress by Hooke's law by hand, MPa: with E = 200 GPa and Poisson's ratio 1/4, lambda = mu = 80 GPa, trace 1.1e-3:
/// xx = 88 + 160, yy = 88 - 32, zz = 88 + 48; xy = 80e3 4e-4 and so on.
const KNOWN_STRESS: [f64; 6] = [248.0, 56.0, 136.0, 32.0, -8.0, 16.0];
/// Square of its von Mises stress, MPa^2: (192^2 + 80^2 + 112^2)/2 + 3 (32^2 + 8^2 + 16^2).
const KNOWN_VON_MISES_SQUARED: f64 = 31936.0;

/// A folder `out` with two steps of two rings, the second strained twice as much, stress recovered by the program's own
/// finite elements and written at nodes and at integration points.
fn known_strain() -> Dir {
    let dir = Dir::empty();
    let rings = [RingSide::Inner, RingSide::Outer].map(|side| ring(side, TINY));
    let bodies = [
        Body::from_mesh("inner ring", 0, &rings[0], [0.0; 3]),
        Body::from_mesh("outer ring", 1, &rings[1], [0.0; 3]),
        Body::balls("balls", 2, &[[33e-3, 0.0, 0.0], [0.0, 33e-3, 0.0]], 4.5e-3),
    ];
    let storage = Storage {
        stress: Precision::F64,
        ..Storage::default()
    };
    let mut output = Output::create(&dir.path("out"), &bodies, storage).unwrap();
    for step in [1, 2] {
        output.write_step(&strained(&rings, step)).unwrap();
    }
    output.finish().unwrap();
    dir
}

fn strained(rings: &[Mesh; 2], step: u64) -> StepRecord {
    let material = Material::new(200e9, 0.25, 7800.0).unwrap();
    let (mut displacement, mut nodal, mut values) = (Vec::new(), Vec::new(), Vec::new());
    for ring in rings {
        let moved = |x: &[f64; 3]| {
            KNOWN_GRADIENT.map(|row| step as f64 * (row[0] * x[0] + row[1] * x[1] + row[2] * x[2]))
        };
        let u: Vec<[f64; 3]> = ring.nodes.iter().map(moved).collect();
        let recovery = StressRecovery::new(ring, &material).unwrap();
        nodal.extend(recovery.nodal(u.as_flattened()));
        values.extend(recovery.integration_points(u.as_flattened()).into_flattened());
        displacement.extend(u);
    }
    displacement.extend([[0.0; 3]; 2]);
    nodal.extend([[0.0; 6]; 2]);
    values.extend([0.0; 2 * 48]);
    StepRecord {
        step,
        time: 1e-5 * step as f64,
        points: PointFields {
            displacement,
            von_mises: Some(nodal.iter().map(|&s| von_mises(s)).collect()),
            stress: Some(nodal),
            ..PointFields::default()
        },
        cells: CellFields {
            stress_integration_points: Some(IntegrationPointStress {
                points_per_cell: 8,
                values,
                layout: "eight points, xx yy zz xy yz xz".to_string(),
            }),
            von_mises_largest: None,
        },
        scene: String::new(),
        ..StepRecord::default()
    }
}

/// Compares tensors with the known one, times the number of the step.
#[track_caller]
fn assert_known(found: &[f64], step: u64) {
    assert!(!found.is_empty() && found.len().is_multiple_of(6));
    for (i, &value) in found.iter().enumerate() {
        let expected = 1e6 * step as f64 * KNOWN_STRESS[i % 6];
        // Round-off of a strain of 1e-3 of places of 40 mm in elements of 1 mm.
        assert!(
            (value - expected).abs() < 1e-9 * 248e6,
            "component {}: {value} Pa, by hand {expected} Pa",
            i % 6
        );
    }
}

/// Wrong: the stress in a file would not be that of the strain, by hand, at every node and integration point.
#[test]
fn a_stress_known_by_hand_is_read_back() {
    let dir = known_strain();
    for step in [1, 2] {
        let record = read_step(&dir.path(&format!("out/{}", step_file_name(step)))).unwrap();
        let stress = record.points.stress.unwrap();
        let (rings, balls) = stress.split_at(stress.len() - 2);
        assert_known(rings.as_flattened(), step);
        assert_eq!(balls, [[0.0; 6]; 2]);
        let points = record.cells.stress_integration_points.unwrap().values;
        assert_known(&points[..points.len() - 2 * 48], step);
        let von_mises = record.points.von_mises.unwrap()[0] / (1e6 * step as f64);
        assert!((von_mises.powi(2) / KNOWN_VON_MISES_SQUARED - 1.0).abs() < 1e-9);
    }
}

/// Fails unless a reader saw the known stress at a node and in the first cell of both steps.
#[track_caller]
fn assert_known_seen(text: &str, steps: &[u64]) {
    let line = text.lines().find_map(|line| line.strip_prefix("seen "));
    let seen: Vec<Value> =
        serde_json::from_str(line.unwrap_or_else(|| panic!("nothing seen: {text}"))).unwrap();
    assert_eq!(seen.len(), steps.len(), "{text}");
    for (seen, &step) in seen.iter().zip(steps) {
        for (name, n) in [("stress", 6), ("first_cell", 48)] {
            let numbers: Vec<f64> = serde_json::from_value(seen[name].clone()).unwrap();
            assert_eq!(numbers.len(), n, "{name}: {text}");
            assert_known(&numbers, step);
        }
    }
}

/// Wrong: VTK would show another stress than the one known by hand, at a node or at the integration points of a cell, in
/// a step, in the view of all steps, packed or not, or in what is exported.
#[test]
fn vtk_reads_the_stress_known_by_hand() {
    let Some(python) = python() else { return };
    let dir = known_strain();
    let read = |file: &str| {
        let path = dir.path(file);
        output_of(Command::new(&python).args([&reader(), "vtk", path.to_str().unwrap(), "17"]))
    };
    assert_known_seen(&read("out/step_000002.hdf"), &[2]);
    assert_known_seen(&read("out/run.vtkhdf"), &[1, 2]);
    let outcome = dir.raceway(&["export", "out", "--to", "vtu"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert_known_seen(&read("out/export/step_000001.vtu"), &[1]);
    let outcome = dir.raceway(&["pack", "out", "--keep", "1"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert_known_seen(&read("out/run.vtkhdf"), &[1, 2]);
}

/// Wrong: ParaView would show another stress than the one known by hand.
#[test]
fn paraview_reads_the_stress_known_by_hand() {
    if !has_paraview() {
        return;
    }
    let dir = known_strain();
    let path = dir.path("out/run.hdf.series");
    let arguments = [&reader(), "paraview", path.to_str().unwrap(), "17"];
    assert_known_seen(
        &output_of(Command::new("xvfb-run").args(SCREEN).args(arguments)),
        &[1, 2],
    );
}

/// Wrong: ParaView would read other times, points, cells or stresses than were written.
#[test]
fn paraview_reads_every_step() {
    if !has_paraview() {
        return;
    }
    let dir = moved();
    let folder = dir.path("out");
    let node = loaded_node(&folder);
    let outcome = dir.raceway(&["export", "out", "--to", "vtu"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let steps = committed_steps(&folder).unwrap();
    for name in ["run.hdf.series", "export/run.pvd"] {
        let path = folder.join(name);
        let arguments = [&reader(), "paraview", path.to_str().unwrap(), &node.to_string()];
        let text = output_of(Command::new("xvfb-run").args(SCREEN).args(arguments));
        compare(&text, &folder, &steps, node);
    }
}

/// Wrong: a script would fail, make no picture, or an empty one; or it would not say what is wrong with its input.
#[test]
fn the_scripts_make_their_pictures() {
    if !has_paraview() {
        return;
    }
    let dir = moved();
    let run = |name: &str, arguments: &[&str]| {
        let script = format!("{}/scripts/paraview/{name}", env!("CARGO_MANIFEST_DIR"));
        let mut command = Command::new("xvfb-run");
        command
            .args(SCREEN)
            .arg(script)
            .args(arguments)
            .current_dir(dir.path("."));
        command
    };
    let small = ["--size", "400x300"];
    let pictures = [
        ("render_rings.py", "rings.png", &["--cut", "raceways"][..]),
        ("render_contacts.py", "contacts.png", &["--step", "4"]),
        ("render_section.py", "section.png", &["--azimuth", "20"]),
        ("plot_probe.py", "probe.png", &["--at", "37", "0", "0"]),
    ];
    for (name, picture, more) in pictures {
        let text = output_of(&mut run(name, &[&["out", picture], &small[..], more].concat()));
        assert!(text.contains(&format!("{picture}: ")), "{name}: {text}");
        assert_not_empty(&dir.path(picture));
    }
    let frames = [&["out", "frames", "--steps", "2..6"], &small[..]].concat();
    output_of(&mut run("render_passing.py", &frames));
    for i in 0..3 {
        assert_not_empty(&dir.path(&format!("frames/frame_{i:04}.png")));
    }
    assert!(
        !dir.path("frames/frame_0003.png").exists(),
        "steps 2, 4 and 6 only"
    );
    // The table of the probe has the stress that was written.
    let table = dir.text("probe.csv");
    let row: Vec<f64> = table
        .lines()
        .nth(3)
        .unwrap()
        .split(',')
        .map(|cell| cell.parse().unwrap())
        .collect();
    let stress = read_step(&dir.path("out/step_000004.hdf"))
        .unwrap()
        .points
        .stress
        .unwrap();
    assert_eq!(row[0], 4.0);
    assert!(
        stress.iter().any(|s| s[..] == row[2..8]),
        "{row:?} is the stress of no node"
    );
    let refused = run("render_section.py", &["nowhere", "x.png"]).output().unwrap();
    let text = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2), "{text}");
    assert!(text.contains("run.hdf.series not found"), "{text}");
}

/// A picture of one colour compresses to next to nothing.
#[track_caller]
fn assert_not_empty(path: &Path) {
    let size = std::fs::metadata(path)
        .unwrap_or_else(|e| panic!("{}: {e}", path.display()))
        .len();
    assert!(size > 4000, "{} has {size} bytes only", path.display());
}
