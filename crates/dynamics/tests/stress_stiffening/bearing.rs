//! Bearings whose rings their stress stiffens.

use dynamics::effects::FrameRotation;
use dynamics::interactions::contact_damping::ContactDamping;
use dynamics::kinematics::Speed;
use dynamics::motion::{Motion, MotionSettings, MotionState};
use dynamics::{Backend, ContactMode, Hold, Model, StaticSolution};
use ring::Frame;

use super::rpm;
use crate::support::rings::Level;
use crate::support::{Case, equilibrium, states_from};

/// A bearing whose rings are held like this, that turns with this speed.
fn turning(hold: Hold, case: Case, level: Level, (speed, frame): (&Speed, Frame)) -> Model {
    let mut model = case.flexible(ContactMode::Patch, level, hold);
    let turning = FrameRotation::new(speed.clone());
    match frame {
        Frame::Still => (),
        Frame::Turning => model.effects.push(Box::new(turning)),
        Frame::Stiffened => model.effects.push(Box::new(turning.stiffened())),
    }
    model
}

fn run(model: &Model, start: &StaticSolution, settings: MotionSettings, n: usize) -> Vec<MotionState> {
    let motion = Motion::new(model, settings).unwrap();
    states_from(&motion, motion.start(start), n)
}

/// Wrong: harmonics would hold another stress than the sparse matrix, with the rows of a shaft that tilts or without,
/// or the work of the stress would be missing in the ledger. A load step while the speed falls from 40 000 rpm.
#[test]
fn harmonics_and_the_sparse_matrix_agree_and_the_ledger_closes() {
    let speed = Speed::table(vec![0.0, 1e-3], vec![rpm(40e3), rpm(30e3)]);
    for hold in [Hold::Clamped, Hold::MeanMotion] {
        let before = Case {
            free_tilt: true,
            ..Case::axial(1000.0)
        };
        let level = Level::hex8(54, 6, 1, 2);
        let start = equilibrium(&turning(hold, before, level, (&speed, Frame::Stiffened)));
        let after = Case {
            radial: 1500.0,
            ..before
        };
        let ends = [Frame::Stiffened, Frame::Turning].map(|frame| {
            [Backend::Auto, Backend::Sparse].map(|backend| {
                let mut model = turning(hold, after, level, (&speed, frame));
                model.backend = backend;
                let settings = MotionSettings::conserving(1e-5, speed.clone());
                run(&model, &start, settings, 60).pop().unwrap()
            })
        });
        let off = |[a, b]: [&MotionState; 2]| {
            let largest = a.forces.iter().map(|f| f.norm()).fold(0.0, f64::max);
            let pairs = a.forces.iter().zip(&b.forces);
            pairs.map(|(a, b)| (*a - *b).norm()).fold(0.0, f64::max) / largest
        };
        let [[cyclic, sparse], [plain, _]] = &ends;
        let (same, other) = (off([cyclic, sparse]), off([cyclic, plain]));
        let defects = [cyclic, sparse].map(|state| state.ledger.relative_defect().abs());
        println!("{hold:?}: {same:.1e}, without stress {other:.1e}; ledger {defects:?}");
        assert!(same < 1e-9, "{hold:?}: {same:e}");
        assert!(other > 1e-6, "{hold:?}: {other:e}");
        assert!(defects.into_iter().all(|defect| defect < 1e-9), "{defects:?}");
    }
}

/// Wrong: a bearing with rings in their mean motion would settle elsewhere than in its equilibrium. 40 000 rpm under a
/// load across, damped contacts: where the shaft stands along its axis, by the mean over a millisecond without a step.
#[test]
fn a_bearing_settles_nearer_to_its_equilibrium_with_the_stress() {
    let speed = Speed::constant(rpm(40e3));
    let case = Case {
        radial: 1000.0,
        free_tilt: true,
        ..Case::axial(2000.0)
    };
    let [with, without] = [Frame::Stiffened, Frame::Turning].map(|frame| {
        let model = turning(Hold::MeanMotion, case, Level::hex8(36, 6, 1, 2), (&speed, frame));
        let start = equilibrium(&model);
        let [coarse, fine] = [100, 200].map(|steps| {
            let settings = MotionSettings {
                contact_damping: Some(ContactDamping {
                    coefficient: 50.0,
                    full_approach: 1e-6,
                }),
                ..MotionSettings::conserving(2e-3 / steps as f64, speed.clone())
            };
            let states = run(&model, &start, settings, steps);
            let late = states[steps / 2..].iter().map(|state| state.shaft[2]);
            late.sum::<f64>() / (steps - steps / 2 + 1) as f64 / start.displacements.shaft[2] - 1.0
        });
        2.0 * fine - coarse
    });
    println!("off by {with:.2e} with the stress, {without:.2e} without");
    assert!(with.abs() < 7e-4 && without.abs() > 1e-3, "{with} {without}");
}
