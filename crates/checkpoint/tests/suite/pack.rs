//! Many steps in one file: nothing is lost, the views stay, and it can be taken back.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use checkpoint::{
    Compression, ErrorBound, FolderLock, Output, Precision, Storage, all_steps, committed_steps, pack_steps,
    packs, read_any_step, unpack_steps,
};

use crate::fixture::{bodies, record};

fn lock(dir: &Path) -> FolderLock {
    FolderLock::acquire(dir).unwrap()
}

/// Eight steps, 3 to 10, with texts about the run.
fn run(dir: &Path, storage: Storage) {
    let mut output = Output::create(dir, &bodies(), storage).unwrap();
    output
        .describe(BTreeMap::from([("scene_file".to_string(), "a.toml".to_string())]))
        .unwrap();
    for step in 3..11 {
        output.write_step(&record(step)).unwrap();
    }
    output.finish().unwrap();
}

fn files(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(dir).unwrap().map(|entry| entry.unwrap());
    let read = entries.map(|entry| {
        (
            entry.file_name().into_string().unwrap(),
            fs::read(entry.path()).unwrap(),
        )
    });
    read.filter(|(name, _)| !name.ends_with(".lock")).collect()
}

/// All values that the temporal view shows of a field, such as `PointData/stress`.
fn shown(dir: &Path, field: &str) -> Vec<f64> {
    let file = hdf5::File::open(dir.join("run.vtkhdf")).unwrap();
    let times = file
        .dataset("VTKHDF/Steps/Values")
        .unwrap()
        .read_raw::<f64>()
        .unwrap();
    assert_eq!(times, (3..11).map(|step| record(step).time).collect::<Vec<_>>());
    file.dataset(&format!("VTKHDF/{field}"))
        .unwrap()
        .read_raw::<f64>()
        .unwrap()
}

/// Wrong: packing would lose or change a step, drop it from the temporal view, or could not be taken back to the same
/// bytes, whatever way the steps are stored.
#[test]
fn packing_keeps_the_view_and_unpacking_the_bytes() {
    let exact = Storage {
        stress: Precision::F64,
        ..Storage::default()
    };
    let small = Storage {
        compression: Compression::Deflate(4),
        ..Storage::default()
    };
    let rounded = Storage {
        stress_error: ErrorBound::new(700.0),
        displacement: Precision::F32,
        ..Storage::default()
    };
    let both = Storage {
        compression: Compression::Deflate(4),
        ..rounded
    };
    for storage in [exact, small, rounded, both, Storage::default()] {
        let dir = tempfile::tempdir().unwrap();
        run(dir.path(), storage);
        let fields = ["PointData/stress", "CellData/stress_integration_points"];
        let view = || fields.map(|field| shown(dir.path(), field));
        let (before, seen) = (files(dir.path()), view());
        let records: Vec<_> = (3..11)
            .map(|step| read_any_step(dir.path(), step).unwrap())
            .collect();
        assert_eq!(pack_steps(&lock(dir.path()), 2, 4).unwrap(), 6);
        let names: Vec<String> = files(dir.path()).into_keys().collect();
        assert_eq!(
            names,
            [
                "mesh.hdf",
                "pack_000003_000006.hdf",
                "pack_000007_000008.hdf",
                "run.hdf.series",
                "run.vtkhdf",
                "step_000009.hdf",
                "step_000010.hdf"
            ]
        );
        assert_eq!(all_steps(dir.path()).unwrap(), (3..11).collect::<Vec<_>>());
        assert!(view() == seen, "the view changed");
        for (step, record) in (3..11).zip(&records) {
            assert_eq!(read_any_step(dir.path(), step).unwrap(), *record);
        }
        assert_eq!(
            pack_steps(&lock(dir.path()), 2, 4).unwrap(),
            0,
            "nothing new to pack"
        );
        assert_eq!(unpack_steps(&lock(dir.path())).unwrap(), 6);
        let after = files(dir.path());
        assert!(after.keys().eq(before.keys()), "{:?}", after.keys());
        for (name, bytes) in &before {
            assert!(after[name] == *bytes, "{name} differs");
        }
    }
}

