//! A bearing of 40 deg whose unloaded balls lie between the shoulders by their own weight.

use crate::first_hour::has_gmsh;
use crate::several::succeeds;
use crate::util::Dir;
use crate::util::tables::{Table, number, summary};
use crate::wrong_shoulder::REST;

const BEARING: &str = r#"
[bearing]
bore_diameter = "30 mm"
outside_diameter = "62 mm"
width = "16 mm"
balls = 13
ball_diameter = "9.525 mm"
pitch_diameter = "46 mm"
contact_angle = "40 deg"
inner_curvature_ratio = 0.52
outer_curvature_ratio = 0.53

[materials]
rings = "bearing steel"
balls = "bearing steel"

[contact]
mode = "patch"
"#;

/// A ring and its section.
const RING: &str = r#"
[RING]
mesh = "RING.msh"
mesh_unit = "mm"
support = "clamped"

[RING.section]
element = "hex8"
sectors = 52
groove_elements = 6
thickness_elements = 2
shoulder_elements = 1
grading = 1.2
"#;
const LOADS: &str = "value = \"700 N\"\n\n[effects.radial_force]\nvalue = \"900 N\"\ndirection = \"0 deg\"";
const WEIGHT: &str =
    "[effects.gravity]\nacceleration = \"9.81 m/s2\"\ndirection = [0.0, -1.0, 0.0]\n\n[static]";

/// If this failed, a ball that carries a hundredth of a newton at 70 deg, beyond the shoulders at 60 deg, would end a
/// run whose answer it does not touch, or nothing would be said of it.
#[test]
fn a_ball_that_its_weight_pinches_beyond_the_groove_ends_no_run() {
    if !has_gmsh() {
        return;
    }
    let rings = ["inner", "outer"].map(|ring| RING.replace("RING", ring)).concat();
    let scene = format!("{BEARING}{rings}{}", REST.replace("value = \"2 kN\"", LOADS));
    let dir = Dir::with_scene(&scene);
    dir.write("heavy.toml", scene.replace("[static]", WEIGHT));
    dir.write("light.toml", &scene);
    succeeds(&dir, &["mesh", "light.toml", "--force"]);
    let said = succeeds(&dir, &["run", "heavy.toml", "--out", "heavy"]);
    succeeds(&dir, &["run", "light.toml", "--out", "light"]);
    let balls = Table::read(&dir, "heavy/balls.csv");
    let contacts = balls
        .column("inner_contact_angle_rad")
        .into_iter()
        .zip(balls.column("inner_force_n"));
    let beyond: Vec<(f64, f64)> = contacts
        .filter(|(angle, force)| angle.to_degrees() > 60.0 && *force > 1e-6)
        .collect();
    assert!(
        !beyond.is_empty() && beyond.iter().all(|(_, force)| *force < 0.1),
        "{beyond:?}"
    );
    assert!(
        said.stdout.contains("edge contact on the inner raceway, balls "),
        "{}",
        said.stdout
    );
    let x = ["heavy", "light"].map(|name| number(&summary(&dir, name), "/shaft/displacement_m/0"));
    assert!((x[0] / x[1] - 1.0).abs() < 1e-3, "{x:?}");
}
