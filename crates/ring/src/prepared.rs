//! A held ring ready to be factored for statics, with a forecast of its memory: all that is known before a number is
//! factored.

use mesh::Mesh;
use solver::cyclic::{CyclicBordered, CyclicDefect};
use solver::{LinearSolver, SolverError, Symbolic, Symmetry};
use sprs::CsMat;

use crate::body::{Held, Partner};
use crate::coordinates::Coordinates;
use crate::error::RingError;
use crate::harmonic::defect_change::Changes;
use crate::harmonic::periodic::{Defective, HeldSectors, Periodic, Sectors};
use crate::memory::{MotionSizes, RingMemory};
use crate::model::{Backend, Hold, RingModel};
use crate::rank_memory::{RankMemory, Share};
use crate::sparse::elimination_order;
use crate::statics::named;
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

/// Columns of a block that harmonics solve for: more take memory and save nothing.
const CYCLIC_BLOCK: usize = 8;

/// A ring before its factorisation.
pub struct Prepared {
    /// Forecast of its memory.
    pub memory: RingMemory,
    support: Support,
    matrix: Matrix,
}

/// The stiffness of a held ring.
enum Matrix {
    /// Lower triangle, its analysis, and why the ring is not solved by harmonics.
    Sparse(CsMat<f64>, Box<Symbolic>, String),
    /// One sector.
    Cyclic(Box<Harmonics>),
    /// Sectors cut by angle.
    Cut(Box<Substructures>),
}

/// A ring that harmonics solve.
struct Harmonics {
    held: HeldSectors,
    symmetry: Symmetry,
    /// Rows that its defect changes.
    changes: Option<Changes>,
    note: String,
    motion: MotionSizes,
}

/// A factored ring.
pub struct FactoredRing {
    /// Its hold.
    pub support: Support,
    /// Solves for the free dofs.
    pub solver: Box<dyn LinearSolver>,
    /// Of a ring with a defect, see [`solver::cyclic::Defect::iterations`].
    pub iterations: Option<usize>,
}

/// What the matrices of a [`Prepared`] ring hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    /// The ring's own numbers.
    Assembled,
    /// Zeros where they will stand: enough for a forecast, nothing that can be factored. One sector is assembled all the same.
    Pattern,
}

impl Prepared {
    /// Assembles the ring on `side` and analyses its factorisation.
    pub fn new(
        ring: &RingModel,
        StaticSettings {
            name,
            partner,
            backend,
            n_contacts: n_balls,
        }: StaticSettings,
        numbers: Numbers,
    ) -> Result<Prepared, RingError> {
        let mesh = &ring.mesh;
        let places = ring.places(name, backend)?;
        let weights = fem::surface::facet_node_weights(mesh, mesh.group(ring.held_group));
        if let Backend::Sector(sectors) = backend {
            let support = Support::new(mesh, ring.hold, weights, places);
            let parts = match numbers {
                Numbers::Assembled => Substructures::new(ring, name, &support.free, sectors)?,
                Numbers::Pattern => Substructures::pattern(ring, name, &support.free, sectors)?,
            };
            return Ok(Prepared {
                memory: RankMemory::new(ring, &parts, n_balls, &Share::of(sectors.comm)).phases(),
                support,
                matrix: Matrix::Cut(Box::new(parts)),
            });
        }
        let held = match ring.hold {
            Hold::Clamped => mesh.group_nodes(ring.held_group),
            Hold::MeanMotion | Hold::Free => Vec::new(),
        };
        let why = match Periodic::new(ring, name, backend, &held)? {
            Ok(periodic) => {
                let sectors = &periodic.held.sectors;
                let moving = periodic.in_motion(ring, name)?;
                let symmetry = sectors.ring.symmetry(&sectors.stiffness);
                let memory = RingMemory::cyclic(
                    mesh,
                    sectors.stiffness.n_couplings(),
                    sectors.ring.factor_bytes(symmetry),
                    CYCLIC_BLOCK,
                );
                return Ok(Prepared {
                    memory: match &periodic.defect {
                        Some(d) => memory.with_defect(mesh, d.defect.bytes()),
                        None => memory,
                    },
                    support: Support::unfixed(mesh, ring.hold, weights, places),
                    matrix: Matrix::Cyclic(Box::new(Harmonics {
                        symmetry,
                        changes: periodic.defect.as_ref().map(|d| changes(mesh, &held, d)),
                        motion: periodic.motion_sizes(mesh, &moving, Held { hold: ring.hold, partner }.n_mount()),
                        note: periodic.note(),
                        held: periodic.held,
                    })),
                });
            }
            Err(why) => why,
        };
        let support = Support::new(mesh, ring.hold, weights, places);
        // Only the lower triangle outlives the assembly: the whole matrix takes half as much as a hex8 ring's factor.
        let full = match numbers {
            Numbers::Assembled => fem::assemble_stiffness(mesh, &ring.material),
            Numbers::Pattern => fem::Pattern::new(mesh).map(|p| p.matrix(vec![0.0; p.n_values()])),
        };
        let full = full.map_err(|source| RingError::Fem { side: name, source })?;
        let (stiffness, n_entries) = (solver::restrict_lower(&full, &support.free), full.nnz());
        drop(full);
        let symbolic =
            analyse(mesh, &support, &stiffness).map_err(|source| named(source, name, ring, &support))?;
        Ok(Prepared {
            memory: RingMemory::new(mesh, n_entries, &symbolic, n_balls),
            support,
            matrix: Matrix::Sparse(stiffness, Box::new(symbolic), why),
        })
    }

