//! Inertia of a ring as a rigid body of revolution.

pub use crate::inertia::{RigidInertia, across};

use crate::body::ElasticBody;
use crate::coordinates::RIGID_MOTIONS;

impl dyn ElasticBody + '_ {
    /// Inertia of the ring as a rigid body about the centre of its groove circle: of the mass matrix, with the means of
    /// x and y. Costs five products with that matrix. Collective.
    pub fn rigid_inertia(&self) -> RigidInertia {
        let held = self.held();
        let motion = |x: [f64; 3], k: usize| {
            let mut q = [0.0; RIGID_MOTIONS];
            q[k] = 1.0;
            held.coordinates.whole_rigid_motion(x, q)
        };
        // Forces in the sense of all rigid motions that the unit acceleration of one of them takes.
        let row = |k: usize| {
            let field = held.places.field(|x| motion(x, k));
            let product = self.matrices().nodal_mass_product(&field);
            held.places.sum(|node, x| {
                let f = &product[3 * node..3 * node + 3];
                let along = |k: usize| -> f64 { motion(x, k).iter().zip(f).map(|(u, f)| u * f).sum() };
                [0, 1, 2, 3, 4, 5].map(along)
            })
        };
        let [x, y, tilt_x, tilt_y, spin] = [0, 1, 3, 4, 5].map(row);
        RigidInertia {
            mass: 0.5 * (x[0] + y[1]),
            first_moment: 0.5 * (x[4] - y[3]),
            transverse: 0.5 * (tilt_x[3] + tilt_y[4]),
            polar: spin[5],
        }
    }
}
