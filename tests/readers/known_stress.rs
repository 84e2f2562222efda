//! A stress that is known by hand, written and read back by the program, by VTK and by ParaView.

use std::process::Command;

use checkpoint::{
    Body, CellFields, IntegrationPointStress, Output, PointFields, Precision, StepRecord, Storage, read_step,
    step_file_name,
};
use fem::{Material, StressRecovery, von_mises};
use mesh::{Mesh, RingSide};
use serde_json::Value;

use super::{SCREEN, output_of, paraview, python, reader};
use crate::util::Dir;
use crate::util::rings::{TINY, ring};

/// Displacement gradient of the known state: strain xx 1e-3, yy -2e-4, zz 3e-4, engineering shear xy 4e-4, yz -1e-4,
/// xz 2e-4, and rotations besides, which must not matter.
const KNOWN_GRADIENT: [[f64; 3]; 3] = [[1e-3, 3e-4, 5e-5], [1e-4, -2e-4, -2e-4], [1.5e-4, 1e-4, 3e-4]];
/// Its stress by Hooke's law by hand, MPa: with E = 200 GPa and Poisson's ratio 1/4, lambda = mu = 80 GPa, trace
/// 1.1e-3: xx = 88 + 160, yy = 88 - 32, zz = 88 + 48; xy = 80e3 4e-4 and so on.
const KNOWN_STRESS: [f64; 6] = [248.0, 56.0, 136.0, 32.0, -8.0, 16.0];
/// Square of its von Mises stress, MPa^2: (192^2 + 80^2 + 112^2)/2 + 3 (32^2 + 8^2 + 16^2).
const KNOWN_VON_MISES_SQUARED: f64 = 31936.0;

/// A folder `out` with two steps of two rings, the second strained twice as much, stress recovered by the program's own
/// finite elements and written at nodes and at integration points.
fn known_strain() -> Dir {
    let dir = Dir::empty();
    let rings = [RingSide::Inner, RingSide::Outer].map(|side| ring(side, TINY));
    let bodies = [
        Body::from_mesh("inner ring", 0, &rings[0], [0.0; 3]),
        Body::from_mesh("outer ring", 1, &rings[1], [0.0; 3]),
        Body::balls("balls", 2, &[[33e-3, 0.0, 0.0], [0.0, 33e-3, 0.0]], 4.5e-3),
    ];
    let storage = Storage {
        stress: Precision::F64,
        ..Storage::default()
    };
    let mut output = Output::create(&dir.path("out"), &bodies, storage).unwrap();
    for step in [1, 2] {
        output.write_step(&strained(&rings, step)).unwrap();
    }
    output.finish().unwrap();
    dir
}

fn strained(rings: &[Mesh; 2], step: u64) -> StepRecord {
    let material = Material::new(200e9, 0.25, 7800.0).unwrap();
    let (mut displacement, mut nodal, mut values) = (Vec::new(), Vec::new(), Vec::new());
    for ring in rings {
        let moved = |x: &[f64; 3]| {
            KNOWN_GRADIENT.map(|row| step as f64 * (row[0] * x[0] + row[1] * x[1] + row[2] * x[2]))
        };
        let u: Vec<[f64; 3]> = ring.nodes.iter().map(moved).collect();
        let recovery = StressRecovery::new(ring, &material).unwrap();
        nodal.extend(recovery.nodal(u.as_flattened()));
        values.extend(recovery.integration_points(u.as_flattened()).into_flattened());
        displacement.extend(u);
    }
    displacement.extend([[0.0; 3]; 2]);
    nodal.extend([[0.0; 6]; 2]);
    values.extend([0.0; 2 * 48]);
    StepRecord {
        step,
        time: 1e-5 * step as f64,
        points: PointFields {
            displacement,
            von_mises: Some(nodal.iter().map(|&s| von_mises(s)).collect()),
            stress: Some(nodal),
            ..PointFields::default()
        },
        cells: CellFields {
            stress_integration_points: Some(IntegrationPointStress {
                points_per_cell: 8,
                values,
                layout: "eight points, xx yy zz xy yz xz".to_string(),
            }),
            von_mises_largest: None,
            in_region: None,
        },
        scene: String::new(),
        ..StepRecord::default()
    }
}

