//! Lumped bodies of a bearing: shaft and balls.

mod flat;
mod frame_inertia;
mod free_ball;
mod inertia;
mod tilted_loads;

pub use flat::{AXES, FlatBody, Name};
pub use frame_inertia::{FrameInertia, StepTakes};
pub use free_ball::FreeBall;
pub use inertia::Inertia;
pub use tilted_loads::TiltedLoads;
