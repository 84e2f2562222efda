//! Rounds of friction and temperature until both agree, or until the bearing has run away.
//!
//! ```text
//! temperatures -> clearance and ball forces -> friction -> temperatures ...    stop where none changes by 0.5 K
//! ```
//!
//! All temperatures follow one number: the power P that warms the bearing. A round solves the bearing at those of a P
//! and has its friction F; the steady state has F = P. Where friction changes little the next P is F. The slope of two
//! rounds, the *gain* dF/dP, shortens or lengthens the step where it is beyond 1/2 in size: thick oil has a gain below
//! -1, and rounds without that would go to and fro. Where warmer rings press harder it is positive; from 1 on a round
//! grows by more than it is warmed, as the bearing would: a runaway.
//!
//! Powers that are known to be too small and too large bound the next one, so that it is found where rounds cross. A
//! step beyond the limit of the scene goes half of the way there, twice at most before it goes to the limit: the first
//! one of cold oil is far too warm. A bearing that makes more heat at the limit than flows off there has run away. A
//! step to where the bearing has no equilibrium, as of a ring that comes loose, is halved until less than 0.5 K are
//! left.

use serde::Serialize;
use thiserror::Error;

use crate::network::{Network, OfBodies};

/// Change of all temperatures between rounds at which they agree, K.
pub const AGREES: f64 = 0.5;
/// Rounds before giving up.
const MOST_ROUNDS: usize = 50;
/// Size of a gain up to which rounds converge fast by themselves.
const SMALL_GAIN: f64 = 0.5;
/// Share of the way to the limit that is gone at once where less is left, so that a quarter of it is left after halves.
const LAST_SHARE: f64 = 0.25;

/// A round: the bearing at its temperatures.
#[derive(Clone, Debug, Serialize)]
pub struct Round<T> {
    /// Temperatures at which the bearing was solved, K: inner ring, outer ring, balls, shaft, housing.
    pub temperatures_k: OfBodies,
    /// Friction power there, W.
    pub power_w: f64,
    /// Largest change to the temperatures that this power makes, K.
    pub change_k: f64,
    /// What else is known of it.
    #[serde(flatten)]
    pub bearing: T,
}

/// How the rounds ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BalanceEnd {
    /// Friction and temperatures agree.
    Steady,
    /// A body has become warmer than the limit.
    Runaway,
}

/// The rounds, and where they lead to.
#[derive(Clone, Debug, Serialize)]
pub struct Balance<T> {
    /// How they ended.
    pub end: BalanceEnd,
    /// Temperatures that the last power makes, K.
    pub temperatures_k: OfBodies,
    /// Growth of friction over that of the heat which warms the bearing, of the last two rounds: below zero where
    /// friction falls; None where there were no two.
    pub gain: Option<f64>,
    /// All rounds.
    pub rounds: Vec<Round<T>>,
}

/// Rounds that do not end.
#[derive(Debug, Error)]
#[error(
    "temperatures still change by {change:.1} K after {rounds} rounds of friction and heat flow, to and fro; expected \
     0.5 K: friction jumps as the bearing warms, so that no temperature is steady; larger conductances make the jump \
     smaller"
)]
pub struct NotSteady {
    /// Number of rounds.
    pub rounds: usize,
    /// Change of the last one, K.
    pub change: f64,
}

/// Where the power that warms the bearing is looked for, W.
struct PowerSearch {
    /// Power that warms a body to the limit.
    limit: f64,
    /// Largest power at which friction makes more heat.
    below: f64,
    /// Least power at which friction makes less heat.
    above: Option<f64>,
    /// Least power at which the bearing had no equilibrium.
    failed: Option<f64>,
    /// Power of the round before, and friction there.
    last: Option<[f64; 2]>,
    gain: Option<f64>,
}

impl PowerSearch {
    /// Takes the friction that a power makes; whether it has halved its distance from that power.
    fn take(&mut self, power: f64, friction: f64) -> bool {
        match friction > power {
            true => self.below = self.below.max(power),
            false => self.above = Some(self.above.map_or(power, |above| above.min(power))),
        }
        let before = self.last.replace([power, friction]);
        self.gain = before.map(|[p, f]| (friction - f) / (power - p));
        before.is_none_or(|[p, f]| (friction - power).abs() <= 0.5 * (f - p).abs())
    }

    /// Factor from the last change of friction to the distance of the steady state.
    fn factor(&self) -> f64 {
        match self.gain {
            Some(gain) if gain >= 1.0 => f64::MAX,
            Some(gain) if gain.abs() > SMALL_GAIN => 1.0 / (1.0 - gain),
            _ => 1.0,
        }
    }

