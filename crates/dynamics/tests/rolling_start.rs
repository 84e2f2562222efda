//! Motions that start on the course of the equilibria of a bearing that rolls.

use crate::support::Case;
use contact::Meridian;
use dynamics::interactions::contact_damping::ContactDamping;
use dynamics::kinematics::{Rolling, Speed};
use dynamics::model::ShaftInertia;
use dynamics::motion::{EquilibriumRates, Motion, MotionSettings, MotionState, StepCache};
use dynamics::{Model, StaticSolution, StaticSolver};

/// Speed of the shaft, rad/s: 40 000 rpm.
pub const SPEED: f64 = 40e3 * std::f64::consts::PI / 30.0;

/// A load along the axis and one across.
pub fn combined() -> Case {
    Case {
        free_tilt: true,
        radial: 1000.0,
        ..Case::axial(2000.0)
    }
}

/// A spindle on rigid rings.
pub fn spindle(case: Case) -> Model {
    let mut model = case.rigid();
    model.shaft_mass = 0.15;
    model.shaft_inertia = ShaftInertia {
        transverse: 6e-5,
        polar: 1.1e-4,
    };
    model
}

fn case() -> (Model, Rolling) {
    let model = spindle(combined());
    let rolling = rolling(&model);
    (model, rolling)
}

/// How its balls roll.
pub fn rolling(model: &Model) -> Rolling {
    Rolling::new(&model.geometry, Speed::constant(SPEED), [0.0; 2])
}

/// The equilibrium, and the rates with which it goes round.
pub fn found((model, rolling): (&Model, &Rolling)) -> (StaticSolution, EquilibriumRates) {
    let mut solver = StaticSolver::new(model).unwrap();
    let at = solver.solve(model, None).unwrap();
    let rates = EquilibriumRates::find(&mut solver, (model, rolling), &at).unwrap();
    (at, rates)
}

/// Wrong: balls would start with another velocity than that of their place in the bearing as they go round. All balls
/// are alike, so their places at one instant are one course: its derivative by Fourier's series on 18 points times the
/// speed of the cage, another way to the same.
#[test]
fn balls_have_the_velocities_of_their_orbits() {
    let (model, rolling) = case();
    let (at, rates) = found((&model, &rolling));
    let cage = rolling.kinematics.cage_speed(&rolling.speeds, 0.0);
    let n = model.geometry.n_balls;
    let expected = |b: usize| {
        let others = (0..n).filter(|&c| c != b);
        others.fold(Meridian::default(), |sum, c| {
            let apart = (b + n - c) % n;
            let angle = std::f64::consts::PI * apart as f64 / n as f64;
            let sign = if apart.is_multiple_of(2) { 1.0 } else { -1.0 };
            sum + at.displacements.balls[c].map(|x| 0.5 * sign * cage * x / angle.tan())
        })
    };
    let largest = rates.balls.iter().map(|v| v.norm()).fold(0.0, f64::max);
    let off = (0..n).map(|b| (rates.balls[b] - expected(b)).norm());
    let worst = off.fold(0.0, f64::max) / largest;
    println!("up to {largest:.4} m/s, off by {worst:.1e}");
    assert!(largest > 1e-3 && worst < 0.01, "{worst}");
}

/// Shaft tilts over the steps of 6 ms with damped contacts, the first that of the start.
pub fn tilts(model: &Model, dt: f64, first: impl Fn(&Motion<'_>) -> MotionState) -> Vec<f64> {
    let settings = MotionSettings {
        contact_damping: Some(ContactDamping {
            coefficient: 100.0,
            full_approach: 1e-6,
        }),
        ..MotionSettings::conserving(dt, Speed::constant(SPEED))
    };
    let motion = Motion::new(model, settings).unwrap();
    let mut state = first(&motion);
    let mut cache = StepCache::default();
    let mut tilts = vec![state.shaft[4]];
    for _ in 0..(6e-3 / dt).round() as usize {
        state = motion.step(&state, &mut cache).unwrap().0;
        assert!(state.ledger.relative_defect().abs() < 1e-10);
        tilts.push(state.shaft[4]);
    }
    tilts
}

/// Wrong: balls at rest in their meridian planes would strike a bearing at high speed: its tilt swings by 5 %. With
/// the velocities of their orbits it stays within 1 % of the equilibrium, a quarter per cent beside it because balls
/// that move on their orbits have inertia.
#[test]
fn a_bearing_that_starts_rolling_hardly_swings() {
    let (model, rolling) = case();
    let (at, rates) = found((&model, &rolling));
    let swing = |tilts: &[f64]| {
        let share = |t: &f64| t / tilts[0] - 1.0;
        let [low, high] = [f64::min, f64::max].map(|of| tilts.iter().map(share).fold(0.0, of));
        high - low
    };
    let resting = swing(&tilts(&model, 1e-5, |motion| motion.start(&at)));
    let moving = swing(&tilts(&model, 1e-5, |motion| {
        motion.start_with(&at, Some(&rates))
    }));
    println!("swings by {resting:.4} from rest, {moving:.4} rolling");
    assert!(resting > 0.03 && moving < 0.01, "{resting} {moving}");
}

/// Wrong: a bearing whose balls do not go round would start with velocities.
#[test]
fn a_bearing_that_stands_starts_at_rest() {
    let (model, _) = case();
    let standing = Rolling::new(&model.geometry, Speed::constant(0.0), [0.0; 2]);
    let (_, rates) = found((&model, &standing));
    assert!(rates.shaft == [0.0; 5] && rates.balls.iter().all(|v| *v == Meridian::default()));
}
