//! Life from stress through the whole program.

use serde_json::Value;

use crate::util::tables::number;
use crate::util::{Dir, RIGID, SCENE, assert_close};

const SWEEP: &str = "[sweep]\nkey = \"effects.radial_force.value\"\nvalues = [\"0 kN\", \"1 kN\"]";

/// A folder with meshes and a scene on a tight shaft.
fn pressed() -> Dir {
    let dir = Dir::with_meshes();
    let fit = "[effects.fit.inner]\ninterference = \"20 um\"\n\n[static]";
    dir.write("scene.toml", SCENE.replace("[static]", fit));
    dir
}

fn ratio(dir: &Dir, arguments: &[&str]) -> Value {
    let _ = std::fs::remove_dir_all(dir.path("stress"));
    let all = [&["life", "--stress", "scene.toml", "--out", "stress"], arguments].concat();
    let outcome = dir.raceway(&all);
    assert_eq!(outcome.code, Some(0), "{arguments:?}: {}", outcome.stderr);
    serde_json::from_str(&dir.text("stress/life.json")).unwrap()
}

/// The command must refuse with this text.
fn refused(dir: &Dir, arguments: &[&str], expected: &str) {
    let outcome = dir.raceway(&[&["life"], arguments].concat());
    assert_eq!(outcome.code, Some(2), "{arguments:?}: {}", outcome.stderr);
    assert!(
        outcome.stderr.contains(expected),
        "{arguments:?}: {}",
        outcome.stderr
    );
}

/// Wrong: the hoop stress of a fit would lengthen life, or not count. Ratios multiply, and the loads alone have the
/// ratio of a scene whose rings feel no stress of their own.
#[test]
fn the_stress_of_a_fit_costs_life() {
    let dir = pressed();
    let of = |um: &str| {
        ratio(
            &dir,
            &["--set", &format!("effects.fit.inner.interference={um} um")],
        )
    };
    let (some, more) = (of("10"), of("20"));
    for found in [&some, &more] {
        let [both, loads, stress] =
            ["ratio", "ratio_of_loads", "ratio_of_stress"].map(|key| number(found, &format!("/{key}")));
        assert_close("product", both, loads * stress, 1e-12);
        assert!(stress < 1.0 && number(found, "/outer/ratio") > 0.5, "{found}");
        assert_eq!(found["left_out"], serde_json::json!(["fit"]));
    }
    let stress = |found: &Value| number(found, "/ratio_of_stress");
    assert!(
        stress(&more) < stress(&some),
        "{} {}",
        stress(&more),
        stress(&some)
    );
    // The fit adds its hoop stress near the raceway: I/2 over the radius times E of a tube, some 33 MPa for 10 um.
    let added = number(&some, "/inner/hoop_stress_pa") - number(&some, "/inner/reference_hoop_stress_pa");
    assert!((20e6..45e6).contains(&added), "{added}");
}

/// Wrong: what has no ratio would get one.
#[test]
fn a_life_from_stress_says_what_it_needs() {
    let dir = pressed();
    let plain = ["--stress", "scene.toml", "--set", "effects.fit=none"];
    refused(
        &dir,
        &plain,
        "--stress compares its life with that without them, expected one of them",
    );
    let rigid = [&["--stress", "scene.toml"], &RIGID[..]].concat();
    refused(
        &dir,
        &rigid,
        "the inner ring has no stress below its contacts: it is rigid",
    );
    let limit = ["--stress", "scene.toml", "--set", "life.shear_limit=1.9 GPa"];
    refused(
        &dir,
        &limit,
        "life.shear_limit of 1900 MPa is above all stress below the contacts",
    );
    let large = ["--stress", "scene.toml", "--set", "life.shear_limit=3 GPa"];
    refused(&dir, &large, "life.shear_limit is 3 GPa; expected 0 to 2 GPa");
    let loose = [
        "--stress",
        "scene.toml",
        "--set",
        "shaft.z=-100 um",
        "--set",
        "shaft.x=locked",
        "--set",
        "shaft.y=locked",
        "--set",
        "effects.radial_force=none",
        "--set",
        "effects.axial_force=none",
    ];
    refused(
        &dir,
        &loose,
        "no ball is loaded, so nothing wears the raceways out",
    );
    let text = SCENE.replace(
        "[static]",
        &format!("[effects.fit.inner]\ninterference = \"20 um\"\n\n{SWEEP}"),
    );
    dir.write("sweep.toml", text);
    refused(
        &dir,
        &["--stress", "sweep.toml"],
        "is no single equilibrium; --stress takes a scene with [static]",
    );
}
