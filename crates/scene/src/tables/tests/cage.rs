//! `[cage]`: what a free cage needs and what is refused.

use super::balls::{COULOMB, free};
use super::*;

const KEYS: [(&str, &str); 11] = [
    ("motion", "\"free\""),
    ("bore_diameter", "\"60 mm\""),
    ("outside_diameter", "\"70 mm\""),
    ("width", "\"10 mm\""),
    ("mass", "\"12 g\""),
    ("pocket_clearance", "\"0.2 mm\""),
    ("pocket_stiffness", "\"2e8 N/m^1.5\""),
    ("guidance", "\"outer_land\""),
    ("guidance_clearance", "\"0.3 mm\""),
    ("friction", "0.1"),
    ("restitution", "0.6"),
];

/// A scene with a free cage; `changes` give keys other values, or take them away where they are empty.
fn caged(changes: &[(&str, &str)]) -> String {
    let mut table = String::from("[cage]\n");
    for (key, value) in KEYS {
        let change = changes.iter().find(|(name, _)| *name == key);
        match change.map_or(value, |(_, value)| value) {
            "" => {}
            value => table += &format!("{key} = {value}\n"),
        }
    }
    for (key, value) in changes
        .iter()
        .filter(|(key, _)| KEYS.iter().all(|(name, _)| name != key))
    {
        table += &format!("{key} = {value}\n");
    }
    free(COULOMB, &table)
}

const ELASTIC: [(&str, &str); 3] = [
    ("pocket_stiffness", ""),
    ("young_modulus", "\"3 GPa\""),
    ("poisson_ratio", "0.4"),
];

/// Wrong: a pocket of a material would have another stiffness than Hertz's, here by the fits of Hamrock and Brewe
/// (1983) to his integrals: a ball of 9 mm in a cylinder 0.2 mm wider. They are within 3 % for such ellipses.
#[test]
fn a_pocket_of_a_material_is_as_stiff_as_a_ball_in_a_cylinder() {
    let cage = parse(&caged(&ELASTIC), &[]).unwrap().cage.unwrap();
    let compliance = (1.0 - 0.4f64.powi(2)) / 3e9 + (1.0 - 0.3f64.powi(2)) / 207e9;
    let (along, round) = (4.5e-3, 1.0 / (1.0 / 4.5e-3 - 1.0 / 4.6e-3));
    let ratio = round / along;
    let ellipticity = 1.0339 * f64::powf(ratio, 0.636);
    let second = 1.0003 + 0.5968 / ratio;
    let first = 1.5277 + 0.6023 * f64::ln(ratio);
    let radius = 1.0 / (1.0 / along + 1.0 / round);
    let root = (radius * second / (4.5 * first.powi(3))).sqrt();
    let expected = std::f64::consts::PI * ellipticity * 2.0 / compliance * root;
    assert!(
        (cage.stiffness / expected - 1.0).abs() < 0.03,
        "{} {expected}",
        cage.stiffness
    );
}

/// Wrong: mass and inertia of a tube, the radius of a land, or the offset of a pocket.
#[test]
fn a_cage_is_a_tube_with_its_land() {
    let cage = parse(&caged(&[]), &[]).unwrap().cage.unwrap();
    let squares = 0.03f64.powi(2) + 0.035f64.powi(2);
    assert!((cage.polar / (0.5 * 0.012 * squares) - 1.0).abs() < 1e-12);
    assert!((cage.transverse / (0.001 * (3.0 * squares + 1e-4)) - 1.0).abs() < 1e-12);
    assert_eq!(cage.land.unwrap().radius, 0.035);
    let dense = [
        ("mass", ""),
        ("density", "\"1400 kg/m3\""),
        ("guidance", "\"inner_land\""),
    ];
    let cage = parse(&caged(&dense), &[]).unwrap().cage.unwrap();
    let volume = std::f64::consts::PI * (0.035f64.powi(2) - 0.03f64.powi(2)) * 0.01;
    assert!((cage.mass / (1400.0 * volume) - 1.0).abs() < 1e-12);
    assert_eq!(cage.land.unwrap().radius, 0.03);
    let given = [("inertia_z", "\"1.3e-5 kg m2\""), ("inertia_t", "\"7e-6 kg m2\"")];
    let cage = parse(&caged(&given), &[]).unwrap().cage.unwrap();
    assert_eq!([cage.polar, cage.transverse], [1.3e-5, 7e-6]);
    assert!(parse(DYNAMIC, &[]).unwrap().cage.is_none());
}

