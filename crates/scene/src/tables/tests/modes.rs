//! Scenes of natural modes.

use super::*;

/// The table of the documentation.
const MODES: &str = include_str!("../example_modes.toml");

/// The example with `[modes]` for its sweep.
fn modes(table: &str) -> String {
    format!("{}\n{table}", without_table("[sweep]"))
}

fn read(text: &str) -> Modes {
    match parse(text, &[]).unwrap_or_else(|e| panic!("{e}")).analysis {
        Analysis::Modes(modes) => modes,
        other => panic!("{other:?}"),
    }
}

/// If this failed, the documentation would show a table that the program refuses or reads as something else, or a
/// default would differ from what it says.
#[test]
fn the_example_of_the_documentation_reads_as_it_says() {
    let expected = Modes {
        number: 12,
        bodies: vec![ModeBody::Inner, ModeBody::Outer, ModeBody::Bearing],
        support: ModeSupport::Free,
        shift: Some(2e3),
    };
    assert_eq!(read(&modes(MODES)), expected);
    let short = Modes {
        number: 3,
        bodies: vec![ModeBody::Bearing],
        support: ModeSupport::AsHeld,
        shift: None,
    };
    assert_eq!(read(&modes("[modes]\nnumber = 3")), short);
}

/// If this failed, a scene would be delivered that does not run, or not what its name says.
#[test]
fn the_delivered_scene_is_valid() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/7010c_modes.toml");
    let scene = Scene::load_with(&path, &[], MeshFiles::MayBeMissing).unwrap_or_else(|e| panic!("{e}"));
    let Analysis::Modes(modes) = &scene.analysis else {
        panic!("{:?}", scene.analysis);
    };
    assert_eq!((modes.number, modes.bodies.len()), (14, 3));
    assert_eq!(
        (axial_of(&scene), scene.shaft.mass),
        (Some((2e3, Schedule::Constant)), 2.0)
    );
}

/// If this failed, modes would be computed that are not those of the scene: of a turning bearing, of a rigid ring,
/// about forces without energy.
#[test]
fn what_has_no_modes_is_refused() {
    let cases: [(&str, &[&str], &str); 10] = [
        (
            "number = 0",
            &[],
            "modes.number is 0; expected a whole number from 1 to 1000",
        ),
        ("number = 3\nbodies = []", &[], "modes.bodies is empty"),
        (
            "number = 3\nbodies = [\"inner\", \"inner\"]",
            &[],
            "modes.bodies names \"inner\" twice",
        ),
        (
            "number = 3\nbodies = [\"shaft\"]",
            &[],
            "modes.bodies[0] is \"shaft\"; valid values are \"inner\", \"outer\", \"bearing\"",
        ),
        (
            "number = 3\nsupport = \"free\"",
            &[],
            "modes.support is how rings alone are held, but modes.bodies names none",
        ),
        (
            "number = 3\nbodies = [\"outer\"]",
            &["outer.flexible=false"],
            "modes.bodies names \"outer\", but that ring is rigid; expected outer.flexible = true",
        ),
        (
            "number = 3",
            &["contact.mode=facet"],
            "contact.mode is \"facet\", whose forces have no energy",
        ),
        (
            "number = 3\nshift = \"0 Hz\"",
            &[],
            "modes.shift is 0 Hz; expected more than 0",
        ),
        ("number = 3\nshift = \"1 s\"", &[], "1 s"),
        (
            "number = 3\n[speed]\ninner = \"1800 rpm\"",
            &[],
            "[speed] is given, but [modes] are those of a bearing that does not turn",
        ),
    ];
    for (keys, overrides, expected) in cases {
        let message = message_of(&modes(&format!("[modes]\n{keys}")), overrides);
        assert!(message.contains(expected), "{keys}: {message}");
    }
    let both = message_of(&modes("[static]\n[modes]\nnumber = 3"), &[]);
    assert!(both.contains("the scene has both [static] and [modes]"), "{both}");
}
