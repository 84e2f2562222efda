//! Convergence in the orders of the seat under a smooth load.

use super::*;

/// Length over which the load falls off round the bearing, 1/rad^2.
const SHARPNESS: f64 = 3.0;

/// A radial pressure on the raceway, exp(k cos theta): its order n has the modified Bessel function I_n(k), which
/// falls faster than any power of n.
fn smooth_load(ring: &RingModel) -> Vec<f64> {
    let mut load = vec![0.0; ring.mesh.n_dofs()];
    for (node, w) in fem::facet_node_weights(&ring.mesh, ring.mesh.group("raceway")) {
        let [x, y, _] = ring.mesh.nodes[node];
        let r = x.hypot(y);
        let push = 1e6 * w * (SHARPNESS * x / r).exp();
        load[3 * node] += push * x / r;
        load[3 * node + 1] += push * y / r;
    }
    load
}

/// I_n(k) by its series.
fn bessel(n: usize) -> f64 {
    let half = 0.5 * SHARPNESS;
    let first = (1..=n).fold(1.0, |term, i| term * half / i as f64);
    let terms = (1..40).scan(first, |term, k| {
        *term *= half * half / (k * (k + n)) as f64;
        Some(*term)
    });
    first + terms.sum::<f64>()
}

/// Wrong: the orders of a seat would not be those of the motion: part of an order would be lost, or go into another.
/// The ring sits in a tube held all round, so each order of the load moves its own; what N orders leave is that of
/// order N + 1. Its fall steepens with every order: faster than any power.
#[test]
fn under_a_smooth_load_orders_converge_faster_than_any_power() {
    let clamped = outer(Hold::Clamped);
    let (own, _) = wrapped(&clamped, 3, 1.45, |_| true);
    let load = smooth_load(&clamped);
    let moved = |n: usize| solver(&on_body(own.clone(), harmonics(n, 2))).solve(load.clone(), 1);
    let expected = moved(14);
    let orders = [1, 2, 3, 4, 5, 6, 7, 8];
    let errors = orders.map(|n| difference(&moved(n), &expected));
    let slopes: Vec<f64> = (1..orders.len())
        .map(|i| (errors[i - 1] / errors[i]).ln() / (orders[i] as f64 / orders[i - 1] as f64).ln())
        .collect();
    let left: Vec<f64> = orders
        .iter()
        .zip(errors)
        .map(|(n, e)| e / bessel(n + 1))
        .collect();
    println!("errors {errors:?}; orders of convergence {slopes:.1?}; over what the load has left {left:?}");
    assert!(slopes.windows(2).all(|s| s[1] > s[0]), "{slopes:?}");
    assert!(slopes[6] > 10.0 && errors[7] < 1e-4, "{slopes:?} {errors:?}");
    // Ring and tube yield the less the higher the order, so the errors fall faster than the load.
    assert!(left.windows(2).all(|l| l[1] < 1.2 * l[0]), "{left:?}");
}
