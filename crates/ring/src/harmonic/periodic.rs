//! A rotationally periodic ring as the matrices of one sector: whole, and without what is held.
//!
//! No matrix of the whole ring is made: K, M and the stress at the nodes act through the blocks of one sector
//! ([`solver::CyclicStencil`]), and the harmonics are factored from them.

use fem::SectorCoupling;
use mesh::{Mesh, Periodicity};
use solver::cyclic::RowResponses;
use solver::{Coupling, CyclicMatrix, CyclicRing, SolverError};

use crate::error::RingError;
use crate::harmonic::defect::RingDefect;
use crate::harmonic::regular::RegularRing;
use crate::memory::MotionSizes;
use crate::model::{Backend, Hold, RACEWAY_GROUP, RingModel};

/// Sectors from which on harmonics pay: a few wide ones cost more than the ring as a whole.
const LEAST_SECTORS: usize = 12;

/// Largest table of responses of a ring with a defect, bytes: a tenth of a small machine.
const MOST_TABLE_BYTES: usize = 1_600_000_000;

/// One sector of a ring with some of its section nodes.
pub struct PeriodicSectors {
    /// Where its nodes are.
    pub ring: CyclicRing,
    /// Stiffness.
    pub stiffness: CyclicMatrix,
    /// Mass.
    pub mass: CyclicMatrix,
    /// Stiffness by the stress of turning with unit speed, where that stiffens the ring.
    pub stress: Option<CyclicMatrix>,
}

/// A ring without its held nodes.
pub struct HeldSectors {
    /// What is left.
    pub sectors: PeriodicSectors,
    /// Section nodes of the raceway, counted among those that stay.
    pub raceway: Vec<usize>,
    /// Where the true ring's free nodes are among those of the regular one, when there is a defect.
    pub seen: Option<Vec<Option<usize>>>,
}

/// A ring that harmonics solve.
pub struct Periodic {
    /// All of it, without its defect.
    pub whole: PeriodicSectors,
    /// What is left when some nodes are held.
    pub held: HeldSectors,
    /// Its defect, if it has one.
    pub defect: Option<Defective>,
    /// What is periodic, for a log.
    sectors_note: String,
}

/// A ring with a defect.
pub struct Defective {
    /// What the defect adds to the matrices.
    pub defect: RingDefect,
    /// The ring without it.
    pub regular: RegularRing,
}

impl Periodic {
    /// The ring with the nodes `held` of the mesh held; the inner error is the reason why it has no sectors or is not
    /// to be solved by them. A scene that forces them gets that reason as the outer error.
    pub fn new(
        ring: &RingModel,
        side: &'static str,
        backend: Backend,
        held: &[usize],
    ) -> Result<Result<Periodic, String>, RingError> {
        let found = match backend {
            Backend::Sparse | Backend::Sector(_) => Err("the scene asks for it".to_string()),
            Backend::Auto | Backend::Cyclic => match usable(ring) {
                Ok(_) => Periodic::without_defect(ring, side, held)?,
                Err(reason) if ring.periodicity().is_ok() => Err(reason),
                Err(reason) => Periodic::with_defect(ring, side, held)?
                    .map_err(|no_defect| format!("{reason}; {no_defect}")),
            },
        };
        match found {
            Err(reason) if backend == Backend::Cyclic => Err(RingError::NotPeriodic { side, reason }),
            found => Ok(found),
        }
    }

    /// The same for natural modes, which harmonics do not give of a ring with a defect.
    pub fn for_modes(
        ring: &RingModel,
        side: &'static str,
        backend: Backend,
        held: &[usize],
    ) -> Result<Result<Periodic, String>, RingError> {
        match Periodic::new(ring, side, backend, held)? {
            Ok(found) if found.defect.is_some() => match backend {
                Backend::Cyclic => Err(RingError::ModesOfDefect { side }),
                _ => Ok(Err("it has a defect".to_string())),
            },
            found => Ok(found),
        }
    }

