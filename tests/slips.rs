//! Slips of units beside the bearing, and what a sweep says of all its points.

use crate::remarks::{texts, turning};
use crate::util::{Dir, RIGID, with_line};

/// Wrong: units a thousand times off in the material of a housing or in oil, or diameters typed as radii, would pass
/// without a word.
#[test]
fn slips_of_units_beside_the_bearing_are_warned_of() {
    let effects = r#"[effects.fit.outer]
interference = "5 um"
housing_diameter = "160 mm"
young_modulus = "70 MPa"
density = "2.7 kg/m3"

[effects.temperature]
inner = { radii = ["60 mm", "80 mm"], values = ["40 degC", "60 degC"] }
outer = "40 degC"
balls = "40 degC"
reference = "20 degC"

[lubricant]
viscosity = "40 Pa s"
pressure_coefficient = "22 1/GPa"

[static]"#;
    let sets = [
        "materials.rings.expansion=12e-6 1/K",
        "materials.balls.expansion=12e-6 1/K",
    ];
    let (dir, outcome) = turning("run", effects, &sets);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let warnings = texts(&dir, "warnings");
    for part in [
        "effects.fit.outer.young_modulus is 70 MPa; shafts and housings have 0.4 GPa (plastics) to 1300 GPa (diamond)",
        "effects.fit.outer.density is 2.7 kg/m3; shafts and housings have 500 kg/m3 (plastics) to",
        "effects.temperature.inner.radii reach from 60.0 to 80.0 mm, and the ring lies between radii of 25.0 and",
        "the dynamic viscosity of the lubricant is 4.000e1 Pa s; oils in bearings have 1 mPa s",
    ] {
        assert!(
            warnings.iter().any(|text| text.starts_with(part)),
            "{part}\n{warnings:#?}"
        );
    }
}

/// Wrong: a sweep of the geometry would say of all points what follows from the value that none of them has.
#[test]
fn a_sweep_says_what_all_its_points_assume() {
    let text = with_line(
        "[static]",
        "[static]",
        "[sweep]\nkey = \"bearing.contact_angle\"\nvalues = [\"20 deg\", \"25 deg\"]",
    )
    .replace(
        "inner_raceway_diameter",
        "pitch_diameter = \"65 mm\"\ncontact_angle = \"15 deg\"\n# ",
    )
    .replace("outer_raceway_diameter", "# ");
    let dir = Dir::with_scene(&text);
    let run = [&["run", "scene.toml", "--out", "out"], &RIGID[..]].concat();
    let outcome = dir.raceway(&run);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(
        !outcome.stderr.contains("free contact angle 15"),
        "{}",
        outcome.stderr
    );
    let single = dir.raceway(
        &[
            &run[..2],
            &["--out", "one", "--set", "sweep.values=[\"15 deg\"]"],
            &RIGID[..],
        ]
        .concat(),
    );
    assert!(
        single.stderr.contains("free contact angle 15"),
        "{}",
        single.stderr
    );
}
