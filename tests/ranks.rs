//! Several ranks under a real mpirun: the same bits on any number of them, and an end for all when one fails.
//!
//! `scripts/test-mpi` builds the program with the feature `mpi`, says where it is in `RACEWAY_MPI`, and runs these.

mod faults;
mod lists;
mod memory;
mod parts;
mod stress;

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::cuts::cut_motion;
use crate::free_resume::everything;
use crate::housing;
use crate::sectors::SECTOR;
use crate::util::delivered::delivered;
use crate::util::lockstep::{assert_same_run, copy, small_motion};
use crate::util::{Dir, Outcome, SCENE};

/// Within this all ranks must have ended once one has failed; starting and stopping mpirun takes about one.
const SECONDS: Duration = Duration::from_secs(60);

fn program() -> String {
    std::env::var("RACEWAY_MPI").expect("RACEWAY_MPI names the program built with MPI; run scripts/test-mpi")
}

/// mpirun in a folder; more ranks than cores, in containers and as root.
fn mpirun(dir: &Dir) -> Command {
    let mut command = Command::new("mpirun");
    command
        .args(["--oversubscribe", "--bind-to", "none"])
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
        .env("OMPI_MCA_mpi_yield_when_idle", "1")
        .env("OMPI_MCA_btl_vader_single_copy_mechanism", "none")
        .current_dir(dir.path("."));
    command
}

fn on_ranks(dir: &Dir, ranks: usize, arguments: &[&str]) -> Outcome {
    let mut command = mpirun(dir);
    command
        .args(["-n", &ranks.to_string(), &program()])
        .args(arguments);
    Outcome::of(command.output().unwrap())
}

#[track_caller]
fn done(outcome: &Outcome) {
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
}

/// Wrong: results would depend on the machine. 200 steps, with 1 to 4 ranks of one and two threads, against the
/// program without MPI.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn motion_has_the_same_bits_on_any_number_of_ranks() {
    let dir = small_motion();
    let long = [
        "--set",
        "dynamic.duration=4 ms",
        "--set",
        "dynamic.output_every=40",
    ];
    dir.run("alone", &[&SECTOR[..], &long[..]].concat());
    for (ranks, threads) in [(1, "2"), (2, "1"), (3, "2"), (4, "1")] {
        let out = format!("ranks{ranks}");
        let run = ["run", "scene.toml", "--out", &out, "--threads", threads];
        let outcome = on_ranks(&dir, ranks, &[&run[..], &SECTOR[..], &long[..]].concat());
        done(&outcome);
        if ranks > 1 {
            assert!(
                outcome.stderr.contains(&format!("5 sectors on {ranks} ranks")),
                "{}",
                outcome.stderr
            );
        }
        assert_same_run(&dir, "alone", &out);
    }
}

/// Wrong: harmonics that ranks share would give other results than one process: 200 steps on up to 8 ranks, and
/// equilibria on up to 6.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn harmonics_have_the_same_bits_on_any_number_of_ranks() {
    let dir = small_motion();
    let long = [
        "--set",
        "solver.backend=cyclic",
        "--set",
        "dynamic.duration=4 ms",
        "--set",
        "dynamic.output_every=40",
    ];
    dir.run("alone", &long);
    // More ranks than groups of harmonics: some have none, the first of them rank 0.
    for (ranks, threads) in [(1, "2"), (2, "1"), (3, "2"), (4, "1"), (8, "1")] {
        let out = format!("ranks{ranks}");
        let run = ["run", "scene.toml", "--out", &out, "--threads", threads];
        let outcome = on_ranks(&dir, ranks, &[&run[..], &long[..]].concat());
        done(&outcome);
        let shares = outcome.stderr.contains(&format!("harmonics on {ranks} ranks"));
        assert_eq!(shares, ranks > 1, "{}", outcome.stderr);
        assert_same_run(&dir, "alone", &out);
    }
    dir.write("static.toml", SCENE);
    done(&dir.raceway(&["run", "static.toml", "--out", "alone_static"]));
    for (ranks, out) in [(2, "two"), (6, "six")] {
        done(&on_ranks(&dir, ranks, &["run", "static.toml", "--out", out]));
        for name in ["balls.csv", "shaft.csv", "step_000000.hdf"] {
            let read = |folder: &str| std::fs::read(dir.path(&format!("{folder}/{name}"))).unwrap();
            assert!(
                read("alone_static") == read(out),
                "{name} of {ranks} ranks differs"
            );
        }
    }
}

