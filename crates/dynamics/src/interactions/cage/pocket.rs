//! A ball in its pocket over a step.
//!
//! Lengths of the link: displacement and rotation vector of the ball since the start (3 + 3), displacement (3), tilts
//! (2) and turn (1) of the cage since the start.
//!
//! With bars for means over the step, D the turn and theta the mean azimuth of the pocket, exactly
//!
//! ```text
//! change of d_psi = cos(D/2) e_psi . change of u - sin(D/2)/(D/2) (mean u . e_r) D
//! change of d_z   = change of u_z + tilt_y change of u_x + mean u_x change of tilt_y - (the same with x and y)
//! ```
//!
//! and the forces take these factors. Moment of momentum about the axis is off by D^2/12 of a force's own moment: 5e-8
//! at 800 rpm and 10 us.

use super::super::free_contact::jet::{
    Jet, N_LENGTHS, Vector, cross, dot, fixed, minus, plus, scaled, times,
};
use super::impact::Impact;
use super::{CageContact, CageForce, Rubbing, press};

/// A ball in its pocket over a step.
#[derive(Clone, Debug)]
pub struct PocketStep {
    /// Step size, s.
    pub dt: f64,
    /// Place, velocity and angular velocity of the ball at the start.
    pub ball: [[f64; 3]; 3],
    /// The cage at the start: place, tilts, turn; then their rates.
    pub cage: [[f64; 6]; 2],
    /// Azimuth of the pocket in the cage, rad.
    pub azimuth: f64,
    /// Radius of the ball, m.
    pub ball_radius: f64,
    /// Half of the clearance, m.
    pub touching: f64,
    /// Force law.
    pub impact: Impact,
    /// Friction.
    pub rubbing: Rubbing,
}

/// The pocket at one instant.
struct PocketPlace {
    /// From the centre of the cage to the ball.
    arm: Vector,
    tilts: [Jet; 2],
    /// d along e_psi and e_z.
    reach: [Jet; 2],
    out: Vector,
    round: Vector,
}

impl CageContact for PocketStep {
    fn closing_speed(&self) -> f64 {
        let start = self.start();
        let [d_psi, d_z] = start.reach.map(|x| x.value);
        let size = d_psi.hypot(d_z);
        if size == 0.0 {
            return 0.0;
        }
        let ([_, v, _], [_, rate]) = (self.ball, self.cage);
        let along = |a: &Vector| (0..3).map(|i| a[i].value * (v[i] - rate[i])).sum::<f64>();
        let lever = dot(start.arm, start.out).value;
        let arm = start.arm.map(|x| x.value);
        let of_psi = along(&start.round) - rate[5] * lever;
        let of_z = v[2] - rate[2] + rate[4] * arm[0] - rate[3] * arm[1];
        (d_psi * of_psi + d_z * of_z) / size
    }

    fn overlap_at_start(&self) -> f64 {
        let [a, b] = self.start().reach.map(|x| x.value);
        a.hypot(b) - self.touching
    }

    fn evaluate(&self, end: [f64; N_LENGTHS], resists: &mut [Jet; N_LENGTHS]) -> CageForce {
        let start = self.start();
        let x: [Jet; N_LENGTHS] = std::array::from_fn(|i| Jet::length(i, end[i]));
        let last = self.at(&x);
        let reach = (start.reach.map(|l| l.value), last.reach);
        // On the pocket; the ball gets the opposite.
        let Some((load, mut found)) = press(&self.impact, self.touching, reach, self.dt) else {
            return CageForce::default();
        };
        let before = resists[11].value;
        self.add_normal((&start, &last), load, &x, resists);
        if self.rubbing.acts(&found) {
            self.add_friction((&start, &last), load, &x, resists, &mut found);
        }
        found.torque = before - resists[11].value;
        found
    }

    fn sizes(&self) -> (f64, f64) {
        let [x, y, _] = self.ball[0];
        (self.dt, x.hypot(y))
    }

    fn impact(&self) -> &Impact {
        &self.impact
    }

    fn impact_mut(&mut self) -> &mut Impact {
        &mut self.impact
    }
}

impl PocketStep {
    fn start(&self) -> PocketPlace {
        self.at(&[Jet::default(); N_LENGTHS])
    }

    /// The pocket at lengths.
    fn at(&self, x: &[Jet; N_LENGTHS]) -> PocketPlace {
        let [at, _] = self.cage;
        let ball = plus(fixed(self.ball[0]), [x[0], x[1], x[2]]);
        let centre = plus(fixed([at[0], at[1], at[2]]), [x[6], x[7], x[8]]);
        let arm = minus(ball, centre);
        let tilts = [x[9] + at[3], x[10] + at[4]];
        let [out, round] = directions(x[11] + (at[5] + self.azimuth));
        let axial = arm[2] + tilts[1] * arm[0] - tilts[0] * arm[1];
        PocketPlace {
            arm,
            tilts,
            reach: [dot(arm, round), axial],
            out,
            round,
        }
    }

