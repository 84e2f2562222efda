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

/// Wrong: far from contacts, where the finite elements are alone, stress would not converge, or carry a pattern of the elements. The same patch on
/// three meshes of hex8, against one of hex20; von Mises stress from 7 to 13 degrees beside the ball, 10 degrees being half-way to the next, on
/// the raceway and 1.5 mm below: the orders rise to that of a derivative of linear elements, 1, and second differences over a degree, half an
/// element of the finest mesh, are no larger than those of quadratic elements, as those of a pattern would be.
#[test]
#[ignore = "a ring of 60 000 dofs: ten seconds; scripts/test-slow runs it"]
fn stress_between_balls_converges_without_a_pattern() {
    let side = Side::Outer;
    let histories = [
        Level::hex8(60, 6, 1, 2),
        Level::hex8(120, 12, 2, 4),
        Level::hex8(180, 18, 3, 6),
        Level::hex20(90, 12, 2, 5),
    ]
    .map(|level| {
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
        let points = [0.0, 1.5e-3].into_iter().flat_map(|depth| {
            (0..25).map(move |i| RingPoint {
                azimuth: (7.0 + 0.25 * i as f64).to_radians(),
                angle: ANGLE,
                depth,
            })
        });
        let positions: Vec<[f64; 3]> = points.map(|p| p.position(&ring.groove)).collect();
        let recovery = PointRecovery::new(&ring.mesh, &ring.material, &positions).unwrap();
        recovery
            .stress(&u)
            .into_iter()
            .map(von_mises)
            .collect::<Vec<f64>>()
    });
    let gap = |a: &[f64], b: &[f64]| {
        (a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
    };
    let bend = |h: &[f64]| {
        let second = h
            .chunks(25)
            .flat_map(|h| h.windows(9).map(|w| w[0] - 2.0 * w[4] + w[8]));
        second.fold(0.0f64, |most, x| most.max(x.abs()))
    };
    let errors = [0, 1, 2].map(|i| gap(&histories[i], &histories[3]));
    let orders = [
        (errors[0] / errors[1]).log2(),
        (errors[1] / errors[2]).ln() / 1.5f64.ln(),
    ];
    let bends = histories.each_ref().map(|h| bend(h));
    let largest = histories[3].iter().copied().fold(0.0, f64::max);
    println!(
        "between balls: up to {largest:.3e} Pa; errors {errors:?} Pa, orders {orders:.2?}; bends {bends:?} Pa"
    );
    assert!(orders[0] > 0.6 && orders[1] > 0.85, "{orders:?}");
    assert!(bends[2] < 1.2 * bends[3], "{bends:?}");
}
