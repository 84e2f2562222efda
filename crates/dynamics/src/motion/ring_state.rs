//! The part of the state that belongs to one ring.

use rayon::prelude::*;

use super::integrator::Integrator;

/// Numbers of one task of an update.
const TASK: usize = 1 << 14;

/// Displacement, velocity, acceleration of a ring in the space of its body ([`super::space`]), SI, of one length.
#[derive(Clone, Debug, Default)]
pub struct RingState {
    /// Total displacement in the ring's frame.
    w: Vec<f64>,
    /// Velocity.
    v: Vec<f64>,
    /// Acceleration.
    a: Vec<f64>,
    /// M v and K w once they are known. They follow from the state and are no part of it.
    products: Option<[Vec<f64>; 2]>,
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
            products: None,
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

    /// M v and K w, if [`RingState::keep_products`] was given them.
    pub(super) fn products(&self) -> Option<&[Vec<f64>; 2]> {
        self.products.as_ref()
    }

    /// Keeps M v and K w for the step that follows.
    pub(super) fn keep_products(&mut self, products: [Vec<f64>; 2]) {
        self.products = Some(products);
    }

    /// Displacement and velocity at the weighted time of the scheme when the step's increment is `dw`.
    pub fn within(&self, integrator: Integrator, dt: f64, dw: &[f64]) -> [Vec<f64>; 2] {
        let s = 1.0 - integrator.alpha_f;
        let (mut w, mut v) = (vec![0.0; dw.len()], vec![0.0; dw.len()]);
        let old = self.w.par_chunks(TASK).zip(self.v.par_chunks(TASK));
        let old = old.zip(self.a.par_chunks(TASK)).zip(dw.par_chunks(TASK));
        let new = w.par_chunks_mut(TASK).zip(v.par_chunks_mut(TASK));
        new.zip(old).for_each(|((w, v), (((w0, v0), a0), dw))| {
            for i in 0..dw.len() {
                let [v1, _] = integrator.update(dt, dw[i], v0[i], a0[i]);
                w[i] = w0[i] + s * dw[i];
                v[i] = v0[i] + s * (v1 - v0[i]);
            }
        });
        [w, v]
    }

    /// The state at the end of a step with the increment `dw`.
    pub fn advanced(&self, integrator: Integrator, dt: f64, dw: &[f64]) -> RingState {
        let [mut w, mut v, mut a] = [(); 3].map(|()| vec![0.0; dw.len()]);
        let old = self.w.par_chunks(TASK).zip(self.v.par_chunks(TASK));
        let old = old.zip(self.a.par_chunks(TASK)).zip(dw.par_chunks(TASK));
        let new = w.par_chunks_mut(TASK).zip(v.par_chunks_mut(TASK));
        let new = new.zip(a.par_chunks_mut(TASK));
        new.zip(old).for_each(|(((w, v), a), (((w0, v0), a0), dw))| {
            for i in 0..dw.len() {
                [v[i], a[i]] = integrator.update(dt, dw[i], v0[i], a0[i]);
                w[i] = w0[i] + dw[i];
            }
        });
        RingState::new(w, v, a)
    }
}
