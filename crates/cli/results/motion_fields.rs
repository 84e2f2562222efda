//! Nodal fields of one instant of a motion; the state of the run is stored beside, bit for bit.

use checkpoint::StepRecord;
use dynamics::Model;
use dynamics::motion::{Motion, MotionState};
use fem::stress::StressRecovery;

use super::fields::points;
use super::shown::Shown;
use super::state_arrays;
use crate::scene::Scene;

/// The record of one instant.
pub fn record(
    model: &Model,
    motion: &Motion<'_>,
    state: &MotionState,
    recoveries: &[Option<StressRecovery>; 2],
    scene: &Scene,
) -> StepRecord {
    let shown = Shown::Motion { model, motion, state };
    StepRecord {
        step: state.step,
        time: motion.time(state.step),
        points: points(&shown, recoveries, scene.output.inner_ring),
        scene: scene.text.clone(),
        state: state_arrays::store(state, &motion.shape()),
    }
}
