//! Balls that lean on a shoulder that their bearing does not have, through the whole program.

use crate::util::tables::summary;
use crate::util::{Dir, Outcome};

/// A 7206B with rigid rings under an axial force.
const SCENE: &str = r#"
[bearing]
bore_diameter = "30 mm"
outside_diameter = "62 mm"
width = "16 mm"
balls = 13
ball_diameter = "9.6 mm"
pitch_diameter = "46 mm"
contact_angle = "40 deg"

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

pub const REST: &str = r#"
[shaft]
x = "free"
y = "free"
z = "free"
tilt_x = "locked"
tilt_y = "locked"
load_point = "0 mm"

[effects.axial_force]
value = "2 kN"

[static]
"#;

/// What every such warning says.
const SAID: &str = "an angular contact bearing has a low shoulder there or none and comes apart, but this model \
                    carries on; look at the axial force, the preload and the orientation";

/// The warnings of a run that ends well, which stand in its log as well.
fn warnings(dir: &Dir, scene: &str, set: &[&str]) -> Vec<String> {
    let mut arguments = vec!["run", scene, "--out", "out"];
    set.iter().for_each(|change| arguments.extend(["--set", change]));
    let Outcome { code, stderr, .. } = dir.raceway(&arguments);
    assert_eq!(code, Some(0), "{stderr}");
    let found = summary(dir, "out");
    let texts: Vec<String> = found["warnings"]
        .as_array()
        .unwrap()
        .iter()
        .map(|text| text.as_str().unwrap().to_string())
        .collect();
    std::fs::remove_dir_all(dir.path("out")).unwrap();
    texts
}

fn bearing(rest: &str) -> Dir {
    let dir = Dir::with_scene(SCENE);
    dir.write("scene.toml", format!("{SCENE}{rest}"));
    dir
}

/// Wrong: a bearing that falls apart would end as a normal result, or one that carries as made, or a deep groove
/// bearing, would be warned of.
#[test]
fn an_axial_force_against_the_contact_angle_is_warned_of() {
    let dir = bearing(REST);
    let back = "effects.axial_force.value=\"-2 kN\"";
    assert!(warnings(&dir, "scene.toml", &[]).is_empty());
    let found = warnings(&dir, "scene.toml", &[back]);
    assert_eq!(found.len(), 1, "{found:?}");
    let first =
        "13 of 13 balls carry on the wrong shoulder, ball 0 on the inner raceway at a contact angle of -4";
    assert!(
        found[0].starts_with(first) && found[0].contains(SAID),
        "{found:?}"
    );
    // The same grooves, of a bearing that carries in both directions: 2 A (1 - cos 40 deg), A = 0.05 D_w.
    let clearance = 2.0 * 0.05 * 9.6 * (1.0 - 40f64.to_radians().cos());
    let deep = format!("radial_clearance = \"{clearance} mm\"");
    dir.write(
        "deep.toml",
        format!("{SCENE}{REST}").replace("contact_angle = \"40 deg\"", &deep),
    );
    assert!(warnings(&dir, "deep.toml", &[back]).is_empty());
}

