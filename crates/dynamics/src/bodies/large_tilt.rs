//! Inertia of a shaft that tilts far: what a rotor has beyond the equations of small tilts.
//!
//! All that moves with the shaft is a rigid body of revolution, of the mass m, the first moment S, the moments of
//! inertia I across and I_p about its axis. The tilt turns the axis to
//!
//! ```text
//! n = R e_z = (s p_y, -s p_x, cos t),   s = sin(t)/t,  t = |p|
//! ```
//!
//! with the rotation vector p = (tilt x, tilt y). The body turns about n with the given speed W. With N = dn/dp and the
//! acceleration a of the origin, its inertia asks for (Euler)
//!
//! ```text
//! force             m a + S n''
//! moment on p       N^T (I n'' + S a) + I_p W s J p' + I_p W' (s^2 / cos t) J p,   J p = (p_y, -p_x)
//! ```
//!
//! because N is across n, and n . (dn/dp_x x dn/dp_y) = s. The drive has the moment I_p W' / cos t about z, where the
//! shaft is coupled. The linear part of all that is in the dofs of the shaft, the steps of the rings and
//! [`super::FrameInertia`]; the rest is here. It is taken at the weighted time of the step ([`ShaftStart`]): of
//! second order, and reversible in time with the conserving scheme. A shaft without inertia of its own remembers mean
//! velocities alone, so that its accelerations lag by half a step.

use ring::rigid::RigidInertia;

use super::shaft_course::{ShaftCourse, ShaftStart};

/// Steps of the difference quotients of the forces: displacements in m, tilts in rad.
const DIFFERENCE: f64 = 1e-6;
/// Terms of the series of sin(t)/t and its slopes: the next one is below 1e-17 up to a tilt of 1.2 rad.
const TERMS: usize = 10;
/// 1/(2 k + 1)! by k.
const ODD_FACTORIALS: [f64; TERMS + 2] = odd_factorials();

const fn odd_factorials() -> [f64; TERMS + 2] {
    let mut all = [1.0; TERMS + 2];
    let mut k = 1;
    while k < all.len() {
        let n = 2.0 * k as f64;
        all[k] = all[k - 1] / (n * (n + 1.0));
        k += 1;
    }
    all
}

/// Inertia of a shaft and what is on it over a step, beyond that of small tilts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LargeTilt {
    /// Of all that moves with the shaft, about the origin of its tilts.
    pub inertia: RigidInertia,
    /// What the shaft starts with.
    pub shaft: ShaftStart,
    /// Speeds of the shaft at the start and at the end, rad/s.
    pub speeds: [f64; 2],
}

impl LargeTilt {
    /// Forces and moments on the shaft that the inertia asks for when it ends at `q`, N and N m.
    pub fn forces(&self, q: [f64; 5]) -> [f64; 5] {
        beyond_linear(&self.inertia, self.shaft.spin(self.speeds), &self.shaft.course(q))
    }

    /// Growth of the forces with `q` at the start, by columns.
    pub fn slopes(&self) -> [[f64; 5]; 5] {
        [0, 1, 2, 3, 4].map(|k| {
            let at = |sign: f64| {
                let mut q = self.shaft.start[0];
                q[k] += sign * DIFFERENCE;
                self.forces(q)
            };
            let (low, high) = (at(-1.0), at(1.0));
            [0, 1, 2, 3, 4].map(|i| (high[i] - low[i]) / (2.0 * DIFFERENCE))
        })
    }

    /// Work of the forces on the shaft over the step, J.
    pub fn work(&self, q: [f64; 5]) -> f64 {
        self.shaft.work(self.forces(q), q)
    }
}

/// What the inertia asks for beyond its linear part, with the speed and its rate, rad/s and rad/s^2.
fn beyond_linear(of: &RigidInertia, [speed, rate]: [f64; 2], [x, v, a]: &ShaftCourse) -> [f64; 5] {
    let (tilt, turning, growing) = ([x[3], x[4]], [v[3], v[4]], [a[3], a[4]]);
    let axis = TiltedAxis::new(tilt);
    let (slopes, moved) = (axis.slopes(), axis.acceleration(turning, growing));
    let across = of.first_moment;
    let asked = [0, 1, 2].map(|i| of.transverse * moved[i] + across * a[i]);
    let square = axis.s[0] * axis.s[0] / axis.cos();
    let linear = of.times(*a);
    let spin = [turning[1], -turning[0]];
    let lever = [tilt[1], -tilt[0]];
    let moment = |i: usize| {
        let through: f64 = (0..3).map(|k| slopes[i][k] * asked[k]).sum();
        let of_spin = speed * (axis.s[0] - 1.0) * spin[i] + rate * (square - 1.0) * lever[i];
        through - linear[3 + i] + of.polar * of_spin
    };
    [
        across * (moved[0] - a[4]),
        across * (moved[1] + a[3]),
        across * moved[2],
        moment(0),
        moment(1),
    ]
}