/// Wrong: a ring in an elastic housing would stand or move otherwise where ranks share its harmonics.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn a_housing_has_the_same_bits_on_any_number_of_ranks() {
    let dir = delivered();
    housing::in_motion(&dir);
    done(&dir.raceway(&["run", "motion.toml", "--out", "alone"]));
    let rest = "scenes/6010_plummer_block.toml";
    done(&dir.raceway(&["run", rest, "--out", "rest"]));
    for (ranks, threads) in [(1, "2"), (2, "1"), (3, "1")] {
        let out = format!("ranks{ranks}");
        let run = ["run", "motion.toml", "--out", &out, "--threads", threads];
        done(&on_ranks(&dir, ranks, &run));
        assert_same_run(&dir, "alone", &out);
        let out = format!("rest{ranks}");
        done(&on_ranks(
            &dir,
            ranks,
            &["run", rest, "--out", &out, "--threads", threads],
        ));
        for name in ["balls.csv", "shaft.csv", "seat_outer.csv", "step_000000.hdf"] {
            let read = |folder: &str| std::fs::read(dir.path(&format!("{folder}/{name}"))).unwrap();
            assert!(read("rest") == read(&out), "{name} of {ranks} ranks differs");
        }
    }
}

/// Wrong: balls with a film, drag and a cage would move otherwise where ranks share the rings.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn free_balls_have_the_same_bits_on_any_number_of_ranks() {
    let dir = everything();
    dir.run("alone", &[]);
    for (ranks, threads) in [(1, "2"), (2, "1"), (3, "1")] {
        let out = format!("ranks{ranks}");
        let run = ["run", "scene.toml", "--out", &out, "--threads", threads];
        done(&on_ranks(&dir, ranks, &run));
        assert_same_run(&dir, "alone", &out);
    }
    let short = ["--set", "dynamic.duration=0.2 ms"];
    done(&on_ranks(
        &dir,
        2,
        &[&["run", "scene.toml", "--out", "cut"], &short[..]].concat(),
    ));
    let whole = ["--stored-scene", "--set", "dynamic.duration=0.4 ms"];
    done(&on_ranks(&dir, 3, &[&["resume", "cut"], &whole[..]].concat()));
    assert_same_run(&dir, "alone", "cut");
}

/// Wrong: a ring with missing elements would have other bits when ranks share the harmonics of the ring that has them.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn cut_rings_have_the_same_bits_on_any_number_of_ranks() {
    let dir = cut_motion();
    dir.run("alone", &[]);
    for ranks in [2, 3] {
        let out = format!("ranks{ranks}");
        let outcome = on_ranks(&dir, ranks, &["run", "scene.toml", "--out", &out]);
        done(&outcome);
        assert!(outcome.stderr.contains(" absent nodes; "), "{}", outcome.stderr);
        assert!(
            outcome.stderr.contains(&format!("harmonics on {ranks} ranks")),
            "{}",
            outcome.stderr
        );
        assert_same_run(&dir, "alone", &out);
    }
}

/// Wrong: an equilibrium would depend on the number of ranks; more ranks than sectors included.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn equilibria_have_the_same_bits_on_any_number_of_ranks() {
    let dir = small_motion();
    dir.write("static.toml", SCENE);
    // Few sectors have their interface on all ranks, many divide it.
    for sectors in [5, 17] {
        let set = format!("solver.sectors={sectors}");
        let run = [
            "run",
            "static.toml",
            "--set",
            "solver.backend=sector",
            "--set",
            &set,
            "--out",
        ];
        let alone = format!("alone{sectors}");
        done(&dir.raceway(&[&run[..], &[&alone]].concat()));
        for ranks in [1, 2, 3, 4, 6] {
            let out = format!("{sectors}on{ranks}");
            done(&on_ranks(&dir, ranks, &[&run[..], &[&out]].concat()));
            for name in ["balls.csv", "shaft.csv", "step_000000.hdf", "mesh.hdf"] {
                let read = |folder: &str| std::fs::read(dir.path(&format!("{folder}/{name}"))).unwrap();
                assert!(read(&alone) == read(&out), "{name} of {ranks} ranks differs");
            }
        }
    }
}

