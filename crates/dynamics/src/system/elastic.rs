//! Elastic bodies as a system sees them: by the motion at their ports.

use crate::frame::turn;

/// An elastic body over an interval: at its ports it asks for the forces `at_forces` + K (g - offset) to move as g.
///
/// Ports that move freely come first and are unknowns. Those after them follow a lumped body, as the seat of a ring
/// follows its shaft, or are held: they have no unknowns, and what they ask for acts on what they follow.
#[derive(Clone, Debug, Default)]
pub struct ElasticPorts {
    /// What it is, for messages.
    pub name: &'static str,
    /// Motion at the start, m and rad, moving ports first.
    pub start: Vec<f64>,
    /// Motion of the moving ports from which Newton starts; none is that at the start.
    pub guess: Vec<f64>,
    /// Motion under `at_forces`.
    pub offset: Vec<f64>,
    /// Forces at which `offset` was found, N and N m; none are zeros.
    pub at_forces: Vec<f64>,
    /// Inverse compliance K, SI, row-major.
    pub stiffness: Vec<f64>,
    /// Number of ports that move freely.
    pub n_moving: usize,
    /// What the others follow; None: they are held.
    pub follow: Option<Follow>,
}

/// Ports that follow a lumped body whose coordinates are x, y, z and the tilts about x and y. A sixth port is the
/// rotation about z, which nothing turns in the frame of the elastic body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follow {
    /// Number of the lumped body.
    pub body: usize,
    /// Angle of the elastic body's frame at the weighted time and at the end of the step, rad.
    pub frame: [f64; 2],
}

impl Follow {
    /// Motion of the lumped body seen from the frame at the end of the step.
    pub fn in_frame(&self, q: [f64; 5]) -> [f64; 5] {
        turn(q, -self.frame[1])
    }

    /// Forces in the frame at the weighted time of the step as they act in space.
    pub fn in_space(&self, force: &[f64]) -> [f64; 5] {
        turn(first_five(force), self.frame[0])
    }

    /// Motion of `n` following ports with the coordinates `q`.
    pub(super) fn ports(&self, q: [f64; 5], n: usize) -> Vec<f64> {
        self.in_frame(q).into_iter().chain([0.0]).take(n).collect()
    }
}

impl ElasticPorts {
    /// Number of ports that follow.
    pub(super) fn n_following(&self) -> usize {
        self.offset.len() - self.n_moving
    }

    /// Forces that the body asks for to move as `g`, N and N m.
    pub fn forces(&self, g: &[f64]) -> Vec<f64> {
        let m = g.len();
        let off: Vec<f64> = g.iter().zip(&self.offset).map(|(g, p)| g - p).collect();
        let row = |i: usize| (0..m).map(|k| self.stiffness[m * i + k] * off[k]).sum();
        let mut forces: Vec<f64> = (0..m).map(row).collect();
        for (force, at) in forces.iter_mut().zip(&self.at_forces) {
            *force += at;
        }
        forces
    }

    /// Growth of the force at port `i` when the ports in `moved` grow by `slope`.
    pub(super) fn force_slope(&self, i: usize, moved: &[usize], slope: &[f64]) -> f64 {
        let row = &self.stiffness[slope.len() * i..];
        moved.iter().map(|&k| row[k] * slope[k]).sum()
    }
}

/// The first five entries; zeros when there are fewer.
fn first_five(values: &[f64]) -> [f64; 5] {
    [0, 1, 2, 3, 4].map(|i| values.get(i).copied().unwrap_or(0.0))
}
