//! The small nonlinear system of one step: balls, groove centres of flexible rings, a rigid shaft.
//!
//! Unknowns are the displacements at the end of the step. Residuals are forces: inertia and loads of balls and shaft
//! at the middle of the step, and for every flexible ring its linear answer C^-1 (g1 - predicted) against the mean
//! contact forces. Newton with residual line search, dense LU.

use contact::Side;
use solver::dense::DenseLu;

use super::contacts::{ContactDamping, ContactScheme, MeanForce, mean_force};
use crate::error::DynamicsError;
use crate::problem::Site;

/// Newton iterations before a step counts as failed.
const MAX_ITERATIONS: usize = 40;
/// Residual over the force scale at which iteration may stop; it goes on while it improves.
const RESIDUAL_LIMIT: f64 = 1e-9;
/// Residual over the force scale that counts as round-off.
const RESIDUAL_TARGET: f64 = 1e-14;

/// A point mass or rigid body dof over one step: inertia m (v1 - v0)/dt at the midpoint rule.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inertia {
    /// Mass or moment of inertia, kg or kg m^2.
    pub mass: f64,
    /// Displacement and velocity at the start.
    pub start: [f64; 2],
    /// Load at the middle of the step.
    pub load: f64,
    /// Load per unit of mean displacement (ball centrifugal force), N/m.
    pub load_slope: f64,
}

impl Inertia {
    /// Out-of-balance force at displacement `x` and its derivative.
    fn residual(&self, x: f64, dt: f64) -> [f64; 2] {
        let [x0, v0] = self.start;
        let acceleration = 2.0 * ((x - x0) / dt - v0) / dt;
        let load = self.load + self.load_slope * 0.5 * (x + x0);
        [
            self.mass * acceleration - load,
            2.0 * self.mass / (dt * dt) - 0.5 * self.load_slope,
        ]
    }

    /// Velocity at the end.
    pub fn velocity(&self, x: f64, dt: f64) -> f64 {
        2.0 * (x - self.start[0]) / dt - self.start[1]
    }
}

/// A flexible ring as its contacts see it over the step.
pub struct RingAnswer {
    /// Groove motions at the start, m, `[2 n_balls]`.
    pub start: Vec<f64>,
    /// At the end without contact forces.
    pub predicted: Vec<f64>,
    /// Inverse compliance, N/m, row-major.
    pub stiffness: Vec<f64>,
}

/// The system of one step.
pub struct SmallSystem {
    /// Step size, s.
    pub dt: f64,
    /// Contacts, ball 0 inner, ball 0 outer, ...
    pub sites: Vec<Site>,
    /// Balls [radial, axial].
    pub balls: Vec<[Inertia; 2]>,
    /// Free dofs of a rigid inner ring with its shaft: dof number and inertia; empty for a flexible inner ring.
    pub shaft: Vec<(usize, Inertia)>,
    /// Flexible rings.
    pub rings: [Option<RingAnswer>; 2],
    /// Force scheme.
    pub scheme: ContactScheme,
    /// Contact damping.
    pub damping: Option<ContactDamping>,
}

/// Solution of a step.
pub struct SmallSolution {
    /// Shaft dofs, balls, groove motions: in the order of the unknowns.
    pub unknowns: Vec<f64>,
    /// Mean forces, by site.
    pub forces: Vec<MeanForce>,
    /// Newton iterations.
    pub iterations: usize,
}

impl SmallSystem {
    /// Number of unknowns.
    fn n(&self) -> usize {
        self.shaft.len() + 2 * self.balls.len() * (1 + self.rings.iter().flatten().count())
    }

    /// Index of a ball's radial unknown.
    pub fn ball_index(&self, ball: usize) -> usize {
        self.shaft.len() + 2 * ball
    }

    /// Index of the first groove unknown of a ring.
    fn ring_index(&self, side: Side) -> usize {
        let before = usize::from(side == Side::Outer && self.rings[0].is_some());
        self.shaft.len() + 2 * self.balls.len() * (1 + before)
    }

    /// l at the start and at the end of the step.
    pub fn reach(&self, site: &Site, x: &[f64]) -> [[f64; 2]; 2] {
        let ball = self.ball_index(site.ball);
        let mut l = [site.reach, site.reach];
        for i in 0..2 {
            l[0][i] += self.balls[site.ball][i].start[0];
            l[1][i] += x[ball + i];
        }
        if let Some(ring) = &self.rings[site.side.index()] {
            let first = self.ring_index(site.side) + 2 * site.ball;
            for i in 0..2 {
                l[0][i] -= ring.start[2 * site.ball + i];
                l[1][i] -= x[first + i];
            }
        } else if site.side == Side::Inner {
            for (k, (dof, inertia)) in self.shaft.iter().enumerate() {
                let row = site.shaft_rows()[*dof];
                for i in 0..2 {
                    l[0][i] -= row[i] * inertia.start[0];
                    l[1][i] -= row[i] * x[k];
                }
            }
        }
        l
    }

    /// Unknowns that move a site, and dl1 per unit of each.
    fn local(&self, site: &Site) -> Vec<(usize, [f64; 2])> {
        let ball = self.ball_index(site.ball);
        let mut list = vec![(ball, [1.0, 0.0]), (ball + 1, [0.0, 1.0])];
        if self.rings[site.side.index()].is_some() {
            let first = self.ring_index(site.side) + 2 * site.ball;
            list.extend([(first, [-1.0, 0.0]), (first + 1, [0.0, -1.0])]);
        } else if site.side == Side::Inner {
            let rows = site.shaft_rows();
            list.extend(
                self.shaft
                    .iter()
                    .enumerate()
                    .map(|(k, (dof, _))| (k, rows[*dof].map(|r| -r))),
            );
        }
        list
    }

