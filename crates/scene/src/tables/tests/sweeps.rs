//! Tests of sweeps and their points.

use super::*;
use crate::tables::sweep::Sweep;

fn sweep_of(scene: &Scene) -> &Sweep {
    match &scene.analysis {
        Analysis::Sweep(sweep) => sweep,
        other => panic!("no sweep: {other:?}"),
    }
}

/// If this failed, a sweep would solve other loads than its list, or write them under a wrong name.
#[test]
fn a_sweep_has_a_static_scene_per_value() {
    let scene = parse(EXAMPLE, &[]).unwrap();
    let sweep = sweep_of(&scene);
    assert_eq!(sweep.column, "effects.radial_force.value_n");
    let points = scene.sweep_scenes().unwrap();
    let values: Vec<f64> = sweep.points.iter().map(|p| p.value).collect();
    assert_eq!(values, [0.0, 500.0, 1000.0]);
    for (point, value) in points.iter().zip(values) {
        assert_eq!(radial_of(point), Some(value));
        assert_eq!(point.analysis, Analysis::Static);
        let same = Scene {
            text: scene.text.clone(),
            effects: scene.effects.clone(),
            analysis: scene.analysis.clone(),
            ..point.clone()
        };
        assert_eq!(same, scene);
    }
}

/// If this failed, points between the ends would be unevenly spaced or the ends not what was typed.
#[test]
fn equal_steps_include_both_ends() {
    let text = with_line("values", "from = \"0 kN\"\nto = \"7 kN\"\nsteps = 7");
    let scene = parse(&text, &[]).unwrap();
    let values: Vec<f64> = sweep_of(&scene).points.iter().map(|p| p.value).collect();
    assert_eq!(values, [0.0, 1e3, 2e3, 3e3, 4e3, 5e3, 6e3, 7e3]);
    let forces: Vec<_> = scene.sweep_scenes().unwrap().iter().map(radial_of).collect();
    assert_eq!(forces, values.iter().map(|v| Some(*v)).collect::<Vec<_>>());
}

/// If this failed, numbers without a unit, and keys that the scene leaves at their default, could not be
/// swept.
#[test]
fn pure_numbers_and_keys_left_at_their_default_can_be_swept() {
    let text =
        with_line("patch_elements", "").replace("effects.radial_force.value\" ", "contact.patch_elements\"");
    let text = text.replace("[\"0 kN\", \"0.5 kN\", \"1 kN\"]", "[1, 2.5]");
    let scene = parse(&text, &[]).unwrap();
    assert_eq!(sweep_of(&scene).column, "contact.patch_elements");
    let swept: Vec<f64> = scene
        .sweep_scenes()
        .unwrap()
        .iter()
        .map(|s| s.contact.patch_elements)
        .collect();
    assert_eq!(swept, [1.0, 2.5]);
}

/// If this failed, an hour of a sweep would be computed before its last, impossible point is found.
#[test]
fn every_point_is_checked_before_the_first_is_solved() {
    let text =
        with_line("key", "key = \"bearing.balls\"").replace("[\"0 kN\", \"0.5 kN\", \"1 kN\"]", "[18, 23]");
    let text = text.replace("sectors = 180", "sectors = 414");
    let message = message_of(&text, &[]);
    let expected = "point 1 of the sweep (bearing.balls = 23): bearing.balls is 23; the balls overlap";
    assert!(message.contains(expected), "{message}");
    assert!(message.contains("has a problem: point 1"), "{message}");
}

/// If this failed, a sweep of a key that does not exist would solve the same scene again and again.
#[test]
fn bad_sweeps_are_refused() {
    let key = "sweep.key is ";
    let either =
        "sweep needs either values, a list, or all three of from, to and steps (the number of intervals)";
    let cases = [
        (
            "key",
            "key = \"effects.radial_force.valu\"",
            "unknown key \"valu\" in [effects.radial_force]",
        ),
        (
            "key",
            "key = \"bearing.ball_diameter\"",
            "bearing.ball_diameter: \"0 kN\" is a force; expected a length",
        ),
        (
            "key",
            "key = \"sweep.steps\"",
            "sweep.key is \"sweep.steps\"; expected the path of a number",
        ),
        (
            "key",
            "key = \"dynamic.step\"",
            "sweep.key is \"dynamic.step\"; expected the path of a number",
        ),
        (
            "key",
            "key = \"title\"",
            "sweep.key is \"title\"; expected the path of a number",
        ),
        (
            "key",
            "key = \"contact.mode.x\"",
            "contact.mode is a value, so it has no key \"x\"",
        ),
        ("values", "", either),
        ("values", "from = \"0 N\"\nto = \"1 N\"", either),
        ("values", "values = [\"1 N\"]\nsteps = 3", either),
        (
            "values",
            "from = \"0 N\"\nto = \"1 N\"\nsteps = 0",
            "sweep.steps is 0; expected a whole number from 1",
        ),
        (
            "values",
            "from = \"0 N\"\nto = \"1 m\"\nsteps = 2",
            "sweep.from and sweep.to are of different kinds",
        ),
        (
            "values",
            "values = [\"free\"]",
            "sweep.values[0]: \"free\" does not begin with a number",
        ),
    ];
    for (line, replacement, expected) in cases {
        let message = message_of(&with_line(line, replacement), &[]);
        assert!(message.contains(expected), "{replacement}: {message}");
        if line == "key" {
            assert!(message.contains(key), "{replacement}: {message}");
        }
    }
}
