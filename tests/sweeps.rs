//! Sweeps through the whole program: a table with a column of the swept value, and the same numbers as single runs.

use std::io::{BufRead, BufReader};
use std::process::Stdio;
use std::sync::OnceLock;

use checkpoint::committed_steps;
use serde_json::Value;

use crate::interruption::{outcome_of, signal};
use crate::several::{kind, pair};
use crate::util::lockstep::{assert_same_run, small_motion};
use crate::util::tables::{Table, keys, number, summary};
use crate::util::{Dir, Files, RIGID, SCENE, assert_close, assert_within, with_line};

/// A sweep of the radial force of the tests' scene.
const SWEEP: &str =
    "[sweep]\nkey = \"effects.radial_force.value\"\nvalues = [\"0 kN\", \"0.5 kN\", \"1 kN\"]";

/// Column of the swept value: its key and the SI unit.
const COLUMN: &str = "effects.radial_force.value_n";

/// The swept values, N.
const VALUES: [f64; 3] = [0.0, 500.0, 1000.0];

/// A folder where the sweep was solved on the coarse meshes; solved once for all tests that look at it.
fn swept() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = Dir::with_meshes();
        dir.write("scene.toml", with_line("[static]", "[static]", SWEEP));
        dir.run("out", &[]);
        dir.snapshot()
    }))
}

/// If this failed, the points of a sweep could not be told apart in its tables.
#[test]
fn every_table_of_a_sweep_has_a_column_of_the_swept_value() {
    let swept = swept();
    for (name, rows) in [("balls.csv", 18), ("shaft.csv", 1), ("energy.csv", 1)] {
        let table = Table::read(&swept, &format!("out/{name}"));
        assert_eq!(table.columns[..3], ["step", "time_s", COLUMN], "{name}");
        assert_eq!(table.rows.len(), rows * VALUES.len(), "{name}");
        for (step, value) in VALUES.into_iter().enumerate() {
            assert_eq!(
                table.step(step).column(COLUMN),
                vec![value; rows],
                "{name}, step {step}"
            );
        }
    }
}

/// If this failed, a point would depend on the points before it, from which it only starts.
#[test]
fn points_of_a_sweep_agree_with_single_runs() {
    let swept = swept();
    let table = Table::read(&swept, "out/balls.csv");
    let dir = Dir::with_meshes();
    for (step, value) in VALUES.into_iter().enumerate() {
        let out = format!("single{step}");
        let set = format!("effects.radial_force.value={value} N");
        dir.run(&out, &["--set", &set, "--set", "output.stress=none"]);
        let single = Table::read(&dir, &format!("{out}/balls.csv"));
        for name in [
            "inner_force_n",
            "outer_force_n",
            "inner_contact_angle_rad",
            "displacement_axial_m",
        ] {
            for (a, b) in table.step(step).column(name).iter().zip(single.column(name)) {
                // Both settle to 1e-10 of the largest force; two digits for small forces beside large ones.
                assert_close(&format!("{name} at {value} N"), *a, b, 1e-8);
            }
        }
    }
}

/// Wrong: jobs that share a sweep would solve other points than the whole sweep has, or number them otherwise.
#[test]
fn points_of_a_sweep_can_be_solved_apart() {
    let swept = swept();
    let whole = Table::read(&swept, "out/balls.csv");
    swept.run("part", &["--points", "1-2"]);
    let part = Table::read(&swept, "part/balls.csv");
    assert_eq!(part.columns, whole.columns);
    assert_eq!(part.rows.len(), 2 * 18);
    for step in [1, 2] {
        assert_eq!(part.step(step).column(COLUMN), vec![VALUES[step]; 18]);
        let forces = |table: &Table| table.step(step).column("outer_force_n");
        for (a, b) in forces(&part).into_iter().zip(forces(&whole)) {
            assert_close(&format!("force at point {step}"), a, b, 1e-8);
        }
    }
    for (arguments, text) in [
        (
            ["--points", "2-3"],
            "--points names point 3, but the sweep of scene.toml has 3, from 0 to 2",
        ),
        (["--points", "2-1"], "\"2-1\" names no points; expected a number"),
    ] {
        let outcome = swept.raceway(&[&["run", "scene.toml", "--out", "no"], &arguments[..]].concat());
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        assert!(outcome.stderr.contains(text), "{}", outcome.stderr);
    }
    swept.write("single.toml", SCENE);
    let single = swept.raceway(&["run", "single.toml", "--points", "0"]);
    let text = "--points chooses points of a [sweep], and single.toml has none";
    assert!(
        single.code == Some(2) && single.stderr.contains(text),
        "{}",
        single.stderr
    );
}

