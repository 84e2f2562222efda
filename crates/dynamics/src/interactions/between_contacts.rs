//! What the angle between the contacts of a ball does to their forces.
//!
//! A contact yields by x times the force of the other one of its ball. x depends on the difference delta of the
//! contact angles, inner less outer ([`contact::across`]). The energy V(g_i, g_o, x) of [`contact::law`] has dV/dx =
//! -Q_i Q_o, so besides the normal forces there is a couple M = dV/d delta = -Q_i Q_o x'(delta): the force M/|l| t on
//! the inner ring and -M/|l| t on the outer one, t = (-n_axial, n_radial). It comes from the slope that the ball's
//! surface has at one contact under the force of the other. At 20 deg and 330 N on a 9 mm ball it is 2e-4 Q.
//!
//! Over a step the normal forces are those of [`super::discrete_gradient`] at the mean xm of x0 and x1, and
//!
//! ```text
//! M = {[V(g1, x1) - V(g1, xm)] + [V(g0, xm) - V(g0, x0)]} / (delta1 - delta0)
//! ```
//!
//! acts along the vectors that give exactly the changes of the contact angles ([`super::strip_contact`]). The work of
//! all forces is V1 - V0. Where x changes little, a difference of V is -Q_i Q_o in its middle times that of x.
//!
//! **Convexity.** For forces that stay, Q_i |l_i| + Q_o |l_o| - x Q_i Q_o bends across the normals by Q/|l| (1 - Q_o
//! |x''|/|l|) at least, and 330 N make 1e-3 of the second term. The mixed term Q_i Q_o x'/|l| is taken up by the
//! stiffness of the contact along its normal as long as (Q_o x'/|l|)^2 d_e < |l|: that is 1e-8.

use contact::across::AcrossGrowth;
use contact::law::BallForces;
use contact::{AcrossCompliance, BallLaws, BySide, ContactLaw, Meridian};

use super::contact_damping::Viscous;
use super::discrete_gradient::{
    BallLengths, BallMeans, ContactScheme, ContactTangent, drop_pull, mean_direction, mean_forces, outer,
    size, unit,
};
use super::strip_contact::{Lateral, across as across_normal, turning};

/// Change of the yield by x over the smallest approach below which a force is taken in its middle: the error of the
/// energy is of its square times itself.
const SMALL_CHANGE: f64 = 1e-5;
/// Of the contact angles in their difference.
const SIGNS: BySide<f64> = [1.0, -1.0];

/// Both contacts of a ball, inner first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallContacts {
    /// Each on its own.
    pub laws: [ContactLaw; 2],
    /// How they yield under each other's force.
    pub across: AcrossCompliance,
}

impl BallContacts {
    fn at(&self, across: f64) -> BallLaws {
        BallLaws {
            laws: self.laws,
            across,
            stiffest: self.across.stiffest(),
        }
    }

    /// The contacts at the approaches `g` and at `l`, m, and what they have across their normals where they depend on
    /// each other.
    pub fn instant(&self, g: BySide<f64>, l: BySide<Meridian>) -> (BallForces, Option<BySide<Lateral>>) {
        if self.across.is_none() {
            return (self.at(0.0).evaluate(g), None);
        }
        let x = self.across.at(difference(l.map(|l| l.to_array())));
        let found = self.at(x.value).evaluate(g);
        let (over_x, [product, product_over_x]) = (found.over_across(), product(&found));
        let bend = -(product_over_x * x.slope * x.slope + product * x.bend);
        let lateral = |k: usize| Lateral {
            moment: -SIGNS[k] * product * x.slope,
            cross: SIGNS[k] * over_x[k] * x.slope,
            bend,
        };
        (found, Some([lateral(0), lateral(1)]))
    }

    /// Mean forces over a step, as those of [`mean_forces`].
    pub fn mean_forces(
        &self,
        lengths: &BallLengths,
        (scheme, weight): (ContactScheme, f64),
        viscous: Option<BySide<Viscous>>,
    ) -> BallMeans {
        if self.across.is_none() {
            let laws = self.at(0.0);
            return mean_forces((&laws, &[laws; 2]), lengths, (scheme, weight), viscous);
        }
        let step = BallStep::new(self, lengths);
        let (mean, ends) = (self.at(step.mean_across()), step.x.map(|x| self.at(x.value)));
        let mut result = mean_forces((&mean, &ends), lengths, (scheme, weight), viscous);
        step.add(&step.moment(), &mut result);
        if scheme == ContactScheme::DiscreteGradient && weight != 0.5 {
            step.add_change(0.5 - weight, &mut result);
        }
        result
    }
}

