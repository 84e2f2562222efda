//! Rules of the result folder: nothing is overwritten, steps grow, a resumed run continues the numbering.

use std::fs;
use std::path::Path;

use checkpoint::{
    Body, CellKind, CheckpointError, FolderLock, Output, Storage, committed_steps, newest_step, read_step,
    step_file_name,
};

use crate::fixture::{N_POINTS, bare_record, bodies, record};

fn create(dir: &Path) -> Output {
    Output::create(dir, &bodies(), Storage::default()).unwrap()
}

fn lock(dir: &Path) -> FolderLock {
    FolderLock::acquire(dir).unwrap()
}

fn write_steps(dir: &Path, steps: impl IntoIterator<Item = u64>) {
    let mut output = create(dir);
    for step in steps {
        output.write_step(&bare_record(step)).unwrap();
    }
}

/// Wrong if a second run could write into the results of a first one, or the message did not say what is there.
#[test]
fn existing_results_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    write_steps(dir.path(), 0..3);
    let before = fs::read(dir.path().join("mesh.hdf")).unwrap();
    let error = Output::create(dir.path(), &bodies(), Storage::default()).unwrap_err();
    let text = error.to_string();
    for part in [
        "already holds results",
        "3 steps from 0 to 2",
        "mesh.hdf",
        "resume this run",
    ] {
        assert!(text.contains(part), "{text} lacks {part}");
    }
    assert_eq!(fs::read(dir.path().join("mesh.hdf")).unwrap(), before);
}

/// Wrong if a scene copied into the folder, or the temporary file of a run killed at once, blocked a new run.
#[test]
fn other_files_do_not_block_a_new_run() {
    let dir = tempfile::tempdir().unwrap();
    let deep = dir.path().join("a/b");
    fs::create_dir_all(&deep).unwrap();
    fs::write(deep.join("scene.toml"), "").unwrap();
    fs::write(deep.join(".mesh.hdf.tmp"), "half").unwrap();
    let output = create(&deep);
    assert_eq!((output.n_points(), output.last_step()), (N_POINTS, None));
    assert!(!deep.join(".mesh.hdf.tmp").exists());
}

/// Wrong if a temporary or foreign file counted as a committed step, or steps came in the order of the file system.
#[test]
fn only_final_names_are_committed_steps() {
    let dir = tempfile::tempdir().unwrap();
    for step in [1_000_000, 20, 3] {
        fs::write(dir.path().join(step_file_name(step)), "").unwrap();
    }
    for name in [
        ".step_000004.hdf.tmp",
        "step_5.hdf",
        "step_0000006.hdf",
        "step_-00007.hdf",
        "step_000008.h5",
    ] {
        fs::write(dir.path().join(name), "").unwrap();
    }
    assert_eq!(committed_steps(dir.path()).unwrap(), [3, 20, 1_000_000]);
}

/// Wrong if a step could be written twice, or times could run backwards and confuse every viewer.
#[test]
fn steps_and_times_must_grow() {
    let dir = tempfile::tempdir().unwrap();
    let mut output = create(dir.path());
    output.write_step(&bare_record(2)).unwrap();
    let mut late = bare_record(3);
    late.time = bare_record(2).time;
    for refused in [bare_record(2), bare_record(1), late] {
        let error = output.write_step(&refused).unwrap_err();
        assert!(
            matches!(error, CheckpointError::StepOrder { last: 2, .. }),
            "{error}"
        );
    }
    let mut endless = bare_record(4);
    endless.time = f64::NAN;
    assert!(matches!(
        output.write_step(&endless),
        Err(CheckpointError::Time { step: 4, .. })
    ));
    assert_eq!(committed_steps(dir.path()).unwrap(), [2]);
}

