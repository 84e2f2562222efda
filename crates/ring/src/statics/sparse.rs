//! Stiffness of a ring with one sparse factor.

use ::solver::{LinearSolver, Symbolic};
use sprs::CsMat;

use super::stiffness::{Factored, HeldStiffness, Numbers, named};
use crate::error::RingError;
use crate::memory::{MotionMemory, RingMemory};
use crate::model::RingModel;
use crate::sparse::elimination_order;
use crate::support::AppliedHold;

/// Lower triangle, its analysis, and why the ring is not solved by harmonics.
pub(super) struct SparseStiffness {
    lower: CsMat<f64>,
    symbolic: Box<Symbolic>,
    why: String,
    memory: RingMemory,
    motion: MotionMemory,
}

impl SparseStiffness {
    /// Assembles and analyses a ring of `n_contacts` contacts.
    pub fn new(
        name: &'static str,
        ring: &RingModel,
        support: &AppliedHold,
        numbers: Numbers,
        (why, n_contacts): (String, usize),
    ) -> Result<SparseStiffness, RingError> {
        let mesh = &ring.mesh;
        // Only the lower triangle outlives the assembly: the whole matrix takes half as much as a hex8 ring's factor.
        let full = match numbers {
            Numbers::Assembled => fem::assemble_stiffness(mesh, &ring.material),
            Numbers::Pattern => fem::Pattern::new(mesh).map(|p| p.matrix(vec![0.0; p.n_values()])),
        };
        let full = full.map_err(|source| RingError::Fem { side: name, source })?;
        let (lower, n_entries) = (solver::restrict_lower(&full, &support.free), full.nnz());
        drop(full);
        let symbolic = Symbolic::new(&lower, &elimination_order(mesh, &support.free))
            .map_err(|source| named(source, name, ring, support))?;
        Ok(SparseStiffness {
            memory: RingMemory::new(mesh, n_entries, &symbolic, n_contacts),
            motion: MotionMemory::sparse(mesh, 2 * lower.nnz() - lower.rows(), &symbolic),
            lower,
            symbolic: Box::new(symbolic),
            why,
        })
    }
}

impl HeldStiffness for SparseStiffness {
    fn solver_name(&self) -> &'static str {
        "sparse"
    }

    fn note(&self) -> String {
        format!("sparse ({})", self.why)
    }

    fn memory(&self) -> RingMemory {
        self.memory
    }

    fn motion(&self) -> Option<MotionMemory> {
        Some(self.motion)
    }

    fn factor_bytes(&self) -> usize {
        self.symbolic.factor_bytes()
    }

    fn flops(&self) -> f64 {
        self.symbolic.flops()
    }

    fn factor(self: Box<Self>, name: &'static str, ring: &RingModel, support: &AppliedHold) -> Factored {
        let factor = self.symbolic.factor(&self.lower);
        let factor = factor.map_err(|source| named(source, name, ring, support))?;
        Ok((Box::new(factor) as Box<dyn LinearSolver>, None))
    }
}
