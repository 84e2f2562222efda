//! The raceway of a flexible ring as contacts find it.

use contact::quadrature::PressureRule;
use contact::{FacetSurface, RacewaySurface};
use ring::{RACEWAY_GROUP, RingModel};

use crate::model::ContactMode;

/// Searches on the raceway of one ring.
pub struct Raceway {
    /// Raceway in (azimuth, groove angle).
    pub surface: RacewaySurface,
    /// Raceway facets under boxes, in `facet` mode.
    pub facets: Option<FacetSurface>,
    /// Integration rule of the patches.
    pub rule: PressureRule,
}

impl Raceway {
    /// The raceway of a ring.
    pub fn new(ring: &RingModel, mode: ContactMode) -> Raceway {
        let (mesh, facets) = (&ring.mesh, ring.mesh.group(RACEWAY_GROUP));
        Raceway {
            surface: RacewaySurface::new(mesh, facets, ring.groove),
            facets: (mode == ContactMode::Facet).then(|| FacetSurface::new(mesh, facets, ring.groove)),
            rule: PressureRule::new(),
        }
    }
}
