//! What a run spent its time on: the parts of the solver, and every effect by name.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::time::Instant;

use crate::model::Model;

/// Seconds spent, by part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timing {
    /// Assembly of the stiffness matrices.
    pub assemble: f64,
    /// Ordering, analysis and factorisation.
    pub factor: f64,
    /// Compliance columns of the contacts.
    pub columns: f64,
    /// Placing of patches.
    pub patches: f64,
    /// Full-field solves.
    pub solve: f64,
    /// Newton on contacts, balls and shaft.
    pub newton: f64,
}

/// Seconds spent on each effect. It lives in the workspace of a solver, never in an effect, and nothing that is computed
/// depends on it.
///
/// Effects that add loads are timed by [`crate::effects::timed_loads`]; those inside the steps of a motion time
/// themselves with [`EffectCosts::time`].
#[derive(Debug, Default)]
pub struct EffectCosts(Mutex<BTreeMap<&'static str, f64>>);

impl EffectCosts {
    /// A line of 0 s for every effect of the model.
    pub fn new(model: &Model) -> EffectCosts {
        let lines = model.effects.iter().map(|e| (e.name(), 0.0));
        EffectCosts(Mutex::new(lines.collect()))
    }

    /// Does some work and adds its time to an effect.
    pub fn time<T>(&self, effect: &'static str, work: impl FnOnce() -> T) -> T {
        let clock = Instant::now();
        let result = work();
        let seconds = clock.elapsed().as_secs_f64();
        *self.lines().entry(effect).or_insert(0.0) += seconds;
        result
    }

    /// Seconds by effect, in the order of their names.
    pub fn seconds(&self) -> BTreeMap<&'static str, f64> {
        self.lines().clone()
    }

    fn lines(&self) -> std::sync::MutexGuard<'_, BTreeMap<&'static str, f64>> {
        self.0
            .lock()
            .expect("no thread panics while it adds a number to the costs")
    }
}
