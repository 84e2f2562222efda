//! `raceway stiffness` through the whole program: files, points of a sweep, ripple, refusals.

use serde_json::Value;

use crate::util::lockstep::small_motion;
use crate::util::matrices::matrix;
use crate::util::tables::{Table, keys, number, summary};
use crate::util::{Dir, Outcome, RIGID, SCENE, assert_close, with_line};

/// Runs the command on `scene.toml` into `out`.
fn stiffness(dir: &Dir, out: &str, arguments: &[&str]) -> Outcome {
    let first = ["stiffness", "scene.toml", "--out", out];
    dir.raceway(&[&first[..], arguments].concat())
}

/// The same, which must succeed, and the file that it wrote.
fn found(dir: &Dir, out: &str, arguments: &[&str]) -> (Outcome, Value) {
    let outcome = stiffness(dir, out, arguments);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let json = serde_json::from_str(&dir.text(&format!("{out}/stiffness.json"))).unwrap();
    (outcome, json)
}

/// A scene with these loads, tilts locked, in motion at 1800 rpm.
fn in_motion() -> String {
    let motion = "[speed]\ninner = \"1800 rpm\"\n\n[effects.contact_damping]\ncoefficient = \"5e-2 N s/mm\"\n\
                  full_approach = \"1 um\"\n\n[dynamic]\nduration = \"1 ms\"\nstep = \"10 us\"";
    with_line("[static]", "[static]", motion)
}

/// If this failed, the matrix would not say how the shaft of a run moves under a little more load. Flexible rings,
/// whose patches grow with the load: 1e-3.
#[test]
fn a_run_under_more_load_moves_as_the_stiffness_says() {
    let dir = Dir::with_meshes();
    let (outcome, json) = found(&dir, "k", &[]);
    let k = matrix(&json["stiffness"]);
    let mut moved = [[0.0; 3]; 2];
    for (i, force) in ["1990 N", "2010 N"].into_iter().enumerate() {
        let out = format!("run{i}");
        let set = format!("effects.axial_force.value={force}");
        dir.run(&out, &["--set", &set, "--set", "output.stress=none"]);
        let shaft = summary(&dir, &out);
        moved[i] = [0, 1, 2].map(|axis| number(&shaft, &format!("/shaft/displacement_m/{axis}")));
    }
    let change = [0, 1, 2].map(|i| moved[1][i] - moved[0][i]);
    for (i, expected) in [0.0, 0.0, 20.0].into_iter().enumerate() {
        let force: f64 = (0..3).map(|j| k[i][j] * change[j]).sum();
        assert!((force - expected).abs() < 0.02, "{i}: {force}");
    }
    assert_eq!(
        keys(&json),
        [
            "damping",
            "damping_note",
            "load_stiffness",
            "operating_point",
            "order",
            "source",
            "stiffness",
            "stiffness_schema",
            "units",
            "warnings"
        ]
    );
    assert_eq!(
        json["order"],
        serde_json::json!(["x", "y", "z", "tilt_x", "tilt_y"])
    );
    assert!(json["damping"].is_null());
    assert!(
        outcome
            .stdout
            .contains("damping: none: the scene has neither contact_damping nor rayleigh_damping"),
        "{}",
        outcome.stdout
    );
    let point = &json["operating_point"];
    assert_eq!(point["loads"], serde_json::json!([1000.0, 0.0, 2000.0, 0.0, 0.0]));
    assert_eq!(point["balls"].as_array().unwrap().len(), 18);
    assert!(
        outcome
            .stdout
            .ends_with("stiffness.json, stiffness.csv, ross.csv in k\n"),
        "{}",
        outcome.stdout
    );
}

