//! Smaller files: what is not stored, what is rounded, and how much.

use std::fs;
use std::path::{Path, PathBuf};

use checkpoint::{
    Body, Compression, ErrorBound, Output, PointFields, Precision, StepRecord, Storage, read_step,
};

use crate::fixture::bare_record;

/// Points of the ring, and balls behind them.
const N_RING: usize = 20_000;
const N_BALLS: usize = 18;

/// A step of many points with forces on the last ones only.
fn large(values: impl Fn(usize) -> f64) -> (Vec<Body>, StepRecord) {
    let ring = Body::balls("points", 0, &vec![[0.0; 3]; N_RING], 1e-3);
    let balls = Body::balls("balls", 2, &[[0.0; 3]; N_BALLS], 1e-3);
    let n_points = N_RING + N_BALLS;
    let mut force = vec![[0.0; 3]; n_points];
    for (i, row) in force[N_RING..].iter_mut().enumerate() {
        *row = [-300.0 - i as f64 / 7.0, -0.0, f64::from_bits(3)];
    }
    let points = PointFields {
        displacement: (0..n_points)
            .map(|i| [0, 1, 2].map(|j| values(3 * i + j)))
            .collect(),
        stress: Some(
            (0..n_points)
                .map(|i| [0, 1, 2, 3, 4, 5].map(|j| values(6 * i + j)))
                .collect(),
        ),
        von_mises: Some((0..n_points).map(|i| values(i).abs()).collect()),
        force_inner: Some(force.clone()),
        force_outer: Some(force),
        ..PointFields::default()
    };
    let record = StepRecord {
        points,
        ..bare_record(4)
    };
    (vec![ring, balls], record)
}

fn write(dir: &Path, (bodies, record): &(Vec<Body>, StepRecord), storage: Storage) -> PathBuf {
    let mut output = Output::create(dir, bodies, storage).unwrap();
    output.write_step(record).unwrap()
}

/// Smooth over the points, of both signs, up to 2 GPa.
fn smooth(i: usize) -> f64 {
    2e9 * (i as f64 * 1e-4).sin() * (i as f64 * 1.7e-3).cos()
}

fn bits(rows: &[[f64; 3]]) -> Vec<u64> {
    rows.as_flattened().iter().map(|value| value.to_bits()).collect()
}

/// Wrong: zeros at the points of rings would fill the disk, or a force, a signed zero or the smallest number would be
/// lost with them.
#[test]
fn forces_take_the_place_of_the_balls_and_keep_every_bit() {
    let dir = tempfile::tempdir().unwrap();
    let step = large(smooth);
    let path = write(dir.path(), &step, Storage::default());
    let (read, written) = (read_step(&path).unwrap(), &step.1.points);
    let [inner, outer] = [&read.points.force_inner, &read.points.force_outer];
    for (read, written) in [(inner, &written.force_inner), (outer, &written.force_outer)] {
        assert_eq!(bits(read.as_ref().unwrap()), bits(written.as_ref().unwrap()));
    }
    let file = hdf5::File::open(&path).unwrap();
    for name in ["force_inner", "force_outer"] {
        let force = file.dataset(&format!("VTKHDF/PointData/{name}")).unwrap();
        assert_eq!(force.shape(), [N_RING + N_BALLS, 3]);
        // Two chunks of 128 rows at most.
        assert!(
            force.storage_size() <= 2 * 128 * 24,
            "{} bytes",
            force.storage_size()
        );
    }
    // The temporal view: NaN where a step is missing, zero on rings.
    checkpoint::rebuild_index(dir.path()).unwrap();
    let view = hdf5::File::open(dir.path().join("run.vtkhdf")).unwrap();
    let shown = view.dataset("VTKHDF/PointData/force_inner").unwrap();
    let shown: Vec<u64> = shown
        .read_raw::<f64>()
        .unwrap()
        .iter()
        .map(|x| x.to_bits())
        .collect();
    assert_eq!(shown, bits(written.force_inner.as_ref().unwrap()));
}

/// Wrong: a step in which no ball is loaded could not be written or read.
#[test]
fn forces_that_are_zero_everywhere_take_no_place() {
    let dir = tempfile::tempdir().unwrap();
    let mut step = large(smooth);
    step.1.points.force_inner = Some(vec![[0.0; 3]; N_RING + N_BALLS]);
    let path = write(dir.path(), &step, Storage::default());
    assert_eq!(
        read_step(&path).unwrap().points.force_inner,
        step.1.points.force_inner
    );
    let file = hdf5::File::open(&path).unwrap();
    let force = file.dataset("VTKHDF/PointData/force_inner").unwrap();
    assert_eq!(force.storage_size(), 0);
}

