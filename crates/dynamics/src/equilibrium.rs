//! Minimum of the contact problem's energy by Newton with line search.
//!
//! The energy is convex, so a step along which the slope of the energy shrinks is progress, whatever opens or closes;
//! the test needs no energy values and so loses no digits near the solution. A small proximal stiffness makes
//! steps of unloaded balls zero instead of undefined; it does not shift the solution. Steps are capped, which
//! makes any start safe: no load, huge load, unloaded balls. Cost: one dense factorisation of 2 n_balls (1 + rings) +
//! 5 unknowns per iteration.

use contact::{BearingGeometry, Side};
use dense::{DenseCholesky, DenseError, DenseLu};

use crate::error::DynamicsError;
use crate::footprint::loaded;
use crate::problem::{Displacements, Problem, SHAFT_DOFS, Site, site_forces};

/// Largest residual over the force scale at which Newton may stop; it goes on to round-off while it improves.
const RESIDUAL_LIMIT: f64 = 1e-10;
/// Residual over the force scale below which further improvement is round-off.
const RESIDUAL_TARGET: f64 = 1e-14;
/// Newton iterations before giving up. Preloaded bearings need 6 to 40. Loose ones need up to some hundred: a ball that
/// comes off leaves its last raceway by a factor 3 in approach per iteration, and every ball that is met on the way
/// takes its turn.
const MAX_ITERATIONS: usize = 2000;
/// Proximal stiffness over the contact stiffness scale.
const PROXIMAL: f64 = 1e-9;
/// Slope of the energy that ends a line search, relative to its start.
const SLOPE_SHRINK: f64 = 0.5;
/// Largest tilt for which small rotations hold, rad (about 3 deg).
pub const MAX_TILT: f64 = 0.05;

/// Limits and scales of the search.
#[derive(Clone, Copy, Debug)]
pub struct SearchScales {
    /// Largest change of a displacement in one iteration, m.
    pub step: f64,
    /// Shaft displacement beyond which there is no equilibrium, m.
    pub range: f64,
    /// Stiffness of a typical contact, N/m.
    pub stiffness: f64,
}

impl SearchScales {
    /// Scales of a bearing with contact stiffness K (N/m^1.5): a contact pressed by a hundredth of the groove
    /// distance is typical, a quarter of it a long step.
    pub fn new(geometry: &BearingGeometry, hertz_stiffness: f64) -> SearchScales {
        let distance = geometry.groove_distance();
        SearchScales {
            step: 0.25 * distance,
            range: 0.5 * geometry.ball_diameter,
            stiffness: 1.5 * hertz_stiffness * (0.01 * distance).sqrt(),
        }
    }
}

/// Displacements of the minimum, from any start, and the iterations it took.
pub fn minimise(
    problem: &Problem,
    start: Displacements,
    scales: SearchScales,
) -> Result<(Displacements, usize), DynamicsError> {
    let mut u = start;
    let mut gradient = problem.gradient(&u);
    let mut history: Vec<f64> = Vec::new();
    let mut best = f64::INFINITY;
    let mut stalled = 0;
    for iteration in 0..MAX_ITERATIONS {
        let residual = largest(&gradient);
        if !residual.is_finite() {
            return Err(DynamicsError::NotFinite {
                what: "a contact force",
            });
        }
        let scale = force_scale(problem, &u);
        stalled = if residual < 0.5 * best { 0 } else { stalled + 1 };
        best = best.min(residual);
        history.push(residual);
        let good = residual <= (RESIDUAL_LIMIT * scale).max(round_off(problem, &u));
        if residual <= RESIDUAL_TARGET * scale || (good && stalled >= 2) {
            return Ok((u, iteration));
        }
        let direction = direction(problem, &u, &gradient, scales)?;
        (u, gradient) = line_search(problem, &u, &gradient, &direction);
        check_range(&u, scales)?;
    }
    let (worst, residual) =
        gradient.iter().enumerate().fold(
            (0, 0.0),
            |(w, r), (i, g)| {
                if g.abs() > r { (i, g.abs()) } else { (w, r) }
            },
        );
    let tail = history.len().saturating_sub(8);
    Err(DynamicsError::NewtonStalled {
        iterations: MAX_ITERATIONS,
        residual,
        place: problem.name(worst),
        limit: RESIDUAL_LIMIT * force_scale(problem, &u),
        history: history.split_off(tail),
    })
}

