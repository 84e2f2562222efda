//! Moments of loads on a shaft that tilts: what the finite rotation R of the shaft adds to those of the straight one.
//!
//! Forces F, fixed in space, act on points of the shaft at distances L from its origin. With the rotation vector phi of
//! R, two components, t = |phi| and m = sum of L F, their potential is
//!
//! ```text
//! -P,   P = m . R e_z = s (m_x phi_y - m_y phi_x) + m_z cos t,   s = sin(t)/t
//! ```
//!
//! and their moment dP/dphi, of which m x e_z is the linear part. A moment M fixed in space does the work of the body's
//! turning: on phi acts J^T M = M - e (t^2 M - phi (phi . M)), e = (t - sin t)/t^3, with the left Jacobian J of the
//! rotation. Over a step both are means over it, so that the work of forces is exactly the change of P.

use crate::system::{Interval, angle_functions};

/// Gauss points of a mean over a step.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// Loads on a shaft whose moments change with its tilt.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TiltedLoads {
    /// Forces times their distances from the shaft's origin, N m.
    pub lever: [f64; 3],
    /// Moments about x and y, N m, without those of these forces.
    pub moment: [f64; 2],
}

impl TiltedLoads {
    /// Those of generalised shaft loads of which forces have this lever; None if none depends on the tilt.
    pub fn new(shaft: &[f64; 5], lever: [f64; 3]) -> Option<TiltedLoads> {
        let moment = [shaft[3] + lever[1], shaft[4] - lever[0]];
        let loads = TiltedLoads { lever, moment };
        (loads != TiltedLoads::default()).then_some(loads)
    }

