//! Makes the elastic body of a ring: the choice of its linear solver.

use std::sync::Arc;

use crate::body::{ElasticBody, Frame, Held, HeldRing, Partner};
use crate::error::RingError;
use crate::harmonic::make::harmonic_body;
use crate::harmonic::periodic::Periodic;
use crate::model::{Backend, RingModel};
use crate::nodal::sector::SectorBody;
use crate::nodal::sparse::SparseBody;

/// What a body is made with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodySettings {
    /// What holds it.
    pub partner: Partner,
    /// Rayleigh damping: C = a M + b K with `[a, b]`.
    pub damping: [f64; 2],
    /// Linear solver.
    pub backend: Backend,
    /// Its frame.
    pub frame: Frame,
}

/// Assembles a ring and prepares its factorisation with the linear solver that fits it. Collective.
pub fn elastic_body(
    name: &'static str,
    ring: &RingModel,
    settings: BodySettings,
) -> Result<Arc<dyn ElasticBody>, RingError> {
    let how = Held {
        hold: ring.hold,
        partner: settings.partner,
    };
    let held = HeldRing {
        damping: settings.damping,
        ..HeldRing::new(name, ring, how, settings.backend)?
    };
    if let Backend::Sector(sectors) = settings.backend {
        return Ok(Arc::new(SectorBody::new(ring, held, sectors)?));
    }
    let held_nodes = held.coordinates.held_nodes();
    match Periodic::new(ring, name, settings.backend, &held_nodes)? {
        Ok(periodic) => harmonic_body(ring, held, periodic, settings.frame),
        Err(why) => Ok(Arc::new(SparseBody::new(ring, held, why)?)),
    }
}
