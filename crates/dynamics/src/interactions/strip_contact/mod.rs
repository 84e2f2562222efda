//! Contacts of balls and raceways by strips ([`contact::strips`]): forces along and across the normal.
//!
//! With strips the energy V(g, alpha) of a contact depends on its contact angle too. Its force is Q n + M/|l| t, Q =
//! dV/dg along the normal n and M = dV/dalpha across it, t = (-n_axial, n_radial).
//!
//! Over a step it is a discrete gradient in both variables, that of Itoh and Abe (J. Comput. Phys. 76 (1988) 85) made
//! symmetric:
//!
//! ```text
//! Qbar = 1/2 {[V(g1, a1) - V(g0, a1)] + [V(g1, a0) - V(g0, a0)]} / (g1 - g0),   Mbar with the roles exchanged
//! F = Qbar (l0 + l1)/(|l0| + |l1|) + Mbar t(l0 + l1)/(2 q),   q = |l0| |l1| sin(a1 - a0)/(a1 - a0)
//! ```
//!
//! The vectors give exactly |l1| - |l0| and a1 - a0 over a step, so that F . (l1 - l0) = V1 - V0. Where both variables
//! change little the gradient is integrated along the step instead, by three Gauss points. On a smooth groove M = 0 and
//! F is that of [`super::discrete_gradient`].
//!
//! Contact damping takes its coefficient at the approach at which a smooth groove has the contact's force.

use contact::across::sinc;
use contact::law::ContactForce;
use contact::{ContactLaw, Meridian, StripForce, StripLine};

use super::contact_damping::{StepDamping, coefficient};
use super::discrete_gradient::{
    ContactScheme, ContactTangent, GAUSS, MeanForce, drop_pull, mean_direction, size, unit,
};
use crate::surfaces::Strips;

/// Changes over the size of the contact below which the mean force is integrated: where it bends over a profile or at
/// an edge, and where it does not. A difference has a round-off of one over this.
const SMALL_CHANGE: f64 = 1e-3;
const SMALL_SMOOTH_CHANGE: f64 = 1e-2;

/// The force across the normal and how it grows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lateral {
    /// M = dV/dalpha, N m/rad.
    pub moment: f64,
    /// Growth of Q, or M, with the contact angle, or the approach, N/rad.
    pub cross: f64,
    /// Growth of M with the contact angle, N m/rad^2.
    pub bend: f64,
}

impl Lateral {
    /// Force on the ring, N, at a contact with the normal `n` and |l| = `length`.
    pub fn force(&self, n: Meridian, length: f64) -> Meridian {
        Meridian::new(-n.axial, n.radial).map(|t| self.moment / length * t)
    }

    /// What it adds to the second derivatives of V(|l|, alpha) over l, N/m.
    pub fn tangent(&self, n: Meridian, length: f64) -> ContactTangent {
        let (n, t) = (n.to_array(), across(n.to_array()));
        let mixed = (self.cross - self.moment / length) / length;
        let own = self.bend / (length * length);
        [0, 1].map(|i| [0, 1].map(|j| mixed * (n[i] * t[j] + t[i] * n[j]) + own * t[i] * t[j]))
    }
}

/// A contact of strips: where it stands, and what yields besides.
#[derive(Clone, Copy, Debug)]
pub struct StripSite<'s> {
    /// Its strips.
    pub strips: &'s Strips,
    /// What patch and ball yield besides, m/N.
    pub compliance: f64,
    /// |l| at which a smooth groove touches, m.
    pub touching: f64,
    /// Sign of the raceway's side.
    pub sign: f64,
}

