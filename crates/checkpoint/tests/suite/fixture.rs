//! A tiny bearing: one hexahedron, one tetrahedron, two balls, and records with values that are easy to get wrong.

use std::collections::BTreeMap;

use checkpoint::{
    Body, CellFields, FileStamp, IntegrationPointStress, PointFields, Stamps, StateArray, StepRecord,
};
use mesh::{ElementKind, Mesh};

/// Points of all bodies: 8 + 10 + 2.
pub const N_POINTS: usize = 20;
/// Cells of all bodies: 1 + 1 + 2.
pub const N_CELLS: usize = 4;

pub fn hexahedron() -> Mesh {
    let corner = |i: usize| [[0, 1, 1, 0][i % 4], [0, 0, 1, 1][i % 4], i / 4].map(|c| c as f64 * 1e-3);
    Mesh {
        kind: ElementKind::Hex8,
        nodes: (0..8).map(corner).collect(),
        connectivity: (0..8).collect(),
        groups: BTreeMap::new(),
    }
}

pub fn tetrahedron() -> Mesh {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let middle = |(a, b): (usize, usize)| [0, 1, 2].map(|i| (corners[a][i] + corners[b][i]) / 2.0);
    let edges = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)];
    let nodes = corners.into_iter().chain(edges.map(middle)).collect();
    Mesh {
        kind: ElementKind::Tet10,
        nodes,
        connectivity: (0..10).collect(),
        groups: BTreeMap::new(),
    }
}

pub fn bodies() -> Vec<Body> {
    vec![
        Body::from_mesh("outer_ring", 0, &hexahedron(), [0.0; 3]),
        Body::from_mesh("inner_ring", 1, &tetrahedron(), [0.0, 0.0, 2.5e-3]),
        Body::balls("balls", 2, &[[3e-3, 0.0, 0.0], [-3e-3, 0.0, 0.0]], 0.5e-3),
    ]
}

/// A record with all fields; values differ between steps, fields, points and components, and are not f32 numbers.
pub fn record(step: u64) -> StepRecord {
    let value =
        |field: usize, i: usize, j: usize| (1.0 + step as f64) * (0.1 + (1000 * field + 10 * i + j) as f64);
    let vector = |field| {
        (0..N_POINTS)
            .map(|i| [0, 1, 2].map(|j| value(field, i, j)))
            .collect::<Vec<_>>()
    };
    let points = PointFields {
        displacement: vector(0),
        velocity: Some(vector(1)),
        acceleration: Some(vector(2)),
        stress: Some(
            (0..N_POINTS)
                .map(|i| [0, 1, 2, 3, 4, 5].map(|j| value(3, i, j)))
                .collect(),
        ),
        von_mises: Some((0..N_POINTS).map(|i| value(4, i, 0)).collect()),
        force_inner: Some(vector(5)),
        force_outer: Some(vector(6)),
        in_region: None,
    };
    let state = BTreeMap::from([
        (
            "cage_angle".to_string(),
            StateArray::Real(vec![-0.0, f64::MIN_POSITIVE / 2.0, f64::INFINITY, 1.0 / 3.0]),
        ),
        ("empty".to_string(), StateArray::Real(Vec::new())),
        (
            "in_contact".to_string(),
            StateArray::Integer(vec![i64::MIN, -1, 0, i64::MAX]),
        ),
    ]);
    let scene = "[bearing]\nballs = 2 # Kugeln, größer als nötig\n".to_string();
    StepRecord {
        step,
        time: 1e-5 * step as f64,
        points,
        cells: cells(step),
        scene,
        state,
        tables: Some(Stamps::from([
            (
                "balls.csv".to_string(),
                FileStamp {
                    length: 1000 * step,
                    crc: 7,
                },
            ),
            ("Größe 1.csv".to_string(), FileStamp { length: 0, crc: 0 }),
        ])),
    }
}

/// Fields over the cells: one hexahedron with eight points, one tetrahedron with four, two balls with none.
fn cells(step: u64) -> CellFields {
    let value = |i: usize| (1.0 + step as f64) * (0.1 + (7000 + i) as f64);
    let mut values: Vec<f64> = (0..N_CELLS * 48).map(value).collect();
    values[48 + 4 * 6..].fill(0.0);
    CellFields {
        stress_integration_points: Some(IntegrationPointStress {
            points_per_cell: 8,
            values,
            layout: "Größen: xx yy zz xy yz xz of 8 points".to_string(),
        }),
        von_mises_largest: Some((0..N_CELLS).map(|i| value(900 + i)).collect()),
        in_region: None,
    }
}

/// The smallest record: what a static solution without stress would write.
pub fn bare_record(step: u64) -> StepRecord {
    let full = record(step);
    let points = PointFields {
        displacement: full.points.displacement,
        ..PointFields::default()
    };
    StepRecord {
        points,
        cells: CellFields::default(),
        state: BTreeMap::new(),
        tables: None,
        ..full
    }
}
