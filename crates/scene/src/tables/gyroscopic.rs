//! `[effects.gyroscopic_moment]`: which raceway carries the gyroscopic moment of the balls.

use input::Problems;
use serde::Deserialize;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [effects.gyroscopic_moment]")]
pub struct RawGyroscopicMoment {
    inner_share: Option<f64>,
    outer_share: Option<f64>,
}

/// Both shares together: each is a force of share / D_w at D_w / 2 from the ball's centre.
const SUM: f64 = 2.0;
/// Shares such as 0.7 and 1.3 add up to 2 but for round-off.
const ROUND_OFF: f64 = 1e-12;

impl RawGyroscopicMoment {
    /// Shares of the inner and the outer raceway; one that is not given is the rest of 2, without any the outer raceway
    /// carries all.
    pub fn check(&self, problems: &mut Problems) -> [f64; 2] {
        let inner = self.inner_share.unwrap_or(SUM - self.outer_share.unwrap_or(SUM));
        let outer = self.outer_share.unwrap_or(SUM - inner);
        for (name, share) in [("inner_share", inner), ("outer_share", outer)] {
            problems.require(
                (0.0..=SUM).contains(&share),
                &format!("effects.gyroscopic_moment.{name}"),
                share,
                "expected 0 to 2: inner 0 and outer 2 is outer raceway control, 1 and 1 both alike",
            );
        }
        if (inner + outer - SUM).abs() > ROUND_OFF {
            problems.add(format!(
                "[effects.gyroscopic_moment] has inner_share {inner} and outer_share {outer}; their sum must be 2, or the \
                 moment is not balanced"
            ));
        }
        [inner, outer]
    }
}
