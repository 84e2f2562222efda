//! Fits, temperatures and seat forms: values that make no sense, and their messages.

use dynamics::mounting::{RingTemperature, TemperatureSchedule};

use super::{EXAMPLE, message_of, parse, replace_line};

/// Settings of a scene and the essential part of the message.
const REFUSED: [(&[&str], &str); 33] = [
    (
        &[
            "effects.temperature={inner={times=[\"0 s\"], values=[\"20 degC\"]}, outer=\"20 degC\", balls=\"20 degC\"}",
        ],
        "effects.temperature.inner changes over time, but a scene at rest has no time; give one temperature",
    ),
    (
        &[
            "effects.temperature={inner=\"20 degC\", outer=\"20 degC\", balls={radii=[\"1 mm\"], values=[\"20 \
             degC\"]}}",
        ],
        "effects.temperature.balls is given by radius, which only rings are; give one temperature, or one over time",
    ),
    (
        &[
            "effects.temperature={inner={radii=[\"25 mm\", \"28 mm\"], values=[\"20 degC\"]}, outer=\"20 degC\", \
             balls=\"20 degC\"}",
        ],
        "effects.temperature.inner has 2 radii and 1 values; expected as many of both, at least one",
    ),
    (
        &[
            "effects.temperature={inner={radii=[\"28 mm\", \"25 mm\"], values=[\"20 degC\", \"30 degC\"]}, \
             outer=\"20 degC\", \
             balls=\"20 degC\"}",
        ],
        "effects.temperature.inner.radii[1] is 25 mm; radii must grow, the one before is 28 mm",
    ),
    (
        &[
            "effects.temperature={inner={radii=[\"0 mm\"], values=[\"20 degC\"]}, outer=\"20 degC\", balls=\"20 \
             degC\"}",
        ],
        "effects.temperature.inner.radii[0] is 0 mm; a radius must be positive",
    ),
    (
        &[
            "effects.temperature={inner={radii=[\"25 mm\"], values=[\"400 degC\"]}, outer=\"20 degC\", \
             balls=\"20 degC\"}",
        ],
        "effects.temperature.inner.values[0] is 400 degC; expected -200 degC to 350 degC",
    ),
    (
        &["effects.temperature={inner={values=[\"20 degC\"]}, outer=\"20 degC\", balls=\"20 degC\"}"],
        "effects.temperature.inner needs a temperature, or times and values, or ramp, or of a ring radii and values",
    ),
    (
        &[
            "effects.temperature={inner={ramp={from=\"20 degC\", to=\"500 degC\", start=\"0 s\", duration=\"0 s\"}}, \
             outer=\"20 degC\", balls=\"20 degC\"}",
        ],
        "effects.temperature.inner.ramp.duration is 0 s; a duration must be positive",
    ),
    (
        &[
            "effects.temperature={inner={ramp={from=\"20 degC\", to=\"500 degC\", start=\"0 s\", duration=\"1 s\"}}, \
             outer=\"20 degC\", balls=\"20 degC\"}",
        ],
        "effects.temperature.inner.ramp.to is 500 degC; expected -200 degC to 350 degC",
    ),
    (
        &[
            "effects.temperature={inner={times=[\"1 s\", \"0 s\"], values=[\"20 degC\", \"30 degC\"]}, \
             outer=\"20 degC\", \
             balls=\"20 degC\"}",
        ],
        "effects.temperature.inner.times[1] is 0 s; times must grow, the one before is 1 s",
    ),
    (
        &["effects.temperature={inner=60, outer=\"20 degC\", balls=\"20 degC\"}"],
        "expected a temperature such as \"70 degC\" or a table over time or radius",
    ),
    (
        &["effects.fit={}"],
        "[effects.fit] has no ring; add [effects.fit.inner] or [effects.fit.outer], or remove it",
    ),
    (
        &["effects.fit.inner={}"],
        "[effects.fit.inner] has no key \"interference\", which is required",
    ),
    (
        &["effects.fit.inner.interference=\"10 mm\""],
        "effects.fit.inner.interference is 10 mm; that is 20.00 % of the diameter of 50 mm, no ring takes more",
    ),
    (
        &[
            "effects.fit.inner.interference=\"10 um\"",
            "effects.fit.inner.shaft_bore=\"50 mm\"",
        ],
        "effects.fit.inner.shaft_bore is 50 mm; expected 0 mm (a solid shaft) to less than the bore of the",
    ),
    (
        &[
            "effects.fit.inner.interference=\"10 um\"",
            "effects.fit.inner.housing_diameter=\"90 mm\"",
        ],
        "housing_diameter",
    ),
    (
        &["effects.fit.outer.interference=\"5 um\""],
        "[effects.fit.outer] has no key \"housing_diameter\", which is required",
    ),
    (
        &[
            "effects.fit.outer.interference=\"5 um\"",
            "effects.fit.outer.housing_diameter=\"80 mm\"",
        ],
        "effects.fit.outer.housing_diameter is 80 mm; expected more than the outside diameter of the bearing, 80 mm",
    ),
    (
        &[
            "effects.fit.outer.interference=\"5 um\"",
            "effects.fit.outer.housing_diameter=\"120 mm\"",
            "effects.fit.outer.shaft_bore=\"1 mm\"",
        ],
        "shaft_bore",
    ),
    (
        &[
            "effects.fit.inner.interference=\"10 um\"",
            "effects.fit.inner.young_modulus=\"0 GPa\"",
        ],
        "effects.fit.inner.young_modulus is 0 GPa; a modulus must be positive",
    ),
    (
        &[
            "effects.fit.inner.interference=\"10 um\"",
            "effects.fit.inner.poisson_ratio=0.5",
        ],
        "effects.fit.inner.poisson_ratio is 0.5; expected 0 to below 0.5, steel has 0.3",
    ),
    (
        &["effects.temperature={inner=\"60 degC\", outer=\"500 degC\", balls=\"60 degC\"}"],
        "effects.temperature.outer is 500 degC; expected -200 degC to 350 degC, where rings are elastic as they are",
    ),
    (
        &["effects.temperature={inner=\"60\", outer=\"50 degC\", balls=\"60 degC\"}"],
        "\"60\" has no unit; expected a temperature such as \"70 degC\"",
    ),
    (
        &["effects.temperature={inner=\"60 degC\", outer=\"50 degC\"}"],
        "[effects.temperature] has no key \"balls\", which is required",
    ),
    (
        &[
            "effects.temperature={inner=\"60 degC\", outer=\"50 degC\", balls=\"60 degC\", shaft_expansion=\"1 /K\"}",
        ],
        "effects.temperature.shaft_expansion is 1 /K; expected at most 1e-3 /K",
    ),
    (
        &["materials.rings.expansion=\"11.5e-6\""],
        "\"11.5e-6\" has no unit, of which \"/K\", \"1/K\", \"/degC\", \"1/degC\" are known; expected a thermal \
         expansion such as \"11.5e-6 /K\"",
    ),
    (
        &["materials.rings.yield_strength=\"0 MPa\""],
        "materials.rings.yield_strength is 0 MPa; a strength must be positive",
    ),
    (
        &["effects.seat_form=[{ring=\"middle\", order=2, amplitude=\"1 um\"}]"],
        "effects.seat_form[0].ring is \"middle\"; expected \"inner\" or \"outer\"",
    ),
    (
        &["effects.seat_form=[]"],
        "effects.seat_form is empty; add a table [[effects.seat_form]], or remove it",
    ),
    (
        &["effects.seat_form=[{ring=\"inner\", order=0, amplitude=\"1 um\"}]"],
        "effects.seat_form[0].order is 0, which is an interference; give it as [effects.fit.inner]",
    ),
    (
        &["effects.seat_form=[{ring=\"outer\", order=1, amplitude=\"1 um\"}]"],
        "effects.seat_form[0].order is 1, which shifts the ring as a whole; expected 2 (an oval) or more",
    ),
    (
        &["effects.seat_form=[{ring=\"outer\", order=101, amplitude=\"1 um\"}]"],
        "effects.seat_form[0].order is 101; expected a whole number from 2 to 100",
    ),
    (
        &["effects.seat_form=[{ring=\"outer\", order=2, amplitude=\"1 mm\"}]"],
        "effects.seat_form[0].amplitude is 1 mm; that is 1.25 % of the seat's diameter, expected at most 0.5 %",
    ),
];

