//! How a bearing is mounted and how warm it is, as the effects of a scene say.

use contact::{BySide, Side};

/// What acts on rings and balls before any load.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Conditions {
    /// Interference of bore and seat with their partners, inner first.
    pub fits: BySide<Option<Fit>>,
    /// Temperatures of all bodies.
    pub temperatures: Option<Temperatures>,
    /// Seats of partners that are not round.
    pub seat_forms: Vec<SeatForm>,
}

/// Interference of a ring with its partner, a thick tube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Diametral, at the reference temperature, m; negative is clearance.
    pub interference: f64,
    /// Bore of the shaft, 0 if it is solid, or outside diameter of the housing, m.
    pub partner_diameter: f64,
    /// Young's modulus of the partner, Pa; None: that of the rings.
    pub young_modulus: Option<f64>,
    /// Poisson's ratio of the partner; None: that of the rings.
    pub poisson_ratio: Option<f64>,
}

/// Temperatures, and how partners of other materials expand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Temperatures {
    /// Rings, inner first, K.
    pub rings: BySide<f64>,
    /// Balls, K.
    pub balls: f64,
    /// Shaft and housing, K.
    pub partners: BySide<f64>,
    /// At which all dimensions hold, K.
    pub reference: f64,
    /// Thermal expansion of shaft and housing, 1/K; None: that of the rings.
    pub partner_expansion: BySide<Option<f64>>,
}

/// A wave of a seat's radius round the circumference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeatForm {
    /// The ring on the seat.
    pub side: Side,
    /// Waves round the circumference, at least 2.
    pub order: usize,
    /// Deviation of the radius at a crest, m.
    pub amplitude: f64,
    /// Azimuth of a crest in the frame of the ring, rad.
    pub azimuth: f64,
}

impl Conditions {
    /// Whether nothing acts.
    pub fn is_none(&self) -> bool {
        *self == Conditions::default()
    }
}