/// If this failed, scripts would find other numbers in the summary of a sweep than in its tables.
#[test]
fn the_summary_of_a_sweep_has_all_its_points() {
    let swept = swept();
    let summary = summary(&swept, "out");
    assert_eq!(summary["analysis"], "sweep");
    assert_eq!(keys(&summary["sweep"]), ["column", "key", "points"]);
    assert_eq!(
        (&summary["sweep"]["column"], &summary["sweep"]["key"]),
        (&COLUMN.into(), &"effects.radial_force.value".into())
    );
    let table = Table::read(&swept, "out/balls.csv");
    let points = summary["sweep"]["points"].as_array().unwrap();
    assert_eq!(points.len(), VALUES.len());
    for (step, point) in points.iter().enumerate() {
        assert_eq!(keys(point), ["balls", "shaft", "value"]);
        assert_eq!(number(point, "/value"), VALUES[step]);
        let force: Vec<f64> = (0..18)
            .map(|ball| number(point, &format!("/balls/{ball}/outer/force_n")))
            .collect();
        assert_eq!(force, table.step(step).column("outer_force_n"), "step {step}");
    }
    assert_eq!(
        summary["balls"], points[2]["balls"],
        "the main part is the last point"
    );
}

/// If this failed, ParaView would not find a file per point of the sweep.
#[test]
fn a_sweep_has_a_step_file_per_point() {
    let swept = swept();
    let series: Value = serde_json::from_str(&swept.text("out/run.hdf.series")).unwrap();
    let names: Vec<&str> = series["files"]
        .as_array()
        .unwrap()
        .iter()
        .map(|f| f["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["step_000000.hdf", "step_000001.hdf", "step_000002.hdf"]);
    for (step, name) in names.iter().enumerate() {
        let record = checkpoint::read_step(&swept.path(&format!("out/{name}"))).unwrap();
        assert_eq!((record.step, record.time), (step as u64, step as f64));
        assert!(
            record.scene.contains("[static]") && !record.scene.contains("[sweep]"),
            "{}",
            record.scene
        );
    }
}

/// If this failed, a range would have other values than its ends and equal steps between them.
#[test]
fn a_range_sweeps_both_ends_and_equal_steps_between() {
    let dir = Dir::empty();
    let range = "[sweep]\nkey = \"effects.axial_force.value\"\nfrom = \"1 kN\"\nto = \"4 kN\"\nsteps = 3";
    dir.write("scene.toml", with_line("[static]", "[static]", range));
    dir.run("out", &RIGID);
    let table = Table::read(&dir, "out/shaft.csv");
    assert_eq!(
        table.column("effects.axial_force.value_n"),
        [1000.0, 2000.0, 3000.0, 4000.0]
    );
    let z = table.column("z_m");
    assert!(
        z.windows(2).all(|pair| pair[0] < pair[1]),
        "the shaft must move on with the load: {z:?}"
    );
}

/// If this failed, a sweep that breaks down would lose the points it has, or pass for a finished one.
#[test]
fn a_sweep_that_breaks_down_keeps_its_points_and_ends_with_code_3() {
    let dir = Dir::empty();
    let sweep = "[sweep]\nkey = \"effects.axial_force.value\"\nvalues = [\"1 kN\", \"2 kN\", \"1e9 N\"]";
    dir.write("scene.toml", with_line("[static]", "[static]", sweep));
    let outcome = dir.raceway(&[&["run", "scene.toml", "--out", "out"], &RIGID[..]].concat());
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    let message = "error: effects.axial_force.value_n = 1000000000 failed after 2 finished points, which are kept in \
                   out: no equilibrium: z of the shaft";
    assert!(outcome.stderr.contains(message), "{}", outcome.stderr);
    assert_eq!(Table::read(&dir, "out/balls.csv").rows.len(), 2 * 18);
    assert!(dir.path("out/step_000001.hdf").exists() && dir.path("out/run.vtkhdf").exists());
    let summary = summary(&dir, "out");
    let status = summary["status"].as_str().unwrap();
    assert!(
        status.starts_with("failed: effects.axial_force.value_n = 1000000000 failed after 2"),
        "{status}"
    );
    assert_eq!(summary["sweep"]["points"].as_array().unwrap().len(), 2);

    let rigid = Dir::with_scene(SCENE);
    rigid.run(
        "single",
        &[&["--set", "effects.axial_force.value=2 kN"], &RIGID[..]].concat(),
    );
    let (kept, single) = (
        Table::read(&dir, "out/balls.csv").step(1),
        Table::read(&rigid, "single/balls.csv"),
    );
    for (a, b) in kept
        .column("inner_force_n")
        .iter()
        .zip(single.column("inner_force_n"))
    {
        assert_close("force", *a, b, 1e-8);
    }
}

/// The tests' scene with rigid rings and a sweep of `key` over `values`.
fn rigid_sweep(key: &str, values: &str) -> Dir {
    let dir = Dir::empty();
    let sweep = format!("[sweep]\nkey = \"{key}\"\nvalues = {values}");
    dir.write("scene.toml", with_line("[static]", "[static]", &sweep));
    dir
}

/// If this failed, a sweep over the number of balls would end in a crash, or in tables of changing length.
#[test]
fn a_sweep_over_the_number_of_balls_is_refused() {
    let dir = rigid_sweep("bearing.balls", "[18, 17]");
    let outcome = dir.raceway(&[&["run", "scene.toml", "--out", "out"], &RIGID[..]].concat());
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    let message = "error: scene.toml: [sweep] key bearing.balls changes the number of balls, and with it the tables \
                   and the result files; run one scene per value with --set";
    assert!(outcome.stderr.contains(message), "{}", outcome.stderr);
    assert!(!dir.path("out").exists());
}

/// If this failed, the steel of rigid rings, which changes their contacts only, could not be swept.
#[test]
fn the_steel_of_rigid_rings_can_be_swept() {
    let dir = rigid_sweep("materials.rings.young_modulus", "[\"207 GPa\", \"310 GPa\"]");
    dir.run("out", &RIGID);
    let z = Table::read(&dir, "out/shaft.csv").column("z_m");
    assert!(z[1] < z[0], "stiffer rings must yield less: {z:?}");
}

/// Wrong: under a force along y the table on the screen would have the small x of the shaft and not its y.
#[test]
fn a_sweep_prints_all_that_the_shaft_does() {
    let dir = rigid_sweep("effects.axial_force.value", "[\"2 kN\", \"3 kN\"]");
    let across = [
        "--set",
        "effects.radial_force={value=\"1 kN\", direction=\"90 deg\"}",
    ];
    let outcome = dir.raceway(&[&["run", "scene.toml", "--out", "out"], &RIGID[..], &across].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let lines: Vec<&str> = outcome.stdout.lines().collect();
    let head = "effects.axial_force.value_n    x um     y um     z um  tilt_x urad  tilt_y urad";
    let first = 1 + lines.iter().position(|line| line.contains(head)).unwrap();
    let shaft = Table::read(&dir, "out/shaft.csv");
    let printed = |line: &str| line.split_whitespace().nth(2).map(|cell| cell.parse().unwrap());
    for (line, y) in lines[first..].iter().zip(shaft.column("y_m")) {
        assert_within(line, printed(line).unwrap(), 1e6 * y, 1e-3);
        assert!(y > 1e-6, "{y}");
    }
}

/// If this failed, a reader would not know which points of a sweep a warning means.
#[test]
fn warnings_of_a_sweep_name_their_point() {
    let dir = rigid_sweep("effects.axial_force.value", "[\"2 kN\", \"500 kN\"]");
    dir.run("out", &RIGID);
    let warnings = summary(&dir, "out")["warnings"].clone();
    let warnings = warnings.as_array().unwrap();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    let text = warnings[0].as_str().unwrap();
    assert!(
        text.starts_with("effects.axial_force.value_n = 500000: the peak pressure at ball "),
        "{text}"
    );
}

/// If this failed, ParaView would show the balls of a sweep over their azimuth where those of its first point are.
#[test]
fn balls_of_a_sweep_are_shown_where_they_are() {
    let dir = rigid_sweep("bearing.first_ball_azimuth", "[\"0 deg\", \"7 deg\"]");
    dir.run("out", &RIGID);
    let record = checkpoint::read_step(&dir.path("out/step_000001.hdf")).unwrap();
    let moved = record.points.displacement[0];
    let balls = Table::read(&dir, "out/balls.csv").step(1);
    // R_o - D_w/2 from the outer groove centre, at the free contact angle with cos a0 = 1 - 0.027 / (2 * 0.4).
    let radius = 32.2685e-3 + 0.25e-3 * (1.0 - 0.027 / 0.8);
    let now = radius + balls.column("displacement_radial_m")[0];
    let (sin, cos) = 7f64.to_radians().sin_cos();
    // Coordinates of 30 mm in f64.
    assert_within("x", moved[0], now * cos - radius, 1e-15);
    assert_within("y", moved[1], now * sin, 1e-15);
}

/// Wrong: points solved at the same time would show in the bits, in the order of files, or in which failure is told:
/// the tenth of twelve has no equilibrium, those before it are kept.
#[test]
fn points_solved_at_the_same_time_are_those_solved_one_by_one() {
    let dir = small_motion();
    let newtons = [
        200,
        400,
        600,
        800,
        1000,
        1200,
        1400,
        1600,
        1800,
        1_000_000_000,
        2000,
        2200,
    ];
    let values = newtons.map(|force| format!("\"{force} N\"")).join(", ");
    let sweep = format!("[sweep]\nkey = \"effects.axial_force.value\"\nvalues = [{values}]");
    dir.write("scene.toml", with_line("[static]", "[static]", &sweep));
    for threads in ["1", "2", "4"] {
        let outcome = dir.raceway(&["run", "scene.toml", "--out", threads, "--threads", threads]);
        assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
        let message = format!(
            "error: effects.axial_force.value_n = 1000000000 failed after 9 finished points, which are kept in \
             {threads}"
        );
        assert!(outcome.stderr.contains(&message), "{}", outcome.stderr);
        assert_eq!(
            committed_steps(&dir.path(threads)).unwrap(),
            (0..9).collect::<Vec<_>>()
        );
        let points = summary(&dir, threads)["sweep"]["points"]
            .as_array()
            .unwrap()
            .len();
        assert_eq!(points, 9);
    }
    assert_same_run(&dir, "1", "2");
    assert_same_run(&dir, "1", "4");
}

/// Wrong: a job whose sweep is too long would be killed by its batch system in the middle of a point, and nobody would
/// know which points are still to be computed.
#[test]
fn a_sweep_stops_at_a_signal_and_names_the_points_that_are_left() {
    const POINTS: usize = 3000;
    let dir = Dir::with_meshes();
    let values: Vec<String> = (0..POINTS).map(|i| format!("\"{i} N\"")).collect();
    let sweep = format!(
        "[sweep]\nkey = \"effects.radial_force.value\"\nvalues = [{}]",
        values.join(", ")
    );
    dir.write("scene.toml", with_line("[static]", "[static]", &sweep));
    let arguments = [&["run", "scene.toml", "--out", "out"], &RIGID[..]].concat();
    let mut command = dir.shell("true", &arguments);
    let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
    let mut messages = BufReader::new(child.stderr.take().unwrap());
    // The folder is there with the first point.
    while !dir.path("out").exists() {
        assert!(messages.read_line(&mut String::new()).unwrap() > 0, "it ended");
    }
    signal(&child, "TERM");
    let outcome = outcome_of(child, messages);
    assert_eq!(outcome.code, Some(75), "{}", outcome.stderr);
    let steps = committed_steps(&dir.path("out")).unwrap();
    let solved = steps.len();
    assert!(0 < solved && solved < POINTS, "{solved}");
    assert_eq!(steps, (0..solved as u64).collect::<Vec<_>>());
    assert_eq!(Table::read(&dir, "out/shaft.csv").rows.len(), solved);
    let said = format!(
        "stopped: SIGTERM received; the first {solved} of the {POINTS} points of the sweep are in out; for the others: \
         the same command with --points {solved}-{} and another --out",
        POINTS - 1
    );
    assert!(outcome.stderr.contains(&said), "{}", outcome.stderr);
    // Exit code 75 invites to resume.
    let resumed = dir.raceway(&["resume", "out"]);
    assert_eq!(resumed.code, Some(2));
    let expected = "out holds results of a [sweep] scene; only a run over time";
    assert!(resumed.stderr.contains(expected), "{}", resumed.stderr);
    let rest = format!(
        "are there, points {solved}-{last} are missing; the same command with --points {solved}-{last}, and another \
         --out, computes the missing ones",
        last = POINTS - 1
    );
    assert!(resumed.stderr.contains(&rest), "{}", resumed.stderr);
    // A point is no instant.
    let told = dir.raceway(&["info", "out"]).stdout;
    let expected = format!("steps      {solved} from 0 to {}, ", solved - 1);
    assert!(told.contains(&expected) && !told.contains("t = "), "{told}");
    let refused = dir.raceway(&["life", "out"]);
    assert_eq!(refused.code, Some(2));
    let expected = "the points left are computed by the same command with --points and another --out";
    assert!(refused.stderr.contains(expected), "{}", refused.stderr);
    // As told: the others.
    let part = format!("{solved}-{}", solved + 1);
    dir.run("rest", &[&["--points", part.as_str()], &RIGID[..]].concat());
    assert_eq!(
        committed_steps(&dir.path("rest")).unwrap(),
        [solved as u64, solved as u64 + 1]
    );
    assert_eq!(
        summary(&dir, "out")["status"]
            .as_str()
            .map(|s| s.starts_with("stopped")),
        Some(true)
    );
}

/// Wrong: a sweep would not look at its wall time, or leave a folder without a point.
#[test]
fn a_sweep_without_time_solves_nothing_and_says_so() {
    let dir = Dir::with_meshes();
    dir.write("scene.toml", with_line("[static]", "[static]", SWEEP));
    let run = ["run", "scene.toml", "--out", "out", "--wall-time", "00:00:00"];
    let outcome = dir.raceway(&[&run, &RIGID[..]].concat());
    assert_eq!(outcome.code, Some(75), "{}", outcome.stderr);
    let said = "--wall-time 00:00:00 is used up but for what it takes to stop; none of the 3 points of the sweep has \
                been solved";
    assert!(outcome.stderr.contains(said), "{}", outcome.stderr);
    assert!(!dir.path("out").exists());
    let list = pair("[sweep]\nkey = \"pairing.offset\"\nvalues = [\"10 um\", \"20 um\", \"30 um\"]");
    let outcome = list.raceway(&["run", "pair.toml", "--out", "out", "--wall-time", "00:00:00"]);
    assert_eq!(outcome.code, Some(75), "{}", outcome.stderr);
    assert!(outcome.stderr.contains(said), "{}", outcome.stderr);
}

/// Wrong: temperatures and expansions could not be swept, of a bearing or of a list, or points be others than single
/// runs at their values.
#[test]
fn temperatures_and_expansions_are_swept() {
    let warm = "[effects.temperature]\ninner = \"20 degC\"\nouter = \"20 degC\"\nballs = \"20 degC\"\n\n";
    let expansion = "density = \"7800 kg/m3\"\nexpansion = \"11.5e-6 /K\"\n";
    let text = SCENE.replace("density = \"7800 kg/m3\"\n", expansion);
    let steps =
        "[sweep]\nkey = \"effects.temperature.inner\"\nfrom = \"20 degC\"\nto = \"333.15 K\"\nsteps = 4";
    let values = "[sweep]\nkey = \"materials.rings.expansion\"\nvalues = [\"11e-6 /K\", \"12e-6 1/K\"]";
    let dir = Dir::with_scene(&text.replace("[static]", &format!("{warm}{steps}")));
    dir.run("out", &RIGID);
    let table = Table::read(&dir, "out/balls.csv");
    let kelvin = table.column("effects.temperature.inner_k");
    assert_eq!(
        [0, 18, 36, 54, 72].map(|row| kelvin[row]),
        [293.15, 303.15, 313.15, 323.15, 333.15]
    );
    dir.write("scene.toml", text.replace("[static]", &format!("{warm}[static]")));
    dir.run(
        "one",
        &[&RIGID[..], &["--set", "effects.temperature.inner=50 degC"]].concat(),
    );
    let forces = |table: Table| table.column("inner_force_n");
    let [point, one] = [table.step(3), Table::read(&dir, "one/balls.csv")].map(forces);
    for (point, one) in point.iter().zip(&one) {
        assert_close("force", *point, *one, 1e-9);
    }
    dir.write("scene.toml", text.replace("[static]", &format!("{warm}{values}")));
    dir.run("expansion", &RIGID);
    let shaft = Table::read(&dir, "expansion/shaft.csv");
    assert_eq!(shaft.column("materials.rings.expansion_per_k"), [11e-6, 12e-6]);
    let list = pair(&format!("{warm}{steps}"));
    list.write(
        "types/kind.toml",
        kind().replace("density = \"7800 kg/m3\"\n", expansion),
    );
    let outcome = list.raceway(&["run", "pair.toml", "--out", "out"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let last = Table::read(&list, "out/shaft.csv").column("effects.temperature.inner_k");
    assert_eq!(last.last(), Some(&333.15));
    let cold = text.replace(
        "[static]",
        &format!("{warm}{}", values.replace("11e-6 /K", "-300 degC")),
    );
    dir.write("scene.toml", cold);
    let outcome = dir.raceway(&["check", "scene.toml"]);
    let said = "\"-300 degC\" is no temperature above absolute zero";
    assert!(
        outcome.code == Some(2) && outcome.stderr.contains(said),
        "{}",
        outcome.stderr
    );
}
