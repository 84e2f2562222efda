//! Damping of bearings in a list: that of one bearing, the sum of two, words where there is none.

use serde_json::Value;

use crate::several::{succeeds, with_type};
use crate::util::matrices::{assert_same_matrix, matrix};
use crate::util::tables::Table;
use crate::util::{Dir, assert_close};

/// A free rigid shaft with its loads, and contacts that damp in motion.
const MOTION: &str = "x = \"free\"\ny = \"free\"\nz = \"free\"\ntilt_x = \"free\"\ntilt_y = \"free\"\n\
     mass = \"3 kg\"\ntransverse_inertia = \"1e-2 kg m2\"\npolar_inertia = \"2e-3 kg m2\"\n\n\
     [speed]\ninner = \"3000 rpm\"\n\n\
     [effects.contact_damping]\ncoefficient = \"5e-2 N s/mm\"\nfull_approach = \"1 um\"\n\n\
     [dynamic]\nduration = \"0.5 ms\"\nstep = \"5 us\"\n";

/// The load on a bearing alone, and on a shaft at 0.
const LOAD: &str = "[effects.axial_force]\nvalue = \"800 N\"\n\n[effects.radial_force]\nvalue = \"500 N\"\n\
     direction = \"30 deg\"\n\n";
const LOAD_ON_SHAFT: &str = "[[shaft.load]]\nposition = \"0 mm\"\n\
     force = [\"433.01270189221932 N\", \"250 N\", \"800 N\"]\n\n";

/// A rigid shaft under that load.
fn loaded_shaft() -> String {
    format!(
        "[shaft]\nmodel = \"rigid\"\n{}",
        MOTION.replacen("\n\n[speed]", &format!("\n\n{LOAD_ON_SHAFT}[speed]"), 1)
    )
}

fn bearing(name: &str, position: &str, orientation: &str) -> String {
    format!(
        "[[bearing]]\nname = \"{name}\"\nposition = \"{position}\"\norientation = \"{orientation}\"\n\
         type = \"types/kind.toml\"\n\n"
    )
}

fn stiffness(dir: &Dir, scene: &str, out: &str) -> (Value, String) {
    let said = succeeds(dir, &["stiffness", scene, "--out", out]).stdout;
    (
        serde_json::from_str(&dir.text(&format!("{out}/stiffness.json"))).unwrap(),
        said,
    )
}

/// A column of numbers of `campbell.csv`, which has words in others.
fn modes_column(dir: &Dir, out: &str, column: &str) -> Vec<f64> {
    let text = dir.text(&format!("{out}/campbell.csv"));
    let mut rows = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let place = rows.next().unwrap().iter().position(|name| *name == column);
    let place = place.unwrap_or_else(|| panic!("no column {column}: {text}"));
    rows.map(|row| row[place].parse().unwrap()).collect()
}

/// Wrong: a list would lose the damping that the same bearing has alone, or say that its modes have none. Campbell too.
#[test]
fn a_list_of_one_bearing_has_the_damping_of_the_bearing() {
    let dir = with_type();
    dir.write("list.toml", bearing("only", "0 mm", "+z") + &loaded_shaft());
    dir.write(
        "single.toml",
        format!(
            "{}\n[shaft]\nload_point = \"0 mm\"\n{MOTION}{LOAD}",
            dir.text("types/kind.toml")
        ),
    );
    let (alone, said_alone) = stiffness(&dir, "single.toml", "k1");
    let (list, said) = stiffness(&dir, "list.toml", "k2");
    let line = "damping: contacts along their normal, of slow motions\n";
    assert!(said_alone.contains(line) && said.contains(line), "{said}");
    let expected = matrix(&alone["damping"]);
    assert!(expected[0][0] > 100.0, "{}", expected[0][0]);
    let of_bearing = &list["bearings"]["only"]["points"][0];
    let of_shaft = &list["shaft"]["points"][0];
    assert_same_matrix("damping", matrix(&of_bearing["damping"]), expected, 1e-9);
    assert_same_matrix("damping", matrix(&of_shaft["damping"]), expected, 1e-9);
    assert_eq!(list["damping_note"], alone["damping_note"]);
    let [point, own] = [&of_shaft["operating_point"], &alone["operating_point"]];
    for key in ["time_s", "speed_rad_per_s"] {
        assert_eq!(point[key], own[key], "{key}");
    }
    for axis in 0..5 {
        let at = |point: &Value| point["shaft_displacement"][axis].as_f64().unwrap();
        assert!((at(point) - at(own)).abs() < 1e-13, "{axis}");
    }
    let tables = ["k1/stiffness.csv", "k2/stiffness.csv"].map(|name| Table::read(&dir, name));
    assert_eq!(tables[0].columns, tables[1].columns);
    for scene in ["single", "list"] {
        let out = format!("c_{scene}");
        let said = succeeds(
            &dir,
            &[
                "campbell",
                &format!("{scene}.toml"),
                "--speeds",
                "1000..3000:2000",
                "--out",
                &out,
            ],
        );
        assert!(said.stdout.contains(line), "{}", said.stdout);
    }
    let [expected, found] = ["c_single", "c_list"].map(|out| modes_column(&dir, out, "damping_ratio"));
    assert_eq!(expected.len(), found.len());
    for (found, expected) in found.iter().zip(&expected) {
        assert_close("damping ratio", *found, *expected, 1e-9);
        assert!(*expected > 1e-6, "{expected}");
    }
    // Speeds are those that were asked for, to the last digit.
    assert_eq!(modes_column(&dir, "c_list", "speed_rpm")[0], 1000.0);
}