/// Newton direction, capped.
fn direction(
    problem: &Problem,
    u: &Displacements,
    gradient: &[f64],
    scales: SearchScales,
) -> Result<Vec<f64>, DynamicsError> {
    let n = problem.n();
    let mut hessian = problem.hessian(u);
    for i in 0..n {
        hessian[n * i + i] += proximal(problem, scales);
    }
    let mut direction: Vec<f64> = gradient.iter().map(|g| -g).collect();
    if problem.is_conservative() {
        DenseCholesky::factor(n, &hessian)
            .map_err(dense_error)?
            .solve(&mut direction, 1);
    } else {
        DenseLu::factor(n, &hessian)
            .map_err(dense_error)?
            .solve(&mut direction, 1);
    }
    let length = largest(&direction);
    if length > scales.step {
        direction.iter_mut().for_each(|x| *x *= scales.step / length);
    }
    Ok(direction)
}

/// Longest step of at most 1 along which the slope of the convex energy is still falling or has shrunk enough.
fn line_search(
    problem: &Problem,
    u: &Displacements,
    gradient: &[f64],
    direction: &[f64],
) -> (Displacements, Vec<f64>) {
    if !problem.is_conservative() {
        return backtrack(problem, u, gradient, direction);
    }
    let slope_at = |g: &[f64]| g.iter().zip(direction).map(|(g, p)| g * p).sum::<f64>();
    let start = slope_at(gradient);
    let mut step = 1.0;
    // 60 reductions reach below the resolution of any step.
    for _ in 0..60 {
        let trial = problem.moved(u, direction, step);
        let trial_gradient = problem.gradient(&trial);
        let slope = slope_at(&trial_gradient);
        if slope <= SLOPE_SHRINK * start.abs() {
            return (trial, trial_gradient);
        }
        // The slope has passed zero: secant to its root, kept away from both ends.
        step *= (start / (start - slope)).clamp(0.1, 0.9);
    }
    (u.clone(), gradient.to_vec())
}

/// Halves the step until the residual shrinks: the search without an energy.
fn backtrack(
    problem: &Problem,
    u: &Displacements,
    gradient: &[f64],
    direction: &[f64],
) -> (Displacements, Vec<f64>) {
    let size = |g: &[f64]| g.iter().map(|x| x * x).sum::<f64>();
    let mut step = 1.0;
    // 30 halvings reach below what a smooth residual can need; then the last step is tried as it is.
    for _ in 0..30 {
        let trial = problem.moved(u, direction, step);
        let trial_gradient = problem.gradient(&trial);
        if size(&trial_gradient) < (1.0 - 0.1 * step) * size(gradient) {
            return (trial, trial_gradient);
        }
        step *= 0.5;
    }
    let trial = problem.moved(u, direction, step);
    let trial_gradient = problem.gradient(&trial);
    (trial, trial_gradient)
}

/// Force, N, that the round-off of positions makes in all contacts together: what a light load can be balanced to.
pub fn round_off(problem: &Problem, u: &Displacements) -> f64 {
    let of_site = |site: &Site| {
        let state = site.state(u);
        // The vector between the centres is a sum of terms of the size of these two.
        let place = 2.0 * f64::EPSILON * (state.length + site.reach[0].hypot(site.reach[1]));
        // A contact that has no stiffness yet has the force of an approach that cannot be told from zero.
        (place * state.force.tangent).max(site.law.evaluate(place).force)
    };
    problem.sites.iter().map(of_site).sum()
}

/// Largest force in the problem, N.
fn force_scale(problem: &Problem, u: &Displacements) -> f64 {
    let contacts = problem.sites.iter().map(|s| s.state(u).force.force);
    let loads = problem
        .ball_load
        .iter()
        .flatten()
        .chain(&problem.shaft_load[..3])
        .map(|f| f.abs());
    let moments = problem.shaft_load[3..].iter().map(|m| m.abs() / problem.tilt_arm);
    contacts
        .chain(loads)
        .chain(moments)
        .fold(0.0, f64::max)
        .max(f64::MIN_POSITIVE)
}

fn check_range(u: &Displacements, scales: SearchScales) -> Result<(), DynamicsError> {
    for (i, q) in u.shaft.iter().enumerate() {
        let (limit, text) = match i {
            0..3 => (scales.range, format!("{:.3} mm", 1e3 * scales.range)),
            _ => (MAX_TILT, format!("{MAX_TILT} rad, where small rotations end")),
        };
        if q.abs() > limit {
            return Err(DynamicsError::NoEquilibrium {
                dof: SHAFT_DOFS[i],
                limit: text,
            });
        }
    }
    Ok(())
}

