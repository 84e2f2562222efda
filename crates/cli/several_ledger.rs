//! Whether the energy ledgers of a list in motion close: that of each bearing, and that of the shaft.

use std::ops::Range;
use std::path::Path;

use anyhow::anyhow;
use assembly::{AssemblyMotion, AssemblyState};
use results::failure::Failure;
use scene::{Dynamic, SeveralScene};

use crate::ledger_check::check_ledger;

/// Share of the largest energy below which a defect is round-off of the sums, wherever the rings are.
const ROUND_OFF: f64 = 1e-12;

/// What the ledgers of a run have shown so far.
#[derive(Default)]
pub struct LedgerWatch {
    /// Largest defect over the largest energy, of those that are more than round-off.
    pub worst: f64,
    /// Energy of the round-off of each bearing, J, as last found; empty at first.
    round_off: Vec<f64>,
}

impl LedgerWatch {
    /// Stops a run of which a ledger does not close.
    pub fn check(
        &mut self,
        (scene, dynamic): (&SeveralScene, &Dynamic),
        motion: &AssemblyMotion<'_>,
        next: &AssemblyState,
        dir: &Path,
    ) -> Result<(), Failure> {
        let least = ROUND_OFF.min(dynamic.ledger_tolerance);
        for (i, (bearing, state)) in motion.bearings.iter().zip(&next.bearings).enumerate() {
            check_ledger(dynamic, bearing, state, dir)
                .map_err(|failure| failure.context(format!("bearing {:?}", scene.bearings[i].name)))?;
            let (defect, relative) = (state.ledger.defect().abs(), state.ledger.relative_defect().abs());
            let counts = relative > self.worst.max(least);
            if counts && !self.is_round_off(defect, i..i + 1, (motion, next))? {
                self.worst = relative;
            }
        }
        let (defect, relative) = (next.ledger.defect().abs(), next.ledger.relative_defect().abs());
        let counts = relative > self.worst.max(least);
        if relative > dynamic.ledger_tolerance {
            // Nothing older may excuse what stops the run.
            self.round_off.clear();
        }
        if !counts || self.is_round_off(defect, 0..motion.bearings.len(), (motion, next))? {
            return Ok(());
        }
        self.worst = relative;
        if relative <= dynamic.ledger_tolerance {
            return Ok(());
        }
        Err(Failure::Numerical(anyhow!(
            "the energy ledger of the shaft does not close: the defect is {relative:.3e} of the largest energy, \
             dynamic.ledger_tolerance is {:.1e}; take a smaller step, or a larger tolerance",
            dynamic.ledger_tolerance
        )))
    }

    /// Whether a defect is no more than the round-off of some bearings. To find it takes as long as a part of a step,
    /// so it is found anew only where a defect is beyond what it last was.
    fn is_round_off(
        &mut self,
        defect: f64,
        bearings: Range<usize>,
        (motion, state): (&AssemblyMotion<'_>, &AssemblyState),
    ) -> Result<bool, Failure> {
        self.round_off.resize(motion.bearings.len(), 0.0);
        if defect <= self.round_off[bearings.clone()].iter().sum() {
            return Ok(true);
        }
        for i in bearings.clone() {
            self.round_off[i] = motion.bearings[i].energy_round_off(&state.bearings[i])?;
        }
        Ok(defect <= self.round_off[bearings].iter().sum())
    }
}
