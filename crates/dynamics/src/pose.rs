//! Where the parts of a bearing stand at an instant: what an equilibrium depends on besides its loads.
//!
//! The cage has carried the balls round by its angle. Each ring has turned by its own: its mesh is turned with it, so
//! a ball at azimuth psi in space touches the mesh at psi minus that angle, and loads that are fixed in space turn
//! backwards on it. Shaft, balls and groove motions are measured in space, in the meridian planes of the balls.

use contact::Side;

use crate::effects::loads::Now;

/// Time and angles of an instant; the default is a bearing that has not turned, at time 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Time, s, and angle the cage has turned, rad.
    pub now: Now<'static>,
    /// Angles the rings have turned since the start, inner first, rad.
    pub ring_angles: [f64; 2],
    /// Angle by which the balls have rolled about their own axes since the start, rad.
    pub rolled: f64,
}

impl Pose {
    /// Angle by which the mesh of a ring is turned in space, rad.
    pub fn frame_angle(&self, side: Side) -> f64 {
        self.ring_angles[side.index()]
    }
}