/// Wrong: a packing that was killed half-way could not be finished, or steps would be shown twice.
#[test]
fn an_interrupted_packing_can_be_finished() {
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), Storage::default());
    let before = files(dir.path());
    pack_steps(&lock(dir.path()), 1, 100).unwrap();
    // Killed while it removed the files: some are there beside the pack.
    for name in ["step_000005.hdf", "step_000009.hdf"] {
        fs::write(dir.path().join(name), &before[name]).unwrap();
    }
    assert_eq!(checkpoint::rebuild_index(dir.path()).unwrap().n_steps, 8);
    shown(dir.path(), "PointData/displacement");
    assert_eq!(pack_steps(&lock(dir.path()), 1, 100).unwrap(), 2);
    assert_eq!(committed_steps(dir.path()).unwrap(), [10]);
    // Killed while it unpacked: the same.
    fs::write(dir.path().join("step_000004.hdf"), &before["step_000004.hdf"]).unwrap();
    assert_eq!(unpack_steps(&lock(dir.path())).unwrap(), 6);
    assert!(files(dir.path()) == before);
}

/// Wrong: the half-written pack of a command that was killed, as large as the results and hidden, would fill the disk
/// for good, one more for each kill.
#[test]
fn what_a_killed_packing_has_left_is_removed() {
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), Storage::default());
    let before = files(dir.path());
    let half = dir.path().join(".pack_000003_000005.hdf.tmp");
    fs::write(&half, "half").unwrap();
    assert_eq!(pack_steps(&lock(dir.path()), 2, 100).unwrap(), 6);
    assert!(!half.exists());
    fs::write(&half, "half").unwrap();
    assert_eq!(unpack_steps(&lock(dir.path())).unwrap(), 6);
    assert!(files(dir.path()) == before);
}

/// Wrong: damage would be packed or unpacked as if it were a result, or take whole steps with it.
#[test]
fn damage_stops_packing_and_unpacking() {
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), Storage::default());
    let path = dir.path().join("step_000004.hdf");
    let good = fs::read(&path).unwrap();
    let mut bytes = good.clone();
    bytes[good.len() / 2] ^= 1;
    fs::write(&path, &bytes).unwrap();
    let before = files(dir.path());
    let text = pack_steps(&lock(dir.path()), 1, 100).unwrap_err().to_string();
    assert!(text.contains("step_000004.hdf"), "{text}");
    assert!(files(dir.path()) == before, "a refused packing changed something");
    fs::write(&path, &good).unwrap();
    pack_steps(&lock(dir.path()), 1, 100).unwrap();
    let (pack, _) = packs(dir.path()).unwrap().remove(0);
    let mut bytes = fs::read(&pack).unwrap();
    let value = record(6).points.displacement[2][1].to_le_bytes();
    let at = bytes.windows(8).position(|window| window == value).unwrap();
    bytes[at] ^= 1;
    fs::write(&pack, bytes).unwrap();
    let text = read_any_step(dir.path(), 6).unwrap_err().to_string();
    assert!(text.contains("/VTKHDF/PointData/displacement"), "{text}");
    assert_eq!(
        read_any_step(dir.path(), 5).unwrap().step,
        5,
        "other steps are whole"
    );
    let text = unpack_steps(&lock(dir.path())).unwrap_err().to_string();
    assert!(
        text.contains("pack_000003_000009.hdf")
            && text.contains("/step_000006/VTKHDF/PointData/displacement"),
        "{text}"
    );
    assert!(pack.exists(), "a damaged pack is kept");
    // A new run must not be written over packed results.
    fs::remove_file(dir.path().join("step_000010.hdf")).unwrap();
    let text = Output::create(dir.path(), &bodies(), Storage::default())
        .unwrap_err()
        .to_string();
    assert!(text.contains("pack_000003_000009.hdf"), "{text}");
}
