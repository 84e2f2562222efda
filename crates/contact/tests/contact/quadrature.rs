//! An independent way to the stress under a semi-ellipsoidal pressure: the sum of point loads.

use std::f64::consts::PI;

/// Stress xx yy zz xy yz xz over p0 under the pressure with semi-axes [a, b], at [x, y, depth] well below the surface.
///
/// Point load: Johnson (1985), eq. 3.19, where tau_xy lacks a factor 2 on its first term (it would not turn as a
/// tensor). With u = sqrt(1 - rho^2) over the unit disc the load is 3 u^2 du times a mean over the angle;
/// Gauss-Legendre in u, equal angles: both converge exponentially below the surface.
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

/// Stress xx yy zz xy over p0 on the surface inside the ellipse or at an end of an axis, by the same sum. A load at
/// the distance r pulls with (1 - 2 nu)/(2 pi r^2) along r and pushes as much across. What is left of the loads near
/// the point itself, their pressure p there, is the mean of `point_load` over all distances, -(1 + 2 nu)/2 p in both
/// directions. Polar coordinates about the point; r = R sin^2 phi takes the roots of the pressure out; Gauss-Legendre
/// in both, quadrant by quadrant, because at an end of an axis only half of the angles count.
pub fn surface_stress([a, b]: [f64; 2], nu: f64, [x, y]: [f64; 2]) -> [f64; 4] {
    let inside = (1.0 - x * x / (a * a) - y * y / (b * b)).max(0.0);
    let pressure = inside.sqrt();
    let (rule, mut sums) = (gauss_legendre(120), [0.0; 2]);
    for quadrant in 0..4 {
        for &(node, weight) in &rule {
            let angle = 0.25 * PI * (2.0 * quadrant as f64 + 1.0 + node);
            let (sin, cos) = angle.sin_cos();
            // Along the ray the squared pressure is inside - 2 m r - k r^2 = k (R - r)(r + back).
            let k = cos * cos / (a * a) + sin * sin / (b * b);
            let m = x * cos / (a * a) + y * sin / (b * b);
            let root = (m * m + k * inside).sqrt();
            let (end, back) = ((root - m) / k, (root + m) / k);
            if end <= 1e-12 * a {
                continue;
            }
            let mut ray = if pressure > 0.0 { pressure * end.ln() } else { 0.0 };
            for &(node, weight) in &rule {
                let (sin, cos) = (0.25 * PI * (1.0 + node)).sin_cos();
                let r = end * sin * sin;
                let here = (k * (end - r) * (r + back)).max(0.0).sqrt();
                ray += 0.25 * PI * weight * (here - pressure) * 2.0 * cos / sin;
            }
            sums[0] += 0.25 * PI * weight * (2.0 * angle).cos() * ray;
            sums[1] += 0.25 * PI * weight * (2.0 * angle).sin() * ray;
        }
    }
    let [difference, shear] = sums.map(|s| (1.0 - 2.0 * nu) / (2.0 * PI) * s);
    let mean = -0.5 * (1.0 + 2.0 * nu) * pressure;
    [mean + difference, mean - difference, -pressure, shear]
}

/// Stress xx yy zz xy yz xz over the load of a point load at the origin, times the unit of length squared.
pub fn point_load([x, y, z]: [f64; 3], nu: f64) -> [f64; 6] {
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
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
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
