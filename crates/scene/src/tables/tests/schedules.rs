//! Loads and shaft motions that change in time, speed ramps, the gyroscopic moment: what reads, and what is refused.

use super::*;

/// The example of motion with lines put before its first effect.
fn with_lines(lines: &str) -> String {
    replace_line(
        DYNAMIC,
        "[effects.axial_force]",
        &format!("{lines}\n[effects.axial_force]"),
    )
}

/// The schedule of the axial force, from its lines.
fn axial_schedule(lines: &str) -> Schedule {
    let text = replace_line(DYNAMIC, "value = \"2 kN\"", &format!("value = \"2 kN\"\n{lines}"));
    let scene = parse(&text, &[]).unwrap_or_else(|e| panic!("{e}"));
    scene.effects.axial_force.unwrap().schedule()
}

/// If this failed, a load would follow another course in time than its scene says, or a default would not be the
/// stated one.
#[test]
fn every_kind_of_schedule_reads_as_it_says() {
    let cases = [
        ("", Schedule::Constant),
        (
            "schedule.ramp = { start = \"1 ms\", duration = \"2 ms\" }",
            Schedule::Ramp {
                from: 0.0,
                to: 1.0,
                start: 1e-3,
                duration: 2e-3,
            },
        ),
        (
            "schedule = { ramp = { from = 1, to = -0.5, start = \"0 s\", duration = \"2 ms\" } }",
            Schedule::Ramp {
                from: 1.0,
                to: -0.5,
                start: 0.0,
                duration: 2e-3,
            },
        ),
        (
            "[effects.axial_force.schedule.step]\nat = \"5 us\"",
            Schedule::Step {
                at: 5e-6,
                before: 0.0,
                after: 1.0,
            },
        ),
        (
            "schedule.step = { at = \"5 us\", before = 1.0, after = 6.0 }",
            Schedule::Step {
                at: 5e-6,
                before: 1.0,
                after: 6.0,
            },
        ),
        (
            "[effects.axial_force.schedule.impact]\nstart = \"1 ms\"\nduration = \"0.5 ms\"",
            Schedule::Impact {
                start: 1e-3,
                duration: 0.5e-3,
            },
        ),
        (
            "schedule.harmonic = { frequency = \"50 Hz\" }",
            Schedule::Harmonic {
                frequency: 50.0,
                phase: 0.0,
                mean: 0.0,
                amplitude: 1.0,
            },
        ),
        (
            "schedule.harmonic = { frequency = \"1 kHz\", phase = \"2 rad\", mean = 1, amplitude = 0.2 }",
            Schedule::Harmonic {
                frequency: 1e3,
                phase: 2.0,
                mean: 1.0,
                amplitude: 0.2,
            },
        ),
        (
            "schedule.table = { times = [\"0 s\", \"1 ms\"], factors = [1, 0.5] }",
            Schedule::Table {
                times: vec![0.0, 1e-3],
                factors: vec![1.0, 0.5],
            },
        ),
    ];
    for (lines, expected) in cases {
        assert_eq!(axial_schedule(lines), expected, "{lines}");
    }
}

/// If this failed, only some loads would take a schedule, or one load would get the schedule of another.
#[test]
fn all_loads_and_shaft_motions_take_schedules() {
    let step = |at: &str| format!("schedule.step = {{ at = \"{at}\" }}");
    let text = with_lines(&format!(
        "[effects.radial_force]\nvalue = \"1 kN\"\ndirection = \"0 deg\"\n{}\n\
         [effects.moment]\nx = \"1 N m\"\ny = \"0 N m\"\n{}\n\
         [effects.gravity]\nacceleration = \"9.81 m/s2\"\ndirection = [1.0, 0.0, 0.0]\n{}",
        step("1 s"),
        step("2 s"),
        step("3 s")
    ));
    let text = replace_line(
        &text,
        "tilt_y",
        &format!("tilt_y = {{ value = \"1 mrad\", {} }}", step("4 s")),
    );
    let text = replace_line(&text, "y = ", "y = { value = \"-20 um\" }");
    let scene = parse(&text, &[]).unwrap_or_else(|e| panic!("{e}"));
    let expected = |at: f64| Schedule::Step {
        at,
        before: 0.0,
        after: 1.0,
    };
    let effects = scene.effects;
    assert_eq!(effects.axial_force.unwrap().schedule(), Schedule::Constant);
    assert_eq!(effects.radial_force.unwrap().schedule(), expected(1.0));
    assert_eq!(effects.moment.unwrap().schedule(), expected(2.0));
    assert_eq!(effects.gravity.unwrap().schedule(), expected(3.0));
    assert_eq!(scene.shaft.tilt_y, ShaftMotion::Prescribed(1e-3));
    assert_eq!(scene.shaft.schedules[4], expected(4.0));
    assert_eq!(scene.shaft.y, ShaftMotion::Prescribed(-20e-6));
    assert!(
        scene.shaft.schedules[..4]
            .iter()
            .all(|s| *s == Schedule::Constant)
    );
}

