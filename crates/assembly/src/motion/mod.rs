//! Several bearings on one shaft through time.
//!
//! Each bearing takes its own step ([`dynamics::motion::held`]) with the end of its shaft given, and answers by the
//! mean load that has to act there. The shaft moves by average acceleration, as the bearings do:
//!
//! ```text
//! M (v1 - v0)/h + G (W1 q1 - W0 q0)/h + K (q0 + q1)/2 + sum over bearings S^T T^T r(T S q1 + shift) = f
//! q1 - q0 = h (v0 + v1)/2
//! ```
//!
//! with the letters of the crate's page, G of 1 rad/s, the speed W, and the mean load f over the step. The sum of a
//! bearing's loads times the motion of its place is the work that goes into it, the `imposed_work` of its ledger. So
//! shaft and bearings together gain no energy: the shaft has a ledger of its own ([`ShaftLedger`]), and each closes by
//! itself.
//!
//! A body that carries several bearings moves in each of them, whole, with the loads of the others on its oscillators.
//! These are handed on until they stay as they are, so all copies move alike (`bodies`).
//!
//! An outer Newton balances the shaft with the condensed tangents of the bearings. Patches and turning frames of all
//! bearings are then brought in line with the motion found, and the shaft is balanced again until nothing changes. A
//! part that fails is done again in halves, all bearings together.

mod balance;
mod bodies;
mod factors;
mod ledger;
mod step;

use comm::Communicator;
use dynamics::effects::Now;
use dynamics::kinematics::Speed;
use dynamics::motion::held::{HeldAnswer, HeldPart, Holding};
use dynamics::motion::{
    EquilibriumRates, Integrator, Motion, MotionSettings, MotionState, PartSpan, StepCache, StepReport,
    among_threads,
};
use dynamics::stiffness::N_SHAFT;
use dynamics::{DynamicsError, ShaftDof};

use self::bodies::{BodyJoints, SharedLoads};
use self::factors::{KeptFactors, ShaftAlone};
pub use self::ledger::ShaftLedger;
use self::step::ShaftStep;
use crate::assembly::{Assembly, AssemblySolution};
use crate::error::AssemblyError;
use crate::housing::{HousedTogether, housed_together};
use crate::loads::ShaftLoads;
use crate::newton::Mount;
use crate::side_by_side::of_each;

/// Rounds for patches and frames before a part counts as failed.
const MAX_ROUNDS: usize = 60;

/// Loads on the shaft: their means over an interval about an instant.
pub type LoadAt<'a> = dyn Fn(&Now<'_>) -> Result<ShaftLoads, AssemblyError> + Sync + 'a;

/// Velocities at which equilibria of bearings that roll follow each other.
#[derive(Clone, Debug, PartialEq)]
pub struct AssemblyRates {
    /// Of the shaft's dofs, m/s and rad/s.
    pub shaft: Vec<f64>,
    /// Of every bearing, in its own frame.
    pub bearings: Vec<EquilibriumRates>,
}

impl AssemblyRates {
    /// From equilibria with a time between them, s.
    pub fn between([before, after]: [&AssemblySolution; 2], time: f64) -> AssemblyRates {
        let [from, to] = [before, after].map(|solution| &solution.shaft.displacements);
        let bearings = before.bearings.iter().zip(&after.bearings);
        AssemblyRates {
            shaft: from.iter().zip(to).map(|(from, to)| (to - from) / time).collect(),
            bearings: bearings
                .map(|(before, after)| EquilibriumRates::between([before, after], time))
                .collect(),
        }
    }
}

/// Bearings and shaft ready to move.
pub struct AssemblyMotion<'a> {
    assembly: &'a Assembly,
    mounts: Vec<Mount>,
    /// The bodies that carry several bearings.
    housed: Vec<HousedTogether>,
    /// Motion of every bearing, in its own frame.
    pub bearings: Vec<Motion<'a>>,
    /// Speed of the shaft in its frame.
    speed: Speed,
    load: Box<LoadAt<'a>>,
    dt: f64,
    halvings: u32,
}

/// All that evolves.
#[derive(Clone, Debug, PartialEq)]
pub struct AssemblyState {
    /// Steps done.
    pub step: u64,
    /// Every bearing, in its own frame.
    pub bearings: Vec<MotionState>,
    /// Displacement of the shaft's dofs, m and rad.
    pub shaft: Vec<f64>,
    /// Its velocity.
    pub velocity: Vec<f64>,
    /// Mean load of the shaft on every bearing over the last part of a step, in the bearing's frame, N and N m; without
    /// what a body on the shaft under it asks for.
    pub loads: Vec<[f64; N_SHAFT]>,
    /// Energies of the shaft.
    pub ledger: ShaftLedger,
}

