//! Whether the rows of a history lie close enough for its life.
//!
//! Between two rows the damage (Q / Q_c)^3 of a ball is linear along its way. That keeps the mean of the damage,
//! whatever the distance of the rows, and so the life of a ring that turns under loads which stand. A ring on which the
//! loads stand needs the damage at its place, which distant rows smear. Another count tells how much is open: were
//! forces linear instead, a step of a ball from the force a to b would do
//!
//! ```text
//! (a^3 + a^2 b + a b^2 + b^3) / 4    in place of    (a^3 + b^3) / 2,    less by    (a + b) (a - b)^2 / 4
//! ```
//!
//! The doubt is the sum of what is less over the damage of all steps, from 0 where forces stay to 1/2 where every other
//! one is 0. It grows with the square of the distance. Measured with loads on a quarter, a half and all of the round,
//! 7 to 25 balls, rows 0.1 to 4.3 ball pitches apart: a doubt up to 0.2 makes the life of a ring on which loads stand
//! too long by a seventh of it. Above that, rows may also meet the same places again and again: lives were off by up to
//! 20 %, and by a third with seven balls and rows a pitch apart. Cost: rows times balls.

use std::f64::consts::TAU;

use contact::Side;
use scene::CLOSE_ROWS;

use crate::damage::History;

/// Doubt from which a reader is told: a hundredth of the life of a ring.
const NOTABLE: f64 = 0.07;
/// Doubt up to which the error is its seventh.
const SMALL: f64 = 0.2;
/// Distance of rows from which the doubt no longer grows with its square, pitches.
const WIDE: f64 = 1.0;

/// How far apart rows lie.
#[derive(Clone, Copy, Debug)]
pub struct Spacing {
    /// Mean way of a ball in space from row to row, weighed by itself, ball pitches.
    pub pitches: f64,
    /// Share of the damage that is open, of the ring with the larger one.
    pub doubt: f64,
}

impl Spacing {
    /// Of the rows of a history.
    pub fn of(history: &History) -> Spacing {
        let pitches = pitches(history);
        Spacing {
            pitches,
            doubt: Side::BOTH
                .map(|side| doubt(history, side, pitches))
                .into_iter()
                .fold(0.0, f64::max),
        }
    }

    /// Whether a reader must know.
    pub fn is_too_wide(&self) -> bool {
        self.doubt > NOTABLE
    }

    /// Part of the distance that would do.
    pub fn needed(&self) -> f64 {
        match self.pitches >= WIDE {
            true => CLOSE_ROWS / self.pitches,
            false => (NOTABLE / self.doubt).sqrt(),
        }
    }

    /// How much lives may be off, in words.
    pub fn error(&self) -> String {
        match self.doubt <= SMALL {
            true => format!("about {:.0} %", 100.0 * self.doubt / 7.0),
            false => "up to a third".to_string(),
        }
    }
}

/// Longer ways count more: errors grow with the square of the way, and the damage with the way.
fn pitches(history: &History) -> f64 {
    let (mut squares, mut sum) = (0.0, 0.0);
    for rows in history.azimuths.windows(2) {
        for (from, to) in rows[0].iter().zip(&rows[1]) {
            let way = (to - from).abs();
            squares += way * way;
            sum += way;
        }
    }
    let n_balls = history.azimuths[0].len() as f64;
    if sum > 0.0 {
        squares / sum * n_balls / TAU
    } else {
        0.0
    }
}

fn doubt(history: &History, side: Side, pitches: f64) -> f64 {
    let i = side.index();
    let (mut along, mut across) = (StepDamage::default(), StepDamage::default());
    let half = history.azimuths[0].len() / 2;
    for row in 1..history.azimuths.len() {
        let [before, now] = [row - 1, row].map(|row| &history.forces[row]);
        for ball in 0..now.len() {
            let place = |row: usize| history.azimuths[row][ball] - history.ring_angles[row][i];
            let way = (place(row) - place(row - 1)).abs();
            along.add(way, before[ball][i], now[ball][i]);
            across.add(way, now[ball][i], now[(ball + half) % now.len()][i]);
        }
    }
    // Rows about a turn of the cage apart meet every ball at its old place: balls across from each other tell then
    // whether places differ.
    match pitches >= half as f64 {
        true => along.share().max(across.share()),
        false => along.share(),
    }
}

/// Damage of steps, and what of it is open.
#[derive(Default)]
struct StepDamage {
    open: f64,
    whole: f64,
}

impl StepDamage {
    /// A step of a ball from a force to another.
    fn add(&mut self, way: f64, a: f64, b: f64) {
        self.open += 0.25 * way * (a + b) * (a - b).powi(2);
        self.whole += 0.5 * way * (a.powi(3) + b.powi(3));
    }

    fn share(&self) -> f64 {
        if self.whole > 0.0 {
            self.open / self.whole
        } else {
            0.0
        }
    }
}
