//! The worked examples of `docs/examples.md`: the shipped scenes of other bearings give the values of books and
//! standards.

use std::path::Path;

use crate::util::tables::{Table, number, summary};
use crate::util::{Dir, RIGID, assert_close, assert_within};

/// Runs a shipped scene with rigid rings and the given settings.
fn rigid(scene: &str, settings: &[&str]) -> Dir {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(scene);
    let dir = Dir::empty();
    let set: Vec<&str> = settings.iter().flat_map(|s| ["--set", s]).collect();
    let path = path.to_str().unwrap();
    let outcome = dir.raceway(&[&["run", path, "--out", "out"], &RIGID[..], &set].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    dir
}

/// Wrong: a bearing of 40 degrees would not be Harris's 218 under thrust.
#[test]
fn the_218_under_thrust_is_that_of_the_book() {
    // His K of 896.7 N/mm2 for both contacts together, made a stiffness of each of two equal contacts:
    // K_n = K D^2 / (B D)^1.5, and K = 2^1.5 K_n.
    let (d, b) = (22.225_f64, 0.0464);
    let each = 2f64.powf(1.5) * 896.7 * d * d / (b * d).powf(1.5);
    let settings = ["inner", "outer"].map(|side| format!("contact.{side}_stiffness={each} N/mm^1.5"));
    let dir = rigid("218_thrust.toml", &[&settings[0], &settings[1]]);
    let table = Table::read(&dir, "out/balls.csv");
    let angle = table.column("inner_contact_angle_rad")[3].to_degrees();
    // He gives three digits, 41.6 deg, and four, 1676 N.
    assert_within("contact angle, deg", angle, 41.6, 0.05);
    assert_close("ball force, N", table.column("inner_force_n")[3], 1676.0, 5e-4);
    // 0.0386 mm follows from his rounded angle: 0.05 deg there are 0.0012 mm.
    let z = number(&summary(&dir, "out"), "/shaft/displacement_m/2");
    assert_within("axial displacement, mm", 1e3 * z, 0.0386, 1.2e-3);
}

/// Wrong: the load of a deep-groove bearing would not spread over its balls as Stribeck found.
#[test]
fn the_6010_without_clearance_has_stribecks_constant() {
    let dir = rigid("6010_radial.toml", &[]);
    let force = Table::read(&dir, "out/balls.csv").column("inner_force_n");
    // Largest force 4.37 F_r / Z (Harris, 4th ed., ch. 7: Stribeck's sum, without clearance); exact to its three
    // digits.
    assert_close("largest ball force", force[0], 4.37 * 16e3 / 14.0, 2e-3);
    let (sum, lift): (f64, Vec<f64>) = (
        (0..14)
            .map(|i| force[i] * (std::f64::consts::TAU * i as f64 / 14.0).cos())
            .sum(),
        force[4..=10].to_vec(),
    );
    assert_close("radial balance", sum, 16e3, 1e-8);
    assert_eq!(lift, vec![0.0; 7], "the half without load");
}