/// Wrong if a field for another mesh were written and shown on wrong points.
#[test]
fn a_field_of_the_wrong_length_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let mut short = record(0);
    short.points.stress.as_mut().unwrap().pop();
    let text = create(dir.path()).write_step(&short).unwrap_err().to_string();
    assert_eq!(text, "field stress of step 0 has 19 points, the mesh has 20");
    let dir = tempfile::tempdir().unwrap();
    let mut short = record(0);
    short.cells.von_mises_largest.as_mut().unwrap().pop();
    let text = create(dir.path()).write_step(&short).unwrap_err().to_string();
    assert_eq!(
        text,
        "field von_mises_largest of step 0 has 3 cells, the mesh has 4"
    );
    let dir = tempfile::tempdir().unwrap();
    let mut pointless = record(0);
    let stress = pointless.cells.stress_integration_points.as_mut().unwrap();
    (stress.points_per_cell, stress.values) = (0, vec![0.0; 4]);
    let text = create(dir.path()).write_step(&pointless).unwrap_err().to_string();
    assert_eq!(
        text,
        "field stress_integration_points of step 0 has 0 cells, the mesh has 4"
    );
    assert!(committed_steps(dir.path()).unwrap().is_empty());
}

/// Wrong if names HDF5 would read as paths, or texts it would cut at a NUL, were accepted.
#[test]
fn names_and_texts_hdf5_cannot_hold_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let mut output = create(dir.path());
    let mut bad_name = record(0);
    bad_name
        .state
        .insert("a/b".to_string(), checkpoint::StateArray::Integer(vec![1]));
    assert!(
        output
            .write_step(&bad_name)
            .unwrap_err()
            .to_string()
            .contains("\"a/b\": expected letters")
    );
    let mut bad_text = record(0);
    bad_text.scene.push('\0');
    assert!(
        output
            .write_step(&bad_text)
            .unwrap_err()
            .to_string()
            .contains("without NUL")
    );
}

/// Wrong if cells that name points of another body, or bodies that share an id, reached a viewer.
#[test]
fn bodies_that_cannot_be_drawn_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let refuse = |bodies: &[Body]| {
        Output::create(dir.path(), bodies, Storage::default())
            .unwrap_err()
            .to_string()
    };
    let mut stray = bodies();
    stray[0].connectivity[3] = 8;
    assert_eq!(
        refuse(&stray),
        "body \"outer_ring\": cell 0 names point 8, the body has 8 points"
    );
    let mut cut = bodies();
    cut[1].connectivity.pop();
    assert!(refuse(&cut).contains("connectivity has 9 entries, expected a multiple of 10"));
    let mut twin = bodies();
    twin[2].id = 0;
    assert!(refuse(&twin).contains("its id 0 is that of body \"outer_ring\""));
    let mut far = bodies();
    far[2].points[1][0] = f64::NAN;
    assert!(refuse(&far).contains("point 1 is at [NaN"));
    assert_eq!(CellKind::Vertex.n_points(), 1);
}

/// Wrong if resuming rewrote or lost steps, or left superseded ones in the views.
#[test]
fn a_resumed_run_moves_later_steps_aside() {
    let dir = tempfile::tempdir().unwrap();
    write_steps(dir.path(), 0..5);
    checkpoint::rebuild_index(dir.path()).unwrap();
    fs::write(dir.path().join(".step_000005.hdf.tmp"), "half").unwrap();
    let kept = fs::read(dir.path().join("step_000002.hdf")).unwrap();
    let resumed = Output::resume(lock(dir.path()), &bodies(), Storage::default(), 2).unwrap();
    let mut output = resumed.output;
    assert_eq!(resumed.superseded, Some(dir.path().join("superseded_1")));
    assert_eq!(output.last_step(), Some((2, bare_record(2).time)));
    assert_eq!(committed_steps(dir.path()).unwrap(), [0, 1, 2]);
    assert!(!dir.path().join(".step_000005.hdf.tmp").exists() && !dir.path().join("run.vtkhdf").exists());
    let aside = dir.path().join("superseded_1");
    assert_eq!(committed_steps(&aside).unwrap(), [3, 4]);
    assert_eq!(read_step(&aside.join("step_000004.hdf")).unwrap(), bare_record(4));
    assert_eq!(
        checkpoint::rebuild_index(&aside).unwrap().n_steps,
        2,
        "superseded steps stay viewable"
    );
    output.write_step(&bare_record(3)).unwrap();
    assert_eq!(fs::read(dir.path().join("step_000002.hdf")).unwrap(), kept);
    drop(output);
    Output::resume(lock(dir.path()), &bodies(), Storage::default(), 1).unwrap();
    assert_eq!(committed_steps(&dir.path().join("superseded_2")).unwrap(), [2, 3]);
}

