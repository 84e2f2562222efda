//! Inertia of a body in a frame that turns about z with its shaft.
//!
//! For displacements u = U xi in a frame with the speed W, linear in u (e.g. Genta, Dynamics of Rotating Systems),
//!
//! ```text
//! f = -(2 W G xi' - W^2 P xi + W' G xi),     G = U^T M J U,   P = U^T M (x, y, 0 of U),   J u = (-u_y, u_x, 0)
//! ```
//!
//! U has the rigid motions of the shaft in it. What a rigid tilt takes beyond, because it moves places towards the axis
//! to second order, is that of the whole shaft (`dynamics::bodies::frame_inertia`). The elastic part leaves that out.

use crate::carried::{combined, dot};

/// The forms of the frame over the oscillators, `[n][n]` flat, by columns.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameForms {
    /// G.
    pub(crate) across: Vec<f64>,
    /// P.
    pub(crate) radial: Vec<f64>,
}

impl FrameForms {
    /// Makes the forms of `n` oscillators skew and symmetric, as they are but for round-off: the terms with the speed
    /// do no work then.
    pub(crate) fn remove_round_off(&mut self, n: usize) {
        for i in 0..n {
            for j in 0..=i {
                let [a, b] = [self.across[n * i + j], self.across[n * j + i]];
                (self.across[n * i + j], self.across[n * j + i]) = (0.5 * (a - b), 0.5 * (b - a));
                let mean = 0.5 * (self.radial[n * i + j] + self.radial[n * j + i]);
                (self.radial[n * i + j], self.radial[n * j + i]) = (mean, mean);
            }
        }
    }

    /// Loads on the oscillators at a speed, rad/s, and its rate, where they stand at `x` and move with `v`.
    pub fn load(&self, [speed, rate]: [f64; 2], x: &[f64], v: &[f64]) -> Vec<f64> {
        let pairs = x.iter().zip(v);
        let across: Vec<f64> = pairs.map(|(x, v)| -2.0 * speed * v - rate * x).collect();
        let radial: Vec<f64> = x.iter().map(|x| speed * speed * x).collect();
        let mut load = combined(&self.across, &across);
        let of_radius = combined(&self.radial, &radial);
        load.iter_mut().zip(of_radius).for_each(|(f, p)| *f += p);
        load
    }

    /// G and P of the first `n` oscillators, row-major.
    pub fn of_first(&self, n: usize) -> [Vec<f64>; 2] {
        let all = self.across.len().isqrt();
        [&self.across, &self.radial].map(|by_columns| {
            let entry = |k: usize| by_columns[all * (k % n) + k / n];
            (0..n * n).map(entry).collect()
        })
    }

    /// Velocities in the frame of oscillators that stand still in space.
    pub fn standing(&self, speed: f64, x: &[f64]) -> Vec<f64> {
        let turned: Vec<f64> = x.iter().map(|x| -speed * x).collect();
        combined(&self.across, &turned)
    }

    /// Bytes.
    pub fn bytes(&self) -> usize {
        size_of::<f64>() * (self.across.len() + self.radial.len())
    }
}

/// Length of a vector.
pub fn length(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}
