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

/// A contact of a ball with the inner ring, under a shaft that may tilt.
pub struct InnerContact {
    /// From the shaft's origin to the centre of the groove at the ball, m, in space.
    pub centre: [f64; 3],
    /// Direction of the force on the ring, in space.
    pub normal: [f64; 3],
    /// Direction of falling contact angle, in space.
    pub along: [f64; 3],
}

impl InnerContact {
    pub fn new(model: &Model, solution: &StaticSolution, ball: usize) -> InnerContact {
        let g = &model.geometry;
        let (q, u) = (solution.displacements.shaft, solution.displacements.balls[ball]);
        let (sin, cos) = g.azimuth(ball).sin_cos();
        let (groove, place) = (g.groove_centre(Side::Inner), g.ball_centre());
        let centre = times(
            &rotation([q[3], q[4]]),
            [groove.radial * cos, groove.radial * sin, 0.0],
        );
        let moved = [0, 1, 2].map(|i| q[i] + centre[i]);
        let l = [
            place.radial + u.radial - moved[0] * cos - moved[1] * sin,
            place.axial + u.axial - groove.axial - moved[2],
        ];
        let length = l[0].hypot(l[1]);
        let space = |v: [f64; 2]| [v[0] * cos, v[0] * sin, v[1]];
        InnerContact {
            centre,
            normal: space([l[0] / length, l[1] / length]),
            along: space([-l[1] / length, l[0] / length]),
        }
    }
}
