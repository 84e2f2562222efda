//! Tables that a scene may have: a free cage, a body round the outer ring; and those that change nothing that a run
//! computes, for lubrication, life and heat.

use dynamics::interactions::cage::Cage;
use dynamics::kinematics::{BallSpeeds, RingSpeeds};
use input::Problems;

use super::balls::BallMotion;
use super::bearing::Bearing;
use super::body::{BodyContext, SceneBody, check_bodies};
use super::heat::Heat;
use super::life::Life;
use super::lubricant::{Lubrication, Turns};
use super::materials::Materials;
use super::probes::{Probes, ProbesContext};
use super::solver::BackendChoice;
use super::stress::{Stress, StressContext};
use super::{RawScene, TextSource};
use dynamics::ContactMode;

impl RawScene {
    /// A free cage beside balls that move so.
    pub(super) fn cage(
        &self,
        balls: BallMotion,
        bearing: Option<&Bearing>,
        materials: Option<&Materials>,
        problems: &mut Problems,
    ) -> Option<Cage> {
        let cage = self.cage.as_ref()?;
        let material = materials.map(|materials| &materials.balls);
        cage.check((balls, self.dynamic.is_some()), bearing, material, problems)
    }

    /// The bodies of both rings, inner first.
    pub(super) fn bodies(
        &self,
        source: &TextSource<'_>,
        backend: BackendChoice,
        problems: &mut Problems,
        assumed: &mut Vec<String>,
    ) -> [Option<SceneBody>; 2] {
        let context = BodyContext {
            scene: source.path,
            files: source.mesh_files,
            supports: [self.inner.support(), self.outer.support()],
            is_rigid: [self.inner.is_rigid(), self.outer.is_rigid()],
            turns_outer: self.has_speed()[1],
            backend,
            moves: self.dynamic.is_some() || self.modes.is_some(),
            effects: self.effects.names(),
        };
        check_bodies(&self.body, &context, problems, assumed)
    }

    /// Speeds of the rings, and the contact angles that those of the balls follow.
    pub(super) fn speeds(&self, problems: &mut Problems) -> (Option<RingSpeeds>, BallSpeeds) {
        let speed = self.speed.as_ref();
        let balls = speed.map_or(BallSpeeds::default(), |s| s.ball_speeds(&self.effects, problems));
        (speed.and_then(|s| s.check(self.speed_use(), problems)), balls)
    }

    /// How stress is computed with contacts of this mode.
    pub(super) fn stress_of(&self, contact: ContactMode, problems: &mut Problems) -> Stress {
        let is_modes = self.modes.is_some();
        self.stress.check(StressContext { contact, is_modes }, problems)
    }

    /// Single numbers that are written at every step.
    pub(super) fn probes_of(&self, bearing: Option<&Bearing>, problems: &mut Problems) -> Probes {
        let rigid = [self.inner.is_rigid(), self.outer.is_rigid()];
        let context = ProbesContext::new(bearing, rigid, self.has_speed());
        self.probes.check(context, problems)
    }

    /// What lubricates the contacts that roll at these speeds.
    pub(super) fn lubricant(
        &self,
        speeds: Option<&RingSpeeds>,
        problems: &mut Problems,
    ) -> Option<Lubrication> {
        let rolls = self.speed.is_some() && self.modes.is_none();
        let turns = rolls.then(|| match speeds.is_some_and(RingSpeeds::changes) {
            true => Turns::Changing,
            false => Turns::Steadily,
        });
        self.lubricant.as_ref()?.check(turns, problems)
    }

    /// What a life needs besides loads.
    pub(super) fn life(&self, problems: &mut Problems) -> Option<Life> {
        Some(self.life.as_ref()?.check(self.speed.is_some(), problems))
    }

    /// What a heat balance needs.
    pub(super) fn heat(&self, problems: &mut Problems) -> Option<Heat> {
        let has_free_balls = self.balls.motion() == BallMotion::Free;
        self.heat
            .as_ref()?
            .check(self.speed.is_some(), has_free_balls, problems)
    }
}