/// If this failed, a ring would not change its speed as the scene says.
#[test]
fn a_speed_ramp_is_linear_between_its_ends() {
    let ramp =
        "inner = { ramp = { from = \"1 rad/s\", to = \"3 rad/s\", start = \"1 s\", duration = \"2 s\" } }";
    let scene = parse(&replace_line(DYNAMIC, "inner = {", ramp), &[]).unwrap_or_else(|e| panic!("{e}"));
    let speed = scene.speed.unwrap();
    assert_eq!(
        (speed.inner.times, speed.inner.values),
        (vec![1.0, 3.0], vec![1.0, 3.0])
    );
}

/// If this failed, the shares of the gyroscopic moment would not be those of the scene, or not balance it.
#[test]
fn shares_of_the_gyroscopic_moment_complete_each_other() {
    for (keys, shares) in [
        ("", [0.0, 2.0]),
        ("inner_share = 1.0", [1.0, 1.0]),
        ("outer_share = 1.5", [0.5, 1.5]),
        ("inner_share = 0.7\nouter_share = 1.3", [0.7, 1.3]),
    ] {
        let text = with_lines(&format!("[effects.gyroscopic_moment]\n{keys}\n"));
        let scene = parse(&text, &[]).unwrap_or_else(|e| panic!("{e}"));
        let moment = scene.effects.gyroscopic_moment.unwrap();
        let found = moment.shares();
        assert_eq!([found.inner, found.outer], shares, "{keys}");
    }
    assert_eq!(parse(DYNAMIC, &[]).unwrap().effects.gyroscopic_moment, None);
}

/// Lines for the axial force and the message that refuses them.
const SCHEDULES: [(&str, &str); 15] = [
    (
        "schedule = {}",
        "effects.axial_force.schedule is empty; expected exactly one of ramp, step, impact, harmonic and table, or no \
         schedule",
    ),
    (
        "schedule = { step = { at = \"1 s\" }, impact = { start = \"1 s\", duration = \"1 s\" } }",
        "effects.axial_force.schedule has step and impact; keep exactly one",
    ),
    (
        "schedule = { stepp = { at = \"1 s\" } }",
        "unknown key \"stepp\" in [effects.axial_force.schedule]; did you mean \"step\"? valid keys \
         are \"ramp\", \"step\", \"impact\", \"harmonic\", \"table\"",
    ),
    (
        "schedule = \"ramp\"",
        "effects.axial_force.schedule: invalid type: string \"ramp\", expected a table with one of ramp, step, \
         impact, harmonic and table",
    ),
    (
        "[effects.axial_force.schedule.ramp]\nstart = \"1 ms\"",
        "[effects.axial_force.schedule.ramp] has no key \"duration\", which is required",
    ),
    (
        "schedule.ramp = { start = \"1 ms\", duration = \"0 s\" }",
        "effects.axial_force.schedule.ramp.duration is 0 s; a duration must be positive",
    ),
    (
        "schedule.ramp = { start = \"1 ms\", duration = \"1 mm\" }",
        "effects.axial_force.schedule.ramp.duration: \"1 mm\" is a length; expected a time such as \"10 us\"",
    ),
    (
        "schedule.ramp = { start = \"1 ms\", duration = \"1 s\", to = inf }",
        "effects.axial_force.schedule.ramp.to is inf; expected a finite factor",
    ),
    (
        "schedule.step = { at = \"1 ms\", after = nan }",
        "effects.axial_force.schedule.step.after is NaN; expected a finite factor",
    ),
    (
        "schedule.impact = { start = \"1 ms\", duration = \"-1 ms\" }",
        "effects.axial_force.schedule.impact.duration is -1 ms; a duration must be positive",
    ),
    (
        "schedule.harmonic = { frequency = \"0 Hz\" }",
        "effects.axial_force.schedule.harmonic.frequency is 0 Hz; a frequency must be positive",
    ),
    (
        "schedule.harmonic = { frequency = \"1 Hz\", phase = \"1 s\" }",
        "effects.axial_force.schedule.harmonic.phase: \"1 s\" is a time; expected an angle such as \"15 deg\"",
    ),
    (
        "schedule.table = { times = [\"1 s\"], factors = [] }",
        "effects.axial_force.schedule.table has 1 times and 0 factors; expected as many of both, at least one",
    ),
    (
        "schedule.table = { times = [\"1 s\", \"1000 ms\"], factors = [0, 1] }",
        "effects.axial_force.schedule.table.times[1] is 1000 ms; times must grow, the one before is 1 s",
    ),
    (
        "schedule.step = { at = \"1 ms\", after = 1e6 }",
        "effects.axial_force.value is 2 kN; times its schedule that is more than any bearing carries, check its unit \
         and factors",
    ),
];

