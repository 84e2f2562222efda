//! Rigid inertia of a ring that turns with the shaft: what the ring's own step in its turning frame leaves out.
//!
//! A flexible ring moves by total displacements in a frame that turns by theta(t), with the speed W. Of its rigid
//! motion there, position x and tilts t of the shaft seen from the frame, a rigid body of revolution asks for
//!
//! ```text
//! force   m D x + S (D t_y, -D t_x)                          D x = x'' + 2 W J x' - W^2 x + W' J x
//! moment  I t'' + (2 I - I_p) W J t' + (I_p - I) W^2 t + (I - I_p) W' J t + S (-D y, D x)
//! ```
//!
//! with J a = (-a_y, a_x), linear in the tilts: the inertia in space of a free rotor (e.g. Genta, Dynamics of Rotating
//! Systems, ch. 2), seen from its frame ([`super::LargeTilt`] has the rest). The step of the ring takes the second
//! derivatives alone, so that a shaft at rest in space would be pulled outwards; what is left acts on the shaft here
//! ([`StepTakes::Still`]).
//!
//! Where the effect `frame_rotation` gives the whole ring the inertia of its frame, it does so on linear displacements:
//! the ring lacks W^2 I_p t / 2 - W' I_p J t / 2 of the moment, because a tilt moves nodes towards the axis to second
//! order, and the centrifugal force works on that. That moment is what acts here then ([`StepTakes::Turning`]).
//!
//! The shaft's own inertia is that of its dofs in space. Of its spin there is the moment - d/dt [ I_p W J t ].
//!
//! Velocities are those of [`ShaftStart`]: no state of its own, and of second order. Bodies are taken as bodies of
//! revolution: the unbalance of a ring with a cut comes with `frame_rotation`. Forces act on the shaft, not over the
//! ring. What its elasticity makes of that is (W / first natural frequency w_1)^2 of them; the shaft of a ring that
//! touches nothing feels it as a negative stiffness of the size m W^4 / w_1^2, which contacts exceed by far. Where the
//! stress of the turning ring stiffens it ([`ring::expansion`]), that holds W^2 I_p t / 2 against a tilt of its own,
//! and of its elastic part too; only the pull of a clamped bore is taken out here. Else the elastic part of a tilt
//! lacks it: 2e-5 of the tilt of a 7010C with a clamped bore at 40 000 rpm.

use ring::Integrator;
use ring::rigid::{RigidInertia, across};

use super::shaft_course::{ShaftCourse, ShaftStart};

use crate::frame::turn;

/// What the ring's own step takes as the inertia of its rigid motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepTakes {
    /// That of a frame that stands.
    Still,
    /// That of the turning frame, on linear displacements.
    Turning,
}

/// Rigid inertia of a turning ring over a step, beyond what the ring's step takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameInertia {
    /// Of the ring about the origin of the shaft's tilts; zero of a rigid one.
    pub inertia: RigidInertia,
    /// Polar moment of inertia of the shaft, kg m^2.
    pub shaft_polar: f64,
    /// That of a body on the shaft, whose step takes the inertia of its turning frame on linear displacements.
    pub body_polar: f64,
    /// What the step of the ring takes.
    pub takes: StepTakes,
    /// Moment that the stress of the ring at unit speed holds against a tilt in that step, N m s^2.
    pub tilt_by_stress: f64,
    /// What the shaft starts with, in space.
    pub shaft: ShaftStart,
    /// Angle of the frame at the start, at the weighted time and at the end of the step, rad.
    pub angles: [f64; 3],
    /// Speed of the frame at the start and at the end, rad/s.
    pub speeds: [f64; 2],
}

impl FrameInertia {
    /// Forces and moments on the shaft that the inertia asks for when it ends at `q`, N and N m. Linear in `q` but for
    /// a constant.
    pub fn forces(&self, q: [f64; 5]) -> [f64; 5] {
        let [from, at, to] = self.angles;
        let (start, end) = (turn(self.shaft.start[0], -from), turn(q, -to));
        let dt = self.shaft.scheme.dt;
        let pairs = [0, 1, 2, 3, 4].map(|i| [start[i], end[i]]);
        let course = self.shaft.course(q);
        let v = match self.shaft.takes_means() {
            true => pairs.map(|[a, b]| (b - a) / dt),
            false => self.seen_from_frame(&course),
        };
        let x = pairs.map(|pair| self.shaft.weighted(pair));
        let mut forces = turn(self.in_frame(x, v), at);
        let spin = self.shaft_spin(q, &course);
        (forces[3], forces[4]) = (forces[3] + spin[0], forces[4] + spin[1]);
        forces
    }

