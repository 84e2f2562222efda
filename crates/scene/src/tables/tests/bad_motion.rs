//! Scenes of motion in time that cannot be, and the essential parts of their messages.

use super::*;

/// Texts that must be refused: what is wrong with a line of the example of motion.
const INVALID: [Case; 55] = [
    (
        "halvings",
        "halvings = 17",
        &["dynamic.halvings is 17; expected a whole number from 0 to 16"],
    ),
    (
        "tolerance",
        "tolerance = 0.0",
        &[
            "dynamic.adaptive.tolerance is 0; expected 1e-9 to 0.1, the error of a step over the largest contact \
             approach",
        ],
    ),
    (
        "velocity_x",
        "velocity_tilt_x = \"1 rad/s\"",
        &[
            "[dynamic.start.given] moves tilt_x, which shaft.tilt_x does not leave free; remove it there or set \
           shaft.tilt_x = \"free\"",
        ],
    ),
    (
        "velocity_x",
        "velocity_x = \"1 mm/s\"\n[dynamic.start.free]",
        &["[dynamic.start] has free and given; expected one of them, or none for static equilibrium"],
    ),
    (
        "duration",
        "",
        &["[dynamic] has no key \"duration\", which is required"],
    ),
    ("step", "", &["[dynamic] has no key \"step\", which is required"]),
    (
        "duration",
        "duration = \"0 ms\"",
        &["dynamic.duration is 0 ms; a duration must be positive"],
    ),
    (
        "step",
        "step = \"-10 us\"",
        &["dynamic.step is -10 us; a step must be positive"],
    ),
    (
        "step",
        "step = \"10 um\"",
        &["dynamic.step: \"10 um\" is a length; expected a time such as \"10 us\""],
    ),
    (
        "duration",
        "duration = \"77.003 ms\"",
        &[
            "dynamic.duration is 77.003 ms; that is 7700.3 steps of 10 us, expected a whole number; the nearest \
             duration that fits is 77 ms",
        ],
    ),
    (
        "duration",
        "duration = \"2 us\"",
        &["that is 0.2 steps of 10 us, expected a whole number; the nearest duration that fits is 10 us"],
    ),
    (
        "step",
        "step = \"10 ps\"",
        &[
            "dynamic.step is 10 ps; the duration 77 ms has 7.7e9 of these steps, more than 1e8, check both units",
        ],
    ),
    (
        "output_every",
        "output_every = 0",
        &["dynamic.output_every is 0; expected a whole number from 1 to 100000000"],
    ),
    (
        "restart_every",
        "restart_every = 0",
        &["output.restart_every is 0; expected a whole number from 1 to 100000000"],
    ),
    (
        "displacement",
        "displacement = \"f16\"",
        &["output.displacement is \"f16\"; valid values are \"f32\", \"f64\""],
    ),
    (
        "integrator",
        "integrator = \"chung-hulbert\"",
        &[
            "dynamic.integrator is \"chung-hulbert\"; did you mean \"chung_hulbert\"? valid values \
             are \"average_acceleration\", \"chung_hulbert\", \"hht\", \"newmark\"",
        ],
    ),
    (
        "integrator",
        "",
        &[
            "dynamic.rho is 0.8; it belongs to the integrator \"chung_hulbert\", but the integrator is by default \
           \"average_acceleration\"",
        ],
    ),
    (
        "rho",
        "",
        &[
            "dynamic.rho is missing; the integrator \"chung_hulbert\" needs it, expected 0 to 1, the amplitude that \
             the highest frequencies keep per step, 0.8 is usual",
        ],
    ),
    (
        "rho",
        "rho = 1.1",
        &["dynamic.rho is 1.1; expected 0 to 1, the amplitude"],
    ),
    (
        "rho",
        "rho = nan",
        &["dynamic.rho is NaN; expected 0 to 1, the amplitude"],
    ),
    (
        "rho",
        "rho = 0.8\nalpha = 0.1",
        &[
            "dynamic.alpha is 0.1; it belongs to the integrator \"hht\", but the integrator is \"chung_hulbert\"",
        ],
    ),
    (
        "rho",
        "rho = 0.8\ngamma = 0.5",
        &[
            "dynamic.gamma is 0.5; it belongs to the integrator \"newmark\", but the integrator is \"chung_hulbert\"",
        ],
    ),
    (
        "contact = ",
        "contact = \"gradient\"",
        &[
            "dynamic.contact is \"gradient\"; did you mean \"discrete_gradient\"? valid \
             values are \"discrete_gradient\", \"pointwise\"",
        ],
    ),
    (
        "ledger_tolerance",
        "ledger_tolerance = 0",
        &[
            "dynamic.ledger_tolerance is 0; expected 1e-14 to 1, it is relative to the largest energy of the run",
        ],
    ),
    (
        "ledger_tolerance",
        "ledger_tolerence = 1e-6",
        &["unknown key \"ledger_tolerence\" in [dynamic]; did you mean \"ledger_tolerance\"?"],
    ),
    (
        "[dynamic]",
        "[static]\n[dynamic]",
        &["the scene has both [static] and [dynamic]; keep exactly one analysis"],
    ),
    (
        "[dynamic]",
        "[static]\n[sweep]\nkey = \"shaft.x\"\n[dynamic]",
        &["the scene has all of [static], [sweep], [dynamic]; keep exactly one analysis"],
    ),
    (
        "mass = \"2 kg\"",
        "mass = \"-2 kg\"",
        &["shaft.mass is -2 kg; expected 0 to 1e6 kg"],
    ),
    (
        "transverse_inertia",
        "transverse_inertia = \"-3e-4 kg m2\"",
        &["shaft.transverse_inertia is -3e-4 kg m2; expected 0 to 1e6 kg m2, about the axis point"],
    ),
    (
        "transverse_inertia",
        "transverse_inertia = \"3e-4 kg\"",
        &[
            "shaft.transverse_inertia: \"3e-4 kg\" is a mass; expected a moment of inertia such as \"2e-4 kg m2\"",
        ],
    ),
    (
        "transverse_inertia",
        "transverse_inertia = \"2e-4 kg m2\"",
        &[
            "shaft.polar_inertia is 0.0005 kg m2 and shaft.transverse_inertia 0.0002 kg m2; no body has more than",
            "twice as much about its axis as across it",
        ],
    ),
    (
        "mass = \"2 kg\"",
        "mass = \"2 N\"",
        &["shaft.mass: \"2 N\" is a force; expected a mass such as \"0.25 kg\""],
    ),
    (
        "inner = {",
        "inner = \"30 Hz\"",
        &[
            "speed.inner: \"30 Hz\" is a rate, which does not say whether it counts revolutions or radians; expected \
             an angular speed such as \"1800 rpm\" or a table with times and values",
        ],
    ),
    (
        "inner = {",
        "inner = 1800",
        &[
            "speed.inner: 1800 is a number without a unit; expected an angular speed such as \"1800 rpm\" or a table \
             with times and values, in quotes",
        ],
    ),
    (
        "inner = {",
        "outer = \"2e6 rpm\"",
        &["speed.outer is 2e6 rpm; that is more than 1e5 rad/s (955 000 rpm), check its unit"],
    ),
    (
        "inner = {",
        "outer = { times = [\"0 s\"], values = [] }",
        &["speed.outer has 1 times and 0 values; expected as many of both, at least one"],
    ),
    (
        "inner = {",
        "outer = { ramp = { from = \"0 rpm\", to = \"1 rpm\", start = \"1 s\", duration = \"0 s\" } }",
        &["speed.outer.ramp.duration is 0 s; a duration must be positive"],
    ),
    (
        "inner = {",
        "outer = 1800",
        &["speed.outer: 1800 is a number without a unit; expected an angular speed such as \"1800 rpm\""],
    ),
    (
        "inner = {",
        "",
        &["[speed] needs inner, outer, or both, such as inner = \"1800 rpm\""],
    ),
    (
        "inner = {",
        "inner = \"1e6 rpm\"",
        &["speed.inner is 1e6 rpm; that is more than 1e5 rad/s (955 000 rpm), check its unit"],
    ),
    (
        "inner = {",
        "inner = { times = [\"0 s\"], value = [\"1 rpm\"] }",
        &[
            "unknown key \"value\" in [speed.inner]; did you mean \"values\"? valid keys \
             are \"times\", \"values\", \"ramp\"",
        ],
    ),
    (
        "inner = {",
        "inner = { times = [\"0 s\"], values = [\"1 rpm\", \"2 rpm\"] }",
        &["speed.inner has 1 times and 2 values; expected as many of both, at least one"],
    ),
    (
        "inner = {",
        "inner = { times = [], values = [] }",
        &["speed.inner has 0 times and 0 values; expected as many of both, at least one"],
    ),
    (
        "inner = {",
        "inner = { times = [\"1 ms\", \"1000 us\"], values = [\"1 rpm\", \"2 rpm\"] }",
        &["speed.inner.times[1] is 1000 us; times must grow, the one before is 1 ms"],
    ),
    (
        "inner = {",
        "inner = { times = [\"0 s\", \"1 ms\"], values = [\"1 rpm\", \"-2e6 rpm\"] }",
        &["speed.inner.values[1] is -2e6 rpm; that is more than 1e5 rad/s"],
    ),
    (
        "inner = {",
        "inner = { times = [\"0 s\", \"1 ms\"], values = [\"1 rpm\", \"2 Hz\"] }",
        &["speed.inner.values[1]: \"2 Hz\" is a rate, which does not say"],
    ),
    (
        "inner = 0.0",
        "inner = 1.0",
        &[
            "effects.cage_slip.inner is 1; expected 0 (pure rolling) to below 1, the share of the rolling motion that \
             is lost",
        ],
    ),
    (
        "outer = 0.01",
        "outer = -0.01",
        &["effects.cage_slip.outer is -0.01; expected 0 (pure rolling) to below 1"],
    ),
    (
        "coefficient",
        "coefficient = \"0 N s/mm\"",
        &["effects.contact_damping.coefficient is 0 N s/mm; a damping must be positive"],
    ),
    (
        "coefficient",
        "coefficient = \"5e-2 N/mm\"",
        &[
            "effects.contact_damping.coefficient: \"5e-2 N/mm\" is a stiffness; expected a damping such as \"5e-2 N \
             s/mm\"",
        ],
    ),
    (
        "full_approach",
        "full_approach = \"1 m\"",
        &[
            "effects.contact_damping.full_approach is 1 m; expected more than 0 and at most 1 mm, 1 um is usual",
        ],
    ),
    (
        "mass = \"10 1/s\"",
        "mass = \"-10 1/s\"",
        &[
            "effects.rayleigh_damping.mass is -10 1/s; damping must not be negative, it would feed energy into the \
             rings",
        ],
    ),
    (
        "mass = \"10 1/s\"",
        "mass = \"10 kg\"",
        &["effects.rayleigh_damping.mass: \"10 kg\" is a mass; expected a rate such as \"10 1/s\""],
    ),
    (
        "stiffness",
        "stiffness = \"-1 ns\"",
        &["effects.rayleigh_damping.stiffness is -1 ns; damping must not be negative"],
    ),
    (
        "[effects.ball_centrifugal]",
        "[effects.ball_centrifugal]\nspeed = 1",
        &[
            "unknown key \"speed\" in [effects.ball_centrifugal]; speed belongs to [speed], \
             [life], [heat]; this table has no keys",
        ],
    ),
];