/// If this failed, a schedule that makes no sense would load the bearing, or its message would not name key and rule.
#[test]
fn schedules_that_make_no_sense_are_refused() {
    for (lines, expected) in SCHEDULES {
        let text = replace_line(DYNAMIC, "value = \"2 kN\"", &format!("value = \"2 kN\"\n{lines}"));
        let message = message_of(&text, &[]);
        assert!(
            message.contains(expected),
            "{lines}: expected\n{expected}\nin\n{message}"
        );
        assert!(!message.contains(" problems:"), "{lines}: {message}");
    }
}

/// If this failed, an imposed displacement, a ramp of the speed or a share of the gyroscopic moment that makes no sense
/// would be computed.
#[test]
fn motions_speeds_and_shares_that_make_no_sense_are_refused() {
    let cases: [Case; 11] = [
        (
            "z = ",
            "z = { value = \"1 mm\", schedule.step = { at = \"0 s\", after = 5 } }",
            &[
                "shaft.z is 1 mm; a prescribed displacement must be less than a ball radius, at the peak of its \
                 schedule too",
            ],
        ),
        (
            "tilt_x",
            "tilt_x = { value = \"30 mrad\", schedule.harmonic = { frequency = \"1 Hz\", mean = 1 } }",
            &[
                "shaft.tilt_x is 30 mrad; a prescribed tilt must be small, at most 55 mrad, at the peak of its \
                 schedule too",
            ],
        ),
        (
            "z = ",
            "z = {}",
            &["[shaft.z] has no key \"value\", which is required"],
        ),
        (
            "z = ",
            "z = { value = \"free\" }",
            &["shaft.z.value: \"free\" does not begin with a number; expected a length such as \"9 mm\""],
        ),
        (
            "z = ",
            "z = { value = \"1 um\", ramp = 1 }",
            &["unknown key \"ramp\" in [shaft.z]; valid keys are \"value\", \"schedule\""],
        ),
        (
            "inner = {",
            "inner = { times = [\"0 s\"] }",
            &["speed.inner needs either both times and values, or ramp"],
        ),
        (
            "inner = {",
            "inner = { ramp = { from = \"1 rpm\", to = \"2 rpm\", start = \"0 s\", duration = \"0 s\" } }",
            &[
                "speed.inner.ramp.duration is 0 s; a duration must be positive; a ring cannot change its speed in no \
                 time",
            ],
        ),
        (
            "inner = {",
            "inner = { ramp = { from = \"1 rpm\", to = \"2e6 rpm\", start = \"0 s\", duration = \"1 s\" } }",
            &["speed.inner.ramp.to is 2e6 rpm; that is more than 1e5 rad/s"],
        ),
        (
            "[effects.axial_force]",
            "[effects.gyroscopic_moment]\ninner_share = 1\nouter_share = 2\n[effects.axial_force]",
            &[
                "[effects.gyroscopic_moment] has inner_share 1 and outer_share 2; their sum must be 2, or the moment \
                 is not balanced",
            ],
        ),
        (
            "[effects.axial_force]",
            "[effects.gyroscopic_moment]\ninner_share = nan\nouter_share = 1\n[effects.axial_force]",
            &["effects.gyroscopic_moment.inner_share is NaN; expected 0 to 2"],
        ),
        (
            "[effects.axial_force]",
            "[effects.gyroscopic_moment]\nshare = 2\n[effects.axial_force]",
            &[
                "unknown key \"share\" in [effects.gyroscopic_moment]; did you mean \"inner_share\" or \
             \"outer_share\"? valid keys are \"inner_share\", \"outer_share\"",
            ],
        ),
    ];
    assert_messages(DYNAMIC, &cases);
}

