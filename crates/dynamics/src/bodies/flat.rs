//! A lumped body whose coordinates are its own displacements, each free or imposed: shaft, ball.

use super::frame_inertia::FrameInertia;
use super::inertia::Inertia;
use super::large_tilt::LargeTilt;
use super::tilted_loads::TiltedLoads;
use crate::system::{Interval, Lumped};

/// Names of the coordinates of a shaft, as in the scene.
pub const AXES: [&str; 5] = ["x", "y", "z", "tilt_x", "tilt_y"];

/// Which body it is, for messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Name {
    /// The shaft, with the coordinates [`AXES`].
    Shaft,
    /// The seat of the outer ring, with the coordinates [`AXES`].
    Seat,
    /// A ball in its meridian plane: radial, axial.
    Ball(usize),
}

/// A body over an interval, coordinate by coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatBody<const N: usize> {
    name: Name,
    /// Inertia, start and load of each coordinate.
    pub dofs: [Inertia; N],
    /// Displacements at the end that are imposed; None is free.
    pub imposed: [Option<f64>; N],
    /// Of a shaft, the inertia of a ring that turns with it.
    pub turning: Option<Box<FrameInertia>>,
    /// Of a shaft that may tilt, its inertia and that of what is on it beyond small tilts.
    pub large_tilt: Option<Box<LargeTilt>>,
    /// Of a shaft that may tilt, loads whose moments change with that.
    pub tilted: Option<TiltedLoads>,
    start: [f64; N],
}

impl<const N: usize> FlatBody<N> {
    /// A body by coordinate.
    pub fn new(name: Name, dofs: [Inertia; N], imposed: [Option<f64>; N]) -> FlatBody<N> {
        FlatBody {
            name,
            start: dofs.map(|dof| dof.start[0]),
            dofs,
            imposed,
            turning: None,
            large_tilt: None,
            tilted: None,
        }
    }

    /// Forces that keep it on its course when it ends at `end`, less its loads: of its own inertia and of what turns
    /// with it.
    pub fn forces(&self, interval: Interval, end: &[f64]) -> [f64; N] {
        let mut forces = [0.0; N];
        for (i, (force, dof)) in forces.iter_mut().zip(&self.dofs).enumerate() {
            *force = dof.residual(interval, end[i])[0];
        }
        let end_five = five(end);
        let turning = self.turning.as_ref().map(|of| of.forces(end_five));
        let large = self.large_tilt.as_ref().map(|of| of.forces(end_five));
        for more in [turning, large].into_iter().flatten() {
            forces
                .iter_mut()
                .zip(more)
                .for_each(|(force, more)| *force += more);
        }
        let tilted = self.loads_by_tilt(interval, end);
        forces
            .iter_mut()
            .zip(tilted)
            .for_each(|(force, more)| *force -= more);
        forces
    }

    /// Its loads beyond those of the straight shaft when it ends at `end`, N and N m.
    pub fn loads_by_tilt(&self, interval: Interval, end: &[f64]) -> [f64; 5] {
        self.tilted.map_or([0.0; 5], |loads| {
            loads.over(interval, [five(&self.start), five(end)])
        })
    }

    /// Numbers of the free coordinates, ascending: those of the unknowns.
    pub fn free(&self) -> impl Iterator<Item = usize> {
        (0..N).filter(|&i| self.imposed[i].is_none())
    }
}

impl<const N: usize> Lumped for FlatBody<N> {
    fn n_coordinates(&self) -> usize {
        N
    }

    fn n_unknowns(&self) -> usize {
        self.free().count()
    }

    fn start(&self) -> &[f64] {
        &self.start
    }

    fn place(&self, x: &[f64], end: &mut [f64]) {
        let mut unknowns = x.iter();
        for (end, imposed) in end.iter_mut().zip(&self.imposed) {
            let mut free = || unknowns.next().copied().unwrap_or_default();
            *end = imposed.unwrap_or_else(&mut free);
        }
    }

    fn slopes(&self, _x: &[f64]) -> Vec<(usize, usize, f64)> {
        self.free()
            .enumerate()
            .map(|(unknown, i)| (i, unknown, 1.0))
            .collect()
    }

    fn guess(&self, interval: Interval) -> Vec<f64> {
        self.free().map(|i| self.dofs[i].guess(interval)).collect()
    }

    fn balance(&self, interval: Interval, x: &[f64], residual: &mut [f64]) {
        let mut end = [0.0; N];
        self.place(x, &mut end);
        let forces = self.forces(interval, &end);
        for (residual, i) in residual.iter_mut().zip(self.free()) {
            *residual = forces[i];
        }
    }

    fn tangent(&self, interval: Interval) -> Vec<f64> {
        let n = self.n_unknowns();
        let mut tangent = vec![0.0; n * n];
        for (k, i) in self.free().enumerate() {
            tangent[(n + 1) * k] = self.dofs[i].residual(interval, self.start[i])[1];
        }
        let turning = self.turning.as_ref().map(|of| of.slopes());
        let large = self.large_tilt.as_ref().map(|of| of.slopes());
        for slopes in [turning, large].into_iter().flatten() {
            for (row, i) in self.free().enumerate() {
                for (column, k) in self.free().enumerate() {
                    tangent[n * row + column] += slopes[k][i];
                }
            }
        }
        tangent
    }

    fn remedy(&self) -> &'static str {
        match self.name {
            Name::Shaft => {
                "give shaft.mass, of a tilt shaft.transverse_inertia, lock it in [shaft], or load the bearing so that \
                 balls touch"
            }
            Name::Seat => "give effects.spring_preload its mass or a stiffness, or start from equilibrium",
            Name::Ball(_) => "give the balls a density",
        }
    }

    fn name(&self, unknown: usize) -> String {
        let i = self.free().nth(unknown).unwrap_or_default();
        match self.name {
            Name::Shaft => format!("{} of the shaft", AXES[i]),
            Name::Seat => format!("{} of the outer ring's seat", AXES[i]),
            Name::Ball(ball) => format!("ball {ball}, {}", ["radial", "axial"][i]),
        }
    }
}

/// Coordinates as those of a shaft.
fn five(x: &[f64]) -> [f64; 5] {
    [0, 1, 2, 3, 4].map(|i| x.get(i).copied().unwrap_or_default())
}
