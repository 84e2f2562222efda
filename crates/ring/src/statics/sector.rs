//! Stiffness of a ring in sectors cut by angle.

use ::solver::LinearSolver;

use super::stiffness::{Factored, HeldStiffness, Numbers, named};
use crate::error::RingError;
use crate::memory::RingMemory;
use crate::model::{RingModel, Sectors};
use crate::rank_memory::{RankMemory, Share};
use crate::substructures::Substructures;
use crate::support::AppliedHold;

/// Sectors cut by angle.
pub(super) struct SectorStiffness {
    parts: Substructures,
    memory: RingMemory,
}

impl SectorStiffness {
    /// Cuts, assembles and analyses a ring of `n_contacts` contacts. Collective.
    pub fn new(
        name: &'static str,
        ring: &RingModel,
        support: &AppliedHold,
        numbers: Numbers,
        (sectors, n_contacts): (Sectors, usize),
    ) -> Result<SectorStiffness, RingError> {
        let parts = match numbers {
            Numbers::Assembled => Substructures::new(ring, name, &support.free, sectors)?,
            Numbers::Pattern => Substructures::pattern(ring, name, &support.free, sectors)?,
        };
        Ok(SectorStiffness {
            memory: RankMemory::new(ring, &parts, n_contacts, &Share::of(sectors.comm)).phases(),
            parts,
        })
    }
}

impl HeldStiffness for SectorStiffness {
    fn solver_name(&self) -> &'static str {
        "sector"
    }

    fn note(&self) -> String {
        format!("sector ({})", self.parts.note())
    }

    fn memory(&self) -> RingMemory {
        self.memory
    }

    fn factor_bytes(&self) -> usize {
        let symbolic = self.parts.symbolic();
        let own: usize = symbolic.costs().iter().map(|c| c.factor_bytes).sum();
        own + symbolic.interface_bytes(symbolic.owned())
    }

    fn flops(&self) -> f64 {
        self.parts.symbolic().costs().iter().map(|c| c.flops).sum()
    }

    fn parts(&self) -> Option<&Substructures> {
        Some(&self.parts)
    }

    fn factor(self: Box<Self>, name: &'static str, ring: &RingModel, support: &AppliedHold) -> Factored {
        match self.parts.factor([0.0, 1.0]) {
            Ok(factor) => Ok((Box::new(factor) as Box<dyn LinearSolver>, None)),
            Err(RingError::Solver { source, .. }) => Err(named(source, name, ring, support)),
            Err(other) => Err(other),
        }
    }
}
