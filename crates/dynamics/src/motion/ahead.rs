//! What a step begins with that does not wait for its contacts: loads, and the answer of each ring to them.
//!
//! The pass that ends a step finds it for the step that follows ([`super::pass`]). It is no part of the state: it is used only if that step
//! has the expected time and size, the contacts are expected where they were, and the same [`Motion`] makes it. Otherwise, and after the
//! reading of a step file, it is found anew from the state, to the same bits.

use std::sync::Arc;

use contact::Side;

use super::body::RingBody;
use super::pass::{Coming, Predicted};
use super::pool::PooledVector;
use super::ring::RingFactor;
use super::ring_state::RingState;
use super::run::Motion;
use super::space::Space;
use super::state::MotionState;
use super::substep::Span;
use crate::effects::{FrameTurn, Loads};
use crate::error::DynamicsError;

/// Loads of a part of a step.
#[derive(Debug)]
pub(super) struct Foreseen {
    /// The motion that evaluated them.
    motion: Arc<()>,
    /// The part.
    pub span: Span,
    /// Contact angle, rad, and force, N, with which they were evaluated, by site.
    pub places: Vec<[f64; 2]>,
    pub loads: Loads,
}

/// What is known of a ring in a part of a step before its contacts.
#[derive(Debug)]
pub(super) struct Known {
    foreseen: Arc<Foreseen>,
    /// Generalised load that is fixed in space, of the ring's space as all loads here, when there is one.
    pub load: Option<Vec<f64>>,
    /// First guess of the inertia load of the turning frame, when there is one.
    pub inertia: Option<(FrameTurn, Arc<PooledVector>)>,
    /// Of a ring in harmonic space, S^-1 of its right-hand side.
    pub solved: Option<Arc<PooledVector>>,
}

impl Known {
    /// What a pass has found with the loads `foreseen` and `load`.
    pub fn of_pass(
        foreseen: Arc<Foreseen>,
        load: Option<Vec<f64>>,
        turn: Option<FrameTurn>,
        predicted: Predicted,
    ) -> Known {
        Known {
            foreseen,
            load,
            inertia: turn.map(|turn| (turn, Arc::new(predicted.inertia))),
            solved: Some(Arc::new(predicted.solved)),
        }
    }

    /// Whether it belongs to these loads.
    fn is_of(&self, foreseen: &Arc<Foreseen>) -> bool {
        Arc::ptr_eq(&self.foreseen, foreseen)
    }
}

impl Motion<'_> {
    /// Loads of a part of a step from `state` with contacts expected at `places`.
    pub(super) fn foresee(&self, places: Vec<[f64; 2]>, span: Span) -> Result<Arc<Foreseen>, DynamicsError> {
        let loads = self.loads_at(&places, self.weighted_time(span), span.dt)?;
        Ok(Arc::new(Foreseen {
            motion: self.token.clone(),
            span,
            places,
            loads,
        }))
    }

    /// The same as the step before has found it, or anew.
    pub(super) fn foreseen(&self, state: &MotionState, span: Span) -> Result<Arc<Foreseen>, DynamicsError> {
        let places = state.expected_places();
        let fits = |foreseen: &&Arc<Foreseen>| {
            Arc::ptr_eq(&foreseen.motion, &self.token) && foreseen.span == span && foreseen.places == places
        };
        let rings = state.rings.iter().flatten();
        let mut found = rings.filter_map(|ring| ring.known()).map(|known| &known.foreseen);
        match found.find(fits) {
            Some(foreseen) => Ok(foreseen.clone()),
            None => self.foresee(places, span),
        }
    }

    /// What is known of a ring, as the step before has found it, or anew.
    pub(super) fn known(
        &self,
        side: Side,
        (body, factor): (&RingBody, &RingFactor),
        old: &RingState,
        foreseen: &Arc<Foreseen>,
    ) -> Arc<Known> {
        if let Some(known) = old.known().filter(|known| known.is_of(foreseen)) {
            return known.clone();
        }
        let load = self.ring_load(body, side, &foreseen.loads, foreseen.span);
        let turn = frame_turn(side, &foreseen.loads);
        let known = match factor.pass(body) {
            Some(pass) => {
                let coming = Coming {
                    load: load.as_deref(),
                    turn,
                };
                Known::of_pass(foreseen.clone(), load.clone(), turn, pass.predict(old, coming))
            }
            None => {
                // First guess: the velocity stays.
                let scheme = (self.settings.integrator, foreseen.span.dt);
                let guess = |turn| Arc::new(body.frame_load(turn, scheme, old, None).into());
                let inertia = turn.map(|turn| (turn, guess(turn)));
                Known {
                    foreseen: foreseen.clone(),
                    load,
                    inertia,
                    solved: None,
                }
            }
        };
        Arc::new(known)
    }

    /// Whether a ring moves in harmonic space, so that a pass finds what the next step begins with.
    pub(super) fn looks_ahead(&self) -> bool {
        let mut rings = self.rings.iter().flatten();
        rings.any(|body| matches!(body.space, Space::Harmonic(_)))
    }
}

/// Turning of a ring's frame, when its inertia is called for.
pub(super) fn frame_turn(side: Side, loads: &Loads) -> Option<FrameTurn> {
    loads.frame.filter(|_| side == Side::Inner)
}
