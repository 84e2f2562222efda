//! Marks on balls.

use contact::surface::{Profiles, Spall};

/// A spall on the equator of a ball at a longitude, wider than the ellipses and their latitudes.
pub fn spall(longitude: f64, length: f64, depth: f64) -> Profiles {
    Profiles {
        spalls: vec![Spall {
            azimuth: longitude,
            groove_angle: 0.0,
            length,
            width: 5e-3,
            depth,
            edge: 0.05e-3,
        }],
        ..Profiles::default()
    }
}
