//! One elastic ring: its matrices, how it is held, and its linear solvers behind one border.
//!
//! A ring is made once ([`elastic_body`]) and factored for a scheme of steps; a step meets the world at its ports,
//! the contacts and the mount ([`step`]). Whether one sparse factor, sectors or harmonics solve it is nobody's
//! business outside. This crate does no input or output and knows no balls.

pub mod body;
pub mod coordinates;
pub mod division;
pub mod error;
pub mod expansion;
pub mod factored;
pub mod first_frequency;
mod free;
mod harmonic;
mod inertia;
pub mod integrator;
pub mod inventory;
mod make;
mod matrices;
pub mod memory;
pub mod model;
mod mount;
mod nodal;
mod oscillators;
pub mod pool;
pub mod rank_memory;
pub mod rigid;
pub mod seat;
mod settling;
pub mod sparse;
pub mod state;
pub mod statics;
pub mod step;
pub mod stress;
pub mod substructures;
pub mod support;
mod tied;
pub mod vectors;
pub mod vibration;

pub use body::{ElasticBody, Frame, Held, HeldRing, Partner, RingShape};
pub use error::RingError;
pub use factored::FactoredBody;
pub use integrator::{Integrator, StepScheme};
pub use inventory::Inventory;
pub use make::{BodySettings, MadeRing, body_beside, elastic_body, require_stiffening};
pub use model::{Backend, Hold, NodeMasses, RACEWAY_GROUP, RingModel, Sectors};
pub use oscillators::Oscillators;
pub use seat::{OwnStress, RadialProfile, SeatAction, SeatField};
pub use solver::SolverError;
pub use state::{BodyState, RingState};
pub use step::{
    BodyAlone, ElasticStep, End, Ended, Feet, FrameTurn, Known, KnownLoad, PortAnswer, PortForces, Settling,
    StepFactor, Works,
};
pub use vibration::{RingToVibrate, VibratingRing, VibratingRings};
