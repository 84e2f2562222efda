//! Newton on a system, with line search: one algorithm, and a policy for each use.
//!
//! A step in time begins near its solution and may have any tangent: LU, and steps that are halved until the residual
//! shrinks. An equilibrium may begin anywhere: where forces have a convex energy, Cholesky, and a step along which the
//! slope of the energy still falls is progress, whatever opens or closes; the test needs no energy values and so loses
//! no digits near the solution. A small proximal stiffness makes steps of unloaded bodies zero instead of undefined and
//! does not shift the solution. Cost: one dense factorisation per iteration, fewer where a policy keeps factors.

use std::ops::Range;

use dense::DenseError;
use timer::SharedLaps;

use super::assembly::{Evaluated, System};
use super::interaction::LinkForces;
use super::lumped::Interval;
use super::tangent::{TangentFactors, scale_tangent};
use crate::error::DynamicsError;

/// Residual over the force scale that counts as round-off.
const RESIDUAL_TARGET: f64 = 1e-14;
/// Residual over that before it at which the factors of an earlier tangent are good enough for one more step.
const KEPT_SHRINK: f64 = 1e-2;
/// Slope of the energy that ends a line search, relative to its start.
const SLOPE_SHRINK: f64 = 0.5;

/// How residuals are judged by the round-off of positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoundOff {
    /// Of the unknowns on the diagonal of the tangent: decisive for bodies that fly without any force.
    Unknowns,
    /// Of the lengths of all links.
    Links,
}

/// How a step is shortened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shortening {
    /// Along the slope of the energy; without one, by halves of at most 2^-30.
    Energy,
    /// Halved at most so many times until the residual does not grow.
    Residual(u32),
}

/// What a use asks of Newton.
pub struct Policy<'p> {
    /// Iterations before giving up.
    pub most_iterations: usize,
    /// Residual over the force scale at which iteration may stop; it goes on while it improves.
    pub residual_limit: f64,
    /// Least force scale, N.
    pub force_scale: f64,
    /// Floor of the residual.
    pub round_off: RoundOff,
    /// Whether iteration ends where the residual is what round-off makes; else it goes on while it improves.
    pub ends_at_floor: bool,
    /// Whether factors are kept for further iterations while these shrink the residual fast.
    pub keeps_factors: bool,
    /// Unknowns of bodies that see no other block of them: eliminated first. Without an energy only.
    pub blocks: &'p [Range<usize>],
    /// Length per unknown by which it is scaled, so that all are lengths; None: they are taken as they are.
    pub scales: Option<&'p [f64]>,
    /// Stiffness added to the diagonal, N/m.
    pub proximal: f64,
    /// Longest change of a scaled unknown in an iteration.
    pub longest_step: f64,
    /// How a step is shortened.
    pub search: Shortening,
    /// Fails where there is no use in going on.
    pub watch: &'p dyn Fn(&[f64]) -> Result<(), DynamicsError>,
    /// Gets the wall time of effects.
    pub costs: &'p SharedLaps,
}

/// A tangent, as kept for further iterations.
pub struct KeptTangent {
    /// Row-major; scaled once it is factored.
    matrix: Vec<f64>,
    /// Its diagonal, not scaled.
    diagonal: Vec<f64>,
    factors: Option<TangentFactors>,
}

/// A solved system.
pub struct NewtonSolution {
    /// The unknowns.
    pub unknowns: Vec<f64>,
    /// Newton iterations.
    pub iterations: usize,
}

