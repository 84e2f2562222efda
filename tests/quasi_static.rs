//! Quasi-static runs through the whole program: instants, files, spin, costs, and runs that end early.

use std::sync::OnceLock;

use checkpoint::{committed_steps, step_file_name};

use crate::interruption::{outcome_of, signal, wait_for_steps};
use crate::resume::{assert_cuts_continue, refused, resumed};
use crate::util::lockstep::{assert_same_run, copy, small_motion};
use crate::util::tables::{Table, number, summary};
use crate::util::{Dir, Files, RIGID, assert_close, with_line};

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

/// 40 instants, a file each; balls come into load and go out of it.
fn small_turning() -> Dir {
    let dir = small_motion();
    let quasi = "[quasi_static]\nduration = \"8 ms\"\nstep = \"0.2 ms\"\n\n[speed]\ninner = \"12000 rpm\"\n\n\
                 [effects.ball_centrifugal]";
    dir.write(
        "scene.toml",
        with_line("[static]", "[static]", quasi).replace("\"2 kN\"", "\"0.4 kN\""),
    );
    dir
}

/// Wrong: which instants are solved at the same time would show in the last digits, or files be out of order.
#[test]
fn instants_have_the_same_bits_on_any_number_of_threads() {
    let dir = small_turning();
    for threads in ["1", "2", "4"] {
        dir.run(threads, &["--threads", threads]);
    }
    assert_eq!(committed_steps(&dir.path("1")).unwrap().len(), 41);
    for threads in ["2", "4"] {
        assert_same_run(&dir, "1", threads);
        assert_eq!(
            summary(&dir, "1")["iterations"],
            summary(&dir, threads)["iterations"]
        );
    }
}

/// Wrong: a resumed run would start its instants from others than the run that was not stopped: cut where eight begin,
/// where they end and between, resumed on other numbers of threads.
#[test]
fn equilibria_cut_at_any_step_continue_bit_for_bit() {
    let dir = small_turning();
    let reduced = format!("{}\n[output.reduction]\n", dir.text("scene.toml"));
    dir.write("scene.toml", reduced);
    dir.run("whole", &["--threads", "2"]);
    assert_cuts_continue(
        &dir,
        &[
            ("0", "2"),
            ("7", "1"),
            ("8", "4"),
            ("9", "2"),
            ("20", "1"),
            ("39", "2"),
            ("40", "1"),
        ],
    );
    for cut in ["cut0", "cut20", "cut40"] {
        let [whole, cut] = ["whole", cut].map(|out| summary(&dir, out));
        for key in ["iterations", "warnings", "shaft", "balls"] {
            assert!(!whole[key].is_null(), "{key}");
            assert_eq!(whole[key], cut[key], "{key}");
        }
    }
    let again = resumed(&dir, &["whole"]);
    let expected = "nothing to do: whole has finished with step 40 of 40, t = 8.000000e-3 s; a longer duration goes on \
                    from there, --set quasi_static.duration=...";
    assert!(again.stdout.contains(expected), "{}", again.stdout);
    copy(&dir, "whole", "longer");
    resumed(&dir, &["longer", "--set", "quasi_static.duration=\"8.4 ms\""]);
    dir.run("long", &["--set", "quasi_static.duration=\"8.4 ms\""]);
    assert_same_run(&dir, "long", "longer");
    refused(
        &dir,
        &["whole", "--set", "quasi_static.duration=\"4 ms\""],
        &[
            "the run is at step 40, t = 0.008 s, beyond quasi_static.duration = 0.004 s; expected a longer duration",
        ],
    );
}

/// Wrong: a kill at some instant, or the end of the time of a batch job, would lose equilibria or change later ones.
#[test]
fn killed_and_stopped_equilibria_go_on_bit_for_bit() {
    let dir = small_turning();
    dir.run("whole", &[]);
    let (mut arguments, mut ends) = (vec!["run", "scene.toml", "--out", "cut"], 0);
    for name in ["KILL", "TERM", "KILL", "TERM"] {
        let mut child = dir.start(&arguments);
        let messages = wait_for_steps(&mut child);
        signal(&child, name);
        let outcome = outcome_of(child, messages);
        ends += usize::from(outcome.code != Some(0));
        if name == "TERM" && outcome.code == Some(75) {
            assert!(
                outcome.stderr.contains("go on with raceway resume cut"),
                "{}",
                outcome.stderr
            );
        }
        if dir.path("cut").is_dir() && !committed_steps(&dir.path("cut")).unwrap_or_default().is_empty() {
            arguments = vec!["resume", "cut"];
        }
    }
    assert!(ends > 0, "no run was cut");
    let last = dir.raceway(&arguments);
    assert_eq!(last.code, Some(0), "{}", last.stderr);
    assert_same_run(&dir, "whole", "cut");
}

/// Wrong: a step would not say where the next equilibria start or what it was found from, or say it twice; a resumed
/// run would have other loads.
#[test]
fn a_step_holds_where_the_next_equilibria_start() {
    let dir = small_turning();
    dir.run("out", &RIGID);
    let state = |step: u64| {
        let path = dir.path("out").join(step_file_name(step));
        checkpoint::read_step(&path).unwrap().state
    };
    let [ahead, of_39, of_32, of_24] = [40, 39, 32, 24].map(state);
    assert!(!ahead.contains_key("start_shaft") && !of_32.contains_key("start_shaft"));
    for name in ["shaft", "balls", "seat"] {
        let start = &of_39[&format!("start_{name}")];
        assert_eq!(format!("{start:?}"), format!("{:?}", of_32[name]), "{name}");
        let from = &of_32[&format!("from_{name}")];
        assert_eq!(format!("{from:?}"), format!("{:?}", of_24[name]), "{name}");
    }
    let load = "effects.axial_force.value=\"1 kN\"";
    refused(
        &dir,
        &["out", "--step", "39", "--set", load],
        &[
            "--set would change effects.axial_force.value",
            "a resumed run may change only dynamic.duration",
        ],
    );
}
