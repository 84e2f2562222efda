//! Motion through the whole program: histories, step files, the energy ledger and its alarm.

use std::sync::OnceLock;

use crate::util::lockstep::{assert_same_run, small_motion};
use crate::util::tables::{Table, summary};
use crate::util::{Dir, Files, RIGID, with_line};

/// Steps of the tests' scene: enough to show the layout and the ledger.
const DYNAMIC: &str =
    "[dynamic]\nduration = \"0.2 ms\"\nstep = \"20 us\"\noutput_every = 5\n\n[speed]\ninner = \"1800 rpm\"";

/// A folder where the scene was run; once for all tests that look at it.
fn moved() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = Dir::with_meshes();
        dir.write("scene.toml", with_line("[static]", "[static]", DYNAMIC));
        dir.run("out", &[]);
        dir.snapshot()
    }))
}

/// If this failed, the inertia of an elastic part would be left out without a word, by the end of a run instead of its
/// speeds, or otherwise on another number of threads and after a resume.
#[test]
fn a_log_says_what_is_left_out_of_a_turning_ring() {
    let dir = small_motion();
    let run = |out: &str, sets: &[&str]| {
        let sets = sets.iter().flat_map(|set| ["--set", set]).collect::<Vec<&str>>();
        dir.run(
            out,
            &[&sets[..], &["--set", "effects.frame_rotation={}"]].concat(),
        )
        .stderr
    };
    let slow = "speed.inner=1800 rpm";
    let left_out = "inner ring: the inertia of its elastic part is left out in its turning frame: at most ";
    let said = run("whole", &[slow]);
    assert!(
        said.contains(left_out) && said.contains("negligible = 1e-6"),
        "{said}"
    );
    let to_come = "speed.inner={ times = [\"0 s\", \"1 s\"], values = [\"1800 rpm\", \"12000 rpm\"] }";
    for (out, speed) in [("fast", "speed.inner=12000 rpm"), ("to_come", to_come)] {
        assert!(!run(out, &[speed]).contains(left_out), "{out}");
    }
    let cut = dir.run(
        "cut",
        &[
            "--threads",
            "2",
            "--set",
            slow,
            "--set",
            "effects.frame_rotation={}",
            "--set",
            "dynamic.duration=0.2 ms",
        ],
    );
    assert!(cut.stderr.contains(left_out));
    let outcome = dir.raceway(&[
        "resume",
        "cut",
        "--stored-scene",
        "--set",
        "dynamic.duration=0.4 ms",
    ]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(outcome.stderr.contains(left_out), "{}", outcome.stderr);
    assert_same_run(&dir, "whole", "cut");
}

/// If this failed, a history would miss steps, or step files would not be those asked for.
#[test]
fn every_step_is_in_the_tables_and_every_fifth_has_a_file() {
    let dir = moved();
    for (name, rows) in [("balls.csv", 18), ("shaft.csv", 1), ("energy.csv", 1)] {
        let table = Table::read(&dir, &format!("out/{name}"));
        assert_eq!(table.rows.len(), 11 * rows, "{name}: the start and ten steps");
        assert_eq!(table.columns[..2], ["step", "time_s"], "{name}");
        assert_eq!(table.step(10).column("time_s")[0], 10.0 * 20e-6, "{name}");
    }
    let files: Vec<String> = dir
        .snapshot()
        .into_keys()
        .map(|path| path.display().to_string())
        .collect();
    let steps: Vec<&String> = files.iter().filter(|name| name.contains("step_")).collect();
    assert_eq!(steps.len(), 3, "steps 0, 5 and 10: {steps:?}");
}

/// If this failed, energy would appear or vanish without a line in the ledger.
#[test]
fn the_ledger_of_a_run_closes() {
    let table = Table::read(&moved(), "out/energy.csv");
    let (total, defect) = (table.column("total_j"), table.column("defect_j"));
    for (t, d) in total.iter().zip(&defect) {
        assert!(d.abs() < 1e-9 * t, "{d} of {t}");
    }
}

/// If this failed, the balls would not roll, or the summary would not be that of the last step.
#[test]
fn balls_roll_with_the_cage() {
    let dir = moved();
    let azimuth = Table::read(&dir, "out/balls.csv").step(10).column("azimuth_rad")[0];
    // Cage speed 0.4331 of 1800 rpm (7010C, pure rolling): to the digits of that ratio.
    let expected = 0.4331 * 1800.0 * std::f64::consts::PI / 30.0 * 0.2e-3;
    let start = Table::read(&dir, "out/balls.csv").step(0).column("azimuth_rad")[0];
    assert!(
        (azimuth - start - expected).abs() < 1e-5,
        "{azimuth} {start} {expected}"
    );
    let summary = summary(&dir, "out");
    assert_eq!(summary["analysis"], "dynamic");
    assert_eq!(summary["balls"][0]["azimuth_rad"].as_f64().unwrap(), azimuth);
}

/// If this failed, a run whose energy is wrong would be taken for a result. Pointwise contacts keep no energy.
#[test]
fn a_ledger_that_does_not_close_stops_the_run() {
    let dir = Dir::with_meshes();
    dir.write("scene.toml", with_line("[static]", "[static]", DYNAMIC));
    let outcome = dir.raceway(&[
        "run",
        "scene.toml",
        "--out",
        "out",
        "--set",
        "dynamic.ledger_tolerance=1e-14",
        "--set",
        "dynamic.contact=pointwise",
    ]);
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    assert!(
        outcome
            .stderr
            .contains("the energy ledger does not close at step "),
        "{}",
        outcome.stderr
    );
    let status = summary(&dir, "out")["status"].as_str().unwrap().to_string();
    assert!(status.starts_with("failed: the energy ledger"), "{status}");
    assert!(
        outcome.stderr.contains("dynamic.ledger_tolerance is 1.0e-14"),
        "{}",
        outcome.stderr
    );
    // The tables have the step that was rejected, the newest step file is the one before: resuming comes to the same
    // end.
    let energy = dir.text("out/energy.csv");
    let rejected: u64 = energy
        .lines()
        .last()
        .unwrap()
        .split(',')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    let step_file = |step: u64| dir.path(&format!("out/step_{step:06}.hdf")).exists();
    assert!(step_file(rejected - 1) && !step_file(rejected), "step {rejected}");
    let again = dir.raceway(&["resume", "out"]);
    assert_eq!(again.code, Some(3), "{}", again.stderr);
    assert!(
        again.stderr.contains("the energy ledger does not close"),
        "{}",
        again.stderr
    );
    assert!(!step_file(rejected), "the rejected step was stored");
    assert_eq!(dir.text("out/energy.csv"), energy);
}

/// If this failed, histories would depend on the number of threads.
#[test]
fn one_and_two_threads_write_the_same_histories() {
    let dir = moved();
    dir.run("one", &["--threads", "1"]);
    for name in ["balls.csv", "shaft.csv", "energy.csv", "step_000010.hdf"] {
        let read = |folder: &str| std::fs::read(dir.path(&format!("{folder}/{name}"))).unwrap();
        assert!(read("one") == read("out"), "{name} differs");
    }
}

/// Wrong: nobody would say that a fast motion under a load across swings for its start, or it would be said of thrust,
/// of slow balls, or of a start that has their velocities.
#[test]
fn a_start_that_swings_is_told() {
    let dir = Dir::with_scene(&with_line("[static]", "[static]", DYNAMIC));
    let told = |across: &str, speed: &str, start: &str| {
        let across = format!("effects.radial_force.value={across}");
        let sets = [
            &across,
            speed,
            "effects.radial_force.direction=0 deg",
            "shaft.mass=0.5 kg",
            start,
        ];
        let sets = sets
            .into_iter()
            .filter(|set| !set.is_empty())
            .flat_map(|set| ["--set", set]);
        let arguments: Vec<&str> = ["check", "scene.toml"]
            .into_iter()
            .chain(RIGID)
            .chain(sets)
            .collect();
        let outcome = dir.raceway(&arguments);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let advice = "[dynamic.start.rolling] is off, but balls that start at rest in their planes make what is free \
                      swing by about";
        outcome.stdout.contains(advice)
    };
    let fast = "speed.inner=40000 rpm";
    assert!(told("500 N", fast, ""));
    assert!(!told("500 N", fast, "dynamic.start.rolling={}"));
    assert!(!told("0 N", fast, ""));
    assert!(!told("500 N", "speed.inner=1000 rpm", ""));
    // Grooves without play: balls that no contact angle holds along the axis are held by their load.
    let play = "bearing.outer_raceway_diameter=74.01 mm";
    assert!(!told("500 N", "speed.inner=1000 rpm", play));
}