    /// Velocity in the frame at the weighted time of a course in space: v - W J x.
    fn seen_from_frame(&self, [x, v, _]: &ShaftCourse) -> [f64; 5] {
        let (speed, jx) = (self.shaft.weighted(self.speeds), across(*x));
        turn([0, 1, 2, 3, 4].map(|i| v[i] - speed * jx[i]), -self.angles[1])
    }

    /// Moment about x and y that the spin of the shaft asks for, N m: the change of its momentum, over the step or at
    /// the weighted time.
    fn shaft_spin(&self, q: [f64; 5], [x, v, _]: &ShaftCourse) -> [f64; 2] {
        let ([from, to], [speed, growth]) = (self.speeds, self.shaft.spin(self.speeds));
        let rate = |i: usize| match self.shaft.takes_means() {
            true => {
                let change = to * q[i] - from * self.shaft.start[0][i];
                self.shaft_polar * change / self.shaft.scheme.dt
            }
            false => self.shaft_polar * (speed * v[i] + growth * x[i]),
        };
        [rate(4), -rate(3)]
    }

    /// Growth of the forces with `q`, by columns.
    pub fn slopes(&self) -> [[f64; 5]; 5] {
        let still = self.forces([0.0; 5]);
        [0, 1, 2, 3, 4].map(|k| {
            let mut q = [0.0; 5];
            q[k] = 1.0;
            let moved = self.forces(q);
            [0, 1, 2, 3, 4].map(|i| moved[i] - still[i])
        })
    }

    /// Work of the forces on the shaft over the step, J, with velocities that are means, and what those of the weighted
    /// time add to it: the scheme's own.
    pub fn works(&self, q: [f64; 5]) -> [f64; 2] {
        let work = |of: &FrameInertia| of.shaft.work(of.forces(q), q);
        if self.shaft.takes_means() {
            return [work(self), 0.0];
        }
        let ([from, _, to], mut means) = (self.angles, *self);
        means.angles[1] = 0.5 * (from + to);
        means.shaft.scheme.integrator = Integrator::average_acceleration();
        let mean = work(&means);
        [mean, work(self) - mean]
    }

