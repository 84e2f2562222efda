//! Stress of a ring that harmonics can solve, as operators of one sector.

use fem::StressRecovery;
use mesh::Periodicity;
use solver::cyclic::PointStencil;
use solver::{CyclicRing, CyclicStencil};

use crate::error::RingError;
use crate::harmonic::periodic::{PeriodicSectors, couplings, usable};
use crate::model::RingModel;

/// Weights of one sector.
pub(crate) struct SectorOperator {
    pub operator: PointStencil,
    /// Class and first node of every element.
    pub elements: Vec<[usize; 2]>,
}

/// The operator of the stress at the nodes, Pa, of a ring that harmonics can solve; None of any other.
pub(crate) fn stress_operator(
    ring: &RingModel,
    recovery: &StressRecovery,
    side: &'static str,
) -> Result<Option<CyclicStencil>, RingError> {
    let Some(periodicity) = periodicity(ring) else {
        return Ok(None);
    };
    let stress = recovery.sector(&ring.mesh, periodicity);
    let weights = stress.weights.as_flattened().as_flattened();
    let whole = whole_ring(ring, periodicity, side)?;
    Ok(Some(whole.stencil(6, &couplings(&stress.couplings), weights)))
}

/// The operator of the stress at the integration points, Pa, of a ring that harmonics can solve and whose elements
/// are alike; None of any other.
pub(crate) fn point_operator(
    ring: &RingModel,
    recovery: &StressRecovery,
    side: &'static str,
) -> Result<Option<SectorOperator>, RingError> {
    let Some(periodicity) = periodicity(ring) else {
        return Ok(None);
    };
    let Some(stress) = recovery.sector_points(&ring.mesh, periodicity) else {
        return Ok(None);
    };
    let n_points = stress.points_per_element;
    let classes = (n_points * periodicity.elements().len(), n_points);
    let weights = stress.weights.as_flattened().as_flattened();
    let whole = whole_ring(ring, periodicity, side)?;
    Ok(Some(SectorOperator {
        operator: whole.point_stencil(classes, &couplings(&stress.couplings), weights),
        elements: stress.elements,
    }))
}

/// The sectors of a ring that harmonics can solve.
fn periodicity(ring: &RingModel) -> Option<&Periodicity> {
    usable(ring).ok().and(ring.periodicity().ok())
}

fn whole_ring(
    ring: &RingModel,
    periodicity: &Periodicity,
    side: &'static str,
) -> Result<CyclicRing, RingError> {
    Ok(PeriodicSectors::assemble(ring, &ring.mesh, periodicity, side)?.ring)
}