    fn forces(&self, x: &[f64]) -> Vec<MeanForce> {
        let damping = self.damping.as_ref().map(|d| (d, self.dt));
        let force = |s: &Site| mean_force(&s.law, s.touching, self.reach(s, x), self.scheme, damping);
        self.sites.iter().map(force).collect()
    }

    /// Residual, and the Jacobian, row-major, when asked for.
    fn residual(&self, x: &[f64], forces: &[MeanForce], mut jacobian: Option<&mut [f64]>) -> Vec<f64> {
        let n = self.n();
        let mut residual = vec![0.0; n];
        let bodies = self.shaft.iter().map(|s| &s.1).chain(self.balls.iter().flatten());
        for (i, body) in bodies.enumerate() {
            let [force, slope] = body.residual(x[i], self.dt);
            residual[i] = force;
            if let Some(j) = &mut jacobian {
                j[n * i + i] += slope;
            }
        }
        for side in Side::BOTH {
            let Some(ring) = &self.rings[side.index()] else {
                continue;
            };
            let (first, m) = (self.ring_index(side), ring.start.len());
            for i in 0..m {
                let row = &ring.stiffness[m * i..m * (i + 1)];
                residual[first + i] = (0..m).map(|k| row[k] * (x[first + k] - ring.predicted[k])).sum();
                if let Some(j) = &mut jacobian {
                    (0..m).for_each(|k| j[n * (first + i) + first + k] += row[k]);
                }
            }
        }
        for (site, force) in self.sites.iter().zip(forces) {
            let local = self.local(site);
            for (a, row_a) in &local {
                residual[*a] += row_a[0] * force.force[0] + row_a[1] * force.force[1];
                if let Some(j) = &mut jacobian {
                    for (b, row_b) in &local {
                        let t = &force.tangent;
                        j[n * a + b] += (0..2)
                            .map(|i| row_a[i] * (t[i][0] * row_b[0] + t[i][1] * row_b[1]))
                            .sum::<f64>();
                    }
                }
            }
        }
        residual
    }

    /// Unknowns of a step in which nothing accelerates: the start of Newton.
    fn guess(&self) -> Vec<f64> {
        let bodies = self.shaft.iter().map(|s| &s.1).chain(self.balls.iter().flatten());
        let mut x: Vec<f64> = bodies
            .map(|b| b.start[0] + if b.mass > 0.0 { self.dt * b.start[1] } else { 0.0 })
            .collect();
        for ring in self.rings.iter().flatten() {
            x.extend_from_slice(&ring.start);
        }
        x
    }

    /// Solves the step. Fails with the residual history.
    pub fn solve(&self, scale: f64) -> Result<SmallSolution, DynamicsError> {
        let (n, mut x) = (self.n(), self.guess());
        let size = |r: &[f64]| {
            r.iter()
                .fold(0.0f64, |m, v| if v.is_nan() { f64::NAN } else { m.max(v.abs()) })
        };
        let (mut history, mut best, mut stalled) = (Vec::new(), f64::INFINITY, 0);
        for iteration in 0..MAX_ITERATIONS {
            let forces = self.forces(&x);
            let mut jacobian = vec![0.0; n * n];
            let residual = self.residual(&x, &forces, Some(&mut jacobian));
            let now = size(&residual);
            if !now.is_finite() {
                return Err(DynamicsError::NotFinite {
                    what: "a contact force",
                });
            }
            let scale = forces
                .iter()
                .fold(scale, |m, f| m.max(f.force[0].abs()).max(f.force[1].abs()));
            history.push(now);
            stalled = if now < 0.5 * best { 0 } else { stalled + 1 };
            best = best.min(now);
            if now <= RESIDUAL_TARGET * scale || (now <= RESIDUAL_LIMIT * scale && stalled >= 2) {
                return Ok(SmallSolution {
                    unknowns: x,
                    forces,
                    iterations: iteration,
                });
            }
            let mut step: Vec<f64> = residual.iter().map(|r| -r).collect();
            DenseLu::factor(n, &jacobian)
                .map_err(|source| DynamicsError::ContactSystem { source })?
                .solve(&mut step, 1);
            x = self.search(&x, &step, &residual);
        }
        let tail = history.len().saturating_sub(8);
        Err(DynamicsError::NewtonStalled {
            iterations: MAX_ITERATIONS,
            residual: *history.last().unwrap_or(&f64::NAN),
            place: "a step in time".to_string(),
            limit: RESIDUAL_LIMIT * scale,
            history: history.split_off(tail),
        })
    }

    /// Halves the step until the residual shrinks.
    fn search(&self, x: &[f64], step: &[f64], residual: &[f64]) -> Vec<f64> {
        let size = |r: &[f64]| r.iter().map(|v| v * v).sum::<f64>();
        let mut share = 1.0;
        loop {
            let trial: Vec<f64> = x.iter().zip(step).map(|(x, s)| x + share * s).collect();
            let after = self.residual(&trial, &self.forces(&trial), None);
            if size(&after) <= size(residual) || share < 1e-3 {
                return trial;
            }
            share *= 0.5;
        }
    }
}

/// Fails when a contact is beyond what its patch leaves of Hertz's law.
pub fn check_patches(system: &SmallSystem, solution: &SmallSolution) -> Result<(), DynamicsError> {
    for (site, force) in system.sites.iter().zip(&solution.forces) {
        let [_, end] = system.reach(site, &solution.unknowns);
        if site
            .law
            .evaluate(end[0].hypot(end[1]) - site.touching)
            .beyond_limit
        {
            return Err(DynamicsError::PatchTooSmall {
                ball: site.ball,
                side: site.side.name(),
                force: force.force[0].hypot(force.force[1]),
            });
        }
    }
    Ok(())
}
