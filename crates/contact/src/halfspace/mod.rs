//! An elastic half-space under a semi-ellipsoidal (Hertz) pressure: its compliance and its stress.

mod axis;
mod carlson;
mod compliance;
mod confocal;
mod curvature;
mod rays;
mod stress;
mod target;

pub use axis::{Extreme, Subsurface, subsurface};
pub use compliance::patch_compliance;
pub use curvature::{CurvatureRules, CurvedSurface};
pub use stress::EllipticPressure;
pub use target::point_load as curved_point_load;
