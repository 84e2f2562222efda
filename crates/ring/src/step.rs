//! The border between an elastic ring and whoever moves it: one implicit step in time.
//!
//! A factor belongs to one scheme and step size, S = c_M M + c_C C + c_K K. A step of it meets the world at its
//! *ports*: two directions of all nodal weights of every contact, then the functionals of the mount. At these the ring
//! answers
//! ```text
//! g(end) = predicted + compliance F
//! ```
//! and nothing else of it is seen until the forces F are known. The steps of a run follow each other:
//! ```text
//! predict     what is known before the contacts, solved where it can be  (the end of the step before does it)
//! begin       start, predicted and compliance at the ports
//! move_contacts   the same with contacts elsewhere; the predictor stays
//! settle      inertia of a turning frame that fits the motion; Again: the ports answer anew
//! end         the new state under the forces; Again as above
//! ```
//! Every method of a ring that ranks share is collective, so ranks call them in the same order.

use std::sync::Arc;

use body::{BodyLoad, SeatModes};
use contact::NodalWeights;
use timer::Laps;

use crate::pool::PooledVector;
use crate::state::{RingState, RowValues, Stamp};

/// Turning of a ring's frame about z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameTurn {
    /// Speed, rad/s.
    pub speed: f64,
    /// Acceleration, rad/s^2.
    pub acceleration: f64,
}

/// What acts on a ring in a step and does not wait for its contacts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KnownLoad {
    /// Generalised load, a vector of the body.
    pub load: Option<Vec<f64>>,
    /// Turning of its frame, where its inertia acts.
    pub turn: Option<FrameTurn>,
    /// Turning of the body on the shaft in which it sits.
    pub body_turn: Option<FrameTurn>,
    /// Load on all of the body in which it sits.
    pub body_load: Option<BodyLoad>,
}

/// A [`KnownLoad`] and what was found of it ahead of the step: half a solve, a first guess of the inertia of the
/// frame. No part of the state: found anew it has the same bits.
#[derive(Debug)]
pub struct Known {
    pub(crate) of: Stamp,
    pub(crate) load: KnownLoad,
    /// First guess of the inertia of the frame: the acceleration stays.
    pub(crate) inertia: Option<Arc<PooledVector>>,
    /// Of a ring in harmonic space, the first half of S^-1 of its right-hand side.
    pub(crate) solved: Option<Arc<PooledVector>>,
    /// Of a ring in coordinates, K and M on the state: what its right-hand side has but loads.
    pub(crate) history: Option<Arc<PooledVector>>,
    /// Values of the state on the rows of a defect.
    pub(crate) rows: Option<Arc<RowValues>>,
}

impl Known {
    /// Whether it was found from this state.
    pub fn is_of(&self, state: &RingState) -> bool {
        self.of == *state.stamp()
    }
}

/// Where contacts meet a ring.
#[derive(Clone, Copy, Debug)]
pub struct Feet<'a> {
    /// Nodal weights of the contacts, those of a contact together.
    pub weights: &'a [NodalWeights],
    /// How many of them a contact has: one of its force, more where it has traction as well.
    pub per_contact: usize,
    /// Nodal weights on the raceway by which a vector is only measured.
    pub seen: &'a [NodalWeights],
}

/// Forces at the ports.
#[derive(Clone, Copy, Debug)]
pub struct PortForces<'a> {
    /// On the two directions of all nodal weights of the contacts, N.
    pub contacts: &'a [f64],
    /// On the functionals of the mount, N and N m.
    pub mount: &'a [f64],
}

/// A ring over one step as its ports see it, contacts, then mount.
#[derive(Clone, Debug, Default)]
pub struct PortAnswer {
    /// Values at the start of the step, m and rad.
    pub start: Vec<f64>,
    /// What is only measured, at the start of the step, two values of all nodal weights, m.
    pub seen: Vec<f64>,
    /// Values at its end without forces.
    pub predicted: Vec<f64>,
    /// Growth of the values at the end with the forces, row-major, SI.
    pub compliance: Vec<f64>,
}

/// Lap of a step: right-hand sides, products with K and M.
pub const RIGHT_SIDE: &str = "solve/right_side";
/// Lap of a step: motion of the raceways of periodic rings by the predictor, and compliance of their contacts by
/// the table of responses.
pub const RACEWAYS: &str = "contact/raceways";

/// Whether a round leaves the answer at the ports as it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settling {
    /// It does.
    Settled,
    /// It does not: the forces are to be found again.
    Again,
}

