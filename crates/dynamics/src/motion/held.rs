//! A part of a step of a bearing whose shaft is moved by others, such as a shaft on several bearings.
//!
//! The bearing answers a displacement of its shaft at the end of the part by the mean load that has to act on it over
//! the part. What holds the shaft balances these loads, bearing by bearing; then patches and the inertia of turning
//! frames are brought in line with the motion found, as in a bearing alone, until nothing changes.

use std::ops::Range;

use contact::Side;
use ring::{BodyAlone, Oscillators, StepFactor, StepScheme};
use timer::SharedLaps;

use super::cache::{RingEnds, StepCache};
use super::run::Motion;
use super::solve::{StepSolution, policy};
use super::span::PartSpan;
use super::state::{MotionState, StepReport};
use super::substep::StepPart;
use crate::bearing::BearingParts;
use crate::condensation::condensed;
use crate::costs::NEWTON;
use crate::error::DynamicsError;
use crate::interactions::discrete_gradient::MeanForce;
use crate::stiffness::{N_SHAFT, ShaftMatrix};
use crate::system::Follow;
use crate::system::newton::{KeptTangent, Policy};

/// A part under way.
pub struct HeldPart<'m> {
    motion: &'m Motion<'m>,
    state: &'m MotionState,
    part: StepPart<'m>,
    solution: StepSolution,
    /// Newton's tangent of the last answer; None where contacts have moved since.
    tangent: Option<KeptTangent>,
    ends: Option<RingEnds>,
    /// Mean load of others on the body of each ring, on its oscillators, inner first; empty: none.
    body_loads: [Vec<f64>; 2],
}

/// How a bearing answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldAnswer {
    /// Mean load that has to act on the shaft over the part, N and N m. A body on the shaft that carries other bearings
    /// as well counts at its first seat alone.
    pub load: [f64; N_SHAFT],
    /// Force by which its round-off counts, N.
    pub force: f64,
}

/// Whether a part is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holding {
    /// Patches and frames are in line with the motion found.
    Settled,
    /// Something has changed: the shaft is to be balanced again.
    Again,
}

