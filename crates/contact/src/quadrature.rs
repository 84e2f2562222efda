//! Integration rule over a semi-ellipsoidal pressure on the unit disc.
//!
//! With u = sqrt(1 - rho^2) the pressure integral is 3 u^2 du over 0..1 times a mean over the angle: Gauss-Legendre
//! in u, equal angles. Weights sum to 1; every polynomial of degree below 2 `N_RADIAL` in u is exact.

/// Gauss points in u.
const N_RADIAL: usize = 8;
/// Equal angles; a multiple of 4 keeps both axes of symmetry.
const N_ANGULAR: usize = 32;

/// Points `[along, across]` in the unit disc with pressure-weighted weights.
pub struct PressureRule {
    /// Points, `[n][2]`.
    pub points: Vec<[f64; 2]>,
    /// Weights, `[n]`, sum 1.
    pub weights: Vec<f64>,
}

impl PressureRule {
    /// The rule used for every patch: 8 x 32 points.
    pub fn new() -> PressureRule {
        let (mut points, mut weights) = (Vec::new(), Vec::new());
        for (x, w) in gauss_legendre(N_RADIAL) {
            let u = 0.5 * (x + 1.0);
            let radius = (1.0 - u * u).sqrt();
            for j in 0..N_ANGULAR {
                let angle = 2.0 * std::f64::consts::PI * (j as f64 + 0.5) / N_ANGULAR as f64;
                points.push([radius * angle.cos(), radius * angle.sin()]);
                weights.push(1.5 * w * u * u / N_ANGULAR as f64);
            }
        }
        let total: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|w| *w /= total);
        PressureRule { points, weights }
    }
}

impl Default for PressureRule {
    fn default() -> Self {
        Self::new()
    }
}

/// Gauss-Legendre points and weights on -1..1, by Newton on the Legendre polynomial.
pub(crate) fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut slope = 1.0;
            // Quadratic convergence from Tricomi's start: 8 rounds reach round-off for every n in use.
            for _ in 0..8 {
                let (value, derivative) = legendre(n, x);
                slope = derivative;
                x -= value / derivative;
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// Legendre polynomial of degree n and its derivative.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut current) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (previous, current) = (
            current,
            ((2.0 * k - 1.0) * x * current - (k - 1.0) * previous) / k,
        );
    }
    (current, n as f64 * (x * current - previous) / (x * x - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: patches would not carry the unit force or would shift its centre.
    /// Moments of a semi-ellipsoid: <x> = 0, <x^2> = 1/5 (Johnson 1985, 3.4).
    #[test]
    fn moments_of_the_pressure_are_exact() {
        let rule = PressureRule::new();
        let moment = |p: i32, q: i32| -> f64 {
            let terms = rule.points.iter().zip(&rule.weights);
            terms.map(|(x, w)| w * x[0].powi(p) * x[1].powi(q)).sum()
        };
        for (p, q, exact) in [
            (0, 0, 1.0),
            (1, 0, 0.0),
            (0, 1, 0.0),
            (1, 1, 0.0),
            (2, 0, 0.2),
            (0, 2, 0.2),
            (4, 0, 3.0 / 35.0),
        ] {
            assert!((moment(p, q) - exact).abs() < 1e-14, "{p} {q}: {}", moment(p, q));
        }
    }
}
