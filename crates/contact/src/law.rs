//! Forces of contacts from their geometric approaches, with what bodies yield besides Hertz's half-spaces.
//!
//! K is a two-body Hertz stiffness: Q = K d_e^1.5. The finite-element ring already yields locally by c_s Q
//! under the spread patch, and the ball, a sphere, yields by c_b Q less than a half-space, so the geometric approach is
//! g = d_e - (c_s + c_b) Q(d_e). The map d_e -> g increases as
//! long as the patch is not smaller than the Hertz ellipse of the load; beyond the point where its slope falls
//! to [`MIN_SLOPE`] it is continued as a straight line, which keeps the energy convex for any trial position. A
//! solution there is not valid: see [`ContactForce::beyond_limit`].
//!
//! Energy: V(g) = 2/5 K d_e^2.5 - (c_s + c_b) Q^2 / 2, dV/dg = Q.
//!
//! **Both contacts of a ball.** Each yields by x times the force of the other ([`crate::sphere`]): g_i = h_i(Q_i) +
//! x Q_o, g_o = h_o(Q_o) + x Q_i. The forces are those of the law at g_i - x Q_o and g_o - x Q_i, found by Newton's
//! iteration on the roots of both Hertz approaches. Where that leaves the range of the law or finds a contact open,
//! they are found in turns, which contract by x^2 dQ_i/dg dQ_o/dg, 3e-4 under 330 N. They are the gradient of
//! V_i + V_o + x Q_i Q_o, with the derivative -Q_i Q_o over x, convex where that product is below 1: the Hessian of the
//! complementary energy, ((dh_i, x), (x, dh_o)), is positive definite then. Far beyond any load a law is continued as a
//! straight line, so that the product is at most 1/4.

use crate::geometry::BySide;

/// Slope of g(d_e) below which the law is continued linearly.
pub const MIN_SLOPE: f64 = 0.1;

/// Hertz stiffness and patch compliance of one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// Two-body Hertz stiffness K, N/m^1.5.
    pub stiffness: f64,
    /// Half-space compliance of the patch c_s, m/N; 0 for a rigid ring.
    pub patch_compliance: f64,
    /// By how much less than a half-space the ball yields c_b, m/N; 0: it is one; negative: it is hollow and softer.
    pub ball_compliance: f64,
}

/// The laws of both contacts of a ball, inner first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallLaws {
    /// Each on its own.
    pub laws: [ContactLaw; 2],
    /// By how much a contact yields under the force of the other one x, m/N.
    pub across: f64,
    /// Tangent of a contact from which its law is continued as a straight line, N/m: [`STIFFEST`] over the largest x
    /// of the ball, so that the energy stays convex for any trial position and its derivative over x is -Q_i Q_o.
    pub stiffest: f64,
}

/// Both contacts of a ball.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct BallForces {
    /// Each contact; of the energy x Q_i Q_o either has half. Tangents are those of its own law.
    pub contacts: [ContactForce; 2],
    /// dQ/dg, N/m, by rows of forces.
    pub tangent: BySide<BySide<f64>>,
}

/// Turns after which both forces of a ball stay as they are.
const MOST_TURNS: usize = 60;

/// Newton steps for the roots of both approaches before they are found in turns.
const MOST_ROOTS: usize = 12;

/// Last of these steps over a root: its square is below round-off.
const ROOT_STEP: f64 = 1e-9;

/// Largest tangent of a contact times what it yields under the force of the other.
pub const STIFFEST: f64 = 0.5;

impl BallForces {
    /// Contacts that know nothing of each other.
    fn apart(contacts: [ContactForce; 2]) -> BallForces {
        let [inner, outer] = contacts.map(|contact| contact.tangent);
        BallForces {
            contacts,
            tangent: [[inner, 0.0], [0.0, outer]],
        }
    }

    /// Growth of the forces with x, N^2/m: a larger x is a smaller approach.
    pub fn over_across(&self) -> BySide<f64> {
        let [inner, outer] = self.contacts.map(|contact| contact.force);
        self.tangent.map(|row| -(row[0] * outer + row[1] * inner))
    }
}

impl BallLaws {
    /// Forces, tangent and energies at the geometric approaches `g`, m.
    pub fn evaluate(&self, g: BySide<f64>) -> BallForces {
        let x = self.across;
        if x == 0.0 {
            return BallForces::apart([0, 1].map(|k| self.laws[k].evaluate(g[k])));
        }
        if let Some(contacts) = self.pressed(g) {
            return self.coupled(contacts);
        }
        let law = |k: usize, g: f64| self.laws[k].capped(g, self.stiffest);
        let mut contacts = [law(0, g[0]), law(1, g[1])];
        // One that is pushed out may touch before it is near: where x is negative.
        if x > 0.0 && contacts.iter().any(|contact| contact.force == 0.0) {
            return BallForces::apart(contacts);
        }
        for _ in 0..MOST_TURNS {
            let before = contacts.map(|contact| contact.force);
            contacts[0] = law(0, g[0] - x * before[1]);
            contacts[1] = law(1, g[1] - x * contacts[0].force);
            let still = |i: usize| (contacts[i].force - before[i]).abs() <= 2.0 * f64::EPSILON * before[i];
            if still(0) && still(1) {
                break;
            }
        }
        self.coupled(contacts)
    }

