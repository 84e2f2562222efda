//! Rigid rings against an independent solution of their equations by an ODE solver.

mod support;

use contact::Side;
use dynamics::effects::{Effect, Loads, Now};
use dynamics::kinematics::Speed;
use dynamics::motion::{Motion, MotionSettings, StepCache};
use dynamics::{DynamicsError, Model};
use ode_solvers::rk4::Rk4;
use ode_solvers::{DVector, System};
use support::finite::{cross, on_tilts, rotation, times};
use support::{Case, equilibrium};

/// A radial force F sin^2(pi t / T): smooth, zero with zero slope at the start.
#[derive(Clone, Copy)]
struct Pulse;

const FORCE: f64 = 400.0;
const PERIOD: f64 = 2e-4;
const SHAFT_MASS: f64 = 0.5;
const AXIAL: f64 = 1000.0;
/// Distance of the load from the plane of the inner grooves, m.
const LOAD_POINT: f64 = 8e-3;
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

/// The equations of shaft (x, y, z, two tilts) and balls (radial, axial) between two rigid tori under finite rotation,
/// written anew from the bearing's dimensions: state = displacements, um and urad / 30, then velocities, over time in
/// us: numbers of like size.
struct Bearing {
    azimuths: Vec<f64>,
    ball_mass: f64,
    stiffness: [f64; 2],
    /// Groove centre radius, axial position, and distance of touching: inner, outer.
    grooves: [[f64; 3]; 2],
    ball_centre: [f64; 2],
    /// Moment of inertia of the tilts, kg m^2; 0: they are locked.
    transverse: f64,
}

/// Unit of a coordinate of the state: um, and of the tilts 1/30 mrad.
fn unit(i: usize) -> f64 {
    if (3..5).contains(&i) { 1e-6 / 0.03 } else { 1e-6 }
}

impl Bearing {
    fn new(model: &Model) -> Bearing {
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
            transverse: model.shaft_inertia.transverse,
        }
    }
}

impl System<f64, DVector<f64>> for Bearing {
    fn system(&self, t: f64, y: &DVector<f64>, dy: &mut DVector<f64>) {
        let n = N_SHAFT + 2 * self.azimuths.len();
        let at = |i: usize| unit(i) * y[i];
        let (place, tilt) = ([at(0), at(1), at(2)], [at(3), at(4)]);
        let turned = rotation(tilt);
        let mut force = [pulse(1e-6 * t), 0.0, AXIAL];
        let mut moment = cross(times(&turned, [0.0, 0.0, LOAD_POINT]), force);
        let mut acceleration = vec![0.0; n];
        for (b, psi) in self.azimuths.iter().enumerate() {
            let (sin, cos) = psi.sin_cos();
            let (r, z) = (
                self.ball_centre[0] + at(N_SHAFT + 2 * b),
                self.ball_centre[1] + at(N_SHAFT + 1 + 2 * b),
            );
            for side in 0..2 {
                let [radius, groove_z, touching] = self.grooves[side];
                let (mut arm, mut moved) = ([radius * cos, radius * sin, 0.0], [0.0; 3]);
                if side == 0 {
                    (arm, moved) = (times(&turned, arm), place);
                }
                let centre = [0, 1, 2].map(|i| arm[i] + moved[i]);
                let l = [r - centre[0] * cos - centre[1] * sin, z - groove_z - centre[2]];
                let length = l[0].hypot(l[1]);
                let size = self.stiffness[side] * (length - touching).max(0.0).powf(1.5) / length;
                acceleration[N_SHAFT + 2 * b] -= size * l[0] / self.ball_mass;
                acceleration[N_SHAFT + 1 + 2 * b] -= size * l[1] / self.ball_mass;
                if side == 0 {
                    let on_ring = [size * l[0] * cos, size * l[0] * sin, size * l[1]];
                    let about = cross(arm, on_ring);
                    (0..3)
                        .for_each(|i| (force[i], moment[i]) = (force[i] + on_ring[i], moment[i] + about[i]));
                }
            }
        }
        (0..3).for_each(|i| acceleration[i] = force[i] / SHAFT_MASS);
        if self.transverse > 0.0 {
            let on_tilts = on_tilts(tilt, moment);
            (0..2).for_each(|i| acceleration[3 + i] = on_tilts[i] / self.transverse);
        }
        // Per s^2 to units per us^2.
        for i in 0..n {
            dy[i] = y[n + i];
            dy[n + i] = 1e-12 * acceleration[i] / unit(i);
        }
    }
}