/// How the force of contact `k` on its ring grows with l of the ball's other contact, N/m: by `growth` with the
/// approach of that one, and with its angle. `slopes` are those of the approaches over l.
pub fn of_other(
    k: usize,
    growth: f64,
    lateral: Option<&BySide<Lateral>>,
    (normals, slopes, lengths): (BySide<[f64; 2]>, BySide<[f64; 2]>, BySide<f64>),
) -> ContactTangent {
    let j = 1 - k;
    let mut block = outer(growth, normals[k], slopes[j]);
    if let Some(lateral) = lateral.filter(|_| lengths[0] > 0.0 && lengths[1] > 0.0) {
        let t = [0, 1].map(|i| across_normal(normals[i]).map(|t| t / lengths[i]));
        add(outer(-lateral[k].cross, normals[k], t[j]), &mut block);
        add(outer(-lateral[j].cross, t[k], normals[j]), &mut block);
        add(outer(-lateral[k].bend, t[k], t[j]), &mut block);
    }
    block
}

fn add(more: ContactTangent, sum: &mut ContactTangent) {
    let sums = sum.as_flattened_mut().iter_mut();
    sums.zip(more.as_flattened()).for_each(|(sum, more)| *sum += more);
}

/// Inner contact angle less the outer one, rad.
fn difference([inner, outer]: BySide<[f64; 2]>) -> f64 {
    let outer = outer.map(|x| -x);
    turn([outer, inner])
}

/// By which angle the second vector is turned against the first.
fn turn([a, b]: [[f64; 2]; 2]) -> f64 {
    (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
}

/// Q_i Q_o and its derivative over x.
fn product(at: &BallForces) -> [f64; 2] {
    let [inner, outer] = at.contacts.map(|contact| contact.force);
    let over_x = at.over_across();
    [inner * outer, inner * over_x[1] + outer * over_x[0]]
}

/// Mean of M over a step, N m, and its growth with both approaches and with the difference of the angles at the end.
#[derive(Clone, Copy, Debug, Default)]
struct MeanMoment {
    value: f64,
    over_approaches: BySide<f64>,
    over_difference: f64,
}

/// Mean of Q_i Q_o between two x, N^2, and its growth with the approaches and with both x.
struct MeanProduct {
    value: f64,
    over_approaches: BySide<f64>,
    over_ends: [f64; 2],
}

/// A ball over a step.
struct BallStep<'s> {
    contacts: &'s BallContacts,
    lengths: &'s BallLengths,
    /// By which angles l turns, rad.
    turns: BySide<f64>,
    /// Differences of the contact angles at start and end, rad.
    differences: [f64; 2],
    /// x there.
    x: [AcrossGrowth; 2],
}

