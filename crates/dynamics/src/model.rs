//! The Model: everything that a scene fixes and that never changes during a run.
//!
//! Frames: the outer ring's mesh is placed with its groove centres at z = 0; the inner ring's with its groove
//! centres at z = A sin a0 (the just-touching position). The shaft's origin is the axis point in the plane of the
//! inner groove centres. A rigid motion is u(x) = t + phi x (x - origin), linear in the tilts phi: consistent with
//! small strain, and the reason why statics is a convex problem.

use std::sync::{Arc, OnceLock};

use comm::Communicator;
use contact::hertz::Elastic;
use contact::{BearingGeometry, Groove, HertzContact, Side};
use fem::{FemError, Material};
use input::Schedule;
use mesh::{
    Mesh, NearlyPeriodic, NotNearlyPeriodic, NotPeriodic, PERIODIC_TOLERANCE, Periodicity,
    find_nearly_periodic, find_periodicity,
};
use serde::{Deserialize, Serialize};

use crate::division::Division;
use crate::effects::Effect;

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
    /// Sectors of the mesh, found when first asked for; a new model has the default.
    pub sectors: FoundSectors,
}

/// What is known of the sectors of a mesh, and what else was asked for.
#[derive(Default)]
pub struct FoundSectors {
    equal: OnceLock<Result<Periodicity, NotPeriodic>>,
    nearly: OnceLock<Result<NearlyPeriodic, NotNearlyPeriodic>>,
    node_masses: OnceLock<Arc<NodeMasses>>,
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

    /// Masses of the nodes, found when first asked for, from the whole mesh.
    pub fn node_masses(&self) -> Result<Arc<NodeMasses>, FemError> {
        if self.sectors.node_masses.get().is_none() {
            assert!(self.is_whole(), "the masses of nodes are of the whole mesh");
            let density = self.material.density;
            let load = fem::body_load(&self.mesh, |_| [density, 0.0, 0.0])?;
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

/// One degree of freedom of the shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShaftDof {
    /// Moves until forces balance.
    Free,
    /// Held at a given displacement, m or rad, times its schedule in `Model::shaft_schedules`; locked is 0.
    Prescribed(f64),
}

/// How balls meet raceways.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactMode {
    /// Exact torus, force spread over a patch, local compliance matched.
    Patch,
    /// Mesh facets found by bounding boxes: the paper's way; local compliance counted twice.
    Facet,
    /// Exact torus, rigid rings: the Jones-Harris limit.
    Rigid,
}

/// Contact choices of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSettings {
    /// Mode.
    pub mode: ContactMode,
    /// Smallest semi-axis of a patch, node spacings.
    pub patch_spacings: f64,
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
    /// The ranks that share a ring: those of the run share the harmonics of a periodic one.
    pub fn comm(self) -> Communicator {
        match self {
            Backend::Sector(sectors) => sectors.comm,
            Backend::Auto | Backend::Cyclic => Communicator::world(),
            Backend::Sparse => Communicator::Serial,
        }
    }

    /// Both of two independent pieces of work on the rings: at the same time, but one after the other where ranks share
    /// a ring, as all ranks must meet in the same order.
    pub fn both<A: Send, B: Send>(
        self,
        first: impl FnOnce() -> A + Send,
        second: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        match self {
            _ if self.comm().size() > 1 => (first(), second()),
            _ => rayon::join(first, second),
        }
    }
}

/// Dimensionless stopping rules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Change of any contact force between two rounds over the largest force.
    pub force: f64,
    /// Rounds of patch placement and Newton before giving up.
    pub max_rounds: usize,
}

impl Default for Tolerances {
    fn default() -> Self {
        Tolerances {
            force: 1e-10,
            max_rounds: 50,
        }
    }
}

/// A bearing with its loads: see the module.
pub struct Model {
    /// Bearing dimensions.
    pub geometry: BearingGeometry,
    /// Hertz contact of each side, inner first.
    pub hertz: [HertzContact; 2],
    /// Flexible rings, inner first; None is a rigid ring and costs nothing.
    pub rings: [Option<Arc<RingModel>>; 2],
    /// Ball steel.
    pub ball_material: Material,
    /// Shaft dofs x, y, z, tilt about x, tilt about y.
    pub shaft: [ShaftDof; 5],
    /// Factors over time of the prescribed ones; those of free dofs do nothing.
    pub shaft_schedules: [Schedule; 5],
    /// Mass carried by the shaft besides a flexible inner ring, kg.
    pub shaft_mass: f64,
    /// Axial distance of the load point from the plane of the inner groove centres, m.
    pub load_point: f64,
    /// Contact choices.
    pub contact: ContactSettings,
    /// Effects the scene calls for, in the order of their names.
    pub effects: Vec<Box<dyn Effect>>,
    /// Linear solver of the rings.
    pub backend: Backend,
    /// Stopping rules.
    pub tolerances: Tolerances,
}

impl Model {
    /// Flexible ring of one side.
    pub fn ring(&self, side: Side) -> Option<&RingModel> {
        self.rings[side.index()].as_deref()
    }

    /// Axial shift from a ring's mesh coordinates to the assembled bearing, m.
    pub fn ring_shift(&self, side: Side) -> f64 {
        let centre_z = self.ring(side).map_or(0.0, |r| r.groove.centre_z);
        self.geometry.groove_centre(side)[1] - centre_z
    }

    /// Imposed displacement of a shaft dof (0..5) at a time in s, m or rad; None: it is free.
    pub fn prescribed(&self, dof: usize, time: f64) -> Option<f64> {
        self.imposed(dof, |schedule| schedule.at(time))
    }

    /// Rate of the imposed displacement of a shaft dof, m/s or rad/s; None: it is free.
    pub fn prescribed_rate(&self, dof: usize, time: f64) -> Option<f64> {
        self.imposed(dof, |schedule| schedule.rate(time))
    }

    fn imposed(&self, dof: usize, factor: impl Fn(&Schedule) -> f64) -> Option<f64> {
        match self.shaft[dof] {
            ShaftDof::Free => None,
            ShaftDof::Prescribed(value) => Some(value * factor(&self.shaft_schedules[dof])),
        }
    }

    /// Mass of one ball, kg.
    pub fn ball_mass(&self) -> f64 {
        std::f64::consts::PI / 6.0 * self.geometry.ball_diameter.powi(3) * self.ball_material.density
    }
}

/// Elastic constants of a material.
pub fn elastic(material: &Material) -> Elastic {
    Elastic {
        young_modulus: material.young_modulus,
        poisson_ratio: material.poisson_ratio,
    }
}