/// Wrong: a slip in a fit or a temperature would be computed.
#[test]
fn what_makes_no_sense_of_seats_and_temperatures_is_refused() {
    for (settings, expected) in REFUSED {
        let message = message_of(EXAMPLE, settings);
        assert!(message.contains(expected), "{settings:?}: {message}");
    }
}

/// Wrong: bodies would expand by a coefficient that nobody gave.
#[test]
fn temperatures_need_expansion() {
    let text = replace_line(EXAMPLE, "expansion", "");
    let set = "effects.temperature={inner=\"60 degC\", outer=\"50 degC\", balls=\"60 degC\"}";
    let message = message_of(&text, &[set]);
    let expected =
        "[effects.temperature] needs the thermal expansion of the rings; add materials.rings.expansion";
    assert!(message.contains(expected), "{message}");
    assert!(!message.contains("of the balls"), "{message}");
}

/// Wrong: a rigid ring would be given the form of a seat that it does not feel.
#[test]
fn a_rigid_ring_has_no_form_of_its_seat() {
    let form = "effects.seat_form=[{ring=\"inner\", order=2, amplitude=\"1 um\"}]";
    let message = message_of(EXAMPLE, &["inner.flexible=false", form]);
    let expected =
        "effects.seat_form[0] gives the inner ring the form of its seat, but it is rigid; give inner.mesh";
    assert!(message.contains(expected), "{message}");
}

