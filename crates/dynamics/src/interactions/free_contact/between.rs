//! Both contacts of a free ball, which yields as a sphere: each by x times the force of the other one.
//!
//! Normal forces and what stands across them are those of kinematic balls
//! ([`crate::interactions::between_contacts`]), of l and contact angles that each ring sees: their work is exactly the
//! change of the energy V(g_i, g_o, x). The difference of the angles leaves out the tilt of the rings against each
//! other, of which x changes by x' times it: some 1e-5 of x at 0.1 mrad.
//!
//! Newton's tangent of a contact has how its force grows as the ball comes nearer to the other ring, exactly; how it
//! grows as that ring moves is left out: x times the stiffness of a contact, a hundredth, and of rings that inertia
//! holds over a step less than that.

use contact::Meridian;

use super::contact::{ContactStep, FoundContact, Pressed, StandingOver, chain, reach_of};
use super::jet::{Jet, N_LENGTHS};
use super::ring_step::BALL_LENGTHS;
use crate::interactions::between_contacts::BallContacts;
use crate::interactions::discrete_gradient::{BallLengths, BallMeans};

/// Weight of the start in means that conserve energy.
const MIDDLE: f64 = 0.5;

/// Both contacts of a ball at lengths at start and end; those on real surfaces have forces of their own.
pub fn evaluate(contacts: &[ContactStep; 2], lengths: [[[f64; N_LENGTHS]; 2]; 2]) -> [FoundContact; 2] {
    let placed = [0, 1].map(|k| contacts[k].placed(lengths[k]));
    let over = [0, 1].map(|k| contacts[k].over_surface(&placed[k]));
    let mut means = means(contacts, &placed);
    for (mean, over) in means.contacts.iter_mut().zip(&over) {
        over.iter().for_each(|over| *mean = over.normal);
    }
    let [first, last] = [0, 1].map(|k| pressed(k, &means, &placed));
    let ([at_inner, at_outer], [over_inner, over_outer]) = (placed, over);
    [
        contacts[0].found(at_inner, first, over_inner),
        contacts[1].found(at_outer, last, over_outer),
    ]
}

fn means(contacts: &[ContactStep; 2], placed: &[StandingOver; 2]) -> BallMeans {
    let [inner, outer] = contacts;
    let ball = BallContacts {
        laws: [inner.law, outer.law],
        across: inner.across,
    };
    let l = [0, 1].map(|k| [&placed[k].start, &placed[k].last].map(reach_of));
    let at = BallLengths {
        touching: [inner.touching, outer.touching],
        l: l.map(|l| l.map(Meridian::to_array)),
    };
    let viscous = inner.viscous(l[0]).zip(outer.viscous(l[1])).map(|(a, b)| [a, b]);
    ball.mean_forces(&at, (inner.scheme, MIDDLE), viscous)
}

/// The normal force of contact `k` as it grows with its lengths.
fn pressed(k: usize, means: &BallMeans, placed: &[StandingOver; 2]) -> Pressed {
    let (normal, of_other) = (means.contacts[k], means.across[k]);
    let other = placed[1 - k].last.reach.map(of_ball);
    let load = [0, 1].map(|i| {
        let mut own = chain(normal.force[i], normal.tangent[i].into(), placed[k].last.reach);
        let more = chain(0.0, of_other[i].into(), other);
        own.slope
            .iter_mut()
            .zip(more.slope)
            .for_each(|(sum, s)| *sum += s);
        own
    });
    Pressed { normal, load }
}

/// A number as it grows with the lengths that both contacts of a ball share.
fn of_ball(mut x: Jet) -> Jet {
    x.slope[BALL_LENGTHS..].fill(0.0);
    x
}