impl<'m> HeldPart<'m> {
    /// Begins a part from a state of a motion whose model has a free shaft.
    pub fn begin(
        motion: &'m Motion<'m>,
        state: &'m MotionState,
        span: PartSpan,
        cache: &StepCache,
    ) -> Result<HeldPart<'m>, DynamicsError> {
        Ok(HeldPart {
            motion,
            state,
            part: motion.begin(state, span, cache)?,
            solution: as_before(state),
            tangent: None,
            ends: None,
            body_loads: Default::default(),
        })
    }

    /// The answer to a displacement of the shaft at the end. Newton starts from the answer before.
    pub fn answer(&mut self, shaft: [f64; N_SHAFT]) -> Result<HeldAnswer, DynamicsError> {
        let part = &mut self.part;
        part.clock.lap();
        part.parts.shaft.imposed = shaft.map(Some);
        let before = Some(std::mem::take(&mut self.solution.unknowns)).filter(|x| !x.is_empty());
        let policy = Policy {
            ends_at_floor: true,
            blocks: &part.parts.kinematic_blocks(),
            ..policy(part.scale, None, &self.motion.costs)
        };
        let solution = part.parts.solve_step_from(before, &policy, &mut self.tangent)?;
        let scheme = StepScheme {
            integrator: self.motion.settings.integrator,
            dt: part.span.dt,
        };
        let forces = solution.forces.iter().map(|f| f.force[0].hypot(f.force[1]));
        let reactions = part.parts.shaft_reactions(&solution, scheme);
        let elsewhere = self.counted_elsewhere(shaft);
        let part = &mut self.part;
        let answer = HeldAnswer {
            load: [0, 1, 2, 3, 4].map(|i| reactions[i] - elsewhere[i]),
            force: forces.fold(part.scale, f64::max),
        };
        part.report.newton_iterations += solution.iterations;
        part.report.laps.add(NEWTON, part.clock.lap());
        self.solution = solution;
        Ok(answer)
    }

    /// How the load of the last answer grows with the displacement at the end.
    pub fn stiffness(&mut self) -> Result<ShaftMatrix, DynamicsError> {
        let part = &mut self.part;
        part.clock.lap();
        let found = part
            .parts
            .held_tangent(self.solution.shaft, &self.solution.unknowns);
        part.report.laps.add(NEWTON, part.clock.lap());
        let mut found = found?;
        if let Some(elsewhere) = self.stiffness_elsewhere() {
            let entries = found.as_flattened_mut().iter_mut();
            entries.zip(elsewhere.as_flattened()).for_each(|(k, e)| *k -= e);
        }
        Ok(found)
    }

    /// The body on the shaft in which the inner ring sits, without that, and how it follows the shaft.
    fn on_shaft(&self) -> Option<(BodyAlone, Follow)> {
        let rings = self.part.rings.iter().zip(&self.part.parts.rings);
        rings
            .filter_map(|(step, ports)| Some((step.as_ref()?.body_alone()?, ports.as_ref()?.follow?)))
            .next()
    }

    /// Whether that body has other seats, and whether this is not the first.
    fn seats_on_shaft(&self) -> [bool; 2] {
        let rings = self.motion.model().rings.iter().flatten();
        let tie = rings
            .filter_map(|ring| ring.tie.as_ref())
            .find(|tie| tie.carried().is_some());
        tie.map_or([false; 2], |tie| [tie.has_others(), tie.seat > 0])
    }

    /// Mean force and moment of the body on the shaft on its ring in the last answer, N and N m; None where there is no
    /// such body.
    pub fn force_of_body(&self) -> Option<[f64; N_SHAFT]> {
        let rings = self.part.rings.iter().zip(&self.part.parts.rings);
        for (side, (step, ports)) in Side::BOTH.into_iter().zip(rings) {
            let (Some(step), Some(ports)) = (step, ports) else {
                continue;
            };
            let forces = self.part.parts.forces_at_ports(side, &self.solution);
            if let (Some(force), Some(follow)) = (step.force_of_body(forces.at_ports()), ports.follow) {
                return Some(follow.in_space(&force));
            }
        }
        None
    }

    /// Loads on the shaft that are in the reactions of the bearing and that other bearings on the same body count. The
    /// reactions hold the whole body, with the loads of the others on it: at the first seat others count these loads,
    /// elsewhere all of the body.
    fn counted_elsewhere(&self, shaft: [f64; N_SHAFT]) -> [f64; N_SHAFT] {
        let [is_shared, is_other] = self.seats_on_shaft();
        let shared = is_shared.then(|| self.on_shaft()).flatten();
        let Some((alone, follow)) = shared else {
            return [0.0; N_SHAFT];
        };
        let at = match is_other {
            true => follow.in_frame(shaft).to_vec(),
            false => alone.unloaded.clone(),
        };
        let off: Vec<f64> = at.iter().zip(&alone.predicted).map(|(q, p)| q - p).collect();
        follow.in_space(&times(&alone.stiffness, &off))
    }

    /// Growth of what others count with the displacement at the end; None: it does not grow.
    fn stiffness_elsewhere(&self) -> Option<ShaftMatrix> {
        let is_other = self.seats_on_shaft() == [true; 2];
        let (alone, follow) = is_other.then(|| self.on_shaft()).flatten()?;
        let column = |k: usize| {
            let mut unit = [0.0; N_SHAFT];
            unit[k] = 1.0;
            follow.in_space(&times(&alone.stiffness, &follow.in_frame(unit)))
        };
        let columns = [0, 1, 2, 3, 4].map(column);
        Some([0, 1, 2, 3, 4].map(|i| columns.map(|column| column[i])))
    }

    /// Size of the part, s.
    pub fn dt(&self) -> f64 {
        self.part.span.dt
    }

    /// Factor of a ring for parts of this size.
    pub fn factor(&self, side: Side) -> Result<Option<&dyn StepFactor>, DynamicsError> {
        let rung = self.motion.rung(self.part.span.rung)?;
        Ok(rung[side.index()].as_deref())
    }

    /// Forces of the joint of a ring and its body in the last answer, N; before the first one, as the contact forces of
    /// the last step let expect. None: there is no body.
    pub fn forces_of_joint(&self, side: Side) -> Option<Vec<f64>> {
        let forces = self.part.parts.forces_at_ports(side, &self.solution);
        let ring = self.part.rings[side.index()].as_ref()?;
        ring.forces_of_joint(forces.at_ports())
    }

    /// Mean load of a ring on the oscillators of its body under forces of their joint.
    pub fn load_on_body(&self, side: Side, joint: &[f64]) -> Vec<f64> {
        let ring = self.part.rings[side.index()].as_ref();
        ring.map_or_else(Vec::new, |ring| ring.load_on_body(joint))
    }

    /// The body of a ring.
    pub fn body(&self, side: Side) -> Option<&Oscillators> {
        self.motion.tied(side)
    }

    /// Puts the mean load of others on these oscillators, in place of the one before.
    pub fn load_body(&mut self, side: Side, load: Vec<f64>) {
        let i = side.index();
        if let (Some(step), Some(ports)) = (&mut self.part.rings[i], &mut self.part.parts.rings[i]) {
            step.load_body(&load);
            ports.offset.clone_from(&step.answer().predicted);
            self.body_loads[i] = load;
        }
    }

    /// Moves the seat of the body of a ring by what others do to it at the end, m, in place of their load.
    pub fn move_seat(&mut self, side: Side, motion: &[f64]) {
        let i = side.index();
        if let (Some(step), Some(ports)) = (&mut self.part.rings[i], &mut self.part.parts.rings[i]) {
            step.move_seat(motion);
            ports.offset.clone_from(&step.answer().predicted);
        }
    }

    /// Brings patches in line with the last answer.
    pub fn place(&mut self) -> Result<Holding, DynamicsError> {
        self.part.clock.lap();
        let stays = self
            .motion
            .stays_in_place(self.state, &mut self.part, &self.solution)?;
        if stays {
            return Ok(Holding::Settled);
        }
        self.tangent = None;
        Ok(Holding::Again)
    }

    /// Brings the inertia of turning frames in line with the last answer and ends the rings; looks ahead to the part
    /// `upcoming`.
    pub fn close(&mut self, upcoming: Option<PartSpan>) -> Result<Holding, DynamicsError> {
        self.part.clock.lap();
        self.ends = self
            .motion
            .close(self.state, &mut self.part, &self.solution, upcoming)?;
        Ok(match self.ends {
            Some(_) => Holding::Settled,
            None => Holding::Again,
        })
    }

    /// The state after the part, which is closed.
    pub fn finish(mut self, cache: &mut StepCache) -> Result<(MotionState, StepReport), DynamicsError> {
        self.part.clock.lap();
        let ends = self.ends.expect("the part is closed");
        let (mut next, report, ahead) = self
            .motion
            .conclude(self.state, self.part, &self.solution, ends)?;
        for (ring, load) in self
            .body_loads
            .iter()
            .enumerate()
            .filter(|(_, load)| !load.is_empty())
        {
            next.ledger.imposed_work += work_on_body((ring, load), [self.state, &next]);
            next.ledger.note_scale();
        }
        cache.ahead = ahead;
        Ok((next, report))
    }
}