/// How a step ends.
pub enum End {
    /// With this state.
    Done(Box<Ended>),
    /// Not yet: the inertia of the frame has changed, and the forces are to be found again.
    Again,
}

/// The end of a step.
pub struct Ended {
    /// The state at its end.
    pub state: RingState,
    /// Work of the loads in the step.
    pub works: Works,
    /// Kinetic and strain energy at its end, J.
    pub energies: [f64; 2],
    /// What the next step begins with, where it was asked for.
    pub next: Option<Known>,
}

/// Works in a step, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Works {
    /// Of the known load.
    pub load: f64,
    /// Of the inertia of the turning frame.
    pub frame: f64,
}

/// The body on which a ring sits, carried by a shaft, over a step without the ring.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyAlone {
    /// Growth of the forces of the shaft on it with the motion of the shaft at the end, `[5][5]` flat, SI.
    pub stiffness: Vec<f64>,
    /// Motion of the shaft at the end without forces of it, m and rad, under the loads on the body.
    pub predicted: Vec<f64>,
    /// The same without loads.
    pub unloaded: Vec<f64>,
}

/// A factored effective matrix: steps of one scheme and size.
pub trait StepFactor: Send + Sync {
    /// Bytes of the factor and of what belongs to it.
    fn bytes(&self) -> usize;

    /// Of a ring with a defect, see [`solver::cyclic::Defect::iterations`].
    fn iterations(&self) -> Option<usize>;

    /// Motion of the seat of a ring by unit forces on its functions over a step, m/N, `[n][n]` flat; None where the
    /// ring is not on a body that carries others.
    fn seat_compliance(&self) -> Option<&[f64]> {
        None
    }

    /// The same of the seat of the body by unit forces on the functions of a seat on it, `[n][n_others]` flat, with the
    /// shaft that carries the body held.
    fn body_compliance(&self, _seat: &SeatModes) -> Option<Vec<f64>> {
        None
    }

    /// What is found of a known load before the contacts, from a state.
    fn predict(&self, from: &RingState, load: KnownLoad) -> Known;

    /// A step from a state, with what was found of its known load, and contacts at these places.
    fn begin<'a>(
        &'a self,
        from: &'a RingState,
        known: Arc<Known>,
        contacts: Feet<'_>,
    ) -> Box<dyn ElasticStep + 'a>;
}

/// A step of a ring under way.
pub trait ElasticStep: Send {
    /// What its ports see.
    fn answer(&self) -> &PortAnswer;

    /// Wall time of the answer that [`StepFactor::begin`] gave, as far as it is told apart from the block solve.
    fn laps(&self) -> &Laps;

    /// Moves the contacts to other places; says of the time what is told apart from the block solve.
    fn move_contacts(&mut self, contacts: Feet<'_>) -> Laps;

    /// Forces of the joint of ring and body on the functions of its seat, N, under these forces; None: there is none.
    fn forces_of_joint(&self, _forces: PortForces<'_>) -> Option<Vec<f64>> {
        None
    }

    /// Load on the oscillators of the body under forces of the joint.
    fn load_on_body(&self, _joint: &[f64]) -> Vec<f64> {
        Vec::new()
    }

    /// Puts a mean load over the step on these oscillators, in place of the one before: what other rings do to them.
    fn load_body(&mut self, _load: &[f64]) {}

    /// Moves the seat of a body that stands by what other rings do to it over the step, m, in place of their load,
    /// until [`ElasticStep::load_body`] puts this on the body.
    fn move_seat(&mut self, _motion: &[f64]) {}

    /// The body to which the ring is tied, without it; None where no shaft carries one.
    fn body_alone(&self) -> Option<BodyAlone> {
        None
    }

    /// Force and moment of a body that a shaft carries on the ring, mean over the step, N and N m, in the ring's frame
    /// about the origin of the shaft's tilts; None where no shaft carries one.
    fn force_of_body(&self, _forces: PortForces<'_>) -> Option<[f64; 5]> {
        None
    }

    /// Values of a vector of the body at the contacts, in two directions of all their nodal weights.
    fn at_contacts(&self, x: &[f64]) -> Vec<f64>;

    /// The same in those of what is only measured.
    fn at_seen(&self, x: &[f64]) -> Vec<f64>;

    /// One round for the inertia of the turning frame under these forces; `scale` is the largest force of the whole
    /// bearing, N.
    fn settle(&mut self, forces: PortForces<'_>, scale: f64) -> Settling;

    /// Ends the step under these forces. With `next`, looks ahead to a step of the same size under these known loads.
    fn end(&mut self, forces: PortForces<'_>, scale: f64, next: Option<KnownLoad>) -> End;
}
