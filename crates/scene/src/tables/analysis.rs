//! Which analysis a scene asks for, and what that means for its other tables.

use std::path::Path;

use dynamics::effects::orbit_inertia::OrbitInertiaTable;
use dynamics::effects::{Context, Effects};
use input::{Clock, Problems};
use toml_edit::DocumentMut;

use super::RawScene;
use super::analyses::not_one;
use super::balls::{BallMotion, BallsContext};
use super::bearing::Bearing;
use super::dynamic::RawDynamic;
use super::materials::Materials;
use super::modes::ModesContext;
use super::output::OutputContext;
use super::profiles::{ProfilesContext, SurfaceProfiles};
use super::ring::{MeshFiles, Ring};
use super::shaft::Shaft;
use super::speed::{RawSpeed, SpeedUse, makes_force};
use super::start::Start;
use super::sweep::{Analysis, RawStatic};

impl Analysis {
    /// The effects with the inertia of balls on their orbits where a motion starts with balls that go round, beside
    /// their centrifugal force and where they follow each other: the motion has it of itself.
    pub(super) fn at_start(&self, effects: Effects, profiles: &SurfaceProfiles) -> Effects {
        let is_rolling = matches!(self, Analysis::Dynamic(dynamic) if dynamic.start == Start::Rolling);
        let may = effects.ball_centrifugal.is_some() && profiles.parts_courses(&effects).is_none();
        let added = (is_rolling && may).then_some(OrbitInertiaTable {});
        Effects {
            orbit_inertia: effects.orbit_inertia.or(added),
            ..effects
        }
    }
}

impl RawScene {
    pub(super) fn analysis(
        &self,
        document: &DocumentMut,
        (shaft, modes): (&Shaft, ModesContext),
        problems: &mut Problems,
    ) -> Option<Analysis> {
        let has = [
            self.r#static.is_some(),
            self.sweep.is_some(),
            self.quasi_static.is_some(),
            self.dynamic.is_some(),
            self.modes.is_some(),
        ];
        if let Some(problem) = not_one(has) {
            problems.add(problem);
            return None;
        }
        if let Some(sweep) = &self.sweep {
            return sweep.check(document, problems).map(Analysis::Sweep);
        }
        if let Some(dynamic) = &self.dynamic {
            let known = (shaft, self.speed.is_some());
            return dynamic.check(known, problems).map(Analysis::Dynamic);
        }
        if let Some(quasi) = &self.quasi_static {
            return quasi.check(problems).map(Analysis::QuasiStatic);
        }
        if let Some(raw) = &self.modes {
            return raw.check(modes, problems).map(Analysis::Modes);
        }
        self.r#static.as_ref().map(|RawStatic {}| Analysis::Static)
    }

    /// Whether equilibria are computed, and no motion; a scene without analysis is not judged further.
    fn is_at_rest(&self) -> bool {
        self.dynamic.is_none() && (self.r#static.is_some() || self.sweep.is_some() || self.modes.is_some())
    }

    /// Whether loads and imposed displacements may have schedules.
    pub(super) fn clock(&self) -> Clock {
        if self.is_at_rest() {
            Clock::AtRest
        } else {
            Clock::Running
        }
    }

    /// Whether inertia is left out, so that damping has nothing to do.
    fn is_without_inertia(&self) -> bool {
        self.is_at_rest() || (self.dynamic.is_none() && self.quasi_static.is_some())
    }

    /// What output depends on; flexible rings, inner first.
    pub(super) fn output_context(&self, flexible: [bool; 2]) -> OutputContext {
        OutputContext {
            has_steps: self.dynamic.is_some() || self.quasi_static.is_some(),
            is_motion: self.dynamic.is_some(),
            is_sweep: self.sweep.is_some(),
            is_static: self.r#static.is_some(),
            flexible,
            has_stress: true,
        }
    }

    pub(super) fn effects_context(
        &self,
        is_flexible: [bool; 2],
        (bearing, materials): (Option<&Bearing>, Option<&Materials>),
        (shaft, inner): (&Shaft, &Ring),
        profiles: &SurfaceProfiles,
    ) -> Context {
        let seats = bearing.map(|b| [b.bore_diameter, b.outside_diameter]);
        Context {
            is_without_inertia: self.is_without_inertia(),
            clock: self.clock(),
            has_speed: self.has_speed(),
            is_flexible,
            seat_diameters: [0, 1].map(|i| seats.map(|d| d[i])),
            // Materials that are wrong are reported themselves.
            has_expansion: materials.map_or([true; 2], Materials::has_expansion),
            has_lubricant: self.lubricant.is_some(),
            turning_mass: shaft.turning_mass(inner),
            parts_courses: profiles.parts_courses(&self.effects),
            has_ball_centrifugal: self.effects.ball_centrifugal.is_some(),
        }
    }

    pub(super) fn surfaces_context<'a>(
        &self,
        bearing: Option<&'a Bearing>,
        scene: &'a Path,
        files: MeshFiles,
    ) -> ProfilesContext<'a> {
        ProfilesContext {
            bearing,
            scene,
            files,
            ball: self.contact.ball,
            is_modes: self.modes.is_some(),
            follows_angles: self.speed.as_ref().is_some_and(RawSpeed::follows_angles),
        }
    }

    /// How balls move in time: at rest they yield as those that do not move.
    pub(super) fn moving_balls(&self) -> BallMotion {
        match self.dynamic {
            Some(_) => self.balls.motion(),
            None => BallMotion::Kinematic,
        }
    }

    pub(super) fn balls_context(&self) -> BallsContext<'_> {
        BallsContext {
            effects: &self.effects,
            has_ball_speeds: self.speed.as_ref().is_some_and(RawSpeed::has_ball_speeds),
            is_dynamic: self.dynamic.is_some(),
            is_modes: self.modes.is_some(),
            has_speed: self.speed.is_some(),
            conserves: self.dynamic.as_ref().is_some_and(RawDynamic::conserves),
        }
    }

    /// Whether the scene names the speed of a ring, inner first.
    pub(super) fn has_speed(&self) -> [bool; 2] {
        self.speed.as_ref().map_or([false; 2], RawSpeed::has)
    }

    pub(super) fn speed_use(&self) -> SpeedUse {
        if self.dynamic.is_none() && self.modes.is_some() {
            return SpeedUse::Modes;
        }
        // A life counts how often, and on the ring that stands; a heat balance how fast.
        let is_counted = self.life.is_some() || self.heat.is_some();
        let is_used = self.effects.use_speed(makes_force) || self.lubricant.is_some() || is_counted;
        match (self.is_at_rest(), is_used) {
            (false, _) => SpeedUse::Motion,
            (true, true) => SpeedUse::AtRest,
            (true, false) => SpeedUse::Nothing,
        }
    }
}
