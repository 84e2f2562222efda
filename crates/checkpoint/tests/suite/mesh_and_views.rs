//! The mesh file and the two views of all steps, as a reader that follows links finds them.

use std::fs;
use std::path::Path;

use checkpoint::{FolderLock, Output, Precision, Storage, point_ranges, rebuild_index};

use crate::fixture::{N_POINTS, bare_record, bodies, record};

const EXACT: Storage = Storage {
    stress: Precision::F64,
    stress_error: None,
    displacement: Precision::F64,
    compression: checkpoint::Compression::None,
};

fn run(dir: &Path, steps: u64) {
    let mut output = Output::create(dir, &bodies(), EXACT).unwrap();
    for step in 0..steps {
        output.write_step(&record(step)).unwrap();
    }
    output.finish().unwrap();
}

fn array<T: hdf5::H5Type>(file: &hdf5::File, name: &str) -> Vec<T> {
    file.dataset(&format!("/VTKHDF/{name}"))
        .unwrap()
        .read_raw()
        .unwrap()
}

/// Wrong if bodies were joined with the wrong offsets, types or places. VTK types: 12 hexahedron, 24 quadratic
/// tetrahedron, 1 vertex (VTK File Formats, Figures 2 and 3).
#[test]
fn every_file_shows_the_same_mesh() {
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), 2);
    for name in ["mesh.hdf", "step_000001.hdf", "run.vtkhdf"] {
        let file = hdf5::File::open(dir.path().join(name)).unwrap();
        let points: Vec<[f64; 3]> = bodies().into_iter().flat_map(|body| body.points).collect();
        assert_eq!(array::<f64>(&file, "Points"), points.as_flattened());
        assert_eq!(array::<i64>(&file, "Connectivity"), (0..20).collect::<Vec<i64>>());
        assert_eq!(array::<i64>(&file, "Offsets"), [0, 8, 18, 19, 20]);
        assert_eq!(array::<u8>(&file, "Types"), [12, 24, 1, 1]);
        assert_eq!(array::<u8>(&file, "CellData/body"), [0, 1, 2, 2]);
        assert_eq!(array::<f64>(&file, "CellData/radius"), [0.0, 0.0, 0.5e-3, 0.5e-3]);
        for (size, expected) in [
            ("NumberOfPoints", 20),
            ("NumberOfCells", 4),
            ("NumberOfConnectivityIds", 20),
        ] {
            assert_eq!(array::<i64>(&file, size), [expected], "{size} of {name}");
        }
    }
    assert_eq!(
        bodies()[1].points[3],
        [0.0, 0.0, 1.0 + 2.5e-3],
        "the inner ring is moved to its place"
    );
    assert_eq!(point_ranges(&bodies()), [0..8, 8..18, 18..20]);
}

/// Wrong if ParaView could not recognise the files: VTK asks for an attribute of fixed-length ASCII.
#[test]
fn the_type_attribute_is_a_fixed_ascii_string() {
    use hdf5::types::{FixedAscii, TypeDescriptor};
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), 1);
    for (name, version) in [
        ("mesh.hdf", [1, 0]),
        ("step_000000.hdf", [1, 0]),
        ("run.vtkhdf", [2, 0]),
    ] {
        let file = hdf5::File::open(dir.path().join(name)).unwrap();
        let root = file.group("VTKHDF").unwrap();
        let kind = root.attr("Type").unwrap();
        assert_eq!(
            kind.dtype().unwrap().to_descriptor().unwrap(),
            TypeDescriptor::FixedAscii(16)
        );
        assert_eq!(
            kind.read_scalar::<FixedAscii<16>>().unwrap().as_str(),
            "UnstructuredGrid"
        );
        assert_eq!(root.attr("Version").unwrap().read_raw::<i64>().unwrap(), version);
    }
}

/// Wrong if the series listed other files or times than those committed; times must be equal to the last bit.
#[test]
fn the_series_lists_every_step_with_its_time() {
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), 12);
    let text = fs::read_to_string(dir.path().join("run.hdf.series")).unwrap();
    let series: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(series["file-series-version"], "1.0");
    let files = series["files"].as_array().unwrap();
    assert_eq!(files.len(), 12);
    for (step, file) in (0..).zip(files) {
        assert_eq!(file["name"], format!("step_{step:06}.hdf"));
        assert_eq!(
            file["time"].as_f64().unwrap().to_bits(),
            record(step).time.to_bits()
        );
    }
}

