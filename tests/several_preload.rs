//! The force by which bearings of a list press on each other, in `raceway stiffness` and its figure.

use serde_json::Value;

use crate::several::{PAIR, succeeds, with_type};
use crate::util::tables::Table;
use crate::util::{assert_close, assert_within};

/// The bearings of the pair on a rigid shaft that moves along the axis alone, without load.
fn unloaded(pairing: &str) -> String {
    let bearings = PAIR.split("[pairing]").next().unwrap();
    format!(
        "{bearings}\n[pairing]\n{pairing}\n\n[shaft]\nmodel = \"rigid\"\nx = \"locked\"\ny = \"locked\"\n\
         z = \"free\"\ntilt_x = \"locked\"\ntilt_y = \"locked\"\n\n"
    )
}

/// Wrong: stiffness would be shown over another force than that of the catalogues. Clamping moves each ring by half of
/// the offset, so the force grows by half the stiffness of a bearing along the axis: differences over 0.2 um, whose
/// error is a 24th of (0.2 / 20)^2.
#[test]
fn stiffness_of_a_sweep_of_the_offset_stands_over_the_preload() {
    let dir = with_type();
    let sweep = "[sweep]\nkey = \"pairing.offset\"\nvalues = [\"19.9 um\", \"20 um\", \"20.1 um\"]\n";
    dir.write("pair.toml", unloaded("offset = \"20 um\"") + sweep);
    let said = succeeds(&dir, &["stiffness", "pair.toml", "--out", "k"]);
    let table = Table::read(&dir, "k/stiffness.csv");
    assert_eq!(table.columns.last().unwrap(), "preload_n");
    let preload = table.column("preload_n");
    let json: Value = serde_json::from_str(&dir.text("k/stiffness.json")).unwrap();
    let of_bearing = json["bearings"]["front"]["points"][1]["stiffness"][2][2]
        .as_f64()
        .unwrap();
    assert_close(
        "growth of the preload",
        (preload[2] - preload[0]) / 0.2e-6,
        0.5 * of_bearing,
        1e-4,
    );
    assert_within(
        "in the file",
        json["shaft"]["points"][1]["preload_n"].as_f64().unwrap(),
        preload[1],
        0.0,
    );
    let line = format!(
        "point 1: the bearings press on each other with {:.2} N along the axis",
        preload[1]
    );
    assert!(said.stdout.contains(&line), "{}", said.stdout);
    assert!(said.stdout.contains(" 0.0000201  front "), "{}", said.stdout);
    // The figure has the force on its axis, and no offset.
    let figure = dir.text("k/stiffness.svg");
    assert!(
        figure.contains("preload") && !figure.contains("offset"),
        "{figure}"
    );
    assert!(dir.text("k/stiffness_tilt.svg").contains("preload"));
}

/// Wrong: a load along the shaft would count as preload, or bearings that press one way only would have some.
#[test]
fn the_preload_is_what_both_orientations_carry() {
    let dir = with_type();
    let loaded = "[[shaft.load]]\nposition = \"0 mm\"\nforce = [\"0 N\", \"0 N\", \"200 N\"]\n\n[static]\n";
    dir.write(
        "soft.toml",
        unloaded("spring = \"500 N\"\nsliding = \"rear\"") + loaded,
    );
    succeeds(&dir, &["stiffness", "soft.toml", "--out", "soft"]);
    let preload = Table::read(&dir, "soft/stiffness.csv").column("preload_n");
    assert_close("soft", preload[0], 500.0, 1e-8);
    let tandem = unloaded("")
        .replace("\"-z\"", "\"+z\"")
        .replace("[pairing]\n", "");
    dir.write("tandem.toml", tandem + loaded);
    succeeds(&dir, &["stiffness", "tandem.toml", "--out", "tandem"]);
    assert!(!dir.text("tandem/stiffness.csv").contains("preload_n"));
    assert!(!dir.text("tandem/stiffness.json").contains("preload_n"));
}

