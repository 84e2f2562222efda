//! Stress of a ring from its displacements: at nodes and at integration points, of the whole ring or by sectors on
//! their ranks.

pub mod nodal;
pub mod point;
mod sector;
pub mod shared;

pub use nodal::NodalStress;
pub use point::PointStress;
pub use shared::{SharedStress, StressPlaces};
