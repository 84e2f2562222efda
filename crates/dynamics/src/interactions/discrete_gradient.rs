//! Contact forces that are means over a step.
//!
//! **Discrete gradient** (default): F = [V(d1) - V(d0)]/(d1 - d0) along (l1 + l0)/(|l1| + |l0|), l the vector from
//! groove centre to ball centre. Then F . (l1 - l0) = V(d1) - V(d0) exactly: contact exchanges energy and makes none,
//! at any step size (Gonzalez, J. Nonlinear Sci. 6 (1996) 449, doi:10.1007/BF02440162). **Pointwise** (for comparison
//! only): the weighted mean of the force values at both ends along the same direction, as plain generalised-alpha
//! takes it; it can gain energy without bound when balls unload.
//!
//! With damping ([`super::contact_damping`]) the sum is never tensile.

use contact::law::BallForces;
use contact::{BallLaws, BySide, ContactLaw};
use serde::Deserialize;

use super::contact_damping::Viscous;

/// Relative change of the approach below which the mean force is integrated instead of differenced: the difference
/// would lose digits, and three Gauss points are exact to round-off there.
const SMALL_CHANGE: f64 = 1e-2;
/// Gauss points and weights on 0..1.
pub(super) const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// How contact forces are evaluated over a step.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum ContactScheme {
    /// Energy-conserving mean force, plus (1/2 - weight) times its change over the step: the force at the weighted
    /// time of an integrator that dissipates. V is convex, so this term only takes energy.
    DiscreteGradient,
    /// (1 - weight) times the force at the end plus `weight` times the force at the start: for comparison, it feeds
    /// energy into contacts that open.
    Pointwise,
}

/// Growth of a force [radial, axial] with l, N/m, by rows of forces.
pub type ContactTangent = [[f64; 2]; 2];

/// Mean force of one contact over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeanForce {
    /// Force on the ring [radial, axial], N; the ball gets its negative.
    pub force: [f64; 2],
    /// Derivative with respect to l1, N/m.
    pub tangent: ContactTangent,
    /// Energy lost to contact damping in this step, J.
    pub loss: f64,
    /// Part of it that what moves the balls round brings, J.
    pub passing_work: f64,
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

/// Mean forces along the normals, their growth with the approaches at the end, N/m, by rows of forces, and with the x
/// of the end, of which the mean has half.
#[derive(Clone, Copy, Debug, Default)]
struct MeanNormals {
    forces: [f64; 2],
    slopes: [[f64; 2]; 2],
    over_across: [f64; 2],
}

/// Elastic mean forces of both contacts between the approaches `d0` and `d1` along their normals, and their derivatives
/// with respect to d1, by rows of forces. Their work is exactly the change of the stored energy: where both change
/// little the gradient is integrated, else the energy is differenced for one contact after the other, as the mean of
/// both orders (Itoh and Abe, J. Comput. Phys. 76 (1988) 85).
fn mean_normals(laws: &BallLaws, d0: [f64; 2], d1: [f64; 2]) -> MeanNormals {
    let is_open = |k: usize| d0[k] <= 0.0 && d1[k] <= 0.0;
    if laws.across == 0.0 || (laws.across > 0.0 && (is_open(0) || is_open(1))) {
        let [inner, outer] = [0, 1].map(|k| mean_normal(&laws.laws[k], d0[k], d1[k]));
        return MeanNormals {
            forces: [inner[0], outer[0]],
            slopes: [[inner[1], 0.0], [0.0, outer[1]]],
            over_across: [0.0; 2],
        };
    }
    // By how much a contact is deeper than its approach because the other one pushes it out.
    let pushed = match laws.across < 0.0 {
        true => [1, 0].map(|k| -laws.across * laws.evaluate(d0).contacts[k].force),
        false => [0.0; 2],
    };
    let is_small = |k: usize| (d1[k] - d0[k]).abs() <= SMALL_CHANGE * (d0[k].min(d1[k]) + pushed[k]);
    let MeanNormals {
        mut forces,
        mut slopes,
        mut over_across,
    } = MeanNormals::default();
    if is_small(0) && is_small(1) {
        for (s, weight) in GAUSS {
            let at = laws.evaluate([0, 1].map(|k| d0[k] + s * (d1[k] - d0[k])));
            let over_x = at.over_across();
            for i in 0..2 {
                over_across[i] += 0.5 * weight * over_x[i];
                forces[i] += weight * at.contacts[i].force;
                (0..2).for_each(|k| slopes[i][k] += weight * s * at.tangent[i][k]);
            }
        }
        return MeanNormals {
            forces,
            slopes,
            over_across,
        };
    }
    for i in 0..2 {
        for (other, is_end) in [(d0[1 - i], false), (d1[1 - i], true)] {
            let [force, own, across, over_x] = divided(laws, (i, pushed[i]), [d0[i], d1[i]], other);
            forces[i] += 0.5 * force;
            slopes[i][i] += 0.5 * own;
            slopes[i][1 - i] += if is_end { 0.5 * across } else { 0.0 };
            over_across[i] += 0.25 * over_x;
        }
    }
    MeanNormals {
        forces,
        slopes,
        over_across,
    }
}