    fn without_defect(
        ring: &RingModel,
        side: &'static str,
        held: &[usize],
    ) -> Result<Result<Periodic, String>, RingError> {
        let periodicity = ring.periodicity().expect("the caller knows that it has sectors");
        let whole = PeriodicSectors::assemble(ring, &ring.mesh, periodicity, side)?.shared();
        let held = match periodicity.section_nodes(held) {
            Ok(held) => held,
            Err(site) => {
                return Ok(Err(format!(
                    "what holds it is not the same in all sectors: section node {} is not held in sector {}",
                    site.section_node, site.sector
                )));
            }
        };
        let Ok(raceway) = periodicity.section_nodes(&ring.mesh.group_nodes(RACEWAY_GROUP)) else {
            return Ok(Err("its raceway is not the same in all sectors".to_string()));
        };
        let raceway = along_groove(raceway, &ring.mesh, periodicity);
        let held = whole.without(periodicity, [&held, &raceway], side)?;
        Ok(held.map(|held| Periodic {
            sectors_note: format!("{} equal sectors", periodicity.n_sectors()),
            whole,
            held,
            defect: None,
        }))
    }

    fn with_defect(
        ring: &RingModel,
        side: &'static str,
        held: &[usize],
    ) -> Result<Result<Periodic, String>, RingError> {
        let nearly = match ring.nearly_periodic() {
            Ok(nearly) => nearly,
            Err(reason) => return Ok(Err(format!("it is not periodic up to a defect either: {reason}"))),
        };
        let periodicity = &nearly.periodicity;
        if periodicity.n_sectors() < LEAST_SECTORS {
            return Ok(Err(format!(
                "without its defect it has {} equal sectors",
                periodicity.n_sectors()
            )));
        }
        let regular = match RegularRing::new(ring, nearly, held) {
            Ok(regular) => regular,
            Err(reason) => return Ok(Err(reason)),
        };
        let defect = match RingDefect::new(ring, nearly, &regular, side)? {
            Ok(defect) => defect,
            Err(reason) => return Ok(Err(reason)),
        };
        let whole = PeriodicSectors::assemble(ring, &regular.mesh, periodicity, side)?.shared();
        let raceway = along_groove(regular.raceway.clone(), &regular.mesh, periodicity);
        let mut held = match whole.without(periodicity, [&regular.held_section, &raceway], side)? {
            Ok(held) => held,
            Err(reason) => return Ok(Err(reason)),
        };
        let Some(defect) = defect else {
            return Ok(Ok(Periodic {
                sectors_note: format!(
                    "{} equal sectors but for groups of facets",
                    periodicity.n_sectors()
                ),
                whole,
                held,
                defect: None,
            }));
        };
        let bytes = held.table_bytes(periodicity, defect.nodes());
        if bytes > MOST_TABLE_BYTES {
            return Ok(Err(format!(
                "the responses of raceway and defect would take {:.1} GB, more than {:.1} GB",
                bytes as f64 / 1e9,
                MOST_TABLE_BYTES as f64 / 1e9
            )));
        }
        held.seen = Some(regular.seen.clone());
        Ok(Ok(Periodic {
            sectors_note: defect.note().to_string(),
            whole,
            held,
            defect: Some(Defective { defect, regular }),
        }))
    }

    /// The same ring, with the nodes `held` of the mesh held, stiffened by the stress of an `expansion`, see
    /// [`crate::expansion`].
    pub fn stiffened(
        mut self,
        ring: &RingModel,
        side: &'static str,
        held: &[usize],
        expansion: &[f64],
    ) -> Result<Periodic, RingError> {
        let periodicity = match (self.unstiffened(ring), ring.periodicity()) {
            (None, Ok(periodicity)) => periodicity,
            (reason, _) => return Err(RingError::no_stress_stiffening(side, reason.unwrap_or_default())),
        };
        let of_sector = fem::assemble_sector_prestress(&ring.mesh, periodicity, &ring.material, expansion)
            .map_err(|source| RingError::Fem { side, source })?;
        let whole = &mut self.whole;
        let stress = whole
            .stiffness
            .with_blocks(&couplings(&of_sector.couplings), &of_sector.blocks)
            .map_err(|source| RingError::Solver { side, source })?;
        let held = periodicity.section_nodes(held);
        let keep = kept(
            periodicity,
            &held.expect("what holds it is the same in all sectors"),
        );
        self.held.sectors.stress = Some(stress.restricted(&keep));
        whole.stress = Some(stress);
        Ok(self)
    }

