//! Scenes with probes: what they say, and those that cannot be.

use super::*;
use crate::tables::gauges::Across;
use crate::tables::probes::{Axes, ContactProbe, NodeProbe, SectionPoint};

/// The example of an equilibrium with more tables.
fn with_probe(tables: &str) -> String {
    format!("{EXAMPLE}\n{tables}\n")
}

/// If this failed, the documentation would show probes that the program refuses or places elsewhere.
#[test]
fn the_probes_of_the_example_read_as_they_say() {
    let probes = parse(DYNAMIC, &[]).unwrap_or_else(|e| panic!("{e}")).probes;
    let degree = std::f64::consts::PI / 180.0;
    let [node] = &probes.nodes[..] else {
        panic!("{probes:?}")
    };
    assert_eq!(
        (node.name.as_str(), node.ring, node.axes),
        ("po2", RingName::Outer, Axes::Cylindrical)
    );
    assert!((node.azimuth - 20.0 * degree).abs() < 1e-15);
    let SectionPoint::Groove(angle) = node.point else {
        panic!("{node:?}")
    };
    assert!((angle - 15.0 * degree).abs() < 1e-15);
    let contact = ContactProbe {
        name: "ball_1_inner".to_string(),
        ball: 1,
        ring: RingName::Inner,
        about: [0.0; 3],
    };
    assert_eq!(probes.contacts, [contact]);
    assert!(parse(EXAMPLE, &[]).unwrap().probes.is_empty());
}

/// If this failed, a probe anywhere in a ring would be read as one of the raceway, or a moment be about another point.
#[test]
fn probes_may_lie_anywhere_and_moments_be_about_any_point() {
    let text = with_probe(
        "[probes.node.rim]\nring = \"inner\"\nazimuth = \"0 deg\"\nr = \"30 mm\"\nz = \"-8 mm\"\naxes = \"cartesian\"\n\
         [probes.contact.b]\nball = 17\nring = \"outer\"\nabout = [\"1 mm\", \"2 mm\", \"-3 mm\"]",
    );
    let probes = parse(&text, &[]).unwrap_or_else(|e| panic!("{e}")).probes;
    let rim = NodeProbe {
        name: "rim".to_string(),
        ring: RingName::Inner,
        azimuth: 0.0,
        point: SectionPoint::Anywhere {
            radius: 30e-3,
            z: -8e-3,
        },
        axes: Axes::Cartesian,
        has_acceleration: false,
    };
    assert_eq!(probes.nodes, [rim]);
    assert_eq!(probes.contacts[0].about, [1e-3, 2e-3, -3e-3]);
}

/// If this failed, a slip in a probe would cost a run, or its message would not say which probe.
#[test]
fn wrong_probes_are_refused_by_name() {
    let node = "[probes.node.p]\nring = \"outer\"\nazimuth = \"0 deg\"\n";
    let cases = [
        (
            "[probes.p]\nring = \"outer\"".to_string(),
            "unknown key \"p\" in [probes]; valid keys are \"node\", \"contact\"",
        ),
        (
            "[probes.node.p]\nring = \"middle\"\nazimuth = \"0 deg\"".to_string(),
            "probes.node.p.ring is \"middle\"; valid values are \"inner\", \"outer\"",
        ),
        (
            "[probes.node.p]\nring = \"outer\"".to_string(),
            "[probes.node.p] has no key \"azimuth\", which is required",
        ),
        (
            format!("{node}r = \"38 mm\""),
            "probes.node.p needs its place in the section: either groove_angle such as \"15 deg\" for a point of the \
             raceway, or both r and z",
        ),
        (
            format!("{node}groove_angle = \"15 deg\"\nz = \"1 mm\""),
            "probes.node.p needs its place in the section",
        ),
        (
            format!("{node}groove_angle = \"91 deg\""),
            "probes.node.p.groove_angle is 91 deg; expected -90 to 90 deg",
        ),
        (
            format!("{node}r = \"-38 mm\"\nz = \"0 mm\""),
            "probes.node.p.r is -38 mm; a distance from the axis must be positive",
        ),
        (
            format!("{node}r = \"38 kN\"\nz = \"0 mm\""),
            "probes.node.p.r: \"38 kN\" is a force; expected a length",
        ),
        (
            "[probes.contact.c]\nball = 18\nring = \"inner\"".to_string(),
            "probes.contact.c.ball is 18; expected a whole number from 0 to 17",
        ),
        (
            "[probes.contact.c]\nball = 0\nring = \"inner\"\nabout = [\"0 mm\", \"1 km\", \"0 mm\"]"
                .to_string(),
            "probes.contact.c.about, y is",
        ),
        (
            "[probes.contact.\"a b\"]\nball = 0\nring = \"inner\"".to_string(),
            "\"a b\" is no name for a column; expected letters, digits, \"_\" and \"-\" only",
        ),
    ];
    for (tables, part) in cases {
        let message = message_of(&with_probe(&tables), &[]);
        assert!(message.contains(part), "expected\n{part}\nin\n{message}");
    }
    let on_raceway = with_probe(&format!("{node}groove_angle = \"15 deg\""));
    let message = message_of(&on_raceway, &["outer.flexible=false"]);
    let part = "probes.node.p.ring is \"outer\", but that ring is rigid and has no nodes; make it flexible or remove \
                the probe";
    assert!(message.contains(part), "expected\n{part}\nin\n{message}");
}

/// If this failed, a gauge would lie or look elsewhere than its scene says, or a tachometer be of another ring.
#[test]
fn gauges_and_tachometers_read_as_they_say() {
    let gauge = |more: &str| {
        with_probe(&format!(
            "[probes.gauge.g]\nring = \"outer\"\nsurface = \"seat\"\nazimuth = \"90 deg\"\nz = \"2 mm\"\n\
             length = \"3 mm\"\nwidth = \"1.5 mm\"\n{more}"
        ))
    };
    for (direction, degrees, across) in [
        ("hoop", 0.0, Across::Any),
        ("axial", 90.0, Across::Axial),
        ("radial", 90.0, Across::Radial),
        ("-30 deg", -30.0, Across::Any),
    ] {
        let text = gauge(&format!("direction = \"{direction}\""));
        let probes = parse(&text, &[]).unwrap_or_else(|e| panic!("{e}")).probes;
        let found = &probes.gauges[0];
        assert!((found.angle.to_degrees() - degrees).abs() < 1e-12);
        assert_eq!(
            (found.across, found.size, found.z, found.r),
            (across, [3e-3, 1.5e-3], Some(2e-3), None)
        );
    }
    let message = message_of(&gauge("direction = \"hoop\"\nr = \"0 mm\""), &[]);
    assert!(
        message.contains("probes.gauge.g.r is 0 mm; a distance from the axis must be positive"),
        "{message}"
    );
    let message = message_of(&gauge("direction = \"hoop\""), &["outer.flexible=false"]);
    let part = "probes.gauge.g.ring is \"outer\", but that ring is rigid and has no nodes";
    assert!(message.contains(part), "{message}");
    let tachometer = with_probe("[probes.tachometer.t]\nring = \"inner\"");
    let message = message_of(&tachometer, &[]);
    let part = "probes.tachometer.t.ring is \"inner\", but [speed] gives that ring no speed; expected a ring that \
                turns";
    assert!(message.contains(part), "{message}");
}
