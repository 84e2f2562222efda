//! Equilibrium of the shaft on what holds it: Newton with a search along the slope of the energy.
//!
//! The energy of the shaft is a quadratic form and that of a bearing convex, but for loads that grow with the radius of
//! a ball. Its slope along a step is the residual times the step, and the reactions of the bearings give it exactly. A
//! full step is taken where the slope has fallen; else the point between where it vanishes, by regula falsi.
//!
//! A bearing whose balls all hang loose has no stiffness. A trace of stiffness on the diagonal, a billionth of a
//! contact's, then makes a step that is cut to a fraction of a groove: any start is safe, and a row that lifts off is
//! one of the ordinary cases.

use comm::Communicator;
use dense::DenseLu;
use dynamics::bodies::{AXES, TiltedLoads};
use dynamics::model::MAX_TILT;
use dynamics::stiffness::N_SHAFT;
use dynamics::system::Interval;

use crate::error::AssemblyError;
use crate::loads::{ShaftLoads, first_dofs};
use crate::place::Seating;
use crate::shaft::{ShaftBody, Station, times};
use crate::support::{SupportAnswer, Supports};

/// Iterations before giving up.
const MOST_ITERATIONS: usize = 200;
/// Points along a step before giving up.
const MOST_POINTS: usize = 40;
/// A step is taken when its slope has fallen to this share.
const ENOUGH: f64 = 0.5;
/// Trace of stiffness on the diagonal over that of a contact.
const PROXIMAL: f64 = 1e-9;
/// Residual over the largest force at which a search that no longer falls has arrived: what rounds of the rings leave.
const FLOOR: f64 = 1e-7;
/// A residual that has not halved in so many iterations no longer falls.
const PATIENCE: usize = 3;
/// Pivot of the rigid motions over the stiffness of a contact below which nothing holds them.
const UNHELD: f64 = 1e-6;

/// A place of the shaft that is held.
#[derive(Clone, Debug)]
pub struct Mount {
    /// Name for messages.
    pub name: String,
    /// Where and which way round.
    pub place: Seating,
    /// The place on the shaft.
    pub station: Station,
}

impl Mount {
    /// The place, with a load on what holds it there, in the frame of the shaft.
    pub fn loaded(&self, by_holder: [f64; N_SHAFT]) -> (Station, [f64; N_SHAFT]) {
        (self.station, self.place.orientation.turned(by_holder))
    }
}

/// Sizes of a search.
#[derive(Clone, Copy, Debug)]
pub struct Scales {
    /// Longest step, m.
    pub step: f64,
    /// Stiffness of a typical contact, N/m.
    pub stiffness: f64,
    /// Length by which tilts count, m.
    pub tilt_arm: f64,
    /// Residual over the largest force at which the search ends.
    pub tolerance: f64,
}

/// What is balanced.
pub struct Problem<'a> {
    /// The shaft.
    pub shaft: &'a ShaftBody,
    /// Loads on it.
    pub load: &'a ShaftLoads,
    /// Where it is held.
    pub mounts: &'a [Mount],
    /// Sizes.
    pub scales: Scales,
}

/// An equilibrium.
#[derive(Clone, Debug)]
pub struct SettledShaft {
    /// Displacements of the shaft's dofs.
    pub displacements: Vec<f64>,
    /// What holds it, in the frames of the holders.
    pub answers: Vec<SupportAnswer>,
    /// Out-of-balance loads on free dofs; on held ones minus the load that holds them.
    pub residual: Vec<f64>,
    /// Largest residual of a free dof over the largest force.
    pub error: f64,
    /// Iterations.
    pub iterations: usize,
}

/// The equations at a point.
struct Iterate {
    q: Vec<f64>,
    answers: Vec<SupportAnswer>,
    residual: Vec<f64>,
    /// Levers of all forces on a rigid shaft.
    levers: Option<TiltedLoads>,
    error: f64,
    limit: f64,
}

/// Balances the shaft from given displacements; held dofs take their values.
pub fn settle(
    problem: &Problem,
    supports: &mut dyn Supports,
    start: &[f64],
) -> Result<SettledShaft, AssemblyError> {
    let held = &problem.shaft.held;
    let q = start
        .iter()
        .zip(held)
        .map(|(q, held)| held.unwrap_or(*q))
        .collect();
    let mut at = problem.evaluate(supports, q)?;
    let mut history: Vec<f64> = vec![at.error];
    let mut iterations = 0;
    let has_free = held.iter().any(Option::is_none);
    while has_free && !is_settled(&at, &history) {
        if iterations == MOST_ITERATIONS {
            let tail = history.len().saturating_sub(6);
            return Err(AssemblyError::NotSettled {
                iterations,
                residual: at.error,
                limit: at.limit,
                history: history.split_off(tail),
            });
        }
        let step = problem.step(&at)?;
        at = problem.search(supports, at, &step)?;
        history.push(at.error);
        iterations += 1;
    }
    problem.check_held(&at)?;
    Ok(SettledShaft {
        displacements: at.q,
        answers: at.answers,
        residual: at.residual,
        error: at.error,
        iterations,
    })
}

