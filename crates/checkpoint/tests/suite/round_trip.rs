//! What is written is what is read.

use std::fs;
use std::path::Path;

use checkpoint::{
    Compression, Output, Precision, StateArray, StepRecord, Storage, read_step, read_step_time,
};

use crate::fixture::{bare_record, bodies, record};

fn write_one(dir: &Path, record: &StepRecord, storage: Storage) -> StepRecord {
    let path = Output::create(dir, &bodies(), storage)
        .unwrap()
        .write_step(record)
        .unwrap();
    read_step(&path).unwrap()
}

/// Wrong if any value of fields, state, scene, number or time changed on the way; no tolerance.
#[test]
fn a_step_reads_back_as_it_was_written() {
    let dir = tempfile::tempdir().unwrap();
    let storage = Storage {
        stress: Precision::F64,
        ..Storage::default()
    };
    assert_eq!(write_one(dir.path(), &record(7), storage), record(7));
    assert_eq!(
        read_step_time(&dir.path().join("step_000007.hdf")).unwrap(),
        record(7).time
    );
}

/// Wrong if a field the run does not compute appears, or a state without arrays cannot be stored.
#[test]
fn absent_fields_stay_absent() {
    let dir = tempfile::tempdir().unwrap();
    assert_eq!(
        write_one(dir.path(), &bare_record(0), Storage::default()),
        bare_record(0)
    );
}

/// Wrong if a restart could differ from an uninterrupted run in the bits of a NaN or of a signed zero.
#[test]
fn the_state_keeps_every_bit() {
    let dir = tempfile::tempdir().unwrap();
    let values = [
        f64::from_bits(0x7ff8_0000_dead_beef),
        -0.0,
        f64::NEG_INFINITY,
        f64::from_bits(1),
    ];
    let mut original = bare_record(0);
    original
        .state
        .insert("odd".to_string(), StateArray::Real(values.to_vec()));
    let read = write_one(dir.path(), &original, Storage::default());
    let StateArray::Real(read) = &read.state["odd"] else {
        panic!("expected real numbers")
    };
    assert_eq!(
        read.iter().map(|x| x.to_bits()).collect::<Vec<_>>(),
        values.map(f64::to_bits)
    );
}

/// Wrong if the default precision did anything else than round stress and von Mises stress to the nearest f32, or
/// touched the fields a restart needs.
#[test]
fn f32_rounds_stress_and_nothing_else() {
    let dir = tempfile::tempdir().unwrap();
    let mut expected = record(3);
    let round = |x: &mut f64| *x = f64::from(*x as f32);
    expected
        .points
        .stress
        .as_mut()
        .unwrap()
        .as_flattened_mut()
        .iter_mut()
        .for_each(round);
    expected
        .points
        .von_mises
        .as_mut()
        .unwrap()
        .iter_mut()
        .for_each(round);
    let cells = &mut expected.cells;
    let stress = &mut cells.stress_integration_points.as_mut().unwrap().values;
    stress.iter_mut().for_each(round);
    let largest = cells.von_mises_largest.as_mut().unwrap();
    largest.iter_mut().for_each(round);
    assert_ne!(expected, record(3), "the fixture must not consist of f32 numbers");
    assert_eq!(write_one(dir.path(), &record(3), Storage::default()), expected);
}

/// Wrong if the filters lost a value, or were not applied: 40 000 equal numbers shrink at least tenfold.
#[test]
fn compression_changes_the_size_and_not_the_values() {
    let cage = checkpoint::Body::balls("balls", 0, &vec![[0.0; 3]; 40_000], 1e-3);
    let mut original = bare_record(0);
    original.points.displacement = vec![[1.5, -2.5, 3.5]; 40_000];
    let size = |compression| {
        let dir = tempfile::tempdir().unwrap();
        let storage = Storage {
            compression,
            ..Storage::default()
        };
        let mut output = Output::create(dir.path(), std::slice::from_ref(&cage), storage).unwrap();
        let path = output.write_step(&original).unwrap();
        assert_eq!(read_step(&path).unwrap(), original);
        fs::metadata(path).unwrap().len()
    };
    let (plain, small) = (size(Compression::None), size(Compression::Deflate(1)));
    assert!(
        10 * small < plain,
        "plain {plain} bytes, compressed {small} bytes"
    );
}

/// Wrong if a file depended on the clock, the folder or an earlier file: same input must give the same bytes. The
/// pause makes time stamps differ, which HDF5 keeps in whole seconds.
#[test]
fn equal_records_give_equal_files() {
    let names = ["mesh.hdf", "step_000001.hdf", "run.hdf.series", "run.vtkhdf"];
    let bytes = || {
        let dir = tempfile::tempdir().unwrap();
        write_one(dir.path(), &record(1), Storage::default());
        checkpoint::rebuild_index(dir.path()).unwrap();
        names.map(|name| fs::read(dir.path().join(name)).unwrap())
    };
    let first = bytes();
    std::thread::sleep(std::time::Duration::from_millis(1100));
    for ((name, first), second) in names.iter().zip(first).zip(bytes()) {
        assert!(first == second, "{name} differs");
    }
}
