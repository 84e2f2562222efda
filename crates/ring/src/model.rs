//! The model of one flexible ring: mesh, material, how it is held, and the linear solver that a scene asks for.

use std::sync::{Arc, Mutex, OnceLock};

use body::SeatTie;
use comm::Communicator;
use contact::{Groove, Side};
use fem::Material;
use mesh::{
    Mesh, NearlyPeriodic, NotNearlyPeriodic, NotPeriodic, PERIODIC_TOLERANCE, Periodicity,
    find_nearly_periodic, find_periodicity,
};
use serde::{Deserialize, Serialize};

use crate::division::known::Division;
use crate::error::RingError;
use crate::seat::{SeatAction, SeatField};

/// Name of the facet group on which balls run.
pub const RACEWAY_GROUP: &str = "raceway";

/// How a ring's mounting surface follows its rigid partner (shaft or housing).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// Every node of the surface moves with the partner.
    Clamped,
    /// Only the mean translation and rotation of the surface follow the partner (RBE3); it may ovalise.
    MeanMotion,
    /// Not at all: a body that floats. Statics has no answer for it, motion has.
    Free,
}

/// A ring that is a finite-element body.
pub struct RingModel {
    /// Mesh, m, in its own coordinates.
    pub mesh: Mesh,
    /// Ring steel.
    pub material: Material,
    /// How the bore or the seat is held.
    pub hold: Hold,
    /// Facet group that is held: `bore` or `seat`.
    pub held_group: &'static str,
    /// The raceway's torus in mesh coordinates.
    pub groove: Groove,
    /// The elastic body to which the held group is tied at rest; the hold must be [`Hold::MeanMotion`] then.
    pub tie: Option<Arc<SeatTie>>,
    /// Sectors of the mesh, found when first asked for; a new model has the default.
    pub sectors: FoundSectors,
}

/// What is known of the sectors of a mesh, and what else was asked for.
#[derive(Default)]
pub struct FoundSectors {
    equal: OnceLock<Result<Periodicity, NotPeriodic>>,
    nearly: OnceLock<Result<NearlyPeriodic, NotNearlyPeriodic>>,
    node_masses: OnceLock<Arc<NodeMasses>>,
    pub(crate) seat_fields: Mutex<Vec<(SeatAction, Arc<SeatField>)>>,
    pub(crate) division: Option<Division>,
}

/// Masses of the nodes of a ring, the integrals of rho N_a over it.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct NodeMasses {
    /// Of each node, kg, `[n_nodes]`; they sum to the mass of the ring.
    pub masses: Vec<f64>,
    /// Their sum, kg.
    pub total: f64,
    /// Sum of mass times position, kg m.
    pub moment: [f64; 3],
}

impl RingModel {
    /// The equal sectors of the mesh, or the reason why there are none.
    pub fn periodicity(&self) -> Result<&Periodicity, &NotPeriodic> {
        self.sectors
            .equal
            .get_or_init(|| find_periodicity(&self.mesh, PERIODIC_TOLERANCE))
            .as_ref()
    }

    /// Masses of the nodes, found when first asked for, from the whole mesh; `side` names the ring in messages.
    pub fn node_masses(&self, side: &'static str) -> Result<Arc<NodeMasses>, RingError> {
        if self.sectors.node_masses.get().is_none() {
            assert!(self.is_whole(), "the masses of nodes are of the whole mesh");
            let density = self.material.density;
            let load = fem::body_load(&self.mesh, |_| [density, 0.0, 0.0])
                .map_err(|source| RingError::Fem { side, source })?;
            let masses: Vec<f64> = load.into_iter().step_by(3).collect();
            let mut moment = [0.0; 3];
            for (x, m) in self.mesh.nodes.iter().zip(&masses) {
                (0..3).for_each(|i| moment[i] += m * x[i]);
            }
            // Another thread may have been first, with the same masses.
            let _ = self.sectors.node_masses.set(Arc::new(NodeMasses {
                total: masses.iter().sum(),
                moment,
                masses,
            }));
        }
        Ok(self.known_node_masses().cloned().unwrap_or_default())
    }

