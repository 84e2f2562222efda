//! Two bearings in one elastic housing through the whole program: files, bits, refusals.

use checkpoint::read_mesh;
use serde_json::Value;

use crate::housing::assert_moves_and_goes_on;
use crate::util::Dir;
use crate::util::delivered::coarse;
use crate::util::tables::{Table, number, summary};

pub const SCENE: &str = "scenes/7010c_spindle_housing.toml";
/// Few functions: these tests ask for no accuracy.
pub const FEW: [&str; 8] = [
    "--set",
    "body.0.seat.0.harmonics=3",
    "--set",
    "body.0.seat.0.across=1",
    "--set",
    "body.0.seat.1.harmonics=3",
    "--set",
    "body.0.seat.1.across=1",
];

/// If this failed, a pair in one housing would not carry its load, each bearing would show the whole housing, or a user
/// would not find the seats. The housing gives, so the nose moves further than in a stiff one.
#[test]
fn a_pair_in_one_housing_gives_more_than_in_a_stiff_one() {
    let stiff = "scenes/7010c_spindle_pair.toml";
    let dir = coarse(&[SCENE, stiff]);
    let run = |scene: &str, out: &str, more: &[&str]| {
        let run = dir.raceway(&[&["run", scene, "--out", out], more].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let line = Table::read(&dir, &format!("{out}/shaft.csv"));
        (line.column("x_m")[0], run.stdout)
    };
    let (stiff, _) = run(stiff, "stiff", &[]);
    let (found, said) = run(SCENE, "found", &FEW);
    assert!(found > 1.1 * stiff && found < 1.5 * stiff, "{found} {stiff}");
    let table = dir.text("found/bearings.csv");
    let at = table
        .lines()
        .next()
        .unwrap()
        .split(',')
        .position(|name| name == "force_x_n");
    let value = |row: &str| row.split(',').nth(at.unwrap()).unwrap().parse::<f64>().unwrap();
    let force: f64 = table.lines().skip(1).map(value).sum();
    assert!((force + 300.0).abs() < 1e-6, "{force}");
    let has_body = |name: &str| {
        let mesh = read_mesh(&dir.path(&format!("found/{name}"))).unwrap();
        mesh.body.contains(&3)
    };
    assert!(has_body("front") && !has_body("rear"));
    let where_it_is = "bearing \"rear\": body \"housing\" is in the files of ../front; raceway export";
    assert_eq!(said.matches(where_it_is).count(), 1, "{said}");
    for name in ["front", "rear"] {
        let line = format!("bearing {name:?}: seat of the outer ring in body \"housing\": ");
        let lines = said.lines().filter(|said| said.starts_with(&line));
        assert_eq!(lines.count(), 1, "{said}");
        let own = summary(&dir, &format!("found/{name}"));
        assert!(number(&own, "/seat/body_energy_j") > 0.0);
        assert!(dir.path(&format!("found/{name}/seat_outer.csv")).exists());
    }
}

/// The text of a scene for a file of the folder, up to its analysis.
pub fn without_analysis(dir: &Dir, scene: &str) -> String {
    let text = dir.text(scene).replace("../meshes", "meshes");
    let text = text.replace("\"types/", "\"scenes/types/");
    text.split_once("\n[static]").unwrap().0.to_string()
}

/// If this failed, a sweep that ends with an error would leave the seats of its last good point with forces of the
/// point that failed. Balls that carry 20 kN each are more than these meshes hold.
#[test]
fn a_sweep_that_fails_leaves_the_seats_of_its_last_point() {
    let dir = coarse(&[SCENE]);
    let before = without_analysis(&dir, SCENE);
    for (name, values) in [("good", "\"1 N\""), ("bad", "\"1 N\", \"2 MN\"")] {
        let sweep = format!(
            "\n[effects.axial_force]\nvalue = \"1 N\"\n[sweep]\nkey = \"effects.axial_force.value\"\n\
             values = [{values}]\n"
        );
        dir.write(&format!("{name}.toml"), format!("{before}{sweep}"));
        let scene = format!("{name}.toml");
        let run = dir.raceway(&[&["run", &scene, "--out", name][..], &FEW].concat());
        assert_eq!(run.code == Some(0), name == "good", "{}", run.stderr);
    }
    for seat in ["front/seat_outer.csv", "rear/seat_outer.csv"] {
        assert!(
            dir.text(&format!("good/{seat}")) == dir.text(&format!("bad/{seat}")),
            "{seat}"
        );
    }
}

/// The scene with a step of the load in motion.
pub fn moving(dir: &Dir) {
    in_motion(dir, SCENE, ["housing", "3000 rpm"]);
}

/// A scene in motion at a speed, with a step of the load and a body of few modes.
pub fn in_motion(dir: &Dir, scene: &str, [body, speed]: [&str; 2]) {
    let name = format!("name = \"{body}\"");
    let below = format!("{name}\nmodes_below = \"3 kHz\"");
    let before = without_analysis(dir, scene).replace(&name, &below);
    let motion = "[effects.axial_force]\nvalue = \"300 N\"\nschedule.step = { at = \"5 us\" }\n\
                  [dynamic]\nduration = \"80 us\"\nstep = \"10 us\"\noutput_every = 4\n";
    dir.write(
        "moving.toml",
        format!("{before}\n[speed]\ninner = \"{speed}\"\n{motion}"),
    );
}

/// If this failed, bearings that feel each other through a housing would lose energy in motion, or would go on to other
/// bits after a resume or on another number of threads.
#[test]
fn a_pair_moves_in_one_housing_and_goes_on_to_the_same_bits() {
    let dir = coarse(&[SCENE]);
    moving(&dir);
    assert_moves_and_goes_on(&dir, "moving.toml", &FEW);
}

/// Wrong: bearings that feel each other through a housing would have other equilibria over time on other numbers of
/// threads, or after a resume between two instants from which others start.
#[test]
fn a_pair_turns_in_one_housing_and_goes_on_to_the_same_bits() {
    let dir = coarse(&[SCENE]);
    let turning = "[speed]\ninner = \"3000 rpm\"\n[quasi_static]\nduration = \"2.2 ms\"\nstep = \"0.2 ms\"\n";
    dir.write(
        "turning.toml",
        format!("{}\n{turning}", without_analysis(&dir, SCENE)),
    );
    for (threads, out) in [("1", "whole"), ("4", "cut")] {
        let run = ["run", "turning.toml", "--out", out, "--threads", threads];
        let run = dir.raceway(&[&run[..], &FEW].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
    }
    let assert_same = || {
        for table in [
            "shaft.csv",
            "front/balls.csv",
            "front/seat_outer.csv",
            "rear/balls.csv",
        ] {
            let [whole, cut] = ["whole", "cut"].map(|out| dir.text(&format!("{out}/{table}")));
            assert!(whole == cut, "{table}");
        }
    };
    assert_same();
    std::fs::remove_file(dir.path("cut/summary.json")).unwrap();
    let resumed = dir.raceway(&["resume", "cut", "--step", "5", "--threads", "2"]);
    assert_eq!(resumed.code, Some(0), "{}", resumed.stderr);
    assert_same();
}

/// If this failed, the matrix of the shaft would not have what bearings do to each other through their housing, or a
/// user would take that of a bearing for all of it. The nose gives way as between two equilibria of nearby loads.
#[test]
fn the_stiffness_of_a_pair_in_one_housing_has_what_bearings_do_to_each_other() {
    let dir = coarse(&[SCENE]);
    let run = |arguments: &[&str]| {
        let run = dir.raceway(&[arguments, &FEW].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        run
    };
    let told = run(&["stiffness", SCENE, "--out", "k"]);
    let warning = "bearings \"front\", \"rear\" feel each other through body \"housing\"";
    assert!(told.stdout.contains(warning), "{}", told.stdout);
    let found: Value = serde_json::from_str(&dir.text("k/stiffness.json")).unwrap();
    let names = |i: usize| [0, 1].map(|k| found["couplings"][i][["loaded", "moved"][k]].as_str().unwrap());
    assert_eq!([names(0), names(1)], [["front", "rear"], ["rear", "front"]]);
    let nose = |out: &str, force: &str| {
        let set = format!("shaft.load.0.force=[\"{force} N\", \"0 N\", \"200 N\"]");
        run(&["run", SCENE, "--out", out, "--set", &set]);
        let line = Table::read(&dir, &format!("{out}/shaft.csv"));
        ["x_m", "y_m", "z_m", "tilt_x_rad", "tilt_y_rad"].map(|name| line.column(name)[0])
    };
    let (low, high) = (nose("low", "298"), nose("high", "302"));
    for row in 0..5 {
        let k = |column: usize| number(&found, &format!("/shaft/points/0/stiffness/{row}/{column}"));
        let load: f64 = (0..5).map(|j| k(j) * (high[j] - low[j])).sum();
        let expected = if row == 0 { 4.0 } else { 0.0 };
        // Patches stay where they are in the matrix. Moments count by the length of the nose.
        let arm = if row < 3 { 1.0 } else { 0.1 };
        assert!((load - expected).abs() < 4e-4 * arm, "{row}: {load} {expected}");
    }
}

/// If this failed, a bearing would sit in a seat that stands elsewhere.
#[test]
fn what_one_housing_of_several_bearings_does_not_have_ends_with_a_message() {
    let dir = coarse(&[SCENE]);
    let refused = |arguments: &[&str], expected: &str| {
        let run = dir.raceway(&[arguments, &["--out", "bad"], &FEW].concat());
        assert_ne!(run.code, Some(0));
        assert!(
            run.stderr.contains(expected),
            "{}\nexpected: {expected}",
            run.stderr
        );
        assert!(!dir.path("bad").exists());
    };
    let apart = "the seat of bearing \"rear\" stands 70.0000 mm along the shaft from that of \"front\", but with these \
                 positions of the bearings it is 80.2";
    refused(&["run", SCENE, "--set", "bearing.1.position=\"140 mm\""], apart);
    let turned = "stands -70.0000 mm along the shaft";
    refused(&["run", SCENE, "--set", "body.0.orientation=\"-z\""], turned);
}