/// The axis of a shaft with a tilt.
struct TiltedAxis {
    tilt: [f64; 2],
    /// s and its first and second derivative by t^2.
    s: [f64; 3],
}

impl TiltedAxis {
    fn new(tilt: [f64; 2]) -> TiltedAxis {
        let square = tilt[0] * tilt[0] + tilt[1] * tilt[1];
        TiltedAxis {
            tilt,
            s: sine_over_angle(square),
        }
    }

    fn cos(&self) -> f64 {
        self.tilt[0].hypot(self.tilt[1]).cos()
    }

    /// dn/dp, by tilts.
    fn slopes(&self) -> [[f64; 3]; 2] {
        let ([x, y], [s, s1, _]) = (self.tilt, self.s);
        let of = |p: f64, [straight_x, straight_y]: [f64; 2]| {
            let growth = 2.0 * s1 * p;
            [straight_x + growth * y, straight_y - growth * x, -s * p]
        };
        [of(x, [0.0, -s]), of(y, [s, 0.0])]
    }

    /// n'' of the tilt rates and their rates.
    fn acceleration(&self, [u, v]: [f64; 2], growing: [f64; 2]) -> [f64; 3] {
        let ([x, y], [s, s1, s2]) = (self.tilt, self.s);
        let (half, square) = (x * u + y * v, u * u + v * v);
        // s' and s'' of an even turning.
        let (rate, curve) = (2.0 * s1 * half, 2.0 * s1 * square + 4.0 * s2 * half * half);
        let even = [
            curve * y + 2.0 * rate * v,
            -curve * x - 2.0 * rate * u,
            -s * square - rate * half,
        ];
        let slopes = self.slopes();
        [0, 1, 2].map(|i| even[i] + slopes[0][i] * growing[0] + slopes[1][i] * growing[1])
    }
}

