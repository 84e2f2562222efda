//! Lumped bodies of a bearing: shaft and balls.

mod flat;
mod inertia;

pub use flat::{AXES, FlatBody, Name};
pub use inertia::Inertia;