/// Wrong: a clearance or contact angle of the unmounted bearing would make another bearing than its diameters.
#[test]
fn a_bearing_is_the_same_by_its_diameters_clearance_or_contact_angle() {
    let by = |key: &str| {
        let text = replace_line(EXAMPLE, "outer_raceway_diameter", key);
        parse(&text, &[]).unwrap().bearing.outer_raceway_diameter
    };
    // P_d = 27 um, A = 0.4 mm: cos a0 = 0.96625, P_e = 2 A sin a0.
    let sin = (1.0 - 0.96625f64 * 0.96625).sqrt();
    for key in [
        "radial_clearance = \"27 um\"".to_string(),
        format!("axial_clearance = \"{:.17} mm\"", 0.8 * sin),
        format!("free_contact_angle = \"{:.17} rad\"", sin.asin()),
    ] {
        assert!((by(&key) - 74.037e-3).abs() < 1e-15, "{key}");
    }
}

/// Wrong: a run without its seat forms could not be asked for on the command line.
#[test]
fn none_takes_out_a_list_of_tables() {
    let form = "[[effects.seat_form]]\nring = \"inner\"\norder = 2\namplitude = \"1 um\"\n";
    let text = format!("{EXAMPLE}\n{form}");
    assert_eq!(
        parse(&text, &[]).unwrap().effects.conditions().seat_forms.len(),
        1
    );
    let plain = parse(&text, &["effects.seat_form=none"]).unwrap();
    assert!(plain.effects.seat_form.is_none());
}

/// Wrong: keys of fits and temperatures would be lost on the way to the bearing.
#[test]
fn fits_and_temperatures_reach_the_conditions() {
    let settings = [
        "effects.fit.outer={interference=\"-5 um\", housing_diameter=\"160 mm\", young_modulus=\"70 GPa\"}",
        "effects.temperature={inner=\"60 degC\", outer=\"50 degC\", balls=\"65 degC\", housing=\"40 degC\"}",
        "effects.seat_form=[{ring=\"outer\", order=3, amplitude=\"2 um\", azimuth=\"90 deg\"}]",
    ];
    let conditions = parse(EXAMPLE, &settings).unwrap().effects.conditions();
    let fit = conditions.fits[1].unwrap();
    assert_eq!(
        (fit.interference, fit.partner_diameter, fit.young_modulus),
        (-5e-6, 160e-3, Some(70e9))
    );
    assert!(conditions.fits[0].is_none());
    let warm = conditions.temperatures.unwrap();
    let of = TemperatureSchedule::constant;
    assert_eq!(
        warm.rings,
        [333.15, 323.15].map(|kelvin| RingTemperature::Uniform(of(kelvin)))
    );
    assert_eq!(
        (warm.balls, warm.partners, warm.reference),
        (of(338.15), [None, Some(of(313.15))], 293.15)
    );
    let form = conditions.seat_forms[0];
    assert_eq!(
        (form.order, form.amplitude, form.azimuth),
        (3, 2e-6, std::f64::consts::FRAC_PI_2)
    );
    assert!(parse(EXAMPLE, &[]).unwrap().effects.conditions().is_none());
}