/// Wrong: bearings of two shoulders that a negative offset presses the other way would have no preload. From the one
/// shoulder to the other each ring moves by twice A sin(alpha), with A = r_i + r_o - D, cos(alpha) = 1 - P_d / (2 A)
/// (Harris, Rolling Bearing Analysis, 4th ed., eqs. 2.8 and 2.9): so an offset of -o - 4 A sin(alpha) is one of o.
#[test]
fn bearings_press_on_their_other_shoulders_as_well() {
    let dir = with_type();
    let (a, play): (f64, f64) = (4.65 + 4.75 - 9.0, 74.037 - 56.01 - 18.0);
    let angle = (1.0 - play / (2.0 * a)).acos();
    let other = -0.02 - 4.0 * a * angle.sin();
    let preload = |name: &str, offset: f64| {
        let scene = unloaded(&format!("offset = \"{offset} mm\"")) + "[static]\n";
        dir.write(&format!("{name}.toml"), scene);
        succeeds(&dir, &["stiffness", &format!("{name}.toml"), "--out", name]);
        Table::read(&dir, &format!("{name}/stiffness.csv")).column("preload_n")[0]
    };
    assert_close(
        "other shoulders",
        preload("back", other),
        preload("there", 0.02),
        1e-6,
    );
    // Between them nothing presses.
    let between = unloaded("offset = \"-0.05 mm\"").replace("z = \"free\"", "z = \"locked\"") + "[static]\n";
    dir.write("loose.toml", between);
    succeeds(&dir, &["stiffness", "loose.toml", "--out", "loose"]);
    assert_eq!(
        Table::read(&dir, "loose/stiffness.csv").column("preload_n"),
        [0.0]
    );
}

/// A 7206B of dimensions between round numbers, whose balls round-off presses where they just touch.
const STEEP: &str = r#"
[bearing]
balls = 13
ball_diameter = "9.525 mm"
pitch_diameter = "46 mm"
contact_angle = "40 deg"
inner_curvature_ratio = 0.515
outer_curvature_ratio = 0.525
bore_diameter = "30 mm"
outside_diameter = "62 mm"
width = "16 mm"

[materials]
rings = "bearing steel"
balls = "bearing steel"

[contact]
mode = "rigid"

[inner]
flexible = false

[outer]
flexible = false
"#;

/// Wrong: pairs that begin where their balls just touch, without an offset, would have no solution where round-off
/// presses those balls by 1e-17 m: about one of three. Their stiffness as well.
#[test]
fn a_pair_whose_balls_round_off_presses_is_solved() {
    let dir = with_type();
    dir.write("types/kind.toml", STEEP);
    let free = unloaded("spring = \"420 N\"\nsliding = \"rear\"").replace("locked", "free");
    dir.write("spring.toml", format!("{free}[static]\n"));
    let (bearings, _) = free.split_once("[pairing]").unwrap();
    let (_, shaft) = free.split_once("[shaft]").unwrap();
    let load = "[effects.axial_force]\nvalue = \"420 N\"\n\n[static]\n";
    dir.write("load.toml", format!("{bearings}[shaft]{shaft}{load}"));
    for (name, carrying) in [("spring", 2), ("load", 1)] {
        succeeds(&dir, &["run", &format!("{name}.toml"), "--out", name]);
        let balls = |bearing: &str| {
            let table = Table::read(&dir, &format!("{name}/{bearing}/balls.csv"));
            let force = table.column("inner_force_n");
            let angle = table.column("inner_contact_angle_rad");
            force.iter().zip(&angle).map(|(q, a)| q * a.sin()).sum::<f64>()
        };
        let pressed = [balls("front"), balls("rear")];
        for (bearing, along) in pressed.into_iter().take(carrying).enumerate() {
            assert_close(&format!("{name}, bearing {bearing}"), along, 420.0, 1e-8);
        }
    }
    let held = shaft.replace("\"free\"", "\"locked\"");
    let one = bearings.split("[[bearing]]").nth(1).unwrap();
    dir.write("held.toml", format!("[[bearing]]{one}\n[shaft]{held}[static]\n"));
    succeeds(&dir, &["stiffness", "held.toml", "--out", "k"]);
}
