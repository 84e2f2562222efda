//! Steps that lack a field, or hold it in a region only.

use std::fs;
use std::path::{Path, PathBuf};

use checkpoint::{
    Body, ErrorBound, FolderLock, Output, PointFields, Precision, StepRecord, Storage, pack_steps,
    read_any_step, read_step, unpack_steps,
};

use crate::fixture::bare_record;

/// Points of the ring, and balls behind them.
const N_RING: usize = 40_000;
const N_BALLS: usize = 18;
const N: usize = N_RING + N_BALLS;

/// No smooth field: nothing gains by compression but what is left out.
fn noise(i: usize) -> f64 {
    let mixed = (i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (mixed ^ (mixed >> 29)) as f64 * 1e-10
}

/// A step with forces on its last points; `inside` tells the region.
fn step_of(step: u64, inside: impl Fn(usize) -> bool) -> StepRecord {
    let mut force = vec![[0.0; 3]; N];
    force[N_RING..].fill([1.0, 2.0, 3.0]);
    let kept = |i: usize, n: usize, c: usize| if inside(i) { noise(n * i + c) } else { f64::NAN };
    StepRecord {
        points: PointFields {
            displacement: (0..N).map(|i| [0, 1, 2].map(|c| noise(3 * i + c))).collect(),
            stress: Some(
                (0..N)
                    .map(|i| [0, 1, 2, 3, 4, 5].map(|c| kept(i, 6, c)))
                    .collect(),
            ),
            von_mises: Some((0..N).map(|i| kept(i, 1, 0)).collect()),
            force_inner: Some(force.clone()),
            force_outer: Some(force),
            in_region: Some((0..N).map(|i| f64::from(u8::from(inside(i)))).collect()),
            ..PointFields::default()
        },
        ..bare_record(step)
    }
}

fn write(dir: &Path, records: &[StepRecord], storage: Storage) -> Vec<PathBuf> {
    let ring = Body::balls("points", 0, &vec![[0.0; 3]; N_RING], 1e-3);
    let balls = Body::balls("balls", 2, &[[0.0; 3]; N_BALLS], 1e-3);
    let mut output = Output::create(dir, &[ring, balls], storage).unwrap();
    records
        .iter()
        .map(|record| output.write_step(record).unwrap())
        .collect()
}

/// Bits of all fields: NaN is equal to itself.
fn bits(points: &PointFields) -> Vec<(&'static str, Vec<u64>)> {
    let arrays = points.arrays().into_iter();
    arrays
        .map(|(name, _, values)| (name, values.iter().map(|v| v.to_bits()).collect()))
        .collect()
}

fn stored(path: &Path, name: &str) -> u64 {
    let file = hdf5::File::open(path).unwrap();
    file.dataset(&format!("VTKHDF/PointData/{name}"))
        .unwrap()
        .storage_size()
}

/// Wrong: values in the region would change, rows outside would hold anything but NaN, or they would fill the disk:
/// those of a region in one piece, or scattered over all.
#[test]
fn a_field_in_a_region_takes_the_place_of_the_region() {
    let storage = Storage {
        stress: Precision::F64,
        ..Storage::default()
    };
    type IsInside = fn(usize) -> bool;
    let pieces: [(IsInside, f64); 2] = [(|i| !(N / 10..N_RING).contains(&i), 1.02), (|i| i % 10 == 0, 1.4)];
    for (inside, most) in pieces {
        let dir = tempfile::tempdir().unwrap();
        let record = step_of(4, inside);
        let path = &write(dir.path(), std::slice::from_ref(&record), storage)[0];
        assert_eq!(bits(&read_step(path).unwrap().points), bits(&record.points));
        let n_inside = (0..N).filter(|&i| inside(i)).count();
        let share = stored(path, "stress") as f64 / (n_inside * 48) as f64;
        assert!(share < most, "{share}");
        // As any program that knows only HDF5 reads it.
        let file = hdf5::File::open(path).unwrap();
        let values = file
            .dataset("VTKHDF/PointData/von_mises")
            .unwrap()
            .read_raw::<f64>()
            .unwrap();
        for (i, value) in values.iter().enumerate() {
            assert!(
                if inside(i) {
                    *value == noise(i)
                } else {
                    value.is_nan()
                },
                "{i}: {value}"
            );
        }
    }
}

/// Wrong: a field of which nothing is kept could not be read, or a bound of the error would be lost beside a region.
#[test]
fn an_error_bound_holds_in_the_region() {
    let dir = tempfile::tempdir().unwrap();
    let storage = Storage {
        stress_error: ErrorBound::new(1e4),
        ..Storage::default()
    };
    let (some, none) = (step_of(4, |i| i % 7 == 0), step_of(5, |_| false));
    let paths = write(dir.path(), &[some.clone(), none], storage);
    let read = read_step(&paths[0]).unwrap().points.von_mises.unwrap();
    for (read, written) in read.iter().zip(some.points.von_mises.unwrap()) {
        assert!(if written.is_nan() {
            read.is_nan()
        } else {
            (read - written).abs() <= 1e4
        });
    }
    assert_eq!(stored(&paths[1], "stress"), 0);
    assert!(
        read_step(&paths[1])
            .unwrap()
            .points
            .von_mises
            .unwrap()
            .iter()
            .all(|v| v.is_nan())
    );
}

/// Wrong: packs would lose what a step leaves out, or unpacked steps would be other files; the view of all steps would
/// show zeros where a step has no field.
#[test]
fn steps_without_fields_are_packed_and_unpacked_to_the_same_bytes() {
    let dir = tempfile::tempdir().unwrap();
    let plain = PointFields {
        stress: None,
        von_mises: None,
        in_region: None,
        ..step_of(5, |_| true).points
    };
    let without = |step, points: &PointFields| {
        let points = PointFields {
            displacement: Vec::new(),
            ..points.clone()
        };
        StepRecord {
            points,
            ..bare_record(step)
        }
    };
    let mut moved = step_of(7, |i| !(3000..N_RING).contains(&i));
    let outside = moved
        .points
        .in_region
        .clone()
        .unwrap()
        .into_iter()
        .map(|inside| inside == 0.0);
    for (row, _) in moved
        .points
        .displacement
        .iter_mut()
        .zip(outside)
        .filter(|(_, outside)| *outside)
    {
        *row = [f64::NAN; 3];
    }
    let all = step_of(8, |_| true).points;
    let stress_alone = PointFields {
        in_region: None,
        ..all
    };
    let records = [
        step_of(4, |i| i < 2000),
        StepRecord {
            points: plain.clone(),
            ..bare_record(5)
        },
        without(6, &plain),
        moved,
        without(8, &stress_alone),
        step_of(9, |i| i > 4),
    ];
    let paths = write(dir.path(), &records, Storage::default());
    let bytes: Vec<Vec<u8>> = paths.iter().map(|path| fs::read(path).unwrap()).collect();
    // Forces without a displacement beside them are small as well.
    assert!(bytes[2].len() < 60_000, "{}", bytes[2].len());
    let lock = FolderLock::acquire(dir.path()).unwrap();
    assert_eq!(pack_steps(&lock, 1, 10).unwrap(), 5);
    for record in &records {
        let read = read_any_step(dir.path(), record.step).unwrap().points;
        let names = |points: &PointFields| points.arrays().iter().map(|a| a.0).collect::<Vec<_>>();
        assert_eq!(names(&read), names(&record.points));
    }
    unpack_steps(&lock).unwrap();
    for (path, bytes) in paths.iter().zip(&bytes) {
        assert!(fs::read(path).unwrap() == *bytes, "{}", path.display());
    }
    let view = hdf5::File::open(dir.path().join("run.vtkhdf")).unwrap();
    let shown = view
        .dataset("VTKHDF/PointData/displacement")
        .unwrap()
        .read_raw::<f64>()
        .unwrap();
    assert!(shown[3 * 2 * N..3 * 3 * N].iter().all(|v| v.is_nan()));
}
