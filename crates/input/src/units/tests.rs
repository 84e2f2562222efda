//! Tests of quantities: values, messages, and writing back.

use super::kind::KINDS;
use super::*;

/// Text, value in SI, kind.
const VALUES: [(&str, f64, usize); 60] = [
    ("9 mm", 9e-3, LENGTH),
    ("9mm", 9e-3, LENGTH),
    ("+9.0e0 mm", 9e-3, LENGTH),
    ("56.01 mm", 56.01e-3, LENGTH),
    ("74.037 mm", 74.037e-3, LENGTH),
    ("0.3 um", 0.3e-6, LENGTH),
    ("12 \u{b5}m", 12e-6, LENGTH),
    ("12 \u{3bc}m", 12e-6, LENGTH),
    ("5 nm", 5e-9, LENGTH),
    ("1.5 cm", 0.015, LENGTH),
    ("0 m", 0.0, LENGTH),
    (".5 m", 0.5, LENGTH),
    ("5. m", 5.0, LENGTH),
    ("2 kN", 2e3, FORCE),
    ("-1.5e3 N", -1500.0, FORCE),
    ("3 mN", 3e-3, FORCE),
    ("1 kg m/s2", 1.0, FORCE),
    ("1 kg.m.s^-2", 1.0, FORCE),
    ("1 kg*m s-2", 1.0, FORCE),
    ("1 kg·m·s⁻²", 1.0, FORCE),
    ("1 kg/(s2/m)", 1.0, FORCE),
    ("207 GPa", 207e9, STRESS),
    ("2.07e5 N/mm2", 2.07e11, STRESS),
    ("2.07e5 N/mm^2", 2.07e11, STRESS),
    ("2.07e5 N/mm²", 2.07e11, STRESS),
    ("3 bar", 3e5, STRESS),
    ("7800 kg/m3", 7800.0, DENSITY),
    ("7.8 g/cm3", 7800.0, DENSITY),
    ("7.8e-9 t/mm3", 7800.0, DENSITY),
    ("7.8e-9 t mm⁻³", 7800.0, DENSITY),
    // Digits of 9.31e5 * 1000^1.5 and 8.09e5 * 1000^1.5 in 40-digit decimal arithmetic.
    ("9.31e5 N/mm^1.5", 2.944_080_501_616_761e10, HERTZ_STIFFNESS),
    ("8.09e5 N/mm^(3/2)", 2.558_282_627_076_219e10, HERTZ_STIFFNESS),
    ("2 N/m^1.5", 2.0, HERTZ_STIFFNESS),
    ("15 deg", 0.261_799_387_799_149_4, ANGLE),
    ("15°", 0.261_799_387_799_149_4, ANGLE),
    ("0.5 rev", std::f64::consts::PI, ANGLE),
    ("0.1 mrad", 1e-4, ANGLE),
    ("3 N m", 3.0, MOMENT),
    ("3000 N.mm", 3.0, MOMENT),
    ("3e3 N*mm", 3.0, MOMENT),
    ("9.81 m/s2", 9.81, ACCELERATION),
    ("9.81 m/s/s", 9.81, ACCELERATION),
    ("10 us", 1e-5, TIME),
    ("2 min", 120.0, TIME),
    ("1800 rpm", 188.495_559_215_387_6, ANGULAR_SPEED),
    ("1800 rev/min", 188.495_559_215_387_6, ANGULAR_SPEED),
    ("188.5 rad/s", 188.5, ANGULAR_SPEED),
    ("20 kHz", 2e4, RATE),
    ("10 1/s", 10.0, RATE),
    ("5e-2 N s/mm", 50.0, DAMPING),
    ("250 g", 0.25, MASS),
    ("200 kg mm2", 2e-4, INERTIA),
    // Exact by the international pound and inch: 0.45359237 kg, 9.80665 m/s2, 25.4 mm.
    ("500 lbf", 2_224.110_807_630_25, FORCE),
    ("100 kgf", 980.665, FORCE),
    ("12 lbf in", 1.355_817_948_331_400_4, MOMENT),
    ("1 psi", 6_894.757_293_168_361, STRESS),
    ("30e3 ksi", 2.068_427_187_950_508_3e11, STRESS),
    ("30 Msi", 2.068_427_187_950_508_3e11, STRESS),
    ("2 lb", 0.907_184_74, MASS),
    ("0.5 ft", 0.1524, LENGTH),
];

/// If this failed, a scene would be solved with other numbers than its author typed. The tolerance is four
/// units in the last place: one for the number, the rest for factors such as pi/180 and powers such as
/// 10^4.5.
#[test]
fn quantities_have_their_si_value_to_rounding() {
    for (text, expected, kind) in VALUES {
        let any: AnyQuantity = text.parse().unwrap();
        let error = (any.si - expected).abs();
        assert!(
            error <= 1e-15 * expected.abs(),
            "{text}: {} instead of {expected}, error {error}",
            any.si
        );
        let found = kind_of_dimension(any.dimension).map(|k| k.name);
        assert_eq!(found, Some(KINDS[kind].name), "{text}");
    }
}

