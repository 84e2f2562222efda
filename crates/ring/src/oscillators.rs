//! The body of a tied ring: its oscillators over a step, their energies and losses.

use std::sync::Arc;

use body::N_SHAFT;
use body::{SeatFunctions, SeatModes, SeatTie, SeatTraction, ShaftAtSeat};
use dense::DenseCholesky;

use crate::error::RingError;
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
pub(crate) struct FrameRounds {
    /// Speed, rad/s, and its rate at the weighted time.
    pub turn: [f64; 2],
    /// Mean load on the oscillators.
    pub load: Vec<f64>,
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
        })
    }

    /// Number of functions of the seat.
    pub(crate) fn n_functions(&self) -> usize {
        self.functions.n()
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
    /// and forces on its other seats, N, over the functions of all seats. A shaft that carries it moves it, has a
    /// velocity, and turns with a `speed`, rad/s, against which the body stands.
    pub fn at_rest(
        &self,
        elastic: &[f64],
        others: Option<&[f64]>,
        (shaft, speed): ([[f64; 5]; 2], f64),
    ) -> BodyState {
        let Some(traction) = self.tie.traction(&self.functions, elastic, others) else {
            return BodyState::default();
        };
        let forces = self.tie.forces_on_body(&traction, others);
        let mut at = self.modes.of_body.at_rest(&forces);
        let zero = vec![0.0; at.len()];
        let mut velocity = match &self.modes.of_body.frame {
            Some(frame) => frame.standing(speed, &at),
            None => zero.clone(),
        };
        if let Some(shares) = self.on_shaft() {
            shares.add_motion(shaft[0], &mut at);
            shares.add_motion(shaft[1], &mut velocity);
        }
        BodyState([at, velocity, zero])
    }

    /// How the oscillators move the shaft that carries the body; None of one that stands.
    pub fn on_shaft(&self) -> Option<&ShaftAtSeat> {
        self.modes.on_shaft.as_ref()
    }

    /// What the joint carries; None for a rigid body.
    ///
    /// Over all seats V lam = -(xi'' + C xi' + omega^2 xi), weighted as at rest:
    /// lam = -F^-1 V^T (xi + (xi'' + C xi')/omega^2).
    pub fn traction(&self, BodyState([x, v, a]): &BodyState) -> Option<SeatTraction> {
        if let Some(shares) = self.on_shaft() {
            return Some(self.traction_on_shaft(shares, [x, v, a]));
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
        let mut motion = self.modes.motion(x);
        let along = self.tie.shaft_motion(shares.motion(x)).unwrap_or_default();
        motion.iter_mut().zip(along).for_each(|(y, r)| *y -= r);
        SeatTraction {
            forces: forces[self.modes.own.clone()].to_vec(),
            motion,
        }
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
        self.body.modes.softness(&self.effective)
    }

    /// What the shaft does to the body; empty where none carries it.
    pub fn by_shaft(&self) -> ShaftSoftness {
        let Some(shares) = self.body.on_shaft() else {
            return ShaftSoftness::default();
        };
        let n = self.body.n_functions();
        let mut softness = ShaftSoftness {
            of_seat: vec![0.0; N_SHAFT * n],
            own: vec![0.0; N_SHAFT * N_SHAFT],
        };
        let rows = self.body.modes.rows().zip(&shares.rows).zip(&self.effective);
        for ((seat, shaft), s) in rows {
            for (k, q) in shaft.iter().enumerate() {
                let by = q / s;
                let of_seat = softness.of_seat[n * k..n * (k + 1)].iter_mut();
                of_seat.zip(seat).for_each(|(d, v)| *d += by * v);
                let own = softness.own[N_SHAFT * k..N_SHAFT * (k + 1)].iter_mut();
                own.zip(shaft).for_each(|(d, q)| *d += by * q);
            }
        }
        softness
    }

    /// The inertia of a turning frame, at first as if the body went on as it does.
    pub fn frame(&self, turn: Option<FrameTurn>, BodyState([x, v, _]): &BodyState) -> Option<FrameRounds> {
        let (turn, forms) = turn.zip(self.body.modes.of_body.frame.as_ref())?;
        let turn = [turn.speed, turn.acceleration];
        Some(FrameRounds {
            load: forms.load(turn, x, v),
            turn,
            change: f64::INFINITY,
        })
    }

    /// The same where the body ends so: second order in the step with the conserving scheme.
    pub fn frame_load(&self, turn: [f64; 2], [old, new]: [&BodyState; 2]) -> Vec<f64> {
        let forms = self.body.modes.of_body.frame.as_ref();
        let (s, dt) = (self.scheme.integrator.alpha_f, self.scheme.dt);
        let pairs = || old.0[0].iter().zip(&new.0[0]);
        let x: Vec<f64> = pairs().map(|(a, b)| s * a + (1.0 - s) * b).collect();
        let v: Vec<f64> = pairs().map(|(a, b)| (b - a) / dt).collect();
        forms.map_or_else(Vec::new, |forms| forms.load(turn, &x, &v))
    }

    /// A step from a state, with the mean `load` on its oscillators over the step; empty: none.
    pub fn step(&self, BodyState([x, v, a]): &BodyState, load: &[f64]) -> BodyStep {
        let [mass, damping] = self.scheme.integrator.history(self.scheme.dt);
        let [am, ak] = self.body.damping;
        let mut increments = Vec::with_capacity(x.len());
        let mut seat = vec![0.0; self.body.n_functions()];
        let modes = &self.body.modes;
        for (i, row) in modes.rows().enumerate() {
            let square = modes.squares()[i];
            let inertial = mass[0] * v[i] + mass[1] * a[i];
            let damped = damping[0] * v[i] + damping[1] * a[i];
            let of_state = inertial + (am + ak * square) * damped - square * x[i];
            let increment = match load.get(i) {
                Some(load) => (of_state + load) / self.effective[i],
                None => of_state / self.effective[i],
            };
            seat.iter_mut()
                .zip(row)
                .for_each(|(y, r)| *y += (x[i] + increment) * r);
            increments.push(increment);
        }
        let shaft = self.body.on_shaft().map(|shares| {
            let end: Vec<f64> = x.iter().zip(&increments).map(|(x, d)| x + d).collect();
            [x, &end].map(|at| shares.motion(at).to_vec())
        });
        BodyStep {
            increments,
            seat,
            shaft: shaft.unwrap_or_default(),
        }
    }

    /// The state after a step under the forces lam of the joint on the ring, and of the shaft that carries the body, N
    /// and N m.
    pub fn advanced(&self, old: &BodyState, step: &BodyStep, lam: &[f64], shaft: &[f64]) -> BodyState {
        let mut new = old.clone();
        let by_shaft = self.body.on_shaft().map(|shares| &shares.rows);
        for (i, row) in self.body.modes.rows().enumerate() {
            let pull = by_shaft.map_or(0.0, |rows| dot(&rows[i], shaft));
            let increment = step.increments[i] - (dot(row, lam) - pull) / self.effective[i];
            let [x, v, a] = &mut new.0;
            let scheme = self.scheme;
            [v[i], a[i]] = scheme.integrator.update(scheme.dt, increment, v[i], a[i]);
            x[i] += increment;
        }
        new
    }
}
