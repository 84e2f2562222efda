//! The rigid motions of a body that a shaft carries, beside the coordinates of its reduction.

use rayon::prelude::*;

use crate::carried::{Carried, N_SHAFT, dot};

/// The rigid motions of a body that a shaft carries.
pub(crate) struct RigidPart<'a> {
    pub carried: &'a Carried,
    /// Q, by rigid oscillator.
    pub motions: [[f64; N_SHAFT]; N_SHAFT],
    /// W, by coordinate.
    pub coupling: Vec<[f64; N_SHAFT]>,
}

impl<'a> RigidPart<'a> {
    pub fn new(carried: &'a Carried, shapes: &[&[f64]]) -> RigidPart<'a> {
        let motions = carried.orthonormal();
        let coupled = |shape: &&[f64]| {
            let pushed = [0, 1, 2, 3, 4].map(|k| dot(&carried.pushes[k], shape));
            motions.map(|motion| dot(&motion, &pushed))
        };
        RigidPart {
            carried,
            motions,
            coupling: shapes.par_iter().map(coupled).collect(),
        }
    }

    /// Rigid oscillators of a displacement of the free dofs that the shaft does not take along, m.
    pub fn momentum(&self, moved: &[f64]) -> [f64; N_SHAFT] {
        let pushed = [0, 1, 2, 3, 4].map(|k| dot(&self.carried.pushes[k], moved));
        self.motions.each_ref().map(|motion| dot(motion, &pushed))
    }

    /// Takes the momentum of the coordinates out of their mass, by rows of its lower triangle.
    pub fn relieve(&self, lower: &mut [Vec<f64>]) {
        for (i, row) in lower.iter_mut().enumerate() {
            let others = self.coupling.iter();
            row.iter_mut()
                .zip(others)
                .for_each(|(m, w)| *m -= dot(&self.coupling[i], w));
        }
    }

    /// Motion of the shaft that coordinates take along.
    pub fn taken_along(&self, coordinates: &[f64]) -> [f64; N_SHAFT] {
        let mut q = [0.0; N_SHAFT];
        for (w, z) in self.coupling.iter().zip(coordinates) {
            for (motion, w) in self.motions.iter().zip(w) {
                (0..N_SHAFT).for_each(|k| q[k] -= motion[k] * w * z);
            }
        }
        q
    }
}
