//! Smaller step files: a restart state in every n-th of them, displacement in f32, stress within an error bound.

use std::sync::OnceLock;

use checkpoint::{StepRecord, committed_steps, has_state, read_any_step, read_step, step_file_name};

use crate::interruption::{outcome_of, signal, wait_for_steps};
use crate::resume::{moved, refused, resumed};
use crate::util::lockstep::{assert_same_run, copy, small_motion};
use crate::util::{Dir, Files};

/// All that makes files smaller.
const SMALL: [&str; 6] = [
    "--set",
    "output.displacement=f32",
    "--set",
    "output.restart_every=4",
    "--set",
    "output.stress_error=10 kPa",
];

/// The small motion run to its end as `small`; once for all tests.
fn small() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = small_motion();
        dir.run("small", &SMALL);
        dir.snapshot()
    }))
}

/// Leaves in the folder `cut` what a kill after step `last` would: no later steps, no end of the run.
fn kill_after(dir: &Dir, last: u64) {
    copy(dir, "small", "cut");
    for step in committed_steps(&dir.path("cut")).unwrap() {
        if step > last {
            std::fs::remove_file(dir.path("cut").join(step_file_name(step))).unwrap();
        }
    }
    for name in ["summary.json", "run.vtkhdf"] {
        std::fs::remove_file(dir.path("cut").join(name)).unwrap();
    }
}

fn step(dir: &Dir, folder: &str, step: u64) -> StepRecord {
    read_step(&dir.path(folder).join(step_file_name(step))).unwrap()
}

/// Wrong: files would hold other values than the same run without these keys, beyond what was asked for, or the run
/// itself would be another.
#[test]
fn small_files_hold_the_same_run() {
    let (dir, plain) = (small(), moved());
    for name in ["balls.csv", "shaft.csv", "energy.csv"] {
        assert_eq!(
            dir.text(&format!("small/{name}")),
            plain.text(&format!("whole/{name}")),
            "{name}"
        );
    }
    for n in 0..=20 {
        let (small, whole) = (step(&dir, "small", n), step(&plain, "whole", n));
        assert_eq!(small.state.is_empty(), n % 4 != 0, "step {n}");
        if !small.state.is_empty() {
            assert_eq!(
                format!("{:?}", small.state),
                format!("{:?}", whole.state),
                "step {n}"
            );
        }
        let (a, b) = (&small.points, &whole.points);
        assert_eq!((&a.force_inner, &a.force_outer), (&b.force_inner, &b.force_outer));
        let pairs = a
            .displacement
            .as_flattened()
            .iter()
            .zip(b.displacement.as_flattened());
        for (small, whole) in pairs {
            assert_eq!(*small, f64::from(*whole as f32), "step {n}");
        }
        let (a, b) = (a.stress.as_ref().unwrap(), b.stress.as_ref().unwrap());
        let differences = a
            .as_flattened()
            .iter()
            .zip(b.as_flattened())
            .map(|(a, b)| (a - b).abs());
        let largest = differences.fold(0.0, f64::max);
        assert!(largest > 1e3 && largest <= 1e4, "step {n}: {largest} Pa");
    }
}

/// Wrong: a kill would lose more than the steps since the last state, a resumed run would come to other bits, or would
/// not say where it starts.
#[test]
fn a_kill_between_states_repeats_the_steps_to_the_same_bits() {
    let dir = small();
    kill_after(&dir, 14);
    let outcome = resumed(&dir, &["cut"]);
    for part in [
        "the newest restart state is that of step 12; the steps after it, to 14, are computed again",
        "resuming cut after step 12 of 20",
        "what the run wrote after step 12 is kept in cut/superseded_1",
    ] {
        assert!(outcome.stderr.contains(part), "{} lacks {part:?}", outcome.stderr);
    }
    assert_same_run(&dir, "small", "cut");
    for n in [13, 14] {
        assert_eq!(step(&dir, "cut/superseded_1", n), step(&dir, "small", n));
    }
}

/// Wrong: a run would go on from nothing, or nobody could tell from where it can.
#[test]
fn steps_without_a_state_are_refused_and_told_apart() {
    let dir = small();
    refused(
        &dir,
        &["small", "--step", "14"],
        &[
            "step 14 of small holds no restart state (output.restart_every); the nearest that do are 12 and 16",
        ],
    );
    let printed = |arguments: &[&str]| dir.raceway(arguments).stdout;
    let text = printed(&["info", "small"]);
    assert!(
        text.contains("restart    steps 0, 4, 8, 12, 16, 20 hold a state\n"),
        "{text}"
    );
    let text = printed(&["info", "small/step_000014.hdf"]);
    assert!(
        text.contains("restart    no state; a run goes on from an earlier step\n"),
        "{text}"
    );
    let text = printed(&["info", "small/step_000016.hdf"]);
    assert!(!text.contains("restart    "), "{text}");
    let text = printed(&[&["check", "scene.toml"], &SMALL[..]].concat());
    assert!(
        text.contains(", 21 step files (6 with a restart state), "),
        "{text}"
    );
}

/// Wrong: packing would take the last state away, or lose what small files hold.
#[test]
fn packing_leaves_a_state_to_go_on_from() {
    let dir = small();
    kill_after(&dir, 14);
    let before: Vec<_> = (0..=14).map(|n| step(&dir, "cut", n)).collect();
    let outcome = dir.raceway(&["pack", "cut", "--keep", "1"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert_eq!(committed_steps(&dir.path("cut")).unwrap(), [12, 13, 14]);
    for (n, record) in before.iter().enumerate() {
        assert!(
            read_any_step(&dir.path("cut"), n as u64).unwrap() == *record,
            "step {n}"
        );
    }
    resumed(&dir, &["cut"]);
    assert_eq!(dir.raceway(&["pack", "cut", "--undo"]).code, Some(0));
    assert_same_run(&dir, "small", "cut");
}

/// Wrong: a run that is told to stop where the file of its step holds no state would go on from far back.
#[test]
fn a_run_that_stops_leaves_its_state() {
    let dir = small_motion();
    let long = [
        "--ignore-disk-space",
        "--set",
        "dynamic.duration=0.4 s",
        "--set",
        "output.restart_every=1000000",
    ];
    let mut child = dir.start(&[&["run", "scene.toml", "--out", "long"], &long[..]].concat());
    let lines = wait_for_steps(&mut child);
    std::thread::sleep(std::time::Duration::from_millis(100));
    signal(&child, "TERM");
    let outcome = outcome_of(child, lines);
    assert_eq!(outcome.code, Some(75), "{}", outcome.stderr);
    let steps = committed_steps(&dir.path("long")).unwrap();
    let last = *steps.last().unwrap();
    assert!(
        last > 0
            && outcome
                .stderr
                .contains(&format!("the state after step {last} of "))
    );
    for &n in &steps {
        let path = dir.path("long").join(step_file_name(n));
        assert_eq!(has_state(&path).unwrap(), n == 0 || n == last, "step {n}");
    }
    let until = format!("dynamic.duration={} us", 20 * (last + 2));
    resumed(&dir, &["long", "--stored-scene", "--set", &until]);
    dir.run("whole", &["--set", &until]);
    assert_eq!(dir.text("long/energy.csv"), dir.text("whole/energy.csv"));
}
