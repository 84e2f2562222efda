//! Lumped bodies of a bearing: shaft and balls.

mod flat;
mod frame_inertia;
mod inertia;
mod tilted_loads;

pub use flat::{AXES, FlatBody, Name};
pub use frame_inertia::{FrameInertia, StepTakes};
pub use inertia::Inertia;
pub use tilted_loads::TiltedLoads;
