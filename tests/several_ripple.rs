//! Ball-pass ripple and instants of lists in `raceway stiffness`: those of one bearing, and of balls elsewhere.

use serde_json::Value;

use crate::several::{PAIR, flexible_pair, parts, succeeds, with_type};
use crate::shared_housing::{FEW, SCENE as HOUSING};
use crate::util::delivered::coarse;
use crate::util::lockstep::small_motion;
use crate::util::matrices::{assert_same_matrix, matrix};
use crate::util::{Dir, assert_close};

/// Angle from a ball of the test's bearing to the next, deg.
const PITCH: f64 = 20.0;
/// The same of the other bearing, which has 15 balls.
const OTHER_PITCH: f64 = 24.0;

/// A list of one bearing on a rigid shaft that is as free as that of the bearing. A load along the shaft makes it a
/// list: without, it would be read as the scene of one bearing.
fn list_of_one(rest: &str) -> String {
    let force = "[effects.axial_force]\nvalue = \"0.4 kN\"\n";
    assert!(rest.contains(force), "{rest}");
    let along = "[[shaft.load]]\nposition = \"0 mm\"\nforce = [\"0 N\", \"0 N\", \"0.4 kN\"]\n";
    let rest = rest.replace(force, along);
    let one = "[[bearing]]\nname = \"only\"\nposition = \"0 mm\"\norientation = \"+z\"\ntype = \"types/kind.toml\"\n";
    rest.replace("[shaft]", &format!("{one}\n[shaft]\nmodel = \"rigid\""))
}

fn stiffness(dir: &Dir, scene: &str, out: &str, more: &[&str]) -> Value {
    succeeds(dir, &[&["stiffness", scene, "--out", out], more].concat());
    serde_json::from_str(&dir.text(&format!("{out}/stiffness.json"))).unwrap()
}

const OF_RIPPLE: [&str; 3] = ["minimum", "mean", "maximum"];

/// Smallest, mean and largest of every entry.
fn ripple_of(matrices: &[[[f64; 5]; 5]]) -> [[[f64; 5]; 5]; 3] {
    let each = |f: &dyn Fn(&[f64]) -> f64| -> [[f64; 5]; 5] {
        let entry = |i: usize, j: usize| f(&matrices.iter().map(|m| m[i][j]).collect::<Vec<_>>());
        std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
    };
    [
        each(&|x| x.iter().copied().fold(f64::INFINITY, f64::min)),
        each(&|x| x.iter().sum::<f64>() / x.len() as f64),
        each(&|x| x.iter().copied().fold(f64::NEG_INFINITY, f64::max)),
    ]
}

/// The matrices of both bearings and of the shaft in a file.
fn three_points(json: &Value) -> [&Value; 3] {
    [
        &json["bearings"]["front"]["points"][0],
        &json["bearings"]["rear"]["points"][0],
        &json["shaft"]["points"][0],
    ]
}

/// Wrong: a list of one bearing would have another ripple than the bearing alone. Rigid rings, and flexible ones.
#[test]
fn a_list_of_one_bearing_has_the_ripple_of_the_bearing() {
    let flexible = small_motion();
    std::fs::create_dir_all(flexible.path("types")).unwrap();
    for mesh in ["inner.msh", "outer.msh"] {
        std::fs::copy(flexible.path(mesh), flexible.path(&format!("types/{mesh}"))).unwrap();
    }
    flexible.write("types/kind.toml", &parts()[0]);
    let (rigid, rest) = (with_type(), parts_with_radial_load());
    for (dir, places) in [(rigid, "5"), (flexible, "3")] {
        dir.write("list.toml", list_of_one(&rest));
        dir.write("single.toml", format!("{rest}\n{}", dir.text("types/kind.toml")));
        let alone = stiffness(&dir, "single.toml", "k1", &["--ripple", places]);
        let list = stiffness(&dir, "list.toml", "k2", &["--ripple", places]);
        for name in OF_RIPPLE {
            let expected = matrix(&alone["ripple"][name]);
            for point in [
                &list["bearings"]["only"]["points"][0],
                &list["shaft"]["points"][0],
            ] {
                assert_eq!(point["ripple"]["positions"], alone["ripple"]["positions"]);
                assert_same_matrix(name, matrix(&point["ripple"][name]), expected, 1e-9);
            }
        }
        let [low, high] = ["minimum", "maximum"].map(|name| matrix(&alone["ripple"][name])[0][0]);
        assert!(high / low - 1.0 > 1e-4, "{low} {high}");
    }
}

