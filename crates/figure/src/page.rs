//! Sizes of what stands on the page, and rectangles on it. Lengths are SVG pixels, y downward.

/// Size of running text.
pub const TEXT: f64 = 13.0;
/// Size of titles.
pub const TITLE: f64 = 15.0;
/// Free space at the edges of the picture, and between its parts.
pub const GAP: f64 = 8.0;
/// Distance of the labels of ticks from their axis.
pub const TICK: f64 = 10.0;
/// Width of the lines of axes and references, in units of the drawing.
pub const LINE_WIDTH: u32 = 10;

/// A rectangle with left, top, right and bottom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Rect {
    /// Whether two rectangles share an area.
    pub fn overlaps(&self, other: &Rect) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }

    /// The point of it that is nearest to another.
    pub fn nearest(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x.clamp(self.left, self.right), y.clamp(self.top, self.bottom)]
    }

    /// Whether `other` lies inside.
    pub fn holds(&self, other: &Rect) -> bool {
        self.left <= other.left
            && other.right <= self.right
            && self.top <= other.top
            && other.bottom <= self.bottom
    }
}
