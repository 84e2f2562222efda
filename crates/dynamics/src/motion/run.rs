//! The time loop's step: from one State to the next.
//!
//! The outer ring lives in space, the inner in a frame turned by theta_i(t): its contacts stand at azimuth minus theta_i,
//! loads that are fixed in space are turned into it. Contacts of a step are placed at the azimuths of its middle.

use contact::patch::PatchShape;
use contact::{ContactLaw, NodalWeights, Patch, Side};
use solver::dense::DenseCholesky;

use super::balls::{Kinematics, Speed};
use super::contacts::{ContactDamping, ContactScheme};
use super::integrator::Integrator;
use super::ledger::Ledger;
use super::ring::{RingMotion, RingState, RingStep};
use super::small::{Inertia, RingAnswer, SmallSolution, SmallSystem};
use crate::effects::{self, Loads, Now};
use crate::equilibrium::SearchScales;
use crate::error::DynamicsError;
use crate::model::{ContactMode, Hold, Model, ShaftDof, elastic};
use crate::problem::Site;
use crate::solution::StaticSolution;

/// Groove angle kept from the rim by an unloaded contact, as a share of the groove.
const RIM_SHARE: f64 = 0.05;

/// Choices of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionSettings {
    /// Step size, s.
    pub dt: f64,
    /// Scheme of the rings.
    pub integrator: Integrator,
    /// Scheme of the contacts.
    pub scheme: ContactScheme,
    /// Inner ring speed.
    pub speed: Speed,
    /// Slip ratios at the inner and outer raceway.
    pub slip: [f64; 2],
    /// Contact damping, when the scene calls for it.
    pub contact_damping: Option<ContactDamping>,
    /// Rayleigh damping C = [0] M + [1] K.
    pub rayleigh: [f64; 2],
}

/// All that evolves.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionState {
    /// Steps done.
    pub step: u64,
    /// Coordinates of the flexible rings.
    pub rings: [Option<RingState>; 2],
    /// Ball displacements from the just-touching position [radial, axial], m.
    pub balls: Vec<[f64; 2]>,
    /// Ball velocities, m/s.
    pub ball_velocities: Vec<[f64; 2]>,
    /// Displacement of a rigid inner ring's shaft, m and rad, in space.
    pub shaft: [f64; 5],
    /// Its velocity.
    pub shaft_velocity: [f64; 5],
    /// Mean contact forces of the last step [radial, axial] on the rings, by site, N.
    pub forces: Vec<[f64; 2]>,
    /// Contact angles at the end of the last step, by site, rad.
    pub angles: Vec<f64>,
    /// Energy ledger.
    pub ledger: Ledger,
}

/// What happened in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepReport {
    /// Newton iterations on the contacts.
    pub newton_iterations: usize,
}

