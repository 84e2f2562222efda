//! A near field that knows what it has cost, for the timing table.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use contact::{LoadedPatch, NearField};
use dynamics::RingModel;

/// The near field at some points of a ring.
pub struct TimedNearField {
    field: NearField,
    nanoseconds: AtomicU64,
}

impl TimedNearField {
    /// At points of a ring, m; `reach` counts larger semi-axes of a patch.
    pub fn new(ring: &RingModel, reach: f64, positions: &[[f64; 3]]) -> TimedNearField {
        TimedNearField {
            field: NearField::new(ring.groove, ring.material.poisson_ratio, reach, positions),
            nanoseconds: AtomicU64::new(0),
        }
    }

    /// Adds it to the stress of the points, Pa, in the ring's frame.
    pub fn add(&self, contacts: &[LoadedPatch], stress: &mut [[f64; 6]]) {
        let clock = Instant::now();
        self.field.add(contacts, stress);
        let spent = clock.elapsed().as_nanos() as u64;
        self.nanoseconds.fetch_add(spent, Ordering::Relaxed);
    }

    /// Time spent on it so far.
    pub fn spent(&self) -> Duration {
        Duration::from_nanos(self.nanoseconds.load(Ordering::Relaxed))
    }
}
