//! Components about the two axes across the shaft, as summaries write them: an array of two.

use serde::{Serialize, Serializer};

/// A rotation, rad, or a moment, N m, about x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AcrossShaft {
    /// About x.
    pub x: f64,
    /// About y.
    pub y: f64,
}

impl Serialize for AcrossShaft {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        [self.x, self.y].serialize(serializer)
    }
}