/// The scene of the tests without its bearing, under a radial load that leaves a part of the balls without load.
fn parts_with_radial_load() -> String {
    let rest = parts()[1].replace("\"1 kN\"", "\"1.2 kN\"");
    assert!(rest.contains("radial_force"), "{rest}");
    rest.replace("\"2 kN\"", "\"0.4 kN\"")
}

/// A pair whose first balls stand at azimuths, deg, in the shaft's frame.
fn pair_at(azimuths: [f64; 2], types: [&str; 2]) -> String {
    // Half of the balls carry nothing: a loaded ring of 18 has hardly any ripple.
    let mut text = PAIR.replace("\"300 N\"", "\"6 kN\"");
    for ((name, azimuth), kind) in [("front", azimuths[0]), ("rear", azimuths[1])]
        .into_iter()
        .zip(types)
    {
        let head = format!("name = \"{name}\"\n");
        let more = format!("{head}first_ball_azimuth = \"{azimuth:?} deg\"\n");
        let at = text.find(&head).unwrap();
        let tail = text
            .split_off(at)
            .replacen(&head, &more, 1)
            .replacen("types/kind.toml", kind, 1);
        text += &tail;
    }
    format!("{text}\n[static]\n")
}

/// Wrong: balls of a turned bearing would go the other way round, or not by its pitch. Against the matrices of scenes
/// whose first balls stand there.
#[test]
fn the_ripple_of_a_pair_is_that_of_scenes_with_their_balls_elsewhere() {
    let dir = with_type();
    let (start, types, n) = ([0.0, 7.0], ["types/kind.toml"; 2], 4);
    let at = |i: usize| start.map(|azimuth| azimuth + PITCH * i as f64 / n as f64);
    let mut expected: [Vec<[[f64; 5]; 5]>; 3] = Default::default();
    for i in 0..n {
        dir.write("placed.toml", pair_at(at(i), types));
        let json = stiffness(&dir, "placed.toml", &format!("k{i}"), &[]);
        for (all, point) in expected.iter_mut().zip(three_points(&json)) {
            all.push(matrix(&point["stiffness"]));
        }
    }
    dir.write("pair.toml", pair_at(start, types));
    let said = succeeds(&dir, &["stiffness", "pair.toml", "--out", "k", "--ripple", "4"]).stdout;
    for name in ["front", "rear", "shaft"] {
        let line = format!("point 0, {name}: ball-pass ripple, +- % of the mean over 4 positions: x ");
        assert!(said.contains(&line), "{said}");
    }
    let json: Value = serde_json::from_str(&dir.text("k/stiffness.json")).unwrap();
    for (point, matrices) in three_points(&json).into_iter().zip(&expected) {
        for (name, expected) in OF_RIPPLE.into_iter().zip(ripple_of(matrices)) {
            assert_same_matrix(name, matrix(&point["ripple"][name]), expected, 1e-9);
        }
    }
    let front = &three_points(&json)[0]["ripple"];
    let [low, high] = ["minimum", "maximum"].map(|name| matrix(&front[name])[0][0]);
    assert!(high / low - 1.0 > 1e-4, "no ripple to see: {low} {high}");
}

