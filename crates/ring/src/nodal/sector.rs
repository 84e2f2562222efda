//! A ring in sectors cut by angle: right-hand sides stay by sector until a step ends.

use solver::SectorBordered;

use super::columns::{Columns, Moved, NodalBody, NodalSolver, Ports};
use super::sector_columns::{SectorFactor, StepHalves};
use crate::body::HeldRing;
use crate::error::RingError;
use crate::matrices::NodalMatrices;
use crate::model::{RingModel, Sectors};
use crate::step::PortForces;
use crate::substructures::Substructures;

/// A ring in sectors.
pub type SectorBody = NodalBody<SectorSolver>;

/// The sectors, which solve themselves.
pub struct SectorSolver(Substructures);

impl SectorBody {
    /// Cuts, assembles and analyses a held ring. Collective.
    pub fn new(ring: &RingModel, held: HeldRing, sectors: Sectors) -> Result<SectorBody, RingError> {
        let parts = Substructures::new(ring, held.name, held.coordinates.free(), sectors)?;
        Ok(NodalBody {
            solver: SectorSolver(parts),
            held,
        })
    }
}

impl NodalSolver for SectorSolver {
    type Columns = SectorFactor;

    fn matrices(&self) -> &dyn NodalMatrices {
        &self.0
    }

    fn name(&self) -> &'static str {
        "sector"
    }

    fn note(&self) -> String {
        format!("sector ({})", self.0.note())
    }

    fn factor(&self, held: &HeldRing, coefficients: [f64; 2]) -> Result<SectorFactor, RingError> {
        let inner = self.0.factor(coefficients)?;
        let [border, corner] = held.nodes(self.matrices()).border(coefficients);
        let columns = border.chunks_exact(held.coordinates.free().len().max(1));
        let entries = |(row, &value): (usize, &f64)| (value != 0.0).then_some((row, value));
        let sparse = columns.map(|column| column.iter().enumerate().filter_map(entries).collect());
        let bordered =
            SectorBordered::new(inner, sparse.collect(), &corner).map_err(|source| RingError::Solver {
                side: held.name,
                source,
            })?;
        Ok(SectorFactor::new(bordered, &held.mount.rows))
    }
}

impl Columns for SectorFactor {
    type Predictor = StepHalves;

    const BY_TABLE: bool = false;

    fn bytes(&self) -> usize {
        self.bytes()
    }

    fn begin(&self, _: &HeldRing, side: Vec<f64>, ports: &Ports) -> (StepHalves, Moved) {
        let halves = self.prepare(&side, &ports.contacts);
        let moved = self.moved(&halves);
        (halves, moved)
    }

    fn move_contacts(&self, _: &HeldRing, halves: &mut StepHalves, ports: &Ports) -> Moved {
        self.move_contacts(halves, &ports.contacts);
        self.moved(halves)
    }

    fn add_load(&self, _: &HeldRing, halves: &mut StepHalves, load: Vec<f64>, _: &Ports) -> Vec<f64> {
        self.add_load(halves, &load)
    }

    fn increment(&self, _: &HeldRing, halves: &StepHalves, _: &Ports, forces: PortForces<'_>) -> Vec<f64> {
        self.increment(halves, forces.contacts, forces.mount)
    }
}
