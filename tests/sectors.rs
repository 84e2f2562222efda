//! `solver.backend = "sector"`: rings cut by angle, solved side by side.

use crate::util::lockstep::{assert_same_run, small_motion};
use crate::util::tables::Table;
use crate::util::{Dir, assert_close};

/// Few sectors, of unequal sizes: 54 layers of elements in 5.
pub const SECTOR: [&str; 4] = ["--set", "solver.backend=sector", "--set", "solver.sectors=5"];

/// Wrong: the number of threads would show in the results, or sectors would give another motion than the ring as a
/// whole.
#[test]
fn a_motion_in_sectors_has_the_same_bits_on_any_number_of_threads() {
    let dir = small_motion();
    let outcome = dir.run("one", &[&SECTOR[..], &["--threads", "1"]].concat());
    assert!(
        outcome.stderr.contains("inner ring: sector (5 sectors, "),
        "{}",
        outcome.stderr
    );
    for threads in ["2", "4"] {
        dir.run(threads, &[&SECTOR[..], &["--threads", threads]].concat());
        assert_same_run(&dir, "one", threads);
    }
    dir.run("whole", &["--set", "solver.backend=sparse"]);
    let forces = |folder: &str| Table::read(&dir, &format!("{folder}/balls.csv")).column("outer_force_n");
    for (a, b) in forces("one")
        .iter()
        .zip(forces("whole"))
        .filter(|(a, _)| **a > 1.0)
    {
        assert_close("force of a ball", *a, b, 1e-8);
    }
}

/// Wrong: the user could not see whether one sector is most of the work, or what a machine must hold.
#[test]
fn check_shows_the_balance_of_the_sectors() {
    let dir = small_motion();
    let outcome = dir.raceway(&[&["check", "scene.toml"], &SECTOR[..]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let sectors = outcome
        .stdout
        .lines()
        .filter(|l| l.trim().starts_with("sector "))
        .count();
    assert_eq!(sectors, 10, "five per ring: {}", outcome.stdout);
    assert!(outcome.stdout.contains("peak of rank 0"), "{}", outcome.stdout);
}

/// Wrong: a user would learn on the cluster, after the start, that rings in sectors are not stiffened by their stress.
#[test]
fn check_refuses_stiffened_rings_in_sectors_as_a_run_does() {
    let dir = small_motion();
    let stiffened = ["--set", "effects.frame_rotation={ stress_stiffening = true }"];
    let say = |command: &str, more: &[&str]| {
        let outcome = dir.raceway(&[&[command, "scene.toml"], &stiffened[..], more].concat());
        let error = outcome.stderr.lines().find(|line| line.starts_with("error: "));
        (outcome.code, error.map(str::to_string))
    };
    let refusal = "error: effects.frame_rotation.stress_stiffening is not there for the inner ring: solver.backend = \
                   \"sector\" cuts it into sectors; remove it, or set it to false";
    let expected = (Some(2), Some(refusal.to_string()));
    assert_eq!(say("check", &SECTOR), expected);
    assert_eq!(say("run", &SECTOR), expected);
    assert_eq!(say("check", &[]), (Some(0), None));
}

/// Wrong: more sectors than elements, or sectors for another solver, would be taken without a word.
#[test]
fn sectors_that_cannot_be_are_refused() {
    let refused = |dir: &Dir, arguments: &[&str], text: &str| {
        let outcome = dir.raceway(&[&["run", "scene.toml"], arguments].concat());
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        assert!(outcome.stderr.contains(text), "{}", outcome.stderr);
    };
    let dir = small_motion();
    refused(
        &dir,
        &["--set", "solver.backend=sector", "--set", "solver.sectors=4000"],
        "cannot be cut into 4000 sectors; expected 1 to 432",
    );
    refused(
        &dir,
        &["--set", "solver.sectors=4"],
        "solver.sectors is 4; expected only with backend = \"sector\"",
    );
    refused(
        &dir,
        &["--set", "solver.backend=sector", "--set", "solver.sectors=0"],
        "solver.sectors is 0",
    );
}
