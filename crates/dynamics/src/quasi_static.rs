//! A bearing that turns without inertia: every instant is an equilibrium, started from the one before.
//!
//! Cage and balls move round as rolling says, the rings turn by their speeds, loads follow their time; velocities
//! and accelerations are taken as zero, so nothing rings and steps may be as long as the pose allows. Centrifugal
//! force of the balls is a load like others. Damping and the inertia of rings and shaft have no part in it.
//!
//! Cost of a step: one solve per ring and round, four (coarse meshes) to seven rounds were measured. The compliance
//! of the contacts is a tangent only, so that of the first instant serves until rounds settle slowly.

use crate::error::DynamicsError;
use crate::kinematics::Rolling;
use crate::model::Model;
use crate::points::{PointStart, SolvedPoint};
use crate::pose::Pose;
use crate::solution::StaticSolution;
use crate::statics::StaticSolver;

/// A model ready to turn without inertia.
pub struct QuasiStaticMotion<'a> {
    model: &'a Model,
    rolling: Rolling,
    /// Time from one instant to the next, s.
    dt: f64,
    /// Factored rings, timing and costs.
    pub solver: StaticSolver,
}

impl<'a> QuasiStaticMotion<'a> {
    /// Factors both rings; instants are `dt` seconds apart.
    pub fn new(model: &'a Model, rolling: Rolling, dt: f64) -> Result<QuasiStaticMotion<'a>, DynamicsError> {
        Ok(QuasiStaticMotion {
            model,
            rolling,
            dt,
            solver: StaticSolver::new(model)?,
        })
    }

    /// Time of a step number, s.
    pub fn time(&self, step: u64) -> f64 {
        step as f64 * self.dt
    }

    /// Where the parts stand at a step.
    pub fn pose(&self, step: u64) -> Pose {
        self.rolling.pose(self.time(step))
    }

    /// Equilibrium of a step, started from that of an earlier one, or from zero displacement.
    pub fn step(
        &mut self,
        step: u64,
        earlier: Option<&StaticSolution>,
    ) -> Result<StaticSolution, DynamicsError> {
        let pose = self.pose(step);
        self.solver.solve_at(self.model, &pose, earlier)
    }

    /// The same as a point of its own, which other threads may have beside others.
    pub fn point(&self, step: u64, start: Option<&PointStart>) -> Result<SolvedPoint, DynamicsError> {
        self.solver.point(self.model, &self.pose(step), start)
    }
}
