//! Motion in time: rings, balls and shaft by an implicit one-step scheme with energy-conserving contact.
//!
//! Per step and ring, a predictor and the compliance of the contacts; then a small Newton on contacts, balls and shaft:
//!
//! ```text
//! place patches at the azimuths of the weighted time of the integrator, measure the motion at the start with them
//! predictor:  S dw = f - K w + M (...)             one solve per ring
//! compliance: of a periodic ring by a table, of another by columns S^-1 W in the same block solve
//! Newton on shaft, balls and groove centres: discrete-gradient forces F
//! dw = predictor + S^-1 W F; v, a; energies; ledger
//! ```
//!
//! A periodic ring solves once in a step: one pass over its harmonics (`pass`) ends the solve of a step with the contact forces and begins that
//! of the known loads of the step that follows. Each round for the inertia of the turning frame is a pass as well.

mod ahead;
pub mod balls;
pub mod body;
pub mod by_sector;
mod close;
pub mod contacts;
pub mod coordinates;
mod defect;
pub mod effective;
mod finish;
pub mod frame;
mod harmonic;
mod harmonic_step;
pub mod integrator;
pub mod ledger;
mod limits;
pub mod matrices;
pub mod newton;
mod part;
mod pass;
mod place;
pub mod pool;
pub mod report;
pub mod ring;
mod ring_state;
pub mod run;
pub mod shaft;
pub mod shape;
pub mod small;
pub mod space;
pub mod space_defect;
pub mod start;
pub mod state;
mod substep;
mod touch;
mod vectors;

pub use integrator::Integrator;
pub use ledger::Ledger;
pub use limits::{ContactLimit, Exceeded};
pub use run::Motion;
pub use shape::{RingShape, StateShape};
pub use start::check_supported;
pub use state::{Ladder, MotionSettings, MotionState, StepReport, StepSeconds};
