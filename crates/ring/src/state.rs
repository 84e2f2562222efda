//! The part of the state that belongs to one ring.

use std::sync::Arc;

use rayon::prelude::*;

use crate::integrator::StepScheme;
use crate::pool::PooledVector;
use crate::vectors::TASK;

/// Tells a state from others: what was found from a state belongs to it as long as the stamps are the same. A copy of
/// a state, which cannot change, has the stamp of the original.
#[derive(Clone, Debug, Default)]
pub struct Stamp(Arc<()>);

impl PartialEq for Stamp {
    fn eq(&self, other: &Stamp) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// Displacement, velocity, acceleration of a ring, vectors of its body ([`crate::body`]), SI, of one length.
#[derive(Clone, Debug, Default)]
pub struct RingState {
    /// Total displacement in the ring's frame.
    w: PooledVector,
    /// Velocity.
    v: PooledVector,
    /// Acceleration.
    a: PooledVector,
    body: Option<BodyState>,
    stamp: Stamp,
}

/// State of a body to which a ring is tied: displacement, velocity and acceleration of its oscillators, m kg^1/2.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyState(pub [Vec<f64>; 3]);

impl PartialEq for RingState {
    fn eq(&self, other: &RingState) -> bool {
        [&self.w, &self.v, &self.a] == [&other.w, &other.v, &other.a] && self.body == other.body
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
            body: None,
            stamp: Stamp::default(),
        }
    }

    /// The same ring, tied to a body in this state.
    pub fn with_body(self, body: Option<BodyState>) -> RingState {
        RingState { body, ..self }
    }

    /// State of the body to which it is tied.
    pub fn body(&self) -> Option<&BodyState> {
        self.body.as_ref()
    }

    /// Takes the state of that body.
    pub fn take_body(&mut self) -> Option<BodyState> {
        self.body.take()
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

    /// The same with the mean acceleration of a step of size dt to another state.
    pub fn with_mean_acceleration(self, end: &RingState, dt: f64) -> RingState {
        let mean = |old: &[f64], new: &[f64]| -> Vec<f64> {
            new.iter().zip(old).map(|(v1, v0)| (v1 - v0) / dt).collect()
        };
        let body = self.body.zip(end.body.as_ref()).map(|(old, new)| {
            let [w, v, _] = old.0;
            let a = mean(&v, &new.0[1]);
            BodyState([w, v, a])
        });
        RingState {
            a: PooledVector::from(mean(&self.v, &end.v)),
            body,
            stamp: Stamp::default(),
            w: self.w,
            v: self.v,
        }
    }

    /// The state with what `of` makes of its vectors, and the same body.
    pub(crate) fn with_vectors(mut self, of: impl Fn(Vec<f64>) -> Vec<f64>) -> RingState {
        let body = self.take_body();
        let [w, v, a] = self.into_parts().map(of);
        RingState::new(w, v, a).with_body(body)
    }

    /// Displacement, velocity, acceleration of the ring.
    pub fn into_parts(self) -> [Vec<f64>; 3] {
        [self.w, self.v, self.a].map(PooledVector::into_vec)
    }

    /// The same, borrowed.
    pub(crate) fn vectors(&self) -> [&[f64]; 3] {
        [&self.w, &self.v, &self.a]
    }

    /// The numbers from `first` on, `len` of each: displacement, velocity, acceleration.
    pub(crate) fn part(&self, first: usize, len: usize) -> [&[f64]; 3] {
        self.vectors().map(|x| &x[first..first + len])
    }

    /// Tells it from others.
    pub(crate) fn stamp(&self) -> &Stamp {
        &self.stamp
    }

    /// Displacement and velocity at the weighted time of the scheme when the step's increment is `dw`, or the
    /// acceleration stays.
    pub(crate) fn within(&self, scheme: StepScheme, dw: Option<&[f64]>) -> [Vec<f64>; 2] {
        let mut within = [vec![0.0; self.w.len()], vec![0.0; self.w.len()]];
        let to = within.each_mut().map(Vec::as_mut_slice);
        within_part(scheme, dw, self.part(0, self.w.len()), to);
        within
    }

    /// The state at the end of a step with the increment `dw`.
    pub(crate) fn advanced(&self, scheme: StepScheme, dw: &[f64]) -> RingState {
        let [mut w, mut v, mut a] = [(); 3].map(|()| vec![0.0; dw.len()]);
        let new = w.par_chunks_mut(TASK).zip(v.par_chunks_mut(TASK));
        let new = new.zip(a.par_chunks_mut(TASK)).zip(dw.par_chunks(TASK));
        new.enumerate().for_each(|(task, (((w, v), a), dw))| {
            advance_part(scheme, dw, self.part(TASK * task, dw.len()), [w, v, a]);
        });
        RingState::new(w, v, a)
    }
}

/// Values of displacement, velocity and acceleration on the rows of a defect.
#[derive(Clone, Debug)]
pub(crate) struct RowValues(pub [Vec<f64>; 3]);

/// Displacement and velocity at the weighted time of a step from `[w0, v0, a0]` with the increment `dw`, or at which
/// the acceleration stays.
pub(crate) fn within_part(
    StepScheme { integrator, dt }: StepScheme,
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
        None => each(start[1], start, to, |v0, start| {
            at(dt * (v0 + 0.5 * dt * start[2]), start)
        }),
    }
}

/// Displacement, velocity and acceleration at the end of a step from `[w0, v0, a0]` with the increment `dw`.
pub(crate) fn advance_part(
    StepScheme { integrator, dt }: StepScheme,
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
