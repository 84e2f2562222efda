//! A point mass or rigid body dof over one step.

use ring::{Integrator, StepScheme};

use crate::system::Interval;

/// A point mass or rigid body dof over one step, by the rings' integrator.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inertia {
    /// Mass or moment of inertia, kg or kg m^2.
    pub mass: f64,
    /// Displacement, velocity and acceleration at the start.
    pub start: [f64; 3],
    /// Load at the weighted time of the step.
    pub load: f64,
    /// Load per unit of weighted displacement (ball centrifugal force), N/m.
    pub load_slope: f64,
}

impl Inertia {
    /// Load at the end displacement `x`.
    pub fn load_at(&self, scheme: Integrator, x: f64) -> f64 {
        self.load + self.load_slope * (scheme.alpha_f * self.start[0] + (1.0 - scheme.alpha_f) * x)
    }

    /// Displacement at the end when nothing accelerates.
    pub fn guess(&self, interval: Interval) -> f64 {
        match interval {
            Interval::Rest => self.start[0],
            Interval::Step(step) => self.start[0] + step.dt * self.start[1],
        }
    }

    /// Out-of-balance force at displacement `x` and its derivative.
    pub fn residual(&self, interval: Interval, x: f64) -> [f64; 2] {
        let [x0, v0, a0] = self.start;
        let StepScheme {
            integrator: scheme,
            dt,
        } = match interval {
            Interval::Rest => return [-(self.load + self.load_slope * x), -self.load_slope],
            Interval::Step(step) => step,
        };
        let [acceleration, slope] = scheme.weighted_acceleration(dt, x - x0, v0, a0);
        [
            self.mass * acceleration - self.load_at(scheme, x),
            self.mass * slope - (1.0 - scheme.alpha_f) * self.load_slope,
        ]
    }

    /// Velocity and acceleration at the end; without mass nothing is remembered but the mean velocity.
    pub fn update(&self, scheme: Integrator, x: f64, dt: f64) -> [f64; 2] {
        let [x0, v0, a0] = self.start;
        if self.mass > 0.0 {
            scheme.update(dt, x - x0, v0, a0)
        } else {
            [(x - x0) / dt, 0.0]
        }
    }

    /// The same under the force of all else on it at the weighted time of the step, N, when it ends at `x`: what Newton
    /// leaves of the balance then stays in the place, and no momentum is lost to it.
    pub fn update_under(
        &self,
        StepScheme {
            integrator: scheme,
            dt,
        }: StepScheme,
        force: f64,
        x: f64,
    ) -> [f64; 2] {
        if self.mass == 0.0 {
            return self.update(scheme, x, dt);
        }
        let [_, v0, a0] = self.start;
        let acceleration = (self.load_at(scheme, x) + force) / self.mass;
        scheme.update_by(dt, acceleration, v0, a0)
    }

    /// Energy that the scheme takes from the body, J: work of its inertia less the gain of kinetic energy.
    pub fn numerical_loss(&self, scheme: Integrator, x: f64, dt: f64) -> f64 {
        if self.mass == 0.0 || scheme.is_conserving() {
            return 0.0;
        }
        let [x0, v0, a0] = self.start;
        let [v1, _] = scheme.update(dt, x - x0, v0, a0);
        let [acceleration, _] = scheme.weighted_acceleration(dt, x - x0, v0, a0);
        self.mass * (acceleration * (x - x0) - 0.5 * (v1 + v0) * (v1 - v0))
    }
}