    /// Generalised loads on the shaft beyond those of the straight one, N and N m: at the end of an interval from one
    /// displacement to another, or their means over it.
    pub fn over(&self, interval: Interval, shaft: [[f64; 5]; 2]) -> [f64; 5] {
        let [start, end] = shaft.map(|[.., about_x, about_y]| [about_x, about_y]);
        let [about_x, about_y] = match interval {
            Interval::Rest => self.at(end),
            Interval::Step(_) => {
                let between = |share: f64| self.at([0, 1].map(|i| start[i] + share * (end[i] - start[i])));
                let [a, b] = GAUSS.map(between);
                [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
            }
        };
        [0.0, 0.0, 0.0, about_x, about_y]
    }

    /// Growth of the moments with the tilts, N m, by rows of moments.
    pub fn slopes(&self, tilt: [f64; 2]) -> [[f64; 2]; 2] {
        let step = 1e-6;
        let columns = [0, 1].map(|k| {
            let (mut low, mut high) = (tilt, tilt);
            (low[k], high[k]) = (low[k] - step, high[k] + step);
            let (low, high) = (self.at(low), self.at(high));
            [0, 1].map(|i| (high[i] - low[i]) / (2.0 * step))
        });
        [0, 1].map(|i| [columns[0][i], columns[1][i]])
    }

    /// Negative growth of the generalised loads with the displacements of the shaft: what they add to its stiffness.
    pub fn stiffness(&self, [.., about_x, about_y]: [f64; 5]) -> [[f64; 5]; 5] {
        let mut matrix = [[0.0; 5]; 5];
        for (row, slopes) in matrix[3..].iter_mut().zip(self.slopes([about_x, about_y])) {
            (row[3], row[4]) = (0.0 - slopes[0], 0.0 - slopes[1]);
        }
        matrix
    }

    /// What the virtual work of the forces through a tilt has more than the change of their potential, J.
    pub fn virtual_excess(&self, tilt: [f64; 2]) -> f64 {
        let square = tilt[0] * tilt[0] + tilt[1] * tilt[1];
        let [c, e] = angle_functions(square);
        let [x, y, z] = self.lever;
        let across = x * tilt[1] - y * tilt[0];
        // dP/dphi . phi - (P - P_0)
        let s = 1.0 - square * e;
        ((e - c) * across - z * s) * square + z * square * c
    }

    /// Beyond those of the straight shaft, N m.
    fn at(&self, tilt: [f64; 2]) -> [f64; 2] {
        let square = tilt[0] * tilt[0] + tilt[1] * tilt[1];
        let [c, e] = angle_functions(square);
        let [x, y, z] = self.lever;
        let across = x * tilt[1] - y * tilt[0];
        let along = tilt[0] * self.moment[0] + tilt[1] * self.moment[1];
        let s = 1.0 - square * e;
        let straight = [-y, x];
        [0, 1].map(|i| {
            let of_forces = -square * e * straight[i] + ((e - c) * across - z * s) * tilt[i];
            of_forces - e * (square * self.moment[i] - along * tilt[i])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::rotated;
    use ring::{Integrator, StepScheme};

    const LOADS: TiltedLoads = TiltedLoads {
        lever: [30.0, -12.0, 50.0],
        moment: [0.0; 2],
    };

    fn potential(tilt: [f64; 2]) -> f64 {
        let axis = rotated(tilt, [0.0, 0.0, 1.0]);
        (0..3).map(|i| LOADS.lever[i] * axis[i]).sum()
    }

    /// Wrong: a force at the end of a tilted shaft has another moment than its lever gives it. Against difference
    /// quotients of the work of the forces.
    #[test]
    fn moments_are_the_slopes_of_the_work() {
        for tilt in [[0.01, -0.02], [0.3, 0.4], [0.6, -0.3]] {
            let found = LOADS.at(tilt);
            for i in 0..2 {
                let (h, mut low, mut high) = (1e-5, tilt, tilt);
                (low[i], high[i]) = (low[i] - h, high[i] + h);
                let slope = (potential(high) - potential(low)) / (2.0 * h);
                let straight = [-LOADS.lever[1], LOADS.lever[0]];
                assert!((slope - straight[i] - found[i]).abs() < 1e-8, "{tilt:?} {i}");
            }
            let linear = -LOADS.lever[1] * tilt[0] + LOADS.lever[0] * tilt[1];
            let work = linear + found[0] * tilt[0] + found[1] * tilt[1];
            let excess = work - (potential(tilt) - LOADS.lever[2]);
            assert!((LOADS.virtual_excess(tilt) - excess).abs() < 1e-12, "{tilt:?}");
        }
    }

    /// Wrong: tilting would make or lose energy over a step.
    #[test]
    fn the_work_over_a_step_is_the_change_of_the_potential() {
        let step = Interval::Step(StepScheme {
            integrator: Integrator::average_acceleration(),
            dt: 1e-5,
        });
        let (start, end) = ([0.01, -0.02], [0.0103, -0.0198]);
        let shaft = |[x, y]: [f64; 2]| [0.0, 0.0, 0.0, x, y];
        let [.., x, y] = LOADS.over(step, [start, end].map(shaft));
        let work: f64 = (0..2)
            .map(|i| ([x, y][i] + [-LOADS.lever[1], LOADS.lever[0]][i]) * (end[i] - start[i]))
            .sum();
        assert!((work - potential(end) + potential(start)).abs() < 1e-14);
    }

    /// Wrong: a moment fixed in space would turn with the shaft. About its own axis it is what it is; across the tilt
    /// its work on phi is that of sin(t)/t.
    #[test]
    fn a_moment_in_space_acts_through_the_rotation() {
        let about = |moment: [f64; 2]| TiltedLoads {
            lever: [0.0; 3],
            moment,
        };
        let tilt: f64 = 0.4;
        assert!(about([5.0, 0.0]).at([tilt, 0.0])[0].abs() < 1e-15);
        let across = about([0.0, 5.0]).at([tilt, 0.0])[1];
        assert!(
            (across - 5.0 * (tilt.sin() / tilt - 1.0)).abs() < 1e-14,
            "{across}"
        );
    }
}