/// Compares tensors with the known one, times the number of the step.
#[track_caller]
fn assert_known(found: &[f64], step: u64) {
    assert!(!found.is_empty() && found.len().is_multiple_of(6));
    for (i, &value) in found.iter().enumerate() {
        let expected = 1e6 * step as f64 * KNOWN_STRESS[i % 6];
        // Round-off of a strain of 1e-3 of places of 40 mm in elements of 1 mm.
        assert!(
            (value - expected).abs() < 1e-9 * 248e6,
            "component {}: {value} Pa, by hand {expected} Pa",
            i % 6
        );
    }
}

/// Wrong: the stress in a file would not be that of the strain, by hand, at every node and integration point.
#[test]
fn a_stress_known_by_hand_is_read_back() {
    let dir = known_strain();
    for step in [1, 2] {
        let record = read_step(&dir.path(&format!("out/{}", step_file_name(step)))).unwrap();
        let stress = record.points.stress.unwrap();
        let (rings, balls) = stress.split_at(stress.len() - 2);
        assert_known(rings.as_flattened(), step);
        assert_eq!(balls, [[0.0; 6]; 2]);
        let points = record.cells.stress_integration_points.unwrap().values;
        assert_known(&points[..points.len() - 2 * 48], step);
        let von_mises = record.points.von_mises.unwrap()[0] / (1e6 * step as f64);
        assert!((von_mises.powi(2) / KNOWN_VON_MISES_SQUARED - 1.0).abs() < 1e-9);
    }
}

/// Fails unless a reader saw the known stress at a node and in the first cell of both steps.
#[track_caller]
fn assert_known_seen(text: &str, steps: &[u64]) {
    let line = text.lines().find_map(|line| line.strip_prefix("seen "));
    let seen: Vec<Value> =
        serde_json::from_str(line.unwrap_or_else(|| panic!("nothing seen: {text}"))).unwrap();
    assert_eq!(seen.len(), steps.len(), "{text}");
    for (seen, &step) in seen.iter().zip(steps) {
        for (name, n) in [("stress", 6), ("first_cell", 48)] {
            let numbers: Vec<f64> = serde_json::from_value(seen[name].clone()).unwrap();
            assert_eq!(numbers.len(), n, "{name}: {text}");
            assert_known(&numbers, step);
        }
    }
}

/// Wrong: VTK would show another stress than the one known by hand, at a node or at the integration points of a cell,
/// in a step, in the view of all steps, packed or not, or in what is exported.
#[test]
fn vtk_reads_the_stress_known_by_hand() {
    let Some(python) = python() else { return };
    let dir = known_strain();
    let read = |file: &str| {
        let path = dir.path(file);
        output_of(Command::new(&python).args([&reader(), "vtk", path.to_str().unwrap(), "17"]))
    };
    assert_known_seen(&read("out/step_000002.hdf"), &[2]);
    assert_known_seen(&read("out/run.vtkhdf"), &[1, 2]);
    let outcome = dir.raceway(&["export", "out", "--to", "vtu"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert_known_seen(&read("out/export/step_000001.vtu"), &[1]);
    let outcome = dir.raceway(&["pack", "out", "--keep", "1"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert_known_seen(&read("out/run.vtkhdf"), &[1, 2]);
}

/// Wrong: ParaView would show another stress than the one known by hand.
#[test]
fn paraview_reads_the_stress_known_by_hand() {
    let Some(_alone) = paraview() else { return };
    let dir = known_strain();
    let path = dir.path("out/run.hdf.series");
    let arguments = [&reader(), "paraview", path.to_str().unwrap(), "17"];
    assert_known_seen(
        &output_of(Command::new("xvfb-run").args(SCREEN).args(arguments)),
        &[1, 2],
    );
}