/// Mean force of the contact `i`, pushed out by so much, between two approaches, while the other one stays at `other`,
/// and its derivatives with respect to the end, to `other` and to x.
fn divided(laws: &BallLaws, (i, pushed): (usize, f64), [from, to]: [f64; 2], other: f64) -> [f64; 4] {
    let at = |d: f64| {
        let mut g = [other; 2];
        g[i] = d;
        laws.evaluate(g)
    };
    let change = to - from;
    if change.abs() <= SMALL_CHANGE * (from.min(to) + pushed) || change == 0.0 {
        return GAUSS.iter().fold([0.0; 4], |sum, (s, weight)| {
            let at = at(from + s * change);
            let [own, across] = [i, 1 - i].map(|k| at.tangent[i][k]);
            let terms = [at.contacts[i].force, s * own, across, at.over_across()[i]];
            [0, 1, 2, 3].map(|k| sum[k] + weight * terms[k])
        });
    }
    let (start, end) = (at(from), at(to));
    let energy = |at: &BallForces| at.contacts[0].energy + at.contacts[1].energy;
    let force = (energy(&end) - energy(&start)) / change;
    let product = |at: &BallForces| at.contacts[0].force * at.contacts[1].force;
    [
        force,
        (end.contacts[i].force - force) / change,
        (end.contacts[1 - i].force - start.contacts[1 - i].force) / change,
        (product(&start) - product(&end)) / change,
    ]
}

/// Mean forces of both contacts of a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallMeans {
    /// Each contact, inner first.
    pub contacts: [MeanForce; 2],
    /// Derivative of the force of each with respect to l1 of the other, N/m.
    pub across: [ContactTangent; 2],
    /// Derivative of the normal force of each with respect to the x of the end, N^2/m.
    pub over_across: [f64; 2],
}

/// Lengths of a ball's contacts over a step.
#[derive(Clone, Copy, Debug)]
pub struct BallLengths {
    /// |l| at which each touches, m.
    pub touching: [f64; 2],
    /// l of each at the start and at the end, m.
    pub l: [[[f64; 2]; 2]; 2],
}

impl BallLengths {
    /// l of both contacts at the start, 0, or the end, 1, m.
    pub(super) fn at(&self, end: usize) -> [[f64; 2]; 2] {
        [0, 1].map(|k| self.l[k][end])
    }

    /// Approaches at the start and at the end, m.
    pub(super) fn approaches(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|end| [0, 1].map(|k| size(self.l[k][end]) - self.touching[k]))
    }
}

/// Mean forces over a step, of the laws at the mean of both x and at the x of either end. `weight` is that of the
/// start, the integrator's alpha_f; `viscous` what damping does to each contact, if there is any
/// ([`super::contact_damping::StepDamping`]).
pub fn mean_forces(
    (laws, ends): (&BallLaws, &[BallLaws; 2]),
    lengths: &BallLengths,
    (scheme, weight): (ContactScheme, f64),
    viscous: Option<BySide<Viscous>>,
) -> BallMeans {
    let [d0, d1] = lengths.approaches();
    let means = match scheme {
        ContactScheme::DiscreteGradient => mean_normals(laws, d0, d1),
        ContactScheme::Pointwise => {
            let (start, end) = (ends[0].evaluate(d0), ends[1].evaluate(d1));
            let force = |k: usize| weight * start.contacts[k].force + (1.0 - weight) * end.contacts[k].force;
            MeanNormals {
                forces: [force(0), force(1)],
                slopes: end.tangent.map(|row| row.map(|t| (1.0 - weight) * t)),
                over_across: end.over_across().map(|growth| (1.0 - weight) * growth),
            }
        }
    };
    let mut result = BallMeans {
        contacts: [MeanForce::default(); 2],
        across: [[[0.0; 2]; 2]; 2],
        over_across: [0.0; 2],
    };
    for k in 0..2 {
        let own = [means.forces[k], means.slopes[k][k]];
        let damping = viscous.map(|terms| terms[k]);
        let (mean, pulls) = along_lengths(lengths.l[k], own, damping, d1[k] - d0[k]);
        result.contacts[k] = mean;
        if !pulls {
            let direction = mean_direction(lengths.l[k]);
            result.across[k] = outer(means.slopes[k][1 - k], direction, unit(lengths.l[1 - k][1]));
            result.over_across[k] = means.over_across[k];
        }
    }
    if scheme == ContactScheme::DiscreteGradient && weight != 0.5 {
        add_changes(ends, lengths, 0.5 - weight, &mut result);
    }
    result
}

