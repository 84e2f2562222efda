//! The time loop's step: from one State to the next.
//!
//! The outer ring lives in space, the inner in a frame turned by theta_i(t): its contacts stand at azimuth minus theta_i,
//! loads that are fixed in space are turned into it. Contacts of a step are placed at the azimuths of its middle.

use contact::patch::PatchShape;
use contact::{NodalWeights, Patch, Side};
use rayon::prelude::*;
use solver::dense::DenseCholesky;

use super::balls::Kinematics;
use super::frame::{turn, turn_nodal};
use super::ring::{RingMotion, RingStep};
use super::small::{Inertia, RingAnswer, SmallSolution, SmallSystem, check_patches};
use super::start::check_supported;
use super::state::{MotionSettings, MotionState, StepReport};
use crate::costs::EffectCosts;
use crate::effects::{self, Loads, Now};
use crate::error::DynamicsError;
use crate::footprint::{on_groove, require_on_groove};
use crate::model::{Model, ShaftDof, elastic};
use crate::problem::Site;

/// A model ready to move.
pub struct Motion<'a> {
    pub(super) model: &'a Model,
    pub(super) settings: MotionSettings,
    pub(super) kinematics: Kinematics,
    pub(super) rings: [Option<RingMotion>; 2],
    /// Seconds so far, by effect.
    pub costs: EffectCosts,
}

