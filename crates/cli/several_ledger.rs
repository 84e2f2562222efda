//! Whether the energy ledgers of a list in motion close: that of each bearing, and that of the shaft.

use std::path::Path;

use anyhow::anyhow;
use assembly::{AssemblyMotion, AssemblyState};
use results::failure::Failure;
use scene::{Dynamic, SeveralScene};

use crate::ledger_check::check_ledger;

/// Stops a run of which a ledger does not close; `worst` becomes the largest defect over the largest energy so far, of
/// those that are more than round-off.
pub fn check_ledgers(
    (scene, dynamic): (&SeveralScene, &Dynamic),
    motion: &AssemblyMotion<'_>,
    next: &AssemblyState,
    worst: &mut f64,
    dir: &Path,
) -> Result<(), Failure> {
    let mut round_off = 0.0;
    for (i, (motion, state)) in motion.bearings.iter().zip(&next.bearings).enumerate() {
        check_ledger(dynamic, motion, state, dir)
            .map_err(|failure| failure.context(format!("bearing {:?}", scene.bearings[i].name)))?;
        let own = motion.energy_round_off(state)?;
        round_off += own;
        if state.ledger.defect().abs() > own {
            *worst = worst.max(state.ledger.relative_defect().abs());
        }
    }
    let (defect, relative) = (next.ledger.defect().abs(), next.ledger.relative_defect().abs());
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
