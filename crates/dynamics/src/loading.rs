//! Loads in the contact problem: at rest, and for loads that follow the contact angles, until both rest.
//!
//! Loads that do not depend on contact angles are evaluated once. Those that do (the gyroscopic moment) are evaluated
//! again at the angles of the equilibrium that they gave, until they do not change: a fixed point, since they are dead
//! loads to Newton. Each pass shrinks the change by (change of the loads) / (change of the contact forces), below 0.4 for
//! the gyroscopic moment even on balls that have left the inner raceway.

use contact::Side;

use crate::costs::EffectCosts;
use crate::effects::{self, Loads, Now};
use crate::equilibrium::{SearchScales, minimise};
use crate::error::DynamicsError;
use crate::model::Model;
use crate::pose::Pose;
use crate::problem::{Displacements, Problem, Site, site_forces};

/// The contact problem of a model at an instant, with its loads.
pub struct LoadCase<'a> {
    /// Model.
    pub model: &'a Model,
    /// Instant.
    pub pose: Pose,
    /// Contact problem, with the loads in it.
    pub problem: Problem,
    /// The loads.
    pub loads: Loads,
    /// Limits and scales of the search.
    pub scales: SearchScales,
    /// Newton iterations so far.
    pub newton_iterations: usize,
}

impl<'a> LoadCase<'a> {
    /// The problem on rigid rings, with the loads of an instant on contacts as they stand in `u`.
    pub fn new(
        model: &'a Model,
        pose: Pose,
        costs: &EffectCosts,
        u: &Displacements,
    ) -> Result<LoadCase<'a>, DynamicsError> {
        let problem = pose.problem(model);
        let stiffness = model.hertz[0].stiffness.max(model.hertz[1].stiffness);
        let mut case = LoadCase {
            model,
            pose,
            problem,
            loads: Loads::none(model),
            scales: SearchScales::new(&model.geometry, stiffness),
            newton_iterations: 0,
        };
        case.loads = case.loads_at(costs, u)?;
        case.problem.set_loads(&case.loads);
        Ok(case)
    }

    /// Loads at the contact angles of `u`.
    fn loads_at(&self, costs: &EffectCosts, u: &Displacements) -> Result<Loads, DynamicsError> {
        let angle = |site: &Site| site.contact_angle(&site.state(u));
        let angles: Vec<f64> = self.problem.sites.iter().map(angle).collect();
        let now = Now {
            angles: Some(&angles),
            ..self.pose.now
        };
        let loads = effects::timed_loads(self.model, &now, costs)?;
        let inertia = effects::static_inertia(self.model, &loads)?;
        Ok(self.pose.in_frames(self.model, loads, inertia))
    }

    /// Newton on the problem as it is.
    pub fn minimise(&mut self, start: Displacements) -> Result<Displacements, DynamicsError> {
        let (u, iterations) = minimise(&self.problem, start, self.scales)?;
        self.newton_iterations += iterations;
        Ok(u)
    }

    /// Equilibrium under loads that may follow the contact angles: they become those of the equilibrium. The time of
    /// effects goes to `costs`.
    pub fn settle(
        &mut self,
        costs: &EffectCosts,
        start: Displacements,
    ) -> Result<Displacements, DynamicsError> {
        let mut u = self.minimise(start)?;
        if self.loads.contacts.is_empty() {
            return Ok(u);
        }
        let tolerance = self.model.tolerances.force;
        let (mut history, mut worst) = (Vec::new(), 0);
        for _ in 0..self.model.tolerances.max_rounds {
            let next = self.loads_at(costs, &u)?;
            let largest = largest_force(&site_forces(&self.problem, &u));
            let (change, place) = largest_change(&self.loads.contacts, &next.contacts, largest);
            if change <= tolerance {
                return Ok(u);
            }
            worst = place;
            history.push(change);
            self.loads = next;
            self.problem.set_loads(&self.loads);
            u = self.minimise(u)?;
        }
        Err(not_settled(self.model, tolerance, worst, history))
    }

    /// Forces on the rings: the normal ones and the contact loads, N, by site.
    pub fn ring_forces(&self, normal: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let mut forces = normal.to_vec();
        for (sum, load) in forces.iter_mut().zip(&self.loads.contacts) {
            *sum = [sum[0] + load[0], sum[1] + load[1]];
        }
        forces
    }
}

impl Problem {
    /// Puts loads in the place of those before.
    pub fn set_loads(&mut self, loads: &Loads) {
        self.shaft_load = [0, 1, 2, 3, 4].map(|i| loads.shaft[i] + loads.ring_on_shaft[i]);
        self.ball_load.clone_from(&loads.balls);
        self.contact_load.clone_from(&loads.contacts);
        self.ball_slope = loads.ball_slope;
        for (site, force) in self.sites.iter().zip(&loads.contacts) {
            for i in 0..2 {
                self.ball_load[site.ball][i] -= force[i];
            }
            if site.side == Side::Inner {
                for (load, row) in self.shaft_load.iter_mut().zip(site.shaft_rows()) {
                    *load += row[0] * force[0] + row[1] * force[1];
                }
            }
        }
    }
}

/// Contact places or loads that do not come to rest; `worst` is the site that changes most.
pub fn not_settled(model: &Model, limit: f64, worst: usize, mut history: Vec<f64>) -> DynamicsError {
    let tail = history.len().saturating_sub(6);
    DynamicsError::NotSettled {
        rounds: model.tolerances.max_rounds,
        change: *history.last().unwrap_or(&f64::NAN),
        limit,
        ball: worst / 2,
        side: Side::BOTH[worst % 2].name(),
        history: history.split_off(tail),
    }
}

/// Largest of the forces, N.
pub fn largest_force(forces: &[[f64; 2]]) -> f64 {
    let size = |f: &[f64; 2]| f[0].hypot(f[1]);
    forces.iter().map(size).fold(f64::MIN_POSITIVE, f64::max)
}

/// Largest change over a scale (N), and where.
pub fn largest_change(old: &[[f64; 2]], new: &[[f64; 2]], scale: f64) -> (f64, usize) {
    old.iter()
        .zip(new)
        .enumerate()
        .fold((0.0, 0), |(largest, place), (i, (a, b))| {
            let change = (a[0] - b[0]).hypot(a[1] - b[1]) / scale;
            if change > largest {
                (change, i)
            } else {
                (largest, place)
            }
        })
}
