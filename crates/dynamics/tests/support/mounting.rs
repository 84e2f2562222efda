//! Bearings with fits, temperatures and seat forms, for tests.

use std::sync::Arc;

use contact::{BearingGeometry, Side};
use dynamics::mounting::{
    Conditions, Fit, Mounting, RingTemperature, TemperatureSchedule, Temperatures, Unmounted,
};
use dynamics::{Backend, Hold, Model, RingModel};

use super::rings::{Level, ring};
use super::steel;

/// Interference of the examples, m.
pub const I: f64 = 10e-6;
/// Thermal expansion of the examples, 1/K.
pub const ALPHA: f64 = 11.5e-6;
pub const RINGS: [Option<Arc<RingModel>>; 2] = [None, None];

pub fn unmounted<'a>(geometry: &'a BearingGeometry, rings: &'a [Option<Arc<RingModel>>; 2]) -> Unmounted<'a> {
    Unmounted {
        geometry,
        seat_diameters: [50e-3, 80e-3],
        rings,
        ring_material: steel(),
        expansion: [ALPHA; 2],
        yield_strength: None,
        speeds: [0.0; 2],
        backend: Backend::Auto,
    }
}

pub fn fit(interference: f64, partner_diameter: f64) -> Option<Fit> {
    Some(Fit {
        interference,
        partner_diameter,
        young_modulus: None,
        poisson_ratio: None,
        density: None,
    })
}

/// Inner ring on a solid shaft, outer ring in a housing twice as large.
pub fn fitted() -> Conditions {
    Conditions {
        fits: [fit(I, 0.0), fit(I, 160e-3)],
        ..Conditions::default()
    }
}

pub fn at(inner: f64, outer: f64, balls: f64, [shaft, housing]: [f64; 2]) -> Conditions {
    let kelvin = |celsius: f64| TemperatureSchedule::constant(celsius + 273.15);
    Conditions {
        temperatures: Some(Temperatures {
            rings: [kelvin(inner), kelvin(outer)].map(RingTemperature::Uniform),
            balls: kelvin(balls),
            partners: [Some(kelvin(shaft)), Some(kelvin(housing))],
            reference: 293.15,
            partner_expansion: [None; 2],
        }),
        ..Conditions::default()
    }
}

pub fn flexible(hold: Hold) -> [Option<Arc<RingModel>>; 2] {
    let level = Level::hex8(60, 12, 4, 8);
    Side::BOTH.map(|side| Some(Arc::new(ring(side, level, hold))))
}

pub fn mount(rings: &[Option<Arc<RingModel>>; 2], conditions: &Conditions) -> Mounting {
    let geometry = BearingGeometry::reference_7010c();
    Mounting::new(&unmounted(&geometry, rings), conditions).unwrap()
}

pub fn message(rings: &[Option<Arc<RingModel>>; 2], conditions: &Conditions) -> String {
    let geometry = BearingGeometry::reference_7010c();
    Mounting::new(&unmounted(&geometry, rings), conditions)
        .unwrap_err()
        .to_string()
}

/// A model with what conditions make of it.
pub fn mounted_model(model: Model, conditions: &Conditions) -> Model {
    let mounting = mount(&model.rings, conditions);
    Model { mounting, ..model }
}
