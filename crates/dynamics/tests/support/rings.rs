//! Ring meshes of the 7010C for tests: a structured section, revolved.

use std::collections::BTreeMap;

use contact::{BearingGeometry, Groove, Side};
use dynamics::{Hold, RingModel};
use mesh::{Arc, ElementKind, Mesh, Section, Snap, revolve};

/// How finely a ring is divided.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    pub sectors: usize,
    pub groove: usize,
    pub shoulder: usize,
    pub thickness: usize,
    pub kind: ElementKind,
}

impl Level {
    pub const fn hex8(sectors: usize, groove: usize, shoulder: usize, thickness: usize) -> Level {
        Level {
            sectors,
            groove,
            shoulder,
            thickness,
            kind: ElementKind::Hex8,
        }
    }

    pub const fn hex20(sectors: usize, groove: usize, shoulder: usize, thickness: usize) -> Level {
        Level {
            sectors,
            groove,
            shoulder,
            thickness,
            kind: ElementKind::Hex20,
        }
    }
}

/// A ring of the 7010C.
pub fn ring(side: Side, level: Level, hold: Hold) -> RingModel {
    let (seat, shoulder, group) = measures(side);
    let mesh = ring_mesh(groove(side), seat, shoulder, group, level);
    ring_model(side, mesh, hold)
}

/// A ring whose mesh is turned about its axis.
pub fn turned(mut ring: RingModel, angle: f64) -> RingModel {
    let (sin, cos) = angle.sin_cos();
    let nodes = ring.mesh.nodes.iter();
    let nodes: Vec<[f64; 3]> = nodes
        .map(|[x, y, z]| [cos * x - sin * y, sin * x + cos * y, *z])
        .collect();
    ring.mesh.nodes = nodes.into();
    ring
}

/// The ring with a given mesh.
pub fn ring_model(side: Side, mesh: Mesh, hold: Hold) -> RingModel {
    RingModel {
        mesh,
        material: super::steel(),
        hold,
        held_group: measures(side).2,
        groove: groove(side),
        tie: None,
        sectors: Default::default(),
    }
}

/// Places of the nodes of a section: columns across the groove as shares of its half, rows from the raceway as shares
/// of the depth.
pub struct Columns {
    pub shares: Vec<f64>,
    pub rows: Vec<f64>,
    pub shoulder_elements: usize,
}

/// Seat radius, shoulder radius, held group.
pub fn measures(side: Side) -> (f64, f64, &'static str) {
    match side {
        Side::Inner => (25e-3, 30.2e-3, "bore"),
        Side::Outer => (40e-3, 34.3e-3, "seat"),
    }
}

pub fn groove(side: Side) -> Groove {
    let geometry = BearingGeometry::reference_7010c();
    Groove {
        side,
        centre_radius: geometry.centre_radius(side),
        groove_radius: geometry.groove_radius(side),
        centre_z: 0.0,
    }
}

fn ring_mesh(groove: Groove, seat: f64, shoulder: f64, group: &str, level: Level) -> Mesh {
    let columns = Columns {
        shares: (0..=level.groove)
            .map(|i| i as f64 / level.groove as f64 * 2.0 - 1.0)
            .collect(),
        // Rows get finer towards the raceway.
        rows: (0..=level.thickness)
            .map(|j| (j as f64 / level.thickness as f64).powf(1.4))
            .collect(),
        shoulder_elements: level.shoulder,
    };
    revolved(groove, seat, shoulder, group, &columns, level.sectors, level.kind)
}

/// A revolved section.
pub fn revolved(
    groove: Groove,
    seat: f64,
    shoulder: f64,
    group: &str,
    places: &Columns,
    sectors: usize,
    kind: ElementKind,
) -> Mesh {
    let half_width = 8e-3;
    let edge = (groove.side.sign() * (shoulder - groove.centre_radius) / groove.groove_radius).acos();
    let groove_z = groove.groove_radius * edge.sin();
    let n_shoulder = places.shoulder_elements;
    // Raceway side and seat side points, from -z to +z.
    let (mut race, mut back) = (Vec::new(), Vec::new());
    let columns = 2 * n_shoulder + places.shares.len() - 1;
    for i in 0..=columns {
        let (left, right) = (
            i as f64 / n_shoulder as f64,
            (columns - i) as f64 / n_shoulder as f64,
        );
        if i < n_shoulder {
            let z = -half_width + left * (half_width - groove_z);
            race.push([shoulder, z]);
            back.push([seat, z]);
        } else if columns - i < n_shoulder {
            let z = half_width - right * (half_width - groove_z);
            race.push([shoulder, z]);
            back.push([seat, z]);
        } else {
            let share = places.shares[i - n_shoulder];
            let angle = share * edge;
            let sign = groove.side.sign();
            race.push([
                groove.centre_radius + sign * groove.groove_radius * angle.cos(),
                groove.groove_radius * angle.sin(),
            ]);
            back.push([seat, share * groove_z]);
        }
    }
    let rows = places.rows.len() - 1;
    let points: Vec<[f64; 2]> = (0..=columns)
        .flat_map(|i| {
            let (a, b) = (race[i], back[i]);
            let along = move |s: &f64| [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])];
            places.rows.iter().map(along)
        })
        .collect();
    let node = |i: usize, j: usize| i * (rows + 1) + j;
    let mut quads = Vec::new();
    for i in 0..columns {
        for j in 0..rows {
            quads.push([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]);
        }
    }
    let on_groove = n_shoulder..columns - n_shoulder;
    let raceway = on_groove.map(|i| [node(i, 0), node(i + 1, 0)]).collect();
    let held = (0..columns).map(|i| [node(i, rows), node(i + 1, rows)]).collect();
    let groups = BTreeMap::from([("raceway".to_string(), raceway), (group.to_string(), held)]);
    let section = Section::new(points, quads, &groups).unwrap();
    let arc = Arc {
        centre_r: groove.centre_radius,
        centre_z: 0.0,
        radius: groove.groove_radius,
    };
    let snap = Snap {
        group: "raceway".to_string(),
        arc,
    };
    revolve(&section, sectors, kind, &[snap]).unwrap()
}
