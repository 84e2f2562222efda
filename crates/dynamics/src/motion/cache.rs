//! What a step begins with that does not wait for its contacts, as the step before has found it.
//!
//! It is no part of the state. It is used only by the [`Motion`] that made it, if the step has the expected time and
//! size, the contacts are expected where they were, and the rings are in the states from which it was found.
//! Otherwise, and after the reading of a step file, it is found anew, to the same bits.

use std::sync::Arc;

use contact::Side;
use ring::{Ended, Known, KnownLoad};

use super::run::Motion;
use super::span::PartSpan;
use super::state::MotionState;
use super::state::PatchPlace;
use crate::effects::{Loads, sum_of};
use crate::error::DynamicsError;
use crate::frame::turn_nodal;

/// What the next step may begin with; empty at first.
#[derive(Debug, Default)]
pub struct StepCache {
    pub(super) ahead: Option<Ahead>,
}

/// Loads of a part of a step, and what both rings have found of them.
#[derive(Debug)]
pub(super) struct Ahead {
    pub loads: Arc<ExpectedLoads>,
    pub rings: [Option<Arc<Known>>; 2],
}

/// The ends of both rings.
pub(super) struct RingEnds {
    pub rings: [Option<Ended>; 2],
    /// What the part that follows begins with.
    pub ahead: Option<Ahead>,
}

/// Loads of a part of a step with its contacts where they are expected.
#[derive(Debug)]
pub(super) struct ExpectedLoads {
    /// The motion that evaluated them.
    motion: Arc<()>,
    /// The part.
    pub span: PartSpan,
    /// Places of the contacts with which they were evaluated, by site.
    pub places: Vec<PatchPlace>,
    pub loads: Loads,
}

impl Motion<'_> {
    /// Loads of a part of a step with contacts expected at `places`.
    pub(super) fn expected_loads(
        &self,
        places: Vec<PatchPlace>,
        span: PartSpan,
    ) -> Result<Arc<ExpectedLoads>, DynamicsError> {
        let loads = self.loads_at(&places, self.weighted_time(span), span.dt)?;
        Ok(Arc::new(ExpectedLoads {
            motion: self.token.clone(),
            span,
            places,
            loads,
        }))
    }

    /// What is known of a part of a step from `state`, as the step before has found it, or anew.
    pub(super) fn ahead(
        &self,
        state: &MotionState,
        span: PartSpan,
        cache: &StepCache,
    ) -> Result<Ahead, DynamicsError> {
        let places = state.expected_places();
        let fits = |ahead: &&Ahead| {
            let loads = &ahead.loads;
            Arc::ptr_eq(&loads.motion, &self.token) && loads.span == span && loads.places == places
        };
        let of_state =
            |i: usize, known: &Arc<Known>| state.rings[i].as_ref().is_some_and(|ring| known.is_of(ring));
        match cache.ahead.as_ref().filter(fits) {
            Some(ahead) => Ok(Ahead {
                loads: ahead.loads.clone(),
                rings: [0, 1].map(|i| ahead.rings[i].clone().filter(|known| of_state(i, known))),
            }),
            None => Ok(Ahead {
                loads: self.expected_loads(places, span)?,
                rings: [None, None],
            }),
        }
    }

    /// What acts on a ring in a part of a step and does not wait for its contacts. Loads are fixed in space and
    /// are turned into the frame of the ring.
    pub(super) fn known_load(&self, side: Side, expected: &ExpectedLoads) -> KnownLoad {
        let loads = &expected.loads;
        let angle = self.frame_angle(side, self.weighted_time(expected.span));
        let moving = self.rings[side.index()].as_ref();
        let nodal = moving.zip(loads.rings[side.index()].as_ref());
        let nodal = nodal.map(|(moving, load)| moving.body.load(&turn_nodal(load, -angle)));
        let weight = moving
            .and_then(|moving| moving.weights.as_deref())
            .zip(loads.weights[side.index()]);
        let weight = weight.map(|(unit, weight)| unit.load(weight.seen_from(angle)));
        let load = sum_of([nodal, weight, self.undeformed_load(side, loads)]);
        KnownLoad {
            load,
            turn: self.elastic_turn(side, loads),
            body_turn: self.body_turn(side, self.weighted_time(expected.span)),
            body_load: self.model.body_load(side, &self.now(expected.span), angle),
        }
    }
}
