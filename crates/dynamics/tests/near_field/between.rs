//! Stress between balls, where the finite elements are alone.

use std::f64::consts::PI;

use contact::near_field::in_axes;
use contact::patch_shape::PatchShape;
use contact::{RingPoint, SemiAxes, Side};
use fem::stress::von_mises;

use super::ANGLE;
use super::loaded::Ring;
use crate::support::rings::Level;

/// Points along each line of the comparison.
const N_LINE: usize = 25;
/// Angle from ball to ball.
const PITCH: f64 = PI / 9.0;
/// Where a pattern of elements is looked for: groove angles, rad, and depths, m.
const GROOVE_ANGLES: [f64; 6] = [-0.5, -0.2, 0.1, ANGLE, 0.6, 0.9];
const DEPTHS: [f64; 4] = [0.0, 0.5e-3, 1.5e-3, 2.5e-3];
/// Twice as fine as the others, of elements whose waves are gone after one.
const REFERENCE: Level = Level::hex20(360, 36, 4, 8);

/// The same on every mesh.
fn fixed_patch() -> PatchShape {
    PatchShape {
        azimuth: 0.0,
        angle: ANGLE,
        semi_axes: SemiAxes::new(2.5e-3, 3.5e-3),
        truncated: false,
    }
}

/// Von Mises stress, Pa, under one patch of fixed size at azimuth 0, from 7 to 13 degrees beside it, 10 degrees being
/// half-way to the next ball: on the raceway, and 1.5 mm below it.
fn lines(level: Level) -> Vec<f64> {
    let ring = Ring::new(Side::Outer, level);
    let point = |i: usize| RingPoint {
        azimuth: (7.0 + 0.25 * (i % N_LINE) as f64).to_radians(),
        angle: ANGLE,
        depth: [0.0, 1.5e-3][i / N_LINE],
    };
    let points: Vec<RingPoint> = (0..2 * N_LINE).map(point).collect();
    let stress = ring.stress(&ring.displacements(&[fixed_patch()]), &points);
    stress.into_iter().map(von_mises).collect()
}

fn gap(a: &[f64], b: &[f64]) -> f64 {
    let squares = a.iter().zip(b).map(|(x, y)| (x - y).powi(2));
    (squares.sum::<f64>() / a.len() as f64).sqrt()
}

/// Wrong: far from contacts, where the finite elements are alone, stress would not converge as that of its elements
/// does. Bounds chosen beforehand: nodal stress of hex8, a derivative of linear functions, of first order at least,
/// that of hex20 of second.
#[test]
#[ignore = "rings of 400 000 dofs: half a minute; scripts/test-slow runs it"]
fn stress_between_balls_converges_by_its_order() {
    let quadratic = [
        Level::hex20(45, 6, 1, 2),
        Level::hex20(90, 12, 2, 4),
        Level::hex20(180, 24, 4, 8),
    ]
    .map(lines);
    let linear = [
        Level::hex8(60, 6, 1, 2),
        Level::hex8(120, 12, 2, 4),
        Level::hex8(240, 24, 4, 8),
        Level::hex8(360, 36, 6, 12),
    ]
    .map(lines);
    let right = &quadratic[2];
    let largest = right.iter().copied().fold(0.0, f64::max);
    let errors = linear.each_ref().map(|l| gap(l, right));
    let steps = [gap(&quadratic[0], &quadratic[1]), gap(&quadratic[1], right)];
    let orders = [
        (errors[0] / errors[1]).log2(),
        (errors[1] / errors[2]).log2(),
        (errors[2] / errors[3]).ln() / 1.5f64.ln(),
    ];
    let order = (steps[0] / steps[1]).log2();
    println!("between balls: up to {largest:.3e} Pa");
    println!("hex8, 60 to 360 sectors: errors {errors:.3?} Pa, orders {orders:.2?}");
    println!("hex20, 45 to 180 sectors: changes {steps:.3?} Pa, order {order:.2}");
    assert!(orders[2] > 1.0 && orders[1] > 0.9, "hex8: {orders:?}");
    assert!(order > 2.0, "hex20: {order}");
}

