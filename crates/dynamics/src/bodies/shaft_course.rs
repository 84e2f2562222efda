//! Displacement, velocity and acceleration of the shaft at the weighted time of a step.
//!
//! Schemes that conserve the energy, and Newmark's with the mean acceleration, take the velocity that does the work of
//! the step, its mean: what turns a momentum does none. Schemes that remember an acceleration balance at another time
//! than the middle, and there the mean is late or early by a share of a step: the moment of a spinning shaft then feeds
//! its nutation. They take the velocity at the weighted time, v[1-af] (Chung and Hulbert, J. Appl. Mech. 60 (1993)
//! 371).

use ring::StepScheme;

/// Displacement, velocity and acceleration.
pub type ShaftCourse = [[f64; 5]; 3];

/// What the shaft starts a step with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShaftStart {
    /// Displacement, velocity and acceleration of the shaft at the start, m and rad, and by s and s^2.
    pub start: ShaftCourse,
    /// Which dofs remember more than a mean velocity: those with inertia of their own.
    pub remembers: [bool; 5],
    /// The step.
    pub scheme: StepScheme,
}

impl ShaftStart {
    /// At the weighted time of the step, of values at the start and at the end.
    pub fn weighted(&self, [start, end]: [f64; 2]) -> f64 {
        let alpha = self.scheme.integrator.alpha_f;
        alpha * start + (1.0 - alpha) * end
    }

    /// Speed at the weighted time, and its rate, of speeds at the start and at the end.
    pub fn spin(&self, speeds: [f64; 2]) -> [f64; 2] {
        [self.weighted(speeds), (speeds[1] - speeds[0]) / self.scheme.dt]
    }

    /// Work of forces on the shaft over the step that ends at `q`, J.
    pub fn work(&self, forces: [f64; 5], q: [f64; 5]) -> f64 {
        (0..5).map(|i| forces[i] * (q[i] - self.start[0][i])).sum()
    }

    /// At the weighted time of the step that ends at `q`.
    pub fn course(&self, q: [f64; 5]) -> ShaftCourse {
        let all = [0, 1, 2, 3, 4];
        [
            all.map(|i| self.weighted([self.start[0][i], q[i]])),
            all.map(|i| self.velocity(i, q[i])),
            all.map(|i| self.acceleration(i, q[i])),
        ]
    }

    /// Whether velocities are means over the step.
    pub fn takes_means(&self) -> bool {
        let integrator = self.scheme.integrator;
        integrator.alpha_f == 0.5 || integrator.old == [0.0; 2]
    }

    fn velocity(&self, i: usize, end: f64) -> f64 {
        let StepScheme { integrator, dt } = self.scheme;
        let [x, v, a] = self.start.map(|all| all[i]);
        let mean = (end - x) / dt;
        match (self.takes_means(), self.remembers[i]) {
            (true, _) => mean,
            (false, true) => self.weighted([v, integrator.update(dt, end - x, v, a)[0]]),
            // Between the middles of two steps, and on.
            (false, false) => mean + (0.5 - integrator.alpha_f) * (mean - v),
        }
    }

    fn acceleration(&self, i: usize, end: f64) -> f64 {
        let StepScheme { integrator, dt } = self.scheme;
        let [x, v, a] = self.start.map(|all| all[i]);
        match self.remembers[i] {
            true => integrator.weighted_acceleration(dt, end - x, v, a)[0],
            false => ((end - x) / dt - v) / dt,
        }
    }
}
