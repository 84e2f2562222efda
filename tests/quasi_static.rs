//! Quasi-static runs through the whole program: instants, files, spin, costs, and runs that end early.

use std::sync::OnceLock;

use crate::util::tables::{Table, number, summary};
use crate::util::{Dir, Files, assert_close, with_line};

/// Steps of the tests' scene.
const QUASI: &str = "[quasi_static]\nduration = \"1 ms\"\nstep = \"0.25 ms\"\noutput_every = 3\n\n[speed]\n\
                     inner = \"1800 rpm\"\n\n[effects.gravity]\nacceleration = \"9.81 m/s2\"\ndirection = [0, -1, 0]";

/// A folder where the scene was run; once for all tests that look at it.
fn turned() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = Dir::with_meshes();
        dir.write("scene.toml", with_line("[static]", "[static]", QUASI));
        let outcome = dir.run("out", &[]);
        dir.write("log", outcome.stdout);
        dir.snapshot()
    }))
}

/// If this failed, instants would be missing from the tables, or step files would not be those asked for.
#[test]
fn every_instant_is_in_the_tables_and_every_third_has_a_file() {
    let dir = turned();
    for (name, rows) in [("balls.csv", 18), ("shaft.csv", 1), ("energy.csv", 1)] {
        let table = Table::read(&dir, &format!("out/{name}"));
        assert_eq!(table.rows.len(), 5 * rows, "{name}: the start and four steps");
        assert_eq!(table.step(4).column("time_s")[0], 4.0 * 0.25e-3, "{name}");
    }
    for (step, is_there) in [(0, true), (1, false), (3, true), (4, true)] {
        let path = dir.path(&format!("out/step_{step:06}.hdf"));
        assert_eq!(path.is_file(), is_there, "{}", path.display());
    }
    let summary = summary(&dir, "out");
    assert_eq!(summary["analysis"], "quasi_static");
    assert_eq!(number(&summary, "/iterations/steps"), 4.0);
    assert!(!dir.path("out/probes.csv").exists(), "no probes were asked for");
}

/// If this failed, an instant of a turning bearing would not be in equilibrium: the work of all forces through the
/// displacements is complete, and every ball carries what its inner ring gives it.
#[test]
fn every_instant_is_in_equilibrium() {
    let dir = turned();
    let energy = Table::read(&dir, "out/energy.csv");
    for (defect, total) in energy.column("defect_j").iter().zip(energy.column("total_j")) {
        assert!(defect.abs() < 1e-9 * total.abs(), "{defect} of {total}");
    }
    let balls = Table::read(&dir, "out/balls.csv");
    let forces = balls
        .column("inner_force_n")
        .into_iter()
        .zip(balls.column("outer_force_n"));
    for (inner, outer) in forces {
        // They differ by the weight of the ball, 0.03 N.
        assert!((inner - outer).abs() < 0.05, "{inner} {outer}");
    }
}

/// If this failed, the balls would not roll, or their spin would not be Harris' n_R = n_i D_m / (2 D_w) (1 - gamma^2).
#[test]
fn balls_roll_and_spin() {
    let dir = turned();
    let table = Table::read(&dir, "out/balls.csv");
    let at = |step: usize| table.step(step).column("azimuth_rad");
    let speed = 1800.0 * std::f64::consts::PI / 30.0;
    let moved = at(4)[0] - at(0)[0];
    // Cage speed 0.4331 of the inner ring's (7010C, pure rolling), to the digits of that ratio.
    assert_close("cage angle", moved, 0.4331 * speed * 1e-3, 1e-4);
    let (ball, pitch) = (9.0, 0.5 * (56.01 + 74.037));
    let cosine: f64 = 1.0 - 0.027 / 0.8;
    let gamma = ball / pitch * cosine;
    let spin = speed * pitch / (2.0 * ball) * (1.0 - gamma * gamma);
    // The pitch circle of the groove centres is that of the raceways to 1e-3.
    for found in table.column("spin_rad_per_s") {
        assert_close("spin", found, spin, 1e-3);
    }
    let summary = summary(&dir, "out");
    assert_close(
        "spin",
        number(&summary, "/balls/5/spin_rad_per_s"),
        table.column("spin_rad_per_s")[0],
        0.0,
    );
}

/// If this failed, nobody could tell which effects a run had, or what they cost.
#[test]
fn the_log_and_the_summary_name_effects_and_their_costs() {
    let dir = turned();
    let log = dir.text("log");
    let line = log.lines().find(|l| l.starts_with("effects: "));
    let line = line.unwrap_or_else(|| panic!("no line of effects in\n{log}"));
    let summary = summary(&dir, "out");
    for name in ["axial_force", "gravity", "radial_force"] {
        assert!(line.contains(&format!("{name} ")), "{line}");
        let seconds = number(&summary, &format!("/timing_s/effect_{name}"));
        // Measured on the reference rings of 51 300 dofs each: 1e-4 s an instant.
        assert!((0.0..0.1).contains(&seconds), "{name}: {seconds} s");
    }
    assert!(number(&summary, "/timing_s/effect_gravity") > 0.0);
}

/// If this failed, results would depend on the number of threads.
#[test]
fn one_and_two_threads_write_the_same_instants() {
    let dir = turned();
    dir.run("one", &["--threads", "1"]);
    for name in ["balls.csv", "shaft.csv", "energy.csv", "step_000004.hdf"] {
        let read = |folder: &str| std::fs::read(dir.path(&format!("{folder}/{name}"))).unwrap();
        assert!(read("one") == read("out"), "{name} differs");
    }
}

/// If this failed, instants before one without equilibrium would be lost, or the message would not say which it is.
/// At some hundred thousand turns a minute the centrifugal force of the balls drives the inner contacts over the
/// shoulder.
#[test]
fn instants_before_a_failure_are_kept() {
    let dir = Dir::with_meshes();
    let spun_up = "[quasi_static]\nduration = \"1 s\"\nstep = \"0.25 s\"\noutput_every = 4\n\n[speed]\n\
                   inner = { times = [\"0 s\", \"1 s\"], values = [\"0 rpm\", \"400000 rpm\"] }\n\n\
                   [effects.ball_centrifugal]";
    dir.write("scene.toml", with_line("[static]", "[static]", spun_up));
    let outcome = dir.raceway(&["run", "scene.toml", "--out", "out"]);
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    for part in [
        "step 3, t = 7.5",
        "the last equilibrium is in out",
        "leaves the inner raceway",
    ] {
        assert!(outcome.stderr.contains(part), "{part}: {}", outcome.stderr);
    }
    let summary = summary(&dir, "out");
    let status = summary["status"].as_str().unwrap();
    assert!(status.starts_with("failed: step 3"), "{status}");
    assert_eq!(number(&summary, "/iterations/steps"), 2.0);
    assert_eq!(Table::read(&dir, "out/shaft.csv").rows.len(), 3);
    for (step, is_there) in [(0, true), (1, false), (2, true)] {
        let path = dir.path(&format!("out/step_{step:06}.hdf"));
        assert_eq!(path.is_file(), is_there, "{}", path.display());
    }
}
