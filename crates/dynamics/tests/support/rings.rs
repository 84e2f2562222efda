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

/// The ring with a given mesh.
pub fn ring_model(side: Side, mesh: Mesh, hold: Hold) -> RingModel {
    RingModel {
        mesh,
        material: super::steel(),
        hold,
        held_group: measures(side).2,
        groove: groove(side),
        sectors: Default::default(),
    }
}

/// Seat radius, shoulder radius, held group.
fn measures(side: Side) -> (f64, f64, &'static str) {
    match side {
        Side::Inner => (25e-3, 30.2e-3, "bore"),
        Side::Outer => (40e-3, 34.3e-3, "seat"),
    }
}

fn groove(side: Side) -> Groove {
    let geometry = BearingGeometry::reference_7010c();
    Groove {
        side,
        centre_radius: geometry.centre_radius(side),
        groove_radius: geometry.groove_radius(side),
        centre_z: 0.0,
    }
}

fn ring_mesh(groove: Groove, seat: f64, shoulder: f64, group: &str, level: Level) -> Mesh {
    let half_width = 8e-3;
    let edge = (groove.side.sign() * (shoulder - groove.centre_radius) / groove.groove_radius).acos();
    let groove_z = groove.groove_radius * edge.sin();
    // Raceway side and seat side points, from -z to +z.
    let (mut race, mut back) = (Vec::new(), Vec::new());
    let columns = 2 * level.shoulder + level.groove;
    for i in 0..=columns {
        let (left, right) = (
            i as f64 / level.shoulder as f64,
            (columns - i) as f64 / level.shoulder as f64,
        );
        if i < level.shoulder {
            let z = -half_width + left * (half_width - groove_z);
            race.push([shoulder, z]);
            back.push([seat, z]);
        } else if columns - i < level.shoulder {
            let z = half_width - right * (half_width - groove_z);
            race.push([shoulder, z]);
            back.push([seat, z]);
        } else {
            let share = (i - level.shoulder) as f64 / level.groove as f64 * 2.0 - 1.0;
            let angle = share * edge;
            let sign = groove.side.sign();
            race.push([
                groove.centre_radius + sign * groove.groove_radius * angle.cos(),
                groove.groove_radius * angle.sin(),
            ]);
            back.push([seat, share * groove_z]);
        }
    }
    let rows = level.thickness;
    let points: Vec<[f64; 2]> = (0..=columns)
        .flat_map(|i| {
            let (a, b) = (race[i], back[i]);
            (0..=rows).map(move |j| {
                // Rows get finer towards the raceway.
                let s = (j as f64 / rows as f64).powf(1.4);
                [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])]
            })
        })
        .collect();
    let node = |i: usize, j: usize| i * (rows + 1) + j;
    let mut quads = Vec::new();
    for i in 0..columns {
        for j in 0..rows {
            quads.push([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]);
        }
    }
    let on_groove = level.shoulder..level.shoulder + level.groove;
    let raceway = on_groove.map(|i| [node(i, 0), node(i + 1, 0)]).collect();
    let held = (0..columns).map(|i| [node(i, rows), node(i + 1, rows)]).collect();
    let groups = BTreeMap::from([("raceway".to_string(), raceway), (group.to_string(), held)]);
    let section = Section::new(points, quads, &groups).unwrap();
    let arc = Arc {
        centre_r: groove.centre_radius,
        centre_z: 0.0,
        radius: groove.groove_radius,
    };
    revolve(
        &section,
        level.sectors,
        level.kind,
        &[Snap {
            group: "raceway".to_string(),
            arc,
        }],
    )
    .unwrap()
}
