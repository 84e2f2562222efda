//! The start of a motion on the course of the equilibria of a bearing that rolls.
//!
//! In an equilibrium nothing moves but the turning. Under a load across, balls that go round move in and out of their
//! place in the bearing: balls that start without that velocity are struck by it, at high speed so that shaft and tilt
//! swing by some per cent. Here shaft and balls have the velocities at which equilibria follow each other: the
//! difference of those a little before and after, over the time between. Loads, temperatures and speeds are those of
//! t = 0. What the balls' accelerations ask for is not in the equilibria: it is left to the motion. So are the
//! velocities of the rings' elastic parts, whose inertia is small.

use contact::{BearingGeometry, Meridian, Side};

use crate::effects::Now;
use crate::error::DynamicsError;
use crate::kinematics::Rolling;
use crate::model::Model;
use crate::pose::Pose;
use crate::solution::StaticSolution;
use crate::statics::StaticSolver;

/// Turn of the cage before and after t = 0 at which equilibria are compared, over the angle from ball to ball. The
/// first four harmonics of a load on 18 balls are then known to 0.5 %, and elements are not felt.
const SHARE: f64 = 0.125;

/// Velocities at which equilibria of a rolling bearing follow each other.
#[derive(Clone, Debug, PartialEq)]
pub struct EquilibriumRates {
    /// Of the shaft, m/s and rad/s.
    pub shaft: [f64; 5],
    /// Of the balls in their meridian planes, m/s; zero of one without load.
    pub balls: Vec<Meridian>,
}

/// Time before and after t = 0 at which equilibria are compared, s; None where the balls do not go round.
pub fn comparison_time(geometry: &BearingGeometry, rolling: &Rolling) -> Option<f64> {
    let pitch = std::f64::consts::TAU / geometry.n_balls as f64;
    let cage = rolling.kinematics.cage_speed(&rolling.speeds, 0.0).abs();
    (cage > 0.0).then(|| SHARE * pitch / cage)
}

/// Where the parts stand a time, s, after t = 0 at the speeds of t = 0, with the loads of t = 0.
pub fn pose_beside(rolling: &Rolling, time: f64) -> Pose {
    let ring_angles = Side::BOTH.map(|side| rolling.speeds.of(side).at(0.0) * time);
    Pose {
        now: Now {
            cage_angle: rolling.kinematics.of_cage(ring_angles),
            ..Now::default()
        },
        rolled: rolling.kinematics.rolled(ring_angles),
        ring_angles,
    }
}

impl EquilibriumRates {
    /// Those of a bearing about an equilibrium at t = 0; zero where its balls do not go round. Costs two equilibria.
    pub fn find(
        solver: &mut StaticSolver,
        (model, rolling): (&Model, &Rolling),
        at: &StaticSolution,
    ) -> Result<EquilibriumRates, DynamicsError> {
        let Some(time) = comparison_time(&model.geometry, rolling) else {
            return Ok(EquilibriumRates {
                shaft: [0.0; 5],
                balls: vec![Meridian::default(); model.geometry.n_balls],
            });
        };
        let mut beside = |time: f64| solver.solve_at(model, &pose_beside(rolling, time), Some(at));
        let (before, after) = (beside(-time)?, beside(time)?);
        Ok(EquilibriumRates::between([&before, &after], 2.0 * time))
    }

    /// From equilibria with a time between them, s.
    pub fn between([before, after]: [&StaticSolution; 2], time: f64) -> EquilibriumRates {
        let (from, to) = (&before.displacements, &after.displacements);
        let is_loaded = |solution: &StaticSolution, ball: usize| {
            let ball = &solution.balls[ball];
            ball.inner.force_n > 0.0 || ball.outer.force_n > 0.0
        };
        let rate = |ball: usize| {
            if is_loaded(before, ball) && is_loaded(after, ball) {
                (to.balls[ball] - from.balls[ball]).map(|change| change / time)
            } else {
                Meridian::default()
            }
        };
        EquilibriumRates {
            shaft: [0, 1, 2, 3, 4].map(|i| (to.shaft[i] - from.shaft[i]) / time),
            balls: (0..from.balls.len()).map(rate).collect(),
        }
    }
}
