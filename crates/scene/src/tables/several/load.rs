//! Loads along a shaft.

/// A load on the shaft.
#[derive(Clone, Debug, PartialEq)]
pub struct ShaftLoad {
    /// Position along the shaft, m.
    pub position: f64,
    /// Force, N.
    pub force: [f64; 3],
    /// Moment about x and y, N m.
    pub moment: [f64; 2],
}
