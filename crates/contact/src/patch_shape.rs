//! Where a contact patch is, and how large: at least a few node spacings, at most up to the edge of the groove.

use crate::error::ContactError;
use crate::raceway::RacewaySurface;
use crate::semi_axes::SemiAxes;

/// Share of the way to the groove's edge that a patch may fill.
const EDGE_SHARE: f64 = 0.98;

/// Where and how large a patch is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchShape {
    /// Azimuth of the ball in the ring's frame, rad.
    pub azimuth: f64,
    /// Contact angle, rad.
    pub angle: f64,
    /// Semi-axes, m.
    pub semi_axes: SemiAxes,
    /// The Hertz ellipse reaches beyond the edge of the groove: edge contact, Hertz theory does not hold.
    pub truncated: bool,
}

/// How small a patch may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastSize {
    /// Least semi-axis in both directions, node spacings.
    pub spacings: f64,
    /// Least semi-axis in the rolling direction, m.
    pub rolling: f64,
}

impl PatchShape {
    /// Shape at an azimuth and contact angle, at least the Hertz ellipse `hertz_axes` (m) and `least`, at most up to
    /// the edge of the groove.
    pub fn new(
        surface: &RacewaySurface,
        azimuth: f64,
        angle: f64,
        hertz_axes: SemiAxes,
        least: LeastSize,
    ) -> Result<PatchShape, ContactError> {
        let spacing = surface.spacing(surface.locate(azimuth, angle)?);
        let room = EDGE_SHARE * surface.rim_distance(angle);
        let groove = hertz_axes.groove.max(least.spacings * spacing[0]).min(room);
        let rolling = hertz_axes
            .rolling
            .max(least.spacings * spacing[1])
            .max(least.rolling);
        Ok(PatchShape {
            azimuth,
            angle,
            semi_axes: SemiAxes::new(groove, rolling),
            truncated: is_truncated(surface, angle, hertz_axes),
        })
    }
}

/// Whether a Hertz ellipse of semi-axes `hertz_axes`, m, at a contact angle, rad, reaches beyond the edge of the
/// groove.
pub fn is_truncated(surface: &RacewaySurface, angle: f64, hertz_axes: SemiAxes) -> bool {
    hertz_axes.groove > EDGE_SHARE * surface.rim_distance(angle)
}
