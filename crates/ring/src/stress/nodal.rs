//! Stress at the nodes of a flexible ring: element by element, or of a periodic ring by the weights of one sector.
//!
//! Both are the same to round-off ([`fem::stress`]); the second costs a fraction of the first, because neither
//! geometry nor elements are looked at again. A model that forces the sparse solver gets the first.

use fem::StressRecovery;
use solver::CyclicStencil;

use super::sector::stress_operator;
use crate::error::RingError;
use crate::model::{Backend, RingModel};

/// What the stress at the nodes of a ring takes.
pub enum NodalStress {
    /// Geometry and averages of all elements.
    Elements(Box<StressRecovery>),
    /// Weights of one sector.
    Sectors(Box<CyclicStencil>),
}

impl NodalStress {
    /// Prepares a ring's stress; `side` is `inner` or `outer`.
    pub fn new(ring: &RingModel, side: &'static str, backend: Backend) -> Result<NodalStress, RingError> {
        let recovery = StressRecovery::new(&ring.mesh, &ring.material)
            .map_err(|source| RingError::Fem { side, source })?;
        let operator = match backend {
            Backend::Sparse | Backend::Sector(_) => None,
            Backend::Auto | Backend::Cyclic => stress_operator(ring, &recovery, side)?,
        };
        Ok(operator.map_or_else(
            || NodalStress::Elements(Box::new(recovery)),
            |operator| NodalStress::Sectors(Box::new(operator)),
        ))
    }

    /// Stress at the nodes, Pa, `[n_nodes][6]`, from displacements, m, `[3 n_nodes]`.
    ///
    /// # Panics
    /// If `u` has another length.
    pub fn nodal(&self, u: &[f64]) -> Vec<[f64; 6]> {
        match self {
            NodalStress::Elements(recovery) => recovery.nodal(u),
            NodalStress::Sectors(operator) => {
                let mut stress = vec![[0.0; 6]; u.len() / 3];
                operator.tensors(u, &mut stress);
                stress
            }
        }
    }

    /// Bytes of the weights, of a periodic ring.
    pub fn operator_bytes(&self) -> Option<usize> {
        match self {
            NodalStress::Elements(_) => None,
            NodalStress::Sectors(operator) => Some(operator.bytes()),
        }
    }
}
