//! `[bearing.ball_diameters]`: balls that are not equal; see [`super::profiles`].

use input::{LENGTH, Problems, Quantity};
use serde::Deserialize;

use super::random::SplitMix64;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [bearing.ball_diameters]")]
pub struct RawBallDiameters {
    spread: Option<Quantity<LENGTH>>,
    seed: Option<i64>,
    deviations: Option<Vec<Quantity<LENGTH>>>,
}

/// Largest deviation of a ball over its diameter.
const MAX_OVERSIZE: f64 = 1e-3;

impl RawBallDiameters {
    /// How much larger each ball is than `ball_diameter`, m; checked.
    pub fn check(&self, n_balls: usize, ball_diameter: f64, problems: &mut Problems) -> Vec<f64> {
        let most = MAX_OVERSIZE * ball_diameter;
        let rule = format!(
            "expected at most a thousandth of the ball diameter, {}",
            Quantity::<LENGTH>::about(most)
        );
        match (&self.spread, &self.deviations) {
            (Some(spread), None) => {
                problems.require(
                    spread.si() > 0.0 && 0.5 * spread.si() <= most,
                    "bearing.ball_diameters.spread",
                    spread,
                    rule,
                );
                let Some(seed) = self.seed else {
                    problems
                        .add("bearing.ball_diameters.seed is missing; expected a whole number beside spread");
                    return Vec::new();
                };
                let mut random = SplitMix64::new(seed);
                (0..n_balls)
                    .map(|_| (random.next() - 0.5) * spread.si())
                    .collect()
            }
            (None, Some(deviations)) => {
                problems.require(
                    deviations.len() == n_balls && self.seed.is_none(),
                    "bearing.ball_diameters.deviations",
                    format!("a list of {}", deviations.len()),
                    format!("expected one for each of the {} balls, and no seed", n_balls),
                );
                for deviation in deviations {
                    problems.require(
                        deviation.si().abs() <= most,
                        "bearing.ball_diameters.deviations",
                        deviation,
                        &rule,
                    );
                }
                deviations.iter().map(Quantity::si).collect()
            }
            _ => {
                problems.add("bearing.ball_diameters needs one of spread, with a seed, and deviations");
                Vec::new()
            }
        }
    }
}