impl System<'_> {
    /// Solves the system from the unknowns `x`. Fails with the residual history and the place of the largest residual.
    pub fn solve(&self, x: Vec<f64>, policy: &Policy) -> Result<NewtonSolution, DynamicsError> {
        self.solve_again(x, policy, &mut None)
    }

    /// The same with the tangent that an earlier solution nearby has left, and leaves its own.
    pub fn solve_again(
        &self,
        mut x: Vec<f64>,
        policy: &Policy,
        kept: &mut Option<KeptTangent>,
    ) -> Result<NewtonSolution, DynamicsError> {
        let done = |unknowns, iterations| Ok(NewtonSolution { unknowns, iterations });
        let (mut history, mut best, mut stalled) = (Vec::new(), f64::INFINITY, 0);
        let mut at = self.evaluate(&x, policy.costs);
        let (mut worst, mut limit, mut bodies) = (0, 0.0, Vec::new());
        for iteration in 0..policy.most_iterations {
            let now;
            (worst, now) = largest(&policy.scaled(&at.residual));
            if !now.is_finite() {
                let what = "a contact force";
                return Err(DynamicsError::NotFinite { what });
            }
            let is_fast = history.last().is_none_or(|last| now <= KEPT_SHRINK * last);
            history.push(now);
            stalled = if now < 0.5 * best { 0 } else { stalled + 1 };
            best = best.min(now);
            let scale = force_scale(&at.links, policy.force_scale);
            limit = policy.residual_limit * scale;
            if now <= RESIDUAL_TARGET * scale {
                return done(x, iteration);
            }
            let mut tangent = match kept.take() {
                Some(earlier) if policy.keeps_factors && is_fast => earlier,
                _ => self.tangent(&x, &at, &mut bodies),
            };
            let floor = || match policy.round_off {
                RoundOff::Unknowns => round_off(&tangent.diagonal, &x),
                RoundOff::Links => self.round_off(&x),
            };
            // Where increments are small beside places, these have their own round-off.
            let places = || policy.ends_at_floor && now <= self.round_off(&x);
            let is_at_floor = policy.ends_at_floor && now <= floor() || now <= limit && places();
            let is_floor = || now <= limit.max(floor()) || places();
            if stalled >= 2 && is_floor() {
                *kept = Some(tangent);
                return done(x, iteration);
            }
            let factors = match tangent.factors.take() {
                Some(factors) => factors,
                None => self.factors(&x, &at, &mut tangent.matrix, policy)?,
            };
            let step = self.direction(&factors, &at.residual, policy);
            tangent.factors = Some(factors);
            *kept = Some(tangent);
            if is_at_floor {
                // Light bodies beside heavy ones gain by the last step; its residual is round-off of the heavy ones.
                x.iter_mut().zip(&step).for_each(|(x, s)| *x += s);
                return done(x, iteration + 1);
            }
            (x, at) = self.search(x, at, &step, policy);
            (policy.watch)(&x)?;
        }
        Err(self.stalled(policy, history, (worst, limit)))
    }

    fn stalled(&self, policy: &Policy, mut history: Vec<f64>, (worst, limit): (usize, f64)) -> DynamicsError {
        DynamicsError::NewtonStalled {
            iterations: policy.most_iterations,
            residual: *history.last().unwrap_or(&f64::NAN),
            place: self.name(worst),
            limit,
            history: history.split_off(history.len().saturating_sub(8)),
        }
    }

    /// The tangent at a point; `bodies` is the part that hardly changes over a step, made when first asked for.
    fn tangent(&self, x: &[f64], at: &Evaluated, bodies: &mut Vec<f64>) -> KeptTangent {
        if bodies.is_empty() {
            *bodies = self.body_tangent(x);
            if self.has_curvature() && self.interval() != Interval::Rest {
                self.add_curvatures(x, &at.links, bodies);
            }
        }
        let mut matrix = bodies.clone();
        self.add_link_tangents(x, &at.links, &mut matrix);
        KeptTangent {
            diagonal: matrix.iter().step_by(x.len() + 1).copied().collect(),
            matrix,
            factors: None,
        }
    }

    /// Factors of the tangent, which is scaled. Where curvatures of finite motions make an energy's tangent indefinite,
    /// they are left out: the step still goes downhill.
    fn factors(
        &self,
        x: &[f64],
        at: &Evaluated,
        tangent: &mut [f64],
        policy: &Policy,
    ) -> Result<TangentFactors, DynamicsError> {
        self.check_held(tangent, &at.residual, policy)?;
        let is_rest = self.interval() == Interval::Rest;
        let curved = (is_rest && self.has_curvature()).then(|| {
            let mut curved = tangent.to_vec();
            self.add_curvatures(x, &at.links, &mut curved);
            self.factors_of(&mut curved, policy)
        });
        let factors = match curved {
            Some(Ok(factors)) => Ok(factors),
            _ => self.factors_of(tangent, policy),
        };
        factors.map_err(|source| DynamicsError::ContactSystem { source })
    }

    fn factors_of(&self, tangent: &mut [f64], policy: &Policy) -> Result<TangentFactors, DenseError> {
        policy.scale(self.n(), tangent);
        TangentFactors::new(self.n(), tangent, self.has_energy(), policy.blocks)
    }

    /// Newton's step from a residual, at most as long as the policy allows.
    fn direction(&self, factors: &TangentFactors, residual: &[f64], policy: &Policy) -> Vec<f64> {
        let mut step: Vec<f64> = policy.scaled(residual).iter().map(|r| -r).collect();
        factors.solve(&mut step);
        let length = step.iter().fold(0.0, |most: f64, s| most.max(s.abs()));
        if length > policy.longest_step {
            step.iter_mut().for_each(|s| *s *= policy.longest_step / length);
        }
        policy.scaled(&step)
    }

    /// Fails when an unknown has neither inertia nor stiffness: its row of the tangent is empty. Names the one that the
    /// loads push most.
    fn check_held(&self, tangent: &[f64], residual: &[f64], policy: &Policy) -> Result<(), DynamicsError> {
        if policy.proximal > 0.0 {
            return Ok(());
        }
        let rows = tangent.chunks_exact(self.n()).zip(residual).enumerate();
        let adrift = rows.filter(|(_, (row, _))| row.iter().all(|x| *x == 0.0));
        match adrift.max_by(|a, b| a.1.1.abs().total_cmp(&b.1.1.abs())) {
            Some((unknown, _)) => Err(DynamicsError::Adrift {
                dof: self.name(unknown),
                remedy: self.remedy(unknown),
            }),
            None => Ok(()),
        }
    }

    /// The unknowns after a step that may have been shortened, and the system there.
    fn search(&self, x: Vec<f64>, at: Evaluated, step: &[f64], policy: &Policy) -> (Vec<f64>, Evaluated) {
        let trial = |share: f64| {
            let trial: Vec<f64> = x.iter().zip(step).map(|(x, s)| x + share * s).collect();
            let at = self.evaluate(&trial, policy.costs);
            (trial, at)
        };
        match policy.search {
            Shortening::Residual(halvings) => halve(&at, policy, halvings, 0.0, trial),
            Shortening::Energy if !self.has_energy() => halve(&at, policy, 30, 0.1, trial),
            Shortening::Energy => along_energy(&at.residual, step, trial).unwrap_or((x, at)),
        }
    }
}

