//! Semi-axes of ellipses on a raceway: those of a contact, and those of the patch that spreads its force.

use serde::Serialize;

/// Semi-axes of an ellipse on a raceway, m; in files `[groove, rolling]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[serde(into = "[f64; 2]")]
pub struct SemiAxes {
    /// Along the groove, across the track.
    pub groove: f64,
    /// In the rolling direction.
    pub rolling: f64,
}

impl SemiAxes {
    /// Those along the groove and in the rolling direction.
    pub const fn new(groove: f64, rolling: f64) -> SemiAxes {
        SemiAxes { groove, rolling }
    }

    /// The larger one.
    pub fn major(self) -> f64 {
        self.groove.max(self.rolling)
    }

    /// The smaller one.
    pub fn minor(self) -> f64 {
        self.groove.min(self.rolling)
    }

    /// What a function makes of each.
    pub fn map(self, f: impl Fn(f64) -> f64) -> SemiAxes {
        SemiAxes::new(f(self.groove), f(self.rolling))
    }
}

impl From<[f64; 2]> for SemiAxes {
    fn from([groove, rolling]: [f64; 2]) -> SemiAxes {
        SemiAxes { groove, rolling }
    }
}

impl From<SemiAxes> for [f64; 2] {
    fn from(axes: SemiAxes) -> [f64; 2] {
        [axes.groove, axes.rolling]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: columns, summaries and half-spaces would have the semi-axes in another order than they are named.
    #[test]
    fn semi_axes_come_back_from_their_pair() {
        let axes = SemiAxes::new(1.0, 2.0);
        assert_eq!(<[f64; 2]>::from(axes), [1.0, 2.0]);
        assert_eq!(SemiAxes::from([1.0, 2.0]), axes);
        assert_eq!((axes.major(), axes.minor()), (2.0, 1.0));
    }
}
