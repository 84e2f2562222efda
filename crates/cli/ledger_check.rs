//! Whether the energy ledger of a motion closes.

use std::path::Path;

use anyhow::anyhow;
use dynamics::motion::{Motion, MotionState};
use results::failure::Failure;
use scene::Dynamic;

/// Stops a run whose energy ledger does not close.
pub fn check_ledger(
    dynamic: &Dynamic,
    motion: &Motion<'_>,
    state: &MotionState,
    dir: &Path,
) -> Result<(), Failure> {
    let defect = state.ledger.relative_defect();
    if defect.abs() <= dynamic.ledger_tolerance {
        return Ok(());
    }
    // A bearing that hardly moves has less energy than the round-off of its positions.
    if state.ledger.defect().abs() <= motion.energy_round_off(state)? {
        return Ok(());
    }
    Err(Failure::Numerical(anyhow!(
        "the energy ledger does not close at step {}, t = {:.6e} s: the defect is {defect:.3e} of the largest energy, \
         dynamic.ledger_tolerance is {:.1e}; use contact = \"discrete_gradient\" with integrator = \
         \"average_acceleration\", a smaller step, or a larger tolerance; histories up to here are in {}",
        state.step,
        motion.time(state.step),
        dynamic.ledger_tolerance,
        dir.display()
    )))
}
