//! A ring with one sparse factor: columns of all contacts in one block solve.

use solver::{LinearSolver, Symbolic};

use super::columns::{Columns, Moved, NodalBody, NodalSolver, Ports, column_compliance, measure};
use crate::body::HeldRing;
use crate::error::RingError;
use crate::matrices::{NodalMatrices, SparseMatrices};
use crate::model::RingModel;
use crate::mount::MountColumns;
use crate::sparse::{fill, sparse_dot};
use crate::step::PortForces;

/// A ring with one sparse factor.
pub type SparseBody = NodalBody<SparseSolver>;

/// Matrices, analysis, and why the ring is not solved by harmonics.
pub struct SparseSolver {
    matrices: SparseMatrices,
    symbolic: Box<Symbolic>,
    why: String,
}

/// A factor and the columns of the mount.
pub struct SparseColumns {
    factor: Box<dyn LinearSolver>,
    mount: MountColumns,
}

impl SparseBody {
    /// Assembles and analyses a held ring that is not solved by harmonics, with the reason.
    pub fn new(ring: &RingModel, held: HeldRing, why: String) -> Result<SparseBody, RingError> {
        let matrices = SparseMatrices::new(ring, held.name, &held.coordinates)?;
        let symbolic = matrices
            .analyse(ring, &held.coordinates)
            .map_err(|source| RingError::Solver {
                side: held.name,
                source,
            })?;
        Ok(NodalBody {
            solver: SparseSolver {
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

    fn factor(&self, held: &HeldRing, coefficients: [f64; 2]) -> Result<SparseColumns, RingError> {
        let factor = self
            .matrices
            .factor(&self.symbolic, &held.coordinates, coefficients)
            .map_err(|source| RingError::Solver {
                side: held.name,
                source,
            })?;
        Ok(SparseColumns {
            mount: MountColumns::new(&*factor, &held.mount, held.coordinates.n()),
            factor,
        })
    }
}

impl SparseColumns {
    /// What ports see of a block of columns, the predictor first.
    fn moved(&self, held: &HeldRing, block: &[f64], ports: &Ports) -> Moved {
        let (n, all) = (held.coordinates.n(), ports.all(held));
        let (predictor, columns) = block.split_at(n);
        let size = [all.len(), columns.len() / n];
        Moved {
            predicted: measure(&all, predictor),
            compliance: column_compliance(size, &self.mount.compliance, |i, j| {
                sparse_dot(all[i], &columns[n * j..n * (j + 1)])
            }),
        }
    }
}

impl Columns for SparseColumns {
    /// The predictor, then the increments per unit contact force: column-major `[n][1 + 2 n_contacts]`.
    type Predictor = Vec<f64>;

    const BY_TABLE: bool = false;

    fn bytes(&self) -> usize {
        self.factor.factor_bytes()
    }

    fn begin(&self, held: &HeldRing, mut block: Vec<f64>, ports: &Ports) -> (Vec<f64>, Moved) {
        let (n, n_columns) = (held.coordinates.n(), 1 + ports.contacts.len());
        block.resize(n * n_columns, 0.0);
        fill(&mut block[n..], &ports.contacts, n);
        self.factor.solve(&mut block, n_columns);
        let moved = self.moved(held, &block, ports);
        (block, moved)
    }

    fn move_contacts(&self, held: &HeldRing, block: &mut Vec<f64>, ports: &Ports) -> Moved {
        let n = held.coordinates.n();
        block[n..].fill(0.0);
        fill(&mut block[n..], &ports.contacts, n);
        self.factor.solve(&mut block[n..], ports.contacts.len());
        self.moved(held, block, ports)
    }

    fn add_load(&self, held: &HeldRing, block: &mut Vec<f64>, mut load: Vec<f64>, ports: &Ports) -> Vec<f64> {
        self.factor.solve(&mut load, 1);
        block.iter_mut().zip(&load).for_each(|(p, d)| *p += d);
        measure(&ports.all(held), &load)
    }

    fn increment(&self, held: &HeldRing, block: &Vec<f64>, _: &Ports, forces: PortForces<'_>) -> Vec<f64> {
        let n = held.coordinates.n();
        let mut dw = block[..n].to_vec();
        let contacts = block[n..].chunks_exact(n).zip(forces.contacts);
        let mount = self.mount.columns.chunks_exact(n).zip(forces.mount);
        for (column, &f) in contacts.chain(mount) {
            if f != 0.0 {
                dw.iter_mut().zip(column).for_each(|(d, c)| *d += f * c);
            }
        }
        dw
    }
}
