//! The end of a part of a step for both rings, once their contacts are solved: inertia of the turning frame, new states, works.
//!
//! The inertia of the frame depends on the motion that it changes. A trial finds the one that fits the increment, and the predictor under
//! it, until the change is small ([`Settling`]); when the next is expected to be, it is checked by the pass that ends the step. Rounds
//! contract by about speed times step size, so that one or two trials and the end are the rule.

use std::sync::Arc;

use contact::Side;

use super::ahead::{Foreseen, Known, frame_turn};
use super::harmonic_step::StepStart;
use super::newton::SmallSolution;
use super::part::Moving;
use super::pass::{Acting, Change, Coming, Turned};
use super::place::expected;
use super::pool::PooledVector;
use super::ring_state::RingState;
use super::run::Motion;
use super::state::MotionState;
use super::substep::{Part, Span};
use super::vectors::combined;
use crate::error::DynamicsError;

/// Rounds before a step counts as failed; each contracts by about speed times step size.
const MAX_FRAME_ROUNDS: usize = 25;
/// Change of the frame's inertia loads in a round, the most that all can add up to, over the largest force, at which they count as settled.
const FRAME_TOLERANCE: f64 = 1e-9;
/// The same over the inertia loads themselves, which a body without other forces has alone: what rounding of a transform of
/// its motion leaves of them.
const FRAME_ROUND_OFF: f64 = 1e-13;

/// How far the inertia of the turning frame is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Settling {
    /// It is not, after a round whose change was the number times that of the round before.
    Open(f64),
    /// The next change is expected to be small.
    Expected,
    /// It fits the motion, or there is none.
    Settled,
}

/// The end of a part for one ring.
pub(super) struct RingEnd {
    pub state: RingState,
    /// Work of the load and of the inertia of the frame, J.
    pub works: [f64; 2],
}

/// The end of a ring, and what of the inertia of its frame is to be checked.
struct Candidate {
    end: RingEnd,
    renewed: Option<(PooledVector, Change)>,
}

