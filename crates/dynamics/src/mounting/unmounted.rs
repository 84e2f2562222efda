//! The bearing that is mounted: its dimensions, rings and materials.

use std::sync::Arc;

use contact::{BearingGeometry, BySide, Side};
use fem::Material;
use ring::statics::StaticSettings;
use ring::{Backend, Partner, RingModel};

/// The bearing that is mounted.
pub struct Unmounted<'a> {
    /// Its dimensions.
    pub geometry: &'a BearingGeometry,
    /// Diameters of bore and seat, m.
    pub seat_diameters: BySide<f64>,
    /// Flexible rings, inner first; None is a rigid ring.
    pub rings: &'a BySide<Option<Arc<RingModel>>>,
    /// Steel of the rings.
    pub ring_material: Material,
    /// Thermal expansion of rings and balls, 1/K; needed with temperatures.
    pub expansion: BySide<f64>,
    /// Yield strength of the rings, Pa; None: not compared.
    pub yield_strength: Option<f64>,
    /// Largest speed of each ring, rad/s.
    pub speeds: BySide<f64>,
    /// Linear solver of the rings.
    pub backend: Backend,
}

impl Unmounted<'_> {
    /// Radii of a ring's seat and of the bottom of its groove, m.
    pub fn tube_radii(&self, side: Side) -> [f64; 2] {
        let geometry = self.geometry;
        let bottoms = [geometry.inner_raceway_diameter, geometry.outer_raceway_diameter];
        [self.seat_diameters[side.index()], bottoms[side.index()]].map(|d| 0.5 * d)
    }

    /// What a ring is solved with at rest.
    pub fn settings(&self, side: Side) -> StaticSettings {
        StaticSettings {
            name: side.name(),
            partner: Partner::AT_REST,
            backend: self.backend,
            n_contacts: self.geometry.n_balls,
        }
    }
}
