//! A rotationally periodic ring as the matrices of one sector: whole, and without what is held.
//!
//! No matrix of the whole ring is made: K, M and the stress at the nodes act through the blocks of one sector
//! ([`solver::CyclicStencil`]), and the harmonics are factored from them.

use fem::SectorCoupling;
use solver::{Coupling, CyclicMatrix, CyclicRing, CyclicStencil, SolverError};

use crate::error::DynamicsError;
use crate::model::{Backend, RingModel};

/// Sectors from which on harmonics pay: a few wide ones cost more than the ring as a whole.
const LEAST_SECTORS: usize = 12;

/// One sector of a ring with some of its section nodes.
pub struct Sectors {
    /// Where its nodes are.
    pub ring: CyclicRing,
    /// Stiffness.
    pub stiffness: CyclicMatrix,
    /// Mass.
    pub mass: CyclicMatrix,
}

/// A ring without its held nodes.
pub struct HeldSectors {
    /// What is left.
    pub sectors: Sectors,
    /// Section nodes of the raceway, counted among those that stay.
    pub raceway: Vec<usize>,
}

impl Sectors {
    /// The whole ring, and the ring without the nodes `held` of the mesh; the inner error is the reason why it has no
    /// sectors or is not to be solved by them. A scene that forces them gets that reason as the outer error.
    pub fn held(
        ring: &RingModel,
        side: &'static str,
        backend: Backend,
        held: &[usize],
    ) -> Result<Result<(Sectors, HeldSectors), String>, DynamicsError> {
        let pair = match Sectors::whole(ring, side, backend)? {
            Ok(whole) => whole.without(ring, held, side)?.map(|held| (whole, held)),
            Err(reason) => Err(reason),
        };
        match pair {
            Err(reason) if backend == Backend::Cyclic => Err(DynamicsError::NotPeriodic { side, reason }),
            pair => Ok(pair),
        }
    }

    /// The whole ring; the inner error is the reason why it has no sectors or is not to be solved by them.
    fn whole(
        ring: &RingModel,
        side: &'static str,
        backend: Backend,
    ) -> Result<Result<Sectors, String>, DynamicsError> {
        if matches!(backend, Backend::Sparse | Backend::Sector(_)) {
            return Ok(Err("the scene asks for it".to_string()));
        }
        match usable(ring) {
            Ok(_) => Sectors::assemble(ring, side).map(Ok),
            Err(reason) => Ok(Err(reason)),
        }
    }

    fn assemble(ring: &RingModel, side: &'static str) -> Result<Sectors, DynamicsError> {
        let periodicity = ring.periodicity().expect("the caller knows that it has sectors");
        let sector = fem::assemble_sector(&ring.mesh, periodicity, &ring.material)
            .map_err(|source| DynamicsError::Fem { side, source })?;
        let couplings = couplings(&sector.couplings);
        let build = || -> Result<Sectors, SolverError> {
            let (n, width) = (periodicity.n_sectors(), periodicity.n_section_nodes());
            let stiffness = CyclicMatrix::new(n, width, &couplings, &sector.stiffness)?;
            let mass = stiffness.with_blocks(&couplings, &sector.mass)?;
            let directions = fem::azimuth_directions(&ring.mesh);
            let ring = CyclicRing::new(
                &stiffness,
                periodicity.nodes(),
                &directions,
                periodicity.half_way(),
            )?;
            Ok(Sectors {
                ring,
                stiffness,
                mass,
            })
        };
        build().map_err(|source| DynamicsError::Solver { side, source })
    }

    /// The ring without the nodes `held` (of the mesh); the inner error says why that is not periodic.
    fn without(
        &self,
        ring: &RingModel,
        held: &[usize],
        side: &'static str,
    ) -> Result<Result<HeldSectors, String>, DynamicsError> {
        let periodicity = ring.periodicity().expect("a ring of sectors has them");
        let held = match periodicity.section_nodes(held) {
            Ok(held) => held,
            Err(site) => {
                return Ok(Err(format!(
                    "what holds it is not the same in all sectors: section node {} is not held in sector {}",
                    site.section_node, site.sector
                )));
            }
        };
        let keep: Vec<usize> = (0..periodicity.n_section_nodes())
            .filter(|i| held.binary_search(i).is_err())
            .collect();
        let touched = periodicity.section_nodes(&ring.mesh.group_nodes(crate::model::RACEWAY_GROUP));
        let places = |nodes: Vec<usize>| nodes.iter().map(|n| keep.binary_search(n).ok()).collect();
        let Some(raceway): Option<Vec<usize>> = touched.ok().and_then(places) else {
            return Ok(Err(
                "its raceway is not the same in all sectors, or touches what is held".to_string(),
            ));
        };
        let (stiffness, mass) = (self.stiffness.restricted(&keep), self.mass.restricted(&keep));
        let restricted = self
            .ring
            .restricted(&stiffness, &keep)
            .map_err(|source| DynamicsError::Solver { side, source })?;
        Ok(Ok(HeldSectors {
            sectors: Sectors {
                ring: restricted,
                stiffness,
                mass,
            },
            raceway,
        }))
    }
}

/// Number of sectors of a ring that harmonics can solve, or why they cannot.
pub fn usable(ring: &RingModel) -> Result<usize, String> {
    match ring.periodicity() {
        Err(reason) => Err(reason.to_string()),
        Ok(periodicity) if periodicity.n_sectors() < LEAST_SECTORS => Err(format!(
            "its mesh has {} equal sectors, expected at least {LEAST_SECTORS}",
            periodicity.n_sectors()
        )),
        Ok(periodicity) => Ok(periodicity.n_sectors()),
    }
}

/// The operator of the stress at the nodes, Pa, of a ring that harmonics can solve; None of any other.
pub fn stress_operator(
    ring: &RingModel,
    recovery: &fem::StressRecovery,
    side: &'static str,
) -> Result<Option<CyclicStencil>, DynamicsError> {
    let (Ok(_), Ok(periodicity)) = (usable(ring), ring.periodicity()) else {
        return Ok(None);
    };
    let whole = Sectors::assemble(ring, side)?;
    let stress = recovery.sector(&ring.mesh, periodicity);
    let weights = stress.weights.as_flattened().as_flattened();
    Ok(Some(whole.ring.stencil(
        6,
        &couplings(&stress.couplings),
        weights,
    )))
}

/// Couplings as the solver has them.
fn couplings(couplings: &[SectorCoupling]) -> Vec<Coupling> {
    let coupling = |c: &SectorCoupling| Coupling {
        row: c.row,
        column: c.column,
        shift: c.shift,
    };
    couplings.iter().map(coupling).collect()
}