/// A model ready to move.
pub struct Motion<'a> {
    model: &'a Model,
    settings: MotionSettings,
    kinematics: Kinematics,
    rings: [Option<RingMotion>; 2],
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
        })
    }

    /// The state at static equilibrium, at rest but for the turning of the inner ring.
    pub fn start(&self, solution: &StaticSolution) -> MotionState {
        let model = self.model;
        let q = solution.displacements.shaft;
        let omega = self.settings.speed.at(0.0);
        let ring = |side: Side| {
            let motion = self.rings[side.index()].as_ref()?;
            let elastic = solution.elastic[side.index()].as_ref()?;
            Some(ring_at_start(
                motion,
                elastic,
                if side == Side::Inner { q } else { [0.0; 5] },
                omega,
            ))
        };
        let forces = solution.balls.iter().flat_map(|b| {
            [(Side::Inner, &b.inner), (Side::Outer, &b.outer)].map(|(side, c)| {
                let (sin, cos) = c.contact_angle_rad.sin_cos();
                [side.sign() * c.force_n * cos, side.sign() * c.force_n * sin]
            })
        });
        let angles = solution
            .balls
            .iter()
            .flat_map(|b| [b.inner.contact_angle_rad, b.outer.contact_angle_rad]);
        let mut state = MotionState {
            step: 0,
            rings: [ring(Side::Inner), ring(Side::Outer)],
            balls: solution.displacements.balls.clone(),
            ball_velocities: vec![[0.0; 2]; model.geometry.n_balls],
            shaft: q,
            shaft_velocity: [0.0; 5],
            forces: forces.collect(),
            angles: angles.collect(),
            ledger: Ledger::default(),
        };
        state.ledger.hertz = solution.hertz_energy;
        self.measure_energies(&mut state);
        state.ledger.initial = state.ledger.total();
        state.ledger.note_scale();
        state
    }

    /// Time of a step number, s.
    pub fn time(&self, step: u64) -> f64 {
        step as f64 * self.settings.dt
    }

    /// Azimuth of a ball at a time, rad.
    pub fn ball_azimuth(&self, ball: usize, time: f64) -> f64 {
        self.model.geometry.azimuth(ball) + self.cage_angle(time)
    }

    /// Angle the cage has turned since the start, rad.
    fn cage_angle(&self, time: f64) -> f64 {
        self.kinematics.cage * self.settings.speed.angle(time)
    }

    /// One step.
    pub fn step(&self, state: &MotionState) -> Result<(MotionState, StepReport), DynamicsError> {
        let middle = self.time(state.step) + 0.5 * self.settings.dt;
        let loads = effects::loads(
            self.model,
            &Now {
                time: middle,
                cage_angle: self.cage_angle(middle),
            },
        )?;
        let (mut sites, feet) = self.place(state, middle)?;
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
        let system = self.system(state, std::mem::take(&mut sites), &steps, &loads);
        let scale = state
            .forces
            .iter()
            .flatten()
            .fold(loads.shaft[2].abs().max(1e-9), |m, f| m.max(f.abs()));
        let solution = system.solve(scale)?;
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
        let (model, geometry) = (self.model, &self.model.geometry);
        let ball_centre = geometry.ball_centre();
        let turned = self.settings.speed.angle(middle);
        let (mut sites, mut feet) = (Vec::new(), [Vec::new(), Vec::new()]);
        for ball in 0..geometry.n_balls {
            let azimuth = self.ball_azimuth(ball, middle);
            for side in Side::BOTH {
                let index = 2 * ball + side.index();
                let hertz = &model.hertz[side.index()];
                let centre = geometry.groove_centre(side);
                let mut site = Site {
                    ball,
                    side,
                    azimuth,
                    reach: [ball_centre[0] - centre[0], ball_centre[1] - centre[1]],
                    touching: geometry.touching_distance(side),
                    lever: geometry.centre_radius(side),
                    law: ContactLaw {
                        stiffness: hertz.stiffness,
                        patch_compliance: 0.0,
                    },
                    unevenness: None,
                };
                if let (Some(ring), Some(motion)) = (model.ring(side), &self.rings[side.index()]) {
                    let force = state.forces[index];
                    let local = if side == Side::Inner {
                        azimuth - turned
                    } else {
                        azimuth
                    };
                    let [low, high] = motion.surface.angle_range;
                    let rim = RIM_SHARE * (high - low);
                    let angle = state.angles[index].clamp(low + rim, high - rim);
                    let axes = hertz.semi_axes(force[0].hypot(force[1]));
                    let spacings = model.contact.patch_spacings;
                    let shape = PatchShape::new(&motion.surface, local, angle, axes, spacings)?;
                    let material = elastic(&ring.material);
                    let patch = Patch::new(&motion.surface, &ring.mesh.nodes, &motion.rule, shape, material)?;
                    site.law.patch_compliance = patch.compliance;
                    feet[side.index()].push(patch.weights);
                }
                sites.push(site);
            }
        }
        Ok((sites, feet))
    }

    /// Generalised load of a ring. Loads are fixed in space: those of the inner ring and its shaft are turned into
    /// its frame.
    fn ring_load(&self, motion: &RingMotion, side: Side, loads: &Loads, middle: f64) -> Vec<f64> {
        let back = if side == Side::Inner {
            -self.settings.speed.angle(middle)
        } else {
            0.0
        };
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

    fn measure_energies(&self, state: &mut MotionState) {
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

    /// Displacement of the shaft in space, m and rad.
    pub fn shaft(&self, state: &MotionState) -> [f64; 5] {
        let (Some(motion), Some(ring)) = (&self.rings[0], &state.rings[0]) else {
            return state.shaft;
        };
        let (dofs, first) = motion.coordinates.shaft();
        let mut q = [0.0; 5];
        for (i, dof) in self.model.shaft.iter().enumerate() {
            if let ShaftDof::Prescribed(value) = dof {
                q[i] = *value;
            }
        }
        dofs.iter()
            .enumerate()
            .for_each(|(k, &dof)| q[dof] = ring.w[first + k]);
        turn(q, self.settings.speed.angle(self.time(state.step)))
    }

    /// Scales of the contact search, for messages and starts.
    pub fn scales(&self) -> SearchScales {
        SearchScales::new(&self.model.geometry, self.model.hertz[0].stiffness)
    }
}

/// Shaft dofs seen from a frame turned by `angle` the other way: the pairs (x, y) and (tilt x, tilt y) turn.
fn turn(q: [f64; 5], angle: f64) -> [f64; 5] {
    let (sin, cos) = angle.sin_cos();
    [
        cos * q[0] - sin * q[1],
        sin * q[0] + cos * q[1],
        q[2],
        cos * q[3] - sin * q[4],
        sin * q[3] + cos * q[4],
    ]
}

/// Nodal vectors turned about z.
fn turn_nodal(v: &[f64], angle: f64) -> Vec<f64> {
    let (sin, cos) = angle.sin_cos();
    v.chunks_exact(3)
        .flat_map(|x| [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1], x[2]])
        .collect()
}

