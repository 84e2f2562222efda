//! Damage of a raceway at positions round it, and the life that follows: ISO 16281 for a bearing at rest, and the
//! same formula by counting passes for any history.
//!
//! A raceway has K positions in its own frame. Every ball that passes a position with the force Q takes the share
//! (Q / Q_c)^3 / (10^6 n_p) of its life, where n_p counts the passes over a position per turn of the inner ring
//! against the outer one: Z (1 + gamma) / 2 inside, Z (1 - gamma) / 2 outside. So a raceway under constant Q_c lives
//! 10^6 turns. The survivals of the positions multiply, with Weibull's slope e = 10/9:
//!
//! ```text
//! 1/L(theta) = damage of the passes at theta / turns
//! L_ring^-e = mean of L(theta)^-e over the positions,      L^-e = L_inner^-e + L_outer^-e
//! ```
//!
//! Under loads fixed in space a ring at rest has the equivalent force (mean Q^(10/3))^(3/10), one that turns
//! (mean Q^3)^(1/3), which are the formulas of ISO 16281:2025.
//!
//! **A history is one cycle that goes on for ever.** Where balls roll on in one direction over a raceway, every
//! position comes to be passed as often as any other: the forces at a position are those of its own passes, their
//! number is the mean one. Where balls go to and fro, passes are counted as they are. Positions that a short history
//! has not passed lie between two that it has, and take what is between. Cost: rows times balls.
//!
//! Between two rows of a history the damage (Q / Q_c)^3 of a ball is linear along its way, so that rows at any distance
//! keep its mean; [`crate::spacing`] says what distant rows leave open.

use std::f64::consts::TAU;

use contact::Side;
use dynamics::kinematics::BothRings;

use crate::error::LifeError;

/// Weibull's slope of ball bearings (ISO 281).
pub const WEIBULL: f64 = 10.0 / 9.0;
/// Turns that a raceway lives at its rating.
pub const MILLION: f64 = 1e6;
/// Least number of positions.
const POSITIONS: usize = 360;
/// Positions that balls must cross at least when they go to and fro.
const LEAST_SWING: f64 = 5.0;
/// Turning of balls on a raceway between two rows that is round-off, rad.
const STILL: f64 = 1e-9;

/// Damage of the positions of a raceway: 10^6 revolutions over the life at each, `[n_positions]`. Position p stands at
/// the azimuth 2 pi (p + 1/2) / n_positions in the frame of the ring.
pub type Damage = Vec<f64>;

/// Number of positions: 360, or the next multiple of the number of balls.
pub fn n_positions(n_balls: usize) -> usize {
    n_balls * POSITIONS.div_ceil(n_balls)
}

/// Whether a ring turns under loads that are fixed in space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RingMotion {
    /// Every position meets all forces.
    Turns,
    /// Every position keeps its force.
    Stands,
}

/// Damage of a raceway of a bearing whose balls keep their forces, N, `[n_balls]`; ball 0 stands at `first_azimuth`,
/// rad. Every ball stands for the arc up to half way to its neighbours.
pub fn at_rest(forces: &[f64], rating: f64, first_azimuth: f64, motion: RingMotion) -> Damage {
    let n = n_positions(forces.len());
    let damage = |force: &f64| (force / rating).powi(3);
    if motion == RingMotion::Turns {
        let mean = forces.iter().map(damage).sum::<f64>() / forces.len() as f64;
        return vec![mean; n];
    }
    let per_ball = n / forces.len();
    let first = (first_azimuth.rem_euclid(TAU) / TAU * n as f64).round() as usize;
    let of = |position: usize| &forces[(position + n - first % n + per_ball / 2) % n / per_ball];
    (0..n).map(|position| damage(of(position))).collect()
}

/// What happened in a bearing that turned.
#[derive(Clone, Debug, Default)]
pub struct History {
    /// Azimuth of the balls in space, rad, without jumps, `[n_rows][n_balls]`.
    pub azimuths: Vec<Vec<f64>>,
    /// Angles of the rings, rad, inner first, `[n_rows]`.
    pub ring_angles: Vec<BothRings>,
    /// Contact forces, N, inner first, `[n_rows][n_balls]`.
    pub forces: Vec<Vec<BothRings>>,
}

impl History {
    /// Turns of the inner ring against the outer one, to and fro.
    pub fn turns(&self) -> f64 {
        let relative = |[inner, outer]: BothRings| inner - outer;
        let steps = self.ring_angles.windows(2);
        steps
            .map(|w| (relative(w[1]) - relative(w[0])).abs())
            .sum::<f64>()
            / TAU
    }