impl<'s> StripSite<'s> {
    /// A contact with the compliances of its law.
    pub fn new(strips: &'s Strips, law: &ContactLaw, touching: f64, sign: f64) -> StripSite<'s> {
        StripSite {
            strips,
            compliance: law.compliance(),
            touching,
            sign,
        }
    }

    fn evaluate(&self, line: StripLine, g: f64, angle: f64) -> StripForce {
        self.strips.surface.law.evaluate(line, self.compliance, g, angle)
    }

    /// The contact at a geometric approach, m, and a contact angle, rad.
    pub fn state(&self, g: f64, angle: f64) -> (ContactForce, Lateral) {
        let found = self.evaluate(self.strips.line(), g, angle);
        let force = ContactForce {
            force: found.force,
            tangent: found.tangent[0][0],
            energy: found.energy,
            approach: found.approach,
            beyond_limit: found.beyond_limit,
        };
        let lateral = Lateral {
            moment: found.moment,
            cross: found.tangent[0][1],
            bend: found.tangent[1][1],
        };
        (force, lateral)
    }

    /// The contact at l on the surface of the step's middle.
    pub fn at(&self, l: Meridian) -> StripForce {
        self.evaluate(self.strips.line(), l.norm() - self.touching, self.angle(l))
    }

    /// The contact at l on the surface of the start, 0, or the end, 1, of the step.
    pub fn at_end(&self, end: usize, l: Meridian) -> StripForce {
        let line = self.strips.lines_at_ends()[end];
        self.evaluate(line, l.norm() - self.touching, self.angle(l))
    }

    /// Energies with the lengths and on the lines of start and end of a step, J.
    pub fn energies_at_ends(&self, l: [Meridian; 2]) -> [f64; 2] {
        [0, 1].map(|end| self.at_end(end, l[end]).energy)
    }

    fn angle(&self, l: Meridian) -> f64 {
        (self.sign * l.axial).atan2(self.sign * l.radial)
    }

    /// Mean force over a step between these lengths, m. `weight` is that of the start.
    pub fn mean_force(
        &self,
        l: [Meridian; 2],
        (scheme, weight): (ContactScheme, f64),
        damping: Option<StepDamping<'_>>,
    ) -> MeanForce {
        let step = StripStep::new(self, l);
        let mut mean = match scheme {
            ContactScheme::DiscreteGradient => step.discrete_gradient(),
            ContactScheme::Pointwise => step.weighted(weight),
        };
        let [loss, passing_work] = damping.map_or([0.0; 2], |damping| step.add_damping(damping, &mut mean));
        let mut result = step.force(&mean);
        (result.loss, result.passing_work) = (loss, passing_work);
        if scheme == ContactScheme::DiscreteGradient && weight != 0.5 {
            step.add_change(0.5 - weight, &mut result);
        }
        result
    }
}

/// Force on the ring, N, of a contact at l.
pub fn force_on_ring(found: &StripForce, l: Meridian) -> Meridian {
    let (n, length) = (unit(l.to_array()), l.norm());
    let t = across(n);
    [0, 1]
        .map(|i| found.force * n[i] + found.moment / length * t[i])
        .into()
}

/// t = (-n_axial, n_radial).
pub(super) fn across(n: [f64; 2]) -> [f64; 2] {
    [-n[1], n[0]]
}

/// The vector whose product with l1 - l0 is the turn of l over a step, 1/m, and its growth with l1.
pub(super) fn turning([l0, l1]: [[f64; 2]; 2], turn: f64) -> ([f64; 2], ContactTangent) {
    let (n, r0, r1) = (unit(l1), size(l0), size(l1));
    let t = across(n).map(|t| t / r1);
    let [sinc, sinc_slope] = sinc(turn);
    let q = r0 * r1 * sinc;
    let side = across([l0[0] + l1[0], l0[1] + l1[1]]).map(|x| x / (2.0 * q));
    let slope = |i: usize, j: usize| {
        // Of t(e_j): the axial unit vector turns to -radial, the radial one to axial.
        let turned = [[0.0, -1.0], [1.0, 0.0]][i][j];
        let q_slope = r0 * (sinc * n[j] + r1 * sinc_slope * t[j]);
        turned / (2.0 * q) - side[i] * q_slope / q
    };
    (side, [0, 1].map(|i| [0, 1].map(|j| slope(i, j))))
}

/// Means of Q and M, and their growth with g and alpha at the end.
#[derive(Clone, Copy, Debug, Default)]
struct MeanGradient {
    values: [f64; 2],
    growth: [[f64; 2]; 2],
}

/// A contact over a step.
struct StripStep<'s> {
    site: &'s StripSite<'s>,
    l: [[f64; 2]; 2],
    /// Approach and contact angle at start and end.
    at: [[f64; 2]; 2],
    /// The contact there.
    ends: [StripForce; 2],
}

