//! Stress between balls, where the finite elements are alone.

use contact::patch::PatchShape;
use contact::quadrature::PressureRule;
use contact::{Patch, RacewaySurface, RingPoint, Side};
use dynamics::Hold;
use dynamics::model::elastic;
use dynamics::ring::RingSolver;
use fem::stress::{PointRecovery, von_mises};

use crate::support::rings::{Level, ring};
use crate::{ANGLE, FORCE, model};

/// Points along each line of the comparison.
const N_LINE: usize = 25;
/// Von Mises stress, Pa, under one patch at azimuth 0, the same on every mesh.
struct Between {
    /// From 7 to 13 degrees beside the ball, 10 degrees being half-way to the next: on the raceway, and 1.5 mm below it.
    lines: Vec<f64>,
}

fn solved(level: Level) -> Between {
    let side = Side::Outer;
    let model = model(side, ring(side, level, Hold::Clamped));
    let ring = model.ring(side).unwrap();
    let surface = RacewaySurface::new(&ring.mesh, ring.mesh.group("raceway"), ring.groove);
    let shape = PatchShape {
        azimuth: 0.0,
        angle: ANGLE,
        semi_axes: [2.5e-3, 3.5e-3],
        truncated: false,
    };
    let steel = elastic(&ring.material);
    let patch = Patch::new(&surface, &ring.mesh.nodes, &PressureRule::new(), shape, steel).unwrap();
    let mut load = vec![0.0; ring.mesh.n_dofs()];
    let direction = ring.groove.direction(ANGLE);
    patch.weights.add_load(direction.map(|n| FORCE * n), &mut load);
    let u = RingSolver::new(&model, side, ring).unwrap().solve(load, 1);
    let stress = |azimuth: Vec<f64>, depth: f64| {
        let point = |azimuth: f64| RingPoint {
            azimuth,
            angle: ANGLE,
            depth,
        };
        let positions: Vec<[f64; 3]> = azimuth.iter().map(|&a| point(a).position(&ring.groove)).collect();
        let recovery = PointRecovery::new(&ring.mesh, &ring.material, &positions).unwrap();
        recovery
            .stress(&u)
            .into_iter()
            .map(von_mises)
            .collect::<Vec<f64>>()
    };
    let line = |depth: f64| {
        let azimuth = (0..N_LINE).map(|i| (7.0 + 0.25 * i as f64).to_radians());
        stress(azimuth.collect(), depth)
    };
    Between {
        lines: [line(0.0), line(1.5e-3)].concat(),
    }
}

/// Largest second difference over a degree, half an element of a mesh of 180 sectors, Pa.
fn bend(between: &Between) -> f64 {
    let lines = between.lines.chunks(N_LINE);
    let second = lines.flat_map(|line| line.windows(9).map(|w| w[0] - 2.0 * w[4] + w[8]));
    second.fold(0.0f64, |most, x| most.max(x.abs()))
}

fn gap(a: &Between, b: &Between) -> f64 {
    let squares = a.lines.iter().zip(&b.lines).map(|(x, y)| (x - y).powi(2));
    (squares.sum::<f64>() / a.lines.len() as f64).sqrt()
}

/// Wrong: far from contacts, where the finite elements are alone, stress would not converge as that of its elements does, or carry their
/// pattern. Bounds chosen beforehand: nodal stress of hex8, a derivative of linear functions, of first order at least, that of hex20 of
/// second; and second differences of hex8 no larger than 1.2 times those of
/// hex20, on meshes that the quadrature of the patch, made for two elements, still loads evenly.
#[test]
#[ignore = "rings of 400 000 dofs: half a minute; scripts/test-slow runs it"]
fn stress_between_balls_converges_without_a_pattern() {
    let quadratic = [
        Level::hex20(45, 6, 1, 2),
        Level::hex20(90, 12, 2, 4),
        Level::hex20(180, 24, 4, 8),
    ]
    .map(solved);
    let linear = [
        Level::hex8(60, 6, 1, 2),
        Level::hex8(120, 12, 2, 4),
        Level::hex8(240, 24, 4, 8),
        Level::hex8(360, 36, 6, 12),
    ]
    .map(solved);
    let right = &quadratic[2];
    let largest = right.lines.iter().copied().fold(0.0, f64::max);
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
    let [of_linear, of_quadratic] = [bend(&solved(Level::hex8(180, 18, 3, 6))), bend(&quadratic[1])];
    println!("second differences over a degree: hex8 {of_linear:.3} Pa, hex20 {of_quadratic:.3} Pa");
    assert!(orders[2] > 1.0 && orders[1] > 0.9, "hex8: {orders:?}");
    assert!(order > 2.0, "hex20: {order}");
    assert!(of_linear < 1.2 * of_quadratic, "{of_linear} {of_quadratic}");
}
