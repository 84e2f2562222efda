//! Sizes of a motion's state: what a stored state must have for the motion to go on from it.

pub use ring::RingShape;

use super::run::Motion;

/// Lengths of the arrays of a [`super::MotionState`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateShape {
    /// Balls; there are two contact sites per ball.
    pub n_balls: usize,
    /// Vectors of the inner and the outer ring; None for a rigid ring.
    pub rings: [Option<RingShape>; 2],
    /// Whether the seat of the outer ring slides.
    pub has_seat: bool,
    /// Whether balls are free.
    pub has_free_balls: bool,
    /// How many ends of a free cage a land guides; None: there is no free cage.
    pub cage_ends: Option<usize>,
    /// Whether surfaces have a line in the ledger.
    pub has_profiles: bool,
    /// Whether balls have profiles and are free, so that their orientation evolves.
    pub has_orientations: bool,
    /// Whether temperatures have a line in the ledger.
    pub has_temperature_work: bool,
}

impl Motion<'_> {
    /// Sizes of the states of this motion.
    pub fn shape(&self) -> StateShape {
        StateShape {
            n_balls: self.model.geometry.n_balls,
            rings: [0, 1].map(|i| self.rings[i].as_ref().map(|ring| ring.body.shape())),
            has_seat: self.model.seat().is_some(),
            has_free_balls: self.model.traction().is_some(),
            cage_ends: self.model.cage.as_ref().map(|cage| cage.n_ends()),
            has_profiles: self.has_strips(),
            has_orientations: self.model.traction().is_some() && !self.model.surfaces.balls.is_empty(),
            has_temperature_work: self.model.mounting.changes(),
        }
    }
}
