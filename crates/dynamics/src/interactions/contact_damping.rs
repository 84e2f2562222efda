//! Contact damping by the paper's law: c(d) dd/dt along the normal, with c rising from 0 at d = 0 to c0 at d = d0 by a
//! cubic step.

/// The paper's contact damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactDamping {
    /// Largest coefficient c0, N s/m.
    pub coefficient: f64,
    /// Approach at which it is reached, m.
    pub full_approach: f64,
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
pub(super) fn coefficient(damping: &ContactDamping, d: f64) -> [f64; 2] {
    let x = (d / damping.full_approach).clamp(0.0, 1.0);
    let slope = 6.0 * x * (1.0 - x) / damping.full_approach;
    [
        damping.coefficient * x * x * (3.0 - 2.0 * x),
        damping.coefficient * slope,
    ]
}
