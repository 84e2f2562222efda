//! The body of a tied ring: its oscillators over a step, their energies and losses.

use std::sync::Arc;

use body::{
    BesideRing, BodyLoad, N_SHAFT, SeatFunctions, SeatModes, SeatTie, SeatTraction, ShaftAtSeat, shaft_motion,
};
use dense::DenseCholesky;

use crate::error::RingError;
use crate::inertia::RigidInertia;
use crate::integrator::{Integrator, StepScheme};
use crate::state::{BodyState, RingState};
use crate::step::FrameTurn;
use crate::vectors::dot;

/// A body to which a ring is tied.
pub struct Oscillators {
    /// Its modes, as the seat sees them.
    pub modes: SeatModes,
    /// The joint.
    tie: Arc<SeatTie>,
    /// Functions of the seat on the ring's side.
    functions: SeatFunctions,
    /// F of all seats of the body at rest; None of a rigid one.
    flexibility: Option<DenseCholesky>,
    /// Rayleigh damping: C = a M + b K with `[a, b]`.
    damping: [f64; 2],
    /// The ring on a body on the shaft; None on one that stands.
    ring: Option<RigidRing>,
}

/// A ring that moves with its seat, as a rigid one: so its frame turns it.
struct RigidRing {
    inertia: RigidInertia,
    /// Its motion by unit oscillators, m and rad.
    rows: Vec<[f64; N_SHAFT]>,
}

impl RigidRing {
    /// Load on the oscillators of the frame that turns it.
    fn load(&self, turn: [f64; 2], x: &[f64], v: &[f64]) -> Vec<f64> {
        let [x, v] = [x, v].map(|of| shaft_motion(&self.rows, of));
        let force = self.inertia.of_frame(turn, x, v);
        self.rows.iter().map(|row| -dot(row, &force)).collect()
    }
}

/// A body over steps of one scheme and size.
pub(crate) struct BodyFactor {
    pub body: Arc<Oscillators>,
    scheme: StepScheme,
    /// Effective masses s.
    effective: Vec<f64>,
}

/// A body over a step before the forces of its joint are known.
pub(crate) struct BodyStep {
    /// Increments of the oscillators.
    increments: Vec<f64>,
    /// Motion of the seat at the end, m.
    pub seat: Vec<f64>,
    /// Motion of the shaft that carries the body, at the start and at the end, m and rad; empty: none carries it.
    pub shaft: [Vec<f64>; 2],
}

/// Inertia of the turning frame of a body over a step, found by rounds.
pub(crate) struct BodyFrame {
    /// Speed, rad/s, and its rate at the weighted time.
    pub turn: [f64; 2],
    /// Mean load on the oscillators, of the body.
    pub load: Vec<f64>,
    /// The same of the ring on it.
    pub of_ring: Vec<f64>,
    /// Change of the last round over the size of the loads.
    pub change: f64,
}

/// What forces of the shaft that carries a body do over a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct ShaftSoftness {
    /// Motion of the seat by unit forces, `[n_shaft][n_functions]` flat, m/N and m/(N m).
    pub of_seat: Vec<f64>,
    /// Motion of the shaft, `[n_shaft][n_shaft]` flat.
    pub own: Vec<f64>,
}

impl Oscillators {
    /// The body of a joint.
    pub(crate) fn new(
        tie: &Arc<SeatTie>,
        functions: SeatFunctions,
        damping: [f64; 2],
    ) -> Result<Oscillators, RingError> {
        let modes = tie.modes.clone();
        let modes = modes.expect("the modes of a body are found before its ring moves");
        let flexibility = match &tie.body {
            Some(body) if modes.n() > 0 => {
                let factor = DenseCholesky::factor(body.n_functions(), &body.flexibility);
                Some(factor.map_err(|source| RingError::Tie { source })?)
            }
            _ => None,
        };
        Ok(Oscillators {
            modes,
            tie: tie.clone(),
            functions,
            flexibility,
            damping,
            ring: None,
        })
    }

