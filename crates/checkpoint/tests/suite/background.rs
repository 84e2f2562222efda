//! Writing on threads of its own.

use std::fs;

use checkpoint::{BackgroundOutput, CheckpointError, Output, Storage, committed_steps};

use crate::fixture::{bodies, record};

/// Wrong if the queue dropped, reordered or changed a step.
#[test]
fn the_threads_write_the_same_files() {
    let (direct, queued) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let mut output = Output::create(direct.path(), &bodies(), Storage::default()).unwrap();
    let other = Output::create(queued.path(), &bodies(), Storage::default()).unwrap();
    let mut background = BackgroundOutput::start(other, 2, Vec::new()).unwrap();
    for step in 0..10 {
        output.write_step(&record(step)).unwrap();
        background.write_step(record(step)).unwrap();
    }
    output.finish().unwrap();
    background.finish().unwrap().output.finish().unwrap();
    let mut names: Vec<_> = fs::read_dir(direct.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    names.sort();
    assert_eq!(names.len(), 14);
    for name in names {
        let read = |dir: &tempfile::TempDir| fs::read(dir.path().join(&name)).unwrap();
        assert!(read(&direct) == read(&queued), "{name:?} differs");
    }
}

/// Wrong if a run went on after a step could not be written, or the reason were lost.
#[test]
fn an_error_on_a_thread_reaches_the_run() {
    let dir = tempfile::tempdir().unwrap();
    let output = Output::create(dir.path(), &bodies(), Storage::default()).unwrap();
    let mut background = BackgroundOutput::start(output, 1, Vec::new()).unwrap();
    background.write_step(record(5)).unwrap();
    // The second write of step 5 fails on a thread; one of the next calls must say so.
    let error = (0..1000)
        .find_map(|_| background.write_step(record(5)).err())
        .unwrap();
    assert!(
        matches!(error, CheckpointError::StepOrder { step: 5, last: 5, .. }),
        "{error}"
    );
    assert!(matches!(
        background.write_step(record(6)),
        Err(CheckpointError::WriterStopped)
    ));
    assert!(background.finish().is_err());
    assert_eq!(committed_steps(dir.path()).unwrap(), [5]);
}

/// Wrong if a run that ends early, on an error elsewhere, lost steps it had already handed over.
#[test]
fn steps_handed_over_are_written_without_finish() {
    let dir = tempfile::tempdir().unwrap();
    let output = Output::create(dir.path(), &bodies(), Storage::default()).unwrap();
    let mut background = BackgroundOutput::start(output, 8, Vec::new()).unwrap();
    for step in 0..8 {
        background.write_step(record(step)).unwrap();
    }
    drop(background);
    assert_eq!(committed_steps(dir.path()).unwrap(), (0..8).collect::<Vec<_>>());
}
