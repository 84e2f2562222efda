//! One step of the full size, in parts on the ladder dt 2^-k where a part fails or is too inaccurate.

use comm::Communicator;

use super::cache::StepCache;
use super::run::Motion;
use super::span::PartSpan;
use super::state::{MotionState, StepReport};
use crate::error::DynamicsError;

/// Share of the accepted error below which the next rung up is tried: two orders of the step, and a margin.
const RISE: f64 = 1.0 / 16.0;

/// Does it among the threads that share its work. From outside, each of its parts would be handed over to them and
/// waited for, which takes longer than some. Not where ranks share it as well: the main thread alone sends messages.
pub fn among_threads<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    match Communicator::world().size() {
        1 => rayon::scope(|_| work()),
        _ => work(),
    }
}

impl Motion<'_> {
    /// One step of the full size, in parts where a part fails or is too inaccurate. `cache` has what the step before
    /// has found of it, and then what this one finds of the next; no bit of the result depends on it.
    pub fn step(
        &self,
        state: &MotionState,
        cache: &mut StepCache,
    ) -> Result<(MotionState, StepReport), DynamicsError> {
        among_threads(|| self.step_in_parts(state, cache))
    }

    /// The parts of a step.
    fn step_in_parts(
        &self,
        state: &MotionState,
        cache: &mut StepCache,
    ) -> Result<(MotionState, StepReport), DynamicsError> {
        let ladder = self.settings.ladder;
        // Places within the step are counted in integers, in units of the smallest part.
        let n = 1u64 << ladder.halvings;
        let mut rung = match ladder.tolerance {
            Some(_) => ladder.halvings.min(state.rung as u32),
            None => 0,
        };
        let (mut at, mut next, mut report) = (0, None, StepReport::default());
        while at < n {
            let span = self.span(state.step, at, rung);
            let after = at + (n >> rung);
            // The part that follows if all goes on as it is.
            let upcoming = match ladder.tolerance {
                _ if after < n => Some(self.span(state.step, after, rung)),
                Some(_) => Some(self.span(state.step + 1, 0, rung)),
                None => (rung == 0).then(|| self.span(state.step + 1, 0, 0)),
            };
            match self.try_part(next.as_ref().unwrap_or(state), span, upcoming, cache) {
                Ok((part, done)) => {
                    at = after;
                    report.add(&done);
                    next = Some(part);
                    let coarser = ladder.tolerance.is_some_and(|limit| done.error < RISE * limit);
                    if coarser && rung > 0 && at.is_multiple_of(n >> (rung - 1)) {
                        rung -= 1;
                    }
                }
                // Ranks that share rings try again together or not at all.
                Err(error)
                    if rung < ladder.halvings
                        && error.may_pass_with_smaller_step()
                        && Communicator::world().all_failed() =>
                {
                    rung += 1;
                    report.retries += 1;
                }
                Err(source) => {
                    return Err(DynamicsError::StepFailed {
                        dt: span.dt,
                        halvings: rung,
                        time: span.start,
                        source: Box::new(source),
                    });
                }
            }
        }
        let mut next = next.expect("a step has at least one part");
        next.step = state.step + 1;
        next.rung = ladder.tolerance.map_or(0, |_| u64::from(rung));
        Ok((next, report))
    }

    /// The part of a step on a rung of the ladder that begins `at` smallest parts from its start.
    pub fn span(&self, step: u64, at: u64, rung: u32) -> PartSpan {
        let n = 1u64 << self.settings.ladder.halvings;
        PartSpan {
            start: self.time(step) + self.settings.dt * (at as f64 / n as f64),
            dt: self.step_size(rung),
            rung,
        }
    }

    /// One part; too large a local error is an error.
    fn try_part(
        &self,
        state: &MotionState,
        span: PartSpan,
        upcoming: Option<PartSpan>,
        cache: &mut StepCache,
    ) -> Result<(MotionState, StepReport), DynamicsError> {
        let (next, report, ahead) = self.substep(state, span, upcoming, cache)?;
        match self.settings.ladder.tolerance {
            Some(limit) if report.error > limit => Err(DynamicsError::StepInaccurate {
                error: report.error,
                limit,
            }),
            _ => {
                cache.ahead = ahead;
                Ok((next, report))
            }
        }
    }
}
