//! The shaft over a part of a step, without its bearings.

use dynamics::stiffness::N_SHAFT;
use dynamics::system::Interval;
use ring::{Integrator, StepScheme};

use crate::loads::ShaftLoads;
use crate::newton::Mount;
use crate::shaft::{ShaftBody, times};

/// The shaft over a part of a step.
pub struct ShaftStep<'a> {
    /// The shaft.
    pub shaft: &'a ShaftBody,
    /// Where bearings hold it.
    pub mounts: &'a [Mount],
    /// Size of the part, s.
    pub dt: f64,
    /// Speeds of the shaft at both ends, rad/s.
    pub speeds: [f64; 2],
    /// Displacement and velocity at the start.
    pub start: [&'a [f64]; 2],
    /// Mean loads.
    pub load: ShaftLoads,
    /// Length by which tilts count, m.
    pub tilt_arm: f64,
}

impl ShaftStep<'_> {
    /// Where the shaft ends if it goes on as it moves; held dofs stay.
    pub fn guess(&self) -> Vec<f64> {
        let [q, v] = self.start;
        let held = &self.shaft.held;
        let end = |i: usize| held[i].unwrap_or(q[i] + self.dt * v[i]);
        (0..q.len()).map(end).collect()
    }

    /// Velocity at an end.
    pub fn velocity(&self, end: &[f64]) -> Vec<f64> {
        let [q, v] = self.start;
        let of = |i: usize| 2.0 * (end[i] - q[i]) / self.dt - v[i];
        (0..q.len()).map(of).collect()
    }

    /// Mean force of the spin, minus the change of its momentum over the part.
    pub fn spin_force(&self, end: &[f64]) -> Vec<f64> {
        let [from, to] = self.speeds;
        let change = |(q0, q1): (&f64, &f64)| (from * q0 - to * q1) / self.dt;
        let change: Vec<f64> = self.start[0].iter().zip(end).map(change).collect();
        times(self.shaft.n(), &self.shaft.gyroscopic, &change)
    }

    /// The part, over which forces are means.
    pub fn interval(&self) -> Interval {
        Interval::Step(StepScheme {
            integrator: Integrator::average_acceleration(),
            dt: self.dt,
        })
    }

    /// A load on a dof as a force, N.
    pub fn as_force(&self, dof: usize, load: f64) -> f64 {
        match dof % N_SHAFT {
            0..3 => load,
            _ => load / self.tilt_arm,
        }
    }

    /// Tangent of the shaft alone, row-major.
    pub fn own_tangent(&self) -> Vec<f64> {
        let (of_mass, of_spin) = (2.0 / (self.dt * self.dt), self.speeds[1] / self.dt);
        let ShaftBody {
            mass,
            gyroscopic,
            stiffness,
            ..
        } = self.shaft;
        let own = |k: usize| of_mass * mass[k] + of_spin * gyroscopic[k] + 0.5 * stiffness[k];
        (0..mass.len()).map(own).collect()
    }
}
