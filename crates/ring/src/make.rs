//! Makes the elastic body of a ring: the choice of its linear solver.

use std::sync::Arc;

use crate::body::{ElasticBody, Frame, Held, HeldRing, Partner};
use crate::error::RingError;
use crate::expansion::centrifugal_expansion;
use crate::factored::FactoredBody;
use crate::harmonic::make::harmonic_body;
use crate::harmonic::periodic::Periodic;
use crate::model::{Backend, Hold, RingModel};
use crate::mount::MountRows;
use crate::nodal::sector::SectorBody;
use crate::nodal::sparse::SparseBody;
use crate::oscillators::Oscillators;
use crate::statics::StaticSettings;
use crate::tied::TiedRing;

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

/// A ring whose body is made.
#[derive(Clone, Copy)]
pub struct MadeRing<'a> {
    /// The ring.
    pub ring: &'a RingModel,
    /// What its body is made with.
    pub settings: BodySettings,
    /// Its body.
    pub body: &'a Arc<FactoredBody>,
}

/// Assembles a ring and prepares its factorisation with the linear solver that fits it. Collective.
pub fn elastic_body(
    name: &'static str,
    ring: &RingModel,
    settings: BodySettings,
) -> Result<Arc<dyn ElasticBody>, RingError> {
    Ok(body_beside(name, ring, settings, &[])?.into_body())
}

/// The same of a ring beside others, whose body it shares with one that is alike. Rings alike that are tied to bodies
/// of their own share what is behind their seats. Collective.
pub fn body_beside(
    name: &'static str,
    ring: &RingModel,
    settings: BodySettings,
    made: &[MadeRing<'_>],
) -> Result<Arc<FactoredBody>, RingError> {
    let is_alike = |made: &&MadeRing<'_>| made.settings == settings && made.ring.is_like(ring);
    let alike = made.iter().find(is_alike).map(|made| made.body);
    if let (None, Some(body)) = (&ring.tie, alike) {
        return Ok(body.clone());
    }
    let how = Held {
        hold: ring.hold,
        partner: settings.partner,
    };
    match settings.frame {
        Frame::Stiffened => check_stiffening(name, ring, settings.backend)?,
        Frame::Still | Frame::Turning => (),
    }
    let held = HeldRing {
        damping: settings.damping,
        ..HeldRing::new(name, ring, how, settings.backend)?
    };
    match (&ring.tie, ring.seat_functions(name)?) {
        (Some(tie), Some(functions)) => {
            // From outside the ring has no mount: the body is part of it.
            let outside = HeldRing {
                coordinates: held.coordinates.clone(),
                places: held.places.clone(),
                mount: MountRows::default(),
                ..held
            };
            let inside = HeldRing {
                mount: MountRows::of_seat(&functions),
                ..held
            };
            let body = Oscillators::new(tie, functions, settings.damping)?;
            let known = alike.and_then(|alike| alike.behind_seat(body.functions()).cloned());
            let ring = match known {
                Some(ring) => ring,
                None => FactoredBody::new(solved_body(ring, inside, settings)?, None),
            };
            let tied = TiedRing::new(ring.clone(), outside, body, settings.frame);
            Ok(FactoredBody::new(Arc::new(tied), Some(ring)))
        }
        _ => Ok(FactoredBody::new(solved_body(ring, held, settings)?, None)),
    }
}

/// Refuses a ring that is not stiffened by the stress of its turning, as far as that is known without its sectors.
fn check_stiffening(name: &'static str, ring: &RingModel, backend: Backend) -> Result<(), RingError> {
    let reason = match (backend, &ring.tie) {
        (Backend::Sector(_), _) => "solver.backend = \"sector\" cuts it into sectors",
        (_, Some(_)) => "it is tied to a body",
        (_, None) => return Ok(()),
    };
    Err(RingError::no_stress_stiffening(name, reason))
}

/// Refuses a ring that is not stiffened by the stress of its turning, before its body is made. Of a periodic ring it
/// assembles a sector.
pub fn require_stiffening(name: &'static str, ring: &RingModel, backend: Backend) -> Result<(), RingError> {
    check_stiffening(name, ring, backend)?;
    let held = match ring.hold {
        Hold::Clamped => ring.mesh.group_nodes(ring.held_group),
        Hold::MeanMotion | Hold::Free => Vec::new(),
    };
    let periodic = Periodic::new(ring, name, backend, &held)?;
    match periodic.ok().and_then(|periodic| periodic.unstiffened(ring)) {
        Some(reason) => Err(RingError::no_stress_stiffening(name, reason)),
        None => Ok(()),
    }
}

/// The body of a ring, held so, with the linear solver that fits it.
fn solved_body(
    ring: &RingModel,
    held: HeldRing,
    settings: BodySettings,
) -> Result<Arc<dyn ElasticBody>, RingError> {
    let name = held.name;
    let expansion = match settings.frame {
        Frame::Stiffened => {
            let BodySettings { partner, backend, .. } = settings;
            let statics = StaticSettings {
                name,
                partner,
                backend,
                n_contacts: 1,
            };
            Some(centrifugal_expansion(ring, statics)?)
        }
        Frame::Still | Frame::Turning => None,
    };
    let expansion = expansion.as_deref();
    if let Backend::Sector(sectors) = settings.backend {
        return Ok(Arc::new(SectorBody::new(ring, held, sectors)?));
    }
    let held_nodes = held.coordinates.held_nodes();
    match Periodic::new(ring, name, settings.backend, &held_nodes)? {
        Ok(periodic) => harmonic_body(ring, held, periodic, (settings.frame, expansion)),
        Err(why) => Ok(Arc::new(SparseBody::new(ring, held, why, expansion)?)),
    }
}