    /// Why its stress does not stiffen the ring; None where it may.
    pub fn unstiffened(&self, ring: &RingModel) -> Option<&'static str> {
        if self.defect.is_some() {
            return Some("it is rotationally periodic only up to a defect");
        }
        let has_sectors = ring.periodicity().is_ok();
        (!has_sectors).then_some("its sectors are equal but for groups of facets")
    }

    /// The whole ring for nodal vectors of `mesh`, which may lack nodes of the regular one.
    pub fn whole_ring(&self, mesh: &Mesh) -> CyclicRing {
        match &self.defect {
            Some(_) => self
                .whole
                .ring
                .seen_at(&(0..mesh.n_nodes()).map(Some).collect::<Vec<_>>()),
            None => self.whole.ring.clone(),
        }
    }

    /// The ring without its held nodes as it moves: its order ends with the nodes that contacts and mount touch, so
    /// that a step takes one solve. Rings with a defect, whose rows are loaded as well, keep the order of rings at
    /// rest.
    pub fn in_motion(&self, ring: &RingModel, side: &'static str) -> Result<CyclicRing, RingError> {
        let free = &self.held.sectors.ring;
        if self.defect.is_some() {
            return Ok(free.clone());
        }
        let mounted = match ring.hold {
            Hold::MeanMotion => ring.mesh.group_nodes(ring.held_group),
            Hold::Clamped | Hold::Free => Vec::new(),
        };
        let mut touched = free.section_nodes(mounted);
        touched.extend(&self.held.raceway);
        touched.sort_unstable();
        touched.dedup();
        free.ending_with(&touched)
            .map_err(|source| RingError::Solver { side, source })
    }

    /// What a motion of the ring holds as which `moving` moves and whose mount has `n_mount` functionals.
    pub fn motion_sizes(&self, mesh: &Mesh, moving: &CyclicRing, n_mount: usize) -> MotionSizes {
        let (whole, held) = (&self.whole, &self.held);
        let symmetry = moving.symmetry(&held.sectors.stiffness);
        let n_sectors = whole.ring.n_sectors();
        let (touched, defect) = self.defect.as_ref().map_or((0, 0), |Defective { defect, .. }| {
            let touched = whole.ring.section_nodes(defect.nodes().iter().copied()).len();
            let coupling = RowResponses::bytes_of(n_sectors, held.raceway.len(), touched);
            (touched, defect.bytes() + coupling)
        });
        MotionSizes {
            n_nodes: mesh.n_nodes(),
            n_sectors,
            n_couplings: whole.stiffness.n_couplings(),
            n_responses: held.raceway.len() + touched,
            n_mount,
            factor: moving.factor_bytes(symmetry) + defect,
        }
    }

    /// The solver and what it solves, for a log.
    pub fn note(&self) -> String {
        let shared = match Backend::Cyclic.comm().size() {
            1 => String::new(),
            ranks => format!(", harmonics on {ranks} ranks"),
        };
        format!("cyclic ({}{shared})", self.sectors_note)
    }
}

impl PeriodicSectors {
    /// The same with harmonics that the ranks of the run share.
    fn shared(self) -> PeriodicSectors {
        PeriodicSectors {
            ring: self.ring.shared_by(Backend::Cyclic.comm()),
            ..self
        }
    }

