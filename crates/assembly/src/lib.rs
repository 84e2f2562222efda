//! Several bearings on one shaft, at rest and in [`motion`].
//!
//! Each bearing is a [`dynamics::Model`] whose shaft is prescribed: it answers a displacement of its axis point by a
//! load and a tangent ([`support`]). The shaft is rigid or a chain of beam elements ([`shaft`], [`beam`]). An outer
//! Newton balances it ([`newton`]):
//!
//! ```text
//! K q + sum over bearings  S^T T^T r(T S q + shift)  =  f
//! S  displacement of the shaft at the bearing's place,  T  rotation into the bearing's frame (`place`)
//! ```
//!
//! So nothing in a bearing knows of the others, and rings, balls and contacts are those of a bearing alone. Bearings of
//! one type share their rings and the factors of these. Bearings in one elastic body feel each other through it as well
//! (`housing`).

pub mod assembly;
pub mod beam;
mod body_rounds;
mod error;
mod housing;
mod housing_damping;
pub mod loads;
mod mixing;
pub mod modes;
pub mod motion;
pub mod newton;
pub mod place;
pub mod points;
pub mod shaft;
mod side_by_side;
pub mod stiffness;
pub mod support;
pub mod whirl;
mod whirl_bodies;
mod whirl_in_bodies;
mod whirl_kept;
mod whirl_rows;

pub use assembly::{Assembly, AssemblySolution, AssemblySolver, AssemblyStart};
pub use beam::{BeamSection, BeamShaft, PointMass};
pub use error::AssemblyError;
pub use housing::HousedTogether;
pub use loads::ShaftLoads;
pub use motion::{AssemblyMotion, AssemblyState};
pub use place::{MountedBearing, Orientation, Seating};
pub use ring::rigid::RigidInertia;
pub use shaft::{ShaftBody, Station};