    /// Both contacts where both press and neither law is continued; None elsewhere.
    fn pressed(&self, g: BySide<f64>) -> Option<[ContactForce; 2]> {
        if g[0] <= 0.0 || g[1] <= 0.0 {
            return None;
        }
        let kappa = self.laws.map(|law| law.compliance() * law.stiffness);
        let yields = self.laws.map(|law| self.across * law.stiffness);
        let mut roots = [0, 1].map(|k| g[k].sqrt() * (1.0 + 0.5 * kappa[k] * g[k].sqrt()));
        for _ in 0..MOST_ROOTS {
            let squares = roots.map(|x| x * x);
            let lacks = |k: usize| {
                let other = yields[1 - k] * squares[1 - k] * roots[1 - k];
                squares[k] * (1.0 - kappa[k] * roots[k]) + other - g[k]
            };
            let own = |k: usize| 2.0 * roots[k] - 3.0 * kappa[k] * squares[k];
            let [lacks, own] = [[lacks(0), lacks(1)], [own(0), own(1)]];
            let across = [0, 1].map(|k| 3.0 * yields[1 - k] * squares[1 - k]);
            let scale = 1.0 / (own[0] * own[1] - across[0] * across[1]);
            let steps = [0, 1].map(|k| scale * (own[1 - k] * lacks[k] - across[k] * lacks[1 - k]));
            (0..2).for_each(|k| roots[k] -= steps[k]);
            if !(0..2).all(|k| roots[k] > 0.0 && 1.0 - 1.5 * kappa[k] * roots[k] > MIN_SLOPE) {
                return None;
            }
            if (0..2).all(|k| steps[k].abs() <= ROOT_STEP * roots[k]) {
                let at = |k: usize| self.laws[k].at_root(roots[k], 1.0 - 1.5 * kappa[k] * roots[k]);
                let contacts = [at(0), at(1)];
                return contacts
                    .iter()
                    .all(|at| at.tangent <= self.stiffest)
                    .then_some(contacts);
            }
        }
        None
    }

    /// Tangent and energies of both contacts from those of their own laws.
    fn coupled(&self, mut contacts: [ContactForce; 2]) -> BallForces {
        let x = self.across;
        let [inner, outer] = contacts.map(|contact| contact.tangent);
        let shared = 1.0 / (1.0 - x * x * inner * outer);
        let cross = -x * inner * outer * shared;
        let energy = 0.5 * x * contacts[0].force * contacts[1].force;
        contacts.iter_mut().for_each(|contact| contact.energy += energy);
        BallForces {
            contacts,
            tangent: [[inner * shared, cross], [cross, outer * shared]],
        }
    }
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
    /// What patch and ball yield besides Hertz's law together, m/N.
    pub fn compliance(&self) -> f64 {
        self.patch_compliance + self.ball_compliance
    }

