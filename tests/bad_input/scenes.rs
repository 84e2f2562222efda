//! Scenes that must be refused by the whole program. The scene format has its own, finer tests in `crates/scene`.

use super::{assert_refused, run};
use crate::util::{Dir, SCENE, with_line};

/// Table and line of the scene, what the line is replaced with, and the essential parts of the message.
type Case = (&'static str, &'static str, &'static str, &'static [&'static str]);

const CASES: [Case; 28] = [
    (
        "[bearing]",
        "ball_diameter",
        "ball_diametr = \"9 mm\"",
        &[
            "error: scene.toml:6:1: unknown key \"ball_diametr\" in [bearing]; did you mean \"ball_diameter\"? valid \
             keys are \"balls\", \"ball_diameter\"",
            "6 | ball_diametr = \"9 mm\"\n  | ^^^^^^^^^^^^",
        ],
    ),
    (
        "[effects.radial_force]",
        "value",
        "value = \"1 kN\"\nschedule.step = { at = \"1 ms\" }",
        &[
            "error: scene.toml has a problem: effects.radial_force.schedule changes effects.radial_force over time, \
             but a scene at rest has no time; remove it, or give it time with [dynamic] or [quasi_static]",
        ],
    ),
    (
        "[effects.radial_force]",
        "[effects.radial_force]",
        "[effects.radial_fource]",
        &[
            "unknown key \"radial_fource\" in [effects]; did you mean \"radial_force\"? valid keys are \"axial_force\"",
        ],
    ),
    (
        "[bearing]",
        "width",
        "width = \"16 N\"",
        &["error: scene.toml:13:9: bearing.width: \"16 N\" is a force; expected a length such as \"9 mm\""],
    ),
    (
        "[bearing]",
        "width",
        "width = \"16 mn\"",
        &["bearing.width: \"16 mn\" has the unknown unit \"mn\" (did you mean \"mN\"?)"],
    ),
    (
        "[bearing]",
        "width",
        "width = 16",
        &["bearing.width: 16 is a number without a unit; expected a length such as \"9 mm\", in quotes"],
    ),
    (
        "[bearing]",
        "width",
        "width = \"nan mm\"",
        &["bearing.width: \"nan mm\" is not a finite number"],
    ),
    (
        "[bearing]",
        "ball_diameter",
        "ball_diameter = \"-9 mm\"",
        &["error: scene.toml has a problem: bearing.ball_diameter is -9 mm; a diameter must be positive"],
    ),
    (
        "[bearing]",
        "ball_diameter",
        "ball_diameter = \"9 km\"",
        &["bearing.ball_diameter is 9 km; check its unit, expected 10 um to 100 m"],
    ),
    (
        "[bearing]",
        "balls",
        "balls = 2",
        &["bearing.balls is 2; expected a whole number from 3 to 1000"],
    ),
    (
        "[bearing]",
        "balls",
        "balls = 30",
        &["bearing.balls is 30; the balls overlap on the pitch circle of 65.0235 mm, at most 22 of 9 mm fit"],
    ),
    (
        "[bearing]",
        "balls",
        "balls = 18.5",
        &["bearing.balls: invalid type: floating point `18.5`, expected a whole number"],
    ),
    (
        "[bearing]",
        "bore_diameter",
        "",
        &["[bearing] has no key \"bore_diameter\", which is required"],
    ),
    (
        "[bearing]",
        "outer_raceway_diameter",
        "outer_raceway_diameter = \"75 mm\"",
        &[
            "the diametral clearance 0.9900 mm",
            "the balls would touch at 90 degrees or not at all, check the diameters",
        ],
    ),
    (
        "[materials.rings]",
        "poisson_ratio",
        "poisson_ratio = 0.5",
        &["materials.rings.poisson_ratio is 0.5; expected 0 to 0.49, steel has 0.3"],
    ),
    (
        "[materials.balls]",
        "young_modulus",
        "young_modulus = \"207 Pa\"",
        &["materials.balls.young_modulus is 207 Pa; expected 1 kPa to 10 TPa"],
    ),
    (
        "[contact]",
        "mode",
        "mode = \"pach\"",
        &[
            "contact.mode is \"pach\"; did you mean \"patch\"? valid values are \"patch\", \"facet\", \"rigid\"",
        ],
    ),
    (
        "[contact]",
        "mode",
        "mode = \"rigid\"",
        &["inner.flexible is true (the default) but contact.mode is \"rigid\"; set inner.flexible = false"],
    ),
    (
        "[inner]",
        "mesh =",
        "mesh = \"iner.msh\"",
        &[
            "inner.mesh is \"iner.msh\", but there is no file iner.msh; correct the path, which is relative to the \
             scene file",
        ],
    ),
    (
        "[inner]",
        "mesh =",
        "mesh = \".\"",
        &[
            "inner.mesh is \".\", but there is no file .; correct the path, which is relative to the scene file",
        ],
    ),
    (
        "[outer]",
        "mesh_unit",
        "",
        &["outer.mesh_unit is missing; a flexible ring needs the unit of its mesh such as \"mm\""],
    ),
    (
        "[outer]",
        "support",
        "support = \"glued\"",
        &["outer.support is \"glued\"; valid values are \"clamped\", \"mean_motion\""],
    ),
    (
        "[shaft]",
        "z =",
        "z = \"12 mm\"",
        &["shaft.z is 12 mm; a prescribed displacement must be less than a ball radius"],
    ),
    (
        "[shaft]",
        "tilt_x",
        "tilt_x = \"loose\"",
        &["shaft.tilt_x: \"loose\" is no state of a shaft motion; expected \"free\", \"locked\" or an angle"],
    ),
    (
        "[effects.axial_force]",
        "value",
        "value = \"2 TN\"",
        &["effects.axial_force.value is 2 TN; that is more than any bearing carries, check its unit"],
    ),
    (
        "[static]",
        "[static]",
        "[static]\n[sweep]\nkey = \"effects.axial_force.value\"\nvalues = [\"1 kN\"]",
        &["the scene has both [static] and [sweep]; keep exactly one analysis"],
    ),
    (
        "[static]",
        "[static]",
        "",
        &[
            "the scene has no analysis; add one of the tables [static], [sweep], [quasi_static], [dynamic] and [modes]",
        ],
    ),
    (
        "[static]",
        "[static]",
        "[sweep]\nkey = \"bearing.ball_diameter\"\nvalues = [\"9 mm\", \"9.1 mm\", \"-9 mm\"]",
        &["point 2 of the sweep (bearing.ball_diameter_m = -0.009): bearing.ball_diameter is -9 mm"],
    ),
];

/// If this failed, a slip in a scene would be solved, crash the program, or not be found by its user.
#[test]
fn bad_scenes_are_refused_with_place_value_and_remedy() {
    let dir = Dir::with_meshes();
    for (header, line, replacement, parts) in &CASES {
        dir.write("scene.toml", with_line(header, line, replacement));
        assert_refused(replacement, &dir, &[], &run(&[]), parts);
    }
}

/// If this failed, texts that are no scenes at all would be met with something else than their first error.
#[test]
fn files_that_are_no_scenes_are_refused() {
    let cut_off = SCENE.split(" GPa").next().unwrap();
    let cases: [(&str, &[u8], &str); 4] = [
        (
            "empty",
            b"",
            "the table [bearing] is missing; \"raceway init\" writes a scene to start from",
        ),
        (
            "cut off",
            cut_off.as_bytes(),
            "error: scene.toml:16:21: this is not TOML: ",
        ),
        (
            "no text",
            b"\x89PNG\r\n\x1a\n\x00\xff",
            "error: cannot read the scene scene.toml: it is no text in UTF-8; expected a scene, saved as UTF-8\n",
        ),
        (
            "a mesh",
            b"$MeshFormat\n4.1 0 8\n",
            "error: scene.toml:1:12: this is not TOML: ",
        ),
    ];
    let dir = Dir::empty();
    for (name, content, part) in cases {
        dir.write("scene.toml", content);
        assert_refused(name, &dir, &[], &run(&[]), &[part]);
    }
}

/// If this failed, a sweep over what the factorisation depends on would silently use the rings of its first point.
#[test]
fn a_sweep_over_the_rings_themselves_is_refused() {
    let sweep = "[sweep]\nkey = \"materials.rings.young_modulus\"\nvalues = [\"200 GPa\", \"210 GPa\"]";
    let dir = Dir::with_meshes();
    dir.write("scene.toml", with_line("[static]", "[static]", sweep));
    let part = "error: scene.toml: [sweep] key materials.rings.young_modulus changes the rings themselves; sweep \
                loads, contacts, supports of the shaft or the ball phase, or run one scene per value with --set";
    assert_refused("young_modulus", &dir, &[], &run(&[]), &[part]);
}

/// If this failed, a free shaft that nothing holds would drift through the solver, or leave a folder without results.
#[test]
fn a_shaft_that_nothing_holds_is_refused() {
    let dir = Dir::with_meshes();
    let unloaded = [
        "--set",
        "effects.axial_force.value=0 N",
        "--set",
        "effects.radial_force.value=0 N",
    ];
    let part = "of the shaft is free but nothing resists it (stiffness 0.000e0 of the largest): lock it in [shaft] or \
                load the bearing so that balls touch";
    assert_refused("no load", &dir, &[], &run(&unloaded), &[part]);
}