fn is_settled(at: &Iterate, history: &[f64]) -> bool {
    if at.error <= at.limit {
        return true;
    }
    let before = history.len().checked_sub(PATIENCE + 1);
    let stalls = before.is_some_and(|i| at.error > 0.5 * history[i]);
    stalls && at.error <= FLOOR
}

impl Problem<'_> {
    /// Length by which a dof counts.
    fn length(&self, dof: usize) -> f64 {
        if dof % N_SHAFT < 3 {
            1.0
        } else {
            1.0 / self.scales.tilt_arm
        }
    }

    fn evaluate(&self, supports: &mut dyn Supports, q: Vec<f64>) -> Result<Iterate, AssemblyError> {
        let n = self.shaft.n();
        let elastic = times(n, &self.shaft.stiffness, &q);
        let load = &self.load.on_dofs;
        let mut residual: Vec<f64> = load.iter().zip(&elastic).map(|(f, k)| f - k).collect();
        let mut largest = (0..n).fold(f64::MIN_POSITIVE, |m, i| m.max(load[i].abs() * self.length(i)));
        let mut asked = Vec::with_capacity(self.mounts.len());
        for (number, mount) in self.mounts.iter().enumerate() {
            let own = mount.place.into_bearing(mount.station.displacement(&q));
            check_range(mount, supports.range(number), own)?;
            asked.push((mount.name.as_str(), own));
        }
        let answers = supports.answers(&asked)?;
        let pairs = self.mounts.iter().zip(&answers);
        let held: Vec<_> = pairs.map(|(mount, answer)| mount.loaded(answer.load)).collect();
        for ((station, load), answer) in held.iter().zip(&answers) {
            station.add_load(load.map(|f| -f), &mut residual);
            largest = largest.max(answer.force);
            for (i, f) in load.iter().enumerate() {
                largest = largest.max(f.abs() * self.length(i));
            }
        }
        let levers = self.load.beyond_straight(self.shaft, held.into_iter());
        if let Some(levers) = &levers {
            let more = levers.over(Interval::Rest, [first_dofs(&q); 2]);
            residual.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
        }
        let free = (0..n).filter(|&i| self.shaft.held[i].is_none());
        let error = free.fold(0.0f64, |m, i| m.max(residual[i].abs() * self.length(i))) / largest;
        let round_off = 16.0 * f64::EPSILON * self.cancelled(&q) / largest;
        Ok(Iterate {
            q,
            answers,
            residual,
            levers,
            error,
            limit: self.scales.tolerance.max(round_off),
        })
    }

    /// Forces of which the elastic forces of the shaft are the small sum, N.
    fn cancelled(&self, q: &[f64]) -> f64 {
        let n = q.len();
        let row = |i: usize| -> f64 {
            let row = &self.shaft.stiffness[n * i..n * (i + 1)];
            self.length(i) * row.iter().zip(q).map(|(k, x)| (k * x).abs()).sum::<f64>()
        };
        (0..n).map(row).fold(0.0, f64::max)
    }

    /// Tangent over all dofs, row-major.
    fn tangent(&self, at: &Iterate) -> Vec<f64> {
        let n = self.shaft.n();
        let mut tangent = self.shaft.stiffness.clone();
        for (mount, answer) in self.mounts.iter().zip(&at.answers) {
            let turned = mount.place.orientation.turned_matrix(&answer.stiffness);
            mount.station.at(&at.q).add_matrix(&turned, n, &mut tangent);
        }
        if let Some(levers) = &at.levers {
            Station::on_rigid_shaft(0.0).add_matrix(&levers.stiffness(first_dofs(&at.q)), n, &mut tangent);
        }
        tangent
    }

    /// Newton's step, cut to the longest one.
    fn step(&self, at: &Iterate) -> Result<Vec<f64>, AssemblyError> {
        let n = self.shaft.n();
        let free: Vec<usize> = (0..n).filter(|&i| self.shaft.held[i].is_none()).collect();
        let tangent = self.tangent(at);
        let m = free.len();
        let mut matrix = Vec::with_capacity(m * m);
        for &i in &free {
            let row = free
                .iter()
                .map(|&j| tangent[n * i + j] * self.length(i) * self.length(j));
            matrix.extend(row);
        }
        (0..m).for_each(|i| matrix[(m + 1) * i] += PROXIMAL * self.scales.stiffness);
        let mut scaled: Vec<f64> = free.iter().map(|&i| at.residual[i] * self.length(i)).collect();
        DenseLu::factor(m, &matrix)
            .map_err(|source| AssemblyError::Matrix { source })?
            .solve(&mut scaled, 1);
        let longest = scaled.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        let cut = (self.scales.step / longest.max(f64::MIN_POSITIVE)).min(1.0);
        let mut step = vec![0.0; n];
        for (&i, x) in free.iter().zip(&scaled) {
            step[i] = cut * x * self.length(i);
        }
        Ok(step)
    }

    /// The point along a step to go on from.
    fn search(
        &self,
        supports: &mut dyn Supports,
        from: Iterate,
        step: &[f64],
    ) -> Result<Iterate, AssemblyError> {
        let slope = |at: &Iterate| -> f64 { -at.residual.iter().zip(step).map(|(r, p)| r * p).sum::<f64>() };
        let first = slope(&from);
        let (mut low, mut high) = ((0.0, first), None);
        let mut share = 1.0;
        for _ in 0..MOST_POINTS {
            let q = from.q.iter().zip(step).map(|(q, p)| q + share * p).collect();
            let next = match self.evaluate(supports, q) {
                Ok(next) => next,
                // Too far for a bearing: nearer. At the whole step with nothing left to cut it is what is wrong.
                // Ranks that share rings go nearer together or not at all.
                Err(error) if share < 1e-3 || !Communicator::world().all_failed() => return Err(error),
                Err(_) => {
                    share = 0.5 * (low.0 + share);
                    continue;
                }
            };
            let now = slope(&next);
            if next.error < 0.5 * from.error || now.abs() <= ENOUGH * first.abs() || first >= 0.0 {
                return Ok(next);
            }
            if now < 0.0 {
                low = (share, now);
                // The slope hardly changes: the whole step is short, and the next one starts there.
                if share == 1.0 {
                    return Ok(next);
                }
            } else {
                high = Some((share, now));
            }
            let Some((end, of_end)) = high else {
                return Ok(next);
            };
            let zero = low.0 - low.1 * (end - low.0) / (of_end - low.1);
            let margin = 0.1 * (end - low.0);
            share = zero.clamp(low.0 + margin, end - margin);
        }
        let q = from.q.iter().zip(step).map(|(q, p)| q + share * p).collect();
        self.evaluate(supports, q)
    }

    /// Fails where nothing holds a rigid motion of the shaft.
    fn check_held(&self, at: &Iterate) -> Result<(), AssemblyError> {
        let mut stiffness = vec![0.0; N_SHAFT * N_SHAFT];
        for (mount, answer) in self.mounts.iter().zip(&at.answers) {
            let turned = mount.place.orientation.turned_matrix(&answer.stiffness);
            let station = Station::on_rigid_shaft(mount.place.position);
            station.add_matrix(&turned, N_SHAFT, &mut stiffness);
        }
        let free: Vec<usize> = match self.shaft.is_beam() {
            true => (0..N_SHAFT).collect(),
            false => (0..N_SHAFT).filter(|&i| self.shaft.held[i].is_none()).collect(),
        };
        self.require_pivots(&stiffness, &free)
    }

    fn require_pivots(&self, stiffness: &[f64], free: &[usize]) -> Result<(), AssemblyError> {
        let m = free.len();
        let entry = |i: usize, j: usize| {
            stiffness[N_SHAFT * free[i] + free[j]] * self.length(free[i]) * self.length(free[j])
        };
        let mut left: Vec<f64> = (0..m * m).map(|k| entry(k / m, k % m)).collect();
        for i in 0..m {
            let pivot = left[m * i + i];
            if pivot < UNHELD * self.scales.stiffness {
                return Err(AssemblyError::Unheld {
                    dof: AXES[free[i]],
                    stiffness: (pivot / self.scales.stiffness).max(0.0),
                });
            }
            for j in i + 1..m {
                let share = left[m * j + i] / pivot;
                (i..m).for_each(|k| left[m * j + k] -= share * left[m * i + k]);
            }
        }
        Ok(())
    }
}

fn check_range(mount: &Mount, range: Option<f64>, displacement: [f64; N_SHAFT]) -> Result<(), AssemblyError> {
    let Some(range) = range else { return Ok(()) };
    for (i, q) in displacement.into_iter().enumerate() {
        let (most, limit) = match i {
            0..3 => (range, format!("{:.3} mm", 1e3 * range)),
            _ => (MAX_TILT, format!("{MAX_TILT} rad, where small rotations end")),
        };
        if q.abs() > most {
            return Err(AssemblyError::NoEquilibrium {
                name: mount.name.clone(),
                dof: AXES[i],
                limit,
            });
        }
    }
    Ok(())
}
