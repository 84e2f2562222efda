//! Tests of scene files.

mod bad_format;
mod bad_motion;
mod bad_values;
mod balls;
mod body;
mod cage;
mod catalogue;
mod effects;
mod good;
mod groove_circle;
mod hollow_balls;
mod include;
mod life;
mod lubricant;
mod modes;
mod motion;
mod mounting;
mod overrides;
mod probes;
mod profiles;
mod quasi_static;
mod reference;
mod ring_inertia;
mod schedules;
mod several;
mod several_bodies;
mod several_over_time;
mod several_slips;
mod slips;
mod sweeps;

use dynamics::effects::EffectTable as _;
use std::path::Path;

use input::Schedule;

use super::*;

/// The example of the documentation: the scene all tests start from.
const EXAMPLE: &str = include_str!("../example.toml");

/// The example of a motion in time.
const DYNAMIC: &str = include_str!("../example_dynamic.toml");

/// Parses a text as if it were `scenes/test.toml`, without looking for meshes.
fn parse(text: &str, overrides: &[&str]) -> Result<Scene, SceneError> {
    let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
    Scene::parse(
        text,
        Path::new("scenes/test.toml"),
        &overrides,
        MeshFiles::MayBeMissing,
    )
}

/// Axial force of a scene, N, and its factor over time.
fn axial_of(scene: &Scene) -> Option<(f64, Schedule)> {
    let force = scene.effects.axial_force.as_ref();
    force.map(|force| (force.value.si(), force.schedule()))
}

/// Radial force of a scene, N.
fn radial_of(scene: &Scene) -> Option<f64> {
    let force = scene.effects.radial_force.as_ref();
    force.map(|force| force.value.si())
}

/// The example with the first line that starts with `line` replaced, comment and all.
fn with_line(line: &str, replacement: &str) -> String {
    replace_line(EXAMPLE, line, replacement)
}

/// A text with the first line that starts with `line` replaced, comment and all.
fn replace_line(text: &str, line: &str, replacement: &str) -> String {
    let old = text.lines().find(|l| l.starts_with(line));
    let old = old.unwrap_or_else(|| panic!("the example has no line that starts with {line:?}"));
    text.replacen(old, replacement, 1)
}

/// The example without the table whose header is given, up to the next header.
fn without_table(header: &str) -> String {
    let mut inside = false;
    let mut kept = String::new();
    for line in EXAMPLE.lines() {
        if line.starts_with('[') {
            inside = line.starts_with(header);
        }
        if !inside {
            kept += line;
            kept.push('\n');
        }
    }
    assert_ne!(kept, EXAMPLE, "the example has no table {header}");
    kept
}

/// The example of motion with the keys of its integrator replaced.
fn with_integrator(keys: &str) -> String {
    let text = replace_line(DYNAMIC, "rho", "");
    replace_line(&text, "integrator", keys)
}

/// The example of motion as an equilibrium: no damping, and `[static]` for `[dynamic]`.
fn at_rest(speed: &str) -> String {
    let (head, _) = DYNAMIC.split_once("[effects.contact_damping]").unwrap();
    replace_line(&format!("{head}[static]\n"), "inner = {", speed)
}

/// The message of a text that must not be accepted.
fn message_of(text: &str, overrides: &[&str]) -> String {
    match parse(text, overrides) {
        Ok(_) => panic!("accepted with {overrides:?}:\n{text}"),
        Err(error) => error.to_string(),
    }
}

/// A line of the example (by its start), what it is replaced with, and what the message must contain.
type Case = (&'static str, &'static str, &'static [&'static str]);

/// Every case of the text is refused with all parts of its message.
fn assert_messages(text: &str, cases: &[Case]) {
    for (line, replacement, parts) in cases {
        let message = message_of(&replace_line(text, line, replacement), &[]);
        assert!(
            message.starts_with("scenes/test.toml"),
            "{replacement}: {message}"
        );
        for part in *parts {
            assert!(
                message.contains(part),
                "{replacement}: expected\n{part}\nin\n{message}"
            );
        }
    }
}