    /// The same with the inertia of the ring, where a shaft carries the body and the ring has no frame of its own. The
    /// motion of its seat is a rigid one and what that is not, by least squares over the seat.
    pub(crate) fn with_ring(mut self, inertia: impl FnOnce() -> RigidInertia) -> Oscillators {
        if self.on_shaft().is_none() {
            return self;
        }
        let unit = |k: usize| {
            let mut q = [0.0; N_SHAFT];
            q[k] = 1.0;
            self.tie.shaft_motion(q).unwrap_or_default()
        };
        let motions = [0, 1, 2, 3, 4].map(unit);
        let integrals = motions.each_ref().map(|motion| self.functions.integrals(motion));
        let gram: Vec<f64> = integrals
            .iter()
            .flat_map(|a| motions.each_ref().map(|b| dot(a, b)))
            .collect();
        let factor = DenseCholesky::factor(N_SHAFT, &gram).expect("rigid motions of a seat differ");
        let row = |row: &[f64]| {
            let mut q = integrals.each_ref().map(|of_motion| dot(of_motion, row));
            factor.solve(&mut q, 1);
            q
        };
        self.ring = Some(RigidRing {
            inertia: inertia(),
            rows: self.modes.rows().map(row).collect(),
        });
        self
    }

    /// Functions of the seat on the ring's side.
    pub(crate) fn functions(&self) -> &SeatFunctions {
        &self.functions
    }

    /// Number of functions of the seat.
    pub(crate) fn n_functions(&self) -> usize {
        self.functions.n()
    }

    /// Whether the ring is turned by the body, as a rigid one.
    pub fn turns_ring(&self) -> bool {
        self.ring.is_some()
    }

    /// Loads on the oscillators of a load on all of the body, by its weight and by its turning; empty: none.
    pub(crate) fn on_oscillators(&self, load: Option<BodyLoad>) -> [Vec<f64>; 2] {
        [load.map(BodyLoad::weight), load.and_then(BodyLoad::turning)]
            .map(|load| self.tie.on_oscillators(load))
    }

    /// Whether the body carries other rings.
    pub(crate) fn has_others(&self) -> bool {
        self.tie.has_others()
    }

    /// Bytes of the joint; those of the body are its own.
    pub(crate) fn bytes(&self) -> usize {
        let n = self.functions.n();
        self.functions.bytes() + 4 * size_of::<f64>() * n * n
    }

    /// For a log.
    pub(crate) fn note(&self) -> String {
        let (n, modes) = (self.functions.n(), &self.modes);
        if modes.n() == 0 {
            return format!("its seat is tied to a rigid body by {n} functions");
        }
        format!(
            "its seat is tied to a body by {n} functions, and the body moves by these and by its {} modes below {} Hz",
            modes.of_body.n_fixed, modes.of_body.below_hz
        )
    }

    /// The body at rest under a ring that stands as displaced beside the motion of its shaft, m, `[n_nodes][3]` flat,
    /// and what acts on it besides. A shaft that carries it moves it, has a velocity, and turns with a `speed`, rad/s,
    /// against which the body stands.
    pub fn at_rest(
        &self,
        elastic: &[f64],
        acting: BesideRing<'_>,
        (shaft, speed): ([[f64; 5]; 2], f64),
    ) -> BodyState {
        let Some(traction) = self.tie.traction(&self.functions, elastic, acting) else {
            return BodyState::default();
        };
        let forces = self.tie.forces_on_body(&traction, acting.others);
        let mut at = self.modes.of_body.at_rest(&forces);
        let weight = self.tie.at_rest_under(acting.load.map(BodyLoad::weight));
        at.iter_mut().zip(weight).for_each(|(x, load)| *x += load);
        let zero = vec![0.0; at.len()];
        let mut velocity = match &self.modes.of_body.frame {
            Some(frame) => frame.standing(self.way() * speed, &at),
            None => zero.clone(),
        };
        // What it grows turns with it.
        let growth = self.tie.at_rest_under(acting.load.and_then(BodyLoad::turning));
        at.iter_mut().zip(growth).for_each(|(x, load)| *x += load);
        if let Some(shares) = self.on_shaft() {
            shares.add_motion(shaft[0], &mut at);
            shares.add_motion(shaft[1], &mut velocity);
        }
        BodyState([at, velocity, zero])
    }