    /// The next power after a round at which friction has come nearer to it or not.
    fn next(&self, power: f64, friction: f64, is_nearer: bool) -> f64 {
        let next = power + self.factor() * (friction - power);
        let middle = |top: f64| 0.5 * (self.below + top);
        match (self.above, self.failed) {
            (Some(above), _) if !is_nearer || next <= self.below || next >= above => middle(above),
            (_, Some(failed)) if next >= failed => middle(failed),
            (None, None) if next >= self.limit && self.limit - self.below <= LAST_SHARE * self.limit => {
                self.limit
            }
            (None, None) if next >= self.limit => middle(self.limit),
            _ => next,
        }
    }
}

/// Rounds from the temperature of the surroundings on; `friction` gives the power, W, of the bearing at its
/// temperatures, K, and what else is known of it.
pub fn settle<T, E: From<NotSteady>>(
    network: &Network<'_>,
    limit: f64,
    mut friction: impl FnMut(OfBodies) -> Result<(f64, T), E>,
) -> Result<Balance<T>, E> {
    let at = |power: f64| network.steady(network.heat(power));
    let kelvin_per_watt = warmest(at(1.0), network.ambient);
    let mut search = PowerSearch {
        limit: (limit - network.ambient) / kelvin_per_watt,
        below: 0.0,
        above: None,
        failed: None,
        last: None,
        gain: None,
    };
    let mut rounds: Vec<Round<T>> = Vec::new();
    let mut power = 0.0;
    loop {
        let (made, bearing) = match friction(at(power)) {
            Ok(made) => made,
            Err(error) if kelvin_per_watt * (power - search.below) <= AGREES => return Err(error),
            Err(_) => {
                search.failed = Some(power);
                power = 0.5 * (search.below + power);
                continue;
            }
        };
        let change = kelvin_per_watt * (made - power).abs();
        rounds.push(Round {
            temperatures_k: at(power),
            power_w: made,
            change_k: change,
            bearing,
        });
        let is_nearer = search.take(power, made);
        let is_runaway = power >= search.limit && made > power;
        // What a last plain step is off by, where friction grows with temperature.
        let is_off = (search.factor() - 1.0) * change;
        let is_steady = made <= search.limit && change <= AGREES && is_off <= AGREES;
        if is_runaway || is_steady {
            return Ok(Balance {
                end: if is_runaway {
                    BalanceEnd::Runaway
                } else {
                    BalanceEnd::Steady
                },
                temperatures_k: at(made),
                gain: search.gain,
                rounds,
            });
        }
        if rounds.len() == MOST_ROUNDS {
            let rounds = rounds.len();
            return Err(NotSteady { rounds, change }.into());
        }
        power = search.next(power, made, is_nearer);
    }
}

