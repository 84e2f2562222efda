//! Contact damping by the paper's law: c(d) dd/dt along the normal, with c rising from 0 at d = 0 to c0 at d = d0 by a
//! cubic step.
//!
//! The approach d of a ball on its way round changes where the ring is displaced, too: where the shaft stands off the
//! axis, a ball that passes is pressed and let go once in its turn. So dd/dt has a part by displacements, which the
//! lengths of a step show, and one by passing. Its work comes from what moves the balls round.

/// The paper's contact damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactDamping {
    /// Largest coefficient c0, N s/m.
    pub coefficient: f64,
    /// Approach at which it is reached, m.
    pub full_approach: f64,
}

/// Damping over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepDamping<'d> {
    /// The law.
    pub law: &'d ContactDamping,
    /// Size of the step, s.
    pub dt: f64,
    /// By how much the contact closes in the step because its ball passes along a displaced ring, m.
    pub passing: f64,
}

/// What damping does to a contact over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Viscous {
    /// Force along the normal, N.
    pub force: f64,
    /// Its derivative with respect to |l1|, N/m.
    pub slope: f64,
    /// Closing by passing, m.
    pub passing: f64,
}

impl StepDamping<'_> {
    /// c at the mean approach times the mean rate, of lengths at start and end.
    pub fn viscous(&self, touching: f64, [l0, l1]: [[f64; 2]; 2]) -> Viscous {
        let approach = |l: [f64; 2]| l[0].hypot(l[1]) - touching;
        let (d0, d1) = (approach(l0), approach(l1));
        let [c, slope] = coefficient(self.law, 0.5 * (d0 + d1));
        let rate = (d1 - d0 + self.passing) / self.dt;
        Viscous {
            force: c * rate,
            slope: c / self.dt + 0.5 * slope * rate,
            passing: self.passing,
        }
    }
}

/// Damping coefficient at an approach, m, in N s/m, and its derivative.
pub fn coefficient(damping: &ContactDamping, d: f64) -> [f64; 2] {
    let x = (d / damping.full_approach).clamp(0.0, 1.0);
    let slope = 6.0 * x * (1.0 - x) / damping.full_approach;
    [
        damping.coefficient * x * x * (3.0 - 2.0 * x),
        damping.coefficient * slope,
    ]
}
