//! The workspace of one flexible ring in statics: its factored stiffness and the displacement under loads.
//!
//! A periodic ring is factored harmonic by harmonic from one sector, any other as one sparse matrix. Cost: one
//! factorisation; then one solve per right-hand side. Displacements are elastic, relative to the rigid partner (see
//! [`crate::support`]).

mod harmonic;
mod held;
mod prepared;
mod seat;
mod sector;
mod solver;
mod sparse;
mod stiffness;
mod tie;

pub use held::iterations_note;
pub use prepared::{Prepared, StaticSettings};
pub use solver::{ASSEMBLE, FACTOR, RingSolver};
pub use stiffness::{Factored, HeldStiffness, Numbers};
pub use tie::SeatResponse;
