//! A near field that knows what it has cost, for the timing table.

use contact::{LoadedPatch, NearField};
use dynamics::RingModel;
use timer::SharedLaps;

/// Its lap.
const LAP: &str = "near_field";

/// The near field at some points of a ring.
pub struct TimedNearField {
    field: NearField,
    laps: SharedLaps,
}

impl TimedNearField {
    /// At points of a ring, m; `reach` counts larger semi-axes of a patch.
    pub fn new(ring: &RingModel, reach: f64, positions: &[[f64; 3]]) -> TimedNearField {
        TimedNearField {
            field: NearField::new(ring.groove, ring.material.poisson_ratio, reach, positions),
            laps: SharedLaps::default(),
        }
    }

    /// Adds it to the stress of the points, Pa, in the ring's frame.
    pub fn add(&self, contacts: &[LoadedPatch], stress: &mut [[f64; 6]]) {
        self.laps.time(LAP, || self.field.add(contacts, stress));
    }

    /// Seconds spent on it so far.
    pub fn seconds(&self) -> f64 {
        self.laps.laps().seconds(LAP)
    }
}
