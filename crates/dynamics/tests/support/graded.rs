//! A ring of the 7010C whose mesh is graded towards one contact.

use std::f64::consts::PI;

use contact::Side;
use dynamics::{Hold, RingModel};
use mesh::ElementKind;

use super::rings::{Columns, groove, measures, revolved, ring_model};

/// How a mesh is graded towards a contact at azimuth 0: [size there, half the width of that size] along the groove
/// and in the rolling direction, rad, and in depth, m; beyond, every element is larger than the one before by a
/// factor.
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
/// Longest element in the rolling direction, rad: a parabola through its nodes is an arc to 1e-3 of its length.
const LONGEST: f64 = 0.4;

/// Places from 0 to `end`: steps of `size` up to `width`, then growing ones up to `cap`, stretched so that the last
/// place is `end`.
pub fn graded([size, width]: [f64; 2], growth: f64, end: f64, cap: f64) -> Vec<f64> {
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
    let half = graded(grading.rolling, grading.growth, PI, LONGEST);
    let mut azimuths: Vec<f64> = half[..half.len() - 1].to_vec();
    azimuths.extend(half.iter().rev().map(|x| 2.0 * PI - x));
    let shares: Vec<f64> = angles.iter().map(|x| x / edge).collect();
    let n = azimuths.len() - 1;
    let columns = Columns {
        shares,
        rows,
        shoulder_elements: 2,
    };
    let mut mesh = revolved(own, seat, shoulder, group, &columns, n, ElementKind::Hex20);
    for x in &mut mesh.nodes {
        let turn = x[1].atan2(x[0]).rem_euclid(2.0 * PI) / (2.0 * PI);
        // Planes of corners, and of mid-edge nodes half-way between them.
        let half_plane = (2.0 * turn * n as f64).round() as usize % (2 * n);
        let azimuth = 0.5 * (azimuths[half_plane / 2] + azimuths[half_plane.div_ceil(2)]);
        let r = x[0].hypot(x[1]);
        (x[0], x[1]) = (r * azimuth.cos(), r * azimuth.sin());
    }
    ring_model(side, mesh, hold)
}