/// Wrong: an interface that ranks divide would move a ring by other bits than one process.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn many_sectors_move_with_the_same_bits_on_any_number_of_ranks() {
    let dir = small_motion();
    let many = ["--set", "solver.backend=sector", "--set", "solver.sectors=17"];
    dir.run("alone", &many);
    for (ranks, threads) in [(2, "2"), (3, "1"), (4, "1")] {
        let out = format!("ranks{ranks}");
        let run = ["run", "scene.toml", "--out", &out, "--threads", threads];
        done(&on_ranks(&dir, ranks, &[&run[..], &many[..]].concat()));
        assert_same_run(&dir, "alone", &out);
    }
}

/// Wrong: a run could not move to another machine. 4 ranks, then one process without MPI, then 3 ranks.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn a_run_goes_on_with_another_number_of_ranks_bit_for_bit() {
    let dir = small_motion();
    let until = |ms: &str| ["--set".to_string(), format!("dynamic.duration={ms} ms")];
    dir.run("alone", &SECTOR);
    let [set, short] = until("0.14");
    let start = ["run", "scene.toml", "--out", "cut", &set, &short];
    done(&on_ranks(&dir, 4, &[&start[..], &SECTOR[..]].concat()));
    let [set, middle] = until("0.28");
    done(&dir.raceway(&["resume", "cut", "--stored-scene", &set, &middle]));
    let [set, whole] = until("0.4");
    done(&on_ranks(
        &dir,
        3,
        &["resume", "cut", "--stored-scene", &set, &whole],
    ));
    assert_same_run(&dir, "alone", "cut");
    copy(&dir, "cut", "copied");
    assert!(
        on_ranks(&dir, 2, &["info", "copied"]).code == Some(2),
        "one task only"
    );
}

/// Process ids of the ranks that an mpirun has started, in rank order as far as ids tell.
fn ranks_of(mpirun: u32) -> Vec<String> {
    let listed = Command::new("pgrep")
        .args(["-P", &mpirun.to_string()])
        .output()
        .unwrap();
    let text = String::from_utf8(listed.stdout).unwrap();
    text.lines().map(str::to_string).collect()
}

/// Starts a long motion on 3 ranks, sends a signal to the last of them once it moves, and waits for the end.
fn signalled(dir: &Dir, signal: &str) -> (Outcome, Duration) {
    let long = [
        "--set",
        "dynamic.duration=10 s",
        "--set",
        "dynamic.output_every=100000",
    ];
    let run = ["run", "scene.toml", "--out", "long"];
    let mut command = mpirun(dir);
    command
        .args(["-n", "3", &program()])
        .args([&run[..], &SECTOR[..], &long[..]].concat());
    let child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let begin = Instant::now();
    while !dir.path("long/step_000000.hdf").exists() {
        assert!(begin.elapsed() < SECONDS, "the run does not start");
        std::thread::sleep(Duration::from_millis(50));
    }
    let last = ranks_of(child.id()).pop().unwrap();
    let sent = Command::new("kill").args([signal, &last]).status().unwrap();
    assert!(sent.success());
    let begin = Instant::now();
    let outcome = Outcome::of(child.wait_with_output().unwrap());
    (outcome, begin.elapsed())
}

/// Wrong: a signal to one rank would leave the others waiting, or the run without a step to resume from.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn a_signal_to_one_rank_stops_all_at_the_same_step() {
    let dir = small_motion();
    let (outcome, time) = signalled(&dir, "-USR1");
    assert_eq!(outcome.code, Some(75), "{}", outcome.stderr);
    assert!(
        outcome.stderr.contains("stopped: SIGUSR1 received"),
        "{}",
        outcome.stderr
    );
    assert!(time < SECONDS, "{time:?}");
    let summary = dir.text("long/summary.json");
    assert!(summary.contains("\"status\": \"stopped: SIGUSR1"), "{summary}");
    let at = checkpoint::committed_steps(&dir.path("long"))
        .unwrap()
        .pop()
        .unwrap();
    let until = format!("dynamic.duration={} us", 20 * (at + 3));
    done(&on_ranks(
        &dir,
        2,
        &["resume", "long", "--stored-scene", "--set", &until],
    ));
}

/// Wrong: the other ranks would wait for ever for one that the system has killed.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn a_killed_rank_ends_all() {
    let dir = small_motion();
    let (outcome, time) = signalled(&dir, "-KILL");
    assert_ne!(outcome.code, Some(0));
    assert!(outcome.stderr.contains("signal 9"), "{}", outcome.stderr);
    assert!(time < SECONDS, "{time:?}");
}

