//! Laps of what several share.

use std::sync::{Mutex, MutexGuard};

use crate::laps::Laps;
use crate::stopwatch::Stopwatch;

/// [`Laps`] behind a lock, which is held only while a number is added.
#[derive(Debug, Default)]
pub struct SharedLaps(Mutex<Laps>);

impl SharedLaps {
    /// Does some work and adds its time, see [`Laps::add`].
    pub fn time<T>(&self, path: &'static str, work: impl FnOnce() -> T) -> T {
        let mut clock = Stopwatch::start();
        let made = work();
        let seconds = clock.lap();
        self.lock().add(path, seconds);
        made
    }

    /// The laps so far.
    pub fn laps(&self) -> Laps {
        self.lock().clone()
    }

    fn lock(&self) -> MutexGuard<'_, Laps> {
        self.0
            .lock()
            .expect("no thread panics while it adds a number to its laps")
    }
}

impl From<Laps> for SharedLaps {
    fn from(laps: Laps) -> SharedLaps {
        SharedLaps(Mutex::new(laps))
    }
}
