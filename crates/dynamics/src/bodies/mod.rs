//! Lumped bodies of a bearing: shaft, balls, cage.

mod cage;
mod flat;
mod frame_inertia;
mod free_ball;
mod inertia;
mod large_tilt;
mod shaft_course;
mod tilted_loads;

pub use cage::CageBody;
pub use flat::{AXES, FlatBody, Name};
pub use frame_inertia::{FrameInertia, StepTakes};
pub use free_ball::FreeBall;
pub use inertia::Inertia;
pub use large_tilt::LargeTilt;
pub use shaft_course::ShaftStart;
pub use tilted_loads::TiltedLoads;

/// Coordinates at the start of a step where they count from there.
const UNMOVED: [f64; 6] = [0.0; 6];
