//! Scenes of motion in time, and what they say.

use dynamics::effects::RingDamping;
use dynamics::interactions::contact_damping::ContactDamping;

use super::*;

fn dynamic_of(text: &str) -> Dynamic {
    match parse(text, &[]).unwrap_or_else(|e| panic!("{e}")).analysis {
        Analysis::Dynamic(dynamic) => dynamic,
        other => panic!("no motion: {other:?}"),
    }
}

/// 1800 rpm, rad/s.
const SPEED: f64 = 60.0 * std::f64::consts::PI;

/// If this failed, the documentation would show a motion that the program refuses or reads as something else.
#[test]
fn the_example_of_motion_reads_as_it_says() {
    let scene = parse(DYNAMIC, &[]).unwrap_or_else(|e| panic!("{e}"));
    let expected = Dynamic {
        duration: 77e-3,
        step: 1e-5,
        n_steps: 7700,
        output_every: 10,
        integrator: IntegratorChoice::ChungHulbert { rho: 0.8 },
        contact: ContactScheme::DiscreteGradient,
        ledger_tolerance: 1e-6,
        halvings: 4,
        adaptive: Some(1e-4),
        start: Start::Given {
            displacement: [0.0, 0.0, 1e-6, 0.0, 0.0],
            velocity: [1e-3, 0.0, 0.0, 0.0, 0.0],
        },
    };
    assert_eq!(scene.analysis, Analysis::Dynamic(expected));
    let speed = scene.speed.as_ref().unwrap();
    assert_eq!(speed.inner.times, [0.0, 1e-3]);
    // One rounding of pi/30, one of the product.
    for (value, exact) in speed.inner.values.iter().zip([SPEED, 10.0 * SPEED]) {
        assert!((value / exact - 1.0).abs() < 4e-16, "{value} instead of {exact}");
    }
    assert!(speed.outer.is_zero());
    let effects = &scene.effects;
    assert!(effects.ball_centrifugal.is_some() && effects.frame_rotation.is_some());
    assert_eq!(effects.slip(), [0.0, 0.01]);
    let contact_damping = ContactDamping {
        coefficient: 50.0,
        full_approach: 1e-6,
    };
    assert_eq!(effects.contact_damping(), Some(contact_damping));
    let ring_damping = RingDamping {
        mass: 10.0,
        stiffness: 1e-7,
    };
    assert_eq!(effects.ring_damping(), Some(ring_damping));
    assert_eq!(scene.shaft.mass, 2.0);
    let inertia = scene.shaft.inertia;
    assert_eq!((inertia.transverse, inertia.polar), (3e-4, 5e-4));
    assert_eq!(scene.sweep_scenes().unwrap(), []);
}

/// If this failed, a short scene of motion would be refused, or a default would differ from what the example states.
#[test]
fn a_motion_needs_only_duration_and_step() {
    let (head, _) = DYNAMIC.split_once("[speed]").unwrap();
    let head = replace_line(head, "mass", "");
    let text = format!("{head}[dynamic]\nduration = \"1 ms\"\nstep = \"1 ms\"\n");
    let expected = Dynamic {
        duration: 1e-3,
        step: 1e-3,
        n_steps: 1,
        output_every: 1,
        integrator: IntegratorChoice::AverageAcceleration,
        contact: ContactScheme::DiscreteGradient,
        ledger_tolerance: 1e-6,
        halvings: 4,
        adaptive: None,
        start: Start::Static,
    };
    assert_eq!(dynamic_of(&text), expected);
    let scene = parse(&text, &[]).unwrap();
    assert_eq!((&scene.speed, scene.shaft.mass), (&None, 0.0));
    let effects = &scene.effects;
    assert!(effects.names().is_empty(), "{:?}", effects.names());
}

/// If this failed, balls that go round at the start would be asked for in vain, or where nothing turns.
#[test]
fn a_motion_starts_rolling_where_something_turns() {
    let (turning, _) = DYNAMIC.split_once("[dynamic.start.given]").unwrap();
    let rolling = format!("{turning}[dynamic.start.rolling]\n");
    assert_eq!(dynamic_of(&rolling).start, Start::Rolling);
    let message = message_of(&format!("{rolling}[dynamic.start.free]\n"), &[]);
    let expected =
        "[dynamic.start] has rolling and free; expected one of them, or none for static equilibrium";
    assert!(message.contains(expected), "{message}");
    let (head, _) = DYNAMIC.split_once("[speed]").unwrap();
    let standing =
        format!("{head}[dynamic]\nduration = \"1 ms\"\nstep = \"1 ms\"\n[dynamic.start.rolling]\n");
    let message = message_of(&standing, &[]);
    let expected = "[dynamic.start.rolling] starts with balls that go round, but nothing turns; add [speed]";
    assert!(message.contains(expected), "{message}");
}

/// If this failed, a motion that starts rolling would not start where it rests, balls that nothing presses would be
/// carried away by their inertia, or balls on courses of their own would get that of one.
#[test]
fn a_motion_that_starts_rolling_has_the_inertia_of_orbits_where_it_may() {
    let (turning, _) = DYNAMIC.split_once("[dynamic.start.given]").unwrap();
    let rolling = format!("{turning}[dynamic.start.rolling]\n");
    let has_inertia = |text: &str, overrides: &[&str]| {
        let scene = parse(text, overrides).unwrap();
        scene.effects.orbit_inertia.is_some()
    };
    assert!(has_inertia(&rolling, &[]));
    assert!(!has_inertia(
        &replace_line(&rolling, "[effects.ball_centrifugal]", ""),
        &[]
    ));
    let unbalance = "effects.unbalance={ mass = \"10 g\", eccentricity = \"1 um\" }";
    assert!(!has_inertia(&rolling, &[unbalance]));
    let at_rest = parse(turning, &[]).unwrap();
    assert!(at_rest.effects.orbit_inertia.is_none());
}