impl<'s> StripStep<'s> {
    fn new(site: &'s StripSite<'s>, [start, end]: [Meridian; 2]) -> StripStep<'s> {
        let l = [start.to_array(), end.to_array()];
        let [l0, l1] = l;
        let turn = (l0[0] * l1[1] - l0[1] * l1[0]).atan2(l0[0] * l1[0] + l0[1] * l1[1]);
        let angle = site.angle(start);
        let approach = l.map(|l| size(l) - site.touching);
        let at = [[approach[0], angle], [approach[1], angle + turn]];
        StripStep {
            site,
            l,
            at,
            ends: at.map(|[g, angle]| site.evaluate(site.strips.line(), g, angle)),
        }
    }

    fn evaluate(&self, g: f64, angle: f64) -> StripForce {
        self.site.evaluate(self.site.strips.line(), g, angle)
    }

    fn change(&self, k: usize) -> f64 {
        self.at[1][k] - self.at[0][k]
    }

    fn weighted(&self, weight: f64) -> MeanGradient {
        let [start, end] = self.ends;
        let mean = |a: f64, b: f64| weight * a + (1.0 - weight) * b;
        MeanGradient {
            values: [mean(start.force, end.force), mean(start.moment, end.moment)],
            growth: end.tangent.map(|row| row.map(|t| (1.0 - weight) * t)),
        }
    }

    fn discrete_gradient(&self) -> MeanGradient {
        let [[g0, a0], [g1, a1]] = self.at;
        let [start, end] = self.ends;
        if self.is_small(0, [&start, &end]) && self.is_small(1, [&start, &end]) {
            return self.integrated();
        }
        let corners = [start, self.evaluate(g0, a1), self.evaluate(g1, a0), end];
        let mut mean = MeanGradient::default();
        let corner = |g_end: usize, a_end: usize| &corners[2 * g_end + a_end];
        for end in 0..2 {
            let legs = [
                (0, [corner(0, end), corner(1, end)]),
                (1, [corner(end, 0), corner(end, 1)]),
            ];
            for (k, ends) in legs {
                let leg = if self.is_small(k, ends) {
                    self.integrated_leg(k, self.at[end][1 - k])
                } else {
                    divided_leg(k, self.change(k), ends)
                };
                mean.values[k] += 0.5 * leg[0];
                mean.growth[k][k] += 0.5 * leg[1];
                mean.growth[k][1 - k] += if end == 1 { 0.5 * leg[2] } else { 0.0 };
            }
        }
        mean
    }

    /// Whether the variable `k` changes little between these states of the contact.
    fn is_small(&self, k: usize, [start, end]: [&StripForce; 2]) -> bool {
        let change = self.change(k).abs();
        let (strips, law) = (self.site.strips, &self.site.strips.surface.law);
        if k == 0
            && [start, end]
                .iter()
                .zip(self.at)
                .all(|(found, [_, angle])| strips.is_smooth(found.approach, angle))
        {
            return change <= SMALL_SMOOTH_CHANGE * start.approach.min(end.approach);
        }
        let size = if k == 0 {
            let width = law.half_width(start.force.min(end.force));
            0.5 * width * width / law.parabola_radius
        } else {
            // A contact that opens is no smaller across the track than it was.
            law.half_width(start.force.max(end.force)) / law.groove_radius
        };
        change == 0.0 || change <= SMALL_CHANGE * size
    }

    /// The gradient integrated along the step.
    fn integrated(&self) -> MeanGradient {
        let mut mean = MeanGradient::default();
        for (s, weight) in GAUSS {
            let [g, angle] = [0, 1].map(|k| self.at[0][k] + s * self.change(k));
            let at = self.evaluate(g, angle);
            for (k, value) in [at.force, at.moment].into_iter().enumerate() {
                mean.values[k] += weight * value;
                (0..2).for_each(|j| mean.growth[k][j] += weight * s * at.tangent[k][j]);
            }
        }
        mean
    }

    /// Mean of the derivative over the variable `k` while the other stays at `fixed`; its growth with the end of `k`
    /// and with `fixed`.
    fn integrated_leg(&self, k: usize, fixed: f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (s, weight) in GAUSS {
            let mut at = [fixed; 2];
            at[k] = self.at[0][k] + s * self.change(k);
            let found = self.evaluate(at[0], at[1]);
            let terms = [
                [found.force, found.moment][k],
                s * found.tangent[k][k],
                found.tangent[k][1 - k],
            ];
            (0..3).for_each(|i| sum[i] += weight * terms[i]);
        }
        sum
    }

    /// Adds contact damping along the normal; a sum never pulls. Returns the loss, and what passing has of it, J.
    fn add_damping(&self, damping: StepDamping<'_>, mean: &mut MeanGradient) -> [f64; 2] {
        let [start, end] = self.ends;
        let approach = |found: &StripForce, g: f64| {
            let law = &self.site.strips.surface.law;
            if found.force > 0.0 {
                law.smooth_approach(self.site.compliance, found.force)
            } else {
                g.min(0.0)
            }
        };
        let (e0, e1) = (approach(&start, self.at[0][0]), approach(&end, self.at[1][0]));
        // Growth of e1 with the force at the end.
        let growth = if end.force > 0.0 {
            let law = &self.site.strips.surface.law;
            2.0 / 3.0 * (end.force / law.stiffness).powf(2.0 / 3.0) / end.force - self.site.compliance
        } else {
            0.0
        };
        let [c, slope] = coefficient(damping.law, 0.5 * (e0 + e1));
        let (change, elastic) = (self.change(0), mean.values[0]);
        let rate = (change + damping.passing) / damping.dt;
        mean.values[0] += c * rate;
        mean.growth[0][0] += c / damping.dt + 0.5 * slope * rate * growth * end.tangent[0][0];
        mean.growth[0][1] += 0.5 * slope * rate * growth * end.tangent[0][1];
        if mean.values[0] < 0.0 {
            mean.values[0] = 0.0;
            mean.growth[0] = [0.0; 2];
        }
        let viscous = mean.values[0] - elastic;
        [viscous * (change + damping.passing), viscous * damping.passing]
    }

    /// The vectors that give the changes of |l| and alpha, and the force of mean gradients along them.
    fn force(&self, mean: &MeanGradient) -> MeanForce {
        let [l0, l1] = self.l;
        let (r0, r1) = (size(l0), size(l1));
        let (n, turn) = (unit(l1), self.change(1));
        let t = across(n).map(|t| t / r1);
        let along = mean_direction(self.l);
        let (side, side_slope) = turning(self.l, turn);
        let [normal, moment] = mean.values;
        let mut result = MeanForce::default();
        for i in 0..2 {
            result.force[i] = normal * along[i] + moment * side[i];
            for j in 0..2 {
                let identity = if i == j { 1.0 } else { 0.0 };
                let growth = mean.growth.map(|row| row[0] * n[j] + row[1] * t[j]);
                result.tangent[i][j] = growth[0] * along[i]
                    + normal * (identity - along[i] * n[j]) / (r0 + r1)
                    + growth[1] * side[i]
                    + moment * side_slope[i][j];
            }
        }
        result
    }

    /// Adds `share` times the change of the force over the step; no sum pulls.
    fn add_change(&self, share: f64, result: &mut MeanForce) {
        let before = result.force;
        for (end, sign) in [(0, -1.0), (1, 1.0)] {
            let [g, angle] = self.at[end];
            let (found, lateral) = self.site.state(g, angle);
            let (n, length) = (unit(self.l[end]), size(self.l[end]));
            let force = lateral.force(n.into(), length).to_array();
            let more = lateral.tangent(n.into(), length);
            for i in 0..2 {
                result.force[i] += share * sign * (found.force * n[i] + force[i]);
                for j in 0..2 {
                    let identity = if i == j { 1.0 } else { 0.0 };
                    let own = found.tangent * n[i] * n[j] + found.force / length * (identity - n[i] * n[j]);
                    result.tangent[i][j] += if end == 1 { share * (own + more[i][j]) } else { 0.0 };
                }
            }
        }
        let [l0, l1] = self.l;
        drop_pull([l0[0] + l1[0], l0[1] + l1[1]], result);
        result.numerical_loss = (0..2)
            .map(|i| (result.force[i] - before[i]) * (l1[i] - l0[i]))
            .sum();
    }
}

/// Energy differenced over the variable `k`: the mean derivative and its growth with the end of `k` and with the other
/// variable.
fn divided_leg(k: usize, change: f64, [start, end]: [&StripForce; 2]) -> [f64; 3] {
    let gradient = |at: &StripForce| [at.force, at.moment];
    let mean = (end.energy - start.energy) / change;
    [
        mean,
        (gradient(end)[k] - mean) / change,
        (gradient(end)[1 - k] - gradient(start)[1 - k]) / change,
    ]
}

#[cfg(test)]
mod tests;