/// If this failed, points of a sweep would be missing or mixed up, or the table for ROSS would have another unit of
/// speed.
#[test]
fn a_sweep_has_a_line_per_point_and_figures() {
    let sweep = "[speed]\ninner = \"1000 rpm\"\n\n[effects.ball_centrifugal]\n\n[sweep]\n\
                 key = \"speed.inner\"\nvalues = \
                 [\"0 rpm\", \"20000 rpm\", \"40000 rpm\"]";
    let dir = Dir::with_scene(&with_line("[static]", "[static]", sweep));
    let (outcome, json) = found(&dir, "k", &RIGID);
    assert_eq!(json["sweep"]["column"], "speed.inner_rad_per_s");
    // Without the round-off of the unit.
    assert!(outcome.stdout.contains(" 4188.79  "), "{}", outcome.stdout);
    assert!(
        outcome
            .stderr
            .contains("contacts at speed.inner_rad_per_s = 4188.79\n"),
        "{}",
        outcome.stderr
    );
    let table = Table::read(&dir, "k/stiffness.csv");
    assert_eq!(
        table.columns[..5],
        [
            "point",
            "time_s",
            "speed.inner_rad_per_s",
            "speed_rad_per_s",
            "k_x_x"
        ]
    );
    let ross = Table::read(&dir, "k/ross.csv");
    assert_eq!(ross.columns, ["speed", "kxx", "kxy", "kyx", "kyy"]);
    assert_close(
        "speed",
        ross.column("speed")[2],
        40000.0 * std::f64::consts::PI / 30.0,
        1e-12,
    );
    for (i, point) in json["sweep"]["points"].as_array().unwrap().iter().enumerate() {
        let k = matrix(&point["stiffness"]);
        assert_eq!(table.column("k_z_tilt_x")[i], k[2][3]);
        assert_eq!([ross.column("kxx")[i], ross.column("kxy")[i]], [k[0][0], k[0][1]]);
        assert_eq!([ross.column("kyx")[i], ross.column("kyy")[i]], [k[1][0], k[1][1]]);
        let set = format!("speed.inner={} rpm", 20000 * i);
        let alone = with_line(
            "[static]",
            "[static]",
            "[speed]\ninner = \"1000 rpm\"\n\n[effects.ball_centrifugal]\n\n[static]",
        );
        let single = Dir::with_scene(&alone);
        let (_, single) = found(&single, "k", &[&RIGID[..], &["--set", &set]].concat());
        assert_close("single", matrix(&single["stiffness"])[2][2], k[2][2], 1e-8);
    }
    let k_z = table.column("k_z_z");
    assert!(k_z[2] < k_z[0], "balls thrown outwards soften the axis: {k_z:?}");
    for name in ["stiffness.svg", "stiffness.png", "stiffness_tilt.svg"] {
        assert!(dir.path("k").join(name).exists(), "{name}");
    }
    assert!(!outcome.stdout.contains("no ross.csv"));
    let plotted = dir.raceway(&["plot", "k"]);
    assert!(
        plotted.stdout.contains("stiffness, stiffness_tilt"),
        "{}{}",
        plotted.stdout,
        plotted.stderr
    );
    let preload = "[sweep]\nkey = \"effects.axial_force.value\"\nvalues = [\"1 kN\", \"2 kN\"]";
    let dir = Dir::with_scene(&with_line("[static]", "[static]", preload));
    let (outcome, _) = found(&dir, "k", &RIGID);
    assert!(
        outcome
            .stdout
            .contains("no ross.csv: the speeds of the points do not grow")
    );
    assert!(!dir.path("k/ross.csv").exists());
}

/// If this failed, the ripple would not be that of balls that pass. Thrust alone has none.
#[test]
fn balls_that_pass_make_a_ripple_under_a_radial_load() {
    let dir = Dir::with_scene(SCENE);
    let ripple = ["--ripple", "6"];
    let (outcome, json) = found(&dir, "k", &[&RIGID[..], &ripple].concat());
    assert!(
        outcome
            .stdout
            .contains("ball-pass ripple, +- % of the mean over 6 positions: x 0."),
        "{}",
        outcome.stdout
    );
    let [low, mean, high] = ["minimum", "mean", "maximum"].map(|name| matrix(&json["ripple"][name]));
    let start = matrix(&json["stiffness"]);
    for i in 0..5 {
        assert!(low[i][i] < mean[i][i] && mean[i][i] < high[i][i], "{i}");
        assert!((low[i][i]..=high[i][i]).contains(&start[i][i]), "{i}");
    }
    let thrust = ["--set", "effects.radial_force.value=0 N"];
    let (_, json) = found(&dir, "thrust", &[&RIGID[..], &ripple, &thrust].concat());
    let [low, high] = ["minimum", "maximum"].map(|name| matrix(&json["ripple"][name]));
    (0..5).for_each(|i| assert_close("thrust", low[i][i], high[i][i], 1e-8));
}

