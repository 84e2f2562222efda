//! Inertia of a ring as a rigid body of revolution.

pub use crate::inertia::{RigidInertia, across};

use body::BesideRing;

use crate::body::ElasticBody;
use crate::coordinates::RIGID_MOTIONS;
use crate::matrices::Matrix;

impl dyn ElasticBody + '_ {
    /// What the stress of the ring, turning with unit speed, holds against a rigid tilt, N m s^2: R K_1 R, the mean of
    /// both tilts about the centre of its groove circle. Of a ring that nothing holds it is half the polar moment of
    /// inertia; a bore that is held pulls on the ring as well. Zero where the stress does not stiffen it.
    pub fn tilt_by_stress(&self) -> f64 {
        let still = vec![0.0; self.held().coordinates.expanded()];
        let twice: f64 = [3, 4]
            .map(|k| {
                let mut q = [0.0; 5];
                q[k] = 1.0;
                let tilted = self.rigid_state((&still, BesideRing::default()), [q, [0.0; 5]], 0.0);
                let w = tilted.displacement();
                self.form(Matrix::Stress, w, w)
            })
            .iter()
            .sum();
        0.5 * twice
    }

    /// Inertia of the ring as a rigid body about the centre of its groove circle: of the mass matrix, with the means of
    /// x and y. Costs five products with that matrix. Collective.
    pub fn rigid_inertia(&self) -> RigidInertia {
        of_revolution(&self.rigid_rows())
    }

    /// How far the inertia of the ring as a rigid body is from that of a body of revolution in any motion across the
    /// axis, over mass and transverse moment of inertia. Cost as of its rigid inertia. Collective.
    pub fn unroundness(&self) -> f64 {
        let rows = self.rigid_rows();
        let round = of_revolution(&rows);
        let arm = (round.transverse / round.mass).sqrt();
        let unit = [1.0, 1.0, 1.0, arm, arm, arm];
        let of_row = |(row, k): (&[f64; 6], usize)| {
            let mut a = [0.0; 5];
            a[k] = 1.0;
            let expected = round.times(a);
            let off = |i: usize| (row[i] - expected[i]).abs() / (unit[i] * unit[k] * round.mass);
            [0, 1, 3, 4].map(off).into_iter().fold(0.0, f64::max)
        };
        rows[..4].iter().zip([0, 1, 3, 4]).map(of_row).fold(0.0, f64::max)
    }

    /// Forces in the sense of all rigid motions that the unit acceleration of one takes: of x, y, both tilts, spin.
    fn rigid_rows(&self) -> [[f64; 6]; 5] {
        let held = self.held();
        let motion = |x: [f64; 3], k: usize| {
            let mut q = [0.0; RIGID_MOTIONS];
            q[k] = 1.0;
            held.coordinates.whole_rigid_motion(x, q)
        };
        [0, 1, 3, 4, 5].map(|k: usize| {
            let field = held.places.field(|x| motion(x, k));
            let product = self.matrices().nodal_mass_product(&field);
            held.places.sum(|node, x| {
                let f = &product[3 * node..3 * node + 3];
                let along = |k: usize| -> f64 { motion(x, k).iter().zip(f).map(|(u, f)| u * f).sum() };
                [0, 1, 2, 3, 4, 5].map(along)
            })
        })
    }
}

/// The body of revolution with these forces, with the means of x and y.
fn of_revolution([x, y, tilt_x, tilt_y, spin]: &[[f64; 6]; 5]) -> RigidInertia {
    RigidInertia {
        mass: 0.5 * (x[0] + y[1]),
        first_moment: 0.5 * (x[4] - y[3]),
        transverse: 0.5 * (tilt_x[3] + tilt_y[4]),
        polar: spin[5],
    }
}
