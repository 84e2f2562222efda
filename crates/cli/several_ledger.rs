//! Whether the energy ledgers of a list in motion close: that of each bearing, and that of the shaft.

use std::path::Path;

use anyhow::anyhow;
use assembly::{AssemblyMotion, AssemblyState};
use results::failure::Failure;
use scene::{Dynamic, SeveralScene};

use crate::ledger_check::check_ledger;

/// Share of the largest energy below which a defect is round-off of the sums, wherever the rings are.
const ROUND_OFF: f64 = 1e-12;

/// Stops a run of which a ledger does not close; `worst` becomes the largest defect over the largest energy so far, of
/// those that are more than round-off.
pub fn check_ledgers(
    (scene, dynamic): (&SeveralScene, &Dynamic),
    motion: &AssemblyMotion<'_>,
    next: &AssemblyState,
    worst: &mut f64,
    dir: &Path,
) -> Result<(), Failure> {
    let least = ROUND_OFF.min(dynamic.ledger_tolerance);
    for (i, (motion, state)) in motion.bearings.iter().zip(&next.bearings).enumerate() {
        check_ledger(dynamic, motion, state, dir)
            .map_err(|failure| failure.context(format!("bearing {:?}", scene.bearings[i].name)))?;
        let relative = state.ledger.relative_defect().abs();
        let counts = relative > worst.max(least);
        if counts && state.ledger.defect().abs() > motion.energy_round_off(state)? {
            *worst = relative;
        }
    }
    let (defect, relative) = (next.ledger.defect().abs(), next.ledger.relative_defect().abs());
    if relative <= worst.max(least) {
        return Ok(());
    }
    let mut round_off = 0.0;
    for (motion, state) in motion.bearings.iter().zip(&next.bearings) {
        round_off += motion.energy_round_off(state)?;
    }
    if defect <= round_off {
        return Ok(());
    }
    *worst = worst.max(relative);
    if relative <= dynamic.ledger_tolerance {
        return Ok(());
    }
    Err(Failure::Numerical(anyhow!(
        "the energy ledger of the shaft does not close: the defect is {relative:.3e} of the largest energy, \
         dynamic.ledger_tolerance is {:.1e}; take a smaller step, or a larger tolerance",
        dynamic.ledger_tolerance
    )))
}
