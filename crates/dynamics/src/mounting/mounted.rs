//! What mounting does to rings and balls.

use std::sync::Arc;

use contact::{BySide, Meridian};
use ring::OwnStress;

/// What mounting does to all bodies.
#[derive(Clone, Debug, Default)]
pub struct Grown {
    /// Rings, inner first.
    pub rings: BySide<MountedRing>,
    /// Growth of the balls' radius, m.
    pub ball_radius_growth: f64,
}

/// What mounting does to a ring.
#[derive(Clone, Debug, Default)]
pub struct MountedRing {
    /// Free thermal strain, counted from the reference temperature.
    pub expansion: f64,
    /// Radial growth of the circle of groove centres by temperature, m.
    pub centre_growth: f64,
    /// Growth of the groove's radius by temperature, m.
    pub groove_radius_growth: f64,
    /// Mean motion of the groove by the seat [radial, axial], m.
    pub groove: Meridian,
    /// Nodal displacement of a flexible ring by its seat, in the frame of its mesh, m, `[n_nodes][3]` flat; None: none.
    pub field: Option<Arc<Vec<f64>>>,
    /// Stress of a flexible ring besides that of its displacement, from its own strain; None: none.
    pub own_stress: Option<Arc<OwnStress>>,
}