    /// Sign of the speed of the body where its bearing has a positive one.
    fn way(&self) -> f64 {
        self.on_shaft().map_or(1.0, |shaft| shaft.way)
    }

    /// How the oscillators move the shaft that carries the body; None of one that stands.
    pub fn on_shaft(&self) -> Option<&ShaftAtSeat> {
        self.modes.on_shaft.as_ref()
    }

    /// What the joint carries under a load on all of the body; None for a rigid body.
    ///
    /// Over all seats V lam = -(xi'' + C xi' + omega^2 xi - p), weighted as at rest:
    /// lam = -F^-1 V^T (xi + (xi'' + C xi' - p)/omega^2).
    pub fn traction(&self, BodyState([x, v, a]): &BodyState, load: Option<BodyLoad>) -> Option<SeatTraction> {
        // What the load makes is no acceleration.
        let load = self.tie.on_oscillators(load);
        let a: Vec<f64> = match load.is_empty() {
            true => a.clone(),
            false => a.iter().zip(&load).map(|(a, p)| a - p).collect(),
        };
        if let Some(shares) = self.on_shaft() {
            return Some(self.traction_on_shaft(shares, [x, v, &a]));
        }
        let [am, ak] = self.damping;
        let driven = |(i, square): (usize, &f64)| -x[i] - (a[i] + (am + ak * square) * v[i]) / square;
        let driven: Vec<f64> = self.modes.squares().iter().enumerate().map(driven).collect();
        let mut forces = self.modes.of_body.seat_motion(&driven);
        self.flexibility.as_ref()?.solve(&mut forces, 1);
        Some(SeatTraction {
            forces: forces[self.modes.own.clone()].to_vec(),
            motion: self.modes.motion(x),
        })
    }

    /// The same of a body on a shaft, whose rigid oscillators stand for nothing at rest. The motion is that beside the
    /// shaft's.
    fn traction_on_shaft(&self, shares: &ShaftAtSeat, [x, v, a]: [&[f64]; 3]) -> SeatTraction {
        let [am, ak] = self.damping;
        let driven = |(i, square): (usize, &f64)| match *square {
            0.0 => -(a[i] + am * v[i]),
            square => -x[i] - (a[i] + (am + ak * square) * v[i]) / square,
        };
        let driven: Vec<f64> = self.modes.squares().iter().enumerate().map(driven).collect();
        let forces = self.modes.of_body.forces_on_shaft(&driven);
        SeatTraction {
            forces: forces[self.modes.own.clone()].to_vec(),
            motion: self.beside_shaft(shares, x),
        }
    }

    /// Motion of the seat of a body on a shaft beside that of the shaft, by functions, m; None of one that stands.
    pub fn seat_beside_shaft(&self, BodyState([x, ..]): &BodyState) -> Option<Vec<f64>> {
        self.on_shaft().map(|shares| self.beside_shaft(shares, x))
    }

    fn beside_shaft(&self, shares: &ShaftAtSeat, oscillators: &[f64]) -> Vec<f64> {
        let mut motion = self.modes.motion(oscillators);
        let along = self.tie.shaft_motion(shares.motion(oscillators));
        motion
            .iter_mut()
            .zip(along.unwrap_or_default())
            .for_each(|(y, r)| *y -= r);
        motion
    }

    /// Kinetic and strain energy, J.
    pub fn energies(&self, state: Option<&BodyState>) -> [f64; 2] {
        let Some(BodyState([x, v, _])) = state else {
            return [0.0; 2];
        };
        let strain: f64 = x
            .iter()
            .zip(self.modes.squares())
            .map(|(x, square)| square * x * x)
            .sum();
        [0.5 * dot(v, v), 0.5 * strain]
    }

    /// Energy that Rayleigh damping took in a step, J.
    pub(crate) fn rayleigh_loss(
        &self,
        integrator: Integrator,
        [am, ak]: [f64; 2],
        states: [&RingState; 2],
    ) -> f64 {
        let s = integrator.alpha_f;
        self.sum(states, |square, [x0, v0, _], [x1, v1, _]| {
            (am + ak * square) * (x1 - x0) * (s * v0 + (1.0 - s) * v1)
        })
    }

