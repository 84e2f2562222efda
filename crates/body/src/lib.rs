//! An elastic body round a ring, such as a housing: its seats, and its exact flexibility there.
//!
//! A body meets a ring in functions of their common cylinder ([`SeatSpace`]): Fourier round it, Legendre across it. Of
//! each side of the joint [`SeatFunctions`] measure a displacement and spread a traction, with the areas of its own
//! nodes, so that neither mesh need know the other. A [`Surrounding`] comes from a Gmsh mesh, or from the matrix of
//! another program ([`matrix`]). At rest it is condensed exactly: F = Phi^T K^-1 Phi.
//!
//! Cost: one sparse factorisation, and one solve per function of the seats; 225 with 12 harmonics and 2 degrees
//! across. The factor is kept for the displacement of the whole body. In motion a body is reduced to these functions
//! and its own modes up to a frequency ([`BodyModes`]).

mod apparent;
mod areas;
mod carried;
mod definite;
mod error;
mod frame;
mod joint;
mod loaded;
mod loads;
pub mod matrix;
mod mean_motion;
mod memory;
mod nodes;
mod on_shaft;
mod oscillators;
mod rigid_part;
mod rows;
mod seat;
mod surrounding;
mod tie;
mod turning;
mod vibration;

pub use apparent::Apparent;
pub use areas::cylinder_areas;
pub use carried::{Carried, CarriedInertia, N_SHAFT};
pub use error::SurroundingError;
pub use frame::{FrameForms, length};
pub use joint::BodySeat;
pub use loads::{BesideRing, BodyLoad, UnitLoads};
pub use memory::{MakingBytes, joint_bytes};
pub use oscillators::{BodyModes, SeatModes, ShaftAtSeat, shaft_motion};
pub use rows::{SeatRows, lane_dot};
pub use seat::{SeatBasis, SeatCylinder, SeatFunctions, SeatSpace};
pub use surrounding::Surrounding;
pub use tie::{SeatTie, SeatTraction, TieConvergence};