/// Errors of a motion of 100, 200 and 400 steps over how far the shaft moved, against a Runge-Kutta solution.
fn errors(mut model: Model) -> [f64; 3] {
    let start = equilibrium(&model);
    model.effects.push(Box::new(Pulse));
    let n = N_SHAFT + 36;
    let mut initial = DVector::zeros(2 * n);
    (0..N_SHAFT).for_each(|i| initial[i] = start.displacements.shaft[i] / unit(i));
    for (b, ball) in start.displacements.balls.iter().enumerate() {
        (0..2).for_each(|i| initial[N_SHAFT + 2 * b + i] = 1e6 * ball.to_array()[i]);
    }
    // The classical fourth-order scheme at 1/1000 of the shortest period, 23 us: exact to 1e-9.
    let mut solver = Rk4::new(Bearing::new(&model), 0.0, initial, 1e6 * PERIOD, 0.02);
    solver.integrate().unwrap();
    let last = solver.y_out().last().unwrap();
    let exact: Vec<f64> = (0..n).map(|i| unit(i) * last[i]).collect();
    let scale = exact[0].abs();
    println!("moved by {scale:.3e} m, tilted by {:.3e} rad", exact[4]);
    assert!(scale > 1e-7 && (model.shaft_inertia.transverse == 0.0) == (exact[4] == 0.0));
    let found = [100, 200, 400].map(|steps| {
        let settings = MotionSettings::conserving(PERIOD / f64::from(steps), Speed::constant(0.0));
        let motion = Motion::new(&model, settings).unwrap();
        let mut state = motion.start(&start);
        let mut cache = StepCache::default();
        for _ in 0..steps {
            state = motion.step(&state, &mut cache).unwrap().0;
        }
        let shaft = (0..N_SHAFT).map(|i| (state.shaft[i] - exact[i]).abs() * 1e-6 / unit(i));
        let balls = (0..18).flat_map(|b| [0, 1].map(|i| (b, i)));
        let balls = balls.map(|(b, i)| (state.balls[b].to_array()[i] - exact[N_SHAFT + 2 * b + i]).abs());
        shaft.chain(balls).fold(0.0, f64::max) / scale
    });
    println!("errors {found:?}");
    found
}

/// Wrong: motion would not be the solution of the equations of motion. A smooth radial pulse on a preloaded bearing
/// with rigid rings, against a Runge-Kutta solution of independently written equations: the error falls with the
/// square of the step, and is below 1e-4 of the displacement at 0.5 us. The load acts off the plane of the balls, where
/// the tilts are free too.
#[test]
fn rigid_rings_follow_an_independent_ode_solution() {
    for transverse in [0.0, 1e-4] {
        let mut case = Case::axial(AXIAL);
        (case.free_tilt, case.load_point) = (transverse > 0.0, LOAD_POINT);
        let mut model = case.rigid();
        model.shaft_mass = SHAFT_MASS;
        model.shaft_inertia.transverse = transverse;
        let errors = errors(model);
        assert!(errors[2] < 1e-4, "{errors:?}");
        let order = (errors[1] / errors[2]).log2();
        assert!((order - 2.0).abs() < 0.1, "{order}");
        // What is left as the step goes to zero (Richardson).
        let limit = (4.0 * errors[2] - errors[1]) / 3.0;
        assert!(limit.abs() < 2e-6, "{limit}");
    }
}
