//! Motion in time: rings, balls and shaft by an implicit one-step scheme with energy-conserving contact.
//!
//! Per step and ring, one predictor solve and one block of columns; then a small Newton on contacts and balls; no further
//! solve:
//!
//! ```text
//! place patches at the azimuths of the middle of the step, measure the motion at its start with them
//! predictor: S dw = f - K w + M (...)             one solve per ring
//! columns:   X = S^-1 W                           one block solve per ring, 2 directions per contact
//! Newton on balls and groove centres: discrete-gradient forces F
//! dw = predictor + X F; v, a; energies; ledger
//! ```

pub mod balls;
pub mod body;
pub mod contacts;
pub mod coordinates;
pub mod effective;
mod finish;
pub mod frame;
pub mod integrator;
pub mod ledger;
pub mod newton;
mod place;
pub mod report;
pub mod ring;
pub mod run;
pub mod shaft;
pub mod shape;
pub mod small;
mod sparse;
pub mod start;
pub mod state;
mod substep;

pub use integrator::Integrator;
pub use ledger::Ledger;
pub use run::Motion;
pub use shape::StateShape;
pub use start::check_supported;
pub use state::{Ladder, MotionSettings, MotionState, StepReport, StepSeconds};