/// If this failed, the damping of a scene in motion would be lost, or nobody would know of which instant it is.
#[test]
fn a_scene_in_motion_is_linearised_at_an_instant_and_has_damping() {
    let dir = Dir::with_scene(&in_motion());
    let (outcome, json) = found(&dir, "k", &[&RIGID[..], &["--time", "5e-4"]].concat());
    let said = "scene.toml runs in time; it is linearised about the equilibrium at 0.0005 s, without inertia";
    assert!(outcome.stderr.contains(said), "{}", outcome.stderr);
    let damping = matrix(&json["damping"]);
    assert!(damping[0][0] > 0.0 && damping[2][2] > 0.0, "{damping:?}");
    assert_eq!(
        json["damping_note"],
        "contacts along their normal, of slow motions"
    );
    assert_eq!(number(&json, "/operating_point/time_s"), 5e-4);
    let cage = number(&json, "/operating_point/cage_angle_rad");
    assert!(cage > 0.03 && cage < 0.05, "{cage}");
    let ross = Table::read(&dir, "k/ross.csv");
    assert_eq!(ross.columns[5..], ["cxx", "cxy", "cyx", "cyy"]);
    assert_eq!(ross.column("cyy"), [damping[1][1]]);
}

/// If this failed, locked dofs in which the shaft is unstable would pass without a word. A bearing without preload,
/// held tilted under a light radial load.
#[test]
fn a_matrix_that_is_not_positive_definite_is_warned_of() {
    let dir = Dir::with_scene(SCENE);
    let text = "warning: the stiffness is not positive definite: its lowest eigenvalue is -";
    let loads = [
        "effects.axial_force.value=0 N",
        "effects.radial_force.value=100 N",
    ];
    let tilted = ["shaft.tilt_x=1 mrad", "shaft.tilt_y=locked"];
    let sets: Vec<&str> = loads
        .iter()
        .chain(&tilted)
        .flat_map(|set| ["--set", *set])
        .collect();
    let (outcome, json) = found(&dir, "k", &[&RIGID[..], &sets].concat());
    assert!(outcome.stdout.contains(text), "{}", outcome.stdout);
    assert!(
        outcome
            .stdout
            .contains("N/m (tilts times 32.65 mm), in which tilt_y moves most")
    );
    assert_eq!(json["warnings"].as_array().unwrap().len(), 1);
    // The energy of some motion is negative: y, z and tilt_y are coupled by more than they are held.
    let k = matrix(&json["stiffness"]);
    let minor = |i: usize, j: usize| k[i][i] * k[j][j] - k[i][j] * k[j][i];
    let rows = [1, 2, 4];
    let whole: f64 = (0..3)
        .map(|c| {
            let [d, e] = [rows[(c + 1) % 3], rows[(c + 2) % 3]];
            k[1][rows[c]] * (k[2][d] * k[4][e] - k[2][e] * k[4][d])
        })
        .sum();
    assert!(whole < 0.0 || minor(1, 2) < 0.0 || minor(1, 4) < 0.0 || minor(2, 4) < 0.0);
    let (outcome, json) = found(&dir, "preloaded", &RIGID);
    assert!(!outcome.stdout.contains(text));
    assert_eq!(json["warnings"], serde_json::json!([]));
}

