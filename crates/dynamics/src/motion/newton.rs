//! Newton on the small system of a step, with residual line search and dense LU.

use contact::Side;
use dense::DenseLu;
use timer::SharedLaps;

use super::contacts::MeanForce;
use super::small::SmallSystem;
use crate::equilibrium::MAX_TILT;
use crate::error::DynamicsError;
use crate::footprint::require_in_groove;
use crate::model::Model;
use crate::problem::SHAFT_DOFS;

/// Newton iterations before a step counts as failed.
const MAX_ITERATIONS: usize = 40;
/// Residual over the force scale at which iteration may stop; it goes on while it improves.
const RESIDUAL_LIMIT: f64 = 1e-9;
/// Residual over the force scale that counts as round-off.
const RESIDUAL_TARGET: f64 = 1e-14;

/// Solution of a step.
pub struct SmallSolution {
    /// Free shaft dofs, balls, groove motions: in the order of the unknowns.
    pub unknowns: Vec<f64>,
    /// Mean forces, by site.
    pub forces: Vec<MeanForce>,
    /// Forces of the partners on the mounts of inner and outer ring, in the ring's frame.
    pub mounts: [Vec<f64>; 2],
    /// Newton iterations.
    pub iterations: usize,
}

impl SmallSystem {
    /// Unknowns of a step in which nothing accelerates: the start of Newton.
    fn guess(&self) -> Vec<f64> {
        let shaft = self.shaft.free().into_iter().map(|dof| &self.shaft.bodies[dof]);
        let mut x: Vec<f64> = shaft
            .chain(self.balls.iter().flatten())
            .map(|b| b.start[0] + self.dt * b.start[1])
            .collect();
        for ring in self.rings.iter().flatten() {
            x.extend_from_slice(&ring.start[..2 * self.balls.len()]);
        }
        x
    }

    /// What an unknown is, for messages.
    fn name(&self, unknown: usize) -> String {
        let component = ["radial", "axial"];
        let n_shaft = self.n_shaft();
        if unknown < n_shaft {
            return format!("{} of the shaft", SHAFT_DOFS[self.shaft.free()[unknown]]);
        }
        let (index, balls) = (unknown - n_shaft, self.balls.len());
        let (body, ball) = (index / (2 * balls), index % (2 * balls) / 2);
        let side = match (body, &self.rings[0]) {
            (0, _) => "",
            (1, Some(_)) => ", contact on the inner ring",
            _ => ", contact on the outer ring",
        };
        format!("ball {ball}{side}, {}", component[index % 2])
    }

    /// Solves the step. Fails with the residual history and the place of the largest residual.
    pub fn solve(&self, scale: f64, costs: &SharedLaps) -> Result<SmallSolution, DynamicsError> {
        let (n, mut x) = (self.n(), self.guess());
        let linear = self.linear_slope();
        let mut jacobian = linear.clone();
        let (mut history, mut best, mut stalled, mut worst) = (Vec::new(), f64::INFINITY, 0, 0);
        for iteration in 0..MAX_ITERATIONS {
            let forces = self.forces(&x, costs);
            let residual = self.residual(&x, &forces);
            jacobian.copy_from_slice(&linear);
            self.add_contact_slopes(&forces, &mut jacobian);
            let (place, now) = largest(&residual);
            worst = place;
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
            let limit = (RESIDUAL_LIMIT * scale).max(round_off(&jacobian, &x));
            if now <= RESIDUAL_TARGET * scale || (now <= limit && stalled >= 2) {
                return Ok(self.solution(x, forces, iteration));
            }
            self.check_held(&jacobian, &residual)?;
            let mut step: Vec<f64> = residual.iter().map(|r| -r).collect();
            DenseLu::factor(n, &jacobian)
                .map_err(|source| DynamicsError::ContactSystem { source })?
                .solve(&mut step, 1);
            x = self.search(&x, &step, &residual, costs);
        }
        let tail = history.len().saturating_sub(8);
        Err(DynamicsError::NewtonStalled {
            iterations: MAX_ITERATIONS,
            residual: *history.last().unwrap_or(&f64::NAN),
            place: self.name(worst),
            limit: RESIDUAL_LIMIT * scale,
            history: history.split_off(tail),
        })
    }

