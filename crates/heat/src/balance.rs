//! Rounds of friction and temperature until both agree, or until the bearing has run away.
//!
//! ```text
//! temperatures -> clearance and ball forces -> friction -> temperatures ...    stop where none changes by 0.5 K
//! ```
//!
//! A round is what the bearing would warm to if its friction stayed as it is. Where warmer rings press harder the
//! change of a round over that before, the *gain*, is positive; at 1 and above the rounds grow without end, as the
//! bearing would: a runaway. Cold oil makes a first round far too warm, though. So a round that would pass the limit of
//! the scene is taken back to it, all temperatures by one share: a bearing that makes more heat at the limit than flows
//! off there has run away.

use serde::Serialize;
use thiserror::Error;

use crate::network::{Network, OfBodies};

/// Change of all temperatures between rounds at which they agree, K.
pub const AGREES: f64 = 0.5;
/// Rounds before giving up.
const MOST_ROUNDS: usize = 50;

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
    /// Change of the last round over that before, of rounds within the limit; None where there were no two.
    pub gain: Option<f64>,
    /// All rounds.
    pub rounds: Vec<Round<T>>,
}

/// Rounds that do not end.
#[derive(Debug, Error)]
#[error(
    "temperatures still change by {change:.1} K after {rounds} rounds of friction and heat flow, to and fro; expected \
     0.5 K: friction falls too steeply with temperature for a steady state to be found; give larger conductances, or \
     heat.viscosity instead of a class"
)]
pub struct NotSteady {
    /// Number of rounds.
    pub rounds: usize,
    /// Change of the last one, K.
    pub change: f64,
}

/// Rounds from the temperature of the surroundings on; `friction` gives the power, W, of the bearing at its
/// temperatures, K, and what else is known of it.
pub fn settle<T, E: From<NotSteady>>(
    network: &Network<'_>,
    limit: f64,
    mut friction: impl FnMut(OfBodies) -> Result<(f64, T), E>,
) -> Result<Balance<T>, E> {
    let mut temperatures = [network.ambient; 5];
    let mut rounds: Vec<Round<T>> = Vec::new();
    let (mut gain, mut is_at_limit) = (None, false);
    loop {
        let (power, bearing) = friction(temperatures)?;
        let next = network.steady(network.heat(power));
        let change = (0..5)
            .map(|i| (next[i] - temperatures[i]).abs())
            .fold(0.0, f64::max);
        if let Some(before) = rounds.last().filter(|_| !is_at_limit) {
            gain = Some(change / before.change_k);
        }
        rounds.push(Round {
            temperatures_k: temperatures,
            power_w: power,
            change_k: change,
            bearing,
        });
        let warmest = next
            .iter()
            .fold(f64::NEG_INFINITY, |most: f64, kelvin| most.max(*kelvin));
        let end = match warmest > limit {
            true => is_at_limit.then_some(BalanceEnd::Runaway),
            false => (change <= AGREES).then_some(BalanceEnd::Steady),
        };
        if let Some(end) = end {
            return Ok(Balance {
                end,
                temperatures_k: next,
                gain,
                rounds,
            });
        }
        if rounds.len() == MOST_ROUNDS {
            return Err(NotSteady {
                rounds: rounds.len(),
                change,
            }
            .into());
        }
        is_at_limit = warmest > limit;
        let share = (limit - network.ambient) / (warmest - network.ambient);
        temperatures = match is_at_limit {
            true => next.map(|kelvin| network.ambient + share * (kelvin - network.ambient)),
            false => next,
        };
    }
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

    /// Wrong: rounds that go to and fro would never end.
    #[test]
    fn rounds_that_go_to_and_fro_are_said() {
        let said = settled(|rise| if rise > 20.0 { 10.0 } else { 60.0 })
            .unwrap_err()
            .to_string();
        let start =
            "temperatures still change by 25.0 K after 50 rounds of friction and heat flow, to and fro;";
        assert!(said.starts_with(start), "{said}");
    }

    /// Wrong: friction that does not depend on temperature would take more than a look back.
    #[test]
    fn constant_friction_is_steady_at_once() {
        let found = settled(|_| 30.0).unwrap();
        assert_eq!((found.end, found.rounds.len()), (BalanceEnd::Steady, 2));
        assert_eq!(found.temperatures_k[INNER], 293.15 + 15.0);
    }
}
