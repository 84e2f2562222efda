//! Stress at the integration points of a flexible ring: element by element, or of a periodic ring by the weights of
//! one sector.
//!
//! Both are the same to round-off. The second needs the nodes of all elements of a class in the same order, as in a
//! revolved mesh.

use fem::StressRecovery;

use super::sector::{SectorOperator, point_operator};
use crate::error::RingError;
use crate::model::{Backend, RingModel};

/// What the stress at the integration points of a ring takes.
pub struct PointStress {
    recovery: StressRecovery,
    sectors: Option<SectorOperator>,
}

impl PointStress {
    /// Prepares a ring's stress; `side` is `inner` or `outer`.
    pub fn new(ring: &RingModel, side: &'static str, backend: Backend) -> Result<PointStress, RingError> {
        let recovery = StressRecovery::new(&ring.mesh, &ring.material)
            .map_err(|source| RingError::Fem { side, source })?;
        let sectors = match backend {
            Backend::Sparse | Backend::Sector(_) => None,
            Backend::Auto | Backend::Cyclic => point_operator(ring, &recovery, side)?,
        };
        Ok(PointStress { recovery, sectors })
    }

    /// Stress element by element, of any mesh.
    pub fn of_elements(recovery: StressRecovery) -> PointStress {
        PointStress {
            recovery,
            sectors: None,
        }
    }

    /// Stress at the points, Pa, `[n_elements * points_per_element][6]`, from displacements, m, `[3 n_nodes]`.
    ///
    /// # Panics
    /// If `u` has another length.
    pub fn at_points(&self, u: &[f64]) -> Vec<[f64; 6]> {
        match &self.sectors {
            None => self.recovery.integration_points(u),
            Some(sectors) => sectors.operator.tensors(u, &sectors.elements),
        }
    }

    /// Positions of the points, m.
    pub fn point_positions(&self) -> Vec<[f64; 3]> {
        self.recovery.point_positions()
    }

    /// Bytes of the weights, of a periodic ring.
    pub fn operator_bytes(&self) -> Option<usize> {
        self.sectors.as_ref().map(|sectors| sectors.operator.bytes())
    }
}
