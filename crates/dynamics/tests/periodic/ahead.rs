//! A step begins with what the one before has found: of periodic rings in its pass over the harmonics, of others of
//! K and M on its last state.

use dynamics::effects::{Gravity, RingDamping};
use dynamics::motion::RingState;
use dynamics::motion::{Integrator, Ladder};
use input::Schedule;

use super::*;

/// The state as a step file holds it: without what the step before has found of the next.
pub(super) fn alone(state: &MotionState) -> MotionState {
    let mut alone = state.clone();
    for ring in alone.rings.iter_mut().flatten() {
        *ring = RingState::new(
            ring.displacement().to_vec(),
            ring.velocity().to_vec(),
            ring.acceleration().to_vec(),
        );
    }
    alone
}

/// Wrong: a resumed run would not go on as the run that was never stopped, or a step of another size would begin with
/// what was found for the size before. Clamped and in mean motion, with all that known loads and history may hold,
/// and sizes that change.
#[test]
fn a_step_from_its_state_alone_has_the_same_bits() {
    let conserving = MotionSettings::conserving(5e-6, Speed::constant(SPEED));
    let adaptive = Ladder {
        halvings: 3,
        tolerance: Some(2e-5),
    };
    let cases = [
        (Hold::Clamped, conserving.clone()),
        (
            Hold::MeanMotion,
            MotionSettings {
                integrator: Integrator::chung_hulbert(0.8),
                rayleigh: RingDamping {
                    mass: 300.0,
                    stiffness: 2e-8,
                },
                ..conserving.clone()
            },
        ),
        (
            Hold::Clamped,
            MotionSettings {
                dt: 4e-5,
                ladder: adaptive,
                speeds: Speed::table(vec![0.0, 1e-3], vec![SPEED, 2.0 * SPEED]).into(),
                ..conserving
            },
        ),
    ];
    let backends = [(Backend::Auto, "cyclic"), (Backend::Sparse, "sparse")];
    let all = backends
        .iter()
        .flat_map(|&backend| cases.iter().map(move |case| (backend, case.clone())));
    for ((backend, name), (hold, settings)) in all {
        let mut model = bearing(HEX8, hold, backend);
        let gravity = Gravity::new([0.0, -9.81, 0.0], Schedule::Constant, &model.rings).unwrap();
        model.effects.push(Box::new(gravity));
        model
            .effects
            .push(Box::new(FrameRotation::new(settings.speeds.clone())));
        let start = statics(&model, name);
        let motion = Motion::new(&model, settings).unwrap();
        let mut state = motion.start(&start);
        let mut parts = 0;
        let mut cache = StepCache::default();
        for _ in 0..6 {
            let (next, report) = motion.step(&state, &mut cache).unwrap();
            let (expected, _) = motion.step(&alone(&state), &mut StepCache::default()).unwrap();
            assert!(next == expected, "{name}, {hold:?}, step {}", next.step);
            parts += report.substeps;
            state = next;
        }
        assert!(hold == Hold::MeanMotion || state.ledger.relative_defect().abs() < 1e-9);
        println!("{name}, {hold:?}: {parts} parts of 6 steps");
    }
}
