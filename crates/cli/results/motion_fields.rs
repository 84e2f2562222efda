//! Nodal fields of one instant of a motion; the state of the run is stored beside, bit for bit.

use checkpoint::{PointFields, StepRecord};
use dynamics::Model;
use dynamics::motion::{Motion, MotionState};
use fem::stress::StressRecovery;

use super::fields::Unstressed;
use super::shown::Shown;
use super::state_arrays;
use crate::scene::Scene;

/// What makes the record of one instant. It has copied all it needs, so that stress is recovered where and when it is
/// called.
pub fn record_later(
    model: &Model,
    motion: &Motion<'_>,
    state: &MotionState,
    scene: &Scene,
) -> impl FnOnce(&[Option<StressRecovery>; 2]) -> StepRecord + Send + use<> {
    let unstressed = Unstressed::new(&Shown::Motion { model, motion, state }, scene.output.inner_ring);
    let record = StepRecord {
        step: state.step,
        time: motion.time(state.step),
        points: PointFields::default(),
        scene: scene.text.clone(),
        state: state_arrays::store(state, &motion.shape()),
    };
    move |recoveries| StepRecord {
        points: unstressed.points(recoveries),
        ..record
    }
}
