//! Scenes that are not of the format, and the essential parts of their messages.

use super::{Case, EXAMPLE, Scene, assert_messages, message_of, without_table};

/// Errors of the format: they have a line and a column.
const FORMAT: [Case; 36] = [
    (
        "ball_diameter",
        "ball_diametr = \"9 mm\"",
        &[
            "scenes/test.toml:6:1: unknown key \"ball_diametr\" in [bearing]; did you mean \"ball_diameter\"? valid \
             keys are \"balls\", \"ball_diameter\", \"inner_raceway_diameter\"",
            "6 | ball_diametr = \"9 mm\"\n  | ^^^^^^^^^^^^",
        ],
    ),
    (
        "ball_diameter",
        "colour = \"red\"",
        &[
            "[bearing] has no key \"ball_diameter\", which is required (line 4)",
            "unknown key \"colour\" in [bearing]; valid keys are \"balls\"",
        ],
    ),
    (
        "title",
        "titel = \"x\"",
        &[
            "2:1: unknown key \"titel\"; did you mean \"title\"? valid keys are \"title\", \"include\", \"bearing\"",
        ],
    ),
    (
        "[effects.gravity]",
        "[effects.gravty]",
        &["unknown key \"gravty\" in [effects]; did you mean \"gravity\"?"],
    ),
    (
        "[effects.gravity]",
        "[effects.tides]",
        &["unknown key \"tides\" in [effects]; valid keys \
             are \"axial_force\", \"radial_force\", \"moment\", \"gravity\", \"ball_centrifugal\", \
             \"gyroscopic_moment\", \"orbit_inertia\", \"cage_slip\", \"frame_rotation\", \"contact_damping\", \
         \"rayleigh_damping\""],
    ),
    (
        "[inner.section]",
        "[inner.sektion]",
        &["unknown key \"sektion\" in [inner]; did you mean \"section\"?"],
    ),
    (
        "[solver]",
        "[solvers]",
        &["unknown key \"solvers\"; did you mean \"solver\"?"],
    ),
    (
        "[materials.balls]",
        "[materials.cage]",
        &[
            "unknown key \"cage\" in [materials]; [cage] is a table of its own; valid keys are \"rings\", \"balls\"",
        ],
    ),
    (
        "grading",
        "gradient = 1.2",
        &["unknown key \"gradient\" in [inner.section]; did you mean \"grading\"?"],
    ),
    (
        "ball_diameter",
        "",
        &["4:1: [bearing] has no key \"ball_diameter\", which is required"],
    ),
    (
        "load_point",
        "",
        &["[shaft] has no key \"load_point\", which is required"],
    ),
    (
        "tilt_y",
        "",
        &["[shaft] has no key \"tilt_y\", which is required"],
    ),
    (
        "ball_diameter",
        "ball_diameter = \"9 N\"",
        &[
            "6:17: bearing.ball_diameter: \"9 N\" is a force; expected a length such as \"9 mm\"",
            "6 | ball_diameter = \"9 N\"\n  |                 ^^^^^",
        ],
    ),
    (
        "ball_diameter",
        "ball_diameter = 9",
        &[
            "6:17: bearing.ball_diameter: 9 is a number without a unit; expected a length such as \"9 mm\", in quotes",
        ],
    ),
    (
        "ball_diameter",
        "ball_diameter = 0.009",
        &["bearing.ball_diameter: 0.009 is a number without a unit"],
    ),
    (
        "ball_diameter",
        "ball_diameter = \"9\"",
        &["bearing.ball_diameter: \"9\" has no unit; expected a length"],
    ),
    (
        "ball_diameter",
        "ball_diameter = \"nan mm\"",
        &["bearing.ball_diameter: \"nan mm\" is not a finite number"],
    ),
    (
        "ball_diameter",
        "ball_diameter = nan",
        &["bearing.ball_diameter: NaN is a number without a unit"],
    ),
    (
        "ball_diameter",
        "ball_diameter = \"9 mn\"",
        &["\"9 mn\" has the unknown unit \"mn\" (did you mean \"mN\"?)"],
    ),
    (
        "ball_diameter",
        "ball_diameter = true",
        &["bearing.ball_diameter: invalid type: boolean `true`, expected a length such as \"9 mm\""],
    ),
    (
        "first_ball",
        "first_ball_azimuth = \"1800 rpm\"",
        &["\"1800 rpm\" is an angular speed; expected an angle such as \"15 deg\""],
    ),
    (
        "young",
        "young_modulus = \"207 GN\"",
        &["materials.rings.young_modulus: \"207 GN\" is a force; expected a stress such as \"207 GPa\""],
    ),
    (
        "inner_stiffness",
        "inner_stiffness = \"9.31e5 N/mm\"",
        &[
            "contact.inner_stiffness: \"9.31e5 N/mm\" is a stiffness; expected a Hertz stiffness such as \"9.31e5 \
             N/mm^1.5\"",
        ],
    ),
    (
        "balls",
        "balls = 18.5",
        &["bearing.balls: invalid type: floating point `18.5`, expected a whole number"],
    ),
    (
        "balls",
        "balls = \"18\"",
        &["bearing.balls: invalid type: string \"18\", expected a whole number"],
    ),
    ("balls", "balls =", &["5:8: this is not TOML: "]),
    (
        "balls",
        "balls = 18\nballs = 19",
        &["6:1: this is not TOML: duplicate key"],
    ),
    ("[bearing]", "[bearing", &["4:9: this is not TOML: "]),
    (
        "mode",
        "mode = \"pach\"",
        &[
            "contact.mode is \"pach\"; did you mean \"patch\"? valid values are \"patch\", \"facet\", \"rigid\"",
        ],
    ),
    (
        "support",
        "support = \"glued\"",
        &["inner.support is \"glued\"; valid values are \"clamped\", \"mean_motion\""],
    ),
    (
        "element",
        "element = \"hex27\"",
        &[
            "inner.section.element is \"hex27\"; did you mean \"hex20\"? valid values \
             are \"hex8\", \"hex20\", \"tet10\"",
        ],
    ),
    (
        "backend",
        "backend = \"mumps\"",
        &["solver.backend is \"mumps\"; valid values are \"auto\", \"cyclic\", \"sparse\", \"sector\""],
    ),
    (
        "tilt_x",
        "tilt_x = \"lokced\"",
        &[
            "shaft.tilt_x: \"lokced\" is no state of a shaft motion; expected \"free\", \"locked\" or an angle such \
             as \"15 deg\"",
        ],
    ),
    (
        "x =",
        "x = \"12 urad\"",
        &["shaft.x: \"12 urad\" is an angle; expected \"free\", \"locked\" or a length such as \"9 mm\""],
    ),
    (
        "shoulder_diameters",
        "shoulder_diameters = [\"60.4 mm\", \"60.4 N\"]",
        &["inner.section.shoulder_diameters[1]: \"60.4 N\" is a force"],
    ),
    (
        "direction = [",
        "direction = [0.0, -1.0]",
        &["effects.gravity.direction: invalid length 2, expected an array of length 3"],
    ),
];

