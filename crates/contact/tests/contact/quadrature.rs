//! An independent way to the stress under a semi-ellipsoidal pressure: the sum of point loads.

use std::f64::consts::PI;

/// Stress xx yy zz xy yz xz over p0 under the pressure with semi-axes [a, b], at [x, y, depth] well below the surface.
///
/// Point load: Johnson (1985), eq. 3.19, where tau_xy lacks a factor 2 on its first term (it would not turn as a tensor). With u = sqrt(1 - rho^2) over the unit disc the load is 3 u^2 du times a mean over
/// the angle; Gauss-Legendre in u, equal angles: both converge exponentially below the surface.
pub fn stress([a, b]: [f64; 2], nu: f64, x: [f64; 3], [n_radial, n_angular]: [usize; 2]) -> [f64; 6] {
    let mut sum = [0.0; 6];
    for (node, weight) in gauss_legendre(n_radial) {
        let u = 0.5 * (1.0 + node);
        let radius = (1.0 - u * u).sqrt();
        for j in 0..n_angular {
            let angle = 2.0 * PI * (j as f64 + 0.3) / n_angular as f64;
            let load = 1.5 * weight * u * u / n_angular as f64;
            let from = [a * radius * angle.cos(), b * radius * angle.sin()];
            let point = point_load([x[0] - from[0], x[1] - from[1], x[2]], nu);
            for c in 0..6 {
                sum[c] += load * point[c];
            }
        }
    }
    // The whole load of p0 = 1 is 2/3 pi a b.
    sum.map(|s| 2.0 / 3.0 * PI * a * b * s)
}

fn point_load([x, y, z]: [f64; 3], nu: f64) -> [f64; 6] {
    let (r2, p) = (x * x + y * y, 1.0 - 2.0 * nu);
    let rho = (r2 + z * z).sqrt();
    let (r3, r5) = (rho.powi(3), rho.powi(5));
    let cap = 1.0 / (rho * (rho + z));
    let across = |x: f64, y: f64| p / r2 * (cap * (x * x - y * y) + z * y * y / r3) - 3.0 * z * x * x / r5;
    [
        across(x, y),
        across(y, x),
        -3.0 * z.powi(3) / r5,
        p / r2 * (2.0 * cap * x * y - x * y * z / r3) - 3.0 * x * y * z / r5,
        -3.0 * y * z * z / r5,
        -3.0 * x * z * z / r5,
    ]
    .map(|s| s / (2.0 * PI))
}

/// Points and weights on -1..1.
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let rule = |i: usize| {
        let mut x = -(PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..10 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=n {
                let k = k as f64;
                (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
            }
            slope = n as f64 * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(rule).collect()
}