/// Rise of the warmest body over the surroundings, K.
fn warmest(temperatures: OfBodies, ambient: f64) -> f64 {
    let rises = temperatures.map(|kelvin| kelvin - ambient);
    rises.into_iter().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use scene::SURROUNDINGS;

    use super::*;
    use crate::network::{INNER, OUTER};

    /// Two equal rings, 1 W/K each: P watts warm them by P/2.
    const CONDUCTANCES: [([usize; 2], f64); 2] = [([INNER, SURROUNDINGS], 1.0), ([OUTER, SURROUNDINGS], 1.0)];

    fn settled(power: impl Fn(f64) -> f64) -> Result<Balance<()>, NotSteady> {
        let network = Network {
            conductances: &CONDUCTANCES,
            ambient: 293.15,
        };
        settle(&network, 393.15, |temperatures| {
            Ok::<_, NotSteady>((power(temperatures[INNER] - 293.15), ()))
        })
    }

    /// Wrong: friction that grows with temperature would not warm the bearing by its sum: P = 20 W (1 + 0.04 T/K) with
    /// 2 W/K has T = 10/(1 - 0.4) K, with a gain of 0.4; rounds stop within 0.5 x 0.4/0.6 K.
    #[test]
    fn a_gain_below_one_ends_at_the_sum_of_its_rounds() {
        let found = settled(|rise| 20.0 * (1.0 + 0.04 * rise)).unwrap();
        assert_eq!(found.end, BalanceEnd::Steady);
        assert!((found.temperatures_k[INNER] - 293.15 - 10.0 / 0.6).abs() < 0.34);
        assert!((found.gain.unwrap() - 0.4).abs() < 1e-9);
    }

    /// Wrong: a bearing that seizes would be reported as steady. A gain of 1.2 has no steady state.
    #[test]
    fn a_gain_above_one_runs_away() {
        let found = settled(|rise| 20.0 * (1.0 + 0.12 * rise)).unwrap();
        assert_eq!(found.end, BalanceEnd::Runaway);
        assert!((found.gain.unwrap() - 1.2).abs() < 1e-9);
        assert!(found.temperatures_k[INNER] > 393.15);
    }

    /// Wrong: the thick oil of a cold start would be taken for a runaway. P = 400 W / (1 + T/10 K): T (1 + T/10) = 200
    /// has T = 40 K, and the first round would be 200 K.
    #[test]
    fn a_first_round_that_is_too_warm_is_no_runaway() {
        let found = settled(|rise| 400.0 / (1.0 + rise / 10.0)).unwrap();
        assert_eq!(found.end, BalanceEnd::Steady);
        assert!(
            (found.temperatures_k[INNER] - 293.15 - 40.0).abs() < 0.5,
            "{:?}",
            found.temperatures_k
        );
        assert!(
            found
                .rounds
                .iter()
                .all(|round| round.temperatures_k[INNER] < 393.15 + 1e-9)
        );
    }

    /// Wrong: rounds that go to and fro over a jump of friction would never end.
    #[test]
    fn rounds_that_go_to_and_fro_are_said() {
        let said = settled(|rise| if rise > 20.0 { 10.0 } else { 60.0 })
            .unwrap_err()
            .to_string();
        let parts = [
            "after 50 rounds of friction and heat flow, to and fro;",
            "friction jumps",
        ];
        assert!(parts.iter().all(|part| said.contains(part)), "{said}");
    }

    /// Wrong: thick oil would be said to have no steady state, though friction that falls with temperature always has
    /// one. P = 2000 W exp(-T/b) with 2 W/K: T = 10, 40, 70 K for b = T/ln(1000/T), gains of -T/b = -4.6 to -2.7.
    #[test]
    fn friction_that_falls_steeply_has_its_steady_state() {
        for rise in [10.0, 40.0, 70.0, 99.0] {
            let fall = rise / f64::ln(1000.0 / rise);
            let found = settled(|rise| 2000.0 * f64::exp(-rise / fall)).unwrap();
            assert_eq!(found.end, BalanceEnd::Steady);
            let kelvin = found.temperatures_k[INNER];
            assert!((kelvin - 293.15 - rise).abs() < 0.5, "{rise}: {kelvin}");
            assert!(found.rounds.len() <= 13, "{rise}: {} rounds", found.rounds.len());
            assert!(
                (found.gain.unwrap() * fall / rise + 1.0).abs() < 0.15,
                "{rise}: {:?}",
                found.gain
            );
        }
    }

    /// Wrong: friction that grows almost as fast as it warms would end far from its steady state, by 0.5 K of 50 K: a
    /// gain of 0.95 would end 9.5 K before it. And beyond a dip of friction, where a bearing would run away, it would
    /// not be found: 200 W exp(-T/5 K) + 10 W + T^2/50 W/K^2 meets 2 W/K at 13.5 K.
    #[test]
    fn a_gain_near_one_and_a_dip_end_at_the_steady_state() {
        let found = settled(|rise| 5.0 * (1.0 + 0.38 * rise)).unwrap();
        assert_eq!(found.end, BalanceEnd::Steady);
        assert!((found.temperatures_k[INNER] - 293.15 - 50.0).abs() < 0.5);
        let dip = |rise: f64| 200.0 * f64::exp(-rise / 5.0) + 10.0 + 0.02 * rise * rise;
        let found = settled(dip).unwrap();
        let rise = found.temperatures_k[INNER] - 293.15;
        assert_eq!(found.end, BalanceEnd::Steady);
        assert!((rise - 13.5).abs() < 0.5, "{rise}");
    }

    /// Wrong: rounds on the way would end the search where the bearing has no equilibrium, as where a ring comes loose,
    /// though the steady state lies before: 40 K, of 60 K. One at 40 K of 30 K is not there.
    #[test]
    fn a_round_without_equilibrium_is_tried_again_nearer() {
        let network = Network {
            conductances: &CONDUCTANCES,
            ambient: 293.15,
        };
        let settled = |most: f64| {
            settle(&network, 393.15, |temperatures| {
                let rise = temperatures[INNER] - 293.15;
                match rise < most {
                    true => Ok((400.0 / (1.0 + rise / 10.0), ())),
                    false => Err(NotSteady {
                        rounds: 0,
                        change: rise,
                    }),
                }
            })
        };
        let found = settled(45.0).unwrap();
        assert_eq!(found.end, BalanceEnd::Steady);
        assert!((found.temperatures_k[INNER] - 293.15 - 40.0).abs() < 0.5);
        let lost = settled(30.0).unwrap_err();
        assert!(lost.rounds == 0 && (lost.change - 30.0).abs() < 0.5, "{lost:?}");
    }

    /// Wrong: friction that does not depend on temperature would take more than a look back.
    #[test]
    fn constant_friction_is_steady_at_once() {
        let found = settled(|_| 30.0).unwrap();
        assert_eq!((found.end, found.rounds.len()), (BalanceEnd::Steady, 2));
        assert_eq!(found.temperatures_k[INNER], 293.15 + 15.0);
    }
}
