//! Where balls rest that no contact holds.

use contact::{BySide, Meridian, Side};

use crate::bearing::BearingParts;
use crate::displacements::Displacements;
use crate::footprint::{least_load, sizes};
use crate::interactions::raceway_contact::{Site, on_rings};

/// Unloaded balls rest midway between their raceways: those without a load of their own that are not squeezed between
/// both. A ball that Newton left touching a raceway, with a force below its residual, is unloaded. One that would touch
/// there, beside a profile, stays where it is.
pub fn centre_unloaded(parts: &BearingParts, u: &mut Displacements) {
    let loads: Vec<f64> = (0..parts.balls.len())
        .map(|ball| parts.ball_load(ball).norm())
        .collect();
    // The weight of a ball across its meridian plane leaves round-off in that plane.
    let weightless = 4.0 * f64::EPSILON * loads.iter().copied().fold(0.0, f64::max);
    let states = parts.states_at(u);
    let forces = on_rings(&states);
    let least = least_load(sizes(&forces));
    let found = u.balls.clone();
    let pairs = parts.contacts.sites.chunks_exact(2).zip(states.chunks_exact(2));
    for ((pair, states), forces) in pairs.zip(forces.chunks_exact(2)) {
        let ball = pair[0].ball;
        if forces.iter().all(|force| force.norm() > least) || loads[ball] > weightless {
            continue;
        }
        u.balls[ball] = u.balls[ball] + to_middle(pair, [states[0].reach(), states[1].reach()]);
    }
    if u.balls == found {
        return;
    }
    let there = on_rings(&parts.states_at(u));
    for (site, force) in parts.contacts.sites.iter().zip(&there) {
        if u.balls[site.ball] != found[site.ball] && force.norm() > least {
            u.balls[site.ball] = found[site.ball];
        }
    }
}

/// From a ball at these l to the point of equal gap on the line of its groove centres, m.
fn to_middle(pair: &[Site], reach: BySide<Meridian>) -> Meridian {
    debug_assert!([pair[0].side, pair[1].side] == Side::BOTH);
    let centres = reach.map(|l| l.map(|l| -l));
    let middle = |touching: BySide<f64>| {
        let [inner, outer] = centres;
        contact::geometry::midway(inner, outer, touching[0], touching[1])
    };
    let smooth = middle([pair[0].touching, pair[1].touching]);
    let direction = reach.map(|l| l + smooth);
    middle([0, 1].map(|i| pair[i].touching_along(direction[i])))
}
