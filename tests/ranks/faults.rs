//! Faults of one of two ranks, at every message of a run: all end, and the one message names the rank and the cause.
//!
//! `scripts/test-mpi` builds a second program, with the feature `inject` (`comm::inject`), and says where it is in
//! `RACEWAY_INJECTED`. A run tells all places of the program that send messages; then each gets its fault. So a new
//! place is tested as soon as it is there.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use super::{SECONDS, different, done, mpirun, program};
use crate::sectors::SECTOR;
use crate::several::flexible_pair;
use crate::util::lockstep::{copy, small_motion};
use crate::util::{Dir, Outcome, SCENE};

/// An interface that ranks divide.
const MANY: [&str; 4] = ["--set", "solver.backend=sector", "--set", "solver.sectors=17"];
/// Harmonics that ranks share, with a turning ring whose elastic part has no inertia.
const CYCLIC: [&str; 6] = [
    "--set",
    "solver.backend=cyclic",
    "--set",
    "speed.inner=1800 rpm",
    "--set",
    "effects.frame_rotation={}",
];

/// A place that sends messages: the operation, and how often rank 0 calls it in a run.
type Places = BTreeMap<String, (String, usize)>;

/// A run of two ranks.
struct Case {
    dir: Dir,
    arguments: Vec<&'static str>,
    /// Files of the program that must be among the places.
    files: &'static [&'static str],
}

/// Two ranks with a fault in the folder `out`, which a run that is resumed finds as it was.
fn with_fault(case: &Case, fault: &str) -> (Outcome, Duration) {
    let (dir, begin) = (&case.dir, Instant::now());
    let _ = std::fs::remove_dir_all(dir.path("out"));
    if dir.path("cut").exists() {
        copy(dir, "cut", "out");
    }
    let program = std::env::var("RACEWAY_INJECTED").expect("scripts/test-mpi names the program with faults");
    let mut command = mpirun(dir);
    command
        // A run that hangs ends as well, and is too long then.
        .env("MPIEXEC_TIMEOUT", (SECONDS.as_secs() + 5).to_string())
        .env("RACEWAY_INJECT", fault)
        .args(["-n", "2", &program, "--threads", "1"])
        .args(&case.arguments);
    (Outcome::of(command.output().unwrap()), begin.elapsed())
}

fn places(case: &Case) -> Places {
    let (outcome, _) = with_fault(case, "list");
    done(&outcome);
    let mut places = Places::new();
    for line in outcome.stderr.lines() {
        if let ["op", operation, place] = line.split(' ').collect::<Vec<&str>>()[..] {
            let found = places
                .entry(place.to_string())
                .or_insert((operation.to_string(), 0));
            found.1 += 1;
        }
    }
    for file in case.files {
        assert!(
            places.keys().any(|place| place.contains(file)),
            "no message from {file}: {places:?}"
        );
    }
    places
}

/// The cases of all kinds of runs that ranks share.
fn cases() -> Vec<Case> {
    let run = |dir: Dir, scene, more: &[&'static str], files| Case {
        dir,
        arguments: [&["run", scene, "--out", "out"], more].concat(),
        files,
    };
    let with = |scene: String| {
        let dir = small_motion();
        dir.write("still.toml", scene);
        dir
    };
    let sweep = "[sweep]\nkey = \"effects.radial_force.value\"\nvalues = [\"0.3 kN\", \"0.4 kN\"]\n";
    let series = "[quasi_static]\nduration = \"0.6 ms\"\nstep = \"0.2 ms\"\n\n[speed]\ninner = \"12000 rpm\"\n\n\
                  [effects.gravity]\nacceleration = \"9.81 m/s2\"\ndirection = [0, -1, 0]";
    let turning = small_motion();
    let scene = turning.text("scene.toml") + "\n[effects.frame_rotation]\n";
    turning.write("scene.toml", scene);
    let cut = small_motion();
    cut.run(
        "cut",
        &[&SECTOR[..], &["--set", "dynamic.duration=0.2 ms"]].concat(),
    );
    vec![
        run(
            turning,
            "scene.toml",
            &MANY,
            &[
                "results/src/folder.rs",
                "results/src/survey.rs",
                "ring/src/division/mod.rs",
                "ring/src/substructures.rs",
                "solver/src/sector/factor.rs",
                "solver/src/sector/reduction.rs",
                "solver/src/sector/solve.rs",
                "ring/src/stress/shared.rs",
                "results/src/stop.rs",
                "cli/motion.rs",
                "cli/main.rs",
            ],
        ),
        run(
            small_motion(),
            "scene.toml",
            &CYCLIC,
            &[
                "solver/src/cyclic/factor.rs",
                "solver/src/cyclic/definite.rs",
                "cli/motion.rs",
            ],
        ),
        run(
            with(SCENE.replace("[static]", series)),
            "still.toml",
            &[&SECTOR[..], &["--set", "output.stress=integration_points"]].concat(),
            &["cli/quasi_static.rs", "ring/src/stress/shared.rs"],
        ),
        run(
            with(SCENE.replace("[static]", sweep)),
            "still.toml",
            &SECTOR,
            &["cli/run.rs", "solver/src/sector/columns.rs"],
        ),
        Case {
            dir: cut,
            arguments: vec![
                "resume",
                "out",
                "--stored-scene",
                "--set",
                "dynamic.duration=0.4 ms",
            ],
            files: &["cli/resume.rs"],
        },
    ]
    .into_iter()
    .chain(lists())
    .collect()
}

