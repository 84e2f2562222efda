//! Rounds for the inertia of a turning frame, which depends on the motion that it changes.
//!
//! A trial finds the inertia that fits the increment, and the predictor under it, until the change is small; when the
//! next is expected to be, it is checked at the end of the step. Rounds contract by about speed times step size, so
//! that one or two trials and the end are the rule.

use crate::step::FrameTurn;

/// Change of the inertia loads in a round, the most that all can add up to, over the largest force, at which they
/// count as settled.
const FRAME_TOLERANCE: f64 = 1e-9;
/// The same over the inertia loads themselves, which a body without other forces has alone: what rounding of a
/// transform of its motion leaves of them.
const FRAME_ROUND_OFF: f64 = 1e-13;

/// Difference of two loads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LoadChange {
    /// Sum of the squares of its coordinates.
    pub square: f64,
    /// Sum of the squares of the coordinates of the new load.
    pub new_square: f64,
}

/// How far the inertia is found.
#[derive(Clone, Copy, Debug, PartialEq)]
enum InertiaProgress {
    /// It is not, after a round whose change was the number times that of the round before.
    Open(f64),
    /// The next change is expected to be small.
    Expected,
    /// It fits the motion, or there is none.
    Settled,
}

/// The rounds of one step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameRounds {
    progress: InertiaProgress,
    /// Sum of the squares of the last change, N^2.
    last_change: Option<f64>,
    /// By how much a round is expected to contract.
    contraction: f64,
    /// Number of coordinates.
    n: usize,
}

impl FrameRounds {
    /// The rounds of a step of `dt` seconds of a ring of `n` coordinates.
    pub fn new(turn: Option<FrameTurn>, dt: f64, n: usize) -> FrameRounds {
        let contraction = turn.map_or(0.0, |turn| turn.speed.abs() * dt);
        FrameRounds {
            progress: match turn {
                Some(_) => InertiaProgress::Open(contraction),
                None => InertiaProgress::Settled,
            },
            last_change: None,
            contraction,
            n,
        }
    }

    /// Whether a trial is to be made.
    pub fn is_open(&self) -> bool {
        matches!(self.progress, InertiaProgress::Open(_))
    }

    /// Whether the end of the step is to check the inertia.
    pub fn is_checked_at_end(&self) -> bool {
        self.progress == InertiaProgress::Expected
    }

    /// Notes that the inertia fits.
    pub fn close(&mut self) {
        self.progress = InertiaProgress::Settled;
    }

    /// Goes on after a trial whose change was too large; `scale` is the largest force, N.
    pub fn advance(&mut self, change: &LoadChange, scale: f64) {
        let ratio = match (self.last_change, self.progress) {
            (Some(before), _) => (change.square / before).sqrt(),
            (None, InertiaProgress::Open(contraction)) => contraction,
            (None, _) => self.contraction,
        };
        self.last_change = Some(change.square);
        self.progress = if self.most(change.square) * ratio <= self.limit(change, scale) {
            InertiaProgress::Expected
        } else {
            InertiaProgress::Open(ratio)
        };
    }

    /// Begins anew with another inertia.
    pub fn reopen(&mut self) {
        self.progress = InertiaProgress::Open(self.contraction);
    }

    /// Whether the inertia differs little enough from the one that acts.
    pub fn is_settled(&self, change: &LoadChange, scale: f64) -> bool {
        self.most(change.square) <= self.limit(change, scale)
    }

    /// Change at which the inertia counts as settled, N.
    fn limit(&self, change: &LoadChange, scale: f64) -> f64 {
        (FRAME_TOLERANCE * scale).max(FRAME_ROUND_OFF * self.most(change.new_square))
    }

    /// Most that the magnitudes of a load with this sum of squares add up to.
    fn most(&self, square: f64) -> f64 {
        (self.n as f64 * square).sqrt()
    }
}
