//! The inner contact of a ball in space, by matrices: written anew, without what the program uses.

use contact::Side;
use dynamics::{Model, StaticSolution};

/// Rotation matrix of the rotation vector (x, y, 0), row by row: Rodrigues.
pub fn rotation([x, y]: [f64; 2]) -> [[f64; 3]; 3] {
    let angle = x.hypot(y);
    let scale = |f: f64, n: i32| if angle > 0.0 { f / angle.powi(n) } else { 0.0 };
    let (s, c) = (scale(angle.sin(), 1), scale(1.0 - angle.cos(), 2));
    let k = [[0.0, 0.0, y], [0.0, 0.0, -x], [-y, x, 0.0]];
    let mut r = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            let square: f64 = (0..3).map(|l| k[i][l] * k[l][j]).sum();
            r[i][j] = f64::from(i == j) + s * k[i][j] + c * square;
        }
    }
    r
}

/// Matrix times vector.
pub fn times(r: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| (0..3).map(|j| r[i][j] * v[j]).sum())
}

/// Vector product.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// What a moment in space does on the components x and y of the rotation vector: m . J e_k, J = I + c K + e K^2.
pub fn on_tilts(tilt: [f64; 2], m: [f64; 3]) -> [f64; 2] {
    let angle = tilt[0].hypot(tilt[1]);
    let (c, e) = if angle > 0.0 {
        (
            (1.0 - angle.cos()) / angle.powi(2),
            (angle - angle.sin()) / angle.powi(3),
        )
    } else {
        (0.5, 1.0 / 6.0)
    };
    let phi = [tilt[0], tilt[1], 0.0];
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(|axis| {
        let once = cross(phi, axis);
        let twice = cross(phi, once);
        (0..3)
            .map(|i| m[i] * (axis[i] + c * once[i] + e * twice[i]))
            .sum()
    })
}

/// What a ball sees of the circle of groove centres of a ring that has moved.
pub struct SeenCircle {
    /// From the ring's origin to the point that it sees, m, in space.
    pub arm: [f64; 3],
    /// Unit tangent of the circle there; None of a point of the ring that is projected.
    tangent: Option<[f64; 3]>,
    /// Direction in which the ball's meridian plane is left.
    beside: [f64; 3],
}

impl SeenCircle {
    /// Of a circle of this radius, turned and moved, from the plane at an azimuth, by Newton's method round the circle;
    /// or the point at that azimuth of the ring.
    pub fn new(
        turned: &[[f64; 3]; 3],
        moved: [f64; 3],
        radius: f64,
        azimuth: f64,
        projected: bool,
    ) -> SeenCircle {
        let (sin, cos) = azimuth.sin_cos();
        let beside = [-sin, cos, 0.0];
        let mut angle = azimuth;
        let at = |angle: f64| {
            let (sin, cos) = angle.sin_cos();
            let arm = times(turned, [radius * cos, radius * sin, 0.0]);
            (arm, times(turned, [-sin, cos, 0.0]))
        };
        for _ in 0..6 * usize::from(!projected) {
            let (arm, tangent) = at(angle);
            let off: f64 = (0..3).map(|i| (moved[i] + arm[i]) * beside[i]).sum();
            angle -= off / (radius * dot(tangent, beside));
        }
        let (arm, tangent) = at(angle);
        SeenCircle {
            arm,
            tangent: (!projected).then_some(tangent),
            beside,
        }
    }

    /// What a unit force along `normal` on the length from the point to the ball does on the ring: it moves the point,
    /// and the circle slides along itself to stay in the plane.
    pub fn on_ring(&self, normal: [f64; 3]) -> [f64; 3] {
        let across = self
            .tangent
            .map_or(0.0, |tangent| dot(normal, tangent) / dot(tangent, self.beside));
        [0, 1, 2].map(|i| normal[i] - across * self.beside[i])
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

/// A contact of a ball with the inner ring, under a shaft that may tilt.
pub struct InnerContact {
    /// From the shaft's origin to the centre of the groove at the ball, m, in space.
    pub centre: [f64; 3],
    /// Direction of the force on the ring, in space.
    pub normal: [f64; 3],
    /// Direction of falling contact angle, in space.
    pub along: [f64; 3],
    /// e_psi at the ball.
    pub beside: [f64; 3],
}

impl InnerContact {
    pub fn new(model: &Model, solution: &StaticSolution, ball: usize) -> InnerContact {
        let g = &model.geometry;
        let (q, u) = (solution.displacements.shaft, solution.displacements.balls[ball]);
        let (sin, cos) = g.azimuth(ball).sin_cos();
        let (groove, place) = (g.groove_centre(Side::Inner), g.ball_centre());
        let seen = SeenCircle::new(
            &rotation([q[3], q[4]]),
            [q[0], q[1], q[2]],
            groove.radial,
            g.azimuth(ball),
            model.contact.projects_grooves,
        );
        let centre = seen.arm;
        let moved = [0, 1, 2].map(|i| q[i] + centre[i]);
        let l = [
            place.radial + u.radial - moved[0] * cos - moved[1] * sin,
            place.axial + u.axial - groove.axial - moved[2],
        ];
        let length = l[0].hypot(l[1]);
        let space = |v: [f64; 2]| [v[0] * cos, v[0] * sin, v[1]];
        InnerContact {
            centre,
            normal: seen.on_ring(space([l[0] / length, l[1] / length])),
            along: seen.on_ring(space([-l[1] / length, l[0] / length])),
            beside: seen.beside,
        }
    }
}
