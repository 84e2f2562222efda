//! `raceway campbell` where balls have modes of their own, or damping lets nothing swing.

use crate::util::{Dir, Outcome, RIGID, with_line};

/// A rotor of 3 kg under thrust, free in all directions, with contacts that damp in motion.
fn damped_rotor() -> Dir {
    let shaft = "tilt_y = \"free\"\nmass = \"3 kg\"\n\
                 transverse_inertia = \"3e-3 kg m2\"\npolar_inertia = \"3e-3 kg m2\"";
    let scene = with_line("[shaft]", "tilt_y = \"locked\"", shaft);
    let motion = "[speed]\ninner = \"1800 rpm\"\n\n[effects.contact_damping]\ncoefficient = \"1 N s/m\"\n\
                  full_approach = \"1 um\"\n\n[dynamic]\nduration = \"1 ms\"\nstep = \"10 us\"";
    let scene = scene.replacen("tilt_x = \"locked\"", "tilt_x = \"free\"", 1);
    Dir::with_scene(&scene.replacen("[static]", motion, 1))
}

/// Runs the command at rest and at 24000 rpm with this radial force and damping.
fn campbell(dir: &Dir, out: &str, [force, damping]: [&str; 2], more: &[&str]) -> Outcome {
    let force = format!("effects.radial_force.value=\"{force}\"");
    let damping = format!("effects.contact_damping.coefficient=\"{damping}\"");
    let first = [
        "campbell",
        "scene.toml",
        "--speeds",
        "0..24000:24000",
        "--out",
        out,
    ];
    let sets = ["--set", &force, "--set", &damping];
    dir.raceway(&[&first[..], &RIGID, &sets, more].concat())
}

/// Frequencies, Hz, and shares of the shaft, by lines.
fn modes(dir: &Dir, out: &str) -> Vec<[f64; 2]> {
    let text = dir.text(&format!("{out}/campbell.csv"));
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        [2, 6].map(|column| cells[column].parse().unwrap())
    };
    text.lines().skip(1).map(row).collect()
}

fn succeeds(outcome: Outcome) {
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
}

/// Wrong: a shaft whose inertia was forgotten would look like a solution that was not found, and a script would try
/// again with other settings of the solver.
#[test]
fn a_shaft_without_inertia_is_wrong_input() {
    let dir = damped_rotor();
    for (out, none, key) in [
        ("mass", &["shaft.mass=\"0 kg\""][..], "shaft.mass"),
        (
            "tilt",
            &[
                "shaft.transverse_inertia=\"0 kg m2\"",
                "shaft.polar_inertia=\"0 kg m2\"",
            ],
            "shaft.transverse_inertia",
        ),
    ] {
        let sets: Vec<&str> = none.iter().flat_map(|argument| ["--set", argument]).collect();
        let outcome = campbell(&dir, out, ["0 N", "1 N s/m"], &sets);
        let said = format!("is free and has no inertia, so it has no modes at speed; give {key}, or lock it");
        assert!(outcome.stderr.contains(&said), "{}", outcome.stderr);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    }
}

/// Wrong: balls that creep back would stand in the place of the modes of the shaft, at the 0 Hz of round-off.
#[test]
fn overdamped_balls_leave_the_modes_of_the_shaft() {
    let dir = damped_rotor();
    succeeds(campbell(&dir, "little", ["0 N", "1 N s/m"], &[]));
    let expected = modes(&dir, "little");
    assert_eq!(expected.len(), 10, "five modes at two speeds");
    for damping in ["2000 N s/m", "5000 N s/m"] {
        let out = damping.split_once(' ').unwrap().0;
        succeeds(campbell(&dir, out, ["0 N", damping], &[]));
        let found = modes(&dir, out);
        assert_eq!(found.len(), 10, "{damping}: {found:?}");
        assert!(
            found.iter().all(|[hz, share]| *hz > 50.0 && *share > 0.5),
            "{damping}: {found:?}"
        );
        // Damping hardly moves the lowest of each speed.
        for i in [0, 5] {
            assert!(
                (found[i][0] / expected[i][0] - 1.0).abs() < 0.01,
                "{damping}: {found:?} {expected:?}"
            );
        }
    }
}

/// Wrong: with a load across, modes of single balls would push those of the shaft off the list, however many are asked
/// for.
#[test]
fn modes_of_balls_alone_are_left_out_of_those_of_one_bearing() {
    let dir = damped_rotor();
    succeeds(campbell(&dir, "few", ["1500 N", "1 N s/m"], &[]));
    succeeds(campbell(&dir, "all", ["1500 N", "1 N s/m"], &["--number", "60"]));
    let (few, all) = (modes(&dir, "few"), modes(&dir, "all"));
    assert_eq!(few.len(), 10, "{few:?}");
    assert!(all.len() < 40, "{all:?}");
    for [_, share] in few.iter().chain(&all) {
        assert!(*share > 0.02, "{few:?} {all:?}");
    }
}

/// Wrong: where damping stops all modes, an error of the figure would be told, beside tables without rows.
#[test]
fn a_shaft_whose_modes_do_not_swing_is_told_of() {
    let dir = damped_rotor();
    let outcome = campbell(
        &dir,
        "none",
        ["0 N", "1e9 N s/m"],
        &[
            "--set",
            "shaft.tilt_x=locked",
            "--set",
            "shaft.tilt_y=locked",
            "--set",
            "shaft.x=locked",
            "--set",
            "shaft.y=locked",
        ],
    );
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    let expected =
        "error: no mode of the shaft or of a body swings at any of the speeds: damping stops all of them";
    assert!(outcome.stderr.contains(expected), "{}", outcome.stderr);
    assert!(!dir.path("none").exists());
}