    /// Damage of a raceway of the rating Q_c, N, over which `passes_per_turn` balls roll per turn of the rings.
    pub fn damage(&self, side: Side, rating: f64, passes_per_turn: f64) -> Result<Damage, LifeError> {
        let turns = self.turns();
        if turns <= 0.0 {
            return Err(LifeError::NoTurning);
        }
        let n_balls = self.azimuths[0].len();
        let mut count = Count::new(n_positions(n_balls));
        for ball in 0..n_balls {
            for row in 1..self.azimuths.len() {
                let [from, to] = [row - 1, row].map(|row| BallPlace {
                    place: self.azimuths[row][ball] - self.ring_angles[row][side.index()],
                    damage: (self.forces[row][ball][side.index()] / rating).powi(3),
                });
                count.roll(from, to);
            }
        }
        let scale = 1.0 / (passes_per_turn * turns);
        if self.goes_on(side) {
            return count
                .rolled_on(scale)
                .ok_or(LifeError::TooShort { side: side.name() });
        }
        let swing = self.swing(side);
        let least = LEAST_SWING * TAU / count.passes.len() as f64;
        if swing < least {
            return Err(LifeError::SmallSwing {
                side: side.name(),
                swing: swing.to_degrees(),
                least: least.to_degrees(),
            });
        }
        Ok(count.damage.iter().map(|damage| damage * scale).collect())
    }

    /// Mean place of the balls on a raceway, rad.
    fn place(&self, row: usize, side: Side) -> f64 {
        let azimuths = &self.azimuths[row];
        azimuths.iter().sum::<f64>() / azimuths.len() as f64 - self.ring_angles[row][side.index()]
    }

    /// Whether the balls roll in one direction over a raceway.
    fn goes_on(&self, side: Side) -> bool {
        let steps = 1..self.azimuths.len();
        let steps = steps.map(|row| self.place(row, side) - self.place(row - 1, side));
        let moves: Vec<f64> = steps.filter(|step| step.abs() > STILL).collect();
        moves.iter().all(|step| *step > 0.0) || moves.iter().all(|step| *step < 0.0)
    }

    /// Arc over which a ball goes to and fro, rad.
    fn swing(&self, side: Side) -> f64 {
        let places = (0..self.azimuths.len()).map(|row| self.place(row, side));
        let [low, high] = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        });
        high - low
    }
}

/// A ball on a raceway at a row.
#[derive(Clone, Copy)]
struct BallPlace {
    /// Angle in the frame of the ring, rad.
    place: f64,
    /// (Q / Q_c)^3.
    damage: f64,
}

/// Passes over the positions so far.
struct Count {
    /// Sum of (Q / Q_c)^3, `[n_positions]`.
    damage: Vec<f64>,
    /// Number of passes, `[n_positions]`.
    passes: Vec<usize>,
    /// Way of all balls, turns.
    way: f64,
}

impl Count {
    fn new(n: usize) -> Count {
        Count {
            damage: vec![0.0; n],
            passes: vec![0; n],
            way: 0.0,
        }
    }

    /// A ball rolls on; its damage is linear along the way. A force that is linear would cut its peaks off and make
    /// lives too long, twice for rows that are pitches apart.
    fn roll(&mut self, from: BallPlace, to: BallPlace) {
        let n = self.passes.len();
        let width = TAU / n as f64;
        let way = to.place - from.place;
        self.way += way.abs() / TAU;
        // Number of the last position at or before a place: both ends of a step take the same one, so that none is
        // passed twice or never.
        let before = |place: f64| (place / width - 0.5).floor() as i64;
        let (low, high) = (before(from.place.min(to.place)), before(from.place.max(to.place)));
        for number in low + 1..=high {
            let share = ((number as f64 + 0.5) * width - from.place) / way;
            let position = number.rem_euclid(n as i64) as usize;
            self.damage[position] += from.damage + share.clamp(0.0, 1.0) * (to.damage - from.damage);
            self.passes[position] += 1;
        }
    }

    /// Damage where balls roll on: mean of the passes of each position times the mean number of passes. None if no
    /// position was passed.
    fn rolled_on(&self, scale: f64) -> Option<Damage> {
        let n = self.passes.len();
        let passed: Vec<usize> = (0..n).filter(|&p| self.passes[p] > 0).collect();
        let (&first, &last) = (passed.first()?, passed.last()?);
        let mean = |p: usize| self.damage[p] / self.passes[p] as f64;
        let mut damage = vec![0.0; n];
        // Round the ring once, from each position that was passed to the next.
        let next = passed[1..].iter().copied().chain([first + n]);
        for (&from, to) in passed.iter().zip(next) {
            let (start, end) = (mean(from), mean(to % n));
            for p in from..to {
                let share = (p - from) as f64 / (to - from) as f64;
                damage[p % n] = (start + share * (end - start)) * scale * self.way;
            }
        }
        debug_assert!(last < n);
        Some(damage)
    }
}

/// Life of a ring, revolutions of one ring against the other; infinite without damage.
pub fn ring_life(damage: &[f64]) -> f64 {
    let sum: f64 = damage.iter().map(|d| d.powf(WEIBULL)).sum();
    MILLION * (sum / damage.len() as f64).powf(-1.0 / WEIBULL)
}

/// Life of both rings together, revolutions.
pub fn bearing_life(lives: BothRings) -> f64 {
    let sum: f64 = lives.iter().map(|life| life.powf(-WEIBULL)).sum();
    sum.powf(-1.0 / WEIBULL)
}

/// Life of a ring whose positions would all share its damage, revolutions: at least that of the ring.
pub fn even_life(damage: &[f64]) -> f64 {
    MILLION * damage.len() as f64 / damage.iter().sum::<f64>()
}