/// Wrong: the clock of rank 0 would stop some ranks only.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn the_wall_time_stops_all_ranks_together() {
    let dir = small_motion();
    let long = [
        "--set",
        "dynamic.duration=10 s",
        "--set",
        "dynamic.output_every=100000",
    ];
    let run = ["run", "scene.toml", "--out", "long", "--wall-time", "00:00:08"];
    let outcome = on_ranks(&dir, 3, &[&run[..], &SECTOR[..], &long[..]].concat());
    assert_eq!(outcome.code, Some(75), "{}", outcome.stderr);
    assert!(
        outcome.stderr.contains("stopped: --wall-time 00:00:08"),
        "{}",
        outcome.stderr
    );
}

/// Runs one command on rank 0 and another on ranks 1 and 2.
fn different(dir: &Dir, first: &[&str], others: &[&str]) -> (Outcome, Duration) {
    let begin = Instant::now();
    let mut command = mpirun(dir);
    command
        .args(["-n", "1"])
        .args(first)
        .args([":", "-n", "2"])
        .args(others);
    (Outcome::of(command.output().unwrap()), begin.elapsed())
}

/// Wrong: a mesh that rank 0 cannot read, which it alone does, would leave the others waiting, or end them without
/// its reason; ranks would compute with one mesh what their scenes ask of another.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn a_bad_mesh_on_one_rank_ends_all_with_its_message() {
    let dir = small_motion();
    dir.write("bad.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    let program = program();
    let run = [
        &[&program[..], "run", "scene.toml", "--out", "out"][..],
        &SECTOR[..],
    ]
    .concat();
    let bad = [&run[..], &["--set", "inner.mesh=bad.msh"]].concat();
    for (first, others) in [(&run, &bad), (&bad, &run), (&bad, &bad)] {
        let (outcome, time) = different(&dir, first, others);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        assert!(outcome.stderr.contains("bad.msh"), "{}", outcome.stderr);
        let differ = outcome.stderr.contains("is not that of rank 0: inner.mesh from");
        assert_eq!(differ, first != others, "{}", outcome.stderr);
        assert!(time < SECONDS, "{time:?}");
    }
    assert!(
        !dir.path("out").exists(),
        "a run that fails before its start leaves no folder"
    );
}

/// Wrong: a full disk, which only rank 0 sees, would hang the run or be lost. Before the first step, and in the
/// middle of a run.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn a_full_disk_ends_all_with_its_message() {
    let dir = small_motion();
    dir.run("alone", &SECTOR);
    let size = |name: &str| {
        std::fs::metadata(dir.path(&format!("alone/{name}")))
            .unwrap()
            .len()
    };
    let (largest, table) = (size("step_000000.hdf").max(size("mesh.hdf")), size("balls.csv"));
    let longer = format!("dynamic.duration={} us", 400 * (2 * largest / table + 1));
    let program = program();
    for (out, limit) in [("start", largest / 1024 - 2), ("middle", largest / 1024 + 8)] {
        let run = [
            &[&program[..], "run", "scene.toml", "--out", out][..],
            &SECTOR[..],
        ]
        .concat();
        let run = [&run[..], &["--set", &longer, "--set", "dynamic.output_every=10"]].concat();
        let limited = format!("trap '' XFSZ; ulimit -f {limit}; exec \"$0\" \"$@\"");
        // Shared memory between ranks is a file as well: messages go through sockets here.
        let socket = ["env", "OMPI_MCA_btl=self,tcp"];
        let first = [&socket[..], &["bash", "-c", &limited], &run[..]].concat();
        let (outcome, time) = different(&dir, &first, &[&socket[..], &run[..]].concat());
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        assert!(
            outcome.stderr.contains("error: on rank 0: "),
            "{}",
            outcome.stderr
        );
        assert!(outcome.stderr.contains("File too large"), "{}", outcome.stderr);
        assert!(time < 2 * SECONDS, "{time:?}");
    }
}

/// Wrong: tasks that a launcher of another MPI has started would each do the whole run and overwrite each other.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn tasks_that_do_not_see_each_other_are_refused() {
    let dir = small_motion();
    let mut command = Command::new(program());
    command
        .args(["run", "scene.toml", "--out", "out"])
        .env_remove("OMPI_COMM_WORLD_SIZE")
        .env("SLURM_STEP_NUM_TASKS", "3")
        .current_dir(dir.path("."));
    let outcome = Outcome::of(command.output().unwrap());
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    let text = "the launcher started 3 tasks (SLURM_STEP_NUM_TASKS=3), but MPI knows of 1";
    assert!(outcome.stderr.contains(text), "{}", outcome.stderr);
    assert!(!dir.path("out").exists());
}