/// Wrong: a cage that cannot be computed, or a key that does nothing, would be taken.
#[test]
fn a_cage_that_makes_no_sense_is_refused() {
    let pitch = "mm, on which the pockets stand";
    let cases: &[(&[(&str, &str)], &str)] = &[
        (
            &[("motion", "\"kinematic\"")],
            "[cage] has keys of a free cage, but cage.motion is \"kinematic\"; write motion = \"free\", or remove them",
        ),
        (
            &[("mass", "")],
            "[cage] needs mass, such as \"12 g\", or density and the dimensions of a tube",
        ),
        (
            &[("density", "\"1400 kg/m3\"")],
            "cage.mass and cage.density both say how heavy the cage is; keep one of them",
        ),
        (&[("mass", "\"0 g\"")], "cage.mass is 0 g"),
        (
            &[
                ("mass", ""),
                ("density", "\"1400 kg/m3\""),
                ("bore_diameter", ""),
                ("outside_diameter", ""),
                ("width", ""),
                ("guidance", ""),
                ("guidance_clearance", ""),
            ],
            "cage.density needs the tube that it fills: bore_diameter, outside_diameter, width; or give mass",
        ),
        (
            &[("mass", ""), ("density", "\"0 kg/m3\"")],
            "cage.density is 0 kg/m3; a density must be positive",
        ),
        (
            &[("inertia_t", "\"0 kg m2\"")],
            "cage.inertia_t is 0 kg m2; a moment of inertia must be positive",
        ),
        (
            &[("guidance_clearance", "\"6 mm\"")],
            "cage.guidance_clearance is 6 mm; expected a diametral clearance of 0 to 5.000 mm",
        ),
        (
            &[("restitution", "1.01")],
            "cage.restitution is 1.01; expected 0.05 to 1",
        ),
        (
            &[("pocket_clearance", "0.2")],
            "cage.pocket_clearance: 0.2 is a number without a unit; expected a length such as",
        ),
        (
            &[("speed", "\"10 rpm\"")],
            "unknown key \"speed\" in [cage]; speed belongs to [speed], [life], [heat]; valid keys are \"motion\",",
        ),
        (&[("bore_diameter", "\"68 mm\"")], pitch),
        (&[("outside_diameter", "\"61 mm\"")], pitch),
        (
            &[("width", "")],
            "[cage] needs width: bore_diameter, outside_diameter and width belong together",
        ),
        (&[("width", "\"-1 mm\"")], "cage.width is -1 mm"),
        (
            &[("bore_diameter", ""), ("outside_diameter", ""), ("width", "")],
            "[cage] needs inertia_z, or bore_diameter, outside_diameter and width to take it of a tube",
        ),
        (
            &[("bore_diameter", ""), ("outside_diameter", ""), ("width", "")],
            "[cage] needs bore_diameter, outside_diameter and width to meet the land of cage.guidance",
        ),
        (
            &[("inertia_z", "\"2e-5 kg m2\"")],
            "no body has more than twice as much about its axis as across it",
        ),
        (
            &[("pocket_clearance", "")],
            "[cage] needs pocket_clearance, the diametral clearance, such as \"0.2 mm\"",
        ),
        (
            &[("pocket_clearance", "\"-1 um\"")],
            "expected a diametral clearance of 0 to",
        ),
        (
            &[("pocket_clearance", "\"8 mm\"")],
            "expected a diametral clearance of 0 to",
        ),
        (
            &[("pocket_stiffness", "")],
            "[cage] needs pocket_stiffness, such as \"2e8 N/m^1.5\"",
        ),
        (
            &[("young_modulus", "\"3 GPa\"")],
            "cage.pocket_stiffness and cage.young_modulus both say how stiff pockets are; keep one of them",
        ),
        (
            &[("poisson_ratio", "0.4")],
            "cage.poisson_ratio does nothing without cage.young_modulus; add it, or remove this",
        ),
        (
            &[("pocket_stiffness", ""), ("young_modulus", "\"3 GPa\"")],
            "[cage] needs poisson_ratio beside young_modulus, such as 0.4",
        ),
        (
            &[ELASTIC[0], ("young_modulus", "\"3 MPa\""), ELASTIC[2]],
            "expected 0.1 to 500 GPa; polymer cages have 2 to 10 GPa",
        ),
        (
            &[ELASTIC[0], ELASTIC[1], ("poisson_ratio", "0.5")],
            "expected 0 to 0.49",
        ),
        (
            &[
                ELASTIC[0],
                ELASTIC[1],
                ELASTIC[2],
                ("pocket_clearance", "\"0 mm\""),
            ],
            "cage.young_modulus needs a pocket_clearance above 0",
        ),
        (
            &[("pocket_stiffness", "\"20 N/m^1.5\"")],
            "expected 1e4 to 1e12 N/m^1.5",
        ),
        (
            &[("guidance_clearance", "")],
            "[cage] needs guidance_clearance, the diametral clearance",
        ),
        (
            &[("guidance", "\"balls\"")],
            "cage.guidance_clearance does nothing where the balls guide the cage; write guidance = \"inner_land\" or \
             \"outer_land\", or remove it",
        ),
        (
            &[
                ("guidance_clearance", "\"0 mm\""),
                ("land_viscosity", "\"0.01 Pa s\""),
            ],
            "cage.land_viscosity needs a gap to shear; give guidance_clearance above 0, or remove it",
        ),
        (
            &[("land_viscosity", "\"0 Pa s\"")],
            "cage.land_viscosity is 0 Pa s",
        ),
        (
            &[("friction", "")],
            "[cage] needs friction, a coefficient such as 0.1; 0 is frictionless",
        ),
        (
            &[("friction", "3.0")],
            "cage.friction is 3; expected a coefficient of friction from 0 to 2",
        ),
        (
            &[("restitution", "")],
            "[cage] needs restitution, from 0.05 to 1, such as 0.6; 1 loses nothing",
        ),
        (
            &[("restitution", "0.0")],
            "cage.restitution is 0; expected 0.05 to 1",
        ),
        (
            &[("pocket_offsets", "[\"1 um\"]")],
            "cage.pocket_offsets has 1 values for 18 balls",
        ),
        (
            &[("guidance", "\"housing\"")],
            "cage.guidance is \"housing\"; valid values are \"balls\", \"inner_land\", \"outer_land\"",
        ),
    ];
    for (changes, expected) in cases {
        let message = message_of(&caged(changes), &[]);
        assert!(message.contains(expected), "{changes:?}: {message}");
    }
    let offsets = ["\"1 mm\""]
        .into_iter()
        .chain(["\"0 mm\""; 17])
        .collect::<Vec<_>>()
        .join(", ");
    let offsets = message_of(&caged(&[("pocket_offsets", &format!("[{offsets}]"))]), &[]);
    let expected = "cage.pocket_offsets[0] is 1 mm; expected at most a tenth of the ball, to either side";
    assert!(offsets.contains(expected), "{offsets}");
    let kinematic = message_of(&caged(&[]), &["balls.motion=\"kinematic\""]);
    let expected = "cage.motion is \"free\", but the balls are kinematic and would not feel it; write";
    assert!(kinematic.contains(expected), "{kinematic}");
}