/// Wrong: bearings of two kinds would pass in step, which no motion does for long: extremes would be missed.
#[test]
fn bearings_of_two_kinds_take_all_places_against_each_other() {
    let dir = with_type();
    let other = dir.text("types/kind.toml").replace("balls = 18", "balls = 15");
    dir.write("types/other.toml", other);
    let (types, n) = (["types/kind.toml", "types/other.toml"], 2);
    let mut expected: [Vec<[[f64; 5]; 5]>; 3] = Default::default();
    for i in 0..n * n {
        let places = [(i % n) as f64 * PITCH, (i / n) as f64 * OTHER_PITCH];
        dir.write("placed.toml", pair_at(places.map(|x| x / n as f64), types));
        let json = stiffness(&dir, "placed.toml", &format!("k{i}"), &[]);
        for (all, point) in expected.iter_mut().zip(three_points(&json)) {
            all.push(matrix(&point["stiffness"]));
        }
    }
    dir.write("pair.toml", pair_at([0.0; 2], types));
    let json = stiffness(&dir, "pair.toml", "k", &["--ripple", "2"]);
    for (point, matrices) in three_points(&json).into_iter().zip(&expected) {
        assert_eq!(point["ripple"]["positions"], 4);
        for (name, expected) in OF_RIPPLE.into_iter().zip(ripple_of(matrices)) {
            assert_same_matrix(name, matrix(&point["ripple"][name]), expected, 1e-9);
        }
    }
    let refused = dir.raceway(&["stiffness", "pair.toml", "--out", "none", "--ripple", "40"]);
    assert_eq!(refused.code, Some(2), "{}", refused.stderr);
    let text = "error: --ripple is 40, and bearings of 2 kinds pass their balls each at its own time, which makes 40^2 \
                positions; expected 2 to 31 places of each pitch, at most 1000 positions";
    assert!(refused.stderr.contains(text), "{}", refused.stderr);
    let refused = dir.raceway(&["stiffness", "pair.toml", "--out", "none", "--ripple", "1"]);
    let text = "error: --ripple is 1; expected 2 to 1000 places of the balls in a pitch";
    assert!(
        refused.code == Some(2) && refused.stderr.contains(text),
        "{}",
        refused.stderr
    );
    assert!(!dir.path("none").exists());
}

/// Wrong: a ripple that is asked for would change the matrices of the points after it.
#[test]
fn a_ripple_changes_no_bit_of_the_matrices_of_a_sweep() {
    let dir = flexible_pair("[sweep]\nkey = \"pairing.offset\"\nvalues = [\"15 um\", \"20 um\"]");
    stiffness(&dir, "pair.toml", "plain", &[]);
    let json = stiffness(&dir, "pair.toml", "ripple", &["--ripple", "2"]);
    assert_eq!(json["shaft"]["points"][1]["ripple"]["positions"], 2);
    for table in ["stiffness.csv", "stiffness_front.csv", "stiffness_rear.csv"] {
        let [plain, ripple] = ["plain", "ripple"].map(|out| dir.text(&format!("{out}/{table}")));
        assert!(plain == ripple, "{table}");
    }
}

/// A list in time, under a load that grows.
fn turning(analysis: &str) -> String {
    let rest = parts_with_radial_load();
    let rest = rest.replace("load_point", "mass = \"3 kg\"\nload_point");
    let head = rest.split("[static]").next().unwrap();
    format!(
        "{head}\n[speed]\ninner = \"3000 rpm\"\n\n[effects.contact_damping]\ncoefficient = \"5e-2 N s/mm\"\n\
         full_approach = \"1 um\"\n\n{analysis}\n"
    )
}

/// Wrong: a list would be linearised at another instant than the one that is asked for, or without its cage there.
#[test]
fn a_list_is_linearised_at_a_time_of_its_motion_as_a_bearing_is() {
    let dir = with_type();
    let rest = turning("[dynamic]\nduration = \"2 ms\"\nstep = \"10 us\"");
    let growing = "[effects.radial_force.schedule.impact]\nstart = \"1 ms\"\nduration = \"4 ms\"\n";
    let rest = format!("{rest}{growing}");
    dir.write("list.toml", list_of_one(&rest));
    dir.write("single.toml", format!("{rest}\n{}", dir.text("types/kind.toml")));
    let at = ["--time", "1.3e-3", "--ripple", "3"];
    let alone = stiffness(&dir, "single.toml", "k1", &at);
    let list = stiffness(&dir, "list.toml", "k2", &at);
    let own = &list["bearings"]["only"]["points"][0];
    let shaft = &list["shaft"]["points"][0];
    for key in ["stiffness", "damping"] {
        for point in [own, shaft] {
            assert_same_matrix(key, matrix(&point[key]), matrix(&alone[key]), 1e-9);
        }
    }
    for name in OF_RIPPLE {
        let expected = matrix(&alone["ripple"][name]);
        assert_same_matrix(name, matrix(&shaft["ripple"][name]), expected, 1e-9);
    }
    for key in ["time_s", "speed_rad_per_s", "cage_angle_rad"] {
        assert_eq!(
            own["operating_point"][key], alone["operating_point"][key],
            "{key}"
        );
    }
    assert_eq!(shaft["operating_point"]["time_s"], 1.3e-3);
    let time = |out: &str| dir.text(&format!("{out}/stiffness.csv")).lines().nth(1).unwrap()[..8].to_string();
    assert_eq!(time("k1"), time("k2"));
    let late = dir.raceway(&["stiffness", "list.toml", "--out", "none", "--time", "1"]);
    let text = "error: --time is 1; expected 0 to 0.002 s, the time that list.toml runs";
    assert!(
        late.code == Some(2) && late.stderr.contains(text),
        "{}",
        late.stderr
    );
    dir.write("rest.toml", list_of_one(&parts_with_radial_load()));
    let none = dir.raceway(&["stiffness", "rest.toml", "--out", "none", "--time", "0"]);
    let text = "error: --time is for scenes that run in time, and rest.toml does not; leave it out";
    assert!(
        none.code == Some(2) && none.stderr.contains(text),
        "{}",
        none.stderr
    );
}

