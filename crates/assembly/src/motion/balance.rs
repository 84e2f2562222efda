//! Newton on the shaft over a part of a step.

use comm::Communicator;
use dynamics::motion::held::{HeldAnswer, HeldPart, Holding};

use super::bodies::SharedLoads;
use super::factors::KeptFactors;
use super::step::ShaftStep;
use crate::error::AssemblyError;
use crate::loads::first_dofs;
use crate::newton::Mount;
use crate::shaft::times;
use crate::side_by_side::of_each;

/// Iterations before a part counts as failed.
const MOST_ITERATIONS: usize = 40;
/// Residual over the largest force at which iteration may stop; it goes on while it improves.
const LIMIT: f64 = 1e-10;
/// Residual over the largest force that counts as round-off.
const TARGET: f64 = 1e-12;
/// Residual over that before it at which factors are good enough for another step.
const ENOUGH: f64 = 0.05;
/// Halvings of a step of Newton.
const HALVINGS: u32 = 10;

/// The equations at an end.
struct ShaftBalance {
    end: Vec<f64>,
    residual: Vec<f64>,
    /// Largest residual as a force, N.
    error: f64,
    /// Largest force, N.
    scale: f64,
    answers: Vec<HeldAnswer>,
}

impl ShaftStep<'_> {
    /// The end at which the shaft is in balance with the bearings, and their answers, each in its own frame.
    pub fn balance(
        &self,
        parts: &mut [HeldPart<'_>],
        from: Vec<f64>,
        kept: &mut KeptFactors,
        bodies: &mut SharedLoads<'_>,
    ) -> Result<(Vec<f64>, Vec<HeldAnswer>), AssemblyError> {
        let mut at = self.evaluate(parts, from)?;
        let (mut best, mut stalled, mut last) = (f64::INFINITY, 0, f64::INFINITY);
        let mut history = Vec::new();
        let mut is_balanced = false;
        for _ in 0..MOST_ITERATIONS {
            let holding = bodies.exchange(parts);
            stalled = if at.error < 0.5 * best { 0 } else { stalled + 1 };
            best = best.min(at.error);
            history.push(at.error / at.scale);
            let is_small = at.error <= LIMIT * at.scale;
            is_balanced = at.error <= TARGET * at.scale || (stalled >= 2 && is_small);
            if is_balanced && holding == Holding::Settled {
                return Ok((at.end, at.answers));
            }
            if at.error > ENOUGH * last {
                kept.renew();
            }
            // Residuals under other loads say nothing of the steps.
            (best, stalled, last) = match holding {
                Holding::Settled => (best, stalled, at.error),
                Holding::Again => (f64::INFINITY, 0, f64::INFINITY),
            };
            at = match holding {
                Holding::Settled => {
                    let step = kept.step(self, parts, &at.residual)?;
                    self.search(parts, at, &step)?
                }
                // Loads of bodies have changed, and the residual with them: a step, or the same place anew.
                Holding::Again if is_balanced => self.evaluate(parts, at.end)?,
                Holding::Again => {
                    let step = kept.step(self, parts, &at.residual)?;
                    let end = at.end.iter().zip(&step).map(|(q, s)| q + s).collect();
                    self.evaluate(parts, end)?
                }
            };
        }
        if let (true, Some((body, change))) = (is_balanced, bodies.worst()) {
            return Err(AssemblyError::BodiesNotSettled {
                body: body.to_string(),
                rounds: MOST_ITERATIONS,
                change,
            });
        }
        let tail = history.len().saturating_sub(6);
        Err(AssemblyError::NotSettled {
            iterations: MOST_ITERATIONS,
            residual: history[history.len() - 1],
            limit: LIMIT,
            history: history.split_off(tail),
        })
    }

    fn evaluate(&self, parts: &mut [HeldPart<'_>], end: Vec<f64>) -> Result<ShaftBalance, AssemblyError> {
        let (n, [q, v]) = (self.shaft.n(), self.start);
        let inertia: Vec<f64> = self
            .velocity(&end)
            .iter()
            .zip(v)
            .map(|(a, b)| (a - b) / self.dt)
            .collect();
        let inertia = times(n, &self.shaft.mass, &inertia);
        let middle: Vec<f64> = q.iter().zip(&end).map(|(a, b)| 0.5 * (a + b)).collect();
        let elastic = times(n, &self.shaft.stiffness, &middle);
        let spin = self.spin_force(&end);
        let load = &self.load.on_dofs;
        let own = |i: usize| load[i] + spin[i] - inertia[i] - elastic[i];
        let mut residual: Vec<f64> = (0..n).map(own).collect();
        let mut scale = (0..n).fold(f64::MIN_POSITIVE, |m, i| {
            m.max(self.as_force(i, load[i].abs().max(inertia[i].abs())))
        });
        let answer = |(part, mount): (&mut HeldPart<'_>, &Mount)| {
            let own = mount.place.into_bearing(mount.station.displacement(&end));
            part.answer(own).map_err(AssemblyError::of_bearing(&mount.name))
        };
        let answers = of_each(parts.iter_mut().zip(self.mounts), answer)?;
        let pairs = self.mounts.iter().zip(&answers);
        let held: Vec<_> = pairs.map(|(mount, answer)| mount.loaded(answer.load)).collect();
        for ((station, load), answer) in held.iter().zip(&answers) {
            station.add_load(load.map(|f| -f), &mut residual);
            scale = scale.max(answer.force);
        }
        if let Some(levers) = self.load.beyond_straight(self.shaft, held.into_iter()) {
            let more = levers.over(self.interval(), [q, &end].map(first_dofs));
            residual.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
        }
        let free = (0..n).filter(|&i| self.shaft.held[i].is_none());
        let error = free.fold(0.0f64, |m, i| m.max(self.as_force(i, residual[i].abs())));
        if !error.is_finite() {
            return Err(AssemblyError::NotFinite);
        }
        Ok(ShaftBalance {
            end,
            residual,
            error,
            scale,
            answers,
        })
    }

    /// The point along a step, halved until the residual does not grow.
    fn search(
        &self,
        parts: &mut [HeldPart<'_>],
        from: ShaftBalance,
        step: &[f64],
    ) -> Result<ShaftBalance, AssemblyError> {
        let mut share = 1.0;
        for halving in 0..=HALVINGS {
            let end = from.end.iter().zip(step).map(|(q, s)| q + share * s).collect();
            match self.evaluate(parts, end) {
                Ok(next) if next.error <= from.error.max(LIMIT * next.scale) || halving == HALVINGS => {
                    return Ok(next);
                }
                // Ranks that share rings go on together or not at all.
                Err(error) if halving == HALVINGS || !Communicator::world().all_failed() => {
                    return Err(error);
                }
                _ => share *= 0.5,
            }
        }
        unreachable!("the last halving returns")
    }
}