/// sin(t)/t and its first two derivatives by t^2, of t^2: sums of (-t^2)^k times 1/(2 k + 1)!, -(k + 1)/(2 k + 3)!, and
/// (k + 1)(k + 2)/(2 k + 5)!.
fn sine_over_angle(square: f64) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for k in (0..TERMS).rev() {
        let n = k as f64;
        let terms = [
            ODD_FACTORIALS[k],
            -(n + 1.0) * ODD_FACTORIALS[k + 1],
            (n + 1.0) * (n + 2.0) * ODD_FACTORIALS[k + 2],
        ];
        sums = [0, 1, 2].map(|i| terms[i] - square * sums[i]);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use contact::cross;
    use ring::{Integrator, StepScheme};

    const ROTOR: RigidInertia = RigidInertia {
        mass: 0.8,
        first_moment: 6e-3,
        transverse: 2e-4,
        polar: 3e-4,
    };
    const SPEED: f64 = 2e3;
    const GROWTH: f64 = 4e5;

    /// A smooth motion in space with tilts of some 0.3 rad: displacement, velocity, acceleration at a time.
    fn motion(t: f64) -> ShaftCourse {
        let wave = |i: usize| {
            let (size, w, p) = (
                if i < 3 { 1e-3 } else { 0.3 },
                300.0 + 40.0 * i as f64,
                0.3 + i as f64,
            );
            let (sin, cos) = (w * t + p).sin_cos();
            [size * sin, size * w * cos, -size * w * w * sin]
        };
        let waves = [0, 1, 2, 3, 4].map(wave);
        [0, 1, 2].map(|d| waves.map(|x| x[d]))
    }

    /// The axis by Rodrigues' formula.
    fn axis([x, y]: [f64; 2]) -> [f64; 3] {
        let t = x.hypot(y);
        let s = t.sin() / t;
        [s * y, -s * x, t.cos()]
    }

    fn axis_at(t: f64) -> [f64; 3] {
        let [x, ..] = motion(t);
        axis([x[3], x[4]])
    }

    fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
        (0..3).map(|i| a[i] * b[i]).sum()
    }

    /// Momentum and angular momentum about the origin that moves along, without S a.
    fn momenta(t: f64) -> [[f64; 3]; 2] {
        let h = 1e-7;
        let (n, before, after) = (axis_at(t), axis_at(t - h), axis_at(t + h));
        let rate = [0, 1, 2].map(|i| (after[i] - before[i]) / (2.0 * h));
        let turning = cross(n, rate);
        let spin = ROTOR.polar * (SPEED + GROWTH * t);
        [
            rate.map(|r| ROTOR.first_moment * r),
            [0, 1, 2].map(|i| ROTOR.transverse * turning[i] + spin * n[i]),
        ]
    }

    /// Forces beyond those of small tilts, from Euler's equations: the rates of the momenta by differences.
    fn expected(t: f64) -> [f64; 5] {
        let h = 1e-6;
        let (before, after) = (momenta(t - h), momenta(t + h));
        let rates = [0, 1].map(|m: usize| [0, 1, 2].map(|i| (after[m][i] - before[m][i]) / (2.0 * h)));
        let ([x, v, a], n) = (motion(t), axis_at(t));
        let arm = n.map(|n| ROTOR.first_moment * n);
        let of_origin = cross(arm, [a[0], a[1], a[2]]);
        let drive = ROTOR.polar * GROWTH / n[2];
        let moment = [0, 1, 2].map(|i| rates[1][i] + of_origin[i] - if i == 2 { drive } else { 0.0 });
        let on_tilt = |k: usize| {
            let d = 1e-6;
            let (mut low, mut high) = ([x[3], x[4]], [x[3], x[4]]);
            (low[k], high[k]) = (low[k] - d, high[k] + d);
            let (low, high) = (axis(low), axis(high));
            let slope = [0, 1, 2].map(|i| (high[i] - low[i]) / (2.0 * d));
            dot(cross(n, slope), moment)
        };
        let small = ROTOR.times(a);
        let speed = SPEED + GROWTH * t;
        let spin = [
            ROTOR.polar * (speed * v[4] + GROWTH * x[4]),
            -ROTOR.polar * (speed * v[3] + GROWTH * x[3]),
        ];
        let first = ROTOR.first_moment;
        [
            rates[0][0] - first * a[4],
            rates[0][1] + first * a[3],
            rates[0][2],
            on_tilt(0) - small[3] - spin[0],
            on_tilt(1) - small[4] - spin[1],
        ]
    }

    /// A step about an instant. The velocities that average acceleration remembers are off by dt^2/12 of the third
    /// derivative, so that its acceleration is that of the middle.
    fn over(dt: f64, middle: f64) -> LargeTilt {
        let start = middle - 0.5 * dt;
        let [x, v, a] = motion(start);
        let (before, after) = (motion(start - 1e-6)[2], motion(start + 1e-6)[2]);
        let remembered = [0, 1, 2, 3, 4].map(|i| v[i] - dt * dt / 12.0 * (after[i] - before[i]) / 2e-6);
        LargeTilt {
            inertia: ROTOR,
            shaft: ShaftStart {
                start: [x, remembered, a],
                remembers: [true; 5],
                scheme: StepScheme {
                    integrator: Integrator::average_acceleration(),
                    dt,
                },
            },
            speeds: [start, start + dt].map(|t| SPEED + GROWTH * t),
        }
    }

    /// Wrong: a rotor that tilts far moves by other equations than Euler's. Against the rates of its momenta, found by
    /// difference quotients of the axis: second order in the step.
    #[test]
    fn the_forces_are_those_of_eulers_equations() {
        let middle = 7e-4;
        let exact = expected(middle);
        let size = exact[..3].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let moments = exact[3..].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        assert!(size > 1.0 && moments > 0.1, "{exact:?}");
        let error = |dt: f64| {
            let found = over(dt, middle).forces(motion(middle + 0.5 * dt)[0]);
            let off = |i: usize| (found[i] - exact[i]).abs() / if i < 3 { size } else { moments };
            (0..5).map(off).fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(2e-4), error(1e-4));
        assert!(coarse < 1e-2, "{coarse}");
        let order = (coarse / fine).log2();
        assert!((order - 2.0).abs() < 0.1, "order {order}: {coarse} {fine}");
    }

    /// Wrong: a shaft that hardly tilts would feel more than a motion of the second order asks for.
    #[test]
    fn small_motions_ask_for_nothing_more() {
        let mut at = over(1e-5, 7e-4);
        let small = |x: [f64; 5]| x.map(|x| 1e-5 * x);
        let large = at.forces(motion(7e-4 + 5e-6)[0]);
        at.shaft.start = at.shaft.start.map(small);
        let found = at.forces(small(motion(7e-4 + 5e-6)[0]));
        for (found, large) in found.iter().zip(large) {
            assert!(found.abs() < 1e-9 * large.abs(), "{found:e} of {large:e}");
        }
    }

    /// Wrong: Newton's tangent is not the derivative.
    #[test]
    fn the_slopes_are_the_derivative() {
        let of = over(1e-5, 7e-4);
        let slopes = of.slopes();
        let still = of.forces(of.shaft.start[0]);
        for k in 0..5 {
            let mut q = of.shaft.start[0];
            q[k] += 1e-8;
            let moved = of.forces(q);
            for i in 0..5 {
                let rate = (moved[i] - still[i]) / 1e-8;
                let size = slopes.iter().map(|of| of[i].abs()).fold(0.0, f64::max);
                assert!((rate - slopes[k][i]).abs() < 1e-5 * size, "{k} {i}");
            }
        }
    }
}