/// Wrong if a run could continue from a step that is not there, from nothing, or on another mesh.
#[test]
fn resuming_needs_the_step_and_the_mesh() {
    let dir = tempfile::tempdir().unwrap();
    let resume = |bodies: &[Body], step| {
        Output::resume(lock(dir.path()), bodies, Storage::default(), step)
            .unwrap_err()
            .to_string()
    };
    assert!(resume(&bodies(), 0).contains("holds no committed step"));
    write_steps(dir.path(), 1..4);
    assert!(resume(&bodies(), 7).contains("has no step 7; committed steps are 1 to 3, the nearest is 3"));
    let mut other = bodies();
    other[1].points[0][2] += 1e-9;
    let text = resume(&other, 3);
    assert!(text.contains("mesh.hdf was made with mesh 20-4-"), "{text}");
    assert_eq!(committed_steps(dir.path()).unwrap(), [1, 2, 3]);
}

/// Wrong if two processes could write into one folder, or if the lock of a dead one kept the next one out.
#[test]
fn a_folder_has_one_writer_and_outlives_it() {
    let dir = tempfile::tempdir().unwrap();
    let mut output = Output::create(dir.path(), &bodies(), Storage::default()).unwrap();
    assert_eq!(output.lock().dead_owner(), None);
    output.write_step(&bare_record(0)).unwrap();
    let text = FolderLock::acquire(dir.path()).unwrap_err().to_string();
    let owner = format!("process {} on ", std::process::id());
    assert!(
        text.starts_with(&owner) && text.contains("is writing to folder"),
        "{text}"
    );
    drop(output);
    assert_eq!(
        lock(dir.path()).dead_owner(),
        None,
        "a lock given back is no dead one"
    );
    // What a killed process leaves: its line, but no lock.
    fs::write(dir.path().join(".raceway.lock"), "process 77 on elsewhere\n").unwrap();
    let taken = lock(dir.path());
    assert_eq!(taken.dead_owner(), Some("process 77 on elsewhere"));
    Output::resume(taken, &bodies(), Storage::default(), 0).unwrap();
}

/// A step that a run can go on from, or not.
fn with_state(step: u64, has_state: bool) -> checkpoint::StepRecord {
    let state = has_state.then(|| ("x".to_string(), checkpoint::StateArray::Real(vec![0.5])));
    checkpoint::StepRecord {
        state: state.into_iter().collect(),
        ..bare_record(step)
    }
}

/// Wrong if a damaged newest step were taken to resume from, or if nobody heard of it.
#[test]
fn the_newest_whole_step_is_found_below_damaged_ones() {
    let dir = tempfile::tempdir().unwrap();
    let mut output = Output::create(dir.path(), &bodies(), Storage::default()).unwrap();
    for n in 0..4 {
        output.write_step(&with_state(n, true)).unwrap();
    }
    let step = |n: u64| dir.path().join(checkpoint::step_file_name(n));
    fs::write(step(3), &fs::read(step(3)).unwrap()[..1000]).unwrap();
    let mut bytes = fs::read(step(2)).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(step(2), bytes).unwrap();
    let mut skipped = Vec::new();
    let newest = newest_step(dir.path(), |error| skipped.push(error.to_string())).unwrap();
    assert_eq!(newest, with_state(1, true));
    assert!(
        skipped[0].contains("step_000003.hdf") && skipped[1].contains("step_000002.hdf"),
        "{skipped:?}"
    );
    for n in [0, 1] {
        fs::write(step(n), "").unwrap();
    }
    let text = newest_step(dir.path(), |_| {}).unwrap_err().to_string();
    assert!(text.contains("step_000000.hdf"), "{text}");
}

