//! Sizes of a motion's state: what a stored state must have for the motion to go on from it.

use super::run::Motion;

/// Lengths of the arrays of a [`super::MotionState`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateShape {
    /// Balls; there are two contact sites per ball.
    pub n_balls: usize,
    /// Coordinates of the inner and the outer ring; None for a rigid ring.
    pub ring_dofs: [Option<usize>; 2],
}

impl Motion<'_> {
    /// Sizes of the states of this motion.
    pub fn shape(&self) -> StateShape {
        StateShape {
            n_balls: self.model.geometry.n_balls,
            ring_dofs: [0, 1].map(|i| self.rings[i].as_ref().map(|ring| ring.coordinates.n())),
        }
    }
}
