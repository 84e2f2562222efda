//! The next loads of a fixed point that full passes reach slowly or not at all.
//!
//! Anderson's mixing (J. ACM 12 (1965) 547; Walker and Ni, SIAM J. Numer. Anal. 49 (2011) 1715): of the loads of the
//! last passes and those that they gave, the mean is taken whose change would be least if the pass were linear. With
//! one earlier pass and one unknown it is Aitken's rule. Full passes are taken until one contracts slowly.

use contact::Meridian;

use crate::effects::Loads;

/// Contraction of a pass above which passes are mixed.
const SLOW_PASS: f64 = 0.5;
/// Earlier passes that are mixed.
const MOST_PASSES: usize = 6;
/// Share of a pass's own bend below which it is taken for one that the newer passes have already.
const INDEPENDENT: f64 = 1e-6;
/// Largest step over the change of a pass.
const LONGEST: f64 = 1000.0;

/// Passes so far.
#[derive(Default)]
pub struct Relaxation {
    /// Whether a pass has contracted slowly.
    mixes: bool,
    last: Option<LoadPass>,
    /// Differences of successive passes, the newest last.
    bends: Vec<LoadPass>,
}

/// Loads that a pass gave, and their change against those it began with, or the differences of both.
#[derive(Clone)]
struct LoadPass {
    /// All numbers that follow the angles.
    given: Vec<f64>,
    /// Change of the forces, N.
    change: Vec<f64>,
}

impl Relaxation {
    /// Puts the loads of the next pass in the place of `new`, which one that began with `old` gave. A first pass that
    /// began without any loads at contacts tells nothing of how they bend.
    pub fn mix(&mut self, old: &Loads, new: &mut Loads) {
        if old.contacts.len() != new.contacts.len() {
            return;
        }
        let (from, given) = (numbers(old), numbers(new));
        let n_forces = 2 * (new.contacts.len() + new.balls.len());
        let change = given.iter().zip(&from).take(n_forces);
        let pass = LoadPass {
            change: change.map(|(to, from)| to - from).collect(),
            given,
        };
        if let Some(last) = &self.last {
            let [before, now] = [&last.change, &pass.change].map(|change| dot(change, change));
            self.mixes |= now > SLOW_PASS * SLOW_PASS * before;
            if now > before {
                self.bends.clear();
            }
            self.bends.push(pass.since(last));
            if self.bends.len() > MOST_PASSES {
                self.bends.remove(0);
            }
        }
        if self.mixes {
            set_numbers(new, &self.mixed(&pass, &from));
        }
        self.last = Some(pass);
    }

    /// The mean of passes whose change would be least, with a step that is not too long.
    fn mixed(&self, pass: &LoadPass, from: &[f64]) -> Vec<f64> {
        // Orthogonal directions of change, newest first, with the loads that go with them.
        let mut directions: Vec<LoadPass> = Vec::new();
        for bend in self.bends.iter().rev() {
            let (mut rest, whole) = (bend.clone(), dot(&bend.change, &bend.change));
            for direction in &directions {
                let share = dot(&direction.change, &rest.change) / dot(&direction.change, &direction.change);
                rest.subtract(share, direction);
            }
            if dot(&rest.change, &rest.change) > INDEPENDENT * INDEPENDENT * whole {
                directions.push(rest);
            }
        }
        let mut mixed = pass.clone();
        for direction in &directions {
            let share = dot(&direction.change, &mixed.change) / dot(&direction.change, &direction.change);
            mixed.subtract(share, direction);
        }
        let step: Vec<f64> = mixed.given.iter().zip(from).map(|(to, from)| to - from).collect();
        let forces = &step[..pass.change.len()];
        let longest = LONGEST * dot(&pass.change, &pass.change).sqrt();
        let part = (longest / dot(forces, forces).sqrt()).min(1.0);
        from.iter()
            .zip(&step)
            .map(|(from, step)| from + part * step)
            .collect()
    }
}

impl LoadPass {
    /// Difference to an earlier pass.
    fn since(&self, earlier: &LoadPass) -> LoadPass {
        let mut bend = self.clone();
        bend.subtract(1.0, earlier);
        bend
    }

    fn subtract(&mut self, share: f64, other: &LoadPass) {
        let pairs = [(&mut self.given, &other.given), (&mut self.change, &other.change)];
        for (own, other) in pairs {
            own.iter_mut()
                .zip(other)
                .for_each(|(own, other)| *own -= share * other);
        }
    }
}

/// Loads that may follow the contact angles, N: those of the contacts, then of the balls.
pub fn following(loads: &Loads) -> Vec<Meridian> {
    [loads.contacts.as_slice(), &loads.balls].concat()
}

/// All numbers that may follow the angles: the forces of [`following`], N, then slopes, N/m, and loads of the shaft.
fn numbers(loads: &Loads) -> Vec<f64> {
    let forces = following(loads).into_iter().flat_map(|f| [f.radial, f.axial]);
    forces
        .chain(loads.ball_slopes.iter().copied())
        .chain(loads.shaft)
        .collect()
}

fn set_numbers(loads: &mut Loads, numbers: &[f64]) {
    let mut numbers = numbers.iter().copied();
    let mut put = |place: &mut f64| *place = numbers.next().unwrap_or(*place);
    for force in loads.contacts.iter_mut().chain(&mut loads.balls) {
        put(&mut force.radial);
        put(&mut force.axial);
    }
    loads.ball_slopes.iter_mut().chain(&mut loads.shaft).for_each(put);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Passes until loads of two balls rest, of which a pass leaves these shares of their distances to 1 N.
    fn passes(shares: [f64; 2]) -> usize {
        let mut loads = Loads::none(2);
        let mut relaxation = Relaxation::default();
        for pass in 1..100 {
            let mut next = loads.clone();
            for (ball, share) in next.balls.iter_mut().zip(shares) {
                ball.radial = 1.0 + share * (ball.radial - 1.0);
            }
            let change = following(&next).into_iter().zip(following(&loads));
            if change.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) < 1e-10 {
                return pass;
            }
            relaxation.mix(&loads, &mut next);
            loads = next;
        }
        panic!("{shares:?}: {:?}", loads.balls);
    }

    /// Wrong: where only the second pass has loads at contacts, its numbers would be set against others of the first:
    /// slopes against forces.
    #[test]
    fn passes_with_and_without_loads_at_contacts_are_not_compared() {
        let mut relaxation = Relaxation::default();
        let given = Loads {
            contacts: vec![Meridian::from([1.0, 2.0]); 4],
            ..Loads::none(2)
        };
        let mut next = given.clone();
        relaxation.mix(&Loads::none(2), &mut next);
        assert!(next == given && relaxation.last.is_none());
        relaxation.mix(&given, &mut next);
        assert!(relaxation.last.is_some_and(|pass| pass.change == [0.0; 12]));
    }

    /// Wrong: a ball whose load goes back and forth would keep all others from settling, which creep by small shares.
    /// Two unknowns take two passes to see how they bend.
    #[test]
    fn loads_that_creep_settle_beside_those_that_swing() {
        assert!(passes([0.97, -3.0]) <= 6);
        assert!(passes([0.99, -0.9]) <= 6);
        // Fast passes are taken as they are.
        assert_eq!(passes([0.1, 0.1]), 11);
    }
}
