//! A held ring ready to be factored for statics, with a forecast of its memory: all that is known before a number is
//! factored.

use super::Factored;
use super::harmonic::HarmonicStiffness;
use super::sector::SectorStiffness;
use super::sparse::SparseStiffness;
use crate::body::{Held, Partner};
use crate::error::RingError;
use crate::harmonic::Periodic;
use crate::memory::{MotionSizes, RingMemory};
use crate::model::{Backend, Hold, RingModel};
use crate::substructures::Substructures;
use crate::support::Support;

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

/// What the matrices of a [`Prepared`] ring hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    /// The ring's own numbers.
    Assembled,
    /// Zeros where they will stand: enough for a forecast, nothing that can be factored. One sector is assembled all the same.
    Pattern,
}

/// The stiffness of a held ring and the linear solver that fits it.
pub trait HeldStiffness: Send {
    /// Name of the linear solver, as a scene has it.
    fn solver_name(&self) -> &'static str;

    /// The linear solver and why it is that one, for a log.
    fn note(&self) -> String;

    /// Forecast of its memory.
    fn memory(&self) -> RingMemory;

    /// Columns to solve for together: all contacts with a factor that is then read once.
    fn block(&self, n_contacts: usize) -> usize {
        2 * n_contacts
    }

    /// Bytes of the factor.
    fn factor_bytes(&self) -> usize;

    /// Multiplications and additions of the factorisation.
    fn flops(&self) -> f64;

    /// What a motion of the ring holds, where that is known.
    fn motion(&self) -> Option<MotionSizes> {
        None
    }

    /// The ring in sectors, when the scene asks for them.
    fn parts(&self) -> Option<&Substructures> {
        None
    }

    /// Factors the free dofs of `support`. Collective.
    fn factor(self: Box<Self>, name: &'static str, ring: &RingModel, support: &Support) -> Factored;
}

/// A ring before its factorisation.
pub struct Prepared {
    /// Its hold.
    pub(super) support: Support,
    /// Its stiffness.
    pub stiffness: Box<dyn HeldStiffness>,
}

impl Prepared {
    /// Assembles a ring and analyses its factorisation. Collective.
    pub fn new(
        ring: &RingModel,
        settings: StaticSettings,
        numbers: Numbers,
    ) -> Result<Prepared, RingError> {
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
            let support = Support::new(mesh, ring.hold, weights, places);
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
                    support: Support::unfixed(mesh, ring.hold, weights, places),
                    stiffness: Box::new(stiffness),
                })
            }
            Err(why) => {
                let support = Support::new(mesh, ring.hold, weights, places);
                let stiffness = SparseStiffness::new(name, ring, &support, numbers, (why, n_contacts))?;
                Ok(Prepared {
                    support,
                    stiffness: Box::new(stiffness),
                })
            }
        }
    }
}