/// The largest difference of two fields.
fn error(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Wrong: stress would be further off than the user allows, or a coarser bound would gain nothing. The error is that of
/// rounding to the nearest multiple of the step, so it comes close to half of it among 120 000 values.
#[test]
fn stress_stays_within_its_error_bound_and_shrinks() {
    let step = large(smooth);
    let written = step.1.points.stress.as_ref().unwrap().as_flattened();
    let mut sizes = Vec::new();
    for (bound, half) in [(1e3, 512.0), (1e4, 8192.0), (16384.0, 16384.0), (1e6, 524_288.0)] {
        for precision in [Precision::F32, Precision::F64] {
            let dir = tempfile::tempdir().unwrap();
            let storage = Storage {
                stress: precision,
                stress_error: ErrorBound::new(bound),
                ..Storage::default()
            };
            let path = write(dir.path(), &step, storage);
            let points = read_step(&path).unwrap().points;
            let largest = error(points.stress.as_ref().unwrap().as_flattened(), written);
            assert!(
                largest <= half && half <= bound && largest > 0.99 * half,
                "{largest} of {bound}"
            );
            let von_mises = error(
                points.von_mises.as_ref().unwrap(),
                step.1.points.von_mises.as_ref().unwrap(),
            );
            assert!(von_mises <= half, "{von_mises} of {bound}");
            assert_eq!(points.displacement, step.1.points.displacement);
            let file = hdf5::File::open(&path).unwrap();
            let stress = file.dataset("VTKHDF/PointData/stress").unwrap();
            let attribute = stress.attr("error_bound").unwrap().read_scalar::<f64>().unwrap();
            assert_eq!(attribute, bound);
            sizes.push(stress.storage_size());
        }
    }
    let lossless = (written.len() * 4) as u64;
    assert!(
        sizes[0] < lossless && sizes[6] * 2 < sizes[0],
        "{sizes:?} of {lossless}"
    );
}

/// Wrong: rounding would make a number of what is none, a finite stress infinite, or negative zeros.
#[test]
fn what_cannot_be_rounded_stays() {
    let bound = ErrorBound::new(1e4);
    for no_bound in [0.0, -1.0, f64::NAN, f64::INFINITY, f64::MAX, 1e-310] {
        assert_eq!(ErrorBound::new(no_bound), None, "{no_bound}");
    }
    let odd = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        1e300,
        -1e300,
        -1.0,
        8192.1,
        -8192.1,
    ];
    let step = large(|i| odd[i % odd.len()]);
    let storage = Storage {
        stress: Precision::F64,
        stress_error: bound,
        ..Storage::default()
    };
    let dir = tempfile::tempdir().unwrap();
    let read = read_step(&write(dir.path(), &step, storage)).unwrap();
    let found: Vec<u64> = read.points.stress.unwrap().as_flattened()[..8]
        .iter()
        .map(|x| x.to_bits())
        .collect();
    let expected = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        1e300,
        -1e300,
        0.0,
        16384.0,
        -16384.0,
    ];
    assert_eq!(found, expected.map(f64::to_bits));
}

/// Wrong: displacement for the eye would be off by more than the rounding of f32, or other fields would be touched.
#[test]
fn displacement_in_f32_is_the_nearest_f32() {
    let step = large(|i| 1e-5 * (i as f64).sin());
    let sizes = [Precision::F64, Precision::F32].map(|displacement| {
        let dir = tempfile::tempdir().unwrap();
        let storage = Storage {
            stress: Precision::F64,
            displacement,
            ..Storage::default()
        };
        let path = write(dir.path(), &step, storage);
        let read = read_step(&path).unwrap().points;
        let mut expected = step.1.points.clone();
        if displacement == Precision::F32 {
            let round = |x: &mut f64| *x = f64::from(*x as f32);
            expected
                .displacement
                .as_flattened_mut()
                .iter_mut()
                .for_each(round);
        }
        assert_eq!(read, expected);
        fs::metadata(path).unwrap().len()
    });
    assert_eq!(sizes[0] - sizes[1], (12 * (N_RING + N_BALLS)) as u64);
}

/// Wrong: with compression asked for, stress with a bound would be stored at another level.
#[test]
fn the_level_of_the_scene_counts() {
    let step = large(smooth);
    let size = |compression| {
        let dir = tempfile::tempdir().unwrap();
        let storage = Storage {
            stress_error: ErrorBound::new(1e4),
            compression,
            ..Storage::default()
        };
        let file = hdf5::File::open(write(dir.path(), &step, storage)).unwrap();
        file.dataset("VTKHDF/PointData/stress").unwrap().storage_size()
    };
    let [none, fast, small] = [
        Compression::None,
        Compression::Deflate(1),
        Compression::Deflate(9),
    ]
    .map(size);
    assert!(none == fast && small < fast, "{none} {fast} {small}");
}
