//! Model, State, effects and the algorithms of the bearing: contact equilibrium, statics.
//!
//! Everything but the contact forces is linear (`design`: factor once, solve a small convex problem for the
//! contacts). This crate does no input or output.

pub mod balls;
pub mod bearing;
pub mod bodies;
mod compliance;
pub mod costs;
pub mod displacements;
pub mod effects;
pub mod equilibrium;
pub mod error;
pub mod footprint;
pub mod frame;
pub mod interactions;
pub mod kinematics;
pub mod loading;
pub mod model;
pub mod modes;
pub mod motion;
pub mod pose;
pub mod quasi_static;
pub mod raceway;
pub mod solution;
pub mod statics;
pub mod system;

pub use effects::{Effect, Loads};
pub use error::DynamicsError;
pub use model::{ContactMode, ContactSettings, Model, ShaftDof, Tolerances};
pub use modes::{Mode, ModeSet, ModesSettings, RingSupport};
pub use pose::Pose;
pub use quasi_static::QuasiStatic;
pub use solution::StaticSolution;
pub use statics::StaticSolver;

// A model and its results are made of rings.
pub use ring::memory::{MotionSizes, RingMemory, forecast_motion_peak, forecast_peak};
pub use ring::rank_memory::{RankMemory, Share, forecast_rank_peak};
pub use ring::statics::{Numbers, Prepared};
pub use ring::stress::{NodalStress, PointStress, SharedStress, StressPlaces};
pub use ring::substructures::Substructures;
pub use ring::{Backend, Hold, Inventory, NodeMasses, RACEWAY_GROUP, RingError, RingModel, Sectors};