/// What is expected of a part before its first answer: the contact forces of the last step.
fn as_before(state: &MotionState) -> StepSolution {
    let forces = state.forces.iter().map(|force| MeanForce {
        force: force.to_array(),
        ..MeanForce::default()
    });
    StepSolution {
        forces: forces.collect(),
        ..StepSolution::default()
    }
}

/// A matrix over the shaft's dofs times a vector.
fn times(matrix: &[f64], x: &[f64]) -> Vec<f64> {
    let rows = matrix.chunks_exact(N_SHAFT);
    rows.map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum())
        .collect()
}

/// Work of a mean load on the body of a ring between two states, J.
fn work_on_body((ring, load): (usize, &[f64]), [from, to]: [&MotionState; 2]) -> f64 {
    fn body(state: &MotionState, ring: usize) -> Option<&[f64]> {
        Some(&state.rings[ring].as_ref()?.body()?.0[0])
    }
    let (Some(from), Some(to)) = (body(from, ring), body(to, ring)) else {
        return 0.0;
    };
    let moved = from.iter().zip(to).map(|(from, to)| to - from);
    load.iter().zip(moved).map(|(p, x)| p * x).sum()
}

impl BearingParts {
    /// Growth of the load on the shaft with its displacement `shaft` at the end, all else as Newton's unknowns `rest`
    /// have it.
    fn held_tangent(&self, shaft: [f64; N_SHAFT], rest: &[f64]) -> Result<ShaftMatrix, DynamicsError> {
        let mut free = self.clone();
        free.shaft.imposed = [None; N_SHAFT];
        let (system, x) = (free.system(), [&shaft[..], rest].concat());
        let at = system.evaluate(&x, &SharedLaps::default());
        let mut tangent = system.body_tangent(&x);
        system.add_link_tangents(&x, &at.links, &mut tangent);
        system.add_curvatures(&x, &at.links, &mut tangent);
        condensed(system.n(), &tangent, &self.kinematic_blocks())
            .map_err(|source| DynamicsError::ContactSystem { source })
    }

    /// Unknowns of each ball, radial and axial, where the shaft has none: no ball sees another.
    fn kinematic_blocks(&self) -> Vec<Range<usize>> {
        let pairs = 0..self.balls.len();
        pairs.map(|ball| 2 * ball..2 * ball + 2).collect()
    }
}
