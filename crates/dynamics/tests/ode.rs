//! Rigid rings against an independent solution of their equations by an ODE solver.

mod support;

use contact::Side;
use dynamics::effects::{Effect, Loads, Now};
use dynamics::kinematics::Speed;
use dynamics::motion::{Motion, MotionSettings, StepCache};
use dynamics::{DynamicsError, Model};
use ode_solvers::rk4::Rk4;
use ode_solvers::{DVector, System};
use support::{Case, equilibrium};

/// A radial force F sin^2(pi t / T): smooth, zero with zero slope at the start.
#[derive(Clone, Copy)]
struct Pulse;

const FORCE: f64 = 400.0;
const PERIOD: f64 = 2e-4;
const SHAFT_MASS: f64 = 0.5;
const AXIAL: f64 = 1000.0;

fn pulse(t: f64) -> f64 {
    FORCE * (std::f64::consts::PI * t / PERIOD).sin().powi(2)
}

impl Effect for Pulse {
    fn name(&self) -> &'static str {
        "pulse"
    }

    fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        loads.add_shaft_force(model, [pulse(now.time), 0.0, 0.0]);
        Ok(())
    }
}

/// The equations of shaft (x, y, z) and balls (radial, axial) between two rigid tori, written anew from the bearing's
/// dimensions: state = displacements, um, then velocities, um/us, over time in us: numbers of like size.
struct Bearing {
    azimuths: Vec<f64>,
    ball_mass: f64,
    stiffness: [f64; 2],
    /// Groove centre radius, axial position, and distance of touching: inner, outer.
    grooves: [[f64; 3]; 2],
    ball_centre: [f64; 2],
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
        }
    }
}

impl System<f64, DVector<f64>> for Bearing {
    fn system(&self, t: f64, y: &DVector<f64>, dy: &mut DVector<f64>) {
        let n = 3 + 2 * self.azimuths.len();
        let at = |i: usize| 1e-6 * y[i];
        for i in 0..n {
            dy[i] = y[n + i];
            dy[n + i] = 0.0;
        }
        dy[n] = pulse(1e-6 * t) / SHAFT_MASS;
        dy[n + 2] = AXIAL / SHAFT_MASS;
        for (b, psi) in self.azimuths.iter().enumerate() {
            let shaft = [at(0) * psi.cos() + at(1) * psi.sin(), at(2)];
            for side in 0..2 {
                let [radius, z, touching] = self.grooves[side];
                let ring = if side == 0 { shaft } else { [0.0; 2] };
                let l = [
                    self.ball_centre[0] + at(3 + 2 * b) - radius - ring[0],
                    self.ball_centre[1] + at(4 + 2 * b) - z - ring[1],
                ];
                let length = l[0].hypot(l[1]);
                let force = self.stiffness[side] * (length - touching).max(0.0).powf(1.5);
                let [radial, axial] = [force * l[0] / length, force * l[1] / length];
                dy[n + 3 + 2 * b] -= radial / self.ball_mass;
                dy[n + 4 + 2 * b] -= axial / self.ball_mass;
                if side == 0 {
                    dy[n] += radial * psi.cos() / SHAFT_MASS;
                    dy[n + 1] += radial * psi.sin() / SHAFT_MASS;
                    dy[n + 2] += axial / SHAFT_MASS;
                }
            }
        }
        // m/s^2 to um/us^2.
        (n..2 * n).for_each(|i| dy[i] *= 1e-6);
    }
}

/// Wrong: motion would not be the solution of the equations of motion. A smooth radial pulse on a preloaded bearing
/// with rigid rings, against a Runge-Kutta solution of independently written equations: the error falls with the
/// square of the step, and is below 1e-4 of the displacement at 0.5 us.
#[test]
fn rigid_rings_follow_an_independent_ode_solution() {
    let mut model = Case::axial(AXIAL).rigid();
    model.shaft_mass = SHAFT_MASS;
    let start = equilibrium(&model);
    model.effects.push(Box::new(Pulse));
    let n = 3 + 36;
    let mut initial = DVector::zeros(2 * n);
    (0..3).for_each(|i| initial[i] = 1e6 * start.displacements.shaft[i]);
    for (b, ball) in start.displacements.balls.iter().enumerate() {
        (0..2).for_each(|i| initial[3 + 2 * b + i] = 1e6 * ball[i]);
    }
    // The classical fourth-order scheme at 1/1000 of the shortest period, 23 us: exact to 1e-9.
    let mut solver = Rk4::new(Bearing::new(&model), 0.0, initial, 1e6 * PERIOD, 0.02);
    solver.integrate().unwrap();
    let exact = solver.y_out().last().unwrap() * 1e-6;
    let scale = exact[0].abs();
    let error = |steps: usize| {
        let settings = MotionSettings::conserving(PERIOD / steps as f64, Speed::constant(0.0));
        let motion = Motion::new(&model, settings).unwrap();
        let mut state = motion.start(&start);
        let mut cache = StepCache::default();
        for _ in 0..steps {
            state = motion.step(&state, &mut cache).unwrap().0;
        }
        let shaft = (0..3)
            .map(|i| (state.shaft[i] - exact[i]).abs())
            .fold(0.0, f64::max);
        let balls = (0..18).flat_map(|b| (0..2).map(move |i| (b, i)));
        balls
            .map(|(b, i)| (state.balls[b][i] - exact[3 + 2 * b + i]).abs())
            .fold(shaft, f64::max)
            / scale
    };
    let errors = [error(100), error(200), error(400)];
    println!("moved by {scale:.3e} m, errors {errors:?}");
    assert!(scale > 1e-7, "{scale}");
    assert!(errors[2] < 1e-4, "{errors:?}");
    let order = (errors[1] / errors[2]).log2();
    assert!((order - 2.0).abs() < 0.1, "{order}");
}