/// What each bearing has found of its next step, see [`StepCache`], and factors of the shaft and of the joints of
/// shared bodies. Without it a step has the same bits.
#[derive(Default)]
pub struct AssemblyCache {
    bearings: Vec<StepCache>,
    shaft: Option<ShaftAlone>,
    joints: Vec<BodyJoints>,
}

impl Assembly {
    /// Frees the shaft in the models of the bearings: in a motion the common shaft moves it.
    pub fn release(&mut self) {
        for bearing in &mut self.bearings {
            bearing.model.shaft = [ShaftDof::Free; N_SHAFT];
        }
    }
}

impl<'a> AssemblyMotion<'a> {
    /// Factors the rings of every bearing for the full step. `settings` are those of each in its own frame, with one
    /// step size; the assembly is released.
    pub fn new(
        assembly: &'a Assembly,
        settings: Vec<MotionSettings>,
        speed: Speed,
        load: Box<LoadAt<'a>>,
    ) -> Result<AssemblyMotion<'a>, AssemblyError> {
        let (dt, halvings) = (settings[0].dt, settings[0].ladder.halvings);
        let mut bearings = Vec::new();
        for (bearing, settings) in assembly.bearings.iter().zip(settings) {
            require_conserving(&settings)?;
            let motion = Motion::beside(&bearings, &bearing.model, settings);
            let motion = motion.map_err(AssemblyError::of_bearing(&bearing.name))?;
            bearings.push(motion.of_small_tilts());
        }
        Ok(AssemblyMotion {
            mounts: assembly.mounts(),
            housed: housed_together(&assembly.bearings),
            assembly,
            bearings,
            speed,
            load,
            dt,
            halvings,
        })
    }

    /// The state at an equilibrium, at rest but for the turning of the rings.
    pub fn start(&self, solution: &AssemblySolution) -> AssemblyState {
        self.start_with(solution, None)
    }

    /// The same, with the velocities of shaft and balls if they are given.
    pub fn start_with(&self, solution: &AssemblySolution, rates: Option<&AssemblyRates>) -> AssemblyState {
        let bearings = self.bearings.iter().zip(&solution.bearings).enumerate();
        let shaft = solution.shaft.displacements.clone();
        let still = vec![0.0; shaft.len()];
        let mut state = AssemblyState {
            step: 0,
            bearings: bearings
                .map(|(i, (motion, solution))| motion.start_with(solution, rates.map(|r| &r.bearings[i])))
                .collect(),
            velocity: rates.map_or(still, |rates| rates.shaft.clone()),
            loads: solution.bearings.iter().map(|b| b.shaft_reaction).collect(),
            shaft,
            ledger: ShaftLedger::default(),
        };
        state.ledger = ShaftLedger::begin(&self.assembly.shaft, &state.shaft, &state.velocity);
        state
    }

    /// Time of a step number, s.
    pub fn time(&self, step: u64) -> f64 {
        self.bearings[0].time(step)
    }

    /// One step, in halves where a part fails.
    pub fn step(
        &self,
        state: &AssemblyState,
        cache: &mut AssemblyCache,
    ) -> Result<(AssemblyState, StepReport), AssemblyError> {
        cache
            .bearings
            .resize_with(self.bearings.len(), StepCache::default);
        among_threads(|| self.parts(state, cache))
    }

    /// The parts of a step.
    fn parts(
        &self,
        state: &AssemblyState,
        cache: &mut AssemblyCache,
    ) -> Result<(AssemblyState, StepReport), AssemblyError> {
        let n = 1u64 << self.halvings;
        let (mut at, mut rung, mut report) = (0, 0, StepReport::default());
        let mut next: Option<AssemblyState> = None;
        while at < n {
            let after = at + (n >> rung);
            let span = |motion: &Motion<'_>| motion.span(state.step, at, rung);
            let upcoming = |motion: &Motion<'_>| match after < n {
                true => Some(motion.span(state.step, after, rung)),
                false => (rung == 0).then(|| motion.span(state.step + 1, 0, 0)),
            };
            let spans: Vec<_> = self.bearings.iter().map(|m| (span(m), upcoming(m))).collect();
            match self.part(next.as_ref().unwrap_or(state), &spans, cache) {
                Ok((part, done)) => {
                    at = after;
                    report.add(&done);
                    next = Some(part);
                }
                // Ranks that share rings try again together or not at all.
                Err(error)
                    if rung < self.halvings
                        && error.may_pass_with_smaller_step()
                        && Communicator::world().all_failed() =>
                {
                    rung += 1;
                    report.retries += 1;
                }
                Err(source) => {
                    return Err(AssemblyError::StepFailed {
                        dt: self.dt / (1u64 << rung) as f64,
                        halvings: rung,
                        time: spans[0].0.start,
                        source: Box::new(source),
                    });
                }
            }
        }
        let mut next = next.expect("a step has at least one part");
        next.step = state.step + 1;
        next.bearings
            .iter_mut()
            .for_each(|bearing| bearing.step = next.step);
        Ok((next, report))
    }

    /// One part; the spans are those of every bearing, with the parts that follow.
    fn part(
        &self,
        state: &AssemblyState,
        spans: &[(PartSpan, Option<PartSpan>)],
        cache: &mut AssemblyCache,
    ) -> Result<(AssemblyState, StepReport), AssemblyError> {
        let (mounts, known) = (&self.mounts, &cache.bearings);
        let mut parts = of_each(self.bearings.iter().enumerate(), |(i, motion)| {
            let part = HeldPart::begin(motion, &state.bearings[i], spans[i].0, &known[i]);
            part.map_err(AssemblyError::of_bearing(&mounts[i].name))
        })?;
        let span = spans[0].0;
        let step = ShaftStep {
            shaft: &self.assembly.shaft,
            mounts: &self.mounts,
            dt: span.dt,
            speeds: [0.0, 1.0].map(|share| self.speed.at(span.at(share))),
            start: [&state.shaft, &state.velocity],
            load: (self.load)(&Now {
                time: span.at(0.5),
                width: span.dt,
                ..Now::default()
            })?,
            tilt_arm: self.assembly.scales().tilt_arm,
        };
        let (mut end, mut kept) = (step.guess(), KeptFactors::new(&step, cache.shaft.take()));
        let mut bodies = SharedLoads::new(&self.housed, &parts, std::mem::take(&mut cache.joints))?;
        bodies.expect(&mut parts);
        for _ in 0..MAX_ROUNDS {
            let answers;
            (end, answers) = step.balance(&mut parts, end, &mut kept, &mut bodies)?;
            if self.all(&mut parts, |_, part| part.place())? == Holding::Again {
                continue;
            }
            if self.all(&mut parts, |i, part| part.close(spans[i].1))? == Holding::Settled {
                (cache.shaft, cache.joints) = (kept.alone, bodies.into_joints());
                return self.finish(state, (&step, parts), (end, answers), cache);
            }
        }
        Err(AssemblyError::RoundsNotSettled { rounds: MAX_ROUNDS })
    }

    /// Does the same to every part; settled if all are.
    fn all(
        &self,
        parts: &mut [HeldPart<'_>],
        of: impl Fn(usize, &mut HeldPart<'_>) -> Result<Holding, DynamicsError> + Sync,
    ) -> Result<Holding, AssemblyError> {
        let mounts = &self.mounts;
        let of_part = |(i, part)| of(i, part).map_err(AssemblyError::of_bearing(&mounts[i].name));
        let held = of_each(parts.iter_mut().enumerate(), of_part)?;
        Ok(match held.contains(&Holding::Again) {
            true => Holding::Again,
            false => Holding::Settled,
        })
    }

    fn finish(
        &self,
        state: &AssemblyState,
        (step, parts): (&ShaftStep<'_>, Vec<HeldPart<'_>>),
        (shaft, answers): (Vec<f64>, Vec<HeldAnswer>),
        cache: &mut AssemblyCache,
    ) -> Result<(AssemblyState, StepReport), AssemblyError> {
        let pairs = parts.iter().zip(&answers);
        let on_ring = pairs.map(|(part, answer)| part.force_of_body().unwrap_or(answer.load));
        let loads = on_ring.collect();
        let mut report = StepReport::default();
        let mut bearings = Vec::new();
        let finish = |((part, cache), mount): ((HeldPart<'_>, &mut StepCache), &Mount)| {
            part.finish(cache).map_err(AssemblyError::of_bearing(&mount.name))
        };
        let parts = parts.into_iter().zip(&mut cache.bearings);
        for (next, done) in of_each(parts.zip(&self.mounts), finish)? {
            report.add(&done);
            bearings.push(next);
        }
        report.substeps = 1;
        let velocity = step.velocity(&shaft);
        Ok((
            AssemblyState {
                step: state.step,
                ledger: state.ledger.after(step, &shaft, &velocity, &answers),
                bearings,
                shaft,
                velocity,
                loads,
            },
            report,
        ))
    }
}

/// The shaft has no scheme that dissipates.
fn require_conserving(settings: &MotionSettings) -> Result<(), AssemblyError> {
    match settings.integrator == Integrator::average_acceleration() && settings.ladder.tolerance.is_none() {
        true => Ok(()),
        false => Err(AssemblyError::ShaftBody {
            problem: "a list of bearings moves by equal steps of average acceleration; use integrator = \
                      \"average_acceleration\" without dynamic.tolerance"
                .to_string(),
        }),
    }
}
