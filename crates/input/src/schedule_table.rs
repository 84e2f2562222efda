//! Sub-table `schedule` of a load or of an imposed displacement: its factor over time.
//!
//! ```toml
//! [effects.radial_force.schedule.ramp]        # or in one line: schedule.ramp = { start = "1 ms", duration = "2 ms" }
//! start = "1 ms"
//! duration = "2 ms"
//! ```
//!
//! Exactly one of `ramp`, `step`, `impact`, `harmonic` and `table`; what each does is in [`crate::schedule`]. Without a
//! schedule the value is constant. A scene at rest has no time and so no schedules.

use serde::Deserialize;

use crate::problems::Problems;
use crate::schedule::Schedule;
use crate::units::{ANGLE, Quantity, RATE, TIME};

/// As typed.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(
    deny_unknown_fields,
    expecting = "a table with one of ramp, step, impact, harmonic and table"
)]
pub struct RawSchedule {
    ramp: Option<RawRamp>,
    step: Option<RawStep>,
    impact: Option<RawImpact>,
    harmonic: Option<RawHarmonic>,
    table: Option<RawTable>,
}

/// As typed.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "a table with start and duration of a ramp")]
struct RawRamp {
    from: Option<f64>,
    to: Option<f64>,
    start: Quantity<TIME>,
    duration: Quantity<TIME>,
}

/// As typed.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "a table with the time of a step")]
struct RawStep {
    at: Quantity<TIME>,
    before: Option<f64>,
    after: Option<f64>,
}

/// As typed.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(
    deny_unknown_fields,
    expecting = "a table with start and duration of an impact"
)]
struct RawImpact {
    start: Quantity<TIME>,
    duration: Quantity<TIME>,
}

/// As typed.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "a table with the frequency of a harmonic")]
struct RawHarmonic {
    frequency: Quantity<RATE>,
    phase: Option<Quantity<ANGLE>>,
    mean: Option<f64>,
    amplitude: Option<f64>,
}

/// As typed.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "a table with times and factors")]
struct RawTable {
    times: Vec<Quantity<TIME>>,
    factors: Vec<f64>,
}

/// Whether a scene has time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// It computes equilibria without time.
    AtRest,
    /// Loads may change in its time.
    Running,
}

/// Checks the schedule of the table `owner` such as `effects.radial_force`; without one the value is constant.
pub fn check_schedule(
    raw: Option<&RawSchedule>,
    owner: &str,
    clock: Clock,
    problems: &mut Problems,
) -> Schedule {
    let Some(raw) = raw else {
        return Schedule::Constant;
    };
    let key = format!("{owner}.schedule");
    if clock == Clock::AtRest {
        problems.add(format!(
            "{key} changes {owner} over time, but a scene at rest has no time; remove it, or give it time with \
             [dynamic] or [quasi_static]"
        ));
        return Schedule::Constant;
    }
    let kinds = [
        ("ramp", raw.ramp.is_some()),
        ("step", raw.step.is_some()),
        ("impact", raw.impact.is_some()),
        ("harmonic", raw.harmonic.is_some()),
        ("table", raw.table.is_some()),
    ];
    let found: Vec<&str> = kinds.iter().filter(|k| k.1).map(|k| k.0).collect();
    match found.as_slice() {
        [_] => {
            let before = problems.len();
            let schedule = raw.schedule(&key, problems);
            // A wrong schedule is reported once, not again for what it would do to the value.
            if problems.len() == before {
                schedule
            } else {
                Schedule::Constant
            }
        }
        [] => {
            problems.add(format!(
                "{key} is empty; expected exactly one of ramp, step, impact, harmonic and table, or no schedule"
            ));
            Schedule::Constant
        }
        several => {
            problems.add(format!("{key} has {}; keep exactly one", several.join(" and ")));
            Schedule::Constant
        }
    }
}

/// The schedule of a table that was checked; without one the value is constant.
pub fn schedule_of(raw: Option<&RawSchedule>) -> Schedule {
    raw.map_or(Schedule::Constant, |raw| {
        raw.schedule("schedule", &mut Problems::default())
    })
}