/// Wrong: a run would go on from a step that does not hold what it needs, or steps without a state would count as
/// damaged, or packing would leave no step to go on from.
#[test]
fn a_step_without_a_state_is_none_to_go_on_from() {
    let dir = tempfile::tempdir().unwrap();
    let mut output = Output::create(dir.path(), &bodies(), Storage::default()).unwrap();
    for n in 0..9 {
        let path = output.write_step(&with_state(n, n % 3 == 0 && n < 6)).unwrap();
        assert_eq!(checkpoint::has_state(&path).unwrap(), n == 0 || n == 3);
    }
    drop(output);
    let newest = || newest_step(dir.path(), |error| panic!("{error}"));
    assert_eq!(newest().unwrap(), with_state(3, true));
    let lock = FolderLock::acquire(dir.path()).unwrap();
    assert_eq!(checkpoint::pack_steps(&lock, 1, 100).unwrap(), 3);
    assert_eq!(committed_steps(dir.path()).unwrap(), (3..9).collect::<Vec<_>>());
    assert_eq!(newest().unwrap(), with_state(3, true));
    for n in 3..6 {
        fs::remove_file(dir.path().join(checkpoint::step_file_name(n))).unwrap();
    }
    let text = newest().unwrap_err().to_string();
    assert!(
        text.starts_with("no step in folder ")
            && text.ends_with(" holds a restart state; run the scene again")
    );
    // Where no step has one, there is nothing to keep it for.
    assert_eq!(checkpoint::pack_steps(&lock, 1, 100).unwrap(), 2);
}

/// Wrong if one damaged step made all others unusable, or if the library opened it: its structure alone is wrong here.
#[test]
fn a_damaged_earlier_step_is_left_out_of_the_views_and_named() {
    let dir = tempfile::tempdir().unwrap();
    write_steps(dir.path(), 0..4);
    let path = dir.path().join("step_000001.hdf");
    let mut bytes = fs::read(&path).unwrap();
    bytes[200] ^= 0xff;
    fs::write(&path, &bytes).unwrap();
    let views = checkpoint::rebuild_index(dir.path()).unwrap();
    let text = views.damaged[0].to_string();
    assert_eq!(views.n_steps, 3);
    assert!(text.contains("step_000001.hdf"), "{text}");
    let resumed = Output::resume(lock(dir.path()), &bodies(), Storage::default(), 3).unwrap();
    assert_eq!(resumed.damaged[0].to_string(), text);
    let series = fs::read_to_string(dir.path().join("run.hdf.series")).unwrap();
    assert!(series.contains("step_000002.hdf") && !series.contains("step_000001.hdf"));
    drop(resumed);
    let refused = Output::resume(lock(dir.path()), &bodies(), Storage::default(), 1).unwrap_err();
    assert_eq!(refused.to_string(), text);
}

/// Wrong if a step did not say where its run came from, or said it in an array's place.
#[test]
fn steps_say_where_their_run_came_from() {
    let dir = tempfile::tempdir().unwrap();
    let mut output = Output::create(dir.path(), &bodies(), Storage::default()).unwrap();
    let about = std::collections::BTreeMap::from([
        ("scene_file".to_string(), "../scenes/ä.toml".to_string()),
        ("overrides".to_string(), String::new()),
    ]);
    output.describe(about.clone()).unwrap();
    let path = output.write_step(&bare_record(0)).unwrap();
    let read = checkpoint::read_about(&path).unwrap();
    assert_eq!(read["mesh_hash"], output.mesh_hash());
    assert_eq!(read["program_version"], env!("CARGO_PKG_VERSION"));
    assert!(about.iter().all(|(name, text)| read[name] == *text) && read.len() == 4);
    assert_eq!(read_step(&path).unwrap(), bare_record(0));
    let bad = std::collections::BTreeMap::from([("a".to_string(), "b\0".to_string())]);
    assert!(
        output
            .describe(bad)
            .unwrap_err()
            .to_string()
            .contains("without NUL")
    );
}

/// Wrong: a user of an archive that nobody may write to would read of a lock, and not what to do.
#[test]
fn a_folder_that_may_not_be_written_to_says_what_to_do() {
    // Nobody makes files here, the administrator neither.
    let sealed = std::path::Path::new("/sys/kernel");
    if !sealed.is_dir() {
        return;
    }
    let said = checkpoint::FolderLock::acquire(sealed).unwrap_err().to_string();
    assert!(
        said.starts_with("cannot open the lock /sys/kernel/.raceway.lock: "),
        "{said}"
    );
    assert!(
        said.ends_with("writes into this folder; copy it to where you may write"),
        "{said}"
    );
}
