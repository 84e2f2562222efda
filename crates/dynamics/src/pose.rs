//! Where the parts of a bearing stand at an instant: what an equilibrium depends on besides its loads.
//!
//! The cage has carried the balls round by its angle. Each ring has turned by its own: its mesh is turned with it, so
//! a ball at azimuth psi in space touches the mesh at psi minus that angle, and loads that are fixed in space turn
//! backwards on it. Shaft, balls and groove motions are measured in space, in the meridian planes of the balls.

use contact::Side;

use crate::effects::{Loads, Now, resultant};
use crate::error::DynamicsError;
use crate::frame::{turn, turn_nodal};
use crate::model::Model;

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

    /// Loads of which those on the nodes of flexible rings are given in the rings' own frames, and the shaft carries
    /// the resultant on the inner ring where the turned nodes stand. `inertia` are loads in these frames, inner first,
    /// N, `[n_nodes][3]` flat; they have no force along z. Collective.
    pub(crate) fn in_frames(
        &self,
        model: &Model,
        mut loads: Loads,
        inertia: [Option<Vec<f64>>; 2],
    ) -> Result<Loads, DynamicsError> {
        for (side, inertia) in Side::BOTH.into_iter().zip(inertia) {
            let in_space = loads.rings[side.index()].take();
            let turned = in_space.map(|load| turn_nodal(&load, -self.frame_angle(side)));
            loads.rings[side.index()] = match (turned, inertia) {
                (Some(load), Some(inertia)) => Some(load.iter().zip(&inertia).map(|(a, b)| a + b).collect()),
                (load, inertia) => load.or(inertia),
            };
        }
        let inner = model.ring(Side::Inner).zip(loads.rings[0].as_ref());
        if let Some((ring, load)) = inner {
            let places = ring.places(Side::Inner.name(), model.backend)?;
            let resultant = resultant(&places, ring.groove.centre_z, load);
            loads.ring_on_shaft = turn(resultant, self.frame_angle(Side::Inner));
        }
        Ok(loads)
    }
}