/// Fails when a free shaft dof has no stiffness at the solution `u`.
pub fn check_held(problem: &Problem, u: &Displacements, scales: SearchScales) -> Result<(), DynamicsError> {
    let free: Vec<usize> = (0..5).filter(|&i| problem.shaft_free[i]).collect();
    let (n, m) = (problem.n(), free.len());
    let mut hessian = problem.hessian(u);
    for i in m..n {
        hessian[n * i + i] += proximal(problem, scales);
    }
    // Condense everything but the shaft: stiffness of the shaft on its balls and rings.
    let rest = n - m;
    let block: Vec<f64> = (m..n)
        .flat_map(|i| hessian[n * i + m..n * (i + 1)].to_vec())
        .collect();
    let factor = DenseLu::factor(rest, &block).map_err(dense_error)?;
    let mut columns: Vec<f64> = (0..m)
        .flat_map(|j| (m..n).map(|i| hessian[n * i + j]).collect::<Vec<_>>())
        .collect();
    factor.solve(&mut columns, m);
    let mut stiffness = vec![0.0; m * m];
    for i in 0..m {
        for j in 0..m {
            let taken: f64 = (0..rest)
                .map(|k| hessian[n * i + m + k] * columns[rest * j + k])
                .sum();
            stiffness[m * i + j] = hessian[n * i + j] - taken;
        }
    }
    let scale = scales.stiffness;
    for i in 0..m {
        // A dof counts as unheld when its pivot, after elimination of those before it, vanishes.
        let pivot = stiffness[m * i + i];
        if pivot < 1e3 * PROXIMAL * scale {
            return Err(DynamicsError::Unheld {
                dof: SHAFT_DOFS[free[i]],
                stiffness: (pivot / scale).max(0.0),
            });
        }
        for j in i + 1..m {
            let share = stiffness[m * j + i] / pivot;
            (i..m).for_each(|k| stiffness[m * j + k] -= share * stiffness[m * i + k]);
        }
    }
    Ok(())
}

/// Proximal stiffness, N/m: a trace of the contacts' and more than what a growing ball load takes away.
fn proximal(problem: &Problem, scales: SearchScales) -> f64 {
    let slope = problem
        .ball_slopes
        .iter()
        .fold(0.0, |largest, s| f64::max(largest, *s));
    PROXIMAL * scales.stiffness + 2.0 * slope
}

fn dense_error(source: DenseError) -> DynamicsError {
    DynamicsError::ContactSystem { source }
}

fn largest(v: &[f64]) -> f64 {
    // NaN must not be lost in a maximum.
    v.iter()
        .fold(0.0, |m, x| if x.abs() > m || x.is_nan() { x.abs() } else { m })
}

/// Unloaded balls rest midway between their raceways: those without a load of their own that are not squeezed between
/// both. A ball that Newton left touching a raceway, with a force below its residual, is unloaded.
pub fn centre_unloaded(problem: &Problem, u: &mut Displacements) {
    let size = |load: &[f64; 2]| load[0].hypot(load[1]);
    // The weight of a ball across its meridian plane leaves round-off in that plane.
    let heaviest = problem.ball_load.iter().map(size).fold(0.0, f64::max);
    let weightless = 4.0 * f64::EPSILON * heaviest;
    let loaded = loaded(&site_forces(problem, u));
    for (pair, loaded) in problem.sites.chunks_exact(2).zip(loaded.chunks_exact(2)) {
        let (inner, outer) = (pair[0].state(u), pair[1].state(u));
        let ball = pair[0].ball;
        if loaded == [true, true] || size(&problem.ball_load[ball]) > weightless {
            continue;
        }
        debug_assert!(pair[0].side == Side::Inner && pair[1].side == Side::Outer);
        let from = |s: &crate::problem::SiteState| [s.normal[0] * s.length, s.normal[1] * s.length];
        let (to_ball_inner, to_ball_outer) = (from(&inner), from(&outer));
        // Groove centres seen from the ball, then the point of equal gap on their line.
        let centre_inner = [-to_ball_inner[0], -to_ball_inner[1]];
        let centre_outer = [-to_ball_outer[0], -to_ball_outer[1]];
        let shift = contact::geometry::midway(centre_inner, centre_outer, pair[0].touching, pair[1].touching);
        u.balls[ball][0] += shift[0];
        u.balls[ball][1] += shift[1];
    }
}
