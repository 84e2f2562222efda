//! Fields of one instant of a motion, or of an equilibrium in time; the state of the run is stored beside, bit for bit.

use checkpoint::StepRecord;
use dynamics::Model;
use dynamics::motion::{Motion, MotionState};
use scene::{Dynamic, KeptFields, OutputSettings, Scene};

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
    /// Empty where the run does not go on from this step.
    state: Arrays,
    scene: String,
}

/// Whether a step file holds all that a run needs to go on from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RestartState {
    /// It does.
    Stored,
    /// It holds fields only: a run goes on from an earlier step, to the same bits.
    Left,
}

impl RestartState {
    /// Of the file of a step that is written as the scene asks: every `output.restart_every`-th of them has the state,
    /// and that of the end.
    pub fn at(step: u64, dynamic: &Dynamic, output: &OutputSettings) -> RestartState {
        let every = dynamic.output_every.saturating_mul(output.restart_every);
        match step == dynamic.n_steps || step.is_multiple_of(every) {
            true => RestartState::Stored,
            false => RestartState::Left,
        }
    }
}

impl Recorded {
    /// Places of rings and balls at one instant and the stress that ranks have `gathered`, as far as they are kept; the
    /// state if it is to be stored.
    pub fn new(
        model: &Model,
        motion: &Motion<'_>,
        state: &MotionState,
        gathered: Gathered,
        (scene, kept): (&Scene, KeptFields),
        restart: RestartState,
    ) -> Result<Recorded, Failure> {
        let shown = Shown::Motion { model, motion, state };
        Ok(Recorded {
            step: state.step,
            time: motion.time(state.step),
            places: Places::new(&shown, gathered, scene, kept)?,
            state: match restart {
                RestartState::Stored => state_arrays::store(state, &motion.shape()),
                RestartState::Left => Arrays::new(),
            },
            scene: scene.text.clone(),
        })
    }

    /// The same of an equilibrium at a step and its time, s, with the arrays of `state` beside its fields.
    pub fn of_equilibrium(
        shown: &Shown<'_>,
        (step, time): (u64, f64),
        gathered: Gathered,
        (scene, kept): (&Scene, KeptFields),
        state: Arrays,
    ) -> Result<Recorded, Failure> {
        Ok(Recorded {
            step,
            time,
            places: Places::new(shown, gathered, scene, kept)?,
            state,
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
