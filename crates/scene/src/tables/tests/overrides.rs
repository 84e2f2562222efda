//! Tests of `--set path=value`.

use super::*;

/// If this failed, `--set` would change another key, or not what is solved.
#[test]
fn an_override_replaces_exactly_its_key() {
    let plain = parse(EXAMPLE, &[]).unwrap();
    let set = parse(EXAMPLE, &["effects.axial_force.value=3 kN"]).unwrap();
    assert_eq!(axial_of(&plain), Some((2000.0, Schedule::Constant)));
    assert_eq!(axial_of(&set), Some((3000.0, Schedule::Constant)));
    let restored = Effects {
        axial_force: plain.effects.axial_force.clone(),
        ..set.effects
    };
    assert_eq!(restored, plain.effects);
    assert_eq!(set.bearing, plain.bearing);
}

/// If this failed, a checkpoint would record a text that is not the one that was solved.
#[test]
fn the_text_of_an_overridden_scene_reads_as_the_same_scene() {
    let overrides = [
        "effects.moment.x=2 N m",
        "inner.flexible=false",
        "title=a=b",
        "output.compression = 3",
    ];
    let set = parse(EXAMPLE, &overrides).unwrap();
    assert_eq!(set.overrides, overrides);
    assert_eq!(parse(&set.text, &[]).unwrap(), without_arguments(&set));
    assert_eq!(set.title.as_deref(), Some("a=b"));
    assert_eq!(set.output.compression, 3);
    assert_eq!(set.inner.body, None);
}

/// If this failed, comments, and so the documentation of a study, would be lost, and line numbers would
/// shift.
#[test]
fn an_override_keeps_comments_and_lines() {
    let set = parse(EXAMPLE, &["bearing.balls=17", "inner.section.sectors=170"]).unwrap();
    let changed: Vec<_> = EXAMPLE
        .lines()
        .zip(set.text.lines())
        .filter(|(a, b)| a != b)
        .collect();
    let expected = [
        ("balls = 18   ", "balls = 17   ", "# number of balls, 3 or more"),
        (
            "sectors = 180   ",
            "sectors = 170   ",
            "# elements round the ring, a multiple of balls",
        ),
    ];
    assert_eq!(EXAMPLE.lines().count(), set.text.lines().count());
    assert_eq!(changed.len(), expected.len(), "{changed:?}");
    for ((old, new), (before, after, comment)) in changed.iter().zip(expected) {
        assert!(
            old.starts_with(before) && new.starts_with(after) && new.ends_with(comment),
            "{old} | {new}"
        );
    }
}

/// If this failed, an effect could not be switched on from the command line.
#[test]
fn an_override_adds_missing_tables() {
    let text = without_table("[effects.gravity]");
    let set = [
        "effects.gravity.acceleration=2 m/s2",
        "effects.gravity.direction=[0.0, 3.0, 0.0]",
    ];
    let scene = parse(&text, &set).unwrap();
    let gravity = scene.effects.gravity.as_ref().unwrap();
    assert_eq!(
        (gravity.acceleration(), gravity.schedule()),
        ([0.0, 2.0, 0.0], Schedule::Constant)
    );
    assert_eq!(parse(&scene.text, &[]).unwrap(), without_arguments(&scene));
}

/// The scene as if its text had been typed.
fn without_arguments(scene: &Scene) -> Scene {
    Scene {
        overrides: Vec::new(),
        ..scene.clone()
    }
}

/// If this failed, a mistyped `--set` would be ignored without a word.
#[test]
fn bad_overrides_are_refused_with_their_text() {
    let cases = [
        (
            "effects.axial_force",
            "--set \"effects.axial_force\": expected path=value such as",
        ),
        (
            "title.x=3",
            "--set \"title.x=3\": title is a value, so it has no key \"x\"",
        ),
        (
            "a..b=3",
            "--set \"a..b=3\": \"a..b\" is no path of keys; expected one such as",
        ),
        (
            "bearing.bals=17",
            "unknown key \"bals\" in [bearing]; did you mean \"balls\"?",
        ),
        (
            "bearing.bals=17",
            "--set \"bearing.bals=17\": unknown key \"bals\"",
        ),
        (
            "effects.wind.value=3 N",
            "--set \"effects.wind.value=3 N\": unknown key \"wind\" in [effects]",
        ),
        (
            "bearing=17",
            "bearing: invalid type: integer `17`, expected the table [bearing]",
        ),
        (
            "bearing.ball_diameter=9",
            "bearing.ball_diameter: 9 is a number without a unit",
        ),
        (
            "bearing.ball_diameter=9 N",
            "bearing.ball_diameter: \"9 N\" is a force; expected a length",
        ),
        (
            "bearing.balls=1",
            "scenes/test.toml (with --set \"bearing.balls=1\") has a problem: bearing.balls is 1;",
        ),
    ];
    for (argument, expected) in cases {
        let message = message_of(EXAMPLE, &[argument]);
        assert!(message.contains(expected), "{argument}: {message}");
    }
}

/// Wrong: with a value of the command line, several mistakes of the file would have no lines, and one of the command
/// line would be looked for in the file.
#[test]
fn several_problems_have_their_lines_beside_overrides() {
    let text = EXAMPLE
        .replacen("balls = ", "bals = ", 1)
        .replacen("mesh_unit = ", "mesh_unti = ", 1);
    let line_with = |key: &str| 1 + text.lines().position(|line| line.starts_with(key)).unwrap();
    let message = message_of(&text, &["effects.wind.value=3 N", "title=other"]);
    for expected in [
        "unknown key \"bals\" in [bearing]; did you mean \"balls\"? valid keys".to_string(),
        format!("(line {})\n", line_with("bals = ")),
        format!("(line {})\n", line_with("mesh_unti = ")),
        "(--set \"effects.wind.value=3 N\")".to_string(),
    ] {
        assert!(message.contains(&expected), "{expected}: {message}");
    }
}

/// If this failed, a study could not leave an effect out, or would leave out something else.
#[test]
fn none_takes_a_table_out_and_is_a_word_elsewhere() {
    let plain = parse(EXAMPLE, &[]).unwrap();
    let set = parse(EXAMPLE, &["effects.gravity=none", "output.stress = none"]).unwrap();
    assert!(plain.effects.gravity.is_some() && set.effects.gravity.is_none());
    assert_eq!(set.output.stress, StressOutput::None);
    let restored = Effects {
        gravity: plain.effects.gravity.clone(),
        ..set.effects
    };
    assert_eq!(restored, plain.effects);
    let error = parse(EXAMPLE, &["effects.gravitation=none"])
        .unwrap_err()
        .to_string();
    assert!(error.contains("unknown key \"gravitation\""), "{error}");
}
