//! VTK and ParaView read the results, and the scripts of `scripts/paraview` make their pictures.
//!
//! Both are optional: where they are not installed, these tests say so and pass. `RACEWAY_TEST_PYTHON` names a Python
//! that has the package `vtk` (9.3 or later), default python3; ParaView's pvpython and xvfb-run must be on the path.

mod known_stress;

use std::io::Write;
use std::path::Path;
use std::process::Command;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use checkpoint::{committed_steps, read_any_step, read_mesh, read_step, step_file_name};
use serde_json::Value;

use crate::util::lockstep::small_motion;
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
        let small = [
            "--set",
            "output.displacement=f32",
            "--set",
            "output.stress_error=10 kPa",
            "--set",
            "output.restart_every=3",
        ];
        dir.run("small", &[&short[..], &small[..]].concat());
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

/// A Python that has VTK, if there is one.
pub fn python() -> Option<String> {
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

/// ParaView, if there is one, for one test at a time: two that look for a free screen at once may take the same.
fn paraview() -> Option<MutexGuard<'static, ()>> {
    static ALONE: Mutex<()> = Mutex::new(());
    if runs("pvpython", &["--version"]) && runs("xvfb-run", &["--help"]) {
        return Some(ALONE.lock().unwrap_or_else(PoisonError::into_inner));
    }
    skipped("no pvpython or no xvfb-run");
    None
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
        let stress = record.points.stress.as_ref().unwrap()[node];
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
        let points = &record.points;
        assert_eq!(seen["displacement"], serde_json::json!(points.displacement[node]));
        let forces = [&points.force_inner, &points.force_outer].map(|force| loaded(force.as_ref().unwrap()));
        assert!(!forces[0].is_empty(), "balls are loaded");
        assert_eq!(seen["forces"], serde_json::json!(forces), "step {step}");
    }
}

/// Points with a force, and the force.
fn loaded(force: &[[f64; 3]]) -> Vec<(usize, f64, f64, f64)> {
    let rows = force
        .iter()
        .enumerate()
        .filter(|(_, row)| row.iter().any(|f| *f != 0.0));
    rows.map(|(i, [x, y, z])| (i, *x, *y, *z)).collect()
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

/// Wrong: readers without plug-ins would not see files that hold less, or other values than this program.
#[test]
fn vtk_reads_small_files() {
    let Some(python) = python() else { return };
    let dir = moved();
    let folder = dir.path("small");
    let (node, steps) = (loaded_node(&folder), committed_steps(&folder).unwrap());
    for (name, steps) in [("run.vtkhdf", &steps[..]), ("step_000004.hdf", &[4])] {
        let path = folder.join(name);
        let arguments = [&reader(), "vtk", path.to_str().unwrap(), &node.to_string()];
        compare(
            &output_of(Command::new(&python).args(arguments)),
            &folder,
            steps,
            node,
        );
    }
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

/// Wrong: ParaView would read other times, points, cells or stresses than were written.
#[test]
fn paraview_reads_every_step() {
    let Some(_alone) = paraview() else { return };
    let dir = moved();
    for out in ["out", "small"] {
        let folder = dir.path(out);
        let node = loaded_node(&folder);
        let outcome = dir.raceway(&["export", out, "--to", "vtu"]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let steps = committed_steps(&folder).unwrap();
        for name in ["run.hdf.series", "export/run.pvd"] {
            let path = folder.join(name);
            let arguments = [&reader(), "paraview", path.to_str().unwrap(), &node.to_string()];
            let text = output_of(Command::new("xvfb-run").args(SCREEN).args(arguments));
            compare(&text, &folder, &steps, node);
        }
    }
}

/// Wrong: a script would fail, make no picture, or an empty one; or it would not say what is wrong with its input.
#[test]
fn the_scripts_make_their_pictures() {
    let Some(_alone) = paraview() else { return };
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
