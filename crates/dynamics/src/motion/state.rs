//! Choices of a motion, all that evolves in it, and what a step reports.

use super::balls::Speed;
use super::contacts::{ContactDamping, ContactScheme};
use super::integrator::Integrator;
use super::ledger::Ledger;
use super::ring::RingState;

/// Choices of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionSettings {
    /// Step size, s.
    pub dt: f64,
    /// Scheme of the rings.
    pub integrator: Integrator,
    /// Scheme of the contacts.
    pub scheme: ContactScheme,
    /// Inner ring speed.
    pub speed: Speed,
    /// Slip ratios at the inner and outer raceway.
    pub slip: [f64; 2],
    /// Contact damping, when the scene calls for it.
    pub contact_damping: Option<ContactDamping>,
    /// Rayleigh damping: factors of M and of K in C, 1/s and s.
    pub rayleigh: [f64; 2],
}

/// All that evolves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotionState {
    /// Steps done.
    pub step: u64,
    /// Coordinates of the flexible rings.
    pub rings: [Option<RingState>; 2],
    /// Ball displacements from the just-touching position [radial, axial], m.
    pub balls: Vec<[f64; 2]>,
    /// Ball velocities, m/s.
    pub ball_velocities: Vec<[f64; 2]>,
    /// Displacement of a rigid inner ring's shaft, m and rad, in space.
    pub shaft: [f64; 5],
    /// Its velocity.
    pub shaft_velocity: [f64; 5],
    /// Mean contact forces of the last step [radial, axial] on the rings, by site, N.
    pub forces: Vec<[f64; 2]>,
    /// Contact angles at the end of the last step, by site, rad.
    pub angles: Vec<f64>,
    /// Hertz approaches at the end of the last step, by site, m; negative is a gap.
    pub approaches: Vec<f64>,
    /// Energy ledger.
    pub ledger: Ledger,
}

/// What happened in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepReport {
    /// Newton iterations on the contacts.
    pub newton_iterations: usize,
}