impl RawSchedule {
    /// The first kind there is.
    fn schedule(&self, key: &str, problems: &mut Problems) -> Schedule {
        let ramp = self.ramp.as_ref().map(|r| r.check(key, problems));
        let step = self.step.as_ref().map(|s| s.check(key, problems));
        let impact = self.impact.as_ref().map(|i| i.check(key, problems));
        let harmonic = self.harmonic.as_ref().map(|h| h.check(key, problems));
        let table = self.table.as_ref().map(|t| t.check(key, problems));
        let found = ramp.or(step).or(impact).or(harmonic).or(table);
        found.unwrap_or_default()
    }
}

impl RawRamp {
    fn check(&self, key: &str, problems: &mut Problems) -> Schedule {
        let (from, to) = (self.from.unwrap_or(0.0), self.to.unwrap_or(1.0));
        require_finite(from, &format!("{key}.ramp.from"), problems);
        require_finite(to, &format!("{key}.ramp.to"), problems);
        problems.require_positive(&self.duration, &format!("{key}.ramp.duration"), "a duration");
        Schedule::Ramp {
            from,
            to,
            start: self.start.si(),
            duration: self.duration.si(),
        }
    }
}

impl RawStep {
    fn check(&self, key: &str, problems: &mut Problems) -> Schedule {
        let (before, after) = (self.before.unwrap_or(0.0), self.after.unwrap_or(1.0));
        require_finite(before, &format!("{key}.step.before"), problems);
        require_finite(after, &format!("{key}.step.after"), problems);
        Schedule::Step {
            at: self.at.si(),
            before,
            after,
        }
    }
}

impl RawImpact {
    fn check(&self, key: &str, problems: &mut Problems) -> Schedule {
        problems.require_positive(&self.duration, &format!("{key}.impact.duration"), "a duration");
        Schedule::Impact {
            start: self.start.si(),
            duration: self.duration.si(),
        }
    }
}

impl RawHarmonic {
    fn check(&self, key: &str, problems: &mut Problems) -> Schedule {
        let (mean, amplitude) = (self.mean.unwrap_or(0.0), self.amplitude.unwrap_or(1.0));
        require_finite(mean, &format!("{key}.harmonic.mean"), problems);
        require_finite(amplitude, &format!("{key}.harmonic.amplitude"), problems);
        problems.require_positive(
            &self.frequency,
            &format!("{key}.harmonic.frequency"),
            "a frequency",
        );
        Schedule::Harmonic {
            frequency: self.frequency.si(),
            phase: self.phase.as_ref().map_or(0.0, Quantity::si),
            mean,
            amplitude,
        }
    }
}

impl RawTable {
    fn check(&self, key: &str, problems: &mut Problems) -> Schedule {
        let (n_times, n_factors) = (self.times.len(), self.factors.len());
        if n_times == 0 || n_times != n_factors {
            problems.add(format!(
                "{key}.table has {n_times} times and {n_factors} factors; expected as many of both, at least one"
            ));
        }
        require_growing(&self.times, &format!("{key}.table"), problems);
        for (i, factor) in self.factors.iter().enumerate() {
            require_finite(*factor, &format!("{key}.table.factors[{i}]"), problems);
        }
        Schedule::Table {
            times: self.times.iter().map(Quantity::si).collect(),
            factors: self.factors.clone(),
        }
    }
}

/// The `times` of a table must grow.
pub fn require_growing(times: &[Quantity<TIME>], table: &str, problems: &mut Problems) {
    for (i, pair) in times.windows(2).enumerate() {
        let rule = format!("times must grow, the one before is {}", pair[0]);
        let key = format!("{table}.times[{}]", i + 1);
        problems.require(pair[1].si() > pair[0].si(), &key, &pair[1], rule);
    }
}

fn require_finite(factor: f64, key: &str, problems: &mut Problems) {
    problems.require(factor.is_finite(), key, factor, "expected a finite factor");
}
