//! A bearing: what it is, its bodies and interactions, and what is computed of it.
//!
//! Everything but the contact forces is linear: each ring is factored once, and the nonlinear system of contacts, balls
//! and shaft is small. This crate does no input or output. Its modules in the order in which they are read:

// What a bearing is.
pub mod effects;
pub mod kinematics;
pub mod model;
pub mod mounting;

// Its bodies and interactions over an interval, and the system that they make.
pub mod bearing;
pub mod bodies;
pub mod interactions;
pub mod system;

// At rest.
pub mod displacements;
pub mod equilibrium;
pub mod loading;
pub mod points;
pub mod quasi_static;
pub mod solution;
pub mod statics;

// In motion, and about its equilibrium.
mod following;
pub mod modes;
pub mod motion;
pub mod moved_seat;
pub mod moving_patches;
mod orbit;
mod patches_beside;
pub mod stiffness;
pub mod whirl;

// What they share.
pub mod balls;
mod compliance;
pub mod condensation;
pub mod costs;
pub mod error;
pub mod footprint;
pub mod frame;
pub mod pose;
pub mod raceway;
mod relaxation;
pub mod shoulders;
pub mod surface_equilibrium;
pub mod surfaces;
mod unloaded_balls;

pub use effects::{Effect, Loads};
pub use error::DynamicsError;
pub use model::{ContactMode, ContactSettings, Model, ShaftDof, Tolerances};
pub use modes::{Mode, ModeSet, ModesSettings, RingSupport};
pub use mounting::Mounting;
pub use pose::Pose;
pub use quasi_static::QuasiStaticMotion;
pub use solution::StaticSolution;
pub use statics::StaticSolver;
pub use stiffness::{DampingLaws, Linearisation};
pub use surfaces::Surfaces;

// A model and its results are made of rings.
pub use ring::OwnStress;
pub use ring::memory::{MotionMemory, RingMemory, forecast_motion_peak, forecast_peak};
pub use ring::rank_memory::{RankMemory, Share, forecast_rank_peak};
pub use ring::statics::{Numbers, Prepared};
pub use ring::stress::{NodalStress, PointStress, SharedStress, StressPlaces};
pub use ring::substructures::Substructures;
pub use ring::{Backend, Hold, Inventory, NodeMasses, RACEWAY_GROUP, RingError, RingModel, Sectors};
