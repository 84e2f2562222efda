//! Motion in time: rings, balls and shaft by an implicit one-step scheme with energy-conserving contact.
//!
//! Per step and ring, a predictor and the compliance of the contacts; then a small Newton on contacts, balls and shaft:
//!
//! ```text
//! place patches at the azimuths of the weighted time of the integrator, measure the motion at the start with them
//! predictor:  S dw = f - K w + M (...)             one solve per ring
//! compliance: of a periodic ring by a table, of another by columns of its factor
//! Newton on shaft, balls and groove centres: discrete-gradient forces F
//! dw = predictor + S^-1 W F; v, a; energies; ledger
//! ```
//!
//! A periodic ring solves once in a step: one pass over its harmonics (in [`ring`]) ends the solve of a step with the
//! contact forces and begins that of the known loads of the step that follows. Each round for the inertia of the
//! turning frame is a pass as well.

mod advance;
mod cache;
mod cage;
mod cage_state;
mod close;
mod elastic_inertia;
mod finish;
mod finite;
mod free;
mod free_state;
pub mod held;
pub mod ledger;
mod limits;
mod mass_load;
mod part;
mod passing;
mod place;
mod ports;
pub mod report;
mod ring_course;
mod rolling_start;
mod round_off;
pub mod run;
pub mod shape;
pub mod solve;
mod solve_free;
mod span;
pub mod start;
pub mod state;
mod substep;
mod surfaces;

pub use advance::among_threads;
pub use cache::StepCache;
pub use cage_state::CageState;
pub use elastic_inertia::LeftOut;
pub use free_state::{ContactTraction, FreeState};
pub use ledger::{CageLedger, FrictionLedger, Ledger};
pub use limits::{ContactLimit, Exceeded};
pub use ring::{BodyState, Integrator, RingState};
pub use ring_course::RingCourse;
pub use rolling_start::{EquilibriumRates, comparison_time, pose_beside};
pub use run::{Motion, check_supported};
pub use shape::{RingShape, StateShape};
pub use span::PartSpan;
pub use state::{Ladder, MotionSettings, MotionState, PatchPlace, StepReport};
