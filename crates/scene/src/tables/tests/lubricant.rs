//! The table of the lubricant.

use super::*;

/// The example of motion with a lubricant.
fn with_lubricant(keys: &str) -> String {
    format!("{DYNAMIC}\n[lubricant]\n{keys}\n")
}

/// Keys that are fine without a viscosity.
const XI: &str = "pressure_coefficient = \"22 1/GPa\"";

/// Wrong: an oil would have another viscosity than its class and temperature give.
#[test]
fn an_oil_has_its_dynamic_viscosity() {
    let oil = |keys: &str| {
        parse(&with_lubricant(&format!("{XI}\n{keys}")), &[])
            .unwrap()
            .lubricant
            .unwrap()
    };
    let given = oil("viscosity = \"40 mPa s\"");
    assert_eq!((given.lubricant.viscosity, given.roughness), (0.04, None));
    assert!((given.lubricant.pressure_coefficient / 2.2e-8 - 1.0).abs() < 1e-15);
    let class = oil("viscosity_class = 68\ntemperature = \"40 degC\"\ndensity = \"870 kg/m3\"");
    assert!((class.lubricant.viscosity / (68e-6 * 870.0) - 1.0).abs() < 1e-14);
    let rough = oil(
        "viscosity = \"1 Pa s\"\nroughness = { inner = \"0.1 um\", outer = \"0.2 um\", balls = \"20 nm\" }",
    );
    let rough = rough.roughness.unwrap();
    assert!((rough.raceways[1] - 0.2e-6).abs() < 1e-20 && (rough.balls - 2e-8).abs() < 1e-20);
}

/// Wrong: a slip in a lubricant would be computed, or do nothing without a word.
#[test]
fn what_makes_no_sense_of_a_lubricant_is_refused() {
    for (keys, expected) in [
        (
            XI.to_string(),
            "[lubricant] has no viscosity; add viscosity, such as \"40 mPa s\", or viscosity_class with",
        ),
        (
            format!("{XI}\nviscosity = \"40 mPa s\"\nviscosity_class = 68"),
            "lubricant.viscosity and lubricant.viscosity_class both say how thick the oil is; keep one of them",
        ),
        (
            format!("{XI}\nviscosity_class = 68\ntemperature = \"40 degC\""),
            "lubricant.viscosity_class is a kinematic viscosity; add lubricant.density of the oil, such as",
        ),
        (
            format!("{XI}\nviscosity_class = 68\ndensity = \"870 kg/m3\""),
            "lubricant.viscosity_class is 68, the viscosity at 40 degC; add lubricant.temperature of the oil in the",
        ),
        (
            format!("{XI}\nviscosity = \"40 mPa s\"\ndensity = \"870 kg/m3\""),
            "lubricant.density does nothing without lubricant.viscosity_class; add the class, or remove it",
        ),
        (
            format!("{XI}\nviscosity = \"-1 Pa s\""),
            "lubricant.viscosity is -1 Pa s; a viscosity must be positive",
        ),
        (
            "viscosity = \"40 mPa s\"\npressure_coefficient = \"22 1/MPa\"".to_string(),
            "lubricant.pressure_coefficient is 22 1/MPa; expected above 0 to 100 1/GPa, mineral oils have 15 to 30",
        ),
        (
            format!("{XI}\nviscosity = \"40 mPa s\"\nlift_load = \"-3 N\""),
            "lubricant.lift_load is -3 N; a load must be positive",
        ),
        (
            format!("{XI}\nviscosity = \"40 mPa s\"\nlift_load = \"300 N\""),
            "lubricant.lift_load gives films of one thickness, but [speed] changes; give a constant speed, or remove",
        ),
        (
            format!(
                "{XI}\nviscosity = \"40 mPa s\"\n\
                 roughness = {{ inner = \"0.1 mm\", outer = \"0.1 um\", balls = \"0.1 um\" }}"
            ),
            "lubricant.roughness.inner is 0.1 mm; expected above 0 to 10 um, ground raceways have 0.02 um to 0.2 um",
        ),
    ] {
        let message = message_of(&with_lubricant(&keys), &[]);
        assert!(message.contains(expected), "{keys}: {message}");
    }
    let still = format!("{EXAMPLE}\n[lubricant]\n{XI}\nviscosity = \"40 mPa s\"\n");
    let message = message_of(&still, &[]);
    let expected =
        "[lubricant] makes no film in a bearing that stands still; add [speed] with inner = \"1800 rpm\"";
    assert!(message.contains(expected), "{message}");
}