impl Motion<'_> {
    /// The ends of both rings under the forces of a solution, or None when the inertia of the turning frame has changed and the contacts
    /// are to be solved again. Looks ahead to the part `upcoming`.
    pub(super) fn close(
        &self,
        state: &MotionState,
        part: &mut Part<'_>,
        solution: &SmallSolution,
        upcoming: Option<Span>,
    ) -> Result<Option<[Option<RingEnd>; 2]>, DynamicsError> {
        if let Settling::Open(contraction) = part.settling {
            let round = || self.try_frame(part, solution, contraction);
            self.costs.time("frame_rotation", round)?;
            part.report.seconds.frame += part.clock.lap();
            if part.settling != Settling::Settled {
                return Ok(None);
            }
        }
        let next = self.look_ahead(state, part, solution, upcoming);
        let end = |side: Side| {
            let ring = part.moving[side.index()].as_ref()?;
            Some(self.end_ring(side, ring, (part, solution), next.as_ref()))
        };
        let (inner, outer) = self.model.backend.both(|| end(Side::Inner), || end(Side::Outer));
        if let Some((new, change)) = inner.as_ref().and_then(|inner| inner.renewed.as_ref())
            && !self.is_settled(part, change)
        {
            let ended = inner.as_ref().map(|inner| &inner.end.state);
            self.replace_inertia(part, new, ended)?;
            part.report.seconds.update += part.clock.lap();
            return Ok(None);
        }
        part.report.seconds.update += part.clock.lap();
        Ok(Some([inner, outer].map(|ring| ring.map(|ring| ring.end))))
    }

    /// Loads of the part that follows, when a ring can make use of them. Where an effect fails there, that part will say so.
    fn look_ahead(
        &self,
        state: &MotionState,
        part: &Part<'_>,
        solution: &SmallSolution,
        upcoming: Option<Span>,
    ) -> Option<Arc<Foreseen>> {
        let span = upcoming.filter(|span| span.rung == part.span.rung && self.looks_ahead())?;
        let met = part.system.places(solution);
        let places = expected([&met, &state.places[0], &state.places[1]]);
        self.foresee(places, span).ok()
    }

    /// Ends one ring.
    fn end_ring(
        &self,
        side: Side,
        ring: &Moving<'_>,
        (part, solution): (&Part<'_>, &SmallSolution),
        next: Option<&Arc<Foreseen>>,
    ) -> Candidate {
        let forces = part.system.ring_loads(side, solution);
        let mount = &solution.mounts[side.index()];
        let load = ring.known.load.as_deref();
        let inertia = ring.inertia.as_ref().map(|(_, f)| &f[..]);
        let Some(pass) = ring.factor.pass(ring.body) else {
            let made;
            let dw = match &ring.increment {
                Some(dw) => dw,
                None => {
                    made = ring.increment_under(&forces, mount);
                    &made
                }
            };
            let work = |load: &[f64]| ring.body.space.dot(load, dw);
            let end = RingEnd {
                works: [load, inertia].map(|load| load.map_or(0.0, work)),
                state: ring.factor.advance(ring.body, ring.old, dw),
            };
            return Candidate { end, renewed: None };
        };
        let turn = ring.inertia.as_ref().map(|(turn, _)| *turn);
        let checked = turn.filter(|_| part.settling == Settling::Expected);
        let acting = Acting {
            load,
            inertia,
            turn: checked,
        };
        let coming_load = next.and_then(|next| self.ring_load(ring.body, side, &next.loads, next.span));
        let coming_turn = next.and_then(|next| frame_turn(side, &next.loads));
        let coming = next.map(|_| Coming {
            load: coming_load.as_deref(),
            turn: coming_turn,
        });
        let increment = ring.factor.forces(ring.body, &ring.step, &forces, mount);
        let ended = pass.end(ring.old, increment, acting, coming);
        let mut new = ended.state;
        let of_rows = ring.factor.frame_work(ring.body, &ring.step, [ring.old, &new]);
        if let (Some(next), Some(predicted)) = (next, ended.next) {
            new.foresee(Arc::new(Known::of_pass(
                next.clone(),
                coming_load,
                coming_turn,
                predicted,
            )));
        }
        Candidate {
            end: RingEnd {
                state: new,
                works: [ended.works[0], ended.works[1] + of_rows],
            },
            renewed: checked.map(|_| ended.renewed),
        }
    }

    /// One round for the inertia of the turning frame of the inner ring, whose last change was `contraction` times the one before.
    fn try_frame(
        &self,
        part: &mut Part<'_>,
        solution: &SmallSolution,
        contraction: f64,
    ) -> Result<(), DynamicsError> {
        let Some(ring) = &part.moving[0] else {
            part.settling = Settling::Settled;
            return Ok(());
        };
        let Some((turn, used)) = &ring.inertia else {
            part.settling = Settling::Settled;
            return Ok(());
        };
        let forces = part.system.ring_loads(Side::Inner, solution);
        let mount = &solution.mounts[0];
        let Some(pass) = ring.factor.pass(ring.body) else {
            let scheme = (self.settings.integrator, part.span.dt);
            let dw = ring.increment_under(&forces, mount);
            let new = ring.body.frame_load(*turn, scheme, ring.old, Some(&dw));
            let change = combined([1.0, -1.0], &new, used);
            let space = &ring.body.space;
            let [square, new_square] = [&change, &new].map(|x| space.dot(x, x));
            let change = Change { square, new_square };
            if self.is_settled(part, &change) {
                part.settling = Settling::Settled;
                if let Some(ring) = &mut part.moving[0] {
                    ring.increment = Some(dw);
                }
                return Ok(());
            }
            return self.replace_inertia(part, &new, None);
        };
        let predictor = ring.step.harmonics();
        let increment = ring.factor.forces(ring.body, &ring.step, &forces, mount);
        let turned = pass.turn(ring.old, increment, (*turn, used), predictor);
        if self.is_settled(part, &turned.change) {
            part.settling = Settling::Settled;
            return Ok(());
        }
        self.go_on(part, turned, contraction)
    }

    /// Goes on with the inertia and the predictor of a trial.
    fn go_on(&self, part: &mut Part<'_>, turned: Turned, contraction: f64) -> Result<(), DynamicsError> {
        let change = turned.change;
        let ratio = match part.last_change {
            Some(before) => (change.square / before).sqrt(),
            None => contraction,
        };
        part.last_change = Some(change.square);
        let limit = self.frame_limit(part, &change);
        part.settling = if self.most(part, change.square) * ratio <= limit {
            Settling::Expected
        } else {
            Settling::Open(ratio)
        };
        if let Some(ring) = &mut part.moving[0]
            && let Some((turn, used)) = &mut ring.inertia
        {
            let from = StepStart {
                state: ring.old,
                turn: Some(*turn),
                moved: turned.rows,
            };
            let predictor = Arc::new(turned.predictor);
            ring.factor
                .replace_predictor(ring.body, &mut ring.step, predictor, from);
            *used = Arc::new(turned.inertia);
        }
        self.count_round(part)
    }

    /// Goes on with another inertia: one solve.
    fn replace_inertia(
        &self,
        part: &mut Part<'_>,
        new: &[f64],
        ended: Option<&RingState>,
    ) -> Result<(), DynamicsError> {
        if let Some(ring) = &mut part.moving[0]
            && let Some((turn, used)) = &mut ring.inertia
        {
            let change = combined([1.0, -1.0], new, used);
            ring.factor.add_load(ring.body, &mut ring.step, change);
            if let Some(moved) = ended.and_then(|new| ring.factor.moved_rows(ring.body, [ring.old, new])) {
                let from = StepStart {
                    state: ring.old,
                    turn: Some(*turn),
                    moved: Some(moved),
                };
                let predictor = ring.step.harmonics().clone();
                ring.factor
                    .replace_predictor(ring.body, &mut ring.step, predictor, from);
            }
            *used = Arc::new(new.to_vec().into());
        }
        part.settling = Settling::Open(self.contraction(part));
        self.count_round(part)
    }

    /// Counts a round and hands the new predictor to the small system.
    fn count_round(&self, part: &mut Part<'_>) -> Result<(), DynamicsError> {
        part.report.frame_rounds += 1;
        if part.report.frame_rounds > MAX_FRAME_ROUNDS {
            return Err(DynamicsError::FrameNotSettled {
                rounds: MAX_FRAME_ROUNDS,
                speed: part.foreseen.loads.frame.map_or(0.0, |turn| turn.speed),
            });
        }
        for (answer, ring) in part.system.rings.iter_mut().zip(&part.moving) {
            if let (Some(answer), Some(ring)) = (answer, ring) {
                answer.predicted.clone_from(&ring.step.predicted);
            }
        }
        Ok(())
    }

    /// By how much a round is expected to contract.
    pub(super) fn contraction(&self, part: &Part<'_>) -> f64 {
        let speed = part.foreseen.loads.frame.map_or(0.0, |turn| turn.speed);
        speed.abs() * part.span.dt
    }

    /// Change of the frame's inertia at which it counts as settled, N.
    fn frame_limit(&self, part: &Part<'_>, change: &Change) -> f64 {
        (FRAME_TOLERANCE * part.scale).max(FRAME_ROUND_OFF * self.most(part, change.new_square))
    }

    /// Whether the inertia differs little enough from the one that acts.
    fn is_settled(&self, part: &Part<'_>, change: &Change) -> bool {
        self.most(part, change.square) <= self.frame_limit(part, change)
    }

    /// Most that the magnitudes of a load with this sum of squares add up to.
    fn most(&self, part: &Part<'_>, square: f64) -> f64 {
        let ring = part.moving[0].as_ref();
        (ring.map_or(0, |ring| ring.body.coordinates.n()) as f64 * square).sqrt()
    }
}