    /// The same ring without the body to which it is tied.
    pub fn untied(&self) -> RingModel {
        RingModel {
            mesh: self.mesh.clone(),
            material: self.material,
            groove: self.groove,
            tie: None,
            sectors: FoundSectors::default(),
            ..*self
        }
    }

    /// Whether the body of this ring is that of another as well, apart from what it is tied to. Rings whose meshes
    /// ranks have divided among them are not compared.
    pub fn is_like(&self, other: &RingModel) -> bool {
        let is_undivided = |ring: &RingModel| ring.sectors.division.is_none();
        is_undivided(self)
            && is_undivided(other)
            && self.tie.is_some() == other.tie.is_some()
            && (self.hold, self.held_group) == (other.hold, other.held_group)
            && (self.material, self.groove) == (other.material, other.groove)
            && self.mesh == other.mesh
    }

    /// The same if they were asked for before.
    pub(crate) fn known_node_masses(&self) -> Option<&Arc<NodeMasses>> {
        self.sectors.node_masses.get()
    }

    /// Tells the masses of the nodes to a ring that has not been asked for them.
    pub(crate) fn set_node_masses(&self, masses: NodeMasses) {
        let known = self.sectors.node_masses.set(Arc::new(masses));
        known.expect("a new ring has not been asked");
    }

    /// The mesh as a periodic one with a defect, or the reason why it is not one.
    pub fn nearly_periodic(&self) -> Result<&NearlyPeriodic, &NotNearlyPeriodic> {
        self.sectors
            .nearly
            .get_or_init(|| find_nearly_periodic(&self.mesh, PERIODIC_TOLERANCE))
            .as_ref()
    }
}

/// How rings are cut into sectors, and the ranks that share these.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sectors {
    /// Number of sectors of each ring; None: by its size.
    pub n_sectors: Option<usize>,
    /// The ranks.
    pub comm: Communicator,
}

/// Linear solver of the rings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// Harmonics for a rotationally periodic ring, else a sparse factorisation.
    #[default]
    Auto,
    /// Harmonics; a ring that is not periodic is an error.
    Cyclic,
    /// Sparse Cholesky factorisation.
    Sparse,
    /// Sectors, factored and solved in parallel and joined exactly.
    Sector(Sectors),
}

impl Backend {
    /// The sectors of every ring, where rings are cut into some.
    pub fn sectors(self) -> Option<Sectors> {
        match self {
            Backend::Sector(sectors) => Some(sectors),
            Backend::Auto | Backend::Cyclic | Backend::Sparse => None,
        }
    }

    /// The ranks that share a ring: those of the run share the harmonics of a periodic one.
    pub fn comm(self) -> Communicator {
        match self {
            Backend::Sector(sectors) => sectors.comm,
            Backend::Auto | Backend::Cyclic => Communicator::world(),
            Backend::Sparse => Communicator::Serial,
        }
    }

    /// Independent work on both rings, inner first: at the same time, but one after the other where ranks share a ring,
    /// as all ranks must meet in the same order.
    pub fn on_sides<T: Send>(self, of: impl Fn(Side) -> T + Sync) -> [T; 2] {
        self.with_sides([(), ()], |(), side| of(side))
    }

    /// The same with a value for each ring.
    pub fn with_sides<A: Send, T: Send>(
        self,
        [inner, outer]: [A; 2],
        of: impl Fn(A, Side) -> T + Sync,
    ) -> [T; 2] {
        let [first, second] = Side::BOTH;
        match self {
            _ if self.comm().size() > 1 => [of(inner, first), of(outer, second)],
            _ => rayon::join(|| of(inner, first), || of(outer, second)).into(),
        }
    }

    /// The same of work that may fail. Where ranks share a ring, none begins the second when the first has failed: the
    /// others might wait for other messages than those of the second.
    pub fn try_on_sides<T: Send, E: Send>(
        self,
        of: impl Fn(Side) -> Result<T, E> + Sync,
    ) -> Result<[T; 2], E> {
        match self {
            _ if self.comm().size() > 1 => Side::try_both(of),
            _ => {
                let [inner, outer] = Side::BOTH;
                let (inner, outer) = rayon::join(|| of(inner), || of(outer));
                Ok([inner?, outer?])
            }
        }
    }
}
