//! How a bearing is mounted and how warm it is, as the effects of a scene say.

use contact::{BySide, Side};
use input::schedule::piecewise_linear;
use ring::RadialProfile;

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
    /// Density of the partner, kg/m3; None: that of the rings.
    pub density: Option<f64>,
}

/// Temperatures, and how partners of other materials expand.
#[derive(Clone, Debug, PartialEq)]
pub struct Temperatures {
    /// Rings, inner first.
    pub rings: BySide<RingTemperature>,
    /// Balls.
    pub balls: TemperatureSchedule,
    /// Shaft and housing; None: that of the ring at its seat.
    pub partners: BySide<Option<TemperatureSchedule>>,
    /// At which all dimensions hold, K.
    pub reference: f64,
    /// Thermal expansion of shaft and housing, 1/K; None: that of the rings.
    pub partner_expansion: BySide<Option<f64>>,
}

/// Temperature of a ring.
#[derive(Clone, Debug, PartialEq)]
pub enum RingTemperature {
    /// The same all through.
    Uniform(TemperatureSchedule),
    /// By radius, K, constant in time.
    Radial(RadialProfile),
}

/// Temperature of a body over time: linear between its times, constant before the first and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct TemperatureSchedule {
    /// Times, s, growing, `[n]`, n at least 1.
    pub times: Vec<f64>,
    /// Temperatures, K, `[n]`.
    pub values: Vec<f64>,
}

impl TemperatureSchedule {
    /// One temperature at all times, K.
    pub fn constant(kelvin: f64) -> TemperatureSchedule {
        TemperatureSchedule {
            times: vec![0.0],
            values: vec![kelvin],
        }
    }

    /// Temperature at a time in s, K.
    pub fn at(&self, time: f64) -> f64 {
        piecewise_linear(&self.times, &self.values, time)[0]
    }

    /// Whether it changes.
    pub fn changes(&self) -> bool {
        self.values.iter().any(|value| *value != self.values[0])
    }
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