/// Mean force of a contact with a viscous force that depends on the elastic one: `viscous` gets that and its derivative
/// with respect to |l1|, and the change of |l|.
pub fn mean_force_with(
    law: &ContactLaw,
    touching: f64,
    l: [[f64; 2]; 2],
    viscous: impl Fn([f64; 2], f64) -> Viscous,
) -> MeanForce {
    let [d0, d1] = l.map(|l| size(l) - touching);
    let normal = mean_normal(law, d0, d1);
    along_lengths(l, normal, Some(viscous(normal, d1 - d0)), d1 - d0).0
}

/// The mean force of one contact along its mean direction from the normal mean and its stiffness, and whether damping
/// would have made it pull.
fn along_lengths(
    [l0, l1]: [[f64; 2]; 2],
    [mut normal, mut stiffness]: [f64; 2],
    viscous: Option<Viscous>,
    change: f64,
) -> (MeanForce, bool) {
    let total = size(l0) + size(l1);
    let end = unit(l1);
    let (mut loss, mut passing_work, mut pulls) = (0.0, 0.0, false);
    if let Some(viscous) = viscous {
        let elastic = normal;
        normal += viscous.force;
        stiffness += viscous.slope;
        if normal < 0.0 {
            (normal, stiffness) = (0.0, 0.0);
            pulls = true;
        }
        passing_work = (normal - elastic) * viscous.passing;
        loss = (normal - elastic) * change + passing_work;
    }
    let mean = mean_direction([l0, l1]);
    let mut result = MeanForce {
        force: [normal * mean[0], normal * mean[1]],
        tangent: [[0.0; 2]; 2],
        loss,
        passing_work,
        numerical_loss: 0.0,
    };
    for i in 0..2 {
        for j in 0..2 {
            let identity = if i == j { 1.0 } else { 0.0 };
            result.tangent[i][j] =
                stiffness * mean[i] * end[j] + normal * (identity - mean[i] * end[j]) / total;
        }
    }
    (result, pulls)
}

pub(super) fn size(l: [f64; 2]) -> f64 {
    l[0].hypot(l[1])
}

pub(super) fn unit(l: [f64; 2]) -> [f64; 2] {
    let size = size(l);
    [l[0] / size, l[1] / size]
}

/// (l1 + l0)/(|l1| + |l0|).
pub(super) fn mean_direction([l0, l1]: [[f64; 2]; 2]) -> [f64; 2] {
    let total = size(l0) + size(l1);
    [(l0[0] + l1[0]) / total, (l0[1] + l1[1]) / total]
}

/// factor a b^T.
pub(super) fn outer(factor: f64, a: [f64; 2], b: [f64; 2]) -> [[f64; 2]; 2] {
    a.map(|a| b.map(|b| factor * a * b))
}

/// Takes away the part of a force that pulls along the direction of `along`, which grows with l1, and keeps the part
/// across it: so the force stays continuous.
pub(super) fn drop_pull(along: [f64; 2], result: &mut MeanForce) {
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

/// Adds `share` times the change of the forces over the step; no sum pulls.
fn add_changes(laws: &[BallLaws; 2], lengths: &BallLengths, share: f64, result: &mut BallMeans) {
    let [d0, d1] = lengths.approaches();
    let [start, end] = [laws[0].evaluate(d0), laws[1].evaluate(d1)];
    for k in 0..2 {
        let l = lengths.l[k];
        let [e0, e1] = l.map(unit);
        let (s1, forces) = (
            size(l[1]),
            [&start, &end].map(|at: &BallForces| at.contacts[k].force),
        );
        let contact = &mut result.contacts[k];
        let before = contact.force;
        for i in 0..2 {
            contact.force[i] += share * (forces[1] * e1[i] - forces[0] * e0[i]);
            for j in 0..2 {
                let identity = if i == j { 1.0 } else { 0.0 };
                let along = e1[i] * e1[j];
                contact.tangent[i][j] +=
                    share * (end.tangent[k][k] * along + forces[1] / s1 * (identity - along));
            }
        }
        drop_pull([l[0][0] + l[1][0], l[0][1] + l[1][1]], contact);
        contact.numerical_loss = (0..2)
            .map(|i| (contact.force[i] - before[i]) * (l[1][i] - l[0][i]))
            .sum();
        let more = outer(share * end.tangent[k][1 - k], e1, unit(lengths.l[1 - k][1]));
        for (row, more) in result.across[k].iter_mut().zip(more) {
            row.iter_mut().zip(more).for_each(|(value, more)| *value += more);
        }
    }
}

#[cfg(test)]
mod tests;
