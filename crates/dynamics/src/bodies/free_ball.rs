//! A free ball over a step: six dofs in space.
//!
//! ```text
//! x1 = x0 + h (v0 + v1)/2,   m (v1 - v0) = h F,   J (omega1 - omega0) = h M,   J = 2/5 m r^2
//! ```
//!
//! Coordinates are displacement and rotation vector since the start of the step, u = x1 - x0 and theta = h (omega0 +
//! omega1)/2, so that nothing is lost to the size of the orbit. The inertia of a sphere is the same about all axes: in
//! space there is no gyroscopic term, and centrifugal force is the inertia of a straight course. m v_mean . (v1 - v0)
//! and J omega_mean . (omega1 - omega0) are exactly the changes of kinetic energy.
//!
//! Drag -c |v| v takes the mean velocity, u/h. Newton's tangent leaves it out: c |v| h / m is below 1e-3.

use super::UNMOVED;
use crate::model::BallInertia;
use crate::system::{Interval, Lumped};

/// A free ball over a step.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeBall {
    /// Its number.
    pub ball: usize,
    /// Its inertia.
    pub inertia: BallInertia,
    /// Place at the start, m.
    pub place: [f64; 3],
    /// Velocity at the start, m/s.
    pub velocity: [f64; 3],
    /// Angular velocity at the start, rad/s.
    pub turning: [f64; 3],
    /// Change of velocity and angular velocity in the last step beyond the turning round the axis, over its time, m/s^2
    /// and rad/s^2: what the guess goes on with.
    pub trend: [[f64; 3]; 2],
    /// Mean load, N.
    pub load: [f64; 3],
    /// Drag over the square of the speed, N s^2/m^2.
    pub drag: f64,
    /// Step size, s.
    pub dt: f64,
}

impl FreeBall {
    /// Velocity and angular velocity at the end for the coordinates `x`.
    pub fn velocities(&self, x: &[f64]) -> [[f64; 3]; 2] {
        let at_end =
            |first: usize, start: [f64; 3]| [0, 1, 2].map(|i| 2.0 * x[first + i] / self.dt - start[i]);
        [at_end(0, self.velocity), at_end(3, self.turning)]
    }

    /// Velocity and angular velocity at the end if they only turned round the axis with the orbit.
    fn turned(&self) -> [[f64; 3]; 2] {
        let [x, y, _] = self.place;
        let square = x * x + y * y;
        let orbit = if square > 0.0 {
            (x * self.velocity[1] - y * self.velocity[0]) / square
        } else {
            0.0
        };
        let (sin, cos) = (self.dt * orbit).sin_cos();
        [self.velocity, self.turning].map(|v| [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1], v[2]])
    }

    /// [`FreeBall::trend`] of the next step for the coordinates `x`.
    pub fn next_trend(&self, x: &[f64]) -> [[f64; 3]; 2] {
        let (end, turned) = (self.velocities(x), self.turned());
        [0, 1].map(|k| [0, 1, 2].map(|i| (end[k][i] - turned[k][i]) / self.dt))
    }

    /// Place at the end for the coordinates `x`.
    pub fn end(&self, x: &[f64]) -> [f64; 3] {
        [0, 1, 2].map(|i| self.place[i] + x[i])
    }

    /// Energy that drag takes for the coordinates `x`, J.
    pub fn drag_loss(&self, x: &[f64]) -> f64 {
        let drag = self.drag_force(x);
        drag.iter().zip(x).map(|(f, u)| f * u).sum()
    }

    /// Force that drag asks for, N.
    fn drag_force(&self, x: &[f64]) -> [f64; 3] {
        let mean = [0, 1, 2].map(|i| x[i] / self.dt);
        let speed = mean.iter().map(|v| v * v).sum::<f64>().sqrt();
        mean.map(|v| self.drag * speed * v)
    }

    /// Work of its load for the coordinates `x`, J.
    pub fn load_work(&self, x: &[f64]) -> f64 {
        self.load.iter().zip(x).map(|(f, u)| f * u).sum()
    }
}

impl Lumped for FreeBall {
    fn n_unknowns(&self) -> usize {
        6
    }

    fn start(&self) -> &[f64] {
        &UNMOVED
    }

    /// The course goes on round the axis with the orbit's speed, and changes as in the last step.
    fn guess(&self, _interval: Interval) -> Vec<f64> {
        let turned = self.turned();
        let mean = |k: usize, v: [f64; 3]| {
            [0, 1, 2].map(|i| 0.5 * self.dt * (v[i] + turned[k][i] + self.dt * self.trend[k][i]))
        };
        [mean(0, self.velocity), mean(1, self.turning)].concat()
    }

    fn balance(&self, _interval: Interval, x: &[f64], residual: &mut [f64]) {
        let [velocity, turning] = self.velocities(x);
        let (BallInertia { mass, moment }, drag) = (self.inertia, self.drag_force(x));
        for i in 0..3 {
            residual[i] = mass * (velocity[i] - self.velocity[i]) / self.dt - self.load[i] + drag[i];
            residual[3 + i] = moment * (turning[i] - self.turning[i]) / self.dt;
        }
    }

    fn tangent(&self, _interval: Interval) -> Vec<f64> {
        let mut tangent = vec![0.0; 36];
        for i in 0..3 {
            tangent[7 * i] = 2.0 * self.inertia.mass / (self.dt * self.dt);
            tangent[7 * (3 + i)] = 2.0 * self.inertia.moment / (self.dt * self.dt);
        }
        tangent
    }

    fn remedy(&self) -> &'static str {
        "give the balls a density"
    }

    fn name(&self, unknown: usize) -> String {
        let name = [
            "x",
            "y",
            "z",
            "rotation about x",
            "rotation about y",
            "rotation about z",
        ][unknown];
        format!("ball {}, {name}", self.ball)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a step would make or lose kinetic energy, or forget a load. Force and moment of the balance times the
    /// motion are the change of kinetic energy less the work of the load and of drag.
    #[test]
    fn forces_over_a_step_are_its_change_of_energy() {
        let ball = FreeBall {
            ball: 3,
            inertia: BallInertia {
                mass: 3e-3,
                moment: 2.4e-8,
            },
            place: [0.03, 0.01, 0.0],
            velocity: [0.7, -2.0, 0.1],
            turning: [100.0, -20.0, 600.0],
            trend: [[0.0; 3]; 2],
            load: [0.2, -0.4, 0.1],
            drag: 0.03,
            dt: 1e-5,
        };
        let x = [7.1e-6, -1.9e-5, 1.3e-6, 1.1e-3, -2e-4, 5.9e-3];
        let mut residual = [0.0; 6];
        ball.balance(Interval::Rest, &x, &mut residual);
        let work: f64 = residual.iter().zip(x).map(|(f, u)| f * u).sum();
        let energy = |v: [f64; 3], w: [f64; 3]| {
            let square = |a: [f64; 3]| a.iter().map(|x| x * x).sum::<f64>();
            0.5 * (ball.inertia.mass * square(v) + ball.inertia.moment * square(w))
        };
        let [v, w] = ball.velocities(&x);
        let gain = energy(v, w) - energy(ball.velocity, ball.turning);
        assert!((work + ball.load_work(&x) - ball.drag_loss(&x) - gain).abs() < 1e-12 * energy(v, w));
    }
}