    /// Force, tangent and energy at the geometric approach `g`, m.
    pub fn evaluate(&self, g: f64) -> ContactForce {
        if g <= 0.0 {
            return ContactForce {
                approach: g,
                ..ContactForce::default()
            };
        }
        let kappa = (self.patch_compliance + self.ball_compliance) * self.stiffness;
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

    /// The law, continued as a straight line from where its tangent is `most`, N/m.
    fn capped(&self, g: f64, most: f64) -> ContactForce {
        let at = self.evaluate(g);
        if at.tangent <= most {
            return at;
        }
        let kappa = (self.patch_compliance + self.ball_compliance) * self.stiffness;
        let root = most / (1.5 * (self.stiffness + kappa * most));
        let slope = 1.0 - 1.5 * kappa * root;
        let (corner, start) = if slope >= MIN_SLOPE {
            (self.at_root(root, slope), geometric(root, kappa))
        } else {
            // The tangent passes `most` where the map to g is a straight line.
            let root_limit = (1.0 - MIN_SLOPE) / (1.5 * kappa);
            let approach = (most * MIN_SLOPE / (1.5 * self.stiffness)).powi(2);
            let start = geometric(root_limit, kappa) + MIN_SLOPE * (approach - root_limit * root_limit);
            (self.evaluate(start), start)
        };
        let more = g - start;
        ContactForce {
            force: corner.force + most * more,
            tangent: most,
            energy: corner.energy + (corner.force + 0.5 * most * more) * more,
            approach: corner.approach + more,
            beyond_limit: true,
        }
    }

    fn at_root(&self, root: f64, slope: f64) -> ContactForce {
        let approach = root * root;
        let force = self.stiffness * approach * root;
        ContactForce {
            force,
            tangent: 1.5 * self.stiffness * root / slope,
            energy: 0.4 * force * approach
                - 0.5 * (self.patch_compliance + self.ball_compliance) * force * force,
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
    let most = match kappa > 0.0 {
        true => (1.0 - 0.5 * MIN_SLOPE) / (1.5 * kappa),
        false => f64::INFINITY,
    };
    // Newton from below on an increasing function, or from above where the ball is softer than a half-space; 60 rounds
    // cover the slowest start near the limit slope.
    for _ in 0..60 {
        let step = (g - x * x * (1.0 - kappa * x)) / (x * (2.0 - 3.0 * kappa * x));
        let next = (x + step).clamp(0.5 * x, most);
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
        ball_compliance: 0.0,
    };

    /// Wrong: without a patch the law would not be Hertz's.
    #[test]
    fn a_rigid_ring_follows_hertz() {
        let law = ContactLaw {
            stiffness: 2.9e10,
            patch_compliance: 0.0,
            ball_compliance: 0.0,
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

    /// Wrong: a hollow ball, softer than a half-space, would end the search for its force.
    #[test]
    fn a_ball_softer_than_a_half_space_meets_its_equation() {
        let law = ContactLaw {
            patch_compliance: 0.0,
            ball_compliance: -4e-9,
            ..LAW
        };
        for g in [1e-12, 1e-8, 5e-6, 1e-3] {
            let at = law.evaluate(g);
            let residual = at.approach + 4e-9 * at.force - g;
            assert!(residual.abs() < 1e-14 * g && !at.beyond_limit, "{g}: {residual}");
            assert!((law.evaluate(g * (1.0 + 1e-6)).energy - at.energy) / (g * 1e-6) / at.force - 1.0 < 1e-5);
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

    const BALL: BallLaws = BallLaws {
        laws: [
            ContactLaw {
                ball_compliance: 4e-10,
                ..LAW
            },
            ContactLaw {
                stiffness: 2.5e10,
                patch_compliance: 0.0,
                ball_compliance: 3e-10,
            },
        ],
        across: 1.8e-10,
        stiffest: STIFFEST / 1.8e-10,
    };

    /// Wrong: a contact would not feel the force of the other one of its ball, or too much. Both equations of the ball.
    #[test]
    fn both_contacts_of_a_ball_meet_their_equations() {
        for g in [[5e-6, 4e-6], [1.2e-5, 1e-5], [1e-7, 5e-6]] {
            let found = BALL.evaluate(g).contacts;
            for i in 0..2 {
                let law = &BALL.laws[i];
                let (q, other) = (found[i].force, found[1 - i].force);
                let taken = law.patch_compliance + law.ball_compliance;
                let met = (q / law.stiffness).powf(2.0 / 3.0) - taken * q + BALL.across * other;
                assert!(
                    q > 0.0 && (met - g[i]).abs() < 1e-15 * 1e-2 + 1e-12 * g[i],
                    "{g:?} {i}"
                );
            }
        }
    }

    /// Wrong: Newton's iteration on the roots would find another solution than the turns, or none where both press.
    #[test]
    fn roots_of_both_contacts_are_those_of_the_turns() {
        let mut pressed = 0;
        for i in 1..60 {
            for k in 1..60 {
                let g = [3e-7 * i as f64, 3e-7 * k as f64];
                let Some(found) = BALL.pressed(g) else { continue };
                pressed += 1;
                for side in 0..2 {
                    let other = found[1 - side].force;
                    let turn = BALL.laws[side].capped(g[side] - BALL.across * other, BALL.stiffest);
                    let (a, b) = (found[side].force, turn.force);
                    assert!(
                        (a - b).abs() < 1e-13 * b.max(other) && !turn.beyond_limit,
                        "{g:?} {side}: {a} {b}"
                    );
                }
            }
        }
        assert!(pressed > 2500, "{pressed}");
    }

    /// Wrong: forces without an energy, so that motion would make some. Difference quotients of energy and forces; one
    /// contact may come off.
    #[test]
    fn forces_of_a_ball_are_the_gradient_of_its_energy() {
        let energy = |g: BySide<f64>| BALL.evaluate(g).contacts.iter().map(|c| c.energy).sum::<f64>();
        for g in [[5e-6, 4e-6], [2e-5, 1e-5], [1e-9, 5e-6], [-1e-6, 5e-6]] {
            let at = BALL.evaluate(g);
            for k in 0..2 {
                let h = 1e-11;
                let (mut low, mut high) = (g, g);
                (low[k], high[k]) = (low[k] - h, high[k] + h);
                let slope = (energy(high) - energy(low)) / (2.0 * h);
                assert!(
                    (slope - at.contacts[k].force).abs() < 1e-4 * (1.0 + slope.abs()),
                    "{g:?} {k}: {slope}"
                );
                let (low, high) = (BALL.evaluate(low), BALL.evaluate(high));
                for i in 0..2 {
                    let slope = (high.contacts[i].force - low.contacts[i].force) / (2.0 * h);
                    let size = at.tangent[k][k].max(1e6);
                    assert!(
                        (slope - at.tangent[i][k]).abs() < 2e-4 * size,
                        "{g:?} {i} {k}: {slope}"
                    );
                }
            }
        }
    }
}