/// The same of lists of bearings: in motion, at rest, and one that goes on.
fn lists() -> Vec<Case> {
    let motion = "[speed]\ninner = \"1800 rpm\"\n[output]\nreduction = { every = 1 }\n\
                  [dynamic]\nduration = \"80 us\"\nstep = \"20 us\"\noutput_every = 2\nledger_tolerance = 1e-2\n";
    let sweep = "[effects.radial_force]\nvalue = \"0.5 kN\"\ndirection = \"30 deg\"\n\
                 [sweep]\nkey = \"effects.radial_force.value\"\nvalues = [\"0.2 kN\", \"0.5 kN\"]\n";
    let cut = flexible_pair(motion);
    let short = ["--set", "dynamic.duration=40 us"];
    done(&cut.raceway(&[&["run", "pair.toml", "--out", "cut"], &short[..]].concat()));
    let run = vec!["run", "pair.toml", "--out", "out"];
    vec![
        Case {
            dir: flexible_pair(motion),
            arguments: run.clone(),
            files: &["cli/several_motion.rs", "solver/src/cyclic/factor.rs"],
        },
        Case {
            dir: flexible_pair(sweep),
            arguments: run,
            files: &["cli/several_rest.rs"],
        },
        Case {
            dir: cut,
            arguments: vec![
                "resume",
                "out",
                "--stored-scene",
                "--set",
                "dynamic.duration=80 us",
            ],
            files: &["cli/several_state.rs"],
        },
    ]
}

/// The first message of a place and one of the middle, when it sends `count`.
fn first_and_middle(count: usize) -> Vec<usize> {
    if count > 2 {
        vec![1, count / 2 + 1]
    } else {
        vec![1]
    }
}

/// Gives each place of all cases its fault on both ranks, at the `numbers` of its messages: those of the `wanted`
/// operations.
fn for_all(
    kind: &str,
    wanted: impl Fn(&str) -> bool,
    numbers: impl Fn(usize) -> Vec<usize>,
    check: impl Fn(&str, usize, &str, &Outcome),
) {
    let mut n_faults = 0;
    let mut seen = Places::new();
    for case in cases() {
        let mut new = places(&case);
        new.retain(|place, (operation, _)| wanted(operation) && !seen.contains_key(place));
        for (place, (operation, count)) in &new {
            for (number, rank) in numbers(*count).into_iter().flat_map(|n| [(n, 0), (n, 1)]) {
                let fault = format!("{kind} {rank} {place} {number}");
                let (outcome, time) = with_fault(&case, &fault);
                println!(
                    "{operation}: {fault}: exit code {:?}, {:.1} s",
                    outcome.code,
                    time.as_secs_f64()
                );
                assert!(time < SECONDS, "{fault}: {time:?}: {}", outcome.stderr);
                check(&fault, rank, place, &outcome);
                n_faults += 1;
            }
        }
        seen.extend(new);
    }
    println!("{n_faults} faults at {} places", seen.len());
    assert!(n_faults > 0);
}

/// The lines that say why a run has ended.
fn errors(outcome: &Outcome) -> Vec<&str> {
    let lines = outcome.stderr.lines();
    lines.filter(|line| line.starts_with("error: ")).collect()
}

/// Wrong: a rank that fails alone, in whatever phase, would leave the others waiting, or the user without its reason.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn a_failure_of_one_rank_at_every_agreement_ends_all_with_its_message() {
    let wanted = |operation: &str| operation == "agree";
    for_all("error", wanted, first_and_middle, |fault, rank, _, outcome| {
        assert!(
            matches!(outcome.code, Some(2 | 3)),
            "{fault}: {:?} {}",
            outcome.code,
            outcome.stderr
        );
        let errors = errors(outcome);
        let (rank, text) = (format!("on rank {rank}: "), "injected failure");
        assert!(
            errors.len() == 1 && errors[0].contains(&rank) && errors[0].contains(text),
            "{fault}: {}",
            outcome.stderr
        );
    });
}

