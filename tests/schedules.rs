//! Loads that change in time and the gyroscopic moment, through the whole program.

use std::path::Path;

use crate::util::tables::{Table, number, summary};
use crate::util::{Dir, RIGID, SCENE, with_line};

/// The scene of the tests in motion with rigid rings, its radial force of 1 kN coming at 0.1 ms.
fn late_force() -> Dir {
    let moving = with_line(
        "[static]",
        "[static]",
        "[dynamic]\nduration = \"0.4 ms\"\nstep = \"10 us\"",
    );
    let late = "[effects.radial_force]\nschedule.step = { at = \"0.1 ms\" }";
    Dir::with_scene(&moving.replace("[effects.radial_force]", late))
}

/// Wrong: a user whose loads come up from zero would be told to lock the shaft, and not how to start without load.
#[test]
fn a_motion_without_load_at_the_start_says_how_it_can_start() {
    let ramp = "schedule.ramp = { start = \"0 ms\", duration = \"0.1 ms\" }";
    let text = late_force().text("scene.toml");
    let text = text.replace("schedule.step = { at = \"0.1 ms\" }", ramp);
    let dir =
        Dir::with_scene(&text.replace("[effects.axial_force]", &format!("[effects.axial_force]\n{ramp}")));
    let run = |out: &str, sets: &[&str]| {
        let sets = [&["--set", "shaft.mass=0.5 kg"], sets].concat();
        dir.raceway(&[&["run", "scene.toml", "--out", out][..], &RIGID[..], &sets[..]].concat())
    };
    let said = run("out", &[]);
    assert_eq!(said.code, Some(2), "{}", said.stderr);
    for part in ["[dynamic.start.free]", "is free but nothing resists it"] {
        assert!(said.stderr.contains(part), "{part}: {}", said.stderr);
    }
    let said = run("free", &["--set", "dynamic.start.free={}"]);
    assert_eq!(said.code, Some(0), "{}", said.stderr);
}

/// If this failed, a load would act at another time than its schedule says, or with another size: until its time
/// nothing moves, and then its work is the force times the way of the shaft.
#[test]
fn a_load_acts_from_its_time_on() {
    let dir = late_force();
    // A shaft with mass: without any, it would follow the balls without inertia.
    dir.run("out", &[&RIGID[..], &["--set", "shaft.mass=0.5 kg"]].concat());
    let (shaft, energy) = (
        Table::read(&dir, "out/shaft.csv"),
        Table::read(&dir, "out/energy.csv"),
    );
    let (x, z) = (shaft.column("x_m"), shaft.column("z_m"));
    let work = energy.column("load_work_j");
    for i in 0..=10 {
        // The start settles to 1e-10 of the loads, which Newton follows.
        assert!(x[i].abs() < 1e-12, "step {i}: {}", x[i]);
    }
    assert!(x[40] > 1e-7, "{}", x[40]);
    for i in 0..=40 {
        // 1 kN along x, 2 kN along z; the work is summed over 40 steps of up to 1e-3 J.
        let expected = 1000.0 * x[i] + 2000.0 * (z[i] - z[0]);
        assert!(
            (work[i] - expected).abs() < 1e-14,
            "step {i}: {} {expected}",
            work[i]
        );
    }
}

/// If this failed, a scene of the folder `scenes` would not run. Their first 0.2 ms, on their own meshes.
#[test]
fn the_delivered_transients_run() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    for name in ["7010c_radial_step", "7010c_impact", "7010c_speed_change"] {
        let dir = Dir::empty();
        let scene = scenes.join(format!("{name}.toml")).display().to_string();
        let outcome = dir.raceway(&["run", &scene, "--out", "out", "--set", "dynamic.duration=0.2 ms"]);
        assert_eq!(outcome.code, Some(0), "{name}: {}", outcome.stderr);
        assert_eq!(Table::read(&dir, "out/shaft.csv").rows.len(), 11, "{name}");
    }
}

