//! The end of a part of a step for both rings, once their contacts are solved: inertia of the turning frame, new
//! states, and what the part that follows begins with.

use std::sync::Arc;

use contact::Side;
use ring::{ElasticStep, End, Settling};

use super::cache::{Ahead, ExpectedLoads, RingEnds};
use super::place::expected;
use super::run::Motion;
use super::solve::StepSolution;
use super::span::PartSpan;
use super::state::MotionState;
use super::substep::StepPart;
use crate::costs::{FRAME, UPDATE};
use crate::error::DynamicsError;

/// Rounds for the inertia of the turning frame before a step counts as failed; each contracts by about speed times
/// step size.
const MAX_FRAME_ROUNDS: usize = 25;

impl Motion<'_> {
    /// The ends of both rings under the forces of a solution, or None when the inertia of the turning frame has
    /// changed and the contacts are to be solved again. Looks ahead to the part `upcoming`.
    pub(super) fn close(
        &self,
        state: &MotionState,
        part: &mut StepPart<'_>,
        solution: &StepSolution,
        upcoming: Option<PartSpan>,
    ) -> Result<Option<RingEnds>, DynamicsError> {
        let forces = Side::BOTH.map(|side| part.parts.forces_at_ports(side, solution));
        let scale = part.scale;
        if self.has_turning_frames(part) {
            let settle = |(step, forces): (&mut Box<dyn ElasticStep + '_>, &super::part::RingForces)| {
                step.settle(forces.at_ports(), scale)
            };
            let rings = &mut part.rings;
            let settled = self.costs.time("frame_rotation", || {
                let rings = rings.iter_mut().zip(&forces);
                let steps = rings.filter_map(|(step, forces)| Some((step.as_mut()?, forces)));
                // Every ring has its round, whatever the one before says.
                steps.map(settle).fold(Settling::Settled, both_settled)
            });
            part.report.laps.add(FRAME, part.clock.lap());
            if settled == Settling::Again {
                self.next_round(part, solution)?;
                return Ok(None);
            }
        }
        let next = self.look_ahead(state, part, solution, upcoming);
        let end = |step: &mut Option<Box<dyn ElasticStep + '_>>, side: Side| {
            let step = step.as_mut()?;
            let next = next.as_ref().map(|next| self.known_load(side, next));
            Some(step.end(forces[side.index()].at_ports(), scale, next))
        };
        let ends = self.model.backend.with_sides(part.rings.each_mut(), end);
        part.report.laps.add(UPDATE, part.clock.lap());
        let mut rings = [None, None];
        for (ring, end) in rings.iter_mut().zip(ends) {
            match end {
                Some(End::Done(ended)) => *ring = Some(*ended),
                Some(End::Again) => {
                    self.next_round(part, solution)?;
                    return Ok(None);
                }
                None => {}
            }
        }
        let ahead = next.map(|loads| Ahead {
            loads,
            rings: rings
                .each_mut()
                .map(|ring| ring.as_mut().and_then(|ring| ring.next.take()).map(Arc::new)),
        });
        Ok(Some(RingEnds { rings, ahead }))
    }

    /// Loads of the part that follows. Where an effect fails there, that part will say so.
    fn look_ahead(
        &self,
        state: &MotionState,
        part: &StepPart<'_>,
        solution: &StepSolution,
        upcoming: Option<PartSpan>,
    ) -> Option<Arc<ExpectedLoads>> {
        let span = upcoming.filter(|span| span.rung == part.span.rung)?;
        let met = part.parts.places(solution);
        let places = expected([&met, &state.places[0], &state.places[1]]);
        self.expected_loads(places, span).ok()
    }

    /// Whether the inertia of a frame is found by rounds: of a ring's, or of a body on the shaft.
    fn has_turning_frames(&self, part: &StepPart<'_>) -> bool {
        let time = self.weighted_time(part.span);
        let loads = &part.expected.loads;
        let turns = |side: Side| {
            self.elastic_turn(side, loads)
                .or(self.body_turn(side, time))
                .is_some()
        };
        Side::BOTH.into_iter().any(turns)
    }

    /// Speed of the frame that turns fastest, rad/s.
    fn fastest(&self, part: &StepPart<'_>) -> f64 {
        let time = self.weighted_time(part.span);
        let bodies = Side::BOTH.map(|side| self.body_turn(side, time));
        let turns = part.expected.loads.frames.iter().chain(&bodies).flatten();
        let speeds = turns.map(|turn| turn.speed);
        speeds.fold(0.0, |a, b| if b.abs() > a.abs() { b } else { a })
    }

    /// Counts a round and hands the new predictors to the system.
    fn next_round(&self, part: &mut StepPart<'_>, solution: &StepSolution) -> Result<(), DynamicsError> {
        part.report.frame_rounds += 1;
        part.before = Some(solution.unknowns.clone());
        if part.report.frame_rounds > MAX_FRAME_ROUNDS {
            return Err(DynamicsError::FrameNotSettled {
                rounds: MAX_FRAME_ROUNDS,
                speed: self.fastest(part),
            });
        }
        for (ports, step) in part.parts.rings.iter_mut().zip(&part.rings) {
            if let (Some(ports), Some(step)) = (ports, step) {
                ports.offset.clone_from(&step.answer().predicted);
            }
        }
        Ok(())
    }
}

/// Settled if both are.
fn both_settled(a: Settling, b: Settling) -> Settling {
    match (a, b) {
        (Settling::Settled, Settling::Settled) => Settling::Settled,
        _ => Settling::Again,
    }
}
