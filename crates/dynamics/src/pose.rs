//! Where the parts of a bearing stand at an instant: what an equilibrium depends on besides its loads.
//!
//! The cage has carried the balls round by its angle. The inner ring has turned by its own: its mesh is turned with
//! it, so a ball at azimuth psi in space touches the mesh at psi minus that angle, and loads that are fixed in space
//! turn backwards on it. Shaft, balls and groove motions are measured in space, in the meridian planes of the balls.

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
    /// Angle the inner ring has turned since the start, rad.
    pub inner_angle: f64,
}

impl Pose {
    /// Angle by which the mesh of a ring is turned in space, rad.
    pub fn frame_angle(&self, side: Side) -> f64 {
        match side {
            Side::Inner => self.inner_angle,
            Side::Outer => 0.0,
        }
    }

    /// Loads of which those on the nodes of a flexible inner ring are given in its own frame, and the shaft carries
    /// their resultant where the turned nodes stand. `inertia` is a load in that frame, N, `[n_nodes][3]` flat.
    /// Collective.
    pub(crate) fn in_frames(
        &self,
        model: &Model,
        mut loads: Loads,
        inertia: Option<Vec<f64>>,
    ) -> Result<Loads, DynamicsError> {
        let Some(ring) = model.ring(Side::Inner) else {
            return Ok(loads);
        };
        let in_space = loads.rings[Side::Inner.index()].take();
        let turned = in_space.map(|load| turn_nodal(&load, -self.inner_angle));
        let load = match (turned, inertia) {
            (Some(load), Some(inertia)) => Some(load.iter().zip(&inertia).map(|(a, b)| a + b).collect()),
            (load, inertia) => load.or(inertia),
        };
        if let Some(load) = &load {
            let places = ring.places(Side::Inner.name(), model.backend)?;
            let resultant = resultant(&places, ring.groove.centre_z, load);
            loads.ring_on_shaft = turn(resultant, self.inner_angle);
        }
        loads.rings[Side::Inner.index()] = load;
        Ok(loads)
    }
}