/// If this failed, a request that cannot be met would end in numbers, or in files written over.
#[test]
fn refusals_say_what_and_where() {
    let dir = Dir::with_scene(SCENE);
    let refused = |arguments: &[&str], expected: &str, code: i32| {
        let outcome = stiffness(&dir, "refused", &[&RIGID[..], arguments].concat());
        assert_eq!(outcome.code, Some(code), "{}", outcome.stderr);
        assert!(outcome.stderr.contains(expected), "{}", outcome.stderr);
        assert!(!dir.path("refused").exists());
    };
    refused(
        &["--time", "0.1"],
        "error: --time is for scenes that run in time, and scene.toml does not; leave it out",
        2,
    );
    refused(
        &["--ripple", "1"],
        "error: --ripple is 1; expected 2 to 1000 places of the balls in a pitch",
        2,
    );
    refused(
        &[
            "--set",
            "shaft.x=locked",
            "--set",
            "shaft.y=locked",
            "--set",
            "shaft.z=-10 um",
        ],
        "error: no ball is in contact with the inner ring, so the shaft has no stiffness there; expected a preload",
        2,
    );
    refused(
        &["--set", "effects.axial_force.value=1e9 N"],
        "error: no equilibrium: z of the shaft",
        3,
    );
    dir.write("scene.toml", in_motion());
    refused(
        &["--time", "1"],
        "error: --time is 1; expected 0 to 0.001 s, the time that scene.toml runs",
        2,
    );
    let traction =
        "[balls]\nmotion = \"free\"\n\n[effects.traction]\nlaw = \"coulomb\"\nfriction = 0.07\n\n[dynamic]";
    dir.write("scene.toml", in_motion().replace("[dynamic]", traction));
    refused(
        &[],
        "error: a stiffness cannot be had with balls.motion = \"free\", whose traction is not linearised",
        2,
    );
    let sweep = "[sweep]\nkey = \"effects.axial_force.value\"\nvalues = [\"1 kN\", \"1e9 N\"]";
    dir.write("scene.toml", with_line("[static]", "[static]", sweep));
    refused(
        &[],
        "error: effects.axial_force.value_n = 1000000000: no equilibrium",
        3,
    );
    dir.write("scene.toml", SCENE);
    found(&dir, "k", &RIGID);
    let before = dir.text("k/stiffness.json");
    let again = stiffness(&dir, "k", &RIGID);
    assert_eq!(again.code, Some(2));
    assert!(
        again
            .stderr
            .contains("error: k already holds stiffness.json; choose another --out or remove it"),
        "{}",
        again.stderr
    );
    assert_eq!(dir.text("k/stiffness.json"), before);
    let missing = dir.raceway(&["stiffness", "scene.toml"]);
    assert_eq!(missing.code, Some(2));
    assert!(missing.stderr.contains("--out <OUT>"), "{}", missing.stderr);
}

/// A rotor of 2 kg under thrust, free in all directions, with the centrifugal force of the balls.
fn rotor() -> String {
    let shaft = "tilt_y = \"free\"\nmass = \"2 kg\"\n\
                 transverse_inertia = \"1e-3 kg m2\"\npolar_inertia = \"1.2e-3 kg m2\"";
    let scene = with_line("[shaft]", "tilt_y = \"locked\"", shaft);
    let scene = scene.replacen("tilt_x = \"locked\"", "tilt_x = \"free\"", 1);
    let speed = "[speed]\ninner = \"1000 rpm\"\n\n[effects.ball_centrifugal]\n\n[static]";
    scene
        .replacen("[static]", speed, 1)
        .replacen("value = \"1 kN\"", "value = \"0 N\"", 1)
}

/// If this failed, modes at speed would be missing, of another speed, or without their lines and figure. The force of
/// the balls softens the axis; forward and backward part with the speed.
#[test]
fn a_campbell_diagram_has_modes_and_lines_over_the_speed() {
    let dir = Dir::with_scene(&rotor());
    let arguments = [
        "campbell",
        "scene.toml",
        "--speeds",
        "0..40000:20000",
        "--out",
        "c",
    ];
    let outcome = dir.raceway(&[&arguments[..], &RIGID].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let mut reader = csv::Reader::from_path(dir.path("c/campbell.csv")).unwrap();
    let columns: Vec<&str> = reader.headers().unwrap().iter().collect();
    assert_eq!(
        columns,
        [
            "speed_rpm",
            "mode",
            "frequency_hz",
            "whirl",
            "damping_ratio",
            "roundness",
            "shaft_share"
        ]
    );
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 15, "five modes at three speeds");
    let of = |speed: f64, whirl: &str| -> Vec<f64> {
        let chosen = rows
            .iter()
            .filter(|row| row[0].parse::<f64>().unwrap() == speed && &row[3] == whirl);
        chosen.map(|row| row[2].parse().unwrap()).collect()
    };
    assert_eq!(of(0.0, "planar").len(), 4);
    let (forward, backward) = (of(40000.0, "forward"), of(40000.0, "backward"));
    assert_eq!([forward.len(), backward.len()], [2, 2]);
    assert!(
        (0..2).all(|i| forward[i] > 1.001 * backward[i]),
        "{forward:?} {backward:?}"
    );
    assert!(of(40000.0, "axial")[0] < 0.99 * of(0.0, "axial")[0]);
    let lines = Table::read(&dir, "c/campbell_lines.csv");
    assert_close(
        "once per turn",
        lines.column("shaft_hz")[2],
        40000.0 / 60.0,
        1e-12,
    );
    let [cage, outer, inner] =
        ["cage_hz", "ball_pass_outer_hz", "ball_pass_inner_hz"].map(|name| lines.column(name)[1]);
    assert_close("balls pass", outer + inner, 18.0 * 20000.0 / 60.0, 1e-12);
    assert_close("cage", outer, 18.0 * cage, 1e-12);
    assert!(dir.path("c/campbell.svg").exists());
    let again = dir.raceway(&[&arguments[..], &RIGID].concat());
    assert!(
        again
            .stderr
            .contains("error: c already holds campbell.csv; choose another --out"),
        "{}",
        again.stderr
    );
    let plotted = dir.raceway(&["plot", "c"]);
    assert!(
        plotted.stdout.contains("1 figure as svg and png"),
        "{}{}",
        plotted.stdout,
        plotted.stderr
    );
}

