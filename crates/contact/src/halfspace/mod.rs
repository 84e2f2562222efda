//! An elastic half-space under a semi-ellipsoidal (Hertz) pressure: its compliance and its stress.

mod axis;
mod carlson;
mod compliance;
mod confocal;
mod curvature;
mod rays;
mod stress;

pub use axis::{Extreme, Subsurface, subsurface};
pub use compliance::patch_compliance;
pub use curvature::{CurvatureRules, CurvedSurface, point_load as curved_point_load};
pub use stress::EllipticPressure;
