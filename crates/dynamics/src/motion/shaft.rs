//! The shaft over one step: five dofs in space, each free or imposed, with its own mass.

use super::inertia::Inertia;
use crate::frame::turn;

/// The shaft over one step.
#[derive(Clone, Debug, PartialEq)]
pub struct ShaftStep {
    /// Inertia, start and load of every dof.
    pub bodies: [Inertia; 5],
    /// Displacement at the end of the step of the dofs that are imposed; None is free.
    pub imposed: [Option<f64>; 5],
    /// Angle of the inner ring's frame at the weighted time and at the end of the step, rad.
    pub frame: [f64; 2],
}

impl ShaftStep {
    /// Numbers of the free dofs, ascending.
    pub fn free(&self) -> Vec<usize> {
        (0..5).filter(|&i| self.imposed[i].is_none()).collect()
    }

    /// Displacement at the start, m and rad.
    pub fn start(&self) -> [f64; 5] {
        self.bodies.map(|b| b.start[0])
    }

    /// Displacement at the end when the free dofs, in their order, are `x`.
    pub fn end(&self, x: &[f64]) -> [f64; 5] {
        let mut unknown = x.iter();
        self.imposed.map(|value| {
            value.unwrap_or_else(|| *unknown.next().expect("there are as many unknowns as free dofs"))
        })
    }

    /// Displacement seen from the frame of the inner ring at the end of the step.
    pub fn in_frame(&self, q: [f64; 5]) -> [f64; 5] {
        turn(q, -self.frame[1])
    }

    /// Forces in the frame at the weighted time of the step as they act in space.
    pub fn in_space(&self, force: [f64; 5]) -> [f64; 5] {
        turn(force, self.frame[0])
    }
}