/// Wrong if the index showed a step at the wrong time or a field at the wrong rows.
#[test]
fn the_index_shows_the_values_of_every_step() {
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), 3);
    let file = hdf5::File::open(dir.path().join("run.vtkhdf")).unwrap();
    let records = [0, 1, 2].map(record);
    assert_eq!(
        array::<f64>(&file, "Steps/Values"),
        records.each_ref().map(|r| r.time)
    );
    assert_eq!(
        file.group("VTKHDF/Steps")
            .unwrap()
            .attr("NSteps")
            .unwrap()
            .read_scalar::<i64>()
            .unwrap(),
        3
    );
    let stress: Vec<f64> = records
        .iter()
        .flat_map(|r| r.points.stress.clone().unwrap())
        .flatten()
        .collect();
    assert_eq!(array::<f64>(&file, "PointData/stress"), stress);
    let von_mises: Vec<f64> = records
        .iter()
        .flat_map(|r| r.points.von_mises.clone().unwrap())
        .collect();
    assert_eq!(array::<f64>(&file, "PointData/von_mises"), von_mises);
    for name in [
        "displacement",
        "velocity",
        "acceleration",
        "stress",
        "von_mises",
        "force_inner",
        "force_outer",
    ] {
        assert_eq!(
            array::<i64>(&file, &format!("Steps/PointDataOffsets/{name}")),
            [0, 20, 40],
            "{name}"
        );
    }
    let cells = records.map(|r| r.cells);
    let stress = cells
        .each_ref()
        .map(|c| c.stress_integration_points.clone().unwrap().values);
    let name = "CellData/stress_integration_points";
    assert_eq!(array::<f64>(&file, name), stress.concat());
    assert_eq!(
        file.dataset(&format!("VTKHDF/{name}")).unwrap().shape(),
        [12, 48],
        "rows of eight tensors"
    );
    let largest = cells.map(|c| c.von_mises_largest.unwrap());
    assert_eq!(
        array::<f64>(&file, "CellData/von_mises_largest"),
        largest.concat()
    );
    for name in ["stress_integration_points", "von_mises_largest"] {
        let rows = array::<i64>(&file, &format!("Steps/CellDataOffsets/{name}"));
        assert_eq!(rows, [0, 4, 8], "{name}");
    }
}

/// Wrong if a step file that was deleted or not copied along read as zeros: an unloaded bearing.
#[test]
fn a_step_missing_from_the_index_reads_as_nan() {
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), 3);
    fs::remove_file(dir.path().join("step_000001.hdf")).unwrap();
    let file = hdf5::File::open(dir.path().join("run.vtkhdf")).unwrap();
    let values = array::<f64>(&file, "PointData/von_mises");
    assert!(values[N_POINTS..2 * N_POINTS].iter().all(|x| x.is_nan()));
    assert!(
        values[..N_POINTS]
            .iter()
            .chain(&values[2 * N_POINTS..])
            .all(|x| x.is_finite())
    );
}

/// Wrong if steps with other fields or another precision, as after a resume with other choices, broke the index.
#[test]
fn steps_may_differ_in_fields_and_precision() {
    let dir = tempfile::tempdir().unwrap();
    Output::create(dir.path(), &bodies(), Storage::default())
        .unwrap()
        .write_step(&record(0))
        .unwrap();
    let mut output = Output::resume(FolderLock::acquire(dir.path()).unwrap(), &bodies(), EXACT, 0)
        .unwrap()
        .output;
    output.write_step(&record(1)).unwrap();
    output.write_step(&bare_record(2)).unwrap();
    output.finish().unwrap();
    let file = hdf5::File::open(dir.path().join("run.vtkhdf")).unwrap();
    let values = array::<f64>(&file, "PointData/von_mises");
    let rounded = record(0)
        .points
        .von_mises
        .unwrap()
        .iter()
        .map(|&x| f64::from(x as f32))
        .collect::<Vec<_>>();
    assert_eq!(values[..N_POINTS], rounded);
    assert_eq!(
        values[N_POINTS..2 * N_POINTS],
        record(1).points.von_mises.unwrap()
    );
    assert!(values[2 * N_POINTS..].iter().all(|x| x.is_nan()));
}

/// Wrong if the views were more than views: deleted, they must come back the same from the steps alone.
#[test]
fn both_views_can_be_rebuilt() {
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), 4);
    let views = || ["run.hdf.series", "run.vtkhdf"].map(|name| fs::read(dir.path().join(name)).unwrap());
    let before = views();
    for name in ["run.hdf.series", "run.vtkhdf"] {
        fs::remove_file(dir.path().join(name)).unwrap();
    }
    assert_eq!(rebuild_index(dir.path()).unwrap().n_steps, 4);
    assert!(before == views(), "rebuilt views differ");
    let empty = tempfile::tempdir().unwrap();
    assert!(
        rebuild_index(empty.path())
            .unwrap_err()
            .to_string()
            .contains("holds no committed step")
    );
}
