//! Stiffness of a periodic ring: one sector.

use ::solver::cyclic::{CyclicBordered, CyclicDefect};
use ::solver::{LinearSolver, SolverError, Symmetry};
use mesh::Mesh;

use super::stiffness::{Factored, HeldStiffness, named};
use crate::body::Held;
use crate::coordinates::Coordinates;
use crate::error::RingError;
use crate::harmonic::defect_change::Changes;
use crate::harmonic::periodic::{Defective, HeldSectors, Periodic};
use crate::memory::{MotionMemory, RingMemory};
use crate::model::{Hold, RingModel};
use crate::support::AppliedHold;

/// Columns of a block that harmonics solve for: more take memory and save nothing.
const BLOCK: usize = 8;

/// A ring that harmonics solve.
pub(super) struct HarmonicStiffness {
    sectors: HeldSectors,
    symmetry: Symmetry,
    /// Rows that its defect changes.
    changes: Option<Changes>,
    note: String,
    memory: RingMemory,
    motion: MotionMemory,
}

impl HarmonicStiffness {
    /// The ring of which the nodes `held_nodes` are held at rest; in motion it is held as `how` says.
    pub fn new(
        name: &'static str,
        ring: &RingModel,
        periodic: Periodic,
        (held_nodes, how): (&[usize], Held),
    ) -> Result<HarmonicStiffness, RingError> {
        let mesh = &ring.mesh;
        let sectors = &periodic.held.sectors;
        let moving = periodic.in_motion(ring, name)?;
        let symmetry = sectors.ring.symmetry(&sectors.stiffness);
        let memory = RingMemory::cyclic(
            mesh,
            sectors.stiffness.n_couplings(),
            sectors.ring.factor_bytes(symmetry),
            BLOCK,
        );
        let defect = periodic.defect.as_ref();
        Ok(HarmonicStiffness {
            symmetry,
            memory: defect.map_or(memory, |d| memory.with_defect(mesh, d.defect.bytes())),
            changes: defect.map(|d| changes(mesh, held_nodes, d)),
            motion: periodic.motion_sizes(mesh, &moving, how.n_mount()).memory(),
            note: periodic.note(),
            sectors: periodic.held,
        })
    }

    /// The factor, and the iterations of a defect.
    fn factored(&self, hold: Hold) -> Result<(Box<dyn LinearSolver>, Option<usize>), SolverError> {
        let (cyclic, stiffness) = (&self.sectors.sectors.ring, &self.sectors.sectors.stiffness);
        // In its mean motion a ring gets balanced loads only, and what rigid motion is left is removed.
        let factor = match hold {
            Hold::MeanMotion => cyclic.factor_unheld(stiffness),
            Hold::Clamped | Hold::Free => cyclic.factor(stiffness),
        }?;
        let Some(changes) = &self.changes else {
            return Ok((Box::new(factor), None));
        };
        let base = CyclicBordered::new(factor, &[], 0, &[])?;
        let base = match &self.sectors.seen {
            Some(seen) => base.seen_at(seen),
            None => base,
        };
        let factor = CyclicDefect::new(base, &changes.of([0.0, 1.0])?)?;
        let iterations = factor.defect().iterations();
        Ok((Box::new(factor), Some(iterations)))
    }
}

impl HeldStiffness for HarmonicStiffness {
    fn solver_name(&self) -> &'static str {
        "cyclic"
    }

    fn note(&self) -> String {
        self.note.clone()
    }

    fn memory(&self) -> RingMemory {
        self.memory
    }

    fn block(&self, _: usize) -> usize {
        BLOCK
    }

    fn factor_bytes(&self) -> usize {
        self.sectors.sectors.ring.factor_bytes(self.symmetry)
    }

    fn flops(&self) -> f64 {
        self.sectors.sectors.ring.flops(self.symmetry)
    }

    fn motion(&self) -> Option<MotionMemory> {
        Some(self.motion)
    }

    fn factor(self: Box<Self>, name: &'static str, ring: &RingModel, support: &AppliedHold) -> Factored {
        self.factored(ring.hold)
            .map_err(|source| named(source, name, ring, support))
    }
}

/// What a defect changes in the stiffness of a ring without the nodes `held`.
fn changes(mesh: &Mesh, held: &[usize], Defective { defect, regular }: &Defective) -> Changes {
    let coordinates = Coordinates::new(mesh, held, Vec::new(), 0.0);
    defect.changes(&coordinates, &coordinates.of_mesh(&regular.mesh, &regular.held))
}