/// If this failed, a slip of the keyboard would be accepted, or its place and remedy would be hard to find.
#[test]
fn texts_that_are_not_of_the_format_are_refused_with_place_and_advice() {
    assert_messages(EXAMPLE, &FORMAT);
}

/// If this failed, a scene without a table it needs would be solved with invented values.
#[test]
fn missing_tables_are_named() {
    let cases = [
        ("[bearing]", "the table [bearing] is missing"),
        ("[shaft]", "the table [shaft] is missing"),
        ("[contact]", "the table [contact] is missing"),
        (
            "[materials.balls]",
            "[materials] has no key \"balls\", which is required",
        ),
        ("[outer]", "outer.mesh is missing"),
        (
            "[sweep]",
            "the scene has no analysis; add one of the tables [static], [sweep], [quasi_static], [dynamic] and [modes]",
        ),
    ];
    for (header, expected) in cases {
        let message = message_of(&without_table(header), &[]);
        assert!(message.contains(expected), "{header}: {message}");
    }
}

/// If this failed, the user would not learn which file could not be read, and why.
#[test]
fn a_missing_scene_is_named() {
    let message = Scene::load(std::path::Path::new("no/such.toml"), &[])
        .unwrap_err()
        .to_string();
    assert!(
        message.starts_with("cannot read the scene no/such.toml: No such file"),
        "{message}"
    );
}

/// If this failed, a scene cut off or damaged on its way would crash the program.
#[test]
fn no_prefix_of_a_scene_panics() {
    let cut = "title = \"µ\"\n[bearing]\nballs = 18\nball_diameter = \"9 mm\"\n[shaft]\nx = \"12 µm\"\n";
    for end in (0..=cut.len()).filter(|&i| cut.is_char_boundary(i)) {
        let message = message_of(&cut[..end], &[]);
        assert!(message.starts_with("scenes/test.toml"), "{end}: {message}");
    }
}
