//! The line of a ball that meets a groove, where the ball is no sphere: what strips ([`crate::strips`]) miss besides.

/// What is missing of a ball along the line that meets a groove: linear between corners, level beyond them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WornLine<'l> {
    /// Radius of the ball, m.
    pub radius: f64,
    /// Contact angles at which the corners are touched, rad, rising, at least two.
    pub angles: &'l [f64],
    /// Missing material w_b at them, m; negative is a bump.
    pub missing: &'l [f64],
}

impl WornLine<'_> {
    /// Slope of w_b, m/rad, and its value on the line through a piece at an angle, m: piece k ends at corner k.
    pub(crate) fn piece(&self, k: usize, angle: f64) -> (f64, f64) {
        let n = self.angles.len();
        if k == 0 || k == n {
            return (0.0, self.missing[k.min(n - 1)]);
        }
        let slope = (self.missing[k] - self.missing[k - 1]) / (self.angles[k] - self.angles[k - 1]);
        (slope, self.missing[k - 1] + slope * (angle - self.angles[k - 1]))
    }
}