/// If this failed, a motion that cannot be would be computed, or the message would not name key, value and rule, or
/// would drown in its consequences.
#[test]
fn motions_that_make_no_sense_are_refused_with_key_value_and_rule() {
    assert_messages(DYNAMIC, &INVALID);
    for (line, replacement, _) in &INVALID {
        let message = message_of(&replace_line(DYNAMIC, line, replacement), &[]);
        assert!(!message.contains(" problems:"), "{replacement}: {message}");
    }
}

/// If this failed, the numbers of an integrator could leave it unstable, or be silently unused.
#[test]
fn numbers_that_make_an_integrator_unstable_are_refused() {
    let cases = [
        (
            "integrator = \"hht\"",
            "dynamic.alpha is missing; the integrator \"hht\" needs it, expected 0 (no damping) to 1/3, 0.1 is usual",
        ),
        (
            "integrator = \"hht\"\nalpha = 0.4",
            "dynamic.alpha is 0.4; expected 0 (no damping) to 1/3",
        ),
        (
            "integrator = \"hht\"\nalpha = -0.1",
            "dynamic.alpha is -0.1; expected 0 (no damping) to 1/3",
        ),
        (
            "integrator = \"newmark\"\ngamma = 0.4",
            "dynamic.gamma is 0.4; expected 0.5 (no damping) to 1, less is unstable",
        ),
        (
            "integrator = \"newmark\"\ngamma = 0.6",
            "dynamic.beta is 0.25; expected gamma / 2 = 0.3 to (gamma + 1/2)^2 / 4 = 0.3025, which damps high \
             frequencies most: less is unstable for these, more can feed energy into contacts",
        ),
        (
            "integrator = \"newmark\"\ngamma = 0.6\nbeta = 0.31",
            "dynamic.beta is 0.31; expected gamma / 2 = 0.3 to (gamma + 1/2)^2 / 4 = 0.3025",
        ),
        (
            "integrator = \"newmark\"\nbeta = 0",
            "dynamic.beta is 0; expected gamma / 2 = 0.25 to 1",
        ),
    ];
    for (keys, expected) in cases {
        let message = message_of(&with_integrator(keys), &[]);
        assert!(
            message.contains(&format!("has a problem: {expected}")),
            "{keys}: {message}"
        );
    }
}

