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

/// How a mesh is graded towards a contact at azimuth 0: [size there, half the width of that size] along the groove and in the rolling
/// direction, rad, and in depth, m; beyond, every element is larger than the one before by a factor.
#[derive(Clone, Copy, Debug)]
pub struct Grading {
    pub angle: f64,
    pub along: [f64; 2],
    pub rolling: [f64; 2],
    pub depth: [f64; 2],
    pub growth: f64,
}

/// Largest element along the groove, rad: the arc of a wider one would reach through the thin elements below it.
const WIDEST: f64 = 0.1;

/// Places from 0 to `end`: steps of `size` up to `width`, then growing ones up to `cap`, stretched so that the last place is `end`.
fn graded([size, width]: [f64; 2], growth: f64, end: f64, cap: f64) -> Vec<f64> {
    let mut places = vec![0.0];
    while *places.last().unwrap() < width - 0.5 * size {
        places.push(places.len() as f64 * size);
    }
    let (start, mut step, mut rest) = (*places.last().unwrap(), size, vec![]);
    let mut at = start;
    while at < end {
        step = (growth * step).min(cap);
        at += step;
        rest.push(at);
    }
    let stretch = (end - start) / (at - start);
    places.extend(rest.iter().map(|x| start + stretch * (x - start)));
    places
}

/// A ring of the 7010C with a graded mesh of hex20.
pub fn graded_ring(side: Side, grading: Grading, hold: Hold) -> RingModel {
    let (seat, shoulder, group) = measures(side);
    let own = groove(side);
    let edge = (own.side.sign() * (shoulder - own.centre_radius) / own.groove_radius).acos();
    let axial = own.side.sign() * grading.angle;
    let up = graded(grading.along, grading.growth, edge - axial, WIDEST);
    let down = graded(grading.along, grading.growth, edge + axial, WIDEST);
    let mut angles: Vec<f64> = down.iter().rev().map(|x| axial - x).collect();
    angles.extend(up[1..].iter().map(|x| axial + x));
    let thickness = (seat - own.radius(0.0)).abs();
    let rows: Vec<f64> = graded(grading.depth, grading.growth, thickness, thickness)
        .iter()
        .map(|x| x / thickness)
        .collect();
    let half = graded(grading.rolling, grading.growth, std::f64::consts::PI, 1.0);
    let mut azimuths: Vec<f64> = half[..half.len() - 1].to_vec();
    azimuths.extend(half.iter().rev().map(|x| 2.0 * std::f64::consts::PI - x));
    let shares: Vec<f64> = angles.iter().map(|x| x / edge).collect();
    let n = azimuths.len() - 1;
    let columns = Columns {
        shares,
        rows,
        shoulder_elements: 2,
    };
    let mut mesh = revolved(own, seat, shoulder, group, &columns, n, ElementKind::Hex20);
    for x in &mut mesh.nodes {
        let turn = x[1].atan2(x[0]).rem_euclid(2.0 * std::f64::consts::PI) / (2.0 * std::f64::consts::PI);
        // Planes of corners, and of mid-edge nodes half-way between them.
        let half_plane = (2.0 * turn * n as f64).round() as usize % (2 * n);
        let azimuth = 0.5 * (azimuths[half_plane / 2] + azimuths[half_plane.div_ceil(2)]);
        let r = x[0].hypot(x[1]);
        (x[0], x[1]) = (r * azimuth.cos(), r * azimuth.sin());
    }
    ring_model(side, mesh, hold)
}

/// Places of the nodes of a section: columns across the groove as shares of its half, rows from the raceway as shares of the depth.
struct Columns {
    shares: Vec<f64>,
    rows: Vec<f64>,
    shoulder_elements: usize,
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

fn revolved(
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
