//! The rigid motion nearest to that of a seat.
//!
//! It has the functions n <= 1, j <= 1 alone, as all others are orthogonal to rigid motions on the cylinder. Integrals
//! of products of these are exact with eight points round and two Gauss points across.

use std::f64::consts::TAU;

use crate::seat::{SeatBasis, SeatSpace};

const ROUND: usize = 8;
/// Gauss points across, in half widths.
const ACROSS: [f64; 2] = [-0.577_350_269_189_625_8, 0.577_350_269_189_625_8];

impl SeatSpace {
    /// Displacement of a place on the axis, m, and rotation, rad, of the rigid motion nearest to that of the seat,
    /// `motion` by function, m. The place is at z, m, in the coordinates of the ring.
    pub fn mean_motion(&self, motion: &[f64], z: f64) -> [f64; 6] {
        let [ux, uy, uz, rx, ry, rz] = match self.basis {
            SeatBasis::Rigid => std::array::from_fn(|k| motion[k]),
            _ => self.nearest_rigid(motion),
        };
        let arm = z - self.middle;
        [ux + ry * arm, uy - rx * arm, uz, rx, ry, rz]
    }

    /// The same about the middle of the seat: there rigid motions are orthogonal on the cylinder.
    fn nearest_rigid(&self, motion: &[f64]) -> [f64; 6] {
        let is_kept = |function: usize| {
            let of = self.basis.order_and_degree(function);
            of.is_some_and(|[order, degree]| order <= 1 && degree <= 1)
        };
        let (mut products, mut squares) = ([0.0; 6], [0.0; 6]);
        for i in 0..ROUND {
            let azimuth = TAU * i as f64 / ROUND as f64;
            let (sin, cos) = azimuth.sin_cos();
            for across in ACROSS {
                let phi = self.scalars(azimuth, across);
                let mut cylinder = [0.0; 3];
                for (function, value) in motion.iter().enumerate().filter(|(k, _)| is_kept(*k)) {
                    cylinder[function % 3] += value * phi[function / 3];
                }
                let [r, t, a] = cylinder;
                let moved = [r * cos - t * sin, r * sin + t * cos, a];
                let z = self.middle + across * self.half_width;
                let rigid = self.rigid_motions([self.radius * cos, self.radius * sin, z]);
                for k in 0..6 {
                    for c in 0..3 {
                        products[k] += moved[c] * rigid[c][k];
                        squares[k] += rigid[c][k] * rigid[c][k];
                    }
                }
            }
        }
        let unit = |k: usize| if k < 3 { 1.0 } else { 1.0 / self.radius };
        std::array::from_fn(|k| unit(k) * products[k] / squares[k])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: the mean motion of a seat that moves as a rigid body would be another motion, or waves would count.
    #[test]
    fn a_rigid_motion_is_its_own_mean_and_waves_have_none() {
        let space = SeatSpace {
            basis: SeatBasis::Harmonics {
                harmonics: 3,
                across: 2,
            },
            middle: 2e-3,
            half_width: 8e-3,
            radius: 25e-3,
            crest: 0.0,
        };
        let moved = [1e-6, -2e-6, 3e-6, 4e-5, -5e-5, 6e-5];
        // Its functions, by projection on a fine grid.
        let (n, n_round, n_across) = (space.basis.n_functions() / 3, 64, 400);
        let (mut sums, mut squares) = (vec![0.0; 3 * n], vec![0.0; n]);
        for i in 0..n_round {
            let azimuth = TAU * i as f64 / n_round as f64;
            let (sin, cos) = azimuth.sin_cos();
            for j in 0..n_across {
                let across = (2.0 * j as f64 + 1.0) / n_across as f64 - 1.0;
                let z = space.middle + across * space.half_width;
                let motions = space.rigid_motions([space.radius * cos, space.radius * sin, z]);
                let arm = |k: usize| if k < 3 { moved[k] } else { space.radius * moved[k] };
                let [x, y, a] = motions.map(|row| (0..6).map(|k| row[k] * arm(k)).sum::<f64>());
                let cylinder = [x * cos + y * sin, y * cos - x * sin, a];
                for (k, phi) in space.scalars(azimuth, across).into_iter().enumerate() {
                    squares[k] += phi * phi;
                    (0..3).for_each(|c| sums[3 * k + c] += phi * cylinder[c]);
                }
            }
        }
        let mut motion: Vec<f64> = (0..3 * n).map(|i| sums[i] / squares[i / 3]).collect();
        for (i, value) in motion.iter_mut().enumerate() {
            let [order, degree] = space.basis.order_and_degree(i).unwrap();
            if order > 1 || degree > 1 {
                *value += 1e-5;
            }
        }
        let found = space.mean_motion(&motion, space.middle);
        for (found, expected) in found.into_iter().zip(moved) {
            assert!(
                (found - expected).abs() < 1e-4 * expected.abs(),
                "{found} {expected}"
            );
        }
        let there = space.mean_motion(&motion, space.middle + 0.1);
        assert!((there[0] - (found[0] + 0.1 * found[4])).abs() < 1e-18);
        assert!((there[1] - (found[1] - 0.1 * found[3])).abs() < 1e-18);
    }
}
