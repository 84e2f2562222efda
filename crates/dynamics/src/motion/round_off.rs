//! The energy that round-off alone can make: below it a ledger says nothing.
//!
//! A ring that drifts has displacements w far larger than its deformations. Products with K and solves with S then lose
//! the digits of terms of the size of K_ii w_i^2, although their sum is next to nothing.

use contact::Side;

use super::run::Motion;
use super::state::MotionState;
use crate::error::DynamicsError;

impl Motion<'_> {
    /// Energy of the round-off of both flexible rings, J: epsilon/2 times the sum of K_ii w_i^2, with K_ii = E h of an
    /// element of the ring's mean size h. Integrates the rings' masses: for a run that is about to stop. Collective.
    pub fn energy_round_off(&self, state: &MotionState) -> Result<f64, DynamicsError> {
        let mut sum = 0.0;
        for side in Side::BOTH {
            let (moving, own) = (&self.rings[side.index()], &state.rings[side.index()]);
            let (Some(ring), Some(moving), Some(own)) = (self.model.ring(side), moving, own) else {
                continue;
            };
            let w = moving.body.nodal(own.displacement());
            let masses = ring.node_masses(side.name())?;
            let volume = masses.total / ring.material.density;
            let stiffness = ring.material.young_modulus * (volume / ring.mesh.n_nodes() as f64).cbrt();
            sum += stiffness * w.iter().map(|w| w * w).sum::<f64>();
        }
        Ok(0.5 * f64::EPSILON * sum)
    }
}
