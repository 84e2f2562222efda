//! Contact forces that are means over a step.
//!
//! **Discrete gradient** (default): F = [V(d1) - V(d0)]/(d1 - d0) along (l1 + l0)/(|l1| + |l0|), l the vector from
//! groove centre to ball centre. Then F . (l1 - l0) = V(d1) - V(d0) exactly: contact exchanges energy and makes none,
//! at any step size (Gonzalez, J. Nonlinear Sci. 6 (1996) 449, doi:10.1007/BF02440162). **Pointwise** (for comparison
//! only): the weighted mean of the force values at both ends along the same direction, as plain generalised-alpha
//! takes it; it can gain energy without bound when balls unload.
//!
//! Damping (the paper's law): c(d) dd/dt with c rising from 0 at d = 0 to c0 at d = d0 by a cubic step; the sum is
//! never tensile.

use contact::ContactLaw;

/// Relative change of the approach below which the mean force is integrated instead of differenced: the difference
/// would lose digits, and three Gauss points are exact to round-off there.
const SMALL_CHANGE: f64 = 1e-2;
/// Gauss points and weights on 0..1.
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// How forces are evaluated over a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactScheme {
    /// Energy-conserving mean force, plus (1/2 - weight) times its change over the step: the force at the weighted
    /// time of an integrator that dissipates. V is convex, so this term only takes energy.
    DiscreteGradient,
    /// (1 - weight) times the force at the end plus `weight` times the force at the start.
    Pointwise,
}

/// The paper's contact damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactDamping {
    /// Largest coefficient c0, N s/m.
    pub coefficient: f64,
    /// Approach at which it is reached, m.
    pub full_approach: f64,
}

/// Mean force of one contact over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanForce {
    /// Force on the ring [radial, axial], N; the ball gets its negative.
    pub force: [f64; 2],
    /// Derivative with respect to l1, N/m.
    pub tangent: [[f64; 2]; 2],
    /// Energy lost to contact damping in this step, J.
    pub loss: f64,
    /// Energy lost by moving the force to the weighted time, J.
    pub numerical_loss: f64,
}

/// Elastic mean force along the normal and its derivative with respect to d1.
fn mean_normal(law: &ContactLaw, d0: f64, d1: f64) -> [f64; 2] {
    let change = d1 - d0;
    if change.abs() <= SMALL_CHANGE * d0.min(d1) || change == 0.0 {
        return GAUSS.iter().fold([0.0; 2], |sum, (s, weight)| {
            let at = law.evaluate(d0 + s * change);
            [sum[0] + weight * at.force, sum[1] + weight * s * at.tangent]
        });
    }
    let (start, end) = (law.evaluate(d0), law.evaluate(d1));
    let mean = (end.energy - start.energy) / change;
    [mean, (end.force - mean) / change]
}

/// Viscous force along the normal, N, and its derivative with respect to |l1|, N/m: c at the mean approach times the
/// mean rate of a step of `dt` seconds.
pub fn viscous(damping: &ContactDamping, dt: f64, touching: f64, [l0, l1]: [[f64; 2]; 2]) -> [f64; 2] {
    let approach = |l: [f64; 2]| l[0].hypot(l[1]) - touching;
    let (d0, d1) = (approach(l0), approach(l1));
    let [c, slope] = coefficient(damping, 0.5 * (d0 + d1));
    let rate = (d1 - d0) / dt;
    [c * rate, c / dt + 0.5 * slope * rate]
}

/// Damping coefficient at an approach and its derivative.
fn coefficient(damping: &ContactDamping, d: f64) -> [f64; 2] {
    let x = (d / damping.full_approach).clamp(0.0, 1.0);
    let slope = 6.0 * x * (1.0 - x) / damping.full_approach;
    [
        damping.coefficient * x * x * (3.0 - 2.0 * x),
        damping.coefficient * slope,
    ]
}

