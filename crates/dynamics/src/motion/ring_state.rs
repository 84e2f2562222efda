//! The part of the state that belongs to one ring.

use rayon::prelude::*;

use super::integrator::Integrator;
use super::vectors::TASK;

/// Displacement, velocity, acceleration of a ring in the space of its body ([`super::space`]), SI, of one length.
#[derive(Clone, Debug, Default)]
pub struct RingState {
    /// Total displacement in the ring's frame.
    w: Vec<f64>,
    /// Velocity.
    v: Vec<f64>,
    /// Acceleration.
    a: Vec<f64>,
    /// What follows from the state, once it is known; no part of it.
    measures: Option<Measures>,
}

/// What follows from displacement and velocity of a ring.
#[derive(Clone, Debug)]
pub(super) struct Measures {
    /// M v and K w.
    pub products: [Vec<f64>; 2],
    /// v M v / 2 and w K w / 2, J.
    pub energies: [f64; 2],
}

impl PartialEq for RingState {
    fn eq(&self, other: &RingState) -> bool {
        [&self.w, &self.v, &self.a] == [&other.w, &other.v, &other.a]
    }
}

impl RingState {
    /// A state.
    pub fn new(w: Vec<f64>, v: Vec<f64>, a: Vec<f64>) -> RingState {
        RingState {
            w,
            v,
            a,
            measures: None,
        }
    }

    /// At rest, without acceleration, at the displacement `w`.
    pub fn at_rest(w: Vec<f64>) -> RingState {
        let zero = vec![0.0; w.len()];
        RingState::new(w, zero.clone(), zero)
    }

    /// Total displacement in the ring's frame.
    pub fn displacement(&self) -> &[f64] {
        &self.w
    }

    /// Velocity.
    pub fn velocity(&self) -> &[f64] {
        &self.v
    }

    /// Acceleration.
    pub fn acceleration(&self) -> &[f64] {
        &self.a
    }

    /// The same with another acceleration.
    pub fn with_acceleration(self, a: Vec<f64>) -> RingState {
        RingState { a, ..self }
    }

    /// Displacement, velocity, acceleration.
    pub fn into_parts(self) -> [Vec<f64>; 3] {
        [self.w, self.v, self.a]
    }

    /// What [`RingState::keep`] was given.
    pub(super) fn measures(&self) -> Option<&Measures> {
        self.measures.as_ref()
    }

    /// Keeps what follows from the state for the step that follows.
    pub(super) fn keep(&mut self, measures: Measures) {
        self.measures = Some(measures);
    }

    /// Displacement and velocity at the weighted time of the scheme when the step's increment is `dw`, or the velocity stays.
    pub fn within(&self, integrator: Integrator, dt: f64, dw: Option<&[f64]>) -> [Vec<f64>; 2] {
        let mut within = [vec![0.0; self.w.len()], vec![0.0; self.w.len()]];
        self.part_within(integrator, dt, dw, 0, &mut within);
        within
    }

    /// The same of the numbers from `first` on, as many as `within` has.
    pub(super) fn part_within(
        &self,
        integrator: Integrator,
        dt: f64,
        dw: Option<&[f64]>,
        first: usize,
        [w, v]: &mut [Vec<f64>; 2],
    ) {
        let s = 1.0 - integrator.alpha_f;
        let range = first..first + w.len();
        let (w0, v0, a0) = (
            &self.w[range.clone()],
            &self.v[range.clone()],
            &self.a[range.clone()],
        );
        let dw = dw.map(|dw| &dw[range]);
        for i in 0..w.len() {
            let d = dw.map_or(dt * v0[i], |dw| dw[i]);
            let [v1, _] = integrator.update(dt, d, v0[i], a0[i]);
            w[i] = w0[i] + s * d;
            v[i] = v0[i] + s * (v1 - v0[i]);
        }
    }

    /// The state at the end of a step with the increment `dw`.
    pub fn advanced(&self, integrator: Integrator, dt: f64, dw: &[f64]) -> RingState {
        let [mut w, mut v, mut a] = [(); 3].map(|()| vec![0.0; dw.len()]);
        let new = w.par_chunks_mut(TASK).zip(v.par_chunks_mut(TASK));
        let new = new.zip(a.par_chunks_mut(TASK));
        new.enumerate().for_each(|(task, ((w, v), a))| {
            self.advance_part(integrator, dt, dw, TASK * task, [w, v, a]);
        });
        RingState::new(w, v, a)
    }

    /// The same of the numbers from `first` on, as many as `w` has: new displacement, velocity, acceleration.
    pub(super) fn advance_part(
        &self,
        integrator: Integrator,
        dt: f64,
        dw: &[f64],
        first: usize,
        [w, v, a]: [&mut [f64]; 3],
    ) {
        let range = first..first + w.len();
        let (w0, v0, a0) = (
            &self.w[range.clone()],
            &self.v[range.clone()],
            &self.a[range.clone()],
        );
        for (i, &d) in dw[range].iter().enumerate() {
            [v[i], a[i]] = integrator.update(dt, d, v0[i], a0[i]);
            w[i] = w0[i] + d;
        }
    }
}
