//! Motion under loads that follow the contact angles, and with a shaft that is driven.

use dynamics::effects::{BallCentrifugal, GyroscopicMoment, MomentShares, Now};
use dynamics::kinematics::{BallSpeeds, Speed};
use dynamics::motion::{Motion, MotionSettings, MotionState};
use dynamics::{ContactMode, Hold, Model, Pose, ShaftDof, StaticSolver};
use input::Schedule;

use crate::support::rings::Level;
use crate::support::{Case, equilibrium, states_from};

const SMALL: Level = Level::hex8(54, 6, 1, 2);
/// 15 000 rpm, rad/s.
const FAST: f64 = 500.0 * std::f64::consts::PI;

fn settings(dt: f64, speed: f64) -> MotionSettings {
    MotionSettings::conserving(dt, Speed::constant(speed))
}

fn spinning(mut model: Model, shares: [f64; 2]) -> Model {
    let (speed, slip) = (Speed::constant(FAST), [0.0; 2]);
    model.effects.push(Box::new(BallCentrifugal {
        speeds: speed.clone().into(),
        slip,
        ball_speeds: BallSpeeds::FreeAngle,
    }));
    model.effects.push(Box::new(GyroscopicMoment {
        speeds: speed.into(),
        slip,
        shares: MomentShares {
            inner: shares[0],
            outer: shares[1],
        },
        ball_speeds: BallSpeeds::FreeAngle,
    }));
    model.shaft_mass = 0.5;
    model
}

fn run(model: &Model, settings: MotionSettings, n: usize) -> Vec<MotionState> {
    let motion = Motion::new(model, settings).unwrap();
    states_from(&motion, motion.start(&equilibrium(model)), n)
}

fn assert_ledger_closes(states: &[MotionState]) {
    for (i, state) in states.iter().enumerate() {
        let defect = state.ledger.relative_defect();
        assert!(defect.abs() < 1e-9, "step {i}: {defect}");
    }
}

/// Wrong: motion would load the balls otherwise than statics does. Thrust alone is the same all round, so the
/// equilibrium at speed lasts while the balls go round.
#[test]
fn an_equilibrium_with_the_gyroscopic_moment_lasts() {
    for shares in [[0.0, 2.0], [1.0, 1.0]] {
        let model = spinning(Case::axial(2000.0).rigid(), shares);
        let states = run(&model, settings(1e-5, FAST), 50);
        for (a, b) in states[0].balls.iter().zip(&states[50].balls) {
            assert!((*a - *b).norm() < 1e-12, "{a:?} {b:?}");
        }
        assert!((states[0].angles[1] - states[50].angles[1]).abs() < 1e-8);
        assert_ledger_closes(&states);
    }
}

/// Wrong: the work of friction on rings and balls would be missing in the ledger, or be counted twice. A radial
/// force, so all angles change; flexible and rigid rings.
#[test]
fn the_ledger_closes_with_the_gyroscopic_moment() {
    let case = Case {
        radial: 800.0,
        ..Case::axial(2000.0)
    };
    let flexible = case.flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    for model in [case.rigid(), flexible] {
        assert_ledger_closes(&run(&spinning(model, [1.0, 1.0]), settings(1e-5, FAST), 60));
    }
}

/// The bearing whose shaft is driven along z from 15 to 30 um, first at rest and then without a jump of its velocity.
fn driven(rigid: bool) -> Model {
    let case = Case::axial(0.0);
    let mut model = if rigid {
        case.rigid()
    } else {
        case.flexible(ContactMode::Patch, SMALL, Hold::Clamped)
    };
    model.effects.clear();
    model.shaft_mass = 0.5;
    model.shaft[2] = ShaftDof::Prescribed(30e-6);
    // Half a period of 1 ms about the mean, then the mean: from the trough upwards.
    model.shaft_schedules[2] = Schedule::Harmonic {
        frequency: 500.0,
        phase: -0.5 * std::f64::consts::PI,
        mean: 0.75,
        amplitude: 0.25,
    };
    model
}

/// Wrong: a driven shaft would not be where its schedule has it, its work would be missing in the ledger, or balls
/// would not follow: driven slowly against their modes, their forces are those of statics at the same place.
#[test]
fn a_driven_shaft_moves_the_balls() {
    for rigid in [true, false] {
        let model = driven(rigid);
        let states = run(&model, settings(1e-5, 0.0), 100);
        assert_ledger_closes(&states);
        assert_eq!(
            Some(states[0].shaft_velocity[2]),
            model.prescribed_rate(2, 0.0),
            "it starts with the drive"
        );
        let mut solver = StaticSolver::new(&model).unwrap();
        for (i, state) in states.iter().enumerate().skip(10).step_by(10) {
            let end = 1e-5 * i as f64;
            assert!((state.shaft[2] - model.prescribed(2, end).unwrap()).abs() < 1e-18);
            let now = Now {
                time: end - 0.5e-5,
                ..Now::default()
            };
            let pose = Pose {
                now,
                ring_angles: [0.0, 0.0],
                rolled: 0.0,
            };
            let statics = solver.solve_at(&model, &pose, None).unwrap();
            let (force, still) = (state.forces[0].norm(), statics.balls[0].inner.force_n);
            // Forces are means over the step. The ball's modes are above 4 kHz, the drive is at 0.5 kHz: (1/8)^2 / 2
            // of the change at most.
            assert!(
                (force - still).abs() < 0.01 * still,
                "{rigid}, step {i}: {force} {still}"
            );
        }
    }
}