impl<'s> BallStep<'s> {
    fn new(contacts: &'s BallContacts, lengths: &'s BallLengths) -> BallStep<'s> {
        let turns = lengths.l.map(turn);
        let start = difference(lengths.at(0));
        let differences = [start, start + (turns[0] - turns[1])];
        BallStep {
            contacts,
            lengths,
            turns,
            differences,
            x: differences.map(|angle| contacts.across.at(angle)),
        }
    }

    fn mean_across(&self) -> f64 {
        0.5 * (self.x[0].value + self.x[1].value)
    }

    /// The couple, also beside pointwise forces.
    fn moment(&self) -> MeanMoment {
        let ([start, end], middle) = (self.x, self.mean_across());
        let [d0, d1] = self.lengths.approaches();
        let first = self.mean_product(d0, [start.value, middle]);
        let last = self.mean_product(d1, [middle, end.value]);
        let [slope, growth] = self
            .contacts
            .across
            .between(self.differences[0], self.differences[1]);
        let product = 0.5 * (first.value + last.value);
        let over_x = 0.25 * first.over_ends[1] + 0.25 * last.over_ends[0] + 0.5 * last.over_ends[1];
        MeanMoment {
            value: -product * slope,
            over_approaches: last.over_approaches.map(|growth| -0.5 * growth * slope),
            over_difference: -(over_x * end.slope * slope + product * growth),
        }
    }

    fn mean_product(&self, g: BySide<f64>, ends: [f64; 2]) -> MeanProduct {
        let change = ends[1] - ends[0];
        let middle = self.contacts.at(0.5 * (ends[0] + ends[1])).evaluate(g);
        let forces = middle.contacts.map(|contact| contact.force);
        let least = middle
            .contacts
            .iter()
            .fold(f64::INFINITY, |least, contact| least.min(contact.approach.abs()));
        if change.abs() * forces[0].max(forces[1]) <= SMALL_CHANGE * least {
            let [value, over_x] = product(&middle);
            let growth = |j: usize| forces[1] * middle.tangent[0][j] + forces[0] * middle.tangent[1][j];
            return MeanProduct {
                value,
                over_approaches: [growth(0), growth(1)],
                over_ends: [0.5 * over_x; 2],
            };
        }
        let [start, end] = ends.map(|x| self.contacts.at(x).evaluate(g));
        let energy = |at: &BallForces| at.contacts[0].energy + at.contacts[1].energy;
        let value = (energy(&start) - energy(&end)) / change;
        let growth = |j: usize| (start.contacts[j].force - end.contacts[j].force) / change;
        MeanProduct {
            value,
            over_approaches: [growth(0), growth(1)],
            over_ends: [
                (value - product(&start)[0]) / change,
                (product(&end)[0] - value) / change,
            ],
        }
    }

    fn laterals(&self, end: usize) -> BySide<Lateral> {
        let found = self.contacts.instant(
            self.lengths.approaches()[end],
            self.lengths.at(end).map(Meridian::from),
        );
        found.1.unwrap_or_default()
    }

    /// Adds the couple, and the growth of the normal forces with the angle.
    fn add(&self, moment: &MeanMoment, result: &mut BallMeans) {
        let ends = self.lengths.at(1);
        let turned = [0, 1].map(|j| across_normal(unit(ends[j])).map(|t| SIGNS[j] * t / size(ends[j])));
        for k in 0..2 {
            let l = self.lengths.l[k];
            let (vector, slope) = turning(l, self.turns[k]);
            let vector = vector.map(|x| SIGNS[k] * x);
            let normal = result.over_across[k] * self.x[1].slope;
            let contact = &mut result.contacts[k];
            (0..2).for_each(|i| contact.force[i] += moment.value * vector[i]);
            for (j, turned) in turned.iter().enumerate() {
                let block = match j == k {
                    true => &mut contact.tangent,
                    false => &mut result.across[k],
                };
                add(outer(normal, mean_direction(l), *turned), block);
                add(outer(moment.over_approaches[j], vector, unit(ends[j])), block);
                add(outer(moment.over_difference, vector, *turned), block);
            }
            add(
                slope.map(|row| row.map(|x| SIGNS[k] * moment.value * x)),
                &mut contact.tangent,
            );
        }
    }

    /// Adds `share` times the change of the forces across the normals over the step, and how those along them grow
    /// with the angle; no sum pulls.
    fn add_change(&self, share: f64, result: &mut BallMeans) {
        let laterals = [0, 1].map(|end| self.laterals(end));
        let ends = self.lengths.at(1);
        let place = (ends.map(unit), [[0.0; 2]; 2], ends.map(size));
        for k in 0..2 {
            let contact = &mut result.contacts[k];
            let (before, [l0, l1]) = (contact.force, self.lengths.l[k]);
            let [start, end] =
                [(0, l0), (1, l1)].map(|(end, l)| laterals[end][k].force(unit(l).into(), size(l)).to_array());
            (0..2).for_each(|i| contact.force[i] += share * (end[i] - start[i]));
            let own = laterals[1][k].tangent(unit(l1).into(), size(l1));
            add(own.map(|row| row.map(|x| share * x)), &mut contact.tangent);
            drop_pull([l0[0] + l1[0], l0[1] + l1[1]], contact);
            contact.numerical_loss += (0..2)
                .map(|i| (contact.force[i] - before[i]) * (l1[i] - l0[i]))
                .sum::<f64>();
            let other = of_other(k, 0.0, Some(&laterals[1]), place);
            add(other.map(|row| row.map(|x| share * x)), &mut result.across[k]);
        }
    }
}

#[cfg(test)]
mod tests;