    fn solution(&self, x: Vec<f64>, forces: Vec<MeanForce>, iterations: usize) -> SmallSolution {
        let mounts = Side::BOTH.map(|side| match &self.rings[side.index()] {
            Some(ring) => self.ring_forces(side, ring, &x)[2 * self.balls.len()..].to_vec(),
            None => Vec::new(),
        });
        SmallSolution {
            unknowns: x,
            forces,
            mounts,
            iterations,
        }
    }

    /// Fails when a free shaft dof has neither inertia nor stiffness: its row of the Jacobian is empty. Names the one that the
    /// loads push most.
    fn check_held(&self, jacobian: &[f64], residual: &[f64]) -> Result<(), DynamicsError> {
        let rows = jacobian.chunks_exact(self.n());
        let dofs = self.shaft.free().into_iter().zip(rows).zip(residual);
        let adrift = dofs.filter(|((_, row), _)| row.iter().all(|x| *x == 0.0));
        match adrift.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) {
            Some(((dof, _), _)) => Err(DynamicsError::Adrift { dof: SHAFT_DOFS[dof] }),
            None => Ok(()),
        }
    }

    /// Halves the step until the residual shrinks.
    fn search(&self, x: &[f64], step: &[f64], residual: &[f64], costs: &SharedLaps) -> Vec<f64> {
        let size = |r: &[f64]| r.iter().map(|v| v * v).sum::<f64>();
        let mut share = 1.0;
        loop {
            let trial: Vec<f64> = x.iter().zip(step).map(|(x, s)| x + share * s).collect();
            let after = self.residual(&trial, &self.forces(&trial, costs));
            if size(&after) <= size(residual) || share < 1e-3 {
                return trial;
            }
            share *= 0.5;
        }
    }
}

/// Residual that round-off of the unknowns alone can make: decisive for bodies that fly without any force.
fn round_off(jacobian: &[f64], x: &[f64]) -> f64 {
    let diagonal = jacobian.iter().step_by(x.len() + 1);
    let terms = diagonal.zip(x).map(|(slope, x)| (slope * x).abs());
    16.0 * f64::EPSILON * terms.fold(0.0, f64::max)
}

/// Place and size of the largest entry; NaN wins.
fn largest(r: &[f64]) -> (usize, f64) {
    r.iter().enumerate().fold((0, 0.0), |(place, most), (i, v)| {
        if v.is_nan() || v.abs() > most {
            (i, v.abs())
        } else {
            (place, most)
        }
    })
}

/// Fails when a ball presses where no groove can be.
fn check_grooves(system: &SmallSystem, solution: &SmallSolution) -> Result<(), DynamicsError> {
    for site in &system.sites {
        let [_, end] = system.reach(site, &solution.unknowns);
        if end[0].hypot(end[1]) > site.touching {
            let sign = site.side.sign();
            let angle = (sign * end[1]).atan2(sign * end[0]);
            require_in_groove(site.ball, site.side, angle)?;
        }
    }
    Ok(())
}

/// Fails when shaft or balls are where small motions and the search for equilibrium end.
pub fn check_range(
    model: &Model,
    system: &SmallSystem,
    solution: &SmallSolution,
) -> Result<(), DynamicsError> {
    let diameter = model.geometry.ball_diameter;
    let in_mm = |x: f64| format!("{:.3} mm", 1e3 * x);
    for (dof, q) in system.shaft_end(&solution.unknowns).into_iter().enumerate() {
        let (limit, text): (f64, fn(f64) -> String) = match dof {
            0..3 => (0.5 * diameter, in_mm),
            _ => (MAX_TILT, |x| format!("{x:.3} rad")),
        };
        if q.abs() > limit {
            let what = format!("{} of the shaft", SHAFT_DOFS[dof]);
            return Err(left(what, text(q), text(limit)));
        }
    }
    for ball in 0..system.balls.len() {
        let at = system.ball_index(ball);
        let [radial, axial] = [0, 1].map(|i| solution.unknowns[at + i]);
        if radial.hypot(axial) > diameter {
            let what = format!("ball {ball}");
            return Err(left(what, in_mm(radial.hypot(axial)), in_mm(diameter)));
        }
    }
    check_grooves(system, solution)
}

fn left(what: String, value: String, limit: String) -> DynamicsError {
    DynamicsError::LeftBearing { what, value, limit }
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