/// If this failed, the gyroscopic moment of a scene would not reach the solver, or a scene without it would feel it.
#[test]
fn the_gyroscopic_moment_lowers_the_outer_contact_angle() {
    let spinning = |effects: &str| {
        let tables = format!("{effects}\n\n[speed]\ninner = \"30000 rpm\"\n\n[static]");
        Dir::with_scene(&SCENE.replace("[static]", &tables))
    };
    let angle = |effects: &str| {
        let dir = spinning(effects);
        dir.run("out", &RIGID);
        let summary = summary(&dir, "out");
        let named = summary["effects"].to_string().contains("gyroscopic_moment");
        assert_eq!(named, effects.contains("gyroscopic_moment"), "{effects}");
        number(&summary, "/balls/0/outer/contact_angle_rad")
    };
    let without = angle("[effects.ball_centrifugal]");
    let with = angle("[effects.ball_centrifugal]\n[effects.gyroscopic_moment]");
    let inner = angle("[effects.ball_centrifugal]\n[effects.gyroscopic_moment]\ninner_share = 2");
    // 1.8 deg for 2 kN of thrust alone (crates/dynamics/tests/gyroscopic.rs); here with 1 kN of radial force.
    assert!((0.01..0.06).contains(&(without - with)), "{without} {with}");
    assert!(
        (inner - without).abs() > 1e-3 && (inner - with).abs() > 1e-3,
        "{inner}"
    );
}

/// If this failed, a shaft that a scene drives would be elsewhere, or its work, or that of the gyroscopic moment,
/// would be missing in the ledger.
#[test]
fn a_driven_shaft_moves_in_time() {
    let scene = late_force().text("scene.toml");
    let driven = "z = { value = \"30 um\", schedule.ramp = { from = 1, to = 2, start = \"0 s\", duration = \"0.2 ms\" \
                  } }";
    let effects = "[speed]\ninner = \"15000 \
                   rpm\"\n\n[effects.ball_centrifugal]\n\n[effects.gyroscopic_moment]\n\n[effects.radial_force]";
    let scene = scene
        .replace("z = \"free\"", driven)
        .replace("[effects.radial_force]", effects);
    let dir = Dir::with_scene(&scene);
    dir.run("out", &[&RIGID[..], &["--set", "shaft.mass=0.5 kg"]].concat());
    let z = Table::read(&dir, "out/shaft.csv").column("z_m");
    for (i, z) in z.iter().enumerate() {
        let expected = 30e-6 + 1.5e-6 * (i as f64).min(20.0);
        assert!((z - expected).abs() < 1e-18, "step {i}: {z}");
    }
    let energy = Table::read(&dir, "out/energy.csv");
    for (defect, total) in energy.column("defect_j").iter().zip(energy.column("total_j")) {
        assert!(defect.abs() < 1e-9 * total, "{defect} of {total}");
    }
}

/// If this failed, an imposed displacement would not be where its schedule has it, or balls would not feel it: with
/// rigid rings, the last instant has the forces of a shaft that is held there.
#[test]
fn a_driven_shaft_follows_its_schedule() {
    let quasi = "[quasi_static]\nduration = \"2 ms\"\nstep = \"0.5 ms\"";
    let scene = with_line("[static]", "[static]", quasi);
    let driven =
        "z = { value = \"40 um\", schedule.ramp = { from = 0.5, start = \"0 s\", duration = \"1 ms\" } }";
    let dir = Dir::with_scene(&scene.replace("z = \"free\"", driven));
    dir.run("out", &RIGID);
    let z = Table::read(&dir, "out/shaft.csv").column("z_m");
    for (found, expected) in z.iter().zip([20e-6, 30e-6, 40e-6, 40e-6, 40e-6]) {
        assert!((found - expected).abs() < 1e-19, "{z:?}");
    }
    let held = Dir::with_scene(SCENE);
    held.run("out", &[&RIGID[..], &["--set", "shaft.z=40 um"]].concat());
    let force = |dir: &Dir| Table::read(dir, "out/balls.csv").column("inner_force_n");
    let (driven, held) = (force(&dir), force(&held));
    assert_eq!((driven.len(), held.len()), (5 * 18, 18));
    for (a, b) in driven[4 * 18..].iter().zip(&held) {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
}