/// If this failed, "9 mm" would differ in its last bit from the 9e-3 of a formula, and comparisons would
/// fail.
#[test]
fn powers_of_ten_do_not_round() {
    for i in 1..2000 {
        let text = format!("{}.{:03}", i / 7, i);
        for (unit, power) in [("mm", -3), ("um", -6), ("m", 0), ("nm", -9)] {
            let read: Quantity<LENGTH> = format!("{text} {unit}").parse().unwrap();
            let typed: f64 = format!("{text}e{power}").parse().unwrap();
            assert_eq!(read.si().to_bits(), typed.to_bits(), "{text} {unit}");
        }
    }
}

fn error_of<const K: usize>(text: &str) -> String {
    text.parse::<Quantity<K>>().expect_err(text).to_string()
}

/// Wrong: a pressure would be suggested for a viscosity, and a missing '^' be called a product.
#[test]
fn hints_are_of_what_is_expected() {
    let text = error_of::<DYNAMIC_VISCOSITY>("40 cP");
    assert!(text.contains("(did you mean \"mPa s\"?)"), "{text}");
    let text = error_of::<VISCOSITY>("40 cSt");
    assert!(text.contains("(did you mean \"mm2/s\"?)"), "{text}");
    let (length, stress) = (error_of::<LENGTH>("40 MPb"), error_of::<STRESS>("40 MPb"));
    assert!(
        stress.contains("did you mean \"MPa\"") && !length.contains("did you mean"),
        "{length}"
    );
    let text = error_of::<HERTZ_STIFFNESS>("9.31e5 N/mm1.5");
    let hint = "cannot be read: a power with a decimal point needs '^', write \"mm^1.5\"; ";
    assert!(text.contains(hint), "{text}");
    assert_eq!("9 m2.s".parse::<AnyQuantity>().unwrap().si, 9.0);
}

/// If this failed, a wrong unit would be accepted or its message would not say what was typed and what is
/// right.
#[test]
fn wrong_texts_are_refused_with_the_text_and_an_example() {
    let length = "expected a length such as \"9 mm\"";
    let cases = [
        ("9 N", "\"9 N\" is a force; "),
        ("9 deg", "\"9 deg\" is an angle; "),
        ("9 mm2", "\"9 mm2\" is a quantity in m^2; "),
        ("9 N s2/kg2", "\"9 N s2/kg2\" is a quantity in kg^-1 m; "),
        ("9", "\"9\" has no unit; "),
        ("9e3", "\"9e3\" has no unit; "),
        ("", "\"\" does not begin with a number; "),
        ("mm", "\"mm\" does not begin with a number; "),
        ("nine mm", "\"nine mm\" does not begin with a number; "),
        ("nan mm", "\"nan mm\" is not a finite number; "),
        ("-inf mm", "\"-inf mm\" is not a finite number; "),
        ("1e400 mm", "\"1e400 mm\" is not a finite number; "),
        (
            "1e99999999999999999999 mm",
            "\"1e99999999999999999999 mm\" is not a finite number; ",
        ),
        ("9 furlong", "\"9 furlong\" has the unknown unit \"furlong\"; "),
        (
            "9 MM",
            "\"9 MM\" has the unknown unit \"MM\" (did you mean \"mm\"?); ",
        ),
        (
            "9 Nm",
            "\"9 Nm\" has the unknown unit \"Nm\" (did you mean \"N m\"?); ",
        ),
        (
            "9 kNmm",
            "\"9 kNmm\" has the unknown unit \"kNmm\" (did you mean \"kN mm\"?); ",
        ),
        (
            "9 Kn",
            "\"9 Kn\" has the unknown unit \"Kn\" (did you mean \"kN\"?); ",
        ),
        (
            "9 Mpa",
            "\"9 Mpa\" has the unknown unit \"Mpa\" (did you mean \"MPa\"?); ",
        ),
        (
            "9,5 mm",
            "\"9,5 mm\" cannot be read: numbers have a decimal point, 9.5; ",
        ),
        (
            "9 kg/m s",
            "cannot be read: a product after '/' is ambiguous, write \"kg/(m s)\" or \"kg s/m\"; ",
        ),
        ("9 m/", "cannot be read: it ends where a unit is needed; "),
        ("9 (m", "cannot be read: a parenthesis is not closed; "),
        ("9 m)", "cannot be read: unexpected ')'; "),
        ("9 m^", "cannot be read: \"\" is not a power; "),
        ("9 m^0", "cannot be read: the power 0 is zero or larger than 12; "),
        (
            "9 m^99",
            "cannot be read: the power 99 is zero or larger than 12; ",
        ),
        (
            "9 m^(1/2",
            "cannot be read: the parenthesis of a power is not closed; ",
        ),
        (
            "9 ((((((((((m))))))))))",
            "cannot be read: too many nested parentheses; ",
        ),
    ];
    for (text, expected) in cases {
        let message = error_of::<LENGTH>(text);
        assert!(
            message.contains(&format!("{expected}{length}")),
            "{text}: {message}"
        );
    }
}