/// Wrong: loads and places of the balls of an instant would not be those with which the list turns there.
#[test]
fn a_pair_is_linearised_where_its_equilibria_over_time_stand() {
    let dir = with_type();
    let turning = "[speed]\ninner = \"3000 rpm\"\n\n[effects.unbalance]\nmass = \"10 g\"\neccentricity = \"5 mm\"\n\
                   position = \"20 mm\"\n\n[quasi_static]\nduration = \"2 ms\"\nstep = \"0.5 ms\"\n";
    dir.write("pair.toml", format!("{PAIR}\n{turning}"));
    succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
    let json = stiffness(&dir, "pair.toml", "k", &["--time", "1.5e-3"]);
    let rows = dir.text("out/bearings.csv");
    let names: Vec<&str> = rows.lines().next().unwrap().split(',').collect();
    let row = rows
        .lines()
        .find(|line| line.starts_with("3,") && line.contains(",front,"))
        .unwrap();
    let cells: Vec<&str> = row.split(',').collect();
    let value = |name: &str| {
        cells[names.iter().position(|n| *n == name).unwrap()]
            .parse::<f64>()
            .unwrap()
    };
    let shaft = &json["bearings"]["front"]["points"][0]["operating_point"]["shaft_displacement"];
    // The front bearing has the axes of the shaft; half of the offset lies between its ring and the shaft.
    for (axis, name) in ["x_m", "y_m"].into_iter().enumerate() {
        assert_close(name, shaft[axis].as_f64().unwrap(), value(name), 1e-6);
    }
}

/// Wrong: what bearings in one housing do to each other would have no ripple, or that of balls that stay.
#[test]
fn couplings_by_a_housing_have_the_ripple_of_balls_elsewhere() {
    let dir = coarse(&[HOUSING]);
    let half = ["0", "1"].map(|i| format!("bearing.{i}.first_ball_azimuth=\"10 deg\""));
    let moved = ["--set", half[0].as_str(), "--set", half[1].as_str()];
    // Some balls carry nothing: the entries change by 5 % of the largest.
    let load = ["--set", "shaft.load.0.force=[\"4 kN\", \"0 N\", \"200 N\"]"];
    let at = |out: &str, more: &[&str]| stiffness(&dir, HOUSING, out, &[&FEW[..], &load, more].concat());
    let (found, elsewhere) = (at("ripple", &["--ripple", "2"]), at("moved", &moved));
    let couplings = |json: &Value| json["couplings"].as_array().unwrap().clone();
    assert_eq!(couplings(&found).len(), 2);
    for (found, elsewhere) in couplings(&found).iter().zip(&couplings(&elsewhere)) {
        let both = [found, elsewhere].map(|coupling| matrix(&coupling["stiffness"][0]));
        for (name, expected) in OF_RIPPLE.into_iter().zip(ripple_of(&both)) {
            assert_same_matrix(name, matrix(&found["ripple"][0][name]), expected, 1e-9);
        }
    }
}
