//! Rigid rings against an independent solution of their equations by an ODE solver.

use crate::support::finite::{SeenCircle, cross, on_tilts, rotation, times};
use crate::support::{Case, equilibrium};
use contact::Side;
use dynamics::effects::{Effect, Loads, Now};
use dynamics::kinematics::Speed;
use dynamics::model::ShaftInertia;
use dynamics::motion::{Motion, MotionSettings, StepCache};
use dynamics::{DynamicsError, Model, StaticSolution};
use ode_solvers::rk4::Rk4;
use ode_solvers::{DVector, System};

/// A radial force F sin^2(pi t / T): smooth, zero with zero slope at the start.
#[derive(Clone, Copy)]
struct Pulse;

const FORCE: f64 = 400.0;
const PERIOD: f64 = 2e-4;
const SHAFT_MASS: f64 = 0.5;
const AXIAL: f64 = 1000.0;
/// Distance of the load from the plane of the inner grooves, m.
const LOAD_POINT: f64 = 8e-3;
/// Speed of a shaft that turns, rad/s.
const SPEED: f64 = 2100.0;
/// Moment about x on it, N m.
const MOMENT: f64 = 12.0;
/// Dofs of the shaft.
const N_SHAFT: usize = 5;

fn pulse(t: f64) -> f64 {
    FORCE * (std::f64::consts::PI * t / PERIOD).sin().powi(2)
}

impl Effect for Pulse {
    fn name(&self) -> &'static str {
        "pulse"
    }

    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        loads.add_shaft_force_at(model.load_point, [pulse(now.time), 0.0, 0.0]);
        Ok(())
    }
}

/// The equations of shaft and balls (radial, axial) between two rigid tori under finite rotation, written anew from the
/// bearing's dimensions. State: displacements x, y, z of the shaft, components (-y, x) of its axis, balls; then their
/// velocities; um and urad / 30 over time in us: numbers of like size. Balls go round with the cage, and their meridian
/// planes with them.
struct Bearing {
    azimuths: Vec<f64>,
    /// Speeds of shaft and cage, rad/s.
    speeds: [f64; 2],
    /// Moment on the shaft about x, N m.
    moment: f64,
    ball_mass: f64,
    stiffness: [f64; 2],
    /// Groove centre radius, axial position, and distance of touching: inner, outer.
    grooves: [[f64; 3]; 2],
    ball_centre: [f64; 2],
    /// Moments of inertia of the shaft across and about its axis, kg m^2; 0: its tilts are locked.
    inertia: ShaftInertia,
    /// Whether balls see points of the inner groove projected.
    projects: bool,
}

/// The rotation vector (x, y) that turns e_z to the axis with these components (-y, x).
fn tilt_of([x, y]: [f64; 2]) -> [f64; 2] {
    let sine = x.hypot(y);
    let ratio = if sine > 0.0 { sine.asin() / sine } else { 1.0 };
    [x * ratio, y * ratio]
}

/// Unit of a coordinate of the state: um, and of the tilts 1/30 mrad.
fn unit(i: usize) -> f64 {
    if (3..5).contains(&i) { 1e-6 / 0.03 } else { 1e-6 }
}

impl Bearing {
    fn new(model: &Model, speeds: [f64; 2], moment: f64) -> Bearing {
        let (d, di, de, ri, ro) = (9e-3, 56.01e-3, 74.037e-3, 4.65e-3, 4.75e-3);
        let a = ri + ro - d;
        let cos = 1.0 - (de - di - 2.0 * d) / (2.0 * a);
        let sin = f64::sqrt(1.0 - cos * cos);
        let outer = [0.5 * de - ro, 0.0, ro - 0.5 * d];
        let inner = [0.5 * di + ri, a * sin, ri - 0.5 * d];
        Bearing {
            azimuths: (0..18)
                .map(|i| std::f64::consts::TAU * f64::from(i) / 18.0)
                .collect(),
            ball_mass: 7800.0 * std::f64::consts::PI / 6.0 * d * d * d,
            stiffness: Side::BOTH.map(|s| model.hertz[s.index()].stiffness),
            ball_centre: [outer[0] + outer[2] * cos, outer[2] * sin],
            grooves: [inner, outer],
            inertia: model.shaft_inertia,
            projects: model.contact.projects_grooves,
            speeds,
            moment,
        }
    }
}

