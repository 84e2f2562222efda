//! Failing and killed writers: what has its final name is whole, what was acknowledged is there.
//!
//! Writers run as children of the test: the test binary starts itself with [`FOLDER`] set and only [`writer`]
//! selected. This is a test binary of its own, and its tests take turns: a child inherits the files that are open
//! when it starts, and with them HDF5's locks.

#[path = "suite/fixture.rs"]
mod fixture;

use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::{Mutex, MutexGuard};
use std::{env, fs};

use checkpoint::{FolderLock, Output, Storage, committed_steps, read_step, rebuild_index};

use fixture::{bare_record, bodies};

/// Held by the one test that runs.
static TURN: Mutex<()> = Mutex::new(());

fn turn() -> MutexGuard<'static, ()> {
    // A test that failed while holding it has nothing that others need.
    TURN.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// Folder the child writes to.
const FOLDER: &str = "RACEWAY_TEST_WRITER_FOLDER";

/// The child: writes steps until it is stopped or fails, printing each step it was told is committed. Run as a
/// normal test it has no folder and checks only that.
#[test]
fn writer() {
    let Some(folder) = env::var_os(FOLDER) else { return };
    let result = Output::create(Path::new(&folder), &bodies(), Storage::default());
    let mut output = result.unwrap_or_else(|error| stop(&error));
    for step in 0.. {
        let mut record = bare_record(step);
        // About 60 steps fit into the limit of the test below; the state grows until one step does not.
        record.state.insert(
            "load".to_string(),
            checkpoint::StateArray::Real(vec![0.5; 1000 * step as usize]),
        );
        output.write_step(&record).unwrap_or_else(|error| stop(&error));
        println!("committed {step}");
    }
}

fn stop(error: &checkpoint::CheckpointError) -> ! {
    println!("failed {error}");
    std::process::exit(1)
}

/// The command line that starts [`writer`], quoted for a shell.
fn writer_command() -> String {
    let binary = env::current_exe().unwrap();
    format!(
        "exec '{}' --exact writer --nocapture --test-threads=1",
        binary.display()
    )
}

fn committed_in(line: &str) -> Option<u64> {
    line.split_once("committed ")?.1.trim().parse().ok()
}

/// Wrong if a kill lost an acknowledged step, or left a file under a final name that does not read back.
#[test]
fn a_killed_writer_leaves_only_whole_steps() {
    let _turn = turn();
    for acknowledged in [1, 4, 9, 16] {
        let dir = tempfile::tempdir().unwrap();
        let mut child = Command::new("sh")
            .args(["-c", &writer_command()])
            .env(FOLDER, dir.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let last = lines
            .find_map(|line| committed_in(&line.unwrap()).filter(|&step| step >= acknowledged))
            .unwrap();
        child.kill().unwrap();
        child.wait().unwrap();
        let steps = committed_steps(dir.path()).unwrap();
        assert!(
            steps.contains(&last),
            "step {last} was acknowledged, committed are {steps:?}"
        );
        for &step in &steps {
            let read = read_step(&dir.path().join(checkpoint::step_file_name(step))).unwrap();
            assert_eq!(read.points, bare_record(step).points);
        }
        let resumed = Output::resume(
            FolderLock::acquire(dir.path()).unwrap(),
            &bodies(),
            Storage::default(),
            last,
        )
        .unwrap();
        resumed.output.finish().unwrap();
        assert_eq!(rebuild_index(dir.path()).unwrap().n_steps as u64, last + 1);
    }
}

/// Wrong if a file the system refuses to complete appeared under its final name, if the message lacked the file or
/// the system's reason, or if the program crashed or hung on the way out. A limit on the file size stands for a
/// full disk: the write fails in the same place, with another reason.
#[test]
fn a_full_disk_leaves_no_half_file() {
    let _turn = turn();
    let dir = tempfile::tempdir().unwrap();
    let mut child = Command::new("bash")
        .args([
            "-c",
            &format!("trap '' XFSZ; ulimit -f 100; {}", writer_command()),
        ])
        .env(FOLDER, dir.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut text = String::new();
    child.stdout.take().unwrap().read_to_string(&mut text).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(1), "{text}");
    let last = text.lines().filter_map(committed_in).next_back().unwrap();
    let failed = text
        .lines()
        .find_map(|line| line.split_once("failed "))
        .unwrap()
        .1;
    let expected = format!(
        "cannot write {}",
        dir.path().join(checkpoint::step_file_name(last + 1)).display()
    );
    assert!(
        failed.starts_with(&expected) && failed.ends_with("File too large"),
        "{failed}"
    );
    assert_eq!(
        committed_steps(dir.path()).unwrap(),
        (0..=last).collect::<Vec<_>>()
    );
    let names = fs::read_dir(dir.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let odd: Vec<_> = names.filter(|name| name.ends_with(".tmp")).collect();
    assert!(odd.is_empty(), "left behind: {odd:?}");
    read_step(&dir.path().join(checkpoint::step_file_name(last))).unwrap();
}

/// Wrong if a folder that vanished or cannot be written gave a message without the path or the system's reason.
#[test]
fn a_folder_that_cannot_be_written_is_named() {
    let _turn = turn();
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("results");
    let mut output = Output::create(&folder, &bodies(), Storage::default()).unwrap();
    fs::remove_dir_all(&folder).unwrap();
    let text = output.write_step(&bare_record(0)).unwrap_err().to_string();
    let path = folder.join("step_000000.hdf");
    assert_eq!(
        text,
        format!("cannot write {}: No such file or directory", path.display())
    );
    fs::write(dir.path().join("file"), "").unwrap();
    let text = Output::create(&dir.path().join("file"), &bodies(), Storage::default())
        .unwrap_err()
        .to_string();
    assert!(
        text.starts_with(&format!(
            "cannot create folder {}: ",
            dir.path().join("file").display()
        )),
        "{text}"
    );
}
