//! Tables that change nothing that a run computes: for lubrication, life and heat.

use input::Problems;

use super::RawScene;
use super::heat::Heat;
use super::life::Life;
use super::lubricant::Lubrication;

impl RawScene {
    /// What lubricates the contacts; `turns`: whether a speed rolls them.
    pub(super) fn lubricant(&self, turns: bool, problems: &mut Problems) -> Option<Lubrication> {
        self.lubricant.as_ref()?.check(turns, problems)
    }

    /// What a life needs besides loads.
    pub(super) fn life(&self, problems: &mut Problems) -> Option<Life> {
        Some(self.life.as_ref()?.check(self.speed.is_some(), problems))
    }

    /// What a heat balance needs.
    pub(super) fn heat(&self, problems: &mut Problems) -> Option<Heat> {
        self.heat.as_ref()?.check(self.speed.is_some(), problems)
    }
}