/// If this failed, the speeds of balls would follow other angles than asked for, or be asked for in vain.
#[test]
fn ball_speeds_are_for_effects_of_turning_balls() {
    let asked = |value: &str| replace_line(DYNAMIC, "# ball_speeds", &format!("ball_speeds = \"{value}\""));
    let of = |text: &str| parse(text, &[]).unwrap_or_else(|e| panic!("{e}")).ball_speeds;
    assert_eq!(of(DYNAMIC), BallSpeeds::FreeAngle);
    assert_eq!(of(&asked("free_angle")), BallSpeeds::FreeAngle);
    assert_eq!(of(&asked("outer_control")), BallSpeeds::OuterControl);
    let message = message_of(&asked("inner_control"), &[]);
    let expected = "speed.ball_speeds is \"inner_control\"; did you mean \"outer_control\"? valid values \
                    are \"free_angle\"";
    assert!(message.contains(expected), "{message}");
    let idle = replace_line(&asked("outer_control"), "[effects.ball_centrifugal]", "");
    let message = message_of(&idle, &[]);
    let expected =
        "speed.ball_speeds does nothing without [effects.ball_centrifugal] or [effects.gyroscopic_moment]";
    assert!(message.contains(expected), "{message}");
}

/// If this failed, a motion would be integrated with another scheme or with other numbers than the scene names.
#[test]
fn every_integrator_has_its_own_numbers() {
    let cases = [
        (
            "integrator = \"average_acceleration\"",
            IntegratorChoice::AverageAcceleration,
        ),
        (
            "integrator = \"chung_hulbert\"\nrho = 0",
            IntegratorChoice::ChungHulbert { rho: 0.0 },
        ),
        (
            "integrator = \"chung_hulbert\"\nrho = 1.0",
            IntegratorChoice::ChungHulbert { rho: 1.0 },
        ),
        (
            "integrator = \"hht\"\nalpha = 0.1",
            IntegratorChoice::Hht { alpha: 0.1 },
        ),
        (
            "integrator = \"newmark\"",
            IntegratorChoice::Newmark {
                beta: 0.25,
                gamma: 0.5,
            },
        ),
        (
            "integrator = \"newmark\"\nbeta = 0.3025\ngamma = 0.6",
            IntegratorChoice::Newmark {
                beta: 0.3025,
                gamma: 0.6,
            },
        ),
    ];
    for (keys, expected) in cases {
        assert_eq!(dynamic_of(&with_integrator(keys)).integrator, expected, "{keys}");
    }
    let pointwise = replace_line(DYNAMIC, "contact = ", "contact = \"pointwise\"");
    assert_eq!(dynamic_of(&pointwise).contact, ContactScheme::Pointwise);
}

/// If this failed, durations that fit would be refused because of round-off, or ones that do not would end early.
#[test]
fn a_duration_fits_its_step_up_to_round_off_only() {
    for (duration, step, n) in [
        ("0.3 s", "0.1 s", 3),
        ("1 s", "1 us", 1_000_000),
        ("7 min", "0.7 s", 600),
    ] {
        let text = replace_line(DYNAMIC, "duration", &format!("duration = \"{duration}\""));
        let text = replace_line(&text, "step", &format!("step = \"{step}\""));
        assert_eq!(dynamic_of(&text).n_steps, n, "{duration} of {step}");
    }
    let text = replace_line(DYNAMIC, "duration", "duration = \"77.0000002 ms\"");
    let message = message_of(&text, &[]);
    assert!(
        message.contains("the nearest duration that fits is 77 ms"),
        "{message}"
    );
}

/// If this failed, the outer ring would not turn, or a scene would have to give a speed to a ring that stands.
#[test]
fn each_ring_has_its_own_speed() {
    let of = |speed: &str| {
        let scene = parse(&replace_line(DYNAMIC, "inner = {", speed), &[]).unwrap_or_else(|e| panic!("{e}"));
        (scene.speed.unwrap(), scene.has_speed)
    };
    let ramp = "{ ramp = { from = \"0 rad/s\", to = \"5 rad/s\", start = \"1 ms\", duration = \"1 ms\" } }";
    let (alone, has) = of(&format!("outer = {ramp}"));
    assert!(alone.inner.is_zero() && has == [false, true]);
    assert_eq!((alone.outer.at(1.5e-3), alone.outer.at(1.0)), (2.5, 5.0));
    let (both, has) = of("inner = \"3 rad/s\"\nouter = \"-2 rad/s\"");
    assert_eq!((both.relative(0.0), has), (5.0, [true, true]));
}

/// If this failed, the centrifugal force of balls could not be studied without motion.
#[test]
fn a_scene_at_rest_may_have_a_constant_speed_for_the_centrifugal_force() {
    let text = at_rest("inner = \"1800 rpm\"");
    let scene = parse(&text, &[]).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(scene.analysis, Analysis::Static);
    let speed = scene.speed.unwrap();
    assert_eq!(
        (speed.inner.times.as_slice(), speed.inner.values.len()),
        (&[0.0][..], 1)
    );
    let sweep = "[sweep]\nkey = \"speed.inner\"\nvalues = [\"0 rpm\", \"10 rad/s\"]\n";
    let scene = parse(&text.replace("[static]\n", sweep), &[]).unwrap_or_else(|e| panic!("{e}"));
    let speeds: Vec<_> = scene
        .sweep_scenes()
        .unwrap()
        .into_iter()
        .map(|s| s.speed.unwrap().inner.values)
        .collect();
    assert_eq!(speeds, [[0.0], [10.0]]);
}
