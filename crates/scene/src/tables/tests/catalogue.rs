//! Bearings as catalogues give them.

use super::*;

/// The bearing of the documentation.
const CATALOGUE: &str = include_str!("../example_catalogue.toml");

/// The example with the bearing of the catalogue, without sections; `keys` place the raceways.
fn with_raceways(keys: &str) -> String {
    let bearing = replace_line(
        &replace_line(CATALOGUE, "contact_angle", ""),
        "pitch_diameter",
        keys,
    );
    let (_, rest) = EXAMPLE.split_once("[materials.rings]").unwrap();
    let (head, tail) = rest.split_once("[inner.section]").unwrap();
    let (_, tail) = tail.split_once("[outer]").unwrap();
    format!("{bearing}\n[materials.rings]{head}[outer]{tail}")
}

const PLACED: &str = "pitch_diameter = \"60 mm\"\ncontact_angle = \"40 deg\"";

fn bearing(keys: &str) -> Bearing {
    parse(&with_raceways(keys), &[]).unwrap().bearing
}

fn quantities(b: &Bearing) -> [f64; 4] {
    [
        b.inner_raceway_diameter,
        b.outer_raceway_diameter,
        b.inner_groove_radius,
        b.outer_groove_radius,
    ]
}

#[track_caller]
fn assert_same(keys: &str, expected: &Bearing) {
    for (a, b) in quantities(&bearing(keys)).into_iter().zip(quantities(expected)) {
        // Lengths are rounded to ten digits.
        assert!((a - b).abs() < 2e-9 * b, "{keys}: {a} instead of {b}");
    }
}

/// Wrong: the raceways would not have the pitch circle and the contact angle of the catalogue. The library computes
/// both from the raceways by another way, the ball between the groove centres.
#[test]
fn the_raceways_have_the_pitch_circle_and_the_angle_that_were_given() {
    let scene = parse(&with_raceways(PLACED), &[]).unwrap();
    let geometry = crate::build::geometry(&scene);
    assert!((geometry.pitch_diameter() - 60e-3).abs() < 1e-11);
    assert!((geometry.free_contact_angle().to_degrees() - 40.0).abs() < 1e-6);
    assert!((scene.bearing.inner_groove_radius - 0.52 * 11.906e-3).abs() < 1e-15);
    assert!((scene.bearing.outer_groove_radius - 0.53 * 11.906e-3).abs() < 1e-15);
}

/// Wrong: two ways to say the same bearing would be two bearings.
#[test]
fn every_two_numbers_that_place_the_raceways_give_the_same_bearing() {
    let expected = bearing(PLACED);
    let distance = 0.05 * 11.906;
    let angle = 40f64.to_radians();
    let inner = format!(
        "inner_raceway_diameter = \"{} m\"",
        expected.inner_raceway_diameter
    );
    let outer = format!(
        "outer_raceway_diameter = \"{} m\"",
        expected.outer_raceway_diameter
    );
    let pitch = "pitch_diameter = \"60 mm\"";
    let radial = format!(
        "radial_clearance = \"{} mm\"",
        2.0 * distance * (1.0 - angle.cos())
    );
    let axial = format!("axial_clearance = \"{} mm\"", 2.0 * distance * angle.sin());
    let contact = "contact_angle = \"40°\"";
    for place in [&inner, &outer, pitch] {
        for play in [&radial, &axial, contact] {
            assert_same(&format!("{place}\n{play}"), &expected);
        }
    }
    for pair in [
        [&inner, &outer],
        [&inner, &pitch.to_string()],
        [&outer, &pitch.to_string()],
    ] {
        assert_same(&pair.map(String::as_str).join("\n"), &expected);
    }
    let all = [&inner, &outer, pitch, &radial, &axial, contact].join("\n");
    assert_same(&all, &expected);
}

/// Wrong: interference, which has no contact angle, would move the balls off their circle, or lose its sign.
#[test]
fn interference_keeps_the_pitch_circle() {
    let b = bearing("pitch_diameter = \"60 mm\"\nradial_clearance = \"-10 um\"");
    assert!((b.clearance() + 10e-6).abs() < 1e-11);
    assert!((0.5 * (b.inner_raceway_diameter + b.outer_raceway_diameter) - 60e-3).abs() < 1e-11);
    let inner = format!("inner_raceway_diameter = \"{} m\"", b.inner_raceway_diameter);
    assert_same(&format!("{inner}\npitch_diameter = \"60 mm\""), &b);
    let outer = format!("outer_raceway_diameter = \"{} m\"", b.outer_raceway_diameter);
    assert_same(&format!("{outer}\npitch_diameter = \"60 mm\""), &b);
}

