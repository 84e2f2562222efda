//! What a ring does to a ball: normal force, and of a free ball traction, in space.

use contact::{Side, cross};
use dynamics::balls::{BallResult, TractionResult};

/// Force of a ring on a ball at its azimuth, N: normal force, and traction of a free ball.
pub fn force_on_ball(side: Side, ball: &BallResult) -> [f64; 3] {
    let normal = normal_force(side, ball);
    match Pull::of(side, ball) {
        Some(pull) => [0, 1, 2].map(|i| normal[i] + pull.force[i]),
        None => normal,
    }
}

/// Moment of the same about a point that the ball's centre is `arm` away from, N m; `lever` is the distance from the
/// ball's centre to the centre of the contact, m.
pub fn moment_on_ball(side: Side, ball: &BallResult, arm: [f64; 3], lever: f64) -> [f64; 3] {
    let of_slope = ball.free.and_then(|free| free.traction(side).slope_moment_n_m);
    let of_slope = of_slope.unwrap_or_default();
    let of_normal = cross(arm, normal_force(side, ball));
    let of_normal = [0, 1, 2].map(|i| of_normal[i] + of_slope[i]);
    let Some(pull) = Pull::of(side, ball) else {
        return of_normal;
    };
    let at = [0, 1, 2].map(|i| arm[i] + lever * pull.normal[i]);
    let of_pull = cross(at, pull.force);
    [0, 1, 2].map(|i| of_normal[i] + of_pull[i] + pull.moment[i])
}

/// From the contact to the ball's centre, N, with what acts along the rolling direction: by the slope of a real
/// surface, and across the plane of a ball on a ring that has moved.
fn normal_force(side: Side, ball: &BallResult) -> [f64; 3] {
    let contact = ball.contact(side);
    let (sin, cos) = ball.azimuth_rad.sin_cos();
    let (sin_a, cos_a) = contact.contact_angle_rad.sin_cos();
    let radial = -side.sign() * contact.force_n * cos_a;
    let slope = ball.free.and_then(|free| free.traction(side).slope_force_n);
    let round = slope.unwrap_or_default() + ball.across_n.filter(|_| side.index() == 0).unwrap_or_default();
    [
        radial * cos - round * sin,
        radial * sin + round * cos,
        -side.sign() * contact.force_n * sin_a,
    ]
}

/// Traction on a free ball.
struct Pull {
    /// From the ball's centre to the raceway.
    normal: [f64; 3],
    /// N.
    force: [f64; 3],
    /// About the centre of the contact, N m.
    moment: [f64; 3],
}

impl Pull {
    fn of(side: Side, ball: &BallResult) -> Option<Pull> {
        let TractionResult {
            traction_n: [f_t, f_q],
            traction_moment_n_m: [m_t, m_q, m_n],
            ..
        } = *ball.free.as_ref()?.traction(side);
        let (sin, cos) = ball.azimuth_rad.sin_cos();
        let (sin_a, cos_a) = ball.contact(side).contact_angle_rad.sin_cos();
        let [n_r, n_z] = [side.sign() * cos_a, side.sign() * sin_a];
        let (t, normal) = ([-sin, cos, 0.0], [n_r * cos, n_r * sin, n_z]);
        let q = cross(normal, t);
        Some(Pull {
            normal,
            force: [0, 1, 2].map(|i| f_t * t[i] + f_q * q[i]),
            moment: [0, 1, 2].map(|i| m_t * t[i] + m_q * q[i] + m_n * normal[i]),
        })
    }
}