/// Mean force over a step between l0 and l1 (m); they touch at |l| = `touching`. `weight` is that of the start, the
/// integrator's alpha_f; `viscous` what [`viscous`] gives, if there is damping.
pub fn mean_force(
    law: &ContactLaw,
    touching: f64,
    [l0, l1]: [[f64; 2]; 2],
    (scheme, weight): (ContactScheme, f64),
    viscous: Option<[f64; 2]>,
) -> MeanForce {
    let size = |l: [f64; 2]| l[0].hypot(l[1]);
    let (s0, s1) = (size(l0), size(l1));
    let (d0, d1) = (s0 - touching, s1 - touching);
    let (sum, total) = ([l0[0] + l1[0], l0[1] + l1[1]], s0 + s1);
    let end = [l1[0] / s1, l1[1] / s1];
    let [mut normal, mut stiffness] = match scheme {
        ContactScheme::DiscreteGradient => mean_normal(law, d0, d1),
        ContactScheme::Pointwise => {
            let (start, end) = (law.evaluate(d0), law.evaluate(d1));
            [
                weight * start.force + (1.0 - weight) * end.force,
                (1.0 - weight) * end.tangent,
            ]
        }
    };
    let mut loss = 0.0;
    if let Some([force, slope]) = viscous {
        let elastic = normal;
        normal += force;
        stiffness += slope;
        if normal < 0.0 {
            (normal, stiffness) = (0.0, 0.0);
        }
        loss = (normal - elastic) * (d1 - d0);
    }
    let mean = [sum[0] / total, sum[1] / total];
    let mut result = MeanForce {
        force: [normal * mean[0], normal * mean[1]],
        tangent: [[0.0; 2]; 2],
        loss,
        numerical_loss: 0.0,
    };
    for i in 0..2 {
        for j in 0..2 {
            let identity = if i == j { 1.0 } else { 0.0 };
            result.tangent[i][j] =
                stiffness * mean[i] * end[j] + normal * (identity - mean[i] * end[j]) / total;
        }
    }
    if scheme == ContactScheme::DiscreteGradient && weight != 0.5 {
        add_change(law, touching, [l0, l1], 0.5 - weight, &mut result);
    }
    result
}

/// Takes away the part of a force that pulls along the direction of `along`, which grows with l1, and keeps the part
/// across it: so the force stays continuous.
fn drop_pull(along: [f64; 2], result: &mut MeanForce) {
    let length = along[0].hypot(along[1]);
    let e = along.map(|x| x / length);
    let pull = result.force[0] * e[0] + result.force[1] * e[1];
    if pull >= 0.0 {
        return;
    }
    let across = |i: usize, j: usize| (if i == j { 1.0 } else { 0.0 } - e[i] * e[j]) / length;
    // d(pull)/dl1, then F - pull e.
    let slope = [0, 1].map(|j| {
        (0..2)
            .map(|i| e[i] * result.tangent[i][j] + result.force[i] * across(i, j))
            .sum::<f64>()
    });
    for i in 0..2 {
        result.force[i] -= pull * e[i];
        for j in 0..2 {
            result.tangent[i][j] -= slope[j] * e[i] + pull * across(i, j);
        }
    }
}

