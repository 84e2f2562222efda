//! A part of a step: when it begins and how long it is.

/// A part of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartSpan {
    /// Time at its start, s.
    pub start: f64,
    /// Its size, s.
    pub dt: f64,
    /// Its rung of the ladder.
    pub rung: u32,
}

impl PartSpan {
    /// Time at a share of the part, s.
    pub fn at(&self, share: f64) -> f64 {
        self.start + share * self.dt
    }
}