/// Wrong: unequal shoulders would not tell where a bearing carries, or ends of rigid grooves would not count.
#[test]
fn drawn_shoulders_say_where_a_bearing_carries() {
    let section = |inner: &str, outer: &str| {
        let of = |ring: &str, shoulders: &str| {
            format!(
                "[{ring}]\nflexible = false\n\n[{ring}.section]\nsectors = 39\ngroove_elements = 8\n\
                 thickness_elements = 2\nshoulder_elements = 2\nelement = \"hex8\"\n\
                 shoulder_diameters = [{shoulders}]\n"
            )
        };
        let grooves = "contact_angle = \"40 deg\"";
        let clearance = format!(
            "radial_clearance = \"{} mm\"",
            2.0 * 0.05 * 9.6 * (1.0 - 40f64.to_radians().cos())
        );
        let text = SCENE.replace(grooves, &clearance);
        let head = text.split("[inner]").next().unwrap().to_string();
        head + &of("inner", inner) + &of("outer", outer)
    };
    let dir = bearing(REST);
    let back = "effects.axial_force.value=\"-2 kN\"";
    // High at -z inside and at +z outside.
    let drawn = section("\"43.5 mm\", \"40 mm\"", "\"52 mm\", \"48.5 mm\"");
    dir.write("drawn.toml", format!("{drawn}{REST}"));
    let found = warnings(&dir, "drawn.toml", &[]);
    assert!(!found.iter().any(|text| text.contains(SAID)), "{found:?}");
    let found = warnings(&dir, "drawn.toml", &[back]);
    assert!(found.iter().any(|text| text.contains(SAID)), "{found:?}");
    // Low on both sides: the ellipses reach beyond the grooves.
    let low = section("\"39 mm\", \"39 mm\"", "\"54 mm\", \"54 mm\"");
    dir.write("low.toml", format!("{low}{REST}"));
    let found = warnings(&dir, "low.toml", &[]);
    for side in ["inner", "outer"] {
        let edge = format!("edge contact on the {side} raceway, balls 0, 1, 2,");
        assert!(found.iter().any(|text| text.contains(&edge)), "{found:?}");
    }
}

/// Wrong: equilibria in time and motions would not be warned of.
#[test]
fn equilibria_in_time_and_motions_are_warned_of() {
    let dir = bearing("");
    let turn = "schedule.table = { times = [\"0 ms\", \"1 ms\"], factors = [1, -1] }";
    let force = format!("value = \"2 kN\"\n{turn}");
    let loaded = REST.replace("value = \"2 kN\"", &force);
    let series = "[quasi_static]\nstep = \"1 ms\"\nduration = \"2 ms\"\n\n[speed]\ninner = \"100 rpm\"\n";
    let motion = "[dynamic]\nstep = \"10 us\"\nduration = \"2 ms\"\n\n[speed]\ninner = \"100 rpm\"\n";
    for (name, analysis, at) in [
        (
            "series.toml",
            series,
            "t = 1.000000e-3 s: 13 of 13 balls carry on the wrong shoulder",
        ),
        ("motion.toml", motion, "in motion, 13 of 13 balls, in "),
    ] {
        let text = format!("{SCENE}{loaded}").replace("[static]\n", analysis);
        let text = text.replace("[shaft]\n", "[shaft]\nmass = \"0.1 kg\"\n");
        dir.write(name, text);
        let found = warnings(&dir, name, &[]);
        assert_eq!(
            found.iter().filter(|text| text.contains(SAID)).count(),
            1,
            "{found:?}"
        );
        assert!(found.iter().any(|text| text.starts_with(at)), "{found:?}");
    }
}

/// Wrong: bearings on one shaft that are pulled apart would carry without a word, or those that preload presses
/// together be warned of.
#[test]
fn bearings_that_are_pulled_apart_are_named() {
    let dir = Dir::with_scene(SCENE);
    std::fs::create_dir_all(dir.path("types")).unwrap();
    // Steeper grooves have more play than `pairing.offset` takes.
    dir.write("types/kind.toml", SCENE.replace("40 deg", "25 deg"));
    let one = |name: &str, position: f64, orientation: &str| {
        format!(
            "[[bearing]]\nname = {name:?}\nposition = \"{position} mm\"\norientation = {orientation:?}\n\
             type = \"types/kind.toml\"\n\n"
        )
    };
    let rest = "[pairing]\noffset = \"10 um\"\n\n[shaft]\nmodel = \"rigid\"\nx = \"free\"\ny = \"free\"\n\
                z = \"free\"\ntilt_x = \"free\"\ntilt_y = \"free\"\n\n[static]\n";
    dir.write(
        "pair.toml",
        one("front", 20.0, "+z") + &one("rear", 100.0, "-z") + rest,
    );
    assert!(warnings(&dir, "pair.toml", &[]).is_empty());
    let found = warnings(&dir, "pair.toml", &["pairing.offset=\"-1 mm\""]);
    for name in ["front", "rear"] {
        let said = format!("bearing {name:?}: 13 of 13 balls carry on the wrong shoulder");
        assert!(found.iter().any(|text| text.starts_with(&said)), "{found:?}");
    }
}
