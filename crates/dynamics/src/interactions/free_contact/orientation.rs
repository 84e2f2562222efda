//! Orientation of a ball in space: a unit quaternion, from the frame of the ball to space.
//!
//! Over a step the ball turns by the rotation vector theta = h (omega_0 + omega_1)/2: q_1 = exp(theta/2) q_0, of second
//! order (e.g. Hairer, Lubich and Wanner, Geometric Numerical Integration, 2006, IV.8). The product is a rotation
//! whatever the step; its norm is made 1 again after each, so that no round-off gathers.
//!
//! The frame of a ball is (u, -e_psi, a) at the start ([`contact::surface::ball`]).

use contact::cross;

/// A rotation: w, x, y, z.
pub type Quaternion = [f64; 4];

/// The ball of a bearing at the start, at an azimuth, rad, with its equator at the contact angle `equator`, rad.
pub fn at_start(azimuth: f64, equator: f64) -> Quaternion {
    let (sin, cos) = (0.5 * equator).sin_cos();
    let (up, along) = (0.5 * azimuth).sin_cos();
    // (u, -e_psi, a) is half a turn about the direction half-way between e_r and u; then the turn to the azimuth.
    product([along, 0.0, 0.0, up], [0.0, cos, 0.0, sin])
}

/// The orientation after a turn by a rotation vector in space, rad.
pub fn turned(q: Quaternion, theta: [f64; 3]) -> Quaternion {
    let angle = theta.iter().map(|x| x * x).sum::<f64>().sqrt();
    let half = 0.5 * angle;
    // sin(half)/angle.
    let share = if half > 1e-4 {
        half.sin() / angle
    } else {
        0.5 - half * half / 12.0
    };
    let next = product(
        [half.cos(), share * theta[0], share * theta[1], share * theta[2]],
        q,
    );
    let size = next.iter().map(|x| x * x).sum::<f64>().sqrt();
    next.map(|x| x / size)
}

/// A direction in space as the ball sees it.
pub fn in_ball([w, x, y, z]: Quaternion, v: [f64; 3]) -> [f64; 3] {
    // v + 2 w u x v + 2 u x (u x v) with u = -(x, y, z).
    let u = [-x, -y, -z];
    let once = cross(u, v);
    let twice = cross(u, once);
    [0, 1, 2].map(|i| v[i] + 2.0 * (w * once[i] + twice[i]))
}

fn product([a, b, c, d]: Quaternion, [e, f, g, h]: Quaternion) -> Quaternion {
    [
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(a: [f64; 3], b: [f64; 3], most: f64) {
        (0..3).for_each(|i| assert!((a[i] - b[i]).abs() < most, "{a:?} {b:?}"));
    }

    /// Wrong: profiles would start elsewhere on the ball than the scene says. u, -e_psi and a at an azimuth are the
    /// axes of the ball.
    #[test]
    fn the_frame_at_the_start_is_that_of_the_profiles() {
        let (psi, angle) = (2.1f64, 0.26f64);
        let (e_r, e_psi) = ([psi.cos(), psi.sin(), 0.0], [-psi.sin(), psi.cos(), 0.0]);
        let (sin, cos) = angle.sin_cos();
        let q = at_start(psi, angle);
        let u = [0, 1, 2].map(|i| cos * e_r[i] + if i == 2 { sin } else { 0.0 });
        let axis = [0, 1, 2].map(|i| sin * e_r[i] - if i == 2 { cos } else { 0.0 });
        assert_near(in_ball(q, u), [1.0, 0.0, 0.0], 1e-15);
        assert_near(in_ball(q, e_psi.map(|x| -x)), [0.0, 1.0, 0.0], 1e-15);
        assert_near(in_ball(q, axis), [0.0, 0.0, 1.0], 1e-15);
    }

    /// Wrong: a ball would turn the other way, by another angle, or lose its norm over a long run. A million small
    /// turns about one axis make their sum; the norm stays 1.
    #[test]
    fn turns_about_one_axis_add_up() {
        let (n, step) = (1_000_000, 5.3e-3);
        let axis = [0.6, -0.48, 0.64];
        let mut q = at_start(0.4, 0.3);
        let first = q;
        for _ in 0..n {
            q = turned(q, axis.map(|x| step * x));
        }
        let whole = turned(first, axis.map(|x| f64::from(n) * step * x));
        let v = [0.2, 0.9, -0.4];
        assert_near(in_ball(q, v), in_ball(whole, v), 1e-9);
        assert!((q.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-15);
        assert_near(
            in_ball(turned([1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.3]), [1.0, 0.0, 0.0]),
            [0.3f64.cos(), -0.3f64.sin(), 0.0],
            1e-15,
        );
    }

    /// Wrong: orientation would be of first order in the step. A turning whose direction changes: the error of the
    /// midpoint turn falls by four as steps are halved.
    #[test]
    fn orientation_is_of_second_order() {
        let speed = |t: f64| [600.0 * (40.0 * t).cos(), 600.0 * (40.0 * t).sin(), 200.0];
        let end = |n: u32| {
            let h = 0.01 / f64::from(n);
            (0..n).fold(at_start(0.0, 0.3), |q, i| {
                let (a, b) = (speed(h * f64::from(i)), speed(h * f64::from(i + 1)));
                turned(q, [0, 1, 2].map(|k| 0.5 * h * (a[k] + b[k])))
            })
        };
        let exact = end(16_000);
        let off = |n: u32| {
            let q = end(n);
            (0..4).map(|i| (q[i] - exact[i]).abs()).fold(0.0, f64::max)
        };
        let ratio = off(250) / off(500);
        assert!((3.8..4.2).contains(&ratio), "{ratio}");
    }
}