impl System<f64, DVector<f64>> for Bearing {
    fn system(&self, t: f64, y: &DVector<f64>, dy: &mut DVector<f64>) {
        let n = N_SHAFT + 2 * self.azimuths.len();
        let at = |i: usize| unit(i) * y[i];
        let (place, tilt) = ([at(0), at(1), at(2)], tilt_of([at(3), at(4)]));
        let turned = rotation(tilt);
        let mut force = [pulse(1e-6 * t), 0.0, AXIAL];
        let mut moment = cross(times(&turned, [0.0, 0.0, LOAD_POINT]), force);
        moment[0] += self.moment;
        let mut acceleration = vec![0.0; n];
        for (b, psi) in self.azimuths.iter().enumerate() {
            let azimuth = psi + self.speeds[1] * 1e-6 * t;
            let (sin, cos) = azimuth.sin_cos();
            let (r, z) = (
                self.ball_centre[0] + at(N_SHAFT + 2 * b),
                self.ball_centre[1] + at(N_SHAFT + 1 + 2 * b),
            );
            for side in 0..2 {
                let [radius, groove_z, touching] = self.grooves[side];
                let seen = SeenCircle::new(&turned, place, radius, azimuth, self.projects);
                let (mut arm, mut moved) = ([radius * cos, radius * sin, 0.0], [0.0; 3]);
                if side == 0 {
                    (arm, moved) = (seen.arm, place);
                }
                let centre = [0, 1, 2].map(|i| arm[i] + moved[i]);
                let l = [r - centre[0] * cos - centre[1] * sin, z - groove_z - centre[2]];
                let length = l[0].hypot(l[1]);
                let size = self.stiffness[side] * (length - touching).max(0.0).powf(1.5) / length;
                acceleration[N_SHAFT + 2 * b] -= size * l[0] / self.ball_mass;
                acceleration[N_SHAFT + 1 + 2 * b] -= size * l[1] / self.ball_mass;
                if side == 0 {
                    let on_ring = seen.on_ring([size * l[0] * cos, size * l[0] * sin, size * l[1]]);
                    let about = cross(arm, on_ring);
                    (0..3)
                        .for_each(|i| (force[i], moment[i]) = (force[i] + on_ring[i], moment[i] + about[i]));
                }
            }
        }
        (0..3).for_each(|i| acceleration[i] = force[i] / SHAFT_MASS);
        if self.inertia.transverse > 0.0 {
            let axis = times(&turned, [0.0, 0.0, 1.0]);
            // 1e6: per us to per s.
            let rates = [3, 4].map(|i| 1e6 * unit(i) * y[n + i]);
            let moved = self.axis_acceleration(axis, [rates[1], -rates[0]], on_tilts(tilt, moment));
            [acceleration[3], acceleration[4]] = [-moved[1], moved[0]];
        }
        // Per s^2 to units per us^2.
        for i in 0..n {
            dy[i] = y[n + i];
            dy[n + i] = 1e-12 * acceleration[i] / unit(i);
        }
    }
}

impl Bearing {
    /// n'' by Euler: I n x n'' + I_p W n' is the moment across the axis n. `rates` are n_x', n_y'. The moments on the
    /// rotation vector are those of the moment f with f . dn/dp on each component, which is along the slopes of n.
    fn axis_acceleration(&self, n: [f64; 3], rates: [f64; 2], on_tilts: [f64; 2]) -> [f64; 3] {
        let rate = [rates[0], rates[1], -(n[0] * rates[0] + n[1] * rates[1]) / n[2]];
        let tilt = tilt_of([-n[1], n[0]]);
        let step = 1e-4;
        let axis = |tilt: [f64; 2]| times(&rotation(tilt), [0.0, 0.0, 1.0]);
        let slope = |k: usize| {
            // Of the fourth order.
            let at = |share: f64| {
                let mut moved = tilt;
                moved[k] += share * step;
                axis(moved)
            };
            let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(at);
            [0, 1, 2].map(|i| (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * step))
        };
        let slopes = [slope(0), slope(1)];
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
        let [a, b, c] = [(0, 0), (0, 1), (1, 1)].map(|(i, k)| dot(slopes[i], slopes[k]));
        let [p, q] = on_tilts;
        let shares = [
            (c * p - b * q) / (a * c - b * b),
            (a * q - b * p) / (a * c - b * b),
        ];
        let spin = cross(rate, n);
        let ShaftInertia { transverse, polar } = self.inertia;
        [0, 1, 2].map(|i| {
            let force = shares[0] * slopes[0][i] + shares[1] * slopes[1][i];
            (force - polar * self.speeds[0] * spin[i]) / transverse - dot(rate, rate) * n[i]
        })
    }
}