/// If this failed, "30 Hz" would turn the ring 30 times or 4.8 times per second, whichever the program takes it
/// for.
#[test]
fn a_frequency_is_no_angular_speed_and_the_message_says_why() {
    let why = "which does not say whether it counts revolutions or radians";
    for text in ["30 Hz", "30 1/s"] {
        assert_eq!(
            error_of::<ANGULAR_SPEED>(text),
            format!("{text:?} is a rate, {why}; expected an angular speed such as \"1800 rpm\"")
        );
    }
    assert!(!error_of::<LENGTH>("30 Hz").contains(why));
    assert!(!error_of::<ANGULAR_SPEED>("30 m").contains(why));
}

/// If this failed, some slip of the keyboard would crash the program instead of giving a message.
#[test]
fn no_short_text_panics() {
    let alphabet = [
        "9", "-", ".", "e", "m", "/", "^", "(", ")", " ", "1", "³", "⁻", "µ", "N", "°",
    ];
    let n = alphabet.len();
    for code in 0..n.pow(4) {
        let text: String = (0..4).map(|i| alphabet[code / n.pow(i) % n]).collect();
        if let Ok(any) = text.parse::<AnyQuantity>() {
            assert!(any.si.is_finite(), "{text}");
        }
    }
}

/// If this failed, a value computed by the program (a sweep's step) would change on its way through the text.
#[test]
fn a_formatted_si_value_reads_back_as_the_same_bits() {
    for k in 0..KINDS.len() - 1 {
        for i in 0..400 {
            let si = (f64::from(i) - 150.0) * 1.234_567_890_123e-11 * 1.31f64.powi(i % 180);
            let text = KINDS[k].format_si(si);
            let back: AnyQuantity = text.parse().unwrap();
            assert_eq!(back.si, si, "{text}");
            assert_eq!(
                kind_of_dimension(back.dimension).map(|k| k.name),
                Some(KINDS[k].name),
                "{text}"
            );
        }
    }
}

/// If this failed, messages would show values in units nobody thinks in.
#[test]
fn si_values_are_shown_with_the_prefix_of_their_size() {
    let shown = |si: f64, kind: usize| KINDS[kind].format_si(si);
    assert_eq!(shown(-9e-3, LENGTH), "-9 mm");
    assert_eq!(shown(0.05601, LENGTH), "56.01 mm");
    assert_eq!(shown(1.2e-5, LENGTH), "12 um");
    assert_eq!(shown(2e3, FORCE), "2 kN");
    assert_eq!(shown(207e9, STRESS), "207 GPa");
    assert_eq!(shown(0.0, FORCE), "0 N");
    assert_eq!(shown(3.0, MOMENT), "3.0 N m");
}

/// If this failed, a mesh would be read in the wrong unit.
#[test]
fn a_unit_alone_has_its_size() {
    assert_eq!(parse_unit("mm", &KINDS[LENGTH]), Ok(1e-3));
    assert_eq!(parse_unit(" um ", &KINDS[LENGTH]), Ok(1e-6));
    let message = |text: &str| parse_unit(text, &KINDS[LENGTH]).expect_err(text).to_string();
    assert_eq!(
        message("kg"),
        "\"kg\" is a mass; expected a unit of length such as \"mm\""
    );
    assert!(
        message("2 m").contains("cannot be read: unexpected '2'"),
        "{}",
        message("2 m")
    );
    assert!(
        message("").contains("it ends where a unit is needed"),
        "{}",
        message("")
    );
}

/// If this failed, a scene written back would say something else than the scene that was read.
#[test]
fn a_quantity_is_written_as_it_was_typed_and_compared_by_value() {
    let a: Quantity<LENGTH> = serde_json::from_str("\"9.0 mm\"").unwrap();
    assert_eq!(serde_json::to_string(&a).unwrap(), "\"9.0 mm\"");
    assert_eq!(a.to_string(), "9.0 mm");
    assert_eq!(a, Quantity::from_si(9e-3));
    assert_ne!(a, Quantity::from_si(9e-3 + 1e-17));
    assert_eq!(Quantity::<LENGTH>::from_si(9e-3).to_string(), "9 mm");
}
