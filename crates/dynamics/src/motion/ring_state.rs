//! The part of the state that belongs to one ring.

use std::sync::Arc;

use rayon::prelude::*;

use super::ahead::Known;
use super::integrator::Integrator;
use super::pool::PooledVector;
use super::space_defect::RowValues;
use super::vectors::TASK;

/// Displacement, velocity, acceleration of a ring in the space of its body ([`super::space`]), SI, of one length.
#[derive(Clone, Debug, Default)]
pub struct RingState {
    /// Total displacement in the ring's frame.
    w: PooledVector,
    /// Velocity.
    v: PooledVector,
    /// Acceleration.
    a: PooledVector,
    /// Kinetic and strain energy, J, once they are known; no part of the state.
    energies: Option<[f64; 2]>,
    /// What the step from here begins with, where the step before has found it; no part of the state.
    known: Option<Arc<Known>>,
    /// Values on the rows of a defect, once they are found; no part of the state.
    row_values: Option<Arc<RowValues>>,
}

impl PartialEq for RingState {
    fn eq(&self, other: &RingState) -> bool {
        [&self.w, &self.v, &self.a] == [&other.w, &other.v, &other.a]
    }
}

impl RingState {
    /// A state.
    pub fn new<V: Into<PooledVector>>(w: V, v: V, a: V) -> RingState {
        let [w, v, a] = [w, v, a].map(V::into);
        RingState {
            w,
            v,
            a,
            energies: None,
            known: None,
            row_values: None,
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
        RingState {
            a: PooledVector::from(a),
            row_values: None,
            ..self
        }
    }

    /// Displacement, velocity, acceleration.
    pub fn into_parts(self) -> [Vec<f64>; 3] {
        [self.w, self.v, self.a].map(PooledVector::into_vec)
    }

    /// The same, borrowed.
    pub(super) fn vectors(&self) -> [&[f64]; 3] {
        [&self.w, &self.v, &self.a]
    }

    /// The numbers from `first` on, `len` of each: displacement, velocity, acceleration.
    pub(super) fn part(&self, first: usize, len: usize) -> [&[f64]; 3] {
        self.vectors().map(|x| &x[first..first + len])
    }

    /// Kinetic and strain energy, J, where they are known.
    pub(super) fn energies(&self) -> Option<[f64; 2]> {
        self.energies
    }

    /// Keeps the energies.
    pub(super) fn keep(&mut self, energies: [f64; 2]) {
        self.energies = Some(energies);
    }

    /// Values on the rows of a defect, where they are known.
    pub(super) fn row_values(&self) -> Option<&RowValues> {
        self.row_values.as_deref()
    }

    /// Keeps the values on the rows of a defect.
    pub(super) fn keep_rows(&mut self, values: RowValues) {
        self.row_values = Some(Arc::new(values));
    }

    /// What [`RingState::foresee`] was given.
    pub(super) fn known(&self) -> Option<&Arc<Known>> {
        self.known.as_ref()
    }

    /// Keeps what the step from here begins with.
    pub(super) fn foresee(&mut self, known: Arc<Known>) {
        self.known = Some(known);
    }

    /// Displacement and velocity at the weighted time of the scheme when the step's increment is `dw`, or the velocity stays.
    pub fn within(&self, integrator: Integrator, dt: f64, dw: Option<&[f64]>) -> [Vec<f64>; 2] {
        let mut within = [vec![0.0; self.w.len()], vec![0.0; self.w.len()]];
        let to = within.each_mut().map(Vec::as_mut_slice);
        within_part(integrator, dt, dw, self.part(0, self.w.len()), to);
        within
    }

    /// The state at the end of a step with the increment `dw`.
    pub fn advanced(&self, integrator: Integrator, dt: f64, dw: &[f64]) -> RingState {
        let [mut w, mut v, mut a] = [(); 3].map(|()| vec![0.0; dw.len()]);
        let new = w.par_chunks_mut(TASK).zip(v.par_chunks_mut(TASK));
        let new = new.zip(a.par_chunks_mut(TASK)).zip(dw.par_chunks(TASK));
        new.enumerate().for_each(|(task, (((w, v), a), dw))| {
            advance_part(integrator, dt, dw, self.part(TASK * task, dw.len()), [w, v, a]);
        });
        RingState::new(w, v, a)
    }
}

/// Displacement and velocity at the weighted time of a step from `[w0, v0, a0]` with the increment `dw`, or at which the velocity stays.
pub(super) fn within_part(
    integrator: Integrator,
    dt: f64,
    dw: Option<&[f64]>,
    start: [&[f64]; 3],
    to: [&mut [f64]; 2],
) {
    let s = 1.0 - integrator.alpha_f;
    let at = |d: f64, [w0, v0, a0]: [f64; 3]| {
        let [v1, _] = integrator.update(dt, d, v0, a0);
        [w0 + s * d, v0 + s * (v1 - v0)]
    };
    match dw {
        Some(dw) => each(dw, start, to, at),
        None => each(start[1], start, to, |v0, start| at(dt * v0, start)),
    }
}

/// Displacement, velocity and acceleration at the end of a step from `[w0, v0, a0]` with the increment `dw`.
pub(super) fn advance_part(
    integrator: Integrator,
    dt: f64,
    dw: &[f64],
    start: [&[f64]; 3],
    to: [&mut [f64]; 3],
) {
    each(dw, start, to, |d, [w0, v0, a0]| {
        let [v, a] = integrator.update(dt, d, v0, a0);
        [w0 + d, v, a]
    });
}

/// Numbers that are read before any is written, so that the processor's vectors take them.
const TOGETHER: usize = 8;

/// The results `of` each number of x and of the start.
#[inline(always)]
fn each<const R: usize>(
    x: &[f64],
    start: [&[f64]; 3],
    mut to: [&mut [f64]; R],
    of: impl Fn(f64, [f64; 3]) -> [f64; R],
) {
    let end = x.len() - x.len() % TOGETHER;
    for first in (0..end).step_by(TOGETHER) {
        let range = first..first + TOGETHER;
        let x: &[f64; TOGETHER] = x[range.clone()].try_into().expect("as many numbers");
        let start: [&[f64; TOGETHER]; 3] =
            start.map(|s| s[range.clone()].try_into().expect("as many numbers"));
        let mut results = [[0.0; TOGETHER]; R];
        for i in 0..TOGETHER {
            let found = of(x[i], [start[0][i], start[1][i], start[2][i]]);
            (0..R).for_each(|r| results[r][i] = found[r]);
        }
        for (to, results) in to.iter_mut().zip(&results) {
            to[range.clone()].copy_from_slice(results);
        }
    }
    for i in end..x.len() {
        let found = of(x[i], start.map(|s| s[i]));
        (0..R).for_each(|r| to[r][i] = found[r]);
    }
}
