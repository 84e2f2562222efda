//! A ring in sectors cut by angle: its columns stay by sector.

use solver::SectorBordered;

use super::columns::{Columns, Moved, NodalBody, NodalSolver, Ports, column_compliance};
use super::sector_columns::{Motions, SectorFactor, StepColumns};
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

/// The factor of the sectors and the compliance of the mount, row-major.
pub struct SectorsFactored {
    factor: SectorFactor,
    mount_compliance: Vec<f64>,
}

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
    type Columns = SectorsFactored;

    fn matrices(&self) -> &dyn NodalMatrices {
        &self.0
    }

    fn name(&self) -> &'static str {
        "sector"
    }

    fn note(&self) -> String {
        format!("sector ({})", self.0.note())
    }

    fn factor(&self, held: &HeldRing, coefficients: [f64; 2]) -> Result<SectorsFactored, RingError> {
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
        let factor = SectorFactor::new(bordered, &held.mount.rows);
        Ok(SectorsFactored {
            mount_compliance: factor.mount_compliance(&held.mount.rows),
            factor,
        })
    }
}

impl SectorsFactored {
    fn moved(&self, motions: Motions) -> Moved {
        let size = motions.predicted.len();
        let contacts = motions.by_contacts.len() / size.max(1);
        Moved {
            compliance: column_compliance([size, contacts], &self.mount_compliance, |i, j| {
                motions.by_contacts[contacts * i + j]
            }),
            predicted: motions.predicted,
        }
    }
}

impl Columns for SectorsFactored {
    type Predictor = StepColumns;

    const BY_TABLE: bool = false;

    fn bytes(&self) -> usize {
        self.factor.bytes()
    }

    fn begin(&self, held: &HeldRing, side: Vec<f64>, ports: &Ports) -> (StepColumns, Moved) {
        let (columns, motions) = self.factor.prepare(&side, &ports.contacts, &ports.all(held));
        (columns, self.moved(motions))
    }

    fn move_contacts(&self, held: &HeldRing, columns: &mut StepColumns, ports: &Ports) -> Moved {
        let motions = self
            .factor
            .move_contacts(columns, &ports.contacts, &ports.all(held));
        self.moved(motions)
    }

    fn add_load(
        &self,
        held: &HeldRing,
        columns: &mut StepColumns,
        load: Vec<f64>,
        ports: &Ports,
    ) -> Vec<f64> {
        self.factor.add_load(columns, &load, &ports.all(held))
    }

    fn increment(&self, _: &HeldRing, columns: &StepColumns, _: &Ports, forces: PortForces<'_>) -> Vec<f64> {
        self.factor.increment(columns, forces.contacts, forces.mount)
    }
}
