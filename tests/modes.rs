//! Natural modes through the whole program: table, step files, summary, refusals.

use std::sync::OnceLock;

use crate::util::tables::{keys, number, summary};
use crate::util::{Dir, Files, RIGID, assert_close, with_line};

const MODES: &str = "[modes]\nnumber = 9\nbodies = [\"outer\", \"bearing\"]\nsupport = \"free\"";

/// A folder where the scene was run; once for all tests that look at it.
fn found() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = Dir::with_meshes();
        dir.write("scene.toml", with_line("[static]", "[static]", MODES));
        dir.run("out", &["--set", "shaft.mass=2 kg"]);
        dir.snapshot()
    }))
}

fn rows(dir: &Dir) -> Vec<csv::StringRecord> {
    let mut reader = csv::Reader::from_path(dir.path("out/modes.csv")).unwrap();
    let columns: Vec<String> = reader.headers().unwrap().iter().map(str::to_string).collect();
    assert_eq!(columns[..5], ["step", "body", "mode", "frequency_hz", "bound_hz"]);
    reader.records().map(Result::unwrap).collect()
}

/// If this failed, modes would be missing in the table, the files or the summary, or these would disagree.
#[test]
fn every_mode_has_a_line_a_file_and_a_number_in_the_summary() {
    let dir = found();
    let rows = rows(&dir);
    assert_eq!(rows.len(), 18);
    let summary = summary(&dir, "out");
    assert_eq!(summary["analysis"], "modes");
    assert_eq!(keys(&summary["modes"]), ["bearing", "outer"]);
    for (i, row) in rows.iter().enumerate() {
        assert_eq!(row[0], (i + 1).to_string());
        let body = if i < 9 { "outer" } else { "bearing" };
        assert_eq!(&row[1], body);
        let frequency: f64 = row[3].parse().unwrap();
        let listed = number(&summary, &format!("/modes/{body}/frequency_hz/{}", i % 9));
        assert_eq!(frequency, listed);
        let step =
            checkpoint::read_step(&dir.path(&format!("out/{}", checkpoint::step_file_name(i as u64 + 1))));
        let record = step.unwrap();
        assert_eq!(
            record.state["frequency_hz"],
            checkpoint::StateArray::Real(vec![frequency])
        );
        let size = |u: &[f64; 3]| u.iter().map(|x| x * x).sum::<f64>().sqrt();
        let largest = record.points.displacement.iter().map(size).fold(0.0, f64::max);
        assert_close("largest displacement", largest, 1e-3, 1e-12);
    }
    assert_eq!(
        rows.iter().filter(|row| &row[6] == "1").count(),
        6,
        "rigid motions of the free ring"
    );
}

/// If this failed, the free ring would not be that of the mesh: double modes, the first near the 2376 Hz of a fine
/// mesh.
#[test]
fn the_outer_ring_rings_near_its_known_frequency() {
    let dir = found();
    let frequency: Vec<f64> = rows(&dir).iter().map(|row| row[3].parse().unwrap()).collect();
    assert_close("first mode", frequency[6], 2376.0, 1e-2);
    assert_close("double mode", frequency[6], frequency[7], 1e-8);
}

/// If this failed, rigid rings would have no modes, or a scene with fewer modes than asked for would not say so.
#[test]
fn a_bearing_with_rigid_rings_has_two_modes_per_ball_and_those_of_its_shaft() {
    let dir = Dir::with_scene(&with_line("[static]", "[static]", "[modes]\nnumber = 60"));
    let arguments = [&RIGID[..], &["--set", "shaft.mass=2 kg"]].concat();
    let outcome = dir.run("out", &arguments);
    assert_eq!(rows(&dir).len(), 39, "36 of the balls, x, y and z of the shaft");
    assert!(
        outcome.stdout.contains("bearing: it has only 39 modes, not 60"),
        "{}",
        outcome.stdout
    );
    modes_are_not_resumed(&dir);
}

/// Wrong: `resume` would look for a scene file, which modes do not need.
pub fn modes_are_not_resumed(dir: &Dir) {
    let outcome = dir.raceway(&["resume", "out"]);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    let expected = "out holds results of a [modes] scene; only a run over time";
    assert!(outcome.stderr.contains(expected), "{}", outcome.stderr);
    // One that was killed has no summary.
    std::fs::rename(dir.path("out/summary.json"), dir.path("summary.json")).unwrap();
    let outcome = dir.raceway(&["resume", "out"]);
    assert!(outcome.stderr.contains(expected), "{}", outcome.stderr);
    std::fs::rename(dir.path("summary.json"), dir.path("out/summary.json")).unwrap();
}

/// If this failed, a check would not say what is computed.
#[test]
fn a_check_names_the_bodies() {
    let dir = Dir::with_meshes();
    dir.write("scene.toml", with_line("[static]", "[static]", MODES));
    let outcome = dir.raceway(&["check", "scene.toml"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let expected = "analysis modes, the 9 lowest of each: outer ring alone, free, bearing";
    assert!(outcome.stdout.contains(expected), "{}", outcome.stdout);
}

/// If this failed, modes of a turning bearing would be given without their gyroscopic part.
#[test]
fn a_speed_is_refused() {
    let dir = Dir::with_meshes();
    let table = format!("{MODES}\n[speed]\ninner = \"1800 rpm\"");
    dir.write("scene.toml", with_line("[static]", "[static]", &table));
    let outcome = dir.raceway(&["run", "scene.toml", "--out", "out"]);
    assert_eq!(outcome.code, Some(2));
    assert!(
        outcome
            .stderr
            .contains("[modes] are those of a bearing that does not turn"),
        "{}",
        outcome.stderr
    );
    assert!(!dir.path("out").exists());
}

/// Wrong: a scene that asks for sectors would be solved as a whole without a word, on one core of many.
#[test]
fn modes_refuse_sectors() {
    let dir = Dir::with_meshes();
    dir.write("scene.toml", with_line("[static]", "[static]", MODES));
    for command in [
        &["check", "scene.toml"][..],
        &["run", "scene.toml", "--out", "out"],
    ] {
        let outcome = dir.raceway(&[command, &["--set", "solver.backend=sector"]].concat());
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        let text = "solver.backend is \"sector\", but the search for modes has no sectors";
        assert!(outcome.stderr.contains(text), "{}", outcome.stderr);
    }
    assert!(!dir.path("out").exists());
}
