//! Points of the data of a figure.

/// A point in the units of the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DataPoint {
    /// Along the horizontal axis.
    pub x: f64,
    /// Along the vertical axis.
    pub y: f64,
}

impl DataPoint {
    /// Interrupts a line.
    pub const GAP: DataPoint = DataPoint::new(f64::NAN, f64::NAN);

    /// A point at `x` and `y`.
    pub const fn new(x: f64, y: f64) -> DataPoint {
        DataPoint { x, y }
    }

    /// Its place along axis 0 (x) or 1 (y).
    pub(crate) fn along(self, axis: usize) -> f64 {
        [self.x, self.y][axis]
    }
}

impl From<[f64; 2]> for DataPoint {
    fn from([x, y]: [f64; 2]) -> DataPoint {
        DataPoint { x, y }
    }
}
