//! Inertia of a ring as a rigid body of revolution.

use body::CarriedInertia;

use crate::body::ElasticBody;
use crate::coordinates::RIGID_MOTIONS;

/// Inertia of a rigid body of revolution about a point of its axis, the origin of the tilts.
///
/// Its kinetic energy at the velocity v and the tilt rate w, both across the axis, is m v^2 / 2 + S (v_x w_y - v_y
/// w_x) + I w^2 / 2, besides that of the spin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidInertia {
    /// Mass m, kg.
    pub mass: f64,
    /// First moment S: mass times the distance of its centre from the origin along z, kg m.
    pub first_moment: f64,
    /// Moment of inertia I about x and y through the origin, kg m^2.
    pub transverse: f64,
    /// Moment of inertia about z, kg m^2.
    pub polar: f64,
}

impl From<CarriedInertia> for RigidInertia {
    fn from(of: CarriedInertia) -> RigidInertia {
        RigidInertia {
            mass: of.mass,
            first_moment: of.first_moment,
            transverse: of.transverse,
            polar: of.polar,
        }
    }
}

impl RigidInertia {
    /// Force and moment that a rigid motion with the acceleration `a` (x, y, z, tilt x, tilt y) asks for, N and N m,
    /// without the spin.
    pub fn times(&self, a: [f64; 5]) -> [f64; 5] {
        [
            self.mass * a[0] + self.first_moment * a[4],
            self.mass * a[1] - self.first_moment * a[3],
            self.mass * a[2],
            self.transverse * a[3] - self.first_moment * a[1],
            self.transverse * a[4] + self.first_moment * a[0],
        ]
    }

    /// That of two bodies about the same origin.
    pub fn with(self, other: RigidInertia) -> RigidInertia {
        RigidInertia {
            mass: self.mass + other.mass,
            first_moment: self.first_moment + other.first_moment,
            transverse: self.transverse + other.transverse,
            polar: self.polar + other.polar,
        }
    }
}

impl dyn ElasticBody + '_ {
    /// Inertia of the ring as a rigid body about the centre of its groove circle: of the mass matrix, with the means of x and y. Costs five products with that matrix. Collective.
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