    /// Energy that the integrator took in a step, J: as of the ring.
    pub(crate) fn numerical_loss(&self, integrator: Integrator, states: [&RingState; 2]) -> f64 {
        let s = integrator.alpha_m;
        self.sum(states, |square, [x0, v0, a0], [x1, v1, a1]| {
            let change = x1 - x0;
            change * (s * a0 + (1.0 - s) * a1) - 0.5 * (v0 + v1) * (v1 - v0)
                + (0.5 - integrator.alpha_f) * square * change * change
        })
    }

    /// Sum over the oscillators of a term of their square and their values at both ends.
    fn sum(&self, states: [&RingState; 2], term: impl Fn(f64, [f64; 3], [f64; 3]) -> f64) -> f64 {
        let [Some(old), Some(new)] = states.map(RingState::body) else {
            return 0.0;
        };
        let at = |state: &BodyState, i: usize| state.0.each_ref().map(|list| list[i]);
        let squares = self.modes.squares().iter().enumerate();
        squares
            .map(|(i, &square)| term(square, at(old, i), at(new, i)))
            .sum()
    }
}

impl BodyFactor {
    pub fn new(body: Arc<Oscillators>, scheme: StepScheme) -> BodyFactor {
        let [m, c, k] = scheme.integrator.effective(scheme.dt);
        let [am, ak] = body.damping;
        let of = |square: &f64| m + c * (am + ak * square) + k * square;
        BodyFactor {
            effective: body.modes.squares().iter().map(of).collect(),
            body,
            scheme,
        }
    }

    /// D, m/N, `[n][n]` flat; empty for a rigid body.
    pub fn softness(&self) -> Vec<f64> {
        self.body.modes.softness(&self.body.modes, &self.effective)
    }

    /// Motion of the seat by unit forces on the functions of another one of the body, m/N, `[n][n_others]` flat. The
    /// shaft that carries the body stands; `alone` is how it then holds it.
    pub fn softness_by(&self, other: &SeatModes, alone: &[f64]) -> Vec<f64> {
        let mut softness = self.body.modes.softness(other, &self.effective);
        let Some(shares) = self.body.on_shaft() else {
            return softness;
        };
        let [of_seat, of_other] = [&self.body.modes, other].map(|seat| self.of_seat(shares, seat));
        let [n, n_others] = [&of_seat, &of_other].map(|of| of.len() / N_SHAFT);
        for (own, stiffness) in of_seat.chunks_exact(n).zip(alone.chunks_exact(N_SHAFT)) {
            for (by_other, k) in of_other.chunks_exact(n_others).zip(stiffness) {
                for (to, v) in softness.chunks_exact_mut(n_others).zip(own) {
                    to.iter_mut().zip(by_other).for_each(|(d, w)| *d -= v * k * w);
                }
            }
        }
        softness
    }

    /// Motion of a seat by unit forces of the shaft that carries the body, `[n_shaft][n]` flat.
    fn of_seat(&self, shares: &ShaftAtSeat, seat: &SeatModes) -> Vec<f64> {
        let n = seat.own.len();
        let mut of_seat = vec![0.0; N_SHAFT * n];
        for ((row, shaft), s) in seat.rows().zip(&shares.rows).zip(&self.effective) {
            for (to, q) in of_seat.chunks_exact_mut(n).zip(shaft) {
                let by = q / s;
                to.iter_mut().zip(row).for_each(|(d, v)| *d += by * v);
            }
        }
        of_seat
    }

    /// What the shaft does to the body; empty where none carries it.
    pub fn by_shaft(&self) -> ShaftSoftness {
        let Some(shares) = self.body.on_shaft() else {
            return ShaftSoftness::default();
        };
        let mut own = vec![0.0; N_SHAFT * N_SHAFT];
        for (shaft, s) in shares.rows.iter().zip(&self.effective) {
            for (to, q) in own.chunks_exact_mut(N_SHAFT).zip(shaft) {
                let by = q / s;
                to.iter_mut().zip(shaft).for_each(|(d, q)| *d += by * q);
            }
        }
        ShaftSoftness {
            of_seat: self.of_seat(shares, &self.body.modes),
            own,
        }
    }