/// The coordinates of shaft and balls after the pulse, by Runge and Kutta.
fn by_runge_kutta(model: &Model, start: &StaticSolution, speed: f64, moment: f64) -> Vec<f64> {
    let motion = Motion::new(model, settings(1e-6, speed)).unwrap();
    let cage = motion.ball_azimuth(0, 1.0) - motion.ball_azimuth(0, 0.0);
    let n = N_SHAFT + 36;
    let mut initial = DVector::zeros(2 * n);
    let of = &start.displacements;
    let [tilt_x, tilt_y] = [of.shaft[3], of.shaft[4]];
    let axis = times(&rotation([tilt_x, tilt_y]), [0.0, 0.0, 1.0]);
    let [x, y, z, ..] = of.shaft;
    for (i, value) in [x, y, z, -axis[1], axis[0]].into_iter().enumerate() {
        initial[i] = value / unit(i);
    }
    for (b, ball) in of.balls.iter().enumerate() {
        (0..2).for_each(|i| initial[N_SHAFT + 2 * b + i] = 1e6 * ball.to_array()[i]);
    }
    // The classical fourth-order scheme at 1/1000 of the shortest period, 23 us: exact to 1e-9.
    let bearing = Bearing::new(model, [speed, cage], moment);
    let mut solver = Rk4::new(bearing, 0.0, initial, 1e6 * PERIOD, 0.02);
    solver.integrate().unwrap();
    let last = solver.y_out().last().unwrap();
    let mut found: Vec<f64> = (0..n).map(|i| unit(i) * last[i]).collect();
    [found[3], found[4]] = tilt_of([found[3], found[4]]);
    found
}

fn settings(dt: f64, speed: f64) -> MotionSettings {
    MotionSettings::conserving(dt, Speed::constant(speed))
}

/// The same by a motion of so many steps.
fn by_steps(model: &Model, start: &StaticSolution, speed: f64, steps: u32) -> Vec<f64> {
    let motion = Motion::new(model, settings(PERIOD / f64::from(steps), speed)).unwrap();
    let mut state = motion.start(start);
    let mut cache = StepCache::default();
    for _ in 0..steps {
        state = motion.step(&state, &mut cache).unwrap().0;
    }
    let balls = state.balls.iter().flat_map(|ball| ball.to_array());
    state.shaft.into_iter().chain(balls).collect()
}

/// Largest errors over how far the shaft moved, of motions of 400 and 800 steps and of what they go to as the step goes
/// to zero (Richardson, twice).
fn errors(mut model: Model, speed: f64, moment: f64) -> [f64; 3] {
    let start = equilibrium(&model);
    model.effects.push(Box::new(Pulse));
    let exact = by_runge_kutta(&model, &start, speed, moment);
    let scale = (exact[0] - start.displacements.shaft[0]).abs();
    println!(
        "moved by {scale:.3e} m, tilted by {:.3e} rad",
        exact[3].hypot(exact[4])
    );
    assert!(scale > 1e-7 && (model.shaft_inertia.transverse == 0.0) == (exact[4] == 0.0));
    let found = [200, 400, 800].map(|steps| by_steps(&model, &start, speed, steps));
    let better = |a: &[f64], b: &[f64], order: f64| -> Vec<f64> {
        a.iter()
            .zip(b)
            .map(|(a, b)| (order * b - a) / (order - 1.0))
            .collect()
    };
    let once = [0, 1].map(|i| better(&found[i], &found[i + 1], 4.0));
    let limit = better(&once[0], &once[1], 16.0);
    let error = |found: &[f64]| {
        let off = |i: usize| (found[i] - exact[i]).abs() * 1e-6 / unit(i);
        (0..exact.len()).map(off).fold(0.0, f64::max) / scale
    };
    let errors = [error(&found[1]), error(&found[2]), error(&limit)];
    println!("errors {errors:?}");
    errors
}

/// Wrong: motion would not be the solution of the equations of motion. A smooth radial pulse on a preloaded bearing
/// with rigid rings, against a Runge-Kutta solution of independently written equations: the error falls with the
/// square of the step, and what is left at its limit is below 2e-7 of the displacement. The load acts off the plane of
/// the balls, where the tilts are free too: at rest, at 20 000 rpm with balls that go round, and there with a moment
/// that tilts the bearing far.
#[test]
fn rigid_rings_follow_an_independent_ode_solution() {
    for (transverse, polar, speed, moment, projects) in [
        (0.0, 0.0, 0.0, 0.0, true),
        (0.0, 0.0, 0.0, 0.0, false),
        (1e-4, 0.0, 0.0, 0.0, false),
        (1e-4, 1.6e-4, SPEED, 0.0, false),
        (1e-4, 1.6e-4, SPEED, MOMENT, false),
        (1e-4, 1.6e-4, SPEED, MOMENT, true),
    ] {
        let mut case = Case::axial(AXIAL);
        (case.free_tilt, case.load_point, case.moment) = (transverse > 0.0, LOAD_POINT, moment);
        let mut model = case.rigid();
        model.contact.projects_grooves = projects;
        model.shaft_mass = SHAFT_MASS;
        model.shaft_inertia = ShaftInertia { transverse, polar };
        let [coarse, fine, limit] = errors(model, speed, moment);
        assert!(fine < 1e-4, "{fine}");
        let order = (coarse / fine).log2();
        assert!((order - 2.0).abs() < 0.1, "{order}");
        assert!(limit < 2e-7, "{limit}");
    }
}