    fn add_normal(
        &self,
        (start, last): (&PocketPlace, &PocketPlace),
        load: [Jet; 2],
        x: &[Jet; N_LENGTHS],
        resists: &mut [Jet; N_LENGTHS],
    ) {
        let half = x[11] * 0.5;
        let [out, round] = directions(half + (self.cage[0][5] + self.azimuth));
        let arm = scaled(0.5, plus(start.arm, last.arm));
        let tilts = [0, 1].map(|i| (start.tilts[i] + last.tilts[i]) * 0.5);
        let (cos, over) = (cosine(half), sine_over(half));
        let along = times(load[0] * cos, round);
        let across = [load[1] * tilts[1], -(load[1] * tilts[0]), load[1]];
        let force = plus(along, across);
        for i in 0..3 {
            resists[i] = resists[i] + force[i];
            resists[6 + i] = resists[6 + i] - force[i];
        }
        resists[9] = resists[9] - load[1] * arm[1];
        resists[10] = resists[10] + load[1] * arm[0];
        resists[11] = resists[11] - load[0] * over * dot(arm, out);
    }

    /// Friction on ball and cage under a normal force.
    fn add_friction(
        &self,
        (start, last): (&PocketPlace, &PocketPlace),
        load: [Jet; 2],
        x: &[Jet; N_LENGTHS],
        resists: &mut [Jet; N_LENGTHS],
        found: &mut CageForce,
    ) {
        let mean = |first: usize| [0, 1, 2].map(|i| x[first + i] * (1.0 / self.dt));
        let end =
            |first: usize, before: [f64; 3]| [0, 1, 2].map(|i| x[first + i] * (2.0 / self.dt) + -before[i]);
        let [_, rate] = self.cage;
        let rates = [[rate[0], rate[1], rate[2]], [rate[3], rate[4], rate[5]]];
        let middle = WallFrame::new(self, start, last, x);
        let at_middle = middle.slip([mean(0), mean(3), mean(6), mean(9)]);
        let at_end = || {
            let frame = WallFrame::of(self, last.arm, last.reach, [last.out, last.round]);
            frame.slip([
                end(0, self.ball[1]),
                end(3, self.ball[2]),
                end(6, rates[0]),
                end(9, rates[1]),
            ])
        };
        let f = self.rubbing.rub(load, (at_middle, at_end), self.dt, found);
        let force = plus(times(f[0], middle.tangents[0]), times(f[1], middle.tangents[1]));
        let about_ball = cross(middle.lever, force);
        let about_cage = cross(plus(middle.arm, middle.lever), force);
        for i in 0..3 {
            resists[i] = resists[i] - force[i];
            resists[3 + i] = resists[3 + i] - about_ball[i];
            resists[6 + i] = resists[6 + i] + force[i];
            resists[9 + i] = resists[9 + i] + about_cage[i];
        }
    }
}

/// Directions and levers of friction at one instant.
struct WallFrame {
    arm: Vector,
    /// From the ball's centre to where it touches.
    lever: Vector,
    /// Out of the axis, and across it in the wall of the pocket.
    tangents: [Vector; 2],
}

impl WallFrame {
    fn new(step: &PocketStep, start: &PocketPlace, last: &PocketPlace, x: &[Jet; N_LENGTHS]) -> WallFrame {
        let arm = scaled(0.5, plus(start.arm, last.arm));
        let reach = [0, 1].map(|i| start.reach[i] + last.reach[i]);
        let directions = directions(x[11] * 0.5 + (step.cage[0][5] + step.azimuth));
        WallFrame::of(step, arm, reach, directions)
    }

    fn of(step: &PocketStep, arm: Vector, reach: [Jet; 2], [out, round]: [Vector; 2]) -> WallFrame {
        let short = (reach[0] * reach[0] + reach[1] * reach[1]).sqrt().recip();
        let mut normal = times(reach[0] * short, round);
        normal[2] = normal[2] + reach[1] * short;
        WallFrame {
            arm,
            lever: scaled(step.ball_radius, normal),
            tangents: [out, cross(normal, out)],
        }
    }

    /// Slip of the ball's surface on the wall: velocities and turnings of ball and cage.
    fn slip(&self, [ball, ball_turns, cage, cage_turns]: [Vector; 4]) -> [Jet; 2] {
        let of_ball = plus(ball, cross(ball_turns, self.lever));
        let of_cage = plus(cage, cross(cage_turns, plus(self.arm, self.lever)));
        let slip = minus(of_ball, of_cage);
        self.tangents.map(|t| dot(slip, t))
    }
}

/// e_r and e_psi at an azimuth.
fn directions(azimuth: Jet) -> [Vector; 2] {
    let (sin, cos) = azimuth.value.sin_cos();
    let (s, c) = (azimuth.map(sin, cos), azimuth.map(cos, -sin));
    [[c, s, Jet::default()], [-s, c, Jet::default()]]
}

fn cosine(x: Jet) -> Jet {
    let (sin, cos) = x.value.sin_cos();
    x.map(cos, -sin)
}

/// sin(x)/x.
fn sine_over(x: Jet) -> Jet {
    let v = x.value;
    if v.abs() < 1e-3 {
        let square = v * v;
        return x.map(
            1.0 - square / 6.0 * (1.0 - square / 20.0),
            -v / 3.0 * (1.0 - square / 10.0),
        );
    }
    let (sin, cos) = v.sin_cos();
    x.map(sin / v, (cos - sin / v) / v)
}