/// Coordinates of a ring at static equilibrium: elastic part plus the shaft's motion, and the velocity that a
/// displacement fixed in space has in the turning frame.
fn ring_at_start(motion: &RingMotion, elastic: &[f64], q: [f64; 5], omega: f64) -> RingState {
    let coordinates = &motion.coordinates;
    let (dofs, first) = coordinates.shaft();
    let field = |q: [f64; 5]| {
        let mut y = vec![0.0; coordinates.n()];
        for (i, &dof) in coordinates.free().iter().enumerate() {
            y[i] = coordinates.rigid_motion(dof, q);
        }
        dofs.iter()
            .enumerate()
            .for_each(|(k, &dof)| y[first + k] = q[dof]);
        y
    };
    let mut w = field(q);
    coordinates
        .free()
        .iter()
        .enumerate()
        .for_each(|(i, &dof)| w[i] += elastic[dof]);
    let mut state = motion.at_rest(w);
    state.v = field([omega * q[1], -omega * q[0], 0.0, omega * q[4], -omega * q[3]]);
    state
}

fn check_supported(model: &Model) -> Result<(), DynamicsError> {
    let refuse = |what: &'static str| Err(DynamicsError::NotInMotion { what });
    if model.contact.mode == ContactMode::Facet {
        return refuse("contact.mode = \"facet\"; use \"patch\"");
    }
    if model.rings.iter().flatten().any(|r| r.hold == Hold::MeanMotion) {
        return refuse("support = \"mean_motion\"; use \"clamped\"");
    }
    let same = |a: usize, b: usize| {
        matches!((model.shaft[a], model.shaft[b]), (ShaftDof::Free, ShaftDof::Free))
            || (model.shaft[a] == ShaftDof::Prescribed(0.0) && model.shaft[b] == ShaftDof::Prescribed(0.0))
    };
    let axial = matches!(model.shaft[2], ShaftDof::Free) || model.shaft[2] == ShaftDof::Prescribed(0.0);
    if model.ring(Side::Inner).is_some() && !(same(0, 1) && same(3, 4) && axial) {
        return refuse(
            "a flexible inner ring whose shaft has x and y, or both tilts, held differently or driven",
        );
    }
    Ok(())
}