/// If this failed, a share that is none would leave out inertia that acts, or silently keep all.
#[test]
fn a_negligible_share_of_the_forces_is_small() {
    let turning = at_rest("inner = \"1800 rpm\"");
    for (value, shown) in [("-1e-6", "-0.000001"), ("0.1", "0.1"), ("nan", "NaN")] {
        let keys = format!("[effects.frame_rotation]\nnegligible = {value}");
        let message = message_of(&turning.replace("[effects.frame_rotation]", &keys), &[]);
        let expected = format!(
            "has a problem: effects.frame_rotation.negligible is {shown}; expected a share of the forces from 0, which \
             always keeps the inertia of the elastic part, to 0.01; 1e-6 is usual"
        );
        assert!(message.contains(&expected), "{message}");
    }
}

/// If this failed, an effect would be computed without what it needs, or a table would be accepted that does nothing.
#[test]
fn effects_without_anything_to_do_are_refused() {
    let turning = at_rest("inner = \"1800 rpm\"");
    let constant = replace_line(&turning, "[effects.frame_rotation]", "");
    let without_speed = |text: &str| {
        let text = replace_line(text, "[speed]", "");
        replace_line(&text, "inner = \"1800 rpm\"", "")
    };
    let stiffened = turning.replace(
        "[effects.frame_rotation]",
        "[effects.frame_rotation]\nstress_stiffening = true",
    );
    let no_slip = |text: &str| {
        let (head, tail) = text.split_once("[effects.cage_slip]").unwrap();
        format!("{head}{}", &tail[tail.find("\n[").unwrap()..])
    };
    let needs = |name: &str| {
        format!(
            "[effects.{name}] needs the speed of a ring; add [speed] with inner = \"1800 rpm\" or remove the effect"
        )
    };
    let nothing = |name: &str| {
        format!(
            "[effects.{name}] does nothing in a scene without inertia; remove it, or compute motion with [dynamic]"
        )
    };
    let contact = "[effects.contact_damping]\ncoefficient = \"1 N s/m\"\nfull_approach = \"1 um\"\n[static]";
    let rayleigh = "[effects.rayleigh_damping]\nmass = \"1 1/s\"\nstiffness = \"0 s\"\n[static]";
    let sweep = "[sweep]\nkey = \"shaft.mass\"\nvalues = [\"1 kg\"]";
    let cases = [
        (no_slip(&without_speed(&constant)), needs("ball_centrifugal")),
        (
            replace_line(&without_speed(&constant), "[effects.ball_centrifugal]", ""),
            needs("cage_slip"),
        ),
        (
            no_slip(&replace_line(&without_speed(&turning), "[effects.ball_centrifugal]", "")),
            needs("frame_rotation"),
        ),
        (
            turning.replace("mesh = \"../meshes/7010c_inner.msh\"", "flexible = false"),
            "[effects.frame_rotation] is the inertia of a flexible ring that turns, but the inner ring is rigid; \
             remove it"
                .to_string(),
        ),
        (
            stiffened,
            "effects.frame_rotation.stress_stiffening does nothing in a scene without inertia: a shape that stands in \
             space runs round the turning ring, whose inertia takes back what its stress holds; remove it, or compute \
             motion with [dynamic]"
                .to_string(),
        ),
        (
            at_rest("outer = \"1800 rpm\"").replace("mesh = \"../meshes/7010c_outer.msh\"", "flexible = false"),
            "[effects.frame_rotation] is the inertia of a flexible ring that turns, but the outer ring is rigid; \
             remove it"
                .to_string(),
        ),
        (
            at_rest("outer = \"1800 rpm\"").replace(
                "[static]",
                "[effects.unbalance]\nmass = \"1 g\"\neccentricity = \"1 mm\"\n[static]",
            ),
            "[effects.unbalance] turns with the inner ring, but [speed] has outer alone; add inner, or remove the \
             effect"
                .to_string(),
        ),
        (constant.replace("[static]", contact), nothing("contact_damping")),
        (
            constant.replace("[static]", contact).replace("[static]", sweep),
            nothing("contact_damping"),
        ),
        (constant.replace("[static]", rayleigh), nothing("rayleigh_damping")),
        (
            replace_line(&constant, "[effects.ball_centrifugal]", ""),
            "[speed] does nothing in a scene at rest without [life], [heat], [effects.ball_centrifugal], \
             [effects.frame_rotation], [effects.gyroscopic_moment], [effects.orbit_inertia], [effects.traction] or \
             [effects.unbalance]; add one"
                .to_string(),
        ),
        (
            at_rest("inner = { times = [\"0 s\"], values = [\"1 rpm\"] }"),
            "speed.inner is a table over time, but a scene at rest has no time; expected one speed such as \"1800 rpm\""
                .to_string(),
        ),
    ];
    for (text, expected) in cases {
        let message = message_of(&text, &[]);
        assert!(
            message.contains(&format!("has a problem: {expected}")),
            "{expected}\n{message}"
        );
    }
}