/// Wrong: a bearing that is not determined, or that contradicts itself, would be solved with numbers nobody gave.
#[test]
fn missing_and_contradicting_numbers_are_named() {
    let expected = "expected two of inner_raceway_diameter, outer_raceway_diameter and pitch_diameter, or one of \
                    them and \
                    one of contact_angle, radial_clearance and axial_clearance";
    let cases = [
        ("", "bearing has no key that places the raceways; "),
        (
            "contact_angle = \"40 deg\"",
            "bearing has only contact_angle to place the raceways; ",
        ),
        (
            "pitch_diameter = \"60 mm\"",
            "bearing has only pitch_diameter to place the raceways; ",
        ),
        (
            "contact_angle = \"40 deg\"\nradial_clearance = \"0.28 mm\"",
            "bearing has contact_angle, radial_clearance but no diameter to place the raceways; ",
        ),
    ];
    for (keys, start) in cases {
        let message = message_of(&with_raceways(keys), &[]);
        assert!(message.contains(&format!("{start}{expected}")), "{message}");
    }
    let cases = [
        (
            format!("{PLACED}\nradial_clearance = \"0.2 mm\""),
            "bearing.radial_clearance is 0.2 mm, but pitch_diameter and contact_angle give 278.547486 um; leave one of \
             the three out (line 9)",
        ),
        (
            format!("{PLACED}\ninner_raceway_diameter = \"48 mm\""),
            "but inner_raceway_diameter and pitch_diameter give",
        ),
        (
            "pitch_diameter = \"60 mm\"\ncontact_angle = \"95 deg\"".to_string(),
            "bearing.contact_angle is 95 deg; expected 0 deg to less than 90 deg, 15, 25 or 40 deg are usual (line 8)",
        ),
        (
            "pitch_diameter = \"60 mm\"\nradial_clearance = \"15 mm\"".to_string(),
            "bearing.radial_clearance is 15 mm; expected less than that, grooves whose centres are 595.3 um \
             apart allow \
             1.1906 mm: check its unit, um is usual",
        ),
        (
            "pitch_diameter = \"60 mm\"\naxial_clearance = \"2 mm\"".to_string(),
            "bearing.axial_clearance is 2 mm; expected 0 or more and less than what grooves whose centres are 595.3 um \
             apart allow 1.1906 mm",
        ),
        (
            format!("{PLACED}\ninner_groove_radius = \"6.2 mm\""),
            "bearing.inner_groove_radius and bearing.inner_curvature_ratio are the same length twice; leave one out",
        ),
        (
            "pitch_diameter = \"90 mm\"\ncontact_angle = \"40 deg\"".to_string(),
            "bearing.outer_raceway_diameter (from pitch_diameter and contact_angle) is 102.0731285 mm; it must be less \
             than bearing.outside_diameter, which is 80 mm (line 7)",
        ),
    ];
    for (keys, part) in cases {
        let message = message_of(&with_raceways(&keys), &[]);
        assert!(message.contains(part), "{part}\nis not in\n{message}");
    }
    let text = with_raceways(PLACED).replace("inner_curvature_ratio = 0.52", "inner_curvature_ratio = 5.2");
    let message = message_of(&text, &[]);
    let part = "bearing.inner_curvature_ratio is 5.2; expected more than 0.5 and at most 0.6; 0.515 to \
                0.53 is usual (line";
    assert!(message.contains(part), "{message}");
}

