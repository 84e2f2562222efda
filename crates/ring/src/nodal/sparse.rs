//! A ring with one sparse factor: half a solve before the contacts, half after, and between them forward solutions.
//!
//! See [`solver::triangular`]: the compliance of the contacts takes the columns of the factor above them, and the
//! predictor stays half solved until their forces are known.

use solver::{ForwardColumns, Symbolic, TriangularFactor};

use super::columns::{Columns, Moved, NodalBody, NodalSolver, Ports, column_compliance};
use crate::body::HeldRing;
use crate::error::RingError;
use crate::matrices::{NodalMatrices, SparseMatrices};
use crate::memory::MotionMemory;
use crate::model::RingModel;
use crate::step::PortForces;
use crate::vectors::add;

/// A ring with one sparse factor.
pub type SparseBody = NodalBody<SparseSolver>;

/// Matrices, analysis, and why the ring is not solved by harmonics.
pub struct SparseSolver {
    matrices: SparseMatrices,
    symbolic: Box<Symbolic>,
    memory: MotionMemory,
    why: String,
}

/// A factor and the forward solutions of the mount.
pub struct SparseColumns {
    factor: TriangularFactor,
    mount: ForwardColumns,
    /// Compliance of the mount, row-major.
    mount_compliance: Vec<f64>,
}

/// A predictor half solved, L^-1 of its right-hand side, and the forward solutions of the contacts.
pub struct HalfSolved {
    predictor: Vec<f64>,
    contacts: ForwardColumns,
}

impl SparseBody {
    /// Assembles and analyses a held ring that is not solved by harmonics, with the reason, stiffened by the stress of
    /// an `expansion`.
    pub fn new(
        ring: &RingModel,
        held: HeldRing,
        why: String,
        expansion: Option<&[f64]>,
    ) -> Result<SparseBody, RingError> {
        let matrices = SparseMatrices::new(ring, held.name, &held.coordinates, expansion)?;
        let symbolic = matrices
            .analyse(ring, &held.coordinates)
            .map_err(|source| RingError::Solver {
                side: held.name,
                source,
            })?;
        let memory = MotionMemory::sparse(&ring.mesh, matrices.n_entries(), &symbolic);
        Ok(NodalBody {
            solver: SparseSolver {
                memory: match expansion {
                    Some(_) => memory.stiffened(),
                    None => memory,
                },
                matrices,
                symbolic: Box::new(symbolic),
                why,
            },
            held,
        })
    }
}

impl NodalSolver for SparseSolver {
    type Columns = SparseColumns;

    fn matrices(&self) -> &dyn NodalMatrices {
        &self.matrices
    }

    fn name(&self) -> &'static str {
        "sparse"
    }

    fn note(&self) -> String {
        format!("sparse ({})", self.why)
    }

    fn memory(&self, _: &HeldRing) -> Option<MotionMemory> {
        Some(self.memory)
    }

    fn factor(&self, held: &HeldRing, coefficients: [f64; 2]) -> Result<SparseColumns, RingError> {
        let factor = self
            .matrices
            .factor(&self.symbolic, &held.coordinates, coefficients)
            .map_err(|source| RingError::Solver {
                side: held.name,
                source,
            })?;
        let factor = TriangularFactor::new(factor);
        let mount = factor.columns(&held.mount.rows);
        Ok(SparseColumns {
            mount_compliance: mount.products(&mount),
            mount,
            factor,
        })
    }
}

impl SparseColumns {
    /// What ports see of a predictor and their own columns.
    fn moved(&self, half: &HalfSolved) -> Moved {
        let own = half.contacts.products(&half.contacts);
        let of_mount = self.mount.products(&half.contacts);
        let n_contacts = half.contacts.n_columns();
        let size = [n_contacts + self.mount.n_columns(), n_contacts];
        Moved {
            predicted: self.values(half, &half.predictor),
            compliance: column_compliance(size, &self.mount_compliance, |i, j| match i < n_contacts {
                true => own[n_contacts * i + j],
                false => of_mount[n_contacts * (i - n_contacts) + j],
            }),
        }
    }

    /// Values at contacts and mount of the solution whose forward half is `z`.
    fn values(&self, half: &HalfSolved, z: &[f64]) -> Vec<f64> {
        [half.contacts.values(z), self.mount.values(z)].concat()
    }
}

impl Columns for SparseColumns {
    type Predictor = HalfSolved;

    const BY_TABLE: bool = false;

    fn bytes(&self) -> usize {
        self.factor.bytes() + self.mount.bytes()
    }

    fn begin(&self, _: &HeldRing, side: Vec<f64>, ports: &Ports) -> (HalfSolved, Moved) {
        let (predictor, contacts) = self.factor.forward_with(&side, &ports.contacts);
        let half = HalfSolved { predictor, contacts };
        let moved = self.moved(&half);
        (half, moved)
    }

    fn move_contacts(&self, _: &HeldRing, half: &mut HalfSolved, ports: &Ports) -> Moved {
        half.contacts = self.factor.columns(&ports.contacts);
        self.moved(half)
    }

    fn add_load(&self, _: &HeldRing, half: &mut HalfSolved, load: Vec<f64>, _: &Ports) -> Vec<f64> {
        let more = self.factor.forward(&load);
        add(&mut half.predictor, &more);
        self.values(half, &more)
    }

    fn increment(&self, _: &HeldRing, half: &HalfSolved, _: &Ports, forces: PortForces<'_>) -> Vec<f64> {
        let mut z = half.predictor.clone();
        half.contacts.add_to(&mut z, forces.contacts);
        self.mount.add_to(&mut z, forces.mount);
        self.factor.backward(z)
    }
}