    /// The inertia of a turning frame, at first as if the body went on as it does.
    pub fn frame(&self, turn: Option<FrameTurn>, BodyState([x, v, _]): &BodyState) -> Option<BodyFrame> {
        let turn = turn.map(|turn| [turn.speed, turn.acceleration])?;
        self.body.modes.of_body.frame.as_ref()?;
        let [load, of_ring] = self.frame_loads(turn, x, v);
        Some(BodyFrame {
            load,
            of_ring,
            turn,
            change: f64::INFINITY,
        })
    }

    /// The same where the body ends so: second order in the step with the conserving scheme.
    pub fn frame_between(&self, turn: [f64; 2], [old, new]: [&BodyState; 2]) -> [Vec<f64>; 2] {
        let (s, dt) = (self.scheme.integrator.alpha_f, self.scheme.dt);
        let pairs = || old.0[0].iter().zip(&new.0[0]);
        let x: Vec<f64> = pairs().map(|(a, b)| s * a + (1.0 - s) * b).collect();
        let v: Vec<f64> = pairs().map(|(a, b)| (b - a) / dt).collect();
        self.frame_loads(turn, &x, &v)
    }

    /// Of body and ring.
    fn frame_loads(&self, turn: [f64; 2], x: &[f64], v: &[f64]) -> [Vec<f64>; 2] {
        let forms = self.body.modes.of_body.frame.as_ref();
        let of_body = turn.map(|w| self.body.way() * w);
        let body = forms.map_or_else(Vec::new, |forms| forms.load(of_body, x, v));
        let ring = self.body.ring.as_ref();
        [body, ring.map_or_else(Vec::new, |ring| ring.load(turn, x, v))]
    }

    /// A step from a state, with the mean `load` on its oscillators over the step; empty: none.
    pub fn step(&self, BodyState([x, v, a]): &BodyState, load: &[f64]) -> BodyStep {
        let [mass, damping] = self.scheme.integrator.history(self.scheme.dt);
        let [am, ak] = self.body.damping;
        let modes = &self.body.modes;
        let increment = |(i, square): (usize, &f64)| {
            let inertial = mass[0] * v[i] + mass[1] * a[i];
            let damped = damping[0] * v[i] + damping[1] * a[i];
            let of_state = inertial + (am + ak * square) * damped - square * x[i];
            (of_state + load.get(i).unwrap_or(&0.0)) / self.effective[i]
        };
        let increments: Vec<f64> = modes.squares().iter().enumerate().map(increment).collect();
        let end: Vec<f64> = x.iter().zip(&increments).map(|(x, d)| x + d).collect();
        let shaft = self.body.on_shaft();
        let mut seat = modes.motion(&end);
        // A rigid body stands.
        seat.resize(self.body.n_functions(), 0.0);
        BodyStep {
            increments,
            seat,
            shaft: shaft.map_or_else(Default::default, |shares| {
                [x, &end].map(|at| shares.motion(at).to_vec())
            }),
        }
    }

    /// The state after a step under the forces lam of the joint on the ring, and of the shaft that carries the body, N
    /// and N m.
    pub fn advanced(&self, old: &BodyState, step: &BodyStep, lam: &[f64], shaft: &[f64]) -> BodyState {
        let mut new = old.clone();
        let by_shaft = self.body.on_shaft().map(|shares| &shares.rows);
        for (i, load) in self.body.modes.loads(lam).into_iter().enumerate() {
            let pull = by_shaft.map_or(0.0, |rows| dot(&rows[i], shaft));
            let increment = step.increments[i] - (load - pull) / self.effective[i];
            let [x, v, a] = &mut new.0;
            let scheme = self.scheme;
            [v[i], a[i]] = scheme.integrator.update(scheme.dt, increment, v[i], a[i]);
            x[i] += increment;
        }
        new
    }
}
