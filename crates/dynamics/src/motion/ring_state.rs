//! The part of the state that belongs to one ring.

use super::integrator::Integrator;

/// Displacement, velocity, acceleration of a ring's coordinates, `[n]` each, SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RingState {
    /// Total displacement in the ring's frame.
    pub w: Vec<f64>,
    /// Velocity.
    pub v: Vec<f64>,
    /// Acceleration.
    pub a: Vec<f64>,
}

impl RingState {
    /// At rest, without acceleration, at the displacement `w`.
    pub fn at_rest(w: Vec<f64>) -> RingState {
        let zero = vec![0.0; w.len()];
        RingState {
            w,
            v: zero.clone(),
            a: zero,
        }
    }

    /// Displacement and velocity at the weighted time of the scheme when the step's increment is `dw`.
    pub fn within(&self, integrator: Integrator, dt: f64, dw: &[f64]) -> [Vec<f64>; 2] {
        let s = 1.0 - integrator.alpha_f;
        let w = self.w.iter().zip(dw).map(|(w, d)| w + s * d).collect();
        let v = self.v.iter().zip(&self.a).zip(dw).map(|((v0, a0), d)| {
            let [v1, _] = integrator.update(dt, *d, *v0, *a0);
            v0 + s * (v1 - v0)
        });
        [w, v.collect()]
    }
}