/// Points of the third of the pitch between two balls, in planes of nodes and one plane beyond on both sides, plane
/// by plane.
fn between(level: Level) -> (usize, Vec<RingPoint>) {
    let element = 2.0 * PI / level.sectors as f64;
    let [first, last] = [PITCH / 3.0, PITCH * 2.0 / 3.0].map(|a| (a / element).round() as usize);
    let place = |azimuth: f64| {
        GROOVE_ANGLES.into_iter().flat_map(move |angle| {
            DEPTHS.into_iter().map(move |depth| RingPoint {
                azimuth,
                angle,
                depth,
            })
        })
    };
    let planes = first - 1..=last + 1;
    let points: Vec<RingPoint> = planes.flat_map(|k| place(k as f64 * element)).collect();
    (GROOVE_ANGLES.len() * DEPTHS.len(), points)
}

/// The largest part of any component, and of von Mises stress, that changes its sign from one plane of nodes to the
/// next, over the largest von Mises stress, in the third between two balls. All balls are loaded, through patches as
/// a run has them on the mesh. What the true field has in waves that short is taken off by a fine mesh, under the
/// same patches.
fn pattern(level: Level) -> f64 {
    let (own, fine) = (Ring::new(Side::Outer, level), Ring::new(Side::Outer, REFERENCE));
    let patch = own.patch(0.0);
    let balls: Vec<PatchShape> = (0..18)
        .map(|k| PatchShape {
            azimuth: k as f64 * PITCH,
            ..patch
        })
        .collect();
    let (stride, points) = between(level);
    let [found, right] = [&own, &fine].map(|ring| {
        let stress = ring.stress(&ring.displacements(&balls), &points);
        let quantities = |(s, p): ([f64; 6], &RingPoint)| {
            let [gg, tt, dd, gt, td, gd] = in_axes(s, &p.axes(&ring.ring().groove));
            [gg, tt, dd, gt, td, gd, von_mises(s)]
        };
        stress
            .into_iter()
            .zip(&points)
            .map(quantities)
            .collect::<Vec<_>>()
    });
    let inner = stride..points.len() - stride;
    let largest = right[inner.clone()].iter().map(|q| q[6]).fold(0.0, f64::max);
    let error = |i: usize, c: usize| found[i][c] - right[i][c];
    let most_of = |plane: usize| {
        let own = (plane * stride..(plane + 1) * stride).flat_map(|i| (0..7).map(move |c| (i, c)));
        let alternating = |(i, c)| 0.25 * (error(i - stride, c) - 2.0 * error(i, c) + error(i + stride, c));
        own.map(alternating)
            .fold(0.0f64, |most, a: f64| most.max(a.abs()))
    };
    let planes: Vec<f64> = (1..points.len() / stride - 1)
        .map(|plane| most_of(plane) / largest)
        .collect();
    println!("{level:?}: alternating part {planes:.4?} of {largest:.3e} Pa");
    planes.into_iter().fold(0.0, f64::max)
}

/// Wrong: stress would have waves of two elements between the balls. Bound chosen beforehand: 1 % of the stress
/// there, of every component, on a mesh of elements 1.5 times as long in the rolling direction as deep. That the
/// measure sees a pattern is shown by elements seven times as long, on which a wave falls by a quarter per element
/// only (`raceway-fem`, waves.rs).
#[test]
#[ignore = "rings of a million dofs by sectors: a minute; scripts/test-slow runs it"]
fn no_pattern_of_elements_is_between_balls() {
    let [regular, coarse, quadratic, elongated] = [
        Level::hex8(360, 12, 3, 4),
        Level::hex8(180, 12, 3, 4),
        Level::hex20(180, 12, 3, 4),
        Level::hex8(360, 36, 6, 12),
    ]
    .map(pattern);
    println!("largest: {regular:.4}, {coarse:.4}, {quadratic:.4}, {elongated:.4}");
    assert!(regular < 0.01, "{regular}");
    assert!(elongated > 0.03, "{elongated}");
}