/// If this failed, a user would take the modes for those of rings that the stress of their turning stiffens.
#[test]
fn a_campbell_diagram_says_that_it_is_without_the_stress_of_turning_rings() {
    let dir = small_motion();
    let say = |out: &str, stiffening: &str| {
        let table = format!("effects.frame_rotation={{ stress_stiffening = {stiffening} }}");
        let arguments = ["campbell", "scene.toml", "--speeds", "1000..1000:1", "--out", out];
        let sets = [
            "--set",
            "shaft.mass=2 kg",
            "--set",
            "speed.inner=1000 rpm",
            "--set",
            &table,
        ];
        let outcome = dir.raceway(&[&arguments[..], &sets].concat());
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        outcome.stderr + &outcome.stdout
    };
    let warning = "modes over the speed are without effects.frame_rotation.stress_stiffening: their rings yield \
                   without inertia of their own, which would take back most of what the stress of turning holds";
    assert!(say("with", "true").contains(warning));
    assert!(!say("without", "false").contains(warning));
}

/// If this failed, a diagram that cannot be had would end in numbers or in a message that helps nobody.
#[test]
fn refusals_of_a_campbell_diagram_say_what_and_where() {
    let dir = Dir::with_scene(&rotor());
    let refused = |arguments: &[&str], expected: &str| {
        let first = ["campbell", "scene.toml", "--out", "c"];
        let outcome = dir.raceway(&[&first[..], &RIGID, arguments].concat());
        assert!(
            outcome.code == Some(2) || outcome.code == Some(3),
            "{}",
            outcome.stderr
        );
        assert!(outcome.stderr.contains(expected), "{}", outcome.stderr);
        assert!(!dir.path("c").exists());
    };
    refused(
        &["--speeds", "0-5"],
        "\"0-5\" names no speeds; expected first..last:step in rpm, such as 0..40000:2000",
    );
    refused(
        &["--speeds", "0..1:1", "--number", "0"],
        "error: --number is 0; expected at least 1",
    );
    let massless = ["--speeds", "0..1:1", "--set", "shaft.mass=0 kg"];
    refused(
        &massless,
        "error: 0 rpm: x of the shaft is free and has no inertia",
    );
    let held = |scene: String, dof: &str| {
        scene.replacen(&format!("{dof} = \"free\""), &format!("{dof} = \"locked\""), 1)
    };
    let locked = ["x", "y"].into_iter().fold(SCENE.to_string(), held);
    dir.write("scene.toml", locked.replacen("z = \"free\"", "z = \"30 um\"", 1));
    refused(
        &["--speeds", "0..1:1"],
        "error: no dof of the shaft is free, so it has no modes; free some in [shaft]\n",
    );
    refused(
        &["--speeds", "0..1:1", "--number", "3"],
        "error: no dof of the shaft is free, so it has no modes; free some in [shaft]\n",
    );
    let sweep = "[sweep]\nkey = \"effects.axial_force.value\"\nvalues = [\"1 kN\", \"2 kN\"]";
    dir.write("scene.toml", with_line("[static]", "[static]", sweep));
    refused(
        &["--speeds", "0..1:1"],
        "error: scene.toml has a [sweep] of effects.axial_force.value; expected one operating point",
    );
}
