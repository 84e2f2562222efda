//! A rigid ring with the inertia of its section.

use std::f64::consts::TAU;

use mesh::RingSection;

use super::{EXAMPLE, RingName, Scene, message_of, parse, with_line, without_table};

const RIGID: [&str; 2] = ["inner.flexible=false", "contact.mode=patch"];

fn rigid(text: &str) -> Scene {
    parse(text, &RIGID).unwrap_or_else(|e| panic!("{e}"))
}

/// Wrong: a rigid ring would have the mass of another body. Its volume by Pappus, and its moments between those of the
/// tubes from the bore to the bottom of the groove and to the shoulders.
#[test]
fn a_rigid_ring_has_the_inertia_of_its_section() {
    let scene = rigid(EXAMPLE);
    let inertia = scene.inner.inertia.unwrap();
    let section: RingSection = scene
        .inner
        .section
        .unwrap()
        .measures(&scene.bearing, RingName::Inner);
    let density = scene.materials.rings.density;
    assert!((inertia.mass / (density * section.volume().unwrap()) - 1.0).abs() < 1e-13);
    let tube = |outside: f64| {
        let (a, b, w) = (25e-3f64, 0.5 * outside, 16e-3f64);
        let mass = density * 0.5 * TAU * (b * b - a * a) * w;
        [
            mass,
            mass * ((a * a + b * b) / 4.0 + w * w / 12.0),
            mass * (a * a + b * b) / 2.0,
        ]
    };
    let (least, most) = (tube(56.01e-3), tube(60.4e-3));
    for (k, value) in [inertia.mass, inertia.transverse, inertia.polar]
        .into_iter()
        .enumerate()
    {
        assert!(
            least[k] < value && value < most[k],
            "{k}: {value:e}, {least:?}, {most:?}"
        );
    }
    let told = scene
        .assumed
        .iter()
        .any(|line| line.starts_with("the rigid inner ring has 0.095"));
    assert!(told, "{:?}", scene.assumed);
}

/// Wrong: a scene that does not ask for it, or whose ring has a mesh, would get another mass.
#[test]
fn inertia_of_a_section_is_for_rigid_rings_that_ask_for_it() {
    assert_eq!(rigid(&with_line("inertia", "")).inner.inertia, None);
    assert_eq!(parse(EXAMPLE, &[]).unwrap().inner.inertia, None);
}

/// Wrong: what is left out would not be refused, or in other words.
#[test]
fn what_a_section_cannot_give_is_refused() {
    let none = message_of(&without_table("[inner.section]"), &RIGID);
    assert!(
        none.contains(
            "inner.inertia is \"section\", but there is no table [inner.section]; describe the section"
        ),
        "{none}"
    );
    let beside = with_line(
        "shoulder_diameters",
        "shoulder_diameters = [\"60.4 mm\", \"56.4 mm\"]",
    );
    let beside = message_of(&beside, &RIGID);
    let expected = "where a rigid shaft has its own; expected at most 0.6";
    assert!(
        beside.contains("the centre of mass of that ring is -") && beside.contains(expected),
        "{beside}"
    );
    let outer = EXAMPLE.replacen("[outer]", "[outer]\ninertia = \"section\"\nflexible = false", 1);
    let outer = message_of(&outer, &[]);
    assert!(
        outer.contains("outer.inertia is there, but the outer ring does not move with the shaft; remove it"),
        "{outer}"
    );
    let word = message_of(&with_line("inertia", "inertia = \"mesh\""), &[]);
    assert!(
        word.contains("inner.inertia is \"mesh\"") && word.contains("\"section\""),
        "{word}"
    );
}
