//! Inertia of a rigid body of revolution on a shaft.

use body::CarriedInertia;

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

    /// Forces and moments that a frame asks for which turns about z with a speed, rad/s, and its rate, beyond the
    /// second derivatives: at the displacement `x` and the velocity `v` seen from it, N and N m. Of a free rotor (e.g.
    /// Genta, Dynamics of Rotating Systems, ch. 2).
    pub fn of_frame(&self, [speed, rate]: [f64; 2], x: [f64; 5], v: [f64; 5]) -> [f64; 5] {
        let (jx, jv) = (across(x), across(v));
        let polar = self.polar;
        // Terms with the speed, its square and its rate of a coordinate.
        let sum = |i: usize, [of_speed, of_square, of_rate]: [f64; 3]| {
            of_speed * speed * jv[i] + of_square * speed * speed * x[i] + of_rate * rate * jx[i]
        };
        let along = [0, 1, 2, 3, 4].map(|i| if i == 2 { 0.0 } else { sum(i, [2.0, -1.0, 1.0]) });
        let mut forces = self.times(along);
        for i in [3, 4] {
            forces[i] += sum(i, [-polar, polar, -polar]);
        }
        forces
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

/// J of both pairs of coordinates.
pub fn across(x: [f64; 5]) -> [f64; 5] {
    [-x[1], x[0], 0.0, -x[4], x[3]]
}
