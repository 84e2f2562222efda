//! Integration rules over a semi-ellipsoidal pressure on the unit disc.
//!
//! With u = sqrt(1 - rho^2) the pressure integral is 3 u^2 du over 0..1 times a mean over the angle: Gauss-Legendre
//! in u, equal angles. Weights sum to 1; with N points in u every polynomial of degree below 2 N in u is exact.
//!
//! A patch is integrated over the facets of a mesh, which the points must outnumber: where facets see the single
//! points, the ring is loaded in a pattern of its own, which nodal stress shows beside the patch. So every doubling
//! of a patch, counted in node spacings, doubles the points along each direction; in between two rules are blended,
//! so that weights are continuous as a patch grows.

/// Gauss points in u of the coarsest rule.
const N_RADIAL: usize = 8;
/// Equal angles of the coarsest rule; a multiple of 4 keeps both axes of symmetry.
const N_ANGULAR: usize = 32;
/// Rules, each with twice the points of the one before along each direction.
const N_RULES: usize = 4;
/// Node spacings in a semi-axis up to which the coarsest rule is used alone (nine points a facet), and from which the
/// next one is.
const BLEND: [f64; 2] = [3.0, 4.0];

/// Points `[along, across]` in the unit disc with pressure-weighted weights.
pub struct PressureRule {
    rules: Vec<Vec<WeightedPoint>>,
}

/// A point in the unit disc and its share of the force.
type WeightedPoint = ([f64; 2], f64);

impl PressureRule {
    /// The rules for all patches: 8 x 32 to 64 x 256 points.
    pub fn new() -> PressureRule {
        PressureRule {
            rules: (0..N_RULES)
                .map(|k| rule(N_RADIAL << k, N_ANGULAR << k))
                .collect(),
        }
    }

    /// Points and weights, which sum to 1, for a patch whose larger semi-axis has this many node spacings.
    pub fn points(&self, spacings: f64) -> impl Iterator<Item = WeightedPoint> + '_ {
        let (mut coarse, mut size) = (0, spacings);
        while size >= BLEND[1] && coarse + 1 < N_RULES {
            coarse += 1;
            size *= 0.5;
        }
        let fine = (coarse + 1).min(N_RULES - 1);
        let share = ((size - BLEND[0]) / (BLEND[1] - BLEND[0])).clamp(0.0, 1.0);
        let shares = [(coarse, 1.0 - share), (fine, share)];
        shares
            .into_iter()
            .filter(|(_, share)| *share > 0.0)
            .flat_map(|(k, share)| self.rules[k].iter().map(move |&(x, w)| (x, share * w)))
    }
}

impl Default for PressureRule {
    fn default() -> Self {
        Self::new()
    }
}

/// One rule.
fn rule(n_radial: usize, n_angular: usize) -> Vec<WeightedPoint> {
    let mut points = Vec::with_capacity(n_radial * n_angular);
    for (x, w) in gauss_legendre(n_radial) {
        let u = 0.5 * (x + 1.0);
        let radius = (1.0 - u * u).sqrt();
        for j in 0..n_angular {
            let angle = 2.0 * std::f64::consts::PI * (j as f64 + 0.5) / n_angular as f64;
            let weight = 1.5 * w * u * u / n_angular as f64;
            points.push(([radius * angle.cos(), radius * angle.sin()], weight));
        }
    }
    let total: f64 = points.iter().map(|p| p.1).sum();
    points.iter_mut().for_each(|p| p.1 /= total);
    points
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
        for spacings in [2.0, 3.5, 7.0, 12.0, 100.0] {
            let moment = |p: i32, q: i32| -> f64 {
                rule.points(spacings)
                    .map(|(x, w)| w * x[0].powi(p) * x[1].powi(q))
                    .sum()
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
                let error = moment(p, q) - exact;
                // Rounding of up to 16 384 terms.
                assert!(error.abs() < 1e-13, "{spacings}, {p} {q}: {error:e}");
            }
        }
    }

    /// Wrong: patches of ordinary meshes would cost more, large ones would be loaded point by point, or the weights
    /// of a patch that grows through the change of rules would jump.
    #[test]
    fn larger_patches_have_more_points_without_a_jump() {
        let rule = PressureRule::new();
        let n = |spacings: f64| rule.points(spacings).count();
        assert_eq!([2.0, 3.0, 5.0, 12.0, 50.0].map(n), [256, 256, 1024, 4096, 16384]);
        // The share of the force in a square that no symmetry favours.
        let share = |spacings: f64| -> f64 {
            let own = rule.points(spacings).filter(|(x, _)| x[0] > 0.1 && x[1] > 0.3);
            own.map(|(_, w)| w).sum()
        };
        for at in [3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0] {
            let step = share(at + 1e-9) - share(at - 1e-9);
            assert!(step.abs() < 1e-8, "{at}: {step:e}");
        }
        assert!(
            (share(2.0) - share(40.0)).abs() > 1e-4,
            "the square is to see the rule"
        );
    }
}