/// Wrong: the log would be silent about what the program filled in, or speak of what the scene says itself.
#[test]
fn what_is_filled_in_is_said() {
    assert_eq!(parse(EXAMPLE, &[]).unwrap().assumed, Vec::<String>::new());
    let text = with_raceways(PLACED);
    let text = replace_line(&text, "inner_curvature_ratio", "");
    let (head, rest) = text.split_once("[materials.rings]").unwrap();
    let (_, tail) = rest.split_once("[contact]").unwrap();
    let materials = "[materials]\nrings = \"bearing steel\"\nballs = \"si3n4\"\n";
    let section = "[outer.section]\nelement = \"hex8\"\nsectors = 84\ngroove_elements = 12\nthickness_elements = 3\n\
                   shoulder_elements = 2\n";
    let text = format!("{head}{materials}[contact]{tail}\n{section}");
    let scene = parse(&text, &[]).unwrap();
    let expected = [
        "bearing.inner_groove_radius is 0.52 of the ball diameter, 6.1911 mm, as in the ratings of ISO 281; \
         bearing.inner_curvature_ratio changes it",
        "bearing: pitch_diameter and contact_angle place the raceways at 47.9826 mm and 72.0731 mm; radial clearance \
         278.5 um, free contact angle 40.000 deg",
        "materials.rings is bearing steel: Young's modulus 207 GPa, Poisson's ratio 0.3, density 7800 kg/m3, \
         expansion 1.2e-5 /K (Harris, Rolling Bearing Analysis)",
        "materials.balls is silicon nitride: Young's modulus 310 GPa, Poisson's ratio 0.26, density 3200 kg/m3, \
         expansion 3e-6 /K (SKF, Super-precision bearings; Harris)",
        "outer.section.shoulder_diameters are 65.7629 mm on both sides, 0.26 ball diameters above the groove; a \
         catalogue \
         or a drawing may give others",
    ];
    assert_eq!(scene.assumed, expected);
    assert_eq!(scene.materials.balls.young_modulus, 310e9);
}

/// Wrong: an unknown name would be taken for a material, or the user would not learn the names.
#[test]
fn materials_without_a_name_here_are_refused() {
    let text = without_table("[materials.balls]");
    let text = text.replace(
        "[materials.rings]",
        "[materials]\nballs = \"cheese\"\n[materials.rings]",
    );
    let message = message_of(&text, &[]);
    let part = "materials.balls: \"cheese\" is no material with a name here; expected \"bearing steel\", \"silicon \
                nitride\", \"M50\", \"440C\", or a table with young_modulus, poisson_ratio and density";
    assert!(message.contains(part), "{message}");
    let meant = [
        ("steel", "bearing steel"),
        ("AISI 52100", "bearing steel"),
        ("AISI 440C", "440C"),
        ("ceramic", "silicon nitride"),
    ];
    for (typed, name) in meant {
        let message = message_of(&text.replace("cheese", typed), &[]);
        let part = format!("{typed:?} is no material with a name here; did you mean {name:?}? expected");
        assert!(message.contains(&part), "{message}");
    }
}

/// Wrong: the short names would not be known, not be found by `--set`, or their lines would be lost.
#[test]
fn bore_and_outside_have_short_names() {
    let text = EXAMPLE
        .replace("bore_diameter =", "bore =")
        .replace("outside_diameter =", "outside =");
    let scene = parse(&text, &["bearing.bore_diameter=48 mm"]).unwrap();
    assert_eq!(
        [scene.bearing.bore_diameter, scene.bearing.outside_diameter],
        [48e-3, 80e-3]
    );
    let message = message_of(&text.replace("\"50 mm\"", "\"57 mm\""), &[]);
    assert!(message.contains("bearing.bore_diameter is 57 mm"), "{message}");
    assert!(message.contains("(line 12)"), "{message}");
}

/// Wrong: the shoulders of the rule would not lie in their grooves, or meet; the angle to the edge is that of the rule.
#[test]
fn shoulders_of_the_rule_fit_every_contact_angle() {
    let section = |ring: &str| {
        format!(
            "[{ring}.section]\nelement = \"hex8\"\nsectors = 84\ngroove_elements = 12\nthickness_elements = 3\n\
             shoulder_elements = 2\n"
        )
    };
    for degrees in [0, 15, 25, 40, 45] {
        let keys = format!("pitch_diameter = \"60 mm\"\ncontact_angle = \"{degrees} deg\"");
        let text = with_raceways(&keys) + "\n" + &section("inner") + &section("outer");
        let scene = parse(&text, &[]).unwrap();
        let b = scene.bearing;
        let shoulder = scene.inner.section.unwrap().shoulder_diameters.at_high_z;
        let height = 0.5 * (shoulder - b.inner_raceway_diameter);
        let edge = (1.0 - height / b.inner_groove_radius).acos().to_degrees();
        assert!(edge >= f64::from(degrees) + 19.999, "{degrees}: {edge}");
        assert!(height >= 0.2 * b.ball_diameter - 1e-12);
    }
}
