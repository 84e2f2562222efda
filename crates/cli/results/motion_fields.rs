//! Nodal fields of one instant of a motion; the state of the run is stored beside, bit for bit.

use std::collections::BTreeMap;

use checkpoint::{StateArray, StepRecord};
use contact::Side;
use dynamics::Model;
use dynamics::motion::{Motion, MotionState};
use fem::stress::StressRecovery;

use super::fields::points;
use super::shown::Shown;

/// The record of one instant.
pub fn record(
    model: &Model,
    motion: &Motion<'_>,
    state: &MotionState,
    recoveries: &[Option<StressRecovery>; 2],
    scene: &str,
) -> StepRecord {
    let shown = Shown::Motion { model, motion, state };
    StepRecord {
        step: state.step,
        time: motion.time(state.step),
        points: points(&shown, recoveries),
        scene: scene.to_string(),
        state: arrays(state),
    }
}

/// Everything that evolves, by name.
fn arrays(state: &MotionState) -> BTreeMap<String, StateArray> {
    let ledger = &state.ledger;
    let works = [
        ledger.load_work,
        ledger.patch_work,
        ledger.contact_loss,
        ledger.rayleigh_loss,
    ];
    let mut arrays = BTreeMap::from([
        ("balls".to_string(), StateArray::Real(state.balls.concat())),
        (
            "ball_velocities".to_string(),
            StateArray::Real(state.ball_velocities.concat()),
        ),
        ("shaft".to_string(), StateArray::Real(state.shaft.to_vec())),
        (
            "shaft_velocity".to_string(),
            StateArray::Real(state.shaft_velocity.to_vec()),
        ),
        ("forces".to_string(), StateArray::Real(state.forces.concat())),
        ("angles".to_string(), StateArray::Real(state.angles.clone())),
        (
            "approaches".to_string(),
            StateArray::Real(state.approaches.clone()),
        ),
        ("ledger_works".to_string(), StateArray::Real(works.to_vec())),
        (
            "ledger_scale".to_string(),
            StateArray::Real(vec![ledger.initial, ledger.largest, ledger.hertz]),
        ),
    ]);
    for (side, ring) in Side::BOTH.into_iter().zip(&state.rings) {
        if let Some(ring) = ring {
            for (name, values) in [("w", &ring.w), ("v", &ring.v), ("a", &ring.a)] {
                arrays.insert(
                    format!("{}_{name}", side.name()),
                    StateArray::Real(values.clone()),
                );
            }
        }
    }
    arrays
}