    /// The forces in the frame at the displacement `x` and the velocity `v` seen from it.
    fn in_frame(&self, x: [f64; 5], v: [f64; 5]) -> [f64; 5] {
        let [speed, rate] = self.shaft.spin(self.speeds);
        let jx = across(x);
        let of_linear = |polar: f64, by_stress: f64| {
            let moment = |i: usize| {
                let half = 0.5 * polar;
                (half - by_stress) * speed * speed * x[i] - half * rate * jx[i]
            };
            [0.0, 0.0, 0.0, moment(3), moment(4)]
        };
        let forces = match self.takes {
            StepTakes::Still => self.inertia.of_frame([speed, rate], x, v),
            StepTakes::Turning => of_linear(self.inertia.polar, self.tilt_by_stress),
        };
        if self.body_polar == 0.0 {
            return forces;
        }
        let of_body = of_linear(self.body_polar, 0.0);
        [0, 1, 2, 3, 4].map(|i| forces[i] + of_body[i])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ring::StepScheme;

    const RING: RigidInertia = RigidInertia {
        mass: 0.3,
        first_moment: 2e-3,
        transverse: 2e-4,
        polar: 3e-4,
    };
    /// Growth of the speed, rad/s^2.
    const GROWTH: f64 = 4e4;

    /// A smooth motion of the shaft in space: displacement, velocity, acceleration at a time.
    fn motion(t: f64) -> [[f64; 5]; 3] {
        let wave = |i: usize| {
            let (w, p) = (300.0 + 40.0 * i as f64, 0.3 + i as f64);
            let (sin, cos) = (w * t + p).sin_cos();
            [1e-5 * sin, 1e-5 * w * cos, -1e-5 * w * w * sin]
        };
        let waves = [0, 1, 2, 3, 4].map(wave);
        [0, 1, 2].map(|d| waves.map(|x| x[d]))
    }

    fn speed(t: f64) -> f64 {
        900.0 + GROWTH * t
    }

    fn angle(t: f64) -> f64 {
        900.0 * t + 0.5 * GROWTH * t * t
    }

    fn over(dt: f64, (takes, tilt_by_stress): (StepTakes, f64), integrator: Integrator) -> FrameInertia {
        FrameInertia {
            inertia: RING,
            shaft_polar: 1e-4,
            body_polar: 0.0,
            takes,
            tilt_by_stress,
            shaft: ShaftStart {
                start: motion(0.0),
                remembers: [true; 5],
                scheme: StepScheme { integrator, dt },
            },
            angles: [0.0, (1.0 - integrator.alpha_f) * dt, dt].map(angle),
            speeds: [speed(0.0), speed(dt)],
        }
    }

    /// What the step of the ring does not take, by the rotor's equations in space.
    fn expected(t: f64, (takes, by_stress): (StepTakes, f64)) -> [f64; 5] {
        let ([q, v, a], w, p) = (motion(t), speed(t), RING.polar);
        let mut forces = match takes {
            StepTakes::Still => {
                // The second derivative of R^T q, turned back into space.
                let (jq, jv) = (across(q), across(v));
                let seen = [0, 1, 2, 3, 4].map(|i| {
                    let plain = if i == 2 { 0.0 } else { w * w * q[i] };
                    a[i] - 2.0 * w * jv[i] - plain - GROWTH * jq[i]
                });
                let (space, frame) = (RING.times(a), RING.times(seen));
                let mut forces = [0, 1, 2, 3, 4].map(|i| space[i] - frame[i]);
                // d/dt [ I_p W (t_y, -t_x) ]
                forces[3] += p * (w * v[4] + GROWTH * q[4]);
                forces[4] -= p * (w * v[3] + GROWTH * q[3]);
                forces
            }
            StepTakes::Turning => {
                let half = 0.5 * p;
                let moment = [w * w * q[3] + GROWTH * q[4], w * w * q[4] - GROWTH * q[3]];
                let held = [3, 4].map(|i| by_stress * w * w * q[i]);
                [
                    0.0,
                    0.0,
                    0.0,
                    half * moment[0] - held[0],
                    half * moment[1] - held[1],
                ]
            }
        };
        // The shaft's own spin.
        forces[3] += 1e-4 * (w * v[4] + GROWTH * q[4]);
        forces[4] -= 1e-4 * (w * v[3] + GROWTH * q[3]);
        forces
    }

    /// Wrong: Coriolis, centrifugal, Euler or gyroscopic terms have a wrong sign or size, or belong to another time
    /// than that at which a scheme balances. Against the equations in space at that time: second order in the step.
    /// A shaft without inertia of its own remembers the mean velocity of the step before.
    #[test]
    fn the_forces_are_those_of_the_rotors_equations() {
        let all_takes = [
            (StepTakes::Still, 0.0),
            (StepTakes::Turning, 0.0),
            (StepTakes::Turning, 1e-4),
        ];
        let schemes = [
            Integrator::average_acceleration(),
            Integrator::chung_hulbert(0.5),
            Integrator::hht(0.3),
        ];
        let cases = all_takes.into_iter().flat_map(|takes| {
            schemes
                .into_iter()
                .flat_map(move |scheme| [true, false].map(|remembers| (takes, scheme, remembers)))
        });
        for (takes, scheme, remembers) in cases {
            let error = |dt: f64| {
                let mut of = over(dt, takes, scheme);
                if !remembers {
                    let before = motion(-dt)[0];
                    of.shaft.remembers = [false; 5];
                    of.shaft.start[1] = [0, 1, 2, 3, 4].map(|i| (of.shaft.start[0][i] - before[i]) / dt);
                }
                let found = of.forces(motion(dt)[0]);
                let exact = expected((1.0 - scheme.alpha_f) * dt, takes);
                (0..5).map(|i| (found[i] - exact[i]).abs()).fold(0.0, f64::max)
            };
            let size = expected(0.0, takes).iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let (coarse, fine) = (error(2e-5), error(1e-5));
            assert!(coarse < 1e-3 * size, "{scheme:?} {coarse} of {size}");
            let order = (coarse / fine).log2();
            assert!(
                (order - 2.0).abs() < 0.1,
                "{scheme:?} {takes:?} {remembers} order {order}"
            );
        }
    }

    /// Wrong: Newton's tangent is not the derivative.
    #[test]
    fn the_slopes_are_the_derivative() {
        let of = over(1e-5, (StepTakes::Still, 0.0), Integrator::average_acceleration());
        let [from, to] = [motion(0.0)[0], motion(1e-5)[0]];
        let (a, b, slopes) = (of.forces(from), of.forces(to), of.slopes());
        for i in 0..5 {
            let linear: f64 = (0..5).map(|k| slopes[k][i] * (to[k] - from[k])).sum();
            assert!((b[i] - a[i] - linear).abs() < 1e-9 * (1.0 + b[i].abs()), "{i}");
        }
    }
}