impl<'a> Motion<'a> {
    /// Assembles and factors both rings for one step size.
    pub fn new(model: &'a Model, settings: MotionSettings) -> Result<Motion<'a>, DynamicsError> {
        check_supported(model)?;
        let build = |side: Side| {
            let s = &settings;
            model
                .ring(side)
                .map(|ring| RingMotion::new(model, side, ring, s.integrator, s.dt, s.rayleigh))
                .transpose()
        };
        let (inner, outer) = rayon::join(|| build(Side::Inner), || build(Side::Outer));
        let kinematics = Kinematics::new(&model.geometry, settings.slip);
        Ok(Motion {
            model,
            kinematics,
            rings: [inner?, outer?],
            settings,
            costs: EffectCosts::new(model),
        })
    }

    /// Time of a step number, s.
    pub fn time(&self, step: u64) -> f64 {
        step as f64 * self.settings.dt
    }

    /// Azimuth of a ball at a time, rad.
    pub fn ball_azimuth(&self, ball: usize, time: f64) -> f64 {
        self.model.geometry.azimuth(ball) + self.cage_angle(time)
    }

    /// Angle by which the frame of a ring is turned in space, rad.
    pub(super) fn frame_angle(&self, side: Side, time: f64) -> f64 {
        match side {
            Side::Inner => self.settings.speed.angle(time),
            Side::Outer => 0.0,
        }
    }

    /// Angle the cage has turned since the start, rad.
    fn cage_angle(&self, time: f64) -> f64 {
        self.kinematics.cage * self.settings.speed.angle(time)
    }

    /// One step.
    pub fn step(&self, state: &MotionState) -> Result<(MotionState, StepReport), DynamicsError> {
        let middle = self.time(state.step) + 0.5 * self.settings.dt;
        let now = Now {
            time: middle,
            cage_angle: self.cage_angle(middle),
            angles: Some(&state.angles),
        };
        let loads = effects::timed_loads(self.model, &now, &self.costs)?;
        let (sites, feet) = self.place(state, middle)?;
        let prepare = |side: Side| {
            let motion = self.rings[side.index()].as_ref()?;
            let ring = state.rings[side.index()].as_ref()?;
            Some(motion.prepare(
                ring,
                &self.ring_load(motion, side, &loads, middle),
                &feet[side.index()],
            ))
        };
        let (inner, outer) = rayon::join(|| prepare(Side::Inner), || prepare(Side::Outer));
        let steps = [inner, outer];
        let system = self.system(state, sites, &steps, &loads);
        let scale = state
            .forces
            .iter()
            .flatten()
            .fold(loads.shaft[2].abs().max(1e-9), |m, f| m.max(f.abs()));
        let solution = system.solve(scale)?;
        check_patches(&system, &solution)?;
        let next = self.finish(state, &system, &solution, steps, &loads, middle);
        Ok((
            next,
            StepReport {
                newton_iterations: solution.iterations,
            },
        ))
    }

    /// Contact sites and patches at the middle of the step.
    fn place(
        &self,
        state: &MotionState,
        middle: f64,
    ) -> Result<(Vec<Site>, [Vec<NodalWeights>; 2]), DynamicsError> {
        let contacts: Vec<usize> = (0..2 * self.model.geometry.n_balls).collect();
        let placed: Result<Vec<_>, DynamicsError> = contacts
            .par_iter()
            .map(|&index| self.place_contact(state, index, middle))
            .collect();
        let (mut sites, mut feet) = (Vec::new(), [Vec::new(), Vec::new()]);
        for (site, weights) in placed? {
            feet[site.side.index()].extend(weights);
            sites.push(site);
        }
        Ok((sites, feet))
    }

    /// One contact: its site and, on a flexible ring, its weights.
    fn place_contact(
        &self,
        state: &MotionState,
        index: usize,
        middle: f64,
    ) -> Result<(Site, Option<NodalWeights>), DynamicsError> {
        let model = self.model;
        let (ball, side) = (index / 2, Side::BOTH[index % 2]);
        let azimuth = self.ball_azimuth(ball, middle);
        let mut site = Site::new(model, ball, side, azimuth);
        let (Some(ring), Some(motion)) = (model.ring(side), &self.rings[side.index()]) else {
            return Ok((site, None));
        };
        let force = state.forces[index];
        let loaded = force != [0.0; 2];
        if loaded {
            require_on_groove(&motion.surface, ball, state.angles[index])?;
        }
        let angle = on_groove(&motion.surface, state.angles[index], loaded);
        let axes = model.hertz[side.index()].semi_axes(force[0].hypot(force[1]));
        let shape = PatchShape::new(
            &motion.surface,
            azimuth - self.frame_angle(side, middle),
            angle,
            axes,
            model.contact.patch_spacings,
        )?;
        let patch = Patch::new(
            &motion.surface,
            &ring.mesh.nodes,
            &motion.rule,
            shape,
            elastic(&ring.material),
        )?;
        site.law.patch_compliance = patch.compliance;
        Ok((site, Some(patch.weights)))
    }

    /// Generalised load of a ring. Loads are fixed in space: those of the inner ring and its shaft are turned into
    /// its frame.
    fn ring_load(&self, motion: &RingMotion, side: Side, loads: &Loads, middle: f64) -> Vec<f64> {
        let back = -self.frame_angle(side, middle);
        let mut load = match &loads.rings[side.index()] {
            Some(body) => motion.coordinates.reduce(&turn_nodal(body, back)),
            None => vec![0.0; motion.coordinates.n()],
        };
        if side == Side::Inner {
            let (dofs, first) = motion.coordinates.shaft();
            let turned = turn(loads.shaft, back);
            for (k, &dof) in dofs.iter().enumerate() {
                load[first + k] += turned[dof];
            }
        }
        load
    }

    fn system(
        &self,
        state: &MotionState,
        sites: Vec<Site>,
        steps: &[Option<RingStep>; 2],
        loads: &Loads,
    ) -> SmallSystem {
        let model = self.model;
        let mass = model.ball_mass();
        let balls = (0..model.geometry.n_balls).map(|b| {
            [0, 1].map(|i| {
                let load_slope = if i == 0 { loads.ball_slope } else { 0.0 };
                Inertia {
                    mass,
                    start: [state.balls[b][i], state.ball_velocities[b][i]],
                    load: loads.balls[b][i],
                    load_slope,
                }
            })
        });
        let shaft = if self.rings[0].is_some() {
            Vec::new()
        } else {
            self.rigid_shaft(state, loads)
        };
        let answer = |step: &Option<RingStep>| {
            step.as_ref().map(|s| RingAnswer {
                start: s.start.clone(),
                predicted: s.predicted.clone(),
                stiffness: DenseCholesky::factor(s.start.len(), &s.compliance)
                    .expect("a ring with mass has a positive definite compliance")
                    .inverse(),
            })
        };
        SmallSystem {
            dt: self.settings.dt,
            sites,
            balls: balls.collect(),
            shaft,
            rings: [answer(&steps[0]), answer(&steps[1])],
            scheme: self.settings.scheme,
            damping: self.settings.contact_damping,
        }
    }

    /// Free dofs of the shaft that carries a rigid inner ring.
    fn rigid_shaft(&self, state: &MotionState, loads: &Loads) -> Vec<(usize, Inertia)> {
        let free = (0..5).filter(|&i| self.model.shaft[i] == ShaftDof::Free);
        free.map(|i| {
            let mass = if i < 3 { self.model.shaft_mass } else { 0.0 };
            let start = [state.shaft[i], state.shaft_velocity[i]];
            (
                i,
                Inertia {
                    mass,
                    start,
                    load: loads.shaft[i],
                    load_slope: 0.0,
                },
            )
        })
        .collect()
    }

    fn finish(
        &self,
        state: &MotionState,
        system: &SmallSystem,
        solution: &SmallSolution,
        steps: [Option<RingStep>; 2],
        loads: &Loads,
        middle: f64,
    ) -> MotionState {
        let mut next = state.clone();
        next.step += 1;
        for (side, step) in Side::BOTH.into_iter().zip(steps) {
            let i = side.index();
            if let (Some(motion), Some(old), Some(step)) = (&self.rings[i], &state.rings[i], step) {
                let forces: Vec<f64> = solution
                    .forces
                    .iter()
                    .skip(i)
                    .step_by(2)
                    .flat_map(|f| f.force)
                    .collect();
                let new = motion.finish(old, step, &forces);
                let load = self.ring_load(motion, side, loads, middle);
                next.ledger.load_work += load
                    .iter()
                    .zip(new.w.iter().zip(&old.w))
                    .map(|(f, (a, b))| f * (a - b))
                    .sum::<f64>();
                next.ledger.rayleigh_loss += motion.damping_loss(old, &new);
                next.rings[i] = Some(new);
            }
        }
        let x = &solution.unknowns;
        let mut moved = |i: usize, body: &Inertia| {
            let mean = 0.5 * (x[i] + body.start[0]);
            next.ledger.load_work += (body.load + body.load_slope * mean) * (x[i] - body.start[0]);
            // Without mass nothing is remembered.
            [
                x[i],
                if body.mass > 0.0 {
                    body.velocity(x[i], system.dt)
                } else {
                    0.0
                },
            ]
        };
        for (k, (dof, body)) in system.shaft.iter().enumerate() {
            [next.shaft[*dof], next.shaft_velocity[*dof]] = moved(k, body);
        }
        for (b, bodies) in system.balls.iter().enumerate() {
            for (i, body) in bodies.iter().enumerate() {
                [next.balls[b][i], next.ball_velocities[b][i]] = moved(system.ball_index(b) + i, body);
            }
        }
        let hertz_before = state.ledger.hertz;
        let (mut start, mut end) = (0.0, 0.0);
        for (index, site) in system.sites.iter().enumerate() {
            let [l0, l1] = system.reach(site, x);
            let energy = |l: [f64; 2]| site.law.evaluate(l[0].hypot(l[1]) - site.touching).energy;
            start += energy(l0);
            end += energy(l1);
            next.approaches[index] = site.law.evaluate(l1[0].hypot(l1[1]) - site.touching).approach;
            let sign = site.side.sign();
            next.angles[index] = (sign * l1[1]).atan2(sign * l1[0]);
            next.forces[index] = solution.forces[index].force;
            next.ledger.contact_loss += solution.forces[index].loss;
        }
        next.ledger.patch_work += start - hertz_before;
        next.ledger.hertz = end;
        self.measure_energies(&mut next);
        next.ledger.note_scale();
        next
    }

    pub(super) fn measure_energies(&self, state: &mut MotionState) {
        let energies = |i: usize| match (&self.rings[i], &state.rings[i]) {
            (Some(motion), Some(ring)) => motion.energies(ring),
            _ => [0.0; 2],
        };
        let (inner, outer) = rayon::join(|| energies(0), || energies(1));
        let mass = self.model.ball_mass();
        let balls: f64 = state
            .ball_velocities
            .iter()
            .flatten()
            .map(|v| 0.5 * mass * v * v)
            .sum();
        let shaft = if self.rings[0].is_some() {
            0.0
        } else {
            state.shaft_velocity[..3]
                .iter()
                .map(|v| 0.5 * self.model.shaft_mass * v * v)
                .sum()
        };
        state.ledger.kinetic = [inner[0] + shaft, outer[0], balls];
        state.ledger.strain = [inner[1], outer[1]];
    }
}