impl Policy<'_> {
    /// Forces on scaled unknowns, or unknowns of scaled ones.
    fn scaled(&self, values: &[f64]) -> Vec<f64> {
        match self.scales {
            Some(scales) => values.iter().zip(scales).map(|(v, s)| v * s).collect(),
            None => values.to_vec(),
        }
    }

    /// Makes a tangent that of scaled unknowns, with the proximal stiffness.
    fn scale(&self, n: usize, tangent: &mut [f64]) {
        scale_tangent(n, self.scales.unwrap_or_default(), tangent);
        tangent
            .iter_mut()
            .step_by(n + 1)
            .for_each(|diagonal| *diagonal += self.proximal);
    }
}

/// Halves the step until the residual has shrunk by the share `decrease` of the step, at most `halvings` times.
fn halve(
    at: &Evaluated,
    policy: &Policy,
    halvings: u32,
    decrease: f64,
    trial: impl Fn(f64) -> (Vec<f64>, Evaluated),
) -> (Vec<f64>, Evaluated) {
    let size = |r: &[f64]| policy.scaled(r).iter().map(|v| v * v).sum::<f64>();
    let before = size(&at.residual);
    let mut share = 1.0;
    for _ in 0..halvings {
        let found = trial(share);
        if size(&found.1.residual) <= (1.0 - decrease * share) * before {
            return found;
        }
        share *= 0.5;
    }
    trial(share)
}

/// Longest step of at most 1 along which the slope of the convex energy is still falling or has shrunk enough; None
/// where no step can be told from none.
fn along_energy(
    residual: &[f64],
    step: &[f64],
    trial: impl Fn(f64) -> (Vec<f64>, Evaluated),
) -> Option<(Vec<f64>, Evaluated)> {
    let slope_at = |gradient: &[f64]| gradient.iter().zip(step).map(|(g, p)| g * p).sum::<f64>();
    let start = slope_at(residual);
    let mut share = 1.0;
    // 60 reductions reach below the resolution of any step.
    for _ in 0..60 {
        let found = trial(share);
        let slope = slope_at(&found.1.residual);
        if slope <= SLOPE_SHRINK * start.abs() {
            return Some(found);
        }
        // The slope has passed zero: secant to its root, kept away from both ends.
        share *= (start / (start - slope)).clamp(0.1, 0.9);
    }
    None
}

/// Largest force of a link, at least `least`, N.
fn force_scale(links: &[LinkForces], least: f64) -> f64 {
    let forces = links.iter().flat_map(|family| &family.forces);
    forces.fold(least, |most, force| most.max(force.abs()))
}

/// Residual that round-off of the unknowns alone can make.
fn round_off(diagonal: &[f64], x: &[f64]) -> f64 {
    let terms = diagonal.iter().zip(x).map(|(slope, x)| (slope * x).abs());
    16.0 * f64::EPSILON * terms.fold(0.0, f64::max)
}

/// Place and size of the largest entry; NaN wins.
fn largest(r: &[f64]) -> (usize, f64) {
    r.iter().enumerate().fold((0, 0.0), |(place, most), (i, v)| {
        match v.is_nan() || v.abs() > most {
            true => (i, v.abs()),
            false => (place, most),
        }
    })
}