    pub(crate) fn assemble(
        ring: &RingModel,
        mesh: &Mesh,
        periodicity: &Periodicity,
        side: &'static str,
    ) -> Result<PeriodicSectors, RingError> {
        let sector = fem::assemble_sector(mesh, periodicity, &ring.material)
            .map_err(|source| RingError::Fem { side, source })?;
        let couplings = couplings(&sector.couplings);
        let build = || -> Result<PeriodicSectors, SolverError> {
            let (n, width) = (periodicity.n_sectors(), periodicity.n_section_nodes());
            let stiffness = CyclicMatrix::new(n, width, &couplings, &sector.stiffness)?;
            let mass = stiffness.with_blocks(&couplings, &sector.mass)?;
            let directions = fem::azimuth_directions(mesh);
            let ring = CyclicRing::new(
                &stiffness,
                periodicity.nodes(),
                &directions,
                periodicity.half_way(),
            )?;
            Ok(PeriodicSectors {
                ring,
                stiffness,
                mass,
                stress: None,
            })
        };
        build().map_err(|source| RingError::Solver { side, source })
    }

    /// The ring without the section nodes `held`, whose raceway has the section nodes `raceway`; the inner error says
    /// why that cannot be.
    fn without(
        &self,
        periodicity: &Periodicity,
        [held, raceway]: [&[usize]; 2],
        side: &'static str,
    ) -> Result<Result<HeldSectors, String>, RingError> {
        let keep = kept(periodicity, held);
        let places = raceway.iter().map(|n| keep.binary_search(n).ok());
        let Some(raceway): Option<Vec<usize>> = places.collect() else {
            return Ok(Err("its raceway touches what is held".to_string()));
        };
        let (stiffness, mass) = (self.stiffness.restricted(&keep), self.mass.restricted(&keep));
        let restricted = self
            .ring
            .restricted(&stiffness, &keep)
            .map_err(|source| RingError::Solver { side, source })?;
        Ok(Ok(HeldSectors {
            sectors: PeriodicSectors {
                ring: restricted,
                stiffness,
                mass,
                stress: None,
            },
            raceway,
            seen: None,
        }))
    }
}

impl HeldSectors {
    /// Bytes of the responses of raceway and the nodes `nodes` of the mesh, at most.
    fn table_bytes(&self, periodicity: &Periodicity, nodes: &[usize]) -> usize {
        let mut section: Vec<usize> = nodes
            .iter()
            .map(|&n| periodicity.sites()[n].section_node)
            .collect();
        section.sort_unstable();
        section.dedup();
        let n = 3 * (self.raceway.len() + section.len());
        // The table, and the spectra that it is made from.
        2 * size_of::<f64>() * periodicity.n_sectors() * n * n
    }
}

/// Section nodes that are not among the `held` ones, ascending.
fn kept(periodicity: &Periodicity, held: &[usize]) -> Vec<usize> {
    (0..periodicity.n_section_nodes())
        .filter(|i| held.binary_search(i).is_err())
        .collect()
}

/// Section nodes of a raceway, those in the plane of the section first, along the groove: so that a patch is on
/// neighbours in the table of responses.
fn along_groove(mut raceway: Vec<usize>, mesh: &Mesh, periodicity: &Periodicity) -> Vec<usize> {
    let half_way = |node: usize| periodicity.half_way().is_some_and(|half_way| half_way[node]);
    let z = |node: usize| mesh.nodes[periodicity.nodes()[node]][2];
    raceway.sort_by(|&a, &b| {
        let planes = half_way(a).cmp(&half_way(b));
        planes.then(z(a).total_cmp(&z(b)))
    });
    raceway
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

/// Couplings as the solver has them.
pub(crate) fn couplings(couplings: &[SectorCoupling]) -> Vec<Coupling> {
    let coupling = |c: &SectorCoupling| Coupling {
        row: c.row,
        column: c.column,
        shift: c.shift,
    };
    couplings.iter().map(coupling).collect()
}