/// If this failed, an equilibrium would silently be computed with the load at t = 0, or without the speed that an
/// effect needs.
#[test]
fn a_scene_at_rest_has_no_schedules() {
    let constant = at_rest("inner = \"1800 rpm\"");
    let force = "value = \"2 kN\"\nschedule.ramp = { start = \"1 ms\", duration = \"2 ms\" }";
    let shaft = "z = { value = \"9 um\", schedule.step = { at = \"1 ms\" } }";
    let sweep = "[sweep]\nkey = \"shaft.mass\"\nvalues = [\"1 kg\"]\n";
    let advice =
        "but a scene at rest has no time; remove it, or give it time with [dynamic] or [quasi_static]";
    for (line, replacement, owner) in [
        ("value = \"2 kN\"", force, "effects.axial_force"),
        ("z = ", shaft, "shaft.z"),
    ] {
        let text = replace_line(&constant, line, replacement);
        let expected = format!("{owner}.schedule changes {owner} over time, {advice}");
        for text in [text.clone(), text.replace("[static]\n", sweep)] {
            let message = message_of(&text, &[]);
            assert!(message.contains(&expected), "expected\n{expected}\nin\n{message}");
        }
    }
    let gyroscopic = replace_line(
        &constant,
        "[effects.ball_centrifugal]",
        "[effects.gyroscopic_moment]",
    );
    assert!(parse(&gyroscopic, &[]).is_ok(), "the speed has something to do");
    let text = replace_line(&gyroscopic, "[speed]", "");
    let message = message_of(&replace_line(&text, "inner = \"1800 rpm\"", ""), &[]);
    let expected = "[effects.gyroscopic_moment] needs the speed of a ring; add [speed]";
    assert!(message.contains(expected), "{message}");
}

/// If this failed, a transient delivered with the program would not run, or not solve what its name says.
#[test]
fn the_delivered_transients_are_valid() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let load = |name: &str| {
        let path = folder.join(format!("{name}.toml"));
        let scene = Scene::load_with(&path, &[], MeshFiles::MayBeMissing).unwrap_or_else(|e| panic!("{e}"));
        let Analysis::Dynamic(dynamic) = &scene.analysis else {
            panic!("{name}: {:?}", scene.analysis);
        };
        assert_eq!(
            (dynamic.step, dynamic.contact),
            (2e-5, ContactScheme::DiscreteGradient),
            "{name}"
        );
        assert_eq!(
            (scene.shaft.tilt_x, scene.shaft.tilt_y),
            (ShaftMotion::Locked, ShaftMotion::Locked),
            "{name}"
        );
        for ring in [&scene.inner, &scene.outer] {
            assert_eq!(ring.section.map(|s| s.sectors), Some(90), "{name}");
        }
        scene
    };
    let step = load("7010c_radial_step");
    assert_eq!(
        (axial_of(&step), &step.speed),
        (Some((1e3, Schedule::Constant)), &None)
    );
    let radial = step.effects.radial_force.unwrap();
    let schedule = Schedule::Step {
        at: 0.1e-3,
        before: 0.0,
        after: 1.0,
    };
    assert_eq!((radial.value.si(), radial.schedule()), (5e3, schedule));
    let impact = load("7010c_impact");
    let schedule = Schedule::Impact {
        start: 1e-3,
        duration: 1e-3,
    };
    assert!(impact.effects.contact_damping().is_some() && impact.effects.ring_damping().is_some());
    assert_eq!(impact.effects.radial_force.unwrap().schedule(), schedule);
    let change = load("7010c_speed_change");
    let speed = change.speed.unwrap();
    assert_eq!(speed.inner.times, [1e-3, 2e-3]);
    assert!((speed.inner.values[1] / speed.inner.values[0] - 2.0).abs() < 1e-15);
    assert!(change.effects.ball_centrifugal.is_some());
}
