//! Model, State, effects and the algorithms of the bearing: contact equilibrium, statics.
//!
//! Everything but the contact forces is linear (`design`: factor once, solve a small convex problem for the
//! contacts). This crate does no input or output.

pub mod balls;
mod compliance;
pub mod costs;
pub mod defect;
pub mod defect_change;
pub mod displacements;
pub mod division;
pub mod effects;
pub mod equilibrium;
pub mod error;
pub mod footprint;
pub mod inventory;
pub mod loading;
pub mod memory;
pub mod model;
pub mod modes;
pub mod motion;
pub mod nodal_stress;
pub mod point_stress;
pub mod pose;
pub mod prepared;
pub mod problem;
pub mod quasi_static;
pub mod rank_memory;
pub mod regular;
pub mod ring;
mod sector_stress;
pub mod sectors;
pub mod shared_stress;
pub mod solution;
pub mod sparse;
pub mod statics;
pub mod substructures;
pub mod support;

pub use costs::{EffectCosts, Timing};
pub use effects::{Effect, Loads};
pub use error::DynamicsError;
pub use inventory::Inventory;
pub use memory::{MotionSizes, RingMemory, forecast_motion_peak, forecast_peak};
pub use model::{
    Backend, ContactMode, ContactSettings, Hold, Model, RingModel, Sectors, ShaftDof, Tolerances,
};
pub use modes::{Mode, ModeSet, ModesSettings, RingSupport};
pub use nodal_stress::NodalStress;
pub use point_stress::PointStress;
pub use pose::Pose;
pub use prepared::{Numbers, Prepared};
pub use quasi_static::QuasiStatic;
pub use rank_memory::{RankMemory, Share, forecast_rank_peak};
pub use shared_stress::{SharedStress, StressPlaces};
pub use solution::StaticSolution;
pub use statics::StaticSolver;
pub use substructures::Substructures;
