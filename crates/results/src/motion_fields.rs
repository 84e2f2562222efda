//! Fields of one instant of a motion; the state of the run is stored beside, bit for bit.

use checkpoint::StepRecord;
use dynamics::Model;
use dynamics::motion::{Motion, MotionState};
use scene::Scene;

use super::fields::Places;
use super::ring_stress::{Gathered, RingStress};
use super::shown::Shown;
use super::state_arrays::{self, Arrays};
use crate::failure::Failure;

/// One instant as it is stored, but for the stress: that is recovered when the record is made.
pub struct Recorded {
    step: u64,
    time: f64,
    places: Places,
    state: Arrays,
    scene: String,
}

impl Recorded {
    /// Places of rings and balls at one instant, the stress that ranks have `gathered`, and the state.
    pub fn new(
        model: &Model,
        motion: &Motion<'_>,
        state: &MotionState,
        gathered: Gathered,
        scene: &Scene,
    ) -> Result<Recorded, Failure> {
        let shown = Shown::Motion { model, motion, state };
        Ok(Recorded {
            step: state.step,
            time: motion.time(state.step),
            places: Places::new(&shown, gathered, scene)?,
            state: state_arrays::store(state, &motion.shape()),
            scene: scene.text.clone(),
        })
    }

    /// The record of the instant, with the stress that is asked for.
    pub fn record(self, stress: &RingStress) -> StepRecord {
        let (points, cells) = self.places.fields(stress);
        StepRecord {
            step: self.step,
            time: self.time,
            points,
            cells,
            scene: self.scene,
            state: self.state,
            tables: None,
        }
    }
}
