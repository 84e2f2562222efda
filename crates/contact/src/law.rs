//! The force of one contact from its geometric approach, with the patch's own compliance taken out.
//!
//! K is a two-body Hertz stiffness: Q = K d_e^1.5. The finite-element ring already yields locally by c_s Q
//! under the spread patch, so the geometric approach is g = d_e - c_s Q(d_e). The map d_e -> g increases as
//! long as the patch is not smaller than the Hertz ellipse of the load; beyond the point where its slope falls
//! to [`MIN_SLOPE`] it is continued as a straight line, which keeps the energy convex for any trial position. A
//! solution there is not valid: see [`ContactForce::beyond_limit`].
//!
//! Energy: V(g) = 2/5 K d_e^2.5 - c_s Q^2 / 2, dV/dg = Q.

/// Slope of g(d_e) below which the law is continued linearly.
pub const MIN_SLOPE: f64 = 0.1;

/// Hertz stiffness and patch compliance of one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// Two-body Hertz stiffness K, N/m^1.5.
    pub stiffness: f64,
    /// Half-space compliance of the patch c_s, m/N; 0 for a rigid ring.
    pub patch_compliance: f64,
}

/// State of one contact at a geometric approach g.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct ContactForce {
    /// Normal force Q, N.
    pub force: f64,
    /// dQ/dg, N/m.
    pub tangent: f64,
    /// Energy V, J.
    pub energy: f64,
    /// Hertz approach d_e, m; equal to g (negative: gap) when open.
    pub approach: f64,
    /// The linear continuation was used: the patch is smaller than the Hertz ellipse needs.
    pub beyond_limit: bool,
}

impl ContactLaw {
    /// Force, tangent and energy at the geometric approach `g`, m.
    pub fn evaluate(&self, g: f64) -> ContactForce {
        if g <= 0.0 {
            return ContactForce {
                approach: g,
                ..ContactForce::default()
            };
        }
        let kappa = self.patch_compliance * self.stiffness;
        let root_limit = if kappa > 0.0 {
            (1.0 - MIN_SLOPE) / (1.5 * kappa)
        } else {
            f64::INFINITY
        };
        if g.sqrt() < root_limit && g < geometric(root_limit, kappa) {
            let root = solve_root(g, kappa);
            return self.at_root(root, 1.0 - 1.5 * kappa * root);
        }
        let approach_limit = root_limit * root_limit;
        let approach = approach_limit + (g - geometric(root_limit, kappa)) / MIN_SLOPE;
        let limit = self.at_root(root_limit, MIN_SLOPE);
        let mut state = self.at_root(approach.sqrt(), MIN_SLOPE);
        let stored = 0.4 * self.stiffness * (approach.powf(2.5) - approach_limit.powf(2.5));
        state.energy = limit.energy + MIN_SLOPE * stored;
        state.beyond_limit = true;
        state
    }

    fn at_root(&self, root: f64, slope: f64) -> ContactForce {
        let approach = root * root;
        let force = self.stiffness * approach * root;
        ContactForce {
            force,
            tangent: 1.5 * self.stiffness * root / slope,
            energy: 0.4 * force * approach - 0.5 * self.patch_compliance * force * force,
            approach,
            beyond_limit: false,
        }
    }
}

/// g at d_e = root^2.
fn geometric(root: f64, kappa: f64) -> f64 {
    if root.is_finite() {
        root * root * (1.0 - kappa * root)
    } else {
        f64::INFINITY
    }
}

/// Root x = sqrt(d_e) of x^2 - kappa x^3 = g on the increasing branch.
fn solve_root(g: f64, kappa: f64) -> f64 {
    let mut x = g.sqrt();
    if kappa == 0.0 {
        return x;
    }
    // Newton from below on an increasing function; 60 rounds cover the slowest start near the limit slope.
    for _ in 0..60 {
        let step = (g - x * x * (1.0 - kappa * x)) / (x * (2.0 - 3.0 * kappa * x));
        let next = (x + step).clamp(0.5 * x, (1.0 - 0.5 * MIN_SLOPE) / (1.5 * kappa));
        if (next - x).abs() <= 2.0 * f64::EPSILON * x {
            return next;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: ContactLaw = ContactLaw {
        stiffness: 2.9e10,
        patch_compliance: 3e-9,
    };

    /// Wrong: without a patch the law would not be Hertz's.
    #[test]
    fn a_rigid_ring_follows_hertz() {
        let law = ContactLaw {
            stiffness: 2.9e10,
            patch_compliance: 0.0,
        };
        let at = law.evaluate(5e-6);
        assert!((at.force / (2.9e10 * 5e-6f64.powf(1.5)) - 1.0).abs() < 1e-14);
        assert!((at.tangent / (1.5 * at.force / 5e-6) - 1.0).abs() < 1e-14);
        assert!((at.energy / (0.4 * at.force * 5e-6) - 1.0).abs() < 1e-14);
        assert_eq!(law.evaluate(-1e-6).force, 0.0);
        assert_eq!(law.evaluate(-1e-6).approach, -1e-6);
    }

    /// Wrong: the residual d_e - c_s Q - g would not vanish.
    #[test]
    fn patch_compliance_is_taken_out() {
        for i in 1..200 {
            let g = 1e-7 * i as f64;
            let at = LAW.evaluate(g);
            if !at.beyond_limit {
                let residual = at.approach - LAW.patch_compliance * at.force - g;
                assert!(
                    residual.abs() < 4e-16 * at.approach / MIN_SLOPE,
                    "{g}: {residual}"
                );
            }
        }
    }

    /// Wrong: force and tangent would not be derivatives of energy and force, so Newton and the ledger would fail.
    #[test]
    fn force_and_tangent_are_derivatives_also_beyond_the_limit() {
        let mut beyond = 0;
        for i in 1..400 {
            let (g, h) = (2e-7 * i as f64, 1e-11);
            let (low, at, high) = (LAW.evaluate(g - h), LAW.evaluate(g), LAW.evaluate(g + h));
            beyond += usize::from(at.beyond_limit);
            let (force, tangent) = (
                (high.energy - low.energy) / (2.0 * h),
                (high.force - low.force) / (2.0 * h),
            );
            assert!((force / at.force - 1.0).abs() < 1e-4, "{g}: {force} {}", at.force);
            if low.beyond_limit == high.beyond_limit {
                assert!(
                    (tangent / at.tangent - 1.0).abs() < 1e-3,
                    "{g}: {tangent} {}",
                    at.tangent
                );
            }
        }
        assert!(beyond > 50, "the sweep must reach the continuation, {beyond}");
    }
}
