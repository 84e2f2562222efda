//! A rotationally periodic ring, solved harmonic by harmonic, and what its defects change.
//!
//! Its state stays in harmonic space while it moves ([`space`]); one pass over the harmonics ends a step and begins
//! the solve of the next ([`pass`]). Defects (moved, missing or otherwise held nodes) are forces on few rows of the
//! regular ring. Where nodes are free that most sectors hold, the vectors are coordinates and only the solves are
//! harmonic ([`loose`]).

mod body;
pub mod defect;
pub mod defect_change;
mod defect_step;
mod factor;
pub(crate) mod harmonics;
mod loose;
pub(crate) mod make;
mod pass;
pub mod periodic;
pub mod regular;
mod rigid;
mod space;
pub(crate) mod space_defect;
mod step;
mod touch;
