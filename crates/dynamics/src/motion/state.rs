//! Choices of a motion, all that evolves in it, and what a step reports.

use contact::Meridian;

use super::free_state::FreeState;
use super::ledger::Ledger;
use crate::effects::RingDamping;
use crate::interactions::contact_damping::ContactDamping;
use crate::interactions::discrete_gradient::ContactScheme;
use crate::interactions::raceway_contact::SiteState;
use crate::kinematics::{RingSpeeds, SlipRatios};
use ring::Integrator;
use ring::RingState;
use timer::Laps;

/// Choices of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionSettings {
    /// Step size, s: the largest when steps adapt.
    pub dt: f64,
    /// How steps are halved.
    pub ladder: Ladder,
    /// Scheme of the rings.
    pub integrator: Integrator,
    /// Scheme of the contacts.
    pub scheme: ContactScheme,
    /// Speeds of the rings.
    pub speeds: RingSpeeds,
    /// Slip ratios at the inner and outer raceway.
    pub slip: SlipRatios,
    /// Contact damping, when the scene calls for it.
    pub contact_damping: Option<ContactDamping>,
    /// Rayleigh damping of the rings.
    pub rayleigh: RingDamping,
}

impl MotionSettings {
    /// Equal steps of `dt` seconds that conserve energy, without slip and damping.
    pub fn conserving(dt: f64, speeds: impl Into<RingSpeeds>) -> MotionSettings {
        MotionSettings {
            dt,
            ladder: Ladder::default(),
            integrator: Integrator::average_acceleration(),
            scheme: ContactScheme::DiscreteGradient,
            speeds: speeds.into(),
            slip: [0.0; 2],
            contact_damping: None,
            rayleigh: RingDamping::default(),
        }
    }
}

/// The ladder of step sizes dt 2^-k; each keeps its factors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ladder {
    /// Largest k. A step that fails is done again in halves down to it.
    pub halvings: u32,
    /// Accepted local error over the largest contact approach; None: steps are halved only when they fail.
    pub tolerance: Option<f64>,
}

/// All that evolves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotionState {
    /// Steps done.
    pub step: u64,
    /// Rung k of the ladder on which the next step begins.
    pub rung: u64,
    /// The flexible rings.
    pub rings: [Option<RingState>; 2],
    /// Ball displacements from the just-touching position, m.
    pub balls: Vec<Meridian>,
    /// Ball velocities, m/s.
    pub ball_velocities: Vec<Meridian>,
    /// Ball accelerations, m/s^2.
    pub ball_accelerations: Vec<Meridian>,
    /// Displacement of the shaft in space, m and rad.
    pub shaft: [f64; 5],
    /// Its velocity; the mean over the last step for dofs without mass of their own.
    pub shaft_velocity: [f64; 5],
    /// Its acceleration; 0 for dofs without mass of their own.
    pub shaft_acceleration: [f64; 5],
    /// The seat of the outer ring along z, if it slides: displacement, velocity, acceleration, m, m/s, m/s^2.
    pub seat: Option<[f64; 3]>,
    /// Mean accelerations over the last part of a step, of the balls, then of the groove centres by
    /// site, m/s^2: what the local error is estimated from. Zero when steps do not adapt, NaN where nothing is known
    /// yet.
    pub trend: Vec<Meridian>,
    /// Mean contact forces of the last step on the rings, by site, N.
    pub forces: Vec<Meridian>,
    /// Contact angles at the end of the last step, by site, rad.
    pub angles: Vec<f64>,
    /// Hertz approaches at the end of the last step, by site, m; negative is a gap.
    pub approaches: Vec<f64>,
    /// Where patches lay in the middle of the last three parts of a step, the last first, by site.
    pub places: [Vec<PatchPlace>; 3],
    /// Free balls; None: they are kinematic. `balls` and `ball_velocities` then follow from these.
    pub free: Option<FreeState>,
    /// Energy ledger.
    pub ledger: Ledger,
}

/// Where a patch lies on its groove, and the force that gives it its size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchPlace {
    /// Contact angle, rad.
    pub angle: f64,
    /// Force, N.
    pub force: f64,
}

impl PatchPlace {
    /// That of a contact at an instant.
    pub(super) fn of(contact: &SiteState) -> PatchPlace {
        PatchPlace {
            angle: contact.angle,
            force: contact.force.force,
        }
    }
}

impl MotionState {
    /// A copy of all but the rings, which are most of it.
    pub(super) fn without_rings(&self) -> MotionState {
        MotionState {
            step: self.step,
            rung: self.rung,
            rings: [None, None],
            balls: self.balls.clone(),
            ball_velocities: self.ball_velocities.clone(),
            ball_accelerations: self.ball_accelerations.clone(),
            shaft: self.shaft,
            shaft_velocity: self.shaft_velocity,
            shaft_acceleration: self.shaft_acceleration,
            seat: self.seat,
            trend: self.trend.clone(),
            forces: self.forces.clone(),
            angles: self.angles.clone(),
            approaches: self.approaches.clone(),
            places: self.places.clone(),
            free: self.free.clone(),
            ledger: self.ledger,
        }
    }
}

/// What happened in a step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Newton iterations on the contacts.
    pub newton_iterations: usize,
    /// Rounds for the inertia of the turning frame.
    pub frame_rounds: usize,
    /// Rounds for the places of the patches.
    pub place_rounds: usize,
    /// Bearing in which the step was done.
    pub substeps: usize,
    /// Bearing that failed or were too inaccurate and were done again.
    pub retries: usize,
    /// Largest accepted local error over the largest contact approach; 0 when steps do not adapt.
    pub error: f64,
    /// Wall time by part, see [`crate::costs`]; of two rings side by side, the longer.
    pub laps: Laps,
}

impl StepReport {
    /// Adds another part of the same step, or another step.
    pub fn add(&mut self, other: &StepReport) {
        self.newton_iterations += other.newton_iterations;
        self.frame_rounds += other.frame_rounds;
        self.place_rounds += other.place_rounds;
        self.substeps += other.substeps;
        self.retries += other.retries;
        self.error = self.error.max(other.error);
        self.laps.merge(&other.laps);
    }
}