/// Wrong: a fault of the program on one rank would leave the others waiting for its message.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn a_panic_of_one_rank_at_every_message_ends_all_with_its_message() {
    let middle = |count| vec![count / 2 + 1];
    for_all(
        "panic",
        |_| true,
        middle,
        |fault, rank, place, outcome| {
            assert_eq!(outcome.code, Some(101), "{fault}: {}", outcome.stderr);
            let text = format!("error: on rank {rank}: a fault of the program:");
            assert_eq!(errors(outcome), [text], "{fault}: {}", outcome.stderr);
            assert!(
                outcome.stderr.contains(&format!("injected at {place}")),
                "{fault}: {}",
                outcome.stderr
            );
        },
    );
}

/// Wrong: a rank whose numbers are not those of the others, and that fails alone for them, would leave them waiting:
/// it would save a state or try a smaller step, which the others do not.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn a_computation_that_fails_on_one_rank_ends_all_with_its_message() {
    let mut n_alone = 0;
    for (case, places) in [
        (
            0,
            &["sector/solve.rs", "sector/columns.rs", "sector/halves.rs"][..],
        ),
        (1, &["cyclic/factor.rs"]),
        (3, &["sector/solve.rs", "sector/columns.rs"]),
        (5, &["cyclic/factor.rs"]),
        (6, &["cyclic/factor.rs"]),
    ]
    .map(|(case, files)| {
        let case = cases().swap_remove(case);
        let mut places = places(&case);
        places.retain(|place, (operation, _)| {
            operation != "agree" && files.iter().any(|file| place.contains(file))
        });
        (case, places)
    }) {
        assert!(!places.is_empty());
        for (place, (operation, count)) in &places {
            for rank in [0, 1] {
                let fault = format!("nan {rank} {place} {}", count / 2 + 1);
                let (outcome, time) = with_fault(&case, &fault);
                println!(
                    "{operation}: {fault}: {:?}, {time:?}: {}",
                    outcome.code, outcome.stderr
                );
                assert!(time < SECONDS, "{fault}: {time:?}: {}", outcome.stderr);
                // Some numbers are computed again in another round.
                if outcome.code == Some(0) {
                    continue;
                }
                assert_eq!(outcome.code, Some(3), "{fault}: {}", outcome.stderr);
                let errors = errors(&outcome);
                assert_eq!(errors.len(), 1, "{fault}: {}", outcome.stderr);
                // Wrong numbers that are sent on make all ranks fail with one message.
                let other = format!("on rank {}: ", 1 - rank);
                assert!(!errors[0].contains(&other), "{fault}: {}", outcome.stderr);
                n_alone += usize::from(errors[0].contains(&format!("on rank {rank}: ")));
            }
        }
    }
    assert!(n_alone > 0, "no rank has failed alone");
}

/// Wrong: a rank whose scene cannot be read, or says something else, or that does not see the folder of the results,
/// would leave the others waiting, or compute something else than they.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn what_one_rank_alone_cannot_read_ends_all_with_its_message() {
    let dir = small_motion();
    dir.run(
        "cut",
        &[&SECTOR[..], &["--set", "dynamic.duration=0.2 ms"]].concat(),
    );
    let program = program();
    for backend in [&SECTOR[..], &CYCLIC[..]] {
        let run = [&[&program[..], "run", "scene.toml", "--out", "out"][..], backend].concat();
        let refused = [&run[..], &["--set", "bearing.balls=no number"]].concat();
        let other = [&run[..], &["--set", "dynamic.step=10 us"]].concat();
        let resume = [&program[..], "resume", "cut", "--stored-scene"];
        let resume = [&resume[..], &["--set", "dynamic.duration=0.4 ms"]].concat();
        let elsewhere = [&["env", "-C", "/"][..], &resume].concat();
        for (good, bad, text) in [
            (&run, &refused, "bearing.balls"),
            (&run, &other, "is not that of rank 0: dynamic.step"),
            (&resume, &elsewhere, "cut is no folder"),
        ] {
            for rank in [0, 1] {
                let (first, others) = if rank == 0 { (bad, good) } else { (good, bad) };
                let (outcome, time) = different(&dir, first, others);
                assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
                let errors = errors(&outcome);
                // Ranks compare their scenes with that of rank 0.
                let rank = if text.contains("rank 0") { 1 } else { rank };
                assert_eq!(errors.len(), 1, "{}", outcome.stderr);
                assert!(
                    errors[0].contains(&format!("on rank {rank}: ")) && errors[0].contains(text),
                    "{}",
                    outcome.stderr
                );
                assert!(time < SECONDS, "{time:?}");
            }
        }
    }
}