    /// Columns to solve for together: all contacts with a sparse factor, which is then read once.
    pub fn block(&self, n_contacts: usize) -> usize {
        match self.matrix {
            Matrix::Sparse(..) | Matrix::Cut(_) => 2 * n_contacts,
            Matrix::Cyclic(..) => CYCLIC_BLOCK,
        }
    }

    /// The solver and why it is that one, for a log.
    pub fn note(&self) -> String {
        match &self.matrix {
            Matrix::Sparse(_, _, why) => format!("sparse ({why})"),
            Matrix::Cut(parts) => format!("sector ({})", parts.note()),
            Matrix::Cyclic(harmonics) => harmonics.note.clone(),
        }
    }

    /// Whether harmonics solve the ring.
    pub fn is_cyclic(&self) -> bool {
        matches!(self.matrix, Matrix::Cyclic(_))
    }

    /// What a motion of the ring holds; None of a ring that harmonics do not solve.
    pub fn motion(&self) -> Option<MotionSizes> {
        match &self.matrix {
            Matrix::Cyclic(harmonics) => Some(harmonics.motion),
            Matrix::Sparse(..) | Matrix::Cut(_) => None,
        }
    }

    /// Bytes of the factor.
    pub fn factor_bytes(&self) -> usize {
        match &self.matrix {
            Matrix::Sparse(_, symbolic, _) => symbolic.factor_bytes(),
            Matrix::Cut(parts) => {
                let own: usize = parts.symbolic().costs().iter().map(|c| c.factor_bytes).sum();
                own + parts.symbolic().interface_bytes(parts.symbolic().owned())
            }
            Matrix::Cyclic(h) => h.held.sectors.ring.factor_bytes(h.symmetry),
        }
    }

    /// Multiplications and additions of the factorisation.
    pub fn flops(&self) -> f64 {
        match &self.matrix {
            Matrix::Sparse(_, symbolic, _) => symbolic.flops(),
            Matrix::Cut(parts) => parts.symbolic().costs().iter().map(|c| c.flops).sum(),
            Matrix::Cyclic(h) => h.held.sectors.ring.flops(h.symmetry),
        }
    }

    /// The ring in sectors, when the scene asks for them.
    pub fn parts(&self) -> Option<&Substructures> {
        match &self.matrix {
            Matrix::Cut(parts) => Some(parts),
            Matrix::Sparse(..) | Matrix::Cyclic(..) => None,
        }
    }

    /// Factors the ring.
    pub fn factor(self, name: &'static str, ring: &RingModel) -> Result<FactoredRing, RingError> {
        let boxed = |solver: Box<dyn LinearSolver>| (solver, None);
        let factor = match self.matrix {
            Matrix::Sparse(stiffness, symbolic, _) => {
                symbolic.factor(&stiffness).map(|factor| boxed(Box::new(factor)))
            }
            Matrix::Cyclic(harmonics) => harmonics.factor(ring.hold),
            Matrix::Cut(parts) => match parts.factor([0.0, 1.0]) {
                Ok(factor) => Ok(boxed(Box::new(factor))),
                Err(RingError::Solver { source, .. }) => Err(source),
                Err(other) => return Err(other),
            },
        };
        match factor {
            Ok((solver, iterations)) => Ok(FactoredRing {
                support: self.support,
                solver,
                iterations,
            }),
            Err(error) => Err(named(error, name, ring, &self.support)),
        }
    }
}

impl Harmonics {
    /// The factor, and the iterations of a defect.
    fn factor(&self, hold: Hold) -> Result<(Box<dyn LinearSolver>, Option<usize>), SolverError> {
        let Sectors {
            ring: cyclic,
            stiffness,
            ..
        } = &self.held.sectors;
        // In its mean motion a ring gets balanced loads only, and what rigid motion is left is removed.
        let factor = match hold {
            Hold::MeanMotion => cyclic.factor_unheld(stiffness),
            Hold::Clamped | Hold::Free => cyclic.factor(stiffness),
        }?;
        let Some(changes) = &self.changes else {
            return Ok((Box::new(factor), None));
        };
        let base = CyclicBordered::new(factor, &[], 0, &[])?;
        let base = match &self.held.seen {
            Some(seen) => base.seen_at(seen),
            None => base,
        };
        let factor = CyclicDefect::new(base, &changes.of([0.0, 1.0])?)?;
        let iterations = factor.defect().iterations();
        Ok((Box::new(factor), Some(iterations)))
    }
}

/// What a defect changes in the stiffness of a ring without the nodes `held`.
fn changes(mesh: &Mesh, held: &[usize], Defective { defect, regular }: &Defective) -> Changes {
    let coordinates = Coordinates::new(mesh, held, Vec::new(), 0.0);
    defect.changes(&coordinates, &coordinates.of_mesh(&regular.mesh, &regular.held))
}

/// Analysis of the factorisation of a held ring, from its matrix' lower triangle.
fn analyse(mesh: &Mesh, support: &Support, stiffness: &CsMat<f64>) -> Result<Symbolic, SolverError> {
    Symbolic::new(stiffness, &elimination_order(mesh, &support.free))
}