/// Wrong: a rigid shaft would not have the damping of both bearings, at their places. Point at 0: a bearing at z moves
/// by x + tilt_y z and y - tilt_x z.
#[test]
fn a_rigid_shaft_has_the_damping_of_both_bearings_and_a_stiff_beam_as_well() {
    let dir = with_type();
    let bearings = bearing("front", "10 mm", "+z") + &bearing("rear", "50 mm", "-z");
    let pairing = "[pairing]\noffset = \"20 um\"\n\n";
    dir.write("pair.toml", format!("{bearings}{pairing}{}", loaded_shaft()));
    let (json, _) = stiffness(&dir, "pair.toml", "k");
    let mut expected = [[0.0; 5]; 5];
    for (name, z) in [("front", 0.01), ("rear", 0.05)] {
        let own = matrix(&json["bearings"][name]["points"][0]["damping"]);
        let mut moved = [[0.0; 5]; 5];
        (0..5).for_each(|i| moved[i][i] = 1.0);
        (moved[0][4], moved[1][3]) = (z, -z);
        for i in 0..5 {
            for j in 0..5 {
                expected[i][j] += (0..25)
                    .map(|k| moved[k / 5][i] * own[k / 5][k % 5] * moved[k % 5][j])
                    .sum::<f64>();
            }
        }
    }
    assert_same_matrix(
        "damping",
        matrix(&json["shaft"]["points"][0]["damping"]),
        expected,
        // The arms are those of the tilted shaft.
        1e-5,
    );
    // The same on a beam that hardly gives.
    let rest = MOTION.split("polar_inertia = \"2e-3 kg m2\"\n").nth(1).unwrap();
    let beam = format!(
        "[shaft]\nmodel = \"beam\"\n\
                material = {{ young_modulus = \"2000 GPa\", poisson_ratio = 0.3, density = \"7800 kg/m3\" }}\n\
                element_length = \"10 mm\"\n\n\
                [[shaft.section]]\nfrom = \"0 mm\"\nto = \"60 mm\"\noutside = \"900 mm\"\n\n{LOAD_ON_SHAFT}"
    );
    dir.write("beam.toml", format!("{bearings}{pairing}{beam}{rest}"));
    let (json, _) = stiffness(&dir, "beam.toml", "b");
    assert_same_matrix(
        "damping",
        matrix(&json["shaft"]["points"][0]["damping"]),
        expected,
        2e-3,
    );
}

/// Wrong: a list at rest would say nothing of its damping, or something else than a bearing alone.
#[test]
fn a_list_without_a_law_says_why_it_has_no_damping() {
    let dir = with_type();
    let at_rest = loaded_shaft().split("[speed]").next().unwrap().to_string() + "[static]\n";
    dir.write("list.toml", bearing("only", "0 mm", "+z") + &at_rest);
    let (json, said) = stiffness(&dir, "list.toml", "k");
    let line = "none: the scene has neither contact_damping nor rayleigh_damping, which take [dynamic]";
    assert!(said.contains(&format!("damping: {line}\n")), "{said}");
    assert_eq!(json["damping_note"], line);
    assert_eq!(json["bearings"]["only"]["damping_note"], line);
    assert!(json["shaft"]["points"][0]["damping"].is_null());
    assert!(json["bearings"]["only"]["points"][0]["damping"].is_null());
}