/// Adds `share` times the change of the force over the step; the sum does not pull.
fn add_change(law: &ContactLaw, touching: f64, [l0, l1]: [[f64; 2]; 2], share: f64, result: &mut MeanForce) {
    let at = |l: [f64; 2]| {
        let length = l[0].hypot(l[1]);
        (length, law.evaluate(length - touching))
    };
    let ((s0, start), (s1, end)) = (at(l0), at(l1));
    let before = result.force;
    for i in 0..2 {
        result.force[i] += share * (end.force * l1[i] / s1 - start.force * l0[i] / s0);
        for j in 0..2 {
            let identity = if i == j { 1.0 } else { 0.0 };
            let along = l1[i] * l1[j] / (s1 * s1);
            result.tangent[i][j] += share * (end.tangent * along + end.force / s1 * (identity - along));
        }
    }
    let along = [l0[0] + l1[0], l0[1] + l1[1]];
    drop_pull(along, result);
    result.numerical_loss = (0..2)
        .map(|i| (result.force[i] - before[i]) * (l1[i] - l0[i]))
        .sum();
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: ContactLaw = ContactLaw {
        stiffness: 2.9e10,
        patch_compliance: 2e-9,
    };
    const TOUCHING: f64 = 0.15e-3;
    const CONSERVING: (ContactScheme, f64) = (ContactScheme::DiscreteGradient, 0.5);

    fn cases() -> Vec<[[f64; 2]; 2]> {
        let mut cases = Vec::new();
        for d0 in [-3e-6, 0.0, 1e-7, 5e-6] {
            for change in [1e-13, 1e-9, 3e-8, 1e-6, -4e-6] {
                let point = |d: f64, angle: f64| [(TOUCHING + d) * angle.cos(), (TOUCHING + d) * angle.sin()];
                cases.push([point(d0, 0.3), point(d0 + change, 0.31)]);
            }
        }
        cases
    }

    /// Wrong: contact would make or lose energy. F . (l1 - l0) = V1 - V0, to the round-off of the energies.
    #[test]
    fn the_discrete_gradient_exchanges_exactly_the_stored_energy() {
        for [l0, l1] in cases() {
            let f = mean_force(&LAW, TOUCHING, [l0, l1], CONSERVING, None).force;
            let work = f[0] * (l1[0] - l0[0]) + f[1] * (l1[1] - l0[1]);
            let energy = |l: [f64; 2]| LAW.evaluate(l[0].hypot(l[1]) - TOUCHING).energy;
            let scale = energy(l0).abs().max(energy(l1).abs()).max(1e-12);
            assert!(
                (work - energy(l1) + energy(l0)).abs() < 1e-9 * scale,
                "{l0:?} {l1:?}"
            );
        }
    }

    /// Wrong: a dissipating integrator would gain energy in the contacts, or pull on a ball.
    #[test]
    fn the_weighted_discrete_gradient_only_takes_energy() {
        for [l0, l1] in cases() {
            for weight in [0.0, 0.3] {
                let scheme = (ContactScheme::DiscreteGradient, weight);
                let f = mean_force(&LAW, TOUCHING, [l0, l1], scheme, None);
                assert!(f.numerical_loss >= 0.0, "{l0:?} {l1:?}: {}", f.numerical_loss);
                let pull = f.force[0] * (l0[0] + l1[0]) + f.force[1] * (l0[1] + l1[1]);
                let size = f.force[0].hypot(f.force[1]) * (l0[0].hypot(l0[1]));
                assert!(pull >= -1e-12 * size, "{pull}");
            }
        }
    }

    /// Wrong: Newton would use a wrong tangent. Difference quotients, all schemes.
    #[test]
    fn tangents_are_derivatives() {
        let damping = ContactDamping {
            coefficient: 50.0,
            full_approach: 1e-6,
        };
        for scheme in [
            CONSERVING,
            (ContactScheme::DiscreteGradient, 0.3),
            (ContactScheme::Pointwise, 0.4),
        ] {
            for damped in [None, Some(&damping)] {
                for [l0, l1] in cases() {
                    let at = |l| {
                        mean_force(
                            &LAW,
                            TOUCHING,
                            [l0, l],
                            scheme,
                            damped.map(|d| viscous(d, 1e-5, TOUCHING, [l0, l])),
                        )
                    };
                    let h = 1e-11;
                    for j in 0..2 {
                        let (mut low, mut high) = (l1, l1);
                        low[j] -= h;
                        high[j] += h;
                        for i in 0..2 {
                            let numeric = (at(high).force[i] - at(low).force[i]) / (2.0 * h);
                            let exact = at(l1).tangent[i][j];
                            // Cases nearer to a kink of the law than h show half the damping.
                            let kink = if damped.is_some() { 3e6 } else { 3e4 };
                            assert!(
                                (numeric - exact).abs() < 2e-2 * exact.abs() + kink,
                                "{scheme:?} {l0:?} {l1:?}: {numeric} {exact}"
                            );
                        }
                    }
                }
            }
        }
    }

    /// Wrong: damping would feed energy or pull on a ball.
    #[test]
    fn damping_only_takes_energy_and_never_pulls() {
        let damping = ContactDamping {
            coefficient: 5e4,
            full_approach: 1e-6,
        };
        for [l0, l1] in cases() {
            let damped = viscous(&damping, 1e-6, TOUCHING, [l0, l1]);
            let f = mean_force(&LAW, TOUCHING, [l0, l1], CONSERVING, Some(damped));
            assert!(f.loss >= 0.0, "{}", f.loss);
            assert!(f.force[0] * (l0[0] + l1[0]) + f.force[1] * (l0[1] + l1[1]) >= 0.0);
        }
    }
}
