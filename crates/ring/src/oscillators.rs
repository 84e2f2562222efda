//! The body of a tied ring: its oscillators over a step, their energies and losses.

use std::sync::Arc;

use body::{BodyModes, SeatFunctions, SeatTie};
use dense::DenseCholesky;

use crate::error::RingError;
use crate::integrator::{Integrator, StepScheme};
use crate::state::{BodyState, RingState};
use crate::vectors::dot;

/// A body to which a ring is tied.
pub struct Oscillators {
    /// Its modes.
    pub modes: Arc<BodyModes>,
    /// Functions of the seat on the ring's side.
    functions: SeatFunctions,
    /// F of the body at rest; None of a rigid one.
    flexibility: Option<DenseCholesky>,
}

/// Oscillators over a step.
pub(crate) struct BodyStep {
    /// Increments without forces.
    pub predicted: Vec<f64>,
    /// Effective masses s.
    pub effective: Vec<f64>,
}

impl Oscillators {
    /// The body of a joint.
    pub(crate) fn new(tie: &SeatTie, functions: SeatFunctions) -> Result<Oscillators, RingError> {
        let modes = tie.modes.clone();
        let modes = modes.expect("the modes of a body are found before its ring moves");
        let flexibility = match modes.n() {
            0 => None,
            _ => {
                let factor = DenseCholesky::factor(functions.n(), &tie.flexibility);
                Some(factor.map_err(|source| RingError::Tie { source })?)
            }
        };
        Ok(Oscillators {
            modes,
            functions,
            flexibility,
        })
    }

    /// Number of functions of the seat.
    pub(crate) fn n_functions(&self) -> usize {
        self.functions.n()
    }

    pub(crate) fn bytes(&self) -> usize {
        let n = self.functions.n();
        self.modes.bytes() + self.functions.bytes() + 4 * size_of::<f64>() * n * n
    }

    /// For a log.
    pub(crate) fn note(&self) -> String {
        let (n, modes) = (self.functions.n(), &self.modes);
        if modes.n() == 0 {
            return format!("its seat is tied to a rigid body by {n} functions");
        }
        format!(
            "its seat is tied to a body by {n} functions, and the body moves by these and by its {} modes below {} Hz",
            modes.n_fixed, modes.below_hz
        )
    }

    /// The body at rest under a ring that stands as displaced, m, `[n_nodes][3]` flat.
    pub(crate) fn at_rest(&self, displacement: &[f64]) -> BodyState {
        let Some(flexibility) = &self.flexibility else {
            return BodyState::default();
        };
        let mut forces = self.functions.measure(displacement);
        let width = forces.len();
        flexibility.solve(&mut forces, 1);
        let rows = self.modes.of_forces.chunks_exact(width);
        let at: Vec<f64> = rows.map(|row| dot(row, &forces)).collect();
        let zero = vec![0.0; at.len()];
        BodyState([at, zero.clone(), zero])
    }

    /// D of a step, m/N, `[n][n]` flat.
    pub(crate) fn softness(&self, scheme: StepScheme, damping: [f64; 2]) -> Vec<f64> {
        let n = self.functions.n();
        let mut softness = vec![0.0; n * n];
        for (row, s) in self
            .modes
            .seat
            .chunks_exact(n)
            .zip(self.effective(scheme, damping))
        {
            for (i, v) in row.iter().enumerate() {
                let by = v / s;
                let to = &mut softness[n * i..n * (i + 1)];
                to.iter_mut().zip(row).for_each(|(d, w)| *d += by * w);
            }
        }
        softness
    }

    fn effective(&self, scheme: StepScheme, [am, ak]: [f64; 2]) -> Vec<f64> {
        let [m, c, k] = scheme.integrator.effective(scheme.dt);
        let of = |square: &f64| m + c * (am + ak * square) + k * square;
        self.modes.squares.iter().map(of).collect()
    }

    /// A step from a state.
    pub(crate) fn step(&self, scheme: StepScheme, [am, ak]: [f64; 2], old: &BodyState) -> BodyStep {
        let [mass, damping] = scheme.integrator.history(scheme.dt);
        let effective = self.effective(scheme, [am, ak]);
        let [x, v, a] = &old.0;
        let predicted = (0..x.len()).map(|i| {
            let square = self.modes.squares[i];
            let inertial = mass[0] * v[i] + mass[1] * a[i];
            let damped = damping[0] * v[i] + damping[1] * a[i];
            (inertial + (am + ak * square) * damped - square * x[i]) / effective[i]
        });
        BodyStep {
            predicted: predicted.collect(),
            effective,
        }
    }

    /// The state after a step under the forces lam of the joint on the ring, N.
    pub(crate) fn advanced(
        &self,
        scheme: StepScheme,
        old: &BodyState,
        step: &BodyStep,
        lam: &[f64],
    ) -> BodyState {
        let mut new = old.clone();
        let rows = self.modes.seat.chunks_exact(lam.len().max(1));
        for (i, row) in rows.enumerate() {
            let increment = step.predicted[i] - dot(row, lam) / step.effective[i];
            let [x, v, a] = &mut new.0;
            [v[i], a[i]] = scheme.integrator.update(scheme.dt, increment, v[i], a[i]);
            x[i] += increment;
        }
        new
    }

    /// Kinetic and strain energy, J.
    pub(crate) fn energies(&self, state: Option<&BodyState>) -> [f64; 2] {
        let Some(BodyState([x, v, _])) = state else {
            return [0.0; 2];
        };
        let strain: f64 = x
            .iter()
            .zip(&self.modes.squares)
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
        let squares = self.modes.squares.iter().enumerate();
        squares
            .map(|(i, &square)| term(square, at(old, i), at(new, i)))
            .sum()
    }
}
