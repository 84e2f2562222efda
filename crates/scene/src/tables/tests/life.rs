//! `[life]`: what it reads as, and what it refuses.

use super::*;

/// The example with a table `[life]`.
fn with_life(keys: &str) -> String {
    EXAMPLE.replacen("[solver]", &format!("[life]\n{keys}\n\n[solver]"), 1)
}

/// Wrong: a key of the documentation would be refused or read in another unit.
#[test]
fn life_reads_as_its_documentation_says() {
    assert_eq!(parse(EXAMPLE, &[]).unwrap().life, None);
    assert_eq!(
        parse(&with_life(""), &[]).unwrap().life,
        Some(Life::default()),
        "every key is optional"
    );
    let keys = "contact_angle = \"15 deg\"\nrating = \"26.5 kN\"\nstatic_rating = \"18.6 kN\"\n\
                fatigue_limit = \"0.85 kN\"\ngrooves = \"reference\"\nreliability = 95\nspeed = \"30 rad/s\"\n\
                viscosity_class = 68\ntemperature = \"70 degC\"\nviscosity_at_100 = \"8.7 mm2/s\"\ncontamination = 0.6";
    let expected = Life {
        contact_angle: Some(15f64.to_radians()),
        rating: Some(26.5e3),
        static_rating: Some(18.6e3),
        fatigue_limit: Some(0.85e3),
        grooves: LifeGrooves::Reference,
        reliability: 95.0,
        speed: Some(30.0),
        oil: Some(Oil::Class {
            at_40: 68.0 * 1e-6,
            at_100: Some(8.7e-6),
            temperature: 343.15,
        }),
        contamination: Some(0.6),
        shear_limit: None,
    };
    assert_eq!(parse(&with_life(keys), &[]).unwrap().life, Some(expected));
    let oil = |keys: &str| parse(&with_life(keys), &[]).unwrap().life.unwrap().oil;
    assert_eq!(oil("viscosity_ratio = 2"), Some(Oil::Ratio(2.0)));
    assert_eq!(oil("viscosity = \"24 mm2/s\""), Some(Oil::Viscosity(24e-6)));
    let class = "viscosity_class = 5\ntemperature = \"40 degC\"";
    let class = oil(class);
    assert!(matches!(class, Some(Oil::Class { at_40, at_100: None, .. }) if (at_40 - 4.6e-6).abs() < 1e-20));
}

/// Wrong: a slip in `[life]` would give a life that nobody asked for.
#[test]
fn what_makes_no_sense_in_life_is_refused() {
    for (keys, part) in [
        (
            "rating = \"-1 kN\"",
            "life.rating is -1 kN; a rating must be positive (line ",
        ),
        (
            "static_rating = \"0 N\"",
            "life.static_rating is 0 N; a rating must be positive",
        ),
        (
            "fatigue_limit = \"-1 N\"",
            "life.fatigue_limit is -1 N; a rating must be positive",
        ),
        ("rating = 26500", "life.rating: 26500 is a number without a unit"),
        (
            "rating = \"9 mm\"",
            "\"9 mm\" is a length; expected a force such as",
        ),
        (
            "contact_angle = \"60 deg\"",
            "life.contact_angle is 60 deg; expected 0 deg to 45 deg; ISO 281 rates others as thrust bearings",
        ),
        (
            "contact_angle = \"-1 deg\"",
            "life.contact_angle is -1 deg; expected 0 deg to 45 deg",
        ),
        (
            "reliability = 92",
            "life.reliability is 92; expected 90, 95, 96, 97, 98 or 99 per cent",
        ),
        (
            "contamination = 0",
            "life.contamination is 0; the factor e_C is above 0 (much dirt) and at most 1 (clean)",
        ),
        ("contamination = 1.5", "life.contamination is 1.5; the factor e_C"),
        (
            "speed = \"0 rpm\"",
            "life.speed is 0 rpm; expected a speed of at most 1e5 rad/s",
        ),
        (
            "viscosity_ratio = -1",
            "life.viscosity_ratio is -1; kappa must be positive",
        ),
        (
            "viscosity = \"0 mm2/s\"",
            "life.viscosity is 0 mm2/s; a viscosity must be positive",
        ),
        (
            "viscosity = \"9 mm\"",
            "\"9 mm\" is a length; expected a kinematic viscosity such as \"12 mm2/s\"",
        ),
        (
            "viscosity_class = 50\ntemperature = \"70 degC\"",
            "life.viscosity_class is 50; expected a class of ISO 3448: 2, 3, 5, 7, 10, 15, 22, 32, 46, 68",
        ),
        (
            "viscosity_class = 68",
            "life.viscosity_class is 68, the viscosity at 40 degC; add life.temperature of the oil in the contacts",
        ),
        (
            "viscosity_class = 68\ntemperature = \"70 degC\"",
            "life.temperature is 70 degC; how an oil thins from 40 degC takes a second viscosity: add \
             life.viscosity_at_100 from its data sheet",
        ),
        (
            "viscosity_class = 68\ntemperature = \"400 degC\"\nviscosity_at_100 = \"8 mm2/s\"",
            "life.temperature is 400 degC; expected -60 degC to 300 degC",
        ),
        (
            "temperature = \"70\"",
            "\"70\" has no unit; expected a temperature such as \"70 degC\"",
        ),
        (
            "temperature = \"70 degC\"",
            "life.temperature does nothing without life.viscosity_class; add the class, or remove it",
        ),
        (
            "viscosity_class = 68\ntemperature = \"70 degC\"\nviscosity_at_100 = \"80 mm2/s\"",
            "life.viscosity_at_100 is 80 mm2/s; expected 2 mm2/s to less than the 68 mm2/s at 40 degC",
        ),
        (
            "viscosity_ratio = 2\nviscosity = \"24 mm2/s\"",
            "life.viscosity_ratio and life.viscosity both say how thick the oil is; keep one of them",
        ),
        (
            "grooves = \"mine\"",
            "life.grooves is \"mine\"; valid values are \"own\", \"reference\"",
        ),
        ("ratng = \"26 kN\"", "ratng"),
    ] {
        let message = message_of(&with_life(keys), &[]);
        assert!(message.contains(part), "{keys}: expected\n{part}\nin\n{message}");
    }
    let turning = DYNAMIC.replacen("[dynamic]", "[life]\nspeed = \"1800 rpm\"\n\n[dynamic]", 1);
    let part = "life.speed is given, but [speed] says how fast the rings turn; remove life.speed";
    assert!(message_of(&turning, &[]).contains(part));
    let swept = with_life("reliability = 95").replacen("effects.radial_force.value", "life.reliability", 1);
    assert!(message_of(&swept, &[]).contains("sweep.key is \"life.reliability\""));
}
