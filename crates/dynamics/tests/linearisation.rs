//! Modes of a bearing with rigid rings against the eigenvalues of its own motion, linearised by differences.

use std::f64::consts::TAU;

use crate::support::{Case, equilibrium, relative};
use contact::Meridian;
use dynamics::kinematics::Speed;
use dynamics::model::ShaftInertia;
use dynamics::modes::{ModesSettings, bearing_modes};
use dynamics::motion::{Motion, MotionSettings, MotionState, StepCache};
use dynamics::whirl::{TurningShaft, turning_inertia};
use dynamics::{Backend, DampingLaws, Linearisation, Model, ShaftDof, StaticSolver};
use ode_solvers::DVector;

/// Dofs of the shaft.
const N_SHAFT: usize = 5;
/// One step, s.
const STEP: f64 = 1e-6;
/// Size of a difference, m, and over this time that of a velocity, s: 1/2000 of an approach, so that what is not linear
/// is of its square.
const SIZE: f64 = 2e-9;
const TIME: f64 = 1e-5;
/// Tilts count at this radius, m.
const RADIUS: f64 = 0.03;

/// The state with one of its numbers changed: places of shaft and balls, then velocities.
fn changed(state: &MotionState, k: usize, by: f64) -> MotionState {
    let n = N_SHAFT + 2 * state.balls.len();
    let mut state = state.clone();
    let (i, size) = if k < n { (k, SIZE) } else { (k - n, SIZE / TIME) };
    let tilt = if (3..N_SHAFT).contains(&i) { RADIUS } else { 1.0 };
    let change = by * size / tilt;
    let (ball, direction) = (i.saturating_sub(N_SHAFT) / 2, i.saturating_sub(N_SHAFT) % 2);
    match (k < n, i < N_SHAFT) {
        (true, true) => state.shaft[i] += change,
        (true, false) => moved(&mut state.balls[ball], direction, change),
        (false, true) => state.shaft_velocity[i] += change,
        (false, false) => moved(&mut state.ball_velocities[ball], direction, change),
    }
    state
}

fn moved(ball: &mut Meridian, direction: usize, change: f64) {
    *[&mut ball.radial, &mut ball.axial][direction] += change;
}

/// The same numbers in units of their changes.
fn numbers(state: &MotionState) -> Vec<f64> {
    let part = |shaft: &[f64; N_SHAFT], balls: &[Meridian], size: f64| {
        let shaft = (0..N_SHAFT).map(|i| shaft[i] * if i < 3 { 1.0 } else { RADIUS } / size);
        let balls = balls.iter().flat_map(|ball| ball.to_array()).map(|x| x / size);
        shaft.chain(balls).collect::<Vec<f64>>()
    };
    let mut all = part(&state.shaft, &state.balls, SIZE);
    all.extend(part(&state.shaft_velocity, &state.ball_velocities, SIZE / TIME));
    all
}

/// Frequencies, Hz, ascending, and the largest growth over its frequency, of a motion about an equilibrium at a speed,
/// rad/s. A step of the middle rule has the factors (1 + a)/(1 - a) with a half the step times the eigenvalue.
fn of_the_motion(model: &Model, speed: f64) -> (Vec<f64>, f64) {
    let start = equilibrium(model);
    let motion = Motion::new(model, MotionSettings::conserving(STEP, Speed::constant(speed))).unwrap();
    let state = motion.start(&start);
    let after = |k: usize, by: f64| {
        let next = motion
            .step(&changed(&state, k, by), &mut StepCache::default())
            .unwrap();
        numbers(&next.0)
    };
    let n = 2 * (N_SHAFT + 2 * state.balls.len());
    let column = DVector::<f64>::zeros(n);
    let mut factors = &column * column.transpose();
    for k in 0..n {
        let (more, less) = (after(k, 1.0), after(k, -1.0));
        (0..n).for_each(|i| factors[(i, k)] = 0.5 * (more[i] - less[i]));
    }
    let (mut frequencies, mut growth) = (Vec::new(), 0.0f64);
    for factor in factors.complex_eigenvalues().iter() {
        let eigenvalue = (factor - 1.0) / (factor + 1.0) * (2.0 / STEP);
        if eigenvalue.im > 0.0 {
            frequencies.push(eigenvalue.im / TAU);
            growth = growth.max(eigenvalue.re.abs() / eigenvalue.im);
        }
    }
    frequencies.sort_by(f64::total_cmp);
    (frequencies, growth)
}

/// A rotor that may move and tilt.
fn rotor(case: Case) -> Model {
    let mut model = case.rigid();
    model.shaft = [ShaftDof::Free; N_SHAFT];
    model.shaft_mass = 0.6;
    model.shaft_inertia = ShaftInertia {
        transverse: 2.4e-4,
        polar: 3.1e-4,
    };
    model
}

fn check(found: &[f64], expected: &[f64], growth: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    let worst = found
        .iter()
        .zip(expected)
        .map(|(a, b)| relative(*a, *b))
        .fold(0.0, f64::max);
    println!(
        "{:.2?} ... {:.1} Hz; {worst:.1e} off, growth {growth:.1e}",
        &expected[..6],
        expected.last().unwrap()
    );
    assert!(worst < 1e-6, "{worst:e}");
    assert!(growth < 1e-6, "{growth:e}");
}

/// Wrong: modes would be those of another bearing than the one that moves: moments of inertia, or the levers of a
/// tilted ring, missing from either. Loads across and a moment that tilts the shaft; some balls carry little.
#[test]
fn modes_of_rigid_rings_are_those_of_their_motion() {
    let model = rotor(Case {
        radial: 1500.0,
        moment: 8.0,
        free_tilt: true,
        ..Case::axial(2000.0)
    });
    let solution = equilibrium(&model);
    println!(
        "tilt {:.2e} rad",
        solution.displacements.shaft[4].hypot(solution.displacements.shaft[3])
    );
    let settings = ModesSettings {
        number: 41,
        shift: None,
        backend: Backend::Auto,
    };
    let set = bearing_modes(&model, &solution, settings, &mut |_| {}).unwrap();
    let expected: Vec<f64> = set.modes.iter().map(|mode| mode.frequency).collect();
    let (found, growth) = of_the_motion(&model, 0.0);
    check(&found, &expected, growth);
}

/// Wrong: the gyroscopic moment of the modes at speed would not be that of the motion, or part the pairs of a forward
/// and a backward mode by another width. Under thrust, where the bearing is the same wherever its balls are.
#[test]
fn modes_at_speed_are_those_of_the_motion() {
    let model = rotor(Case {
        free_tilt: true,
        ..Case::axial(2000.0)
    });
    for speed in [1000.0, 6000.0] {
        let mut solver = StaticSolver::new(&model).unwrap();
        let solution = solver.solve(&model, None).unwrap();
        let bearing = Linearisation::new(&model, &solver, &solution, DampingLaws::default()).unwrap();
        let shaft = TurningShaft::new(&model, &bearing, turning_inertia(&model).unwrap(), speed).unwrap();
        let mut expected: Vec<f64> = shaft.modes().unwrap().iter().map(|mode| mode.frequency).collect();
        expected.sort_by(f64::total_cmp);
        let (found, growth) = of_the_motion(&model, speed);
        check(&found, &expected, growth);
    }
}
