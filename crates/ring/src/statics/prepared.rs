//! A held ring ready to be factored for statics, with a forecast of its memory: all that is known before a number is
//! factored.

use super::harmonic::HarmonicStiffness;
use super::sector::SectorStiffness;
use super::sparse::SparseStiffness;
use super::stiffness::{HeldStiffness, Numbers};
use crate::body::{Held, Partner};
use crate::error::RingError;
use crate::harmonic::periodic::Periodic;
use crate::model::{Backend, Hold, RingModel};
use crate::support::AppliedHold;

/// What a ring is made with for statics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaticSettings {
    /// `inner` or `outer`.
    pub name: &'static str,
    /// What holds it in motion, for forecasts.
    pub partner: Partner,
    /// Linear solver.
    pub backend: Backend,
    /// Contacts whose columns are kept.
    pub n_contacts: usize,
}

/// A ring before its factorisation.
pub struct Prepared {
    /// Its hold.
    pub(super) support: AppliedHold,
    /// Its stiffness.
    pub stiffness: Box<dyn HeldStiffness>,
}

impl Prepared {
    /// Assembles a ring and analyses its factorisation. Collective.
    pub fn new(ring: &RingModel, settings: StaticSettings, numbers: Numbers) -> Result<Prepared, RingError> {
        let StaticSettings {
            name,
            partner,
            backend,
            n_contacts,
        } = settings;
        let mesh = &ring.mesh;
        let places = ring.places(name, backend)?;
        let weights = fem::surface::facet_node_weights(mesh, mesh.group(ring.held_group));
        if let Backend::Sector(sectors) = backend {
            let support = AppliedHold::new(mesh, ring.hold, weights, places);
            let stiffness = SectorStiffness::new(name, ring, &support, numbers, (sectors, n_contacts))?;
            return Ok(Prepared {
                support,
                stiffness: Box::new(stiffness),
            });
        }
        let held_nodes = match ring.hold {
            Hold::Clamped => mesh.group_nodes(ring.held_group),
            Hold::MeanMotion | Hold::Free => Vec::new(),
        };
        match Periodic::new(ring, name, backend, &held_nodes)? {
            Ok(periodic) => {
                let how = Held {
                    hold: ring.hold,
                    partner,
                };
                let stiffness = HarmonicStiffness::new(name, ring, periodic, (&held_nodes, how))?;
                Ok(Prepared {
                    support: AppliedHold::unfixed(mesh, ring.hold, weights, places),
                    stiffness: Box::new(stiffness),
                })
            }
            Err(why) => {
                let support = AppliedHold::new(mesh, ring.hold, weights, places);
                let stiffness = SparseStiffness::new(name, ring, &support, numbers, (why, n_contacts))?;
                Ok(Prepared {
                    support,
                    stiffness: Box::new(stiffness),
                })
            }
        }
    }
}
